/* SPDX-License-Identifier: GPL-3.0-or-later */
/* h that follows from the density, and the terms that this brings (docs/theory.md 2.15): h and the
 * density agree; Omega and the forces are what differences of independent solutions have; energy
 * and entropy are kept. */
#include <omp.h>
#include "lab.h"
#include "../lib/rng.h"

static const char GAS[] = "name = \"g\"; eos = { form = \"ideal\"; gamma = 1.4; };";
static const char *const densities[] = {"density=sum", "density=miscible"};
enum { MOST = 400 };

static double noise(long i, int k) { return 2 * rng_uniform(31, (uint64_t)i, (uint32_t)k) - 1; }

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* A ball in disorder, of masses and entropies that differ; p/rho^1.4 is what u is made from when
 * the density is known. */
static Parts *ball(int dim, double dx)
{
  const long n = lab_lattice(dx, 40, dim, in_ball, NULL, NULL);
  Parts *p = lab_parts(n, dim, GAS);
  lab_lattice(dx, 40, dim, in_ball, NULL, p->x);
  for (long i = 0; i < n; i++) {
    for (int d = 0; d < dim; d++) p->x[3 * i + d] += .2 * dx * noise(i, d);
    p->m[i] = pow(dx, dim) * exp(.5 * noise(i, 4)), p->rho[i] = 1;
    p->u[i] = 1 + .5 * noise(i, 5), p->h[i] = (dim == 1 ? 4 : dim == 2 ? 3 : 2.5) * dx;
  }
  return p;
}

static double neighbours(int dim) { return dim == 1 ? 8 : dim == 2 ? 26 : 60; }

static Param grad_param(int dim, const char *density, const char *more)
{
  Param par = lab_param("gravity.method=none", "precision=double", "form.grad_h=true",
                        "smoothing.mode=neighbours", "smoothing.min=0.01", "smoothing.max=100",
                        density, NULL);
  lab_set(&par, more);
  par.neighbours = neighbours(dim);
  return par;
}

/* W of Wendland C2, written out. */
static double wendland(int dim, double r, double h)
{
  static const double sigma[] = {5. / 4, 7 / LAB_PI, 21 / (2 * LAB_PI)};
  const double q = r / h;
  if (q >= 1) return 0;
  return sigma[dim - 1] / pow(h, dim) *
         (dim == 1 ? pow(1 - q, 3) * (1 + 3 * q) : pow(1 - q, 4) * (1 + 4 * q));
}

static double distance(const double *a, const double *b)
{
  return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
              (a[2] - b[2]) * (a[2] - b[2]));
}

/* sum_j m_j W(r_ij, h), miscible m_i sum W. */
static double sum_of(const Parts *p, long i, double h, int miscible)
{
  double sum = 0;
  for (long j = 0; j < p->n; j++)
    sum += p->m[miscible ? i : j] * wendland(p->dimension, distance(p->x + 3 * i, p->x + 3 * j), h);
  return sum;
}

/* rho and h of i such that V(h) rho/m is the number of neighbours: by bisection. */
static double solve(const Parts *p, long i, int miscible, double *h)
{
  const int dim = p->dimension;
  const double ball = dim == 1 ? 2 : dim == 2 ? LAB_PI : 4 * LAB_PI / 3;
  double low = 1e-3, high = 10;
  for (int k = 0; k < 80; k++) {
    *h = .5 * (low + high);
    if (ball * pow(*h, dim) * sum_of(p, i, *h, miscible) / p->m[i] < neighbours(dim))
      low = *h;
    else
      high = *h;
  }
  return sum_of(p, i, *h, miscible);
}

/* The internal energy at given entropies p/rho^1.4. */
static double energy(const Parts *p, const double *entropy, int miscible)
{
  double sum = 0, h;
  for (long i = 0; i < p->n; i++)
    sum += p->m[i] * entropy[i] / .4 * pow(solve(p, i, miscible, &h), .4);
  return sum;
}

/* One evaluation: h and rho against the bisection, Omega against differences of the sum by h. */
static void agrees(const Parts *p, const State *s, int miscible, double *worst)
{
  for (long i = 0; i < s->n; i++) {
    const long row = s->row[i];
    double h, rho = solve(p, row, miscible, &h);
    const double d = 1e-5 * h,
                 rate =
                     (sum_of(p, row, h + d, miscible) - sum_of(p, row, h - d, miscible)) / (2 * d),
                 omega = 1 + h / (p->dimension * rho) * rate;
    worst[0] = fmax(worst[0], fmax(fabs(s->h[i] / h - 1), fabs(s->rho[i] / rho - 1)));
    worst[1] = fmax(worst[1], fabs(s->omega[i] / omega - 1));
  }
}

/* Forces are those of the energy, -dU/dx, each h and density solved anew at each place. */
static void variational(void **state)
{
  (void)state;
  for (int c = 0; c < 6; c++) {
    const int dim = c / 2 + 1, miscible = c % 2;
    Parts *p = ball(dim, dim == 1 ? .05 : dim == 2 ? .16 : .4);
    Param par = grad_param(dim, densities[miscible], "viscosity.alpha=0 viscosity.beta=0");
    double entropy[MOST], worst[3] = {0, 0, 0}, plain = 0, size = 0;
    Sim sim;
    assert_true(p->n <= MOST);
    lab_open(&sim, &par, p);
    State s = lab_state(&sim);
    agrees(p, &s, miscible, worst);
    for (long i = 0; i < s.n; i++) entropy[s.row[i]] = s.p[i] / pow(s.rho[i], 1.4);
    for (long i = 0; i < 3 * s.n; i++) size = fmax(size, fabs(s.acc[i]));
    for (long i = 0; i < s.n; i += s.n / 6)
      for (int d = 0; d < dim; d++) {
        double *x = &p->x[3 * s.row[i] + d], was = *x, e[2];
        for (int side = 0; side < 2; side++)
          *x = was + (side ? 1e-5 : -1e-5), e[side] = energy(p, entropy, miscible);
        *x = was;
        const double force = -(e[1] - e[0]) / 2e-5 / s.m[i];
        worst[2] = fmax(worst[2], fabs(s.acc[3 * i + d] - force) / size);
      }
    lab_forget(&s), sim_close(&sim);
    par.grad_h = 0, par.smoothing = PARAM_FIXED; /* what the terms are good for */
    lab_open(&sim, &par, p);
    s = lab_state(&sim);
    for (long i = 0; i < 3 * s.n; i++) plain += s.acc[i] * s.acc[i] / (size * size * (double)s.n);
    lab_forget(&s), sim_close(&sim);
    print_message("%dD %s, %ld: h and rho %.1e, Omega %.1e, force %.1e (%.2f)\n", dim,
                  densities[miscible], p->n, worst[0], worst[1], worst[2], sqrt(plain));
    assert_true(worst[0] < 2e-5 && worst[1] < 2e-4 && worst[2] < 1e-4);
    part_free(p);
  }
}

/* A ball of gas that turns and breathes without viscosity: energy and momentum are kept, and so is
 * the entropy of each particle (with grad_h by the density that bisection finds), to the order of
 * the time integration; without the terms it is not. Returns its rms change. */
static double breathe(const char *how, double cfl, const char *integrator, double *drift)
{
  Parts *p = ball(2, .1);
  Param par = grad_param(2, "density=sum", "viscosity.alpha=0 viscosity.beta=0");
  double before[MOST], worst = 0, h;
  Sums a, b;
  Sim sim;
  lab_set(&par, how), lab_set(&par, integrator);
  par.cfl = par.step_acceleration = par.step_density = cfl;
  assert_true(p->n <= MOST);
  for (long i = 0; i < p->n; i++) {
    p->m[i] = .01, p->u[i] = 1;
    p->v[3 * i] = -.5 * p->x[3 * i] - .3 * p->x[3 * i + 1];
    p->v[3 * i + 1] = -.5 * p->x[3 * i + 1] + .3 * p->x[3 * i];
  }
  lab_open(&sim, &par, p), lab_sums(&sim, &a), lab_store(&sim, p);
  for (long i = 0; i < p->n; i++) before[i] = p->u[i] / pow(p->rho[i], .4);
  lab_run(&sim, .4), lab_sums(&sim, &b), lab_store(&sim, p);
  for (long i = 0; i < p->n; i++) {
    const double rho = par.grad_h ? solve(p, i, 0, &h) : p->rho[i];
    worst += pow(p->u[i] / pow(rho, .4) / before[i] - 1, 2) / (double)p->n;
  }
  *drift = fabs(b.kinetic + b.internal - a.kinetic - a.internal) / a.kinetic;
  for (int d = 0; d < 2; d++)
    assert_true(fabs(b.momentum[d] - a.momentum[d]) < 1e-13 * b.scale_momentum);
  assert_true(fabs(b.angular[2] - a.angular[2]) <
              (strstr(integrator, "leapfrog") ? 1e-13 : 1e-4) * a.scale_angular);
  sim_close(&sim), part_free(p);
  return sqrt(worst);
}

static void adiabatic(void **state)
{
  static const char *const integrators[] = {"integrator=leapfrog", "integrator=rk3-tvd"};
  double e[3];
  (void)state;
  const double without = breathe("form.grad_h=false", .1, "integrator=leapfrog", &e[0]);
  for (int k = 0; k < 2; k++) {
    const double coarse = breathe("form.grad_h=true", .2, integrators[k], &e[1]),
                 fine = breathe("form.grad_h=true", .1, integrators[k], &e[2]);
    print_message("%s: entropy %.1e, %.1e with half the step, %.1e without; energy %.1e %.1e\n",
                  integrators[k], coarse, fine, without, e[1], e[2]);
    assert_true(fine < .5 * coarse && fine < .01 * without && e[2] < .5 * e[1] && e[1] < 1e-2);
  }
}

/* Where h may not follow, Omega is 1. */
static void limits(void **state)
{
  Parts *p = ball(2, .16);
  Param par = grad_param(2, "density=sum", "smoothing.max=1 smoothing.min=1");
  Sim sim;
  (void)state;
  lab_open(&sim, &par, p);
  State s = lab_state(&sim);
  for (long i = 0; i < s.n; i++)
    assert_true(s.omega[i] == 1 && fabs(s.h[i] / p->h[s.row[i]] - 1) < 1e-14);
  lab_forget(&s), sim_close(&sim), part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(variational), cmocka_unit_test(adiabatic),
                                     cmocka_unit_test(limits)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
