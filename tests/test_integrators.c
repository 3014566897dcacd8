/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every integrator of the list: unequal steps of v' = -rate v against the scheme written out as in
 * its source, what a collision conserves, and where damage ends. Their order is in test_order,
 * restarts in test_restart. */
#include <omp.h>
#include "lab.h"

static const char GAS[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";
static const char RUBBER[] =
    "name = \"r\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };"
    "strength = { shear_modulus = 0.5; form = \"none\"; };";
static const char ROCK[] =
    "name = \"b\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };"
    "strength = { shear_modulus = 1.; form = \"none\"; };"
    "damage = { form = \"grady_kipp\"; k = 1e10; m = 5.; };";

/* A scheme on v' = f = -rate v, for one step z = rate dt: v and f at its end from those before; w:
 * this step over the last one. */
typedef struct {
  double v, f, before; /* f: as leapfrog keeps it; before: f of the step before (ab2) */
} Decay;

static void leapfrog(Decay *d, double z, double w)
{
  double f = -(d->v + d->f * z);
  (void)w;
  d->v += 0.5 * z * (d->f + f), d->f = f;
}

static void euler(Decay *d, double z, double w)
{
  (void)w;
  d->v *= 1 - z;
}

static void midpoint(Decay *d, double z, double w)
{
  (void)w;
  d->v *= 1 - z + z * z / 2;
}

static void third(Decay *d, double z, double w)
{
  (void)w;
  d->v *= 1 - z + z * z / 2 - z * z * z / 6;
}

static void ab2(Decay *d, double z, double w)
{
  double f = -d->v, predicted = d->v + z * ((1 + w / 2) * f - w / 2 * d->before);
  d->v += z / 2 * (f - predicted), d->before = f;
}

static const struct {
  const char *name;
  void (*step)(Decay *d, double z, double w);
} schemes[] = {{"leapfrog", leapfrog}, {"euler", euler},        {"predictor-corrector", midpoint},
               {"rk3-tvd", third},     {"rk2-adaptive", third}, {"ab2", ab2},
               {"heun-rk4", midpoint}};

static char *setting(int integrator, char *text, size_t size)
{
  snprintf(text, size, "integrator=%s", integrator_of(integrator)->name);
  return text;
}

#define COUNT(...) +1
enum { ALL = INTEGRATORS(COUNT) };

/* Two specks that part, damped: steps of 0.1, 0.05, 0.2 ... of 1/rate. */
static void decay(void **state)
{
  static const double steps[] = {.1, .05, .2, .2, .03, .11, .4, .1};
  (void)state;
  for (int k = 0; k < ALL; k++) {
    Parts *p = lab_parts(2, 3, GAS);
    char name[64];
    Param par = lab_param("gravity.method=none", "damping.rate=1", "step.acceleration=2",
                          "step.cfl=2", "step.error=1", setting(k, name, sizeof name), NULL);
    Decay d = {1, -1, 0};
    Sim sim;
    SimStep done;
    Err err;
    double before = 0;
    size_t row = 0;
    while (row < sizeof schemes / sizeof *schemes && strcmp(schemes[row].name, name + 11)) row++;
    assert_true(row < sizeof schemes / sizeof *schemes);
    for (int i = 0; i < 2; i++)
      p->x[3 * i] = i ? 1e6 : -1e6, p->v[3 * i] = i ? 1 : -1, p->m[i] = p->rho[i] = 1,
               p->h[i] = 1e3, p->u[i] = 1e-3;
    lab_open(&sim, &par, p);
    for (size_t s = 0; s < sizeof steps / sizeof *steps; s++) {
      sim.par.step_max = steps[s], sim.dt = INFINITY;
      if (sim_advance(&sim, 1e9, &done, &err)) fail_msg("%s", err.text);
      assert_true(done.dt == steps[s]);
      schemes[row].step(&d, steps[s], before > 0 ? steps[s] / before : 0);
      before = steps[s];
    }
    lab_store(&sim, p);
    print_message("%s: v %.12f (%.12f)\n", name, p->v[3], d.v);
    assert_true(fabs(p->v[3] / d.v - 1) < 1e-13 && fabs(p->v[0] / d.v + 1) < 1e-13);
    sim_close(&sim);
    part_free(p);
  }
}

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* Two elastic balls that meet off centre. */
static Parts *balls(void)
{
  double dx = .36;
  long n = lab_lattice(dx, 4, 3, in_ball, NULL, NULL);
  Parts *p = lab_parts(2 * n, 3, RUBBER);
  for (int b = 0; b < 2; b++) lab_lattice(dx, 4, 3, in_ball, NULL, p->x + 3 * n * b);
  for (long i = 0; i < p->n; i++) {
    double side = i < n ? -1 : 1;
    p->x[3 * i] += 1.2 * side, p->x[3 * i + 1] += .4 * side, p->v[3 * i] = -.1 * side;
    p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.2 * dx, p->body[i] = i >= n;
  }
  return p;
}

/* Momentum to rounding, mass exactly; energy and angular momentum with steps of 1/40 of the CFL
 * limit: to the error of the scheme, of first order for Euler's. */
static void collision(void **state)
{
  (void)state;
  for (int k = 0; k < ALL; k++) {
    Parts *p = balls();
    char name[64];
    const int first = integrator_of(k)->order == 1;
    Param par = lab_param("gravity.method=none", "smoothing.mode=fixed", "precision=double",
                          "step.error=1", "step.cfl=0.1", setting(k, name, sizeof name), NULL);
    Sums a, b;
    Sim sim;
    double l = 0, m = 0, e;
    long steps;
    lab_open(&sim, &par, p);
    lab_sums(&sim, &a);
    steps = lab_run(&sim, 3);
    lab_sums(&sim, &b);
    for (int d = 0; d < 3; d++)
      m = fmax(m, fabs(b.momentum[d])), l = fmax(l, fabs(b.angular[d] - a.angular[d]));
    e = (b.kinetic + b.internal - a.kinetic - a.internal) / a.kinetic;
    print_message("%s: %ld steps, p %.1e, L %.1e, E %.1e, kinetic %.2f\n", name, steps,
                  m / b.scale_momentum, l / fabs(a.angular[2]), e, b.kinetic / a.kinetic);
    assert_true(m < 1e-13 * b.scale_momentum && b.mass == a.mass);
    assert_true(b.kinetic < .95 * a.kinetic);
    assert_true(l < (first ? 1e-2 : 1e-4) * fabs(a.angular[2]));
    assert_true(fabs(e) < (first ? 5e-2 : 1e-3));
    sim_close(&sim);
    part_free(p);
  }
}

/* A ball that expands; 3 to 9 flaws of a particle open soon, `shut` others never. */
static Parts *tearing(int shut)
{
  double dx = .36;
  long n = lab_lattice(dx, 4, 3, in_ball, NULL, NULL);
  Parts *p = lab_parts(n, 3, ROCK);
  lab_lattice(dx, 4, 3, in_ball, NULL, p->x);
  p->nflaw = malloc(sizeof *p->nflaw * (size_t)n);
  p->flaw = malloc(sizeof *p->flaw * (size_t)(9 + shut) * (size_t)n);
  for (long i = 0; i < n; i++) {
    int open = 3 + (int)(i % 7);
    for (int d = 0; d < 3; d++) p->v[3 * i + d] = .05 * p->x[3 * i + d];
    p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.2 * dx, p->nflaw[i] = open + shut;
    for (int k = 0; k < open + shut; k++) p->flaw[p->flaws++] = k < open ? 1e-4 : 10;
  }
  return p;
}

/* D reaches its limit, also where D^(1/3) grows by 0.1 to 0.4 a step and a stage of the step
 * therefore meets the limit first. */
static void crack(void **state)
{
  (void)state;
  for (int k = 0; k < ALL; k++)
    for (int shut = 0; shut <= 2; shut += 2) {
      Parts *p = tearing(shut);
      char name[64];
      Param par = lab_param("gravity.method=none", "precision=double", "step.error=1",
                            setting(k, name, sizeof name), NULL);
      double short_of = 0;
      long steps;
      Sim sim;
      lab_open(&sim, &par, p);
      steps = lab_run(&sim, 1.2);
      lab_store(&sim, p);
      for (long i = 0; i < p->n; i++)
        short_of = fmax(short_of, fabs(1 - (double)shut / p->nflaw[i] - p->damage[i]));
      print_message("%s: %ld steps, %d flaws shut, D misses its limit by %.1e at most\n", name,
                    steps, shut, short_of);
      assert_true(short_of < 1e-14);
      sim_close(&sim);
      part_free(p);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(decay), cmocka_unit_test(collision),
                                     cmocka_unit_test(crack)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
