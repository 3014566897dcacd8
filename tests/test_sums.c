/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Other weights of the sums (docs/theory.md 2.2, 2.14): the number density by its continuity
 * equation, kernels that are normalised at surfaces. */
#include <omp.h>
#include "lab.h"
#include "../lib/rng.h"

static const char ROCK[] =
    "name = \"s\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 1.; };"
    "strength = { shear_modulus = 0.3; form = \"none\"; };";
static const char WATER[] = "name = \"w\"; eos = { form = \"liquid\"; rho0 = 1.; c = 1.; };";

static double noise(long i, int k) { return 2 * rng_uniform(29, (uint64_t)i, (uint32_t)k) - 1; }

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* A ball of particles in slight disorder, of masses that differ by `spread`, swelling at `rate`. */
static Parts *ball(double dx, const char *material, double spread, double rate)
{
  const long n = lab_lattice(dx, 9, 3, in_ball, NULL, NULL);
  Parts *p = lab_parts(n, 3, material);
  lab_lattice(dx, 9, 3, in_ball, NULL, p->x);
  for (long i = 0; i < n; i++) {
    const double rho = exp(log(spread) * noise(i, 9));
    for (int d = 0; d < 3; d++) p->x[3 * i + d] += .1 * dx * noise(i, d);
    for (int d = 0; d < 3; d++) p->v[3 * i + d] = rate * p->x[3 * i + d] + .03 * noise(i, 3 + d);
    p->rho[i] = rho, p->m[i] = rho * dx * dx * dx, p->h[i] = 2.3 * dx;
  }
  return p;
}

static double distance(const double *a, const double *b)
{
  return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
              (a[2] - b[2]) * (a[2] - b[2]));
}

/* W of Wendland C2 in space, written out. */
static double wendland(double r, double h)
{
  const double q = r / h;
  return q < 1 ? 21 / (2 * LAB_PI) / (h * h * h) * pow(1 - q, 4) * (1 + 4 * q) : 0;
}

/* sum_j w_j W_ij at x, the particle itself included; volumes: w = m/rho, else 1. */
static double sum_of(const Parts *p, long i, int volumes)
{
  double sum = 0;
  for (long j = 0; j < p->n; j++)
    sum += (volumes ? p->m[j] / p->rho[j] : 1) *
           wendland(distance(p->x + 3 * i, p->x + 3 * j), .5 * (p->h[i] + p->h[j]));
  return sum;
}

/* By its continuity equation the number density of each particle changes by as much as the kernel
 * sum, whatever masses are around, to second order in the step, as long as h does not change. */
static double drift(double spread, double cfl, const char *integrator)
{
  Parts *p = ball(.31, WATER, spread, .1);
  Param par = lab_param("gravity.method=none", "density=miscible_continuity", integrator,
                        "smoothing.mode=fixed", "viscosity.alpha=0.1", NULL);
  double *before = malloc((size_t)p->n * sizeof *before), worst = 0;
  Sim sim;
  par.cfl = cfl, par.step_acceleration = cfl, par.step_density = 2 * cfl;
  for (long i = 0; i < p->n; i++) before[i] = p->rho[i] / p->m[i] - sum_of(p, i, 0);
  lab_open(&sim, &par, p), lab_run(&sim, .6), lab_store(&sim, p), sim_close(&sim);
  for (long i = 0; i < p->n; i++)
    worst =
        fmax(worst, fabs(p->rho[i] / p->m[i] - sum_of(p, i, 0) - before[i]) * p->m[i] / p->rho[i]);
  free(before), part_free(p);
  return worst;
}

static void number_density(void **state)
{
  static const char *const integrators[] = {"integrator=leapfrog", "integrator=rk3-tvd"};
  (void)state;
  for (int k = 0; k < 2; k++) {
    const double coarse = drift(3, .2, integrators[k]), fine = drift(3, .1, integrators[k]);
    print_message("%s: off the kernel sum by %.1e, %.1e with half the step\n", integrators[k],
                  coarse, fine);
    assert_true(coarse < 2e-2 && fine < coarse / 3);
  }
}

/* Forces of that form do the work by which density and stress go, particle by particle: without
 * viscosity du/dt is -p div v/rho + S:e/rho, exactly, for any masses (004 eq. 2.52 in the
 * variational form). */
static void local_work(void **state)
{
  static const char *const forms[] = {"density=miscible_continuity", "density=continuity"};
  double worst[4];
  (void)state;
  for (int k = 0; k < 4; k++) {
    Parts *p = ball(.31, k % 2 ? ROCK : WATER, 3, -.3);
    Param par = lab_param("gravity.method=none", "precision=double", "viscosity.alpha=0",
                          "viscosity.beta=0", forms[k / 2], NULL);
    Sim sim;
    worst[k] = 0;
    lab_open(&sim, &par, p), lab_run(&sim, .2);
    Step step = sim_step(&sim, 0);
    Err err;
    sim.b->pass(&sim, PASS_STILL, &step);
    if (sim.b->search(&sim, &err)) fail_msg("%s", err.text);
    sim.b->pass(&sim, PASS_STILL, &step), sim.b->gradient(&sim);
    sim.b->pass(&sim, PASS_LOCAL, &step), sim.b->force(&sim);
    State s = lab_state(&sim);
    double size = 0;
    for (long i = 0; i < s.n; i++) size += fabs(s.du[i]) / (double)s.n;
    for (long i = 0; i < s.n; i++) {
      const double *g = s.g ? &s.g[9 * i] : NULL, *t = s.s ? &s.s[6 * i] : NULL;
      double work = -s.p[i] * s.divv[i];
      if (k % 2)
        work += t[0] * g[0] + t[3] * g[4] + t[5] * g[8] + t[1] * (g[1] + g[3]) +
                t[2] * (g[2] + g[6]) + t[4] * (g[5] + g[7]);
      worst[k] = fmax(worst[k], fabs(s.du[i] - work / s.rho[i]) / size);
    }
    print_message("%s %s: du/dt off the local work by %.1e\n", k % 2 ? "rock" : "water",
                  forms[k / 2], worst[k]);
    lab_forget(&s), sim_close(&sim), part_free(p);
  }
  assert_true(worst[0] < 1e-12 && worst[1] < 1e-12); /* the others: both of a pair share its work */
  assert_true(worst[2] > .01 && worst[3] > .01);
}

/* theta is the sum of V W, written out; interpolation by V W/theta has a constant exactly, at the
 * surface too, where the plain sum has little more than half of it; and of a ball that swells the
 * divergence is nearer to the truth there. */
static void surfaces(void **state)
{
  double off[2] = {0, 0}, worst = 0, least = 1, most = 0;
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = ball(.2, WATER, 1.2, 0);
    Param par = lab_param("gravity.method=none", "precision=double",
                          k ? "form.shepard=true" : "form.shepard=false", NULL);
    Sim sim;
    for (long i = 0; i < 3 * p->n; i++) p->v[i] = .1 * p->x[i];
    lab_open(&sim, &par, p);
    State s = lab_state(&sim);
    for (long i = 0; i < s.n; i++) {
      const double *x = &s.x[3 * i], r = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
      if (r > .85) off[k] += pow(s.divv[i] / .3 - 1, 2);
      if (!k) continue;
      const double sum = sum_of(p, s.row[i], 1);
      double constant = 0;
      for (long j = 0; j < s.n; j++)
        constant += s.m[j] / s.rho[j] * wendland(distance(x, &s.x[3 * j]), .5 * (s.h[i] + s.h[j])) /
                    s.theta[i];
      worst = fmax(worst, fmax(fabs(s.theta[i] / sum - 1), fabs(constant - 1)));
      least = fmin(least, sum), most = fmax(most, sum);
    }
    lab_forget(&s), sim_close(&sim), part_free(p);
  }
  print_message("sums of V W from %.2f to %.2f, a constant off by %.1e; divergence at the surface "
                "%.3f, %.3f of plain kernels\n",
                least, most, worst, sqrt(off[1]), sqrt(off[0]));
  assert_true(worst < 1e-13 && least < .7 && off[1] < .5 * off[0]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(number_density), cmocka_unit_test(local_work),
                                     cmocka_unit_test(surfaces)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
