/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Self-gravity softened by one length, in runs: two bodies turn around each other, within the
 * softening, at the rate of its pull; a cold cluster falls through itself and keeps the energy that
 * is the sum over its pairs (docs/theory.md 4). */
#include <omp.h>
#include "../lib/rng.h"
#include "../physics/softening.h"
#include "lab.h"

static const char DUST[] = "name = \"dust\"; eos = { form = \"ideal\"; gamma = 1.4; };";
static const double EPSILON = 0.5;
static const char *const SOFTENING[] = {"gravity.softening=spline", "gravity.softening=plummer"};

/* Of a pair at distance r, G = m = 1: a/r, and -phi. */
static double pull_of(int plummer, double r, double *depth)
{
  const double s = fmax(r, 3 * EPSILON), q = fmin(r / (3 * EPSILON), 1), d = hypot(r, EPSILON);
  *depth = plummer ? 1 / d : softening_potential(q) / s;
  return plummer ? 1 / (d * d * d) : softening_force(q) / (s * s * s);
}

static Param settings(const char *method, const char *softening)
{
  return lab_param("gravity.G=1", "gravity.epsilon=0.5", "precision=double", "smoothing.mode=fixed",
                   "step.cfl=2", "step.acceleration=2", "gravity.theta=0.5", method, softening,
                   NULL);
}

/* A circle of radius 0.3 each: after one turn all is where it was. The potential energy is that of
 * the pair. */
static void two_bodies(void **state)
{
  (void)state;
  for (int plummer = 0; plummer < 2; plummer++) {
    Parts *p = lab_parts(2, 3, DUST);
    Param par = settings("gravity.method=direct", SOFTENING[plummer]);
    Sim sim;
    Sums a, b;
    double depth, rate = sqrt(2 * pull_of(plummer, .6, &depth)), far = 0;
    for (int k = 0; k < 2; k++)
      p->x[3 * k] = k ? .3 : -.3, p->v[3 * k + 1] = (k ? .3 : -.3) * rate, p->m[k] = 1,
               p->rho[k] = 1, p->u[k] = 1e-6, p->h[k] = .1;
    par.step_max = 2 * LAB_PI / rate / 500;
    lab_open(&sim, &par, p), lab_sums(&sim, &a);
    assert_true(fabs(a.potential + depth) < 1e-14);
    lab_run(&sim, 2 * LAB_PI / rate), lab_sums(&sim, &b), lab_store(&sim, p);
    for (int k = 0; k < 2; k++) {
      const double side = p->id[k] ? .3 : -.3;
      far = fmax(far, hypot(p->x[3 * k] - side, p->x[3 * k + 1]));
    }
    print_message("%s: off by %.1e, energy %.1e\n", SOFTENING[plummer], far,
                  (b.potential + b.kinetic) / (a.potential + a.kinetic) - 1);
    assert_true(far < 1e-4);
    assert_true(fabs((b.potential + b.kinetic) / (a.potential + a.kinetic) - 1) < 1e-6);
    sim_close(&sim), part_free(p);
  }
}

/* 150 bodies at rest in a ball of radius 1. */
static Parts *cluster(void)
{
  Parts *p = lab_parts(150, 3, DUST);
  for (long i = 0; i < p->n; i++) {
    const double r = cbrt(rng_uniform(1, (uint64_t)i, 0)),
                 z = 2 * rng_uniform(1, (uint64_t)i, 1) - 1,
                 f = 2 * LAB_PI * rng_uniform(1, (uint64_t)i, 2);
    p->x[3 * i] = r * sqrt(1 - z * z) * cos(f), p->x[3 * i + 1] = r * sqrt(1 - z * z) * sin(f);
    p->x[3 * i + 2] = r * z, p->m[i] = 1. / (double)p->n, p->h[i] = 1e-4;
    p->rho[i] = p->m[i] * 21 / (2 * LAB_PI) * 1e12, p->u[i] = 1e-12;
  }
  return p;
}

/* By pairs. */
static double potential_of(const Parts *p, int plummer)
{
  double sum = 0, depth;
  for (long i = 0; i < p->n; i++)
    for (long j = 0; j < i; j++) {
      const double *x = p->x + 3 * i, *y = p->x + 3 * j;
      pull_of(plummer, hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]), &depth);
      sum -= p->m[i] * p->m[j] * depth;
    }
  return sum;
}

/* To a little after the centre has been crossed: with direct sums momentum stays at rounding, with
 * the tree the sums differ by its errors. */
static void cold_cluster(void **state)
{
  static const char *const method[] = {"gravity.method=direct", "gravity.method=tree"};
  (void)state;
  for (int k = 0; k < 4; k++) {
    const int plummer = k / 2, tree = k % 2;
    Parts *p = cluster();
    Param par = settings(method[tree], SOFTENING[plummer]);
    Sim sim;
    Sums a, b;
    par.step_max = .01;
    lab_open(&sim, &par, p), lab_sums(&sim, &a);
    assert_true(fabs(a.potential / potential_of(p, plummer) - 1) < (tree ? 1e-3 : 1e-12));
    lab_run(&sim, 1.5), lab_sums(&sim, &b), lab_store(&sim, p);
    const double drift = (b.potential + b.kinetic + b.internal) / a.potential - 1;
    const double left = hypot(hypot(b.momentum[0], b.momentum[1]), b.momentum[2]);
    print_message("%s, %s: %ld steps, energy %.1e, kinetic %.2f, p %.1e\n", method[tree],
                  SOFTENING[plummer], sim.step, drift, b.kinetic / -a.potential, left);
    assert_true(b.kinetic > .2 * -a.potential && fabs(drift) < 1e-4 && left < 1e-14);
    assert_true(fabs(b.potential / potential_of(p, plummer) - 1) < (tree ? 1e-3 : 1e-12));
    sim_close(&sim), part_free(p);
  }
}

int main(void)
{
  omp_set_num_threads(1);
  const struct CMUnitTest tests[] = {cmocka_unit_test(two_bodies), cmocka_unit_test(cold_cluster)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
