/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pair terms beyond the standard ones: without any of them they are those of pair.h; pairs
 * balance to the last bit; the loops are the sums over all pairs; and what each form conserves in
 * a run, which is what docs/theory.md 2.9 to 2.13 say. */
#include <omp.h>
#include "lab.h"
#include "../lib/rng.h"

static const char RUBBER[] =
    "name = \"s\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 1.; };"
    "strength = { shear_modulus = 0.3; form = \"none\"; };";
static const char WATER[] = "name = \"w\"; eos = { form = \"liquid\"; rho0 = 1.; c = 1.; };";

static double noise(long i, int k) { return 2 * rng_uniform(23, (uint64_t)i, (uint32_t)k) - 1; }

typedef struct {
  PairVector r;
  PairBody i, j;
  PairExtra a, b;
} Pair;

static PairBody body(long n, int dim)
{
  PairBody b;
  double *v = &b.vx, *stress = &b.dxx;
  for (int k = 0; k < 3; k++) v[k] = k < dim ? .5 * noise(n, 5 + k) : 0;
  for (int k = 0; k < 9; k++) stress[k] = noise(n, 11 + k);
  b.p = noise(n, 0), b.h = exp(noise(n, 8)), b.m = exp(noise(n, 1)), b.rho = exp(noise(n, 9));
  b.inverse_rho = 1 / b.rho, b.cs = exp(noise(n, 10)), b.signal = b.cs * 1.2;
  return b;
}

static PairExtra extra(long n)
{
  PairExtra e;
  double *z = &e.zxx;
  e.viscosity = rng_uniform(5, (uint64_t)n, 0), e.sense = n % 3 - 1.5;
  for (int k = 0; k < 6; k++) z[k] = noise(n, 30 + k);
  return e;
}

static Pair pair(long n, int dim)
{
  Pair p = {{noise(n, 20), dim > 1 ? noise(n, 21) : 0, dim > 2 ? noise(n, 22) : 0},
            body(2 * n, dim),
            body(2 * n + 1, dim),
            extra(2 * n),
            extra(2 * n + 1)};
  return p;
}

static double off(double worst, double a, double b, double size)
{
  return fmax(worst, fabs(a - b) / size);
}

/* Whole viscosity and no artificial stress: the force of pair.h. */
static void standard(void **state)
{
  double worst = 0;
  (void)state;
  for (int kern = 0; kern < KERNEL_COUNT; kern++)
    for (int dim = 1; dim <= 3; dim++)
      for (long n = 0; n < 200; n++) {
        PairRun run = {kernel_sigma(kern, dim), .5, .7, dim, 0, 0};
        PairMore more = {.miscible = n & 1, .own = n & 1, .exponent = 4, .over = 2};
        const PairExtra none = {1, 1, 0, 0, 0, 0, 0, 0};
        Pair p = pair(n, dim);
        PairForce f = pair_force(p.r, &p.i, &p.j, kern, dim == 1, 1, n & 1, &run);
        PairRich g = pair_rich(p.r, &p.i, &p.j, &none, &none, kern, dim == 1, 0, &run, &more);
        const double size = fabs(f.fx) + fabs(f.fy) + fabs(f.fz) + 1e-30;
        assert_true(f.near == g.f.near && fabs(f.signal - g.f.signal) <= 1e-14 * f.signal);
        worst = off(off(worst, f.fx, g.f.fx, size), f.fy, g.f.fy, size);
        worst = off(off(worst, f.fz, g.f.fz, size), f.work, g.f.work, size);
      }
  assert_true(worst < 1e-14);
}

/* Of every form: F_i + F_j = 0 to the last bit, heat is what motion loses; what moves one back
 * moves the other forth, and what diffuses out of one goes into the other. */
static void balance(void **state)
{
  double worst = 0;
  (void)state;
  for (int kern = 0; kern < KERNEL_COUNT; kern++)
    for (int dim = 1; dim <= 3; dim++)
      for (long n = 0; n < 400; n++) {
        PairRun run = {kernel_sigma(kern, dim), .5, .7, dim, n & 1, n >> 4 & 1};
        const int grad = n >> 5 & 1;
        PairMore more = {n >> 3 & 1,    n >> 1 & 1, grad | (n >> 2 & 1), grad,
                         (int)(n % 16), 1.7,        {.1, .2, .3}};
        Pair p = pair(n, dim);
        PairVector back = {-p.r.x, -p.r.y, -p.r.z};
        PairRich a = pair_rich(p.r, &p.i, &p.j, &p.a, &p.b, kern, dim == 1, grad, &run, &more),
                 b = pair_rich(back, &p.j, &p.i, &p.b, &p.a, kern, dim == 1, grad, &run, &more);
        const double size = fabs(a.f.fx) + fabs(a.f.fy) + fabs(a.f.fz),
                     moved = (p.i.vx - p.j.vx) * a.f.fx + (p.i.vy - p.j.vy) * a.f.fy +
                             (p.i.vz - p.j.vz) * a.f.fz;
        assert_true(a.f.fx == -b.f.fx && a.f.fy == -b.f.fy && a.f.fz == -b.f.fz);
        assert_true(a.wx == -b.wx && a.wy == -b.wy && a.wz == -b.wz);
        assert_true(a.f.near == b.f.near && a.f.signal == b.f.signal);
        if (size == 0) continue;
        worst = off(worst, moved + a.f.work, -b.f.work, fabs(a.f.work) + fabs(b.f.work) + size);
        const double in = a.rate * p.i.m / p.i.rho, out = b.rate * p.j.m / p.j.rho;
        worst = off(worst, in, -out, fabs(in) + 1e-30);
      }
  print_message("energy and volume of 8400 pairs: %.1e\n", worst);
  assert_true(worst < 1e-13);
}

/* x^n without branches. */
static void powers(void **state)
{
  (void)state;
  for (int n = 0; n < 16; n++) assert_true(fabs(pair_power(1.3, n) / pow(1.3, n) - 1) < 1e-14);
}

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* Two balls that collide off-centre, slightly irregular. */
static Parts *balls(int dimension, const char *material, double speed)
{
  const double dx = dimension == 3 ? .31 : .2;
  const long n = lab_lattice(dx, 6, dimension, in_ball, NULL, NULL);
  Parts *p = lab_parts(2 * n, dimension, material);
  lab_lattice(dx, 6, dimension, in_ball, NULL, p->x);
  lab_lattice(dx, 6, dimension, in_ball, NULL, p->x + 3 * n);
  for (long i = 0; i < p->n; i++) {
    const int b = i >= n;
    for (int d = 0; d < dimension; d++) p->x[3 * i + d] += .1 * dx * noise(i, 40 + d);
    p->body[i] = b, p->m[i] = pow(dx, dimension), p->rho[i] = 1, p->h[i] = 2.4 * dx;
    p->x[3 * i] += b ? 1.15 : -1.15, p->x[3 * i + 1] += b ? .4 : -.4;
    p->v[3 * i] = b ? -speed : speed, p->v[3 * i + 1] = .1 * p->x[3 * i];
  }
  return p;
}

#define ALL                                                                                        \
  "pressure_form=product stress_form=squares form.xsph=0.5 form.diffusion=0.1 "                    \
  "viscosity.switch=cullen_dehnen stress.artificial=0.3"

/* The backend's loops against all pairs. */
static double loops(int dim, int kern)
{
  static const char *const words[] = {
#define WORD(CAPITAL, NAME, ...) "kernel=" #NAME,
      KERNELS(WORD)};
  Parts *p = balls(dim, RUBBER, .3);
  Param par =
      lab_param("gravity.method=none", "precision=double", words[kern], "force.x=0.2", NULL);
  Sim sim;
  Err err;
  double worst = 0;
  if (dim == 1)
    for (long i = 0; i < p->n; i++) p->x[3 * i + 1] = p->v[3 * i + 1] = 0;
  lab_set(&par, ALL);
  lab_open(&sim, &par, p);
  lab_run(&sim, .2);
  Step k = sim_step(&sim, 0);
  if (sim.b->search(&sim, &err)) fail_msg("%s", err.text);
  sim.b->pass(&sim, PASS_STILL, &k), sim.b->gradient(&sim), sim.b->pass(&sim, PASS_LOCAL, &k);
  sim.b->force(&sim);
  State s = lab_state(&sim);
  const PairRun run = backend_pair(&sim, dim);
  for (long i = 0; i < s.n; i++) {
    double f[3] = {0}, w[3] = {0}, work = 0, rate = 0, sense = 0, size = 1e-30;
    const double *e = &s.extra[8 * i];
    PairBody me = passes_body(&s, i);
    PairExtra mine = {e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7]};
    for (long j = 0; j < s.n; j++) {
      const double *x = &s.x[3 * i], *y = &s.x[3 * j], *b = &s.extra[8 * j];
      PairVector r = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
      PairBody other = passes_body(&s, j);
      PairExtra its = {b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]};
      sense += (s.divv[j] < 0 ? -1 : 1) * s.m[j] / s.rho[i] *
               pair_weight(kern, dim == 1, &run, pair_dot(r, r), .5 * (s.h[i] + s.h[j]));
      if (i == j) continue;
      PairRich o = pair_rich(r, &me, &other, &mine, &its, kern, dim == 1, 0, &run, &sim.more);
      f[0] += o.f.fx, f[1] += o.f.fy, f[2] += o.f.fz, work += o.f.work, rate += o.rate;
      w[0] += o.wx, w[1] += o.wy, w[2] += o.wz;
      size += fabs(o.f.fx) + fabs(o.f.fy) + fabs(o.f.fz);
    }
    for (int d = 0; d < 3; d++) {
      worst = off(worst, s.m[i] * s.acc[3 * i + d], f[d], size);
      worst = off(worst, s.m[i] * s.wander[3 * i + d], par.xsph * w[d], s.m[i]);
    }
    worst = off(worst, s.m[i] * s.du[i], work, size), worst = off(worst, s.sense[i], sense, 1);
    worst = off(worst, s.drho[i], par.diffusion * rate, 1);
  }
  lab_forget(&s), sim_close(&sim), part_free(p);
  return worst;
}

static void all_pairs(void **state)
{
  double worst = 0;
  (void)state;
  for (int kern = 0; kern < KERNEL_COUNT; kern++)
    for (int dim = 1; dim <= 3; dim++) worst = fmax(worst, loops(dim, kern));
  print_message("21 stamps against all pairs: %.1e\n", worst);
  assert_true(worst < 1e-12);
}

/* What a collision keeps with each form: momentum (and the path of the centre) to rounding,
 * angular momentum and energy to what the table says, of what moves; angular 0: to rounding. */
typedef struct {
  const char *form, *material;
  double angular, energy;
} Kept;

static const Kept kept[] = {
    {"", WATER, 0, 1e-3},
    {"pressure_form=product", WATER, 0, 1e-3},
    {"viscosity.balsara=true", WATER, 0, 1e-3},
    {"viscosity.switch=morris_monaghan", WATER, 0, 1e-3},
    {"viscosity.switch=cullen_dehnen", WATER, 0, 1e-3},
    {"form.diffusion=0.05", WATER, 0, 1e-3},
    {"form.xsph=0.5", WATER, 1e-5, 1e-3},
    {"stress.artificial=0.3", WATER, 0, 1e-3},
    {"density=miscible_continuity", WATER, 0, 1e-3},
    {"density=miscible_continuity", RUBBER, 1e-4, 1e-3},
    {"form.grad_h=true density=sum", WATER, 0, 1e-3},
    {"form.grad_h=true density=miscible", WATER, 0, 1e-3},
    {"form.grad_h=true density=sum", RUBBER, 1e-3, 1e-2},
    {"form.shepard=true", WATER, 0, 1e-3},
    {"form.shepard=true", RUBBER, 3e-3, 1e-3},
    {"form.gradient=raw", RUBBER, 1, 1e-3},
    {"stress_form=product", RUBBER, 3e-5, 1e-3},
    {"stress_form=squares", RUBBER, 1e-3, 1e-3},
    {"stress.artificial=0.3", RUBBER, 3e-3, 1e-3},
    {ALL, RUBBER, 3e-3, 1e-3},
};

static void conserved(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof kept / sizeof *kept; k++) {
    const Kept *c = &kept[k];
    Parts *p = balls(2, c->material, .2);
    Param par = lab_param("gravity.method=none", "precision=double", "step.cfl=0.2", NULL);
    Sums a, b;
    Sim sim;
    double volume = 0, size = 0;
    lab_set(&par, c->form);
    lab_open(&sim, &par, p);
    lab_sums(&sim, &a), lab_run(&sim, 3), lab_sums(&sim, &b);
    State s = lab_state(&sim);
    for (long i = 0; i < s.n && s.drho; i++)
      volume += s.m[i] / s.rho[i] * s.drho[i], size += fabs(s.m[i] / s.rho[i] * s.drho[i]);
    const double px =
                     fmax(fabs(b.momentum[0] - a.momentum[0]), fabs(b.momentum[1] - a.momentum[1])),
                 l = fabs(b.angular[2] - a.angular[2]) / a.scale_angular,
                 e = fabs(b.kinetic + b.internal - a.kinetic - a.internal) / a.kinetic;
    print_message("%-8s %-36s p %.1e, L %.1e, E %.1e\n", c->material == WATER ? "fluid" : "solid",
                  c->form, px / b.scale_momentum, l, e);
    assert_true(px < 1e-13 * b.scale_momentum);
    assert_true(hypot(b.centre[0] - a.centre[0] - 3 * a.momentum[0] / a.mass,
                      b.centre[1] - a.centre[1] - 3 * a.momentum[1] / a.mass) < 1e-12);
    assert_true(l < (c->angular > 0 ? c->angular : 1e-12) && e < c->energy);
    assert_true(fabs(volume) <= 1e-13 * size);
    lab_forget(&s), sim_close(&sim), part_free(p);
  }
}

/* A square lattice of rubber that is pulled clumps along itself; the artificial stress keeps its
 * particles apart, whichever way the lattice lies. */
static double closest(const char *more, double turn)
{
  const double dx = .1, c = cos(turn), s = sin(turn);
  const long n = lab_lattice(dx, 8, 2, in_ball, NULL, NULL);
  Parts *p = lab_parts(n, 2, WATER);
  Param par = lab_param("gravity.method=none", "kernel=cubic_spline", "smoothing.mode=fixed",
                        "viscosity.alpha=0.2", "precision=double", NULL);
  double least = INFINITY;
  Sim sim;
  lab_set(&par, more);
  lab_lattice(dx, 8, 2, in_ball, NULL, p->x);
  for (long i = 0; i < n; i++) {
    double *x = &p->x[3 * i], u = x[0] + .01 * dx * noise(i, 0), v = x[1] + .01 * dx * noise(i, 1);
    x[0] = c * u - s * v, x[1] = s * u + c * v;
    p->v[3 * i] = .25 * x[0], p->v[3 * i + 1] = .25 * x[1];
    p->m[i] = dx * dx, p->rho[i] = .95, p->h[i] = 3 * dx;
  }
  lab_open(&sim, &par, p), lab_run(&sim, 2), lab_store(&sim, p), sim_close(&sim);
  for (long i = 0; i < n; i++)
    for (long j = 0; j < i; j++)
      least = fmin(least, hypot(p->x[3 * i] - p->x[3 * j], p->x[3 * i + 1] - p->x[3 * j + 1]));
  part_free(p);
  return least / dx;
}

static void clumping(void **state)
{
  (void)state;
  const double without = closest("", 0), with = closest("stress.artificial=0.3", 0),
               turned = closest("stress.artificial=0.3", .6);
  /* the spacing of m, rho and h; a much smaller one, with less stress */
  const double given = closest("stress.artificial=0.3 stress.spacing=0.341993", 0),
               close = closest("stress.artificial=0.3 stress.spacing=0.01", 0);
  print_message("closest pair %.3f, with artificial stress %.3f, turned %.3f\n", without, with,
                turned);
  assert_true(with > without + .15 && fabs(turned / with - 1) < 1e-3);
  assert_true(fabs(given / with - 1) < 1e-3 && close < with - .1);
}

/* What of a tensor is tension: of known axes, in any frame. */
static void tension(void **state)
{
  (void)state;
  for (long n = 0; n < 300; n++) {
    const double l[3] = {noise(n, 0), n % 3 ? noise(n, 1) : noise(n, 0), noise(n, 2)};
    double q[3][3], norm, along;
    for (int a = 0; a < 3; a++) {
      for (int b = 0; b < 3; b++) q[a][b] = noise(n, 10 + 3 * a + b);
      for (int c = 0; c < a; c++) {
        along = q[a][0] * q[c][0] + q[a][1] * q[c][1] + q[a][2] * q[c][2];
        for (int b = 0; b < 3; b++) q[a][b] -= along * q[c][b];
      }
      norm = sqrt(q[a][0] * q[a][0] + q[a][1] * q[a][1] + q[a][2] * q[a][2]);
      for (int b = 0; b < 3; b++) q[a][b] /= norm;
    }
    Sym s = {0, 0, 0, 0, 0, 0}, plus = s;
    for (int a = 0; a < 3; a++) {
      Sym one = {q[a][0] * q[a][0], q[a][0] * q[a][1], q[a][0] * q[a][2],
                 q[a][1] * q[a][1], q[a][1] * q[a][2], q[a][2] * q[a][2]};
      s = tensor_axpy(s, l[a], one), plus = tensor_axpy(plus, fmax(l[a], 0), one);
    }
    Sym d = tensor_axpy(tensor_tension(s), -1, plus);
    assert_true(tensor_dot(d, d) < 1e-26);
  }
}

/* The switches in closed form, and the limiter. */
static void switches(void **state)
{
  double share = .8, divv = 0, div0 = 0, sense = 0, c = 2, h = .5, g[9] = {0};
  State s = {.n = 1,
             .dimension = 3,
             .viscosity = &share,
             .divv = &divv,
             .div0 = &div0,
             .sense = &sense,
             .cs = &c,
             .h = &h,
             .g = g};
  Rich mm = {.viscosity = RICH_MORRIS_MONAGHAN, .least = .1},
       cd = {.viscosity = RICH_CULLEN_DEHNEN, .least = .1};
  (void)state;
  rich_switch(&s, &mm, 0, .3);
  assert_true(fabs(share - .1 - .7 * exp(-.3 * .8)) < 1e-14); /* tau = h/(0.2 c) */
  divv = -5, rich_switch(&s, &mm, 0, 100);
  assert_true(fabs(share - (.08 + 5) / 5.8) < 1e-14); /* where source and decay balance */
  divv = div0 = 0, share = .8, rich_switch(&s, &cd, 0, .3);
  assert_true(fabs(share - .1 - .7 * exp(-.3 * .1 * 2 / .5)) < 1e-14); /* tau = h/(0.1 c) */
  div0 = -1, divv = -3, sense = -1, share = .1; /* compression that grows: no shear, no limit */
  rich_switch(&s, &cd, 0, .01);
  assert_true(fabs(share - .25 * 200 / (3.5 * 3.5 + .25 * 200)) < 1e-14 && div0 == -3);
  g[1] = 60, div0 = -1, sense = .5, share = .1; /* the same in a shear flow: limited */
  rich_switch(&s, &cd, 0, .01);
  assert_true(share == .1);
  g[1] = 0, g[0] = -3;
  assert_true(fabs(rich_balsara(&s, 0) - 3 / (3 + 4e-4)) < 1e-14);
  g[0] = 0, g[1] = 4;
  assert_true(rich_balsara(&s, 0) == 0);
}

/* In a tube where two flows meet the share is large in the shocks and nowhere else. */
static void shocks(void **state)
{
  static const char *const keys[] = {"viscosity.switch=morris_monaghan",
                                     "viscosity.switch=cullen_dehnen"};
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = lab_parts(400, 1, "name = \"g\"; eos = { form = \"ideal\"; gamma = 1.4; };");
    Param par = lab_param("gravity.method=none", "precision=double", keys[k], NULL);
    double peak = 0, away = 0;
    Sim sim;
    for (long i = 0; i < p->n; i++)
      p->x[3 * i] = .01 * ((double)i - 199.5), p->v[3 * i] = p->x[3 * i] < 0 ? 1 : -1,
               p->m[i] = .01, p->rho[i] = 1, p->h[i] = .03, p->u[i] = 1;
    lab_open(&sim, &par, p), lab_run(&sim, .6);
    State s = lab_state(&sim);
    for (long i = 0; i < s.n; i++) {
      if (fabs(s.x[3 * i]) < .7) peak = fmax(peak, s.viscosity[i]);
      if (fabs(s.x[3 * i]) > .9 && fabs(s.x[3 * i]) < 1.2) away = fmax(away, s.viscosity[i]);
    }
    print_message("%s: %.2f at the shocks, %.2f before them\n", keys[k], peak, away);
    assert_true(peak > .5 && away < .15);
    lab_forget(&s), sim_close(&sim), part_free(p);
  }
}

/* Density that stands hydrostatically in a body force does not diffuse; noise on it does. */
static void diffusion(void **state)
{
  double rate[2];
  (void)state;
  for (int k = 0; k < 2; k++) {
    const double dx = .1;
    Parts *p = lab_parts(400, 2, WATER);
    Param par = lab_param("gravity.method=none", "precision=double", "form.diffusion=0.1",
                          k ? "force.y=0" : "force.y=-0.02", NULL);
    Sim sim;
    rate[k] = 0;
    for (long i = 0; i < p->n; i++) {
      p->x[3 * i] = dx * (double)(i % 20), p->x[3 * i + 1] = dx * (double)(i / 20);
      p->rho[i] = exp(-.02 * p->x[3 * i + 1]), p->m[i] = dx * dx * p->rho[i], p->h[i] = 2.6 * dx;
    }
    lab_open(&sim, &par, p);
    State s = lab_state(&sim);
    for (long i = 0; i < s.n; i++) rate[k] = fmax(rate[k], fabs(s.drho[i]));
    lab_forget(&s), sim_close(&sim), part_free(p);
  }
  print_message("rate of a hydrostatic density %.1e, without the force %.1e\n", rate[0], rate[1]);
  assert_true(rate[1] > 1e-3 && rate[0] < 1e-3 * rate[1]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(standard),  cmocka_unit_test(balance),
                                     cmocka_unit_test(powers),    cmocka_unit_test(all_pairs),
                                     cmocka_unit_test(conserved), cmocka_unit_test(clumping),
                                     cmocka_unit_test(tension),   cmocka_unit_test(switches),
                                     cmocka_unit_test(shocks),    cmocka_unit_test(diffusion)};
  omp_set_num_threads(1); /* small loops */
  return cmocka_run_group_tests(tests, NULL, NULL);
}
