/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fluids: the power and the forces of physical viscosity against their closed forms, energy that a
 * run deposits, a constant body force. */
#include "lab.h"

static const char WATER[] = "name = \"w\"; eos = { form = \"liquid\"; rho0 = 1.; c = 2.; };";

/* All integrators. */
#define WORD(WORD, NAME) "integrator=" WORD,
static const char *const integrators[] = {INTEGRATORS(WORD)};
enum { SCHEMES = sizeof integrators / sizeof *integrators };

static int in_box(const double *x, void *data)
{
  (void)x, (void)data;
  return 1;
}

/* A lattice of spacing dx in the box -1..1, without pressure, with velocities dv_a/dx_b = g. */
static Parts *flow(int dimension, double dx, const double g[9])
{
  const int half = (int)lround(1 / dx);
  const long n = lab_lattice(dx, half, dimension, in_box, NULL, NULL);
  Parts *p = lab_parts(n, dimension, WATER);
  lab_lattice(dx, half, dimension, in_box, NULL, p->x);
  for (long i = 0; i < n; i++) {
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) p->v[3 * i + a] += g[3 * a + b] * p->x[3 * i + b];
    p->m[i] = pow(dx, dimension), p->rho[i] = 1, p->h[i] = 2.6 * dx;
  }
  return p;
}

/* What one evaluation gives to the particle at x. */
typedef struct {
  double acc[3], du, signal, size;
} Answer;

static Answer evaluate(Parts *p, const Param *par, double x, double y, double z)
{
  Answer o = {{0, 0, 0}, 0, 0, 0};
  double least = INFINITY;
  Sim sim;
  lab_open(&sim, par, p);
  lab_store(&sim, p);
  for (long i = 0; i < p->n; i++) {
    const double *at = &p->x[3 * i];
    double away = hypot(hypot(at[0] - x, at[1] - y), at[2] - z);
    if (away >= least) continue;
    least = away, o.du = p->dudt[i], o.signal = p->signal[i];
    for (int d = 0; d < 3; d++) o.acc[d] = p->a[3 * i + d];
  }
  for (long i = 0; i < 3 * p->n; i++) o.size = fmax(o.size, fabs(p->a[i]));
  sim_close(&sim);
  part_free(p);
  return o;
}

#define QUIET                                                                                      \
  "gravity.method=none", "viscosity.alpha=0", "viscosity.beta=0", "precision=double",              \
      "kernel=wendland_c2"

/* The power of each viscosity in a uniform velocity gradient: shear nu g^2, rotation nothing,
 * compression (zeta + 4/3 nu) in 1D and zeta (div v)^2 in 3D; alpha c H grows with the distance. */
static void power(void **state)
{
  static const double shear[9] = {0, .3}, turn[9] = {0, .3, 0, -.3}, in[9] = {-.2},
                      all[9] = {-.1, 0, 0, 0, -.1, 0, 0, 0, -.1},
                      out[9] = {.1, 0, 0, 0, .1, 0, 0, 0, .1};
  static const struct {
    const char *key;
    int dimension;
    const double *g;
    double x, power;
  } T[] = {{"viscosity.kinematic=0.02", 2, shear, 0, .02 * .09},
           {"viscosity.kinematic=0.02", 3, shear, 0, .02 * .09},
           {"viscosity.kinematic=0.02", 2, turn, 0, 0},
           {"viscosity.kinematic=0.02", 1, in, 0, .02 * 4 / 3 * .04},
           {"viscosity.kinematic=0.02", 3, all, 0, 0},
           {"viscosity.bulk=0.02", 3, all, 0, .02 * .09},
           {"viscosity.bulk=0.02", 2, shear, 0, 0},
           {"viscosity.compression=0.5", 3, all, 0, .5 * .52 * .52 * .027},
           {"viscosity.compression=0.5", 3, out, 0, 0},
           {"viscosity.shakura_sunyaev=0.1", 2, shear, .5, .1 * 2 * .05 * .5 * .09}};
  (void)state;
  for (size_t k = 0; k < sizeof T / sizeof *T; k++) {
    Param par = lab_param(QUIET, T[k].key, NULL);
    Answer a = evaluate(flow(T[k].dimension, T[k].x > 0 ? .05 : .2, T[k].g), &par, T[k].x, 0, 0);
    print_message("%s, %dD: %.6g, exact %.6g\n", T[k].key, T[k].dimension, a.du, T[k].power);
    assert_true(fabs(a.du - T[k].power) < 1e-12 + (T[k].x > 0 ? 5e-3 : 1e-12) * T[k].power);
  }
}

/* Shakura & Sunyaev (1973): nu = alpha c H, H = aspect r with r from the origin in all directions;
 * eta = rho nu, and what it adds to the signal. */
static void thin_disk(void **state)
{
  double x[3] = {1, 2, 2}, g[9] = {0, .3}, cs = 2, h = .5, rho = 4, cl = 2.5;
  const double nu = .1 * 2 * .05 * 3;
  State s = {.n = 1, .x = x, .g = g, .cs = &cs, .h = &h, .rho = &rho, .cl = &cl};
  Fluid f = {.shakura = .1, .aspect = .05};
  Sym t = fluid_stress(&s, &f, 0);
  (void)state;
  assert_true(fabs(t.xy - 4 * nu * .3) < 1e-15 && t.xx == 0 && t.zz == 0);
  assert_true(fabs(cl - 2.5 - 8 * nu / .5) < 1e-14);
  /* rho (zeta + f h^2 |div v|) div v under compression, from all sides */
  const double squeeze[9] = {-.1, 0, 0, 0, -.2, 0, 0, 0, 0}, zeta = .2 + .5 * .25 * .3;
  memcpy(g, squeeze, sizeof g), f = (Fluid){.bulk = .2, .compression = .5};
  t = fluid_stress(&s, &f, 0);
  assert_true(fabs(t.xx + 4 * zeta * .3) < 1e-15 && t.yy == t.xx && t.zz == t.xx && t.xy == 0);
}

/* A fluid that turns rigidly feels no viscosity, at its free surface neither. */
static void rotation(void **state)
{
  static const double turn[9] = {0, .3, 0, -.3};
  Param par = lab_param(QUIET, "viscosity.kinematic=0.5", "viscosity.bulk=0.5", NULL);
  (void)state;
  assert_true(evaluate(flow(2, .2, turn), &par, 0, 0, 0).size < 1e-14);
}

/* v_x = sin(k y) is slowed down by nu k^2 v; the error falls with h^2. */
static void wave(void **state)
{
  const double none[9] = {0}, nu = .03, k = 3;
  double error[2];
  (void)state;
  for (int e = 0; e < 2; e++) {
    Param par = lab_param(QUIET, "viscosity.kinematic=0.03", NULL);
    const double dx = e ? .05 : .1;
    Parts *p = flow(2, dx, none);
    for (long i = 0; i < p->n; i++) p->v[3 * i] = sin(k * p->x[3 * i + 1]);
    Answer a = evaluate(p, &par, 0, .3, 0);
    error[e] = fabs(a.acc[0] / (-nu * k * k * sin(k * .3)) - 1);
    assert_true(fabs(a.acc[1]) < 1e-13);
  }
  print_message("shear wave: off by %.2e, %.2e with half the spacing\n", error[0], error[1]);
  assert_true(error[0] < .1 && error[1] < .3 * error[0]);
}

/* Viscosity limits the step to 0.4 h/(16 nu/h). */
static void limit(void **state)
{
  const double none[9] = {0};
  Param par = lab_param(QUIET, "viscosity.kinematic=50", "viscosity.bulk=50", NULL);
  Answer a = evaluate(flow(2, .2, none), &par, 0, 0, 0);
  (void)state;
  assert_true(fabs(a.signal / (2 * (2 + 8 * 100 / .52)) - 1) < 1e-12);
}

/* Particles that do not touch get what was deposited to rounding, though steps do not end where the
 * heating does: in a ball, along a beam, with a Gaussian profile. */
static void deposit(void **state)
{
  static const char *const keys[][3] = {
      {"heating.axis=none", "heating.profile=uniform", "heating.radius=0"},
      {"heating.axis=none", "heating.profile=uniform", "heating.radius=2.5"},
      {"heating.axis=x", "heating.profile=uniform", "heating.radius=2.5"},
      {"heating.axis=none", "heating.profile=gaussian", "heating.radius=2"},
      {"heating.axis=x", "heating.profile=gaussian", "heating.radius=2"}};
  (void)state;
  for (int c = 0; c < 5 * SCHEMES; c++) {
    const int k = c % 5;
    const char *const *key = keys[k];
    Parts *p = lab_parts(9, 3, WATER);
    Param par = lab_param("gravity.method=none", integrators[c / 5], "heating.rate=3",
                          "heating.begin=0.1234", "heating.end=1.7", "heating.x=1", "heating.y=2",
                          "step.max=0.037", key[0], key[1], key[2], NULL);
    Sim sim;
    for (long i = 0; i < p->n; i++)
      p->x[3 * i] = (double)i, p->x[3 * i + 1] = 2 + (double)(i % 3), p->m[i] = p->rho[i] = 1,
               p->h[i] = .5, p->u[i] = 1;
    lab_open(&sim, &par, p);
    lab_run(&sim, 1.3), lab_run(&sim, 2);
    lab_store(&sim, p);
    for (long i = 0; i < p->n; i++) {
      const double dx = k == 2 || k == 4 ? 0 : p->x[3 * i] - 1, dy = p->x[3 * i + 1] - 2,
                   r2 = dx * dx + dy * dy;
      const double share = k == 0 ? 1 : k >= 3 ? exp(-r2 / 8) : r2 < 6.25 ? 1 : 0;
      assert_true(fabs(p->u[i] - 1 - 3 * (1.7 - .1234) * share) < 1e-13);
    }
    sim_close(&sim);
    part_free(p);
  }
}

/* What is deposited in matter that moves and expands is the gain of its energy. */
static void balance(void **state)
{
  const double none[9] = {0};
  Parts *p = flow(2, .2, none);
  Param par = lab_param(QUIET, "step.max=0.01", "heating.rate=0.1", "heating.end=0.7", NULL);
  Sim sim;
  Sums a, b;
  (void)state;
  free(p->material[0].text);
  p->material[0].text = strdup("name = \"g\"; eos = { form = \"ideal\"; gamma = 1.4; };");
  for (long i = 0; i < p->n; i++) p->u[i] = .1;
  lab_open(&sim, &par, p);
  lab_sums(&sim, &a), lab_run(&sim, 1), lab_sums(&sim, &b);
  const double gain = b.kinetic + b.internal - a.kinetic - a.internal, given = .07 * a.mass;
  print_message("heated gas: gains %.6g, given %.6g, kinetic %.3g\n", gain, given, b.kinetic);
  assert_true(b.kinetic > .02 * given && fabs(gain / given - 1) < 1e-4);
  sim_close(&sim), part_free(p);
}

/* A body force moves a drop that turns as a whole: its centre falls, potential and kinetic energy
 * add up, and the motion in its frame is that without the force. */
static void fall(void **state)
{
  static const double turn[9] = {0, .3, 0, -.3};
  (void)state;
  for (int c = 0; c < SCHEMES; c++) {
    Parts *p[2];
    Sums a, b;
    for (int k = 0; k < 2; k++) {
      Param par =
          lab_param(QUIET, integrators[c], "step.max=0.02", "step.acceleration=2", "step.error=1",
                    k ? "force.x=0.3" : "force.x=0", k ? "force.y=-2" : "force.y=0", NULL);
      Sim sim;
      p[k] = flow(2, .25, turn);
      lab_open(&sim, &par, p[k]);
      lab_sums(&sim, &a), lab_run(&sim, 1), lab_sums(&sim, &b);
      lab_store(&sim, p[k]);
      sim_close(&sim);
    }
    double worst = 0;
    for (long i = 0; i < p[0]->n; i++) {
      worst = fmax(worst, fabs(p[1]->x[3 * i] - p[0]->x[3 * i] - .15));
      worst = fmax(worst, fabs(p[1]->x[3 * i + 1] - p[0]->x[3 * i + 1] + 1));
    }
    const double energy = b.kinetic + b.internal + b.potential - a.kinetic - a.internal;
    print_message("%s: places off by %.1e, momentum %.1e, energy %.1e of %.3g\n", integrators[c],
                  worst, b.momentum[1] + 2 * b.mass, energy, b.kinetic);
    const int first = integrator_of(c) == &integrator_euler; /* order */
    assert_true(worst < (first ? .021 : 1e-12) && fabs(b.momentum[1] + 2 * b.mass) < 1e-12);
    assert_true(fabs(a.potential) < 1e-12 && fabs(energy) < (first ? .03 : 1e-4) * b.kinetic);
    part_free(p[0]), part_free(p[1]);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(power),   cmocka_unit_test(rotation),
                                     cmocka_unit_test(wave),    cmocka_unit_test(thin_disk),
                                     cmocka_unit_test(limit),   cmocka_unit_test(deposit),
                                     cmocka_unit_test(balance), cmocka_unit_test(fall)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
