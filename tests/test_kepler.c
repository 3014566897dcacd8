/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two point masses on a Kepler orbit: m = 1/2 each, G = 1, a = 1, e = 0.5,
 * ten orbits of 2 pi. rk2-adaptive at step.error 1e-8 keeps the energy to 1e-6 and the apsis to
 * 1e-4 rad an orbit; leapfrog is of second order in both. */
#include <omp.h>
#include "lab.h"

static const char DUST[] = "name = \"dust\"; eos = { form = \"ideal\"; gamma = 1.4; };";

typedef struct {
  double energy, apsis, momentum, angular; /* relative; rad an orbit; relative */
  long steps;
} Drift;

/* At the apocentre, r = 1 + e, v = sqrt((1-e)/(1+e)); the softening ends at h = 0.1, the
 * pericentre is at 0.5. */
static Parts *binary(double e)
{
  Parts *p = lab_parts(2, 3, DUST);
  for (int k = 0; k < 2; k++) {
    p->x[3 * k] = (k ? -.5 : .5) * (1 + e);
    p->v[3 * k + 1] = (k ? -.5 : .5) * sqrt((1 - e) / (1 + e));
    p->m[k] = .5, p->rho[k] = 1, p->u[k] = 1, p->h[k] = .1;
  }
  return p;
}

/* The direction of the pericentre from the relative state: of the vector v x L - r/r. */
static double apsis(const Parts *p)
{
  int a = p->id[0] == 0 ? 0 : 1, b = 1 - a;
  double x = p->x[3 * a] - p->x[3 * b], y = p->x[3 * a + 1] - p->x[3 * b + 1];
  double u = p->v[3 * a] - p->v[3 * b], w = p->v[3 * a + 1] - p->v[3 * b + 1];
  double l = x * w - y * u, r = sqrt(x * x + y * y);
  return atan2(-u * l - y / r, w * l - x / r);
}

/* Kinetic and potential energy of the particles as they are. */
static double energy(const Parts *p)
{
  double v2 = 0, r2 = 0;
  for (int d = 0; d < 3; d++) {
    v2 += p->v[d] * p->v[d] + p->v[3 + d] * p->v[3 + d];
    r2 += (p->x[d] - p->x[3 + d]) * (p->x[d] - p->x[3 + d]);
  }
  return .25 * v2 - .25 / sqrt(r2);
}

static Drift orbit(double e, double orbits, const char *integrator, const char *error, double dt,
                   const char *method)
{
  char max[64];
  Parts *p = binary(e);
  Param par;
  Sim sim;
  Sums a, b;
  Drift d;
  double turn;
  snprintf(max, sizeof max, "step.max=%.17g", dt);
  par = lab_param("gravity.G=1", "precision=double", method, "smoothing.mode=fixed", "step.cfl=2",
                  "step.acceleration=2", integrator, error, max, NULL);
  turn = apsis(p);
  lab_open(&sim, &par, p);
  lab_sums(&sim, &a);
  assert_true(fabs(a.kinetic + a.potential + .125) < 1e-14); /* -m1 m2/2a */
  assert_true(fabs(energy(p) + .125) < 1e-15);
  d.steps = lab_run(&sim, 2 * LAB_PI * orbits);
  lab_sums(&sim, &b);
  lab_store(&sim, p);
  turn = apsis(p) - turn;
  d.energy = fabs(energy(p) / .125 + 1);
  d.apsis = fabs(atan2(sin(turn), cos(turn))) / orbits;
  d.momentum = fabs(b.momentum[0]) + fabs(b.momentum[1]) + fabs(b.momentum[2]);
  d.angular = fabs(b.angular[2] / a.angular[2] - 1);
  print_message("%s %s: %ld steps, energy %.1e, apsis %.1e rad/orbit, p %.1e, L %.1e\n", integrator,
                method, d.steps, d.energy, d.apsis, d.momentum, d.angular);
  sim_close(&sim);
  part_free(p);
  return d;
}

static void runge_kutta(void **state)
{
  static const char *const methods[] = {"gravity.method=direct", "gravity.method=tree"};
  (void)state;
  for (int k = 0; k < 2; k++) {
    Drift d = orbit(.5, 10, "integrator=rk2-adaptive", "step.error=1e-8", 0, methods[k]);
    assert_true(d.energy < 1e-6);
    assert_true(d.apsis < 1e-4);
    assert_true(d.momentum < 1e-13);
  }
}

/* The step follows the error: far fewer steps at a looser tolerance, and a larger drift. */
static void tolerance(void **state)
{
  Drift fine, coarse;
  (void)state;
  fine = orbit(.5, 1, "integrator=rk2-adaptive", "step.error=1e-7", 0, "gravity.method=direct");
  coarse = orbit(.5, 1, "integrator=rk2-adaptive", "step.error=1e-4", 0, "gravity.method=direct");
  assert_true(fine.steps > 5 * coarse.steps);
  assert_true(fine.energy < .01 * coarse.energy);
}

/* Each of three runs has half the step of the one before. */
static void apsis_of_second_order(const Drift d[3])
{
  for (int k = 0; k < 2; k++) {
    double order = log(d[k].apsis / d[k + 1].apsis) / log(2);
    print_message("order of the apsis %.3f\n", order);
    assert_true(fabs(order - 2) < .05);
  }
}

/* Fixed steps: the apsis turns as dt^2; energy comes back after whole orbits; L is kept to
 * rounding. */
static void leapfrog(void **state)
{
  Drift d[3];
  (void)state;
  for (int k = 0; k < 3; k++) {
    double dt = 2 * LAB_PI / (500 << k);
    d[k] = orbit(.5, 10, "integrator=leapfrog", "step.error=1", dt, "gravity.method=direct");
    assert_true(d[k].momentum < 1e-13 && d[k].angular < 1e-12);
  }
  apsis_of_second_order(d);
  assert_true(d[2].apsis < 2e-4 && d[2].energy < 1e-6);
}

/* Gravity every fourth step, and at log lines (every tenth): still of second order in all, with the
 * errors of a step four times as long at most. */
static void every_fourth_step(void **state)
{
  Drift d[3];
  (void)state;
  for (int k = 0; k < 3; k++) {
    double dt = 2 * LAB_PI / (2000 << k);
    d[k] = orbit(.5, 10, "integrator=leapfrog", "gravity.every=4", dt, "gravity.method=direct");
    assert_true(d[k].momentum < 1e-13 && d[k].angular < 1e-12);
  }
  apsis_of_second_order(d);
  Drift coarse = orbit(.5, 10, "integrator=leapfrog", "step.error=1", 2 * LAB_PI / 500,
                       "gravity.method=direct");
  assert_true(d[0].apsis < 1.05 * coarse.apsis && d[0].energy < 1e-5);
}

/* The sums of a row are of one instant, the state's own, however long the steps; and asking for
 * them changes no bit of the orbit. */
static void one_instant(void **state)
{
  static const char *const methods[] = {"gravity.method=direct", "gravity.method=tree"};
  static const char *const integrators[] = {"integrator=rk2-adaptive", "integrator=leapfrog"};
  (void)state;
  for (int k = 0; k < 4; k++) {
    Param par =
        lab_param("gravity.G=1", "precision=double", methods[k / 2], "smoothing.mode=fixed",
                  "step.cfl=2", "step.acceleration=2", integrators[k % 2], "step.error=1e-2", NULL);
    Parts *p = binary(.5), *q = binary(.5);
    Sim asked, alone;
    double worst = 0;
    lab_open(&asked, &par, p), lab_open(&alone, &par, q);
    for (int n = 0; n < 40; n++) {
      Err err;
      SimStep done;
      Sums s;
      assert_return_code(sim_advance(&asked, 1e9, &done, &err), 0);
      assert_return_code(sim_advance(&alone, 1e9, &done, &err), 0);
      lab_sums(&asked, &s);
      lab_store(&asked, p);
      worst = fmax(worst, fabs(s.kinetic + s.potential - energy(p)));
    }
    lab_store(&alone, q);
    print_message("%s %s: to t = %.3f, energies differ by %.1e\n", integrators[k % 2],
                  methods[k / 2], asked.time, worst);
    assert_true(worst < 1e-14);
    assert_true(asked.time == alone.time && asked.time > 1);
    assert_memory_equal(p->x, q->x, 6 * sizeof *p->x);
    assert_memory_equal(p->v, q->v, 6 * sizeof *p->v);
    sim_close(&asked), sim_close(&alone);
    part_free(p), part_free(q);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(runge_kutta), cmocka_unit_test(tolerance), cmocka_unit_test(leapfrog),
      cmocka_unit_test(every_fourth_step), cmocka_unit_test(one_instant)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
