/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gravity.every: a star that falls together and bounces. Against the run with gravity in each step
 * the error goes as (k^2 - 1) dt^2; energy is kept as well; whatever the steps are, what is looked
 * at is of one instant. */
#include <omp.h>
#include "lab.h"

static const char GAS[] =
    "name = \"gas\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };";

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

static Parts *star(void)
{
  const double dx = .31;
  Parts *p = lab_parts(lab_lattice(dx, 4, 3, in_ball, NULL, NULL), 3, GAS);
  lab_lattice(dx, 4, 3, in_ball, NULL, p->x);
  for (long i = 0; i < p->n; i++) p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.2 * dx;
  return p;
}

/* Falls until t = 1.2 with some outputs; the energy that is lost, over the largest kinetic one. */
static double fall(Parts *p, const char *every, const char *most, int outputs)
{
  Param par = lab_param("gravity.G=0.2", "gravity.method=direct", "precision=double",
                        "smoothing.mode=fixed", "viscosity.alpha=0", "viscosity.beta=0",
                        "output.log_every=48", every, most, NULL);
  Sim sim;
  Sums s;
  double first, top = 0, last = 0;
  lab_open(&sim, &par, p);
  lab_sums(&sim, &s);
  first = s.kinetic + s.internal + s.potential;
  for (int k = 1; k <= outputs; k++) {
    lab_run(&sim, 1.2 * k / outputs);
    lab_sums(&sim, &s);
    top = fmax(top, s.kinetic), last = s.kinetic + s.internal + s.potential;
  }
  lab_store(&sim, p);
  sim_close(&sim);
  return fabs(last - first) / top;
}

static double apart(const Parts *p, const Parts *q)
{
  double sum = 0;
  for (long i = 0; i < 3 * p->n; i++) sum += pow(p->x[i] - q->x[i], 2) + pow(p->v[i] - q->v[i], 2);
  return sqrt(sum / (double)p->n);
}

/* Fixed steps: twice the time between evaluations, 2^2 - 1 = 3 and 4^2 - 1 = 15. */
static void second_order(void **state)
{
  static const char *const every[] = {"gravity.every=1", "gravity.every=2", "gravity.every=4"};
  Parts *p[3];
  (void)state;
  for (int k = 0; k < 3; k++) p[k] = star(), fall(p[k], every[k], "step.max=0.005", 1);
  double two = apart(p[1], p[0]), four = apart(p[2], p[0]);
  print_message("every 2: %.2e, every 4: %.2e\n", two, four);
  assert_true(two > 0 && four / two > 4 && four / two < 6);
  for (int k = 0; k < 3; k++) part_free(p[k]);
}

/* Steps as the limits have them, which change all the time. */
static void energy_is_kept(void **state)
{
  static const char *const every[] = {"gravity.every=1", "gravity.every=3", "gravity.every=8"};
  double lost[3];
  (void)state;
  for (int k = 0; k < 3; k++) {
    Parts *p = star();
    lost[k] = fall(p, every[k], "step.cfl=0.02", 3);
    part_free(p);
  }
  print_message("energy lost: %.1e, %.1e, %.1e of the largest kinetic energy\n", lost[0], lost[1],
                lost[2]);
  assert_true(lost[0] < 5e-4 && lost[1] < 2e-3 && lost[2] < 1.5e-2);
}

/* gravity.tolerance: the largest change of gravity from one evaluation to the next, over its mean
 * size, made here from what is stored; evaluations and steps. */
static double by_tolerance(Parts *p, const char *tolerance, long *evaluations, long *steps)
{
  Param par = lab_param("gravity.G=0.2", "gravity.method=direct", "precision=double",
                        "smoothing.mode=fixed", "viscosity.alpha=0", "viscosity.beta=0",
                        "output.log_every=1000", "gravity.every=200", "step.cfl=0.02", NULL);
  double worst = 0, *before = malloc(3 * (size_t)p->n * sizeof *before);
  Sim sim;
  Err err;
  SimStep done;
  lab_set(&par, tolerance);
  lab_open(&sim, &par, p);
  lab_store(&sim, p);
  assert_non_null(before);
  memcpy(before, p->pull, 3 * (size_t)p->n * sizeof *before);
  for (*evaluations = *steps = 0; sim.time < 1.2; ++*steps) {
    double most = 0, square = 0;
    if (sim_advance(&sim, 1.2, &done, &err)) fail_msg("%s", err.text);
    if (sim.outer > 0) continue;
    lab_store(&sim, p);
    for (long i = 0; i < p->n; i++) {
      double change = 0;
      for (int d = 0; d < 3; d++)
        change += pow(p->pull[3 * i + d] - before[3 * i + d], 2),
            square += pow(p->pull[3 * i + d], 2);
      most = fmax(most, change);
    }
    most = sqrt(most / (square / (double)p->n)); /* equal masses */
    if (*tolerance) assert_true(fabs(sim.pull_change - most) < 1e-12 + 1e-9 * most);
    if (sim.outer_span > 0) worst = fmax(worst, most);
    memcpy(before, p->pull, 3 * (size_t)p->n * sizeof *before);
    ++*evaluations;
  }
  free(before);
  sim_close(&sim);
  return worst;
}

static void tolerance_is_kept(void **state)
{
  static const char *const tolerance[] = {"gravity.tolerance=0.1", "gravity.tolerance=0.02"};
  Parts *exact = star(), *p[2];
  long evaluations[2], steps;
  double error[2], worst[2];
  (void)state;
  fall(exact, "gravity.every=1", "step.cfl=0.02", 1);
  for (int k = 0; k < 2; k++) {
    p[k] = star();
    worst[k] = by_tolerance(p[k], tolerance[k], &evaluations[k], &steps);
    error[k] = apart(p[k], exact);
    print_message("%s: %ld evaluations in %ld steps, change %.3g, error %.1e\n", tolerance[k],
                  evaluations[k], steps, worst[k], error[k]);
    part_free(p[k]);
  }
  part_free(exact);
  assert_true(worst[0] < .1 && worst[1] < .02);
  assert_true(2 * evaluations[0] < evaluations[1] && 3 * evaluations[1] < steps);
  assert_true(error[0] < .01 && error[1] < .2 * error[0]);
}

/* A run goes on with the same bits from wherever it stands between two evaluations. */
static void restart(void **state)
{
  Param par = lab_param("gravity.G=0.2", "smoothing.mode=fixed", "output.log_every=1000",
                        "gravity.every=200", "gravity.tolerance=0.1", "step.cfl=0.02", NULL);
  Parts *p = star();
  Sim sim;
  Err err;
  SimStep done;
  int fresh = 0;
  (void)state;
  lab_open(&sim, &par, p);
  for (int n = 0; n < 120; n++) assert_return_code(sim_advance(&sim, 1.2, &done, &err), 0);
  for (int n = 0; n < 16; n++) {
    Parts *q = star();
    Sim again;
    lab_store(&sim, q);
    fresh += sim.outer == 0;
    if (sim_restart(&again, &par, q, lab_device(), &err)) fail_msg("%s", err.text);
    assert_return_code(sim_advance(&again, 1.2, &done, &err), 0);
    assert_return_code(sim_advance(&sim, 1.2, &done, &err), 0);
    assert_true(again.outer_steps == sim.outer_steps && again.outer == sim.outer);
    lab_store(&again, q), lab_store(&sim, p);
    assert_memory_equal(p->x, q->x, 3 * (size_t)p->n * sizeof *p->x);
    sim_close(&again);
    part_free(q);
  }
  assert_true(fresh > 0 && fresh < 16);
  sim_close(&sim);
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(restart), cmocka_unit_test(tolerance_is_kept),
                                     cmocka_unit_test(second_order),
                                     cmocka_unit_test(energy_is_kept)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
