/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Point masses and what leaves a run, on the CUDA backend against the CPU's. Runs on a device, and
 * on the host (tests/host). */
#include "lab.h"
#include "small.h"

static const char GAS[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* A ball of gas that falls towards two masses. */
static Parts *fall(void)
{
  const double dx = .31;
  Parts *p = lab_parts(lab_lattice(dx, 4, 3, in_ball, NULL, NULL), 3, GAS);
  lab_lattice(dx, 4, 3, in_ball, NULL, p->x);
  for (long i = 0; i < p->n; i++) {
    p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.2 * dx, p->u[i] = .5;
    p->x[3 * i] += 3, p->v[3 * i + 1] = .6;
  }
  p->point = calloc(2, sizeof *p->point), p->points = 2;
  assert_non_null(p->point);
  p->point[0] = (PointMass){.m = 50, .h = .5};
  p->point[1] = (PointMass){.m = 5, .x = {-9, 0, 0}, .v = {0, -.7, 0}};
  return p;
}

static void open_both(Sim sim[2], const Param *par, const Parts *p)
{
  static const char *const device[] = {"cpu", "cuda"};
  Err err;
  for (int k = 0; k < 2; k++)
    if (sim_open(&sim[k], par, p, device[k], &err)) fail_msg("%s", err.text);
}

static void near(const double *a, const double *b, long n, double tolerance, const char *what)
{
  double size = 0;
  for (long k = 0; k < n; k++) size = fmax(size, fabs(a[k]));
  for (long k = 0; k < n; k++)
    if (!(fabs(a[k] - b[k]) <= tolerance * size))
      fail_msg("%s: %.17g and %.17g at %ld", what, a[k], b[k], k);
}

/* Both exchange the same pulls, and both keep momentum. */
static void exchange(void **state)
{
  Parts *p = fall(), *q = fall();
  Param par = lab_param("gravity.G=0.1", "precision=double", "gravity.method=none", NULL);
  Sim sim[2];
  Sums a, b;
  (void)state;
  open_both(sim, &par, p);
  lab_sums(&sim[1], &a);
  for (int k = 0; k < 2; k++) lab_run(&sim[k], .05);
  lab_sums(&sim[1], &b);
  for (int d = 0; d < 3; d++)
    assert_true(fabs(b.momentum[d] - a.momentum[d]) < 1e-14 * b.scale_momentum);
  lab_store(&sim[0], p), lab_store(&sim[1], q);
  assert_int_equal(q->points, 2);
  for (int k = 0; k < 2; k++) {
    near(p->point[k].x, q->point[k].x, 3, 1e-13, "position");
    near(p->point[k].v, q->point[k].v, 3, 1e-13, "velocity");
    near(p->point[k].a, q->point[k].a, 3, 1e-12, "acceleration");
  }
  near(p->x, q->x, 3 * p->n, 1e-12, "positions");
  near(p->a, q->a, 3 * p->n, 1e-11, "accelerations");
  near(&sim[0].points.energy, &sim[1].points.energy, 1, 1e-13, "energy");
  sim_close(&sim[0]), sim_close(&sim[1]);
  part_free(p), part_free(q);
}

/* Looks after each step; how many have left. */
static long run_and_leave(Sim *sim, Parts *p, double until)
{
  const long n = sim->s.n;
  Err err;
  SimStep done;
  while (sim->time < until) {
    LeaveFound found;
    Parts *gone[2];
    if (sim_advance(sim, until, &done, &err) || leave_find(sim, &found, &err))
      fail_msg("%s", err.text);
    if (!found.where) continue;
    if (leave_take(sim, &found, p, &gone[0], &gone[1], &err)) fail_msg("%s", err.text);
    part_free(gone[0]), part_free(gone[1]);
  }
  lab_store(sim, p);
  return n - sim->s.n;
}

/* The same particles leave both, and what is left is the same, in the same rows. */
static void leaving(void **state)
{
  static const char *const integrators[] = {"integrator=leapfrog", "integrator=rk2-adaptive"};
  (void)state;
  for (int k = 0; k < small_or(2, 1); k++) {
    Parts *p = fall(), *q = fall();
    Param par = lab_param("gravity.G=0.1", "precision=double", "gravity.method=direct",
                          integrators[k], "step.max=0.05", "escape.distance=6",
                          "escape.unbound=false", "escape.every=2", NULL);
    Sim sim[2];
    p->point[0].radius = 2.5;
    open_both(sim, &par, p);
    const long n = run_and_leave(&sim[0], p, 1), m = run_and_leave(&sim[1], q, 1);
    print_message("%ld of %ld leave\n", n, n + p->n);
    assert_true(n == m && n > 5 && p->n > 20 && q->n == p->n);
    assert_true(sim[1].gone.accreted == sim[0].gone.accreted && sim[0].gone.accreted > 0);
    assert_memory_equal(p->id, q->id, (size_t)p->n * sizeof *p->id);
    near(p->x, q->x, 3 * p->n, 1e-10, "positions");
    near(p->v, q->v, 3 * p->n, 1e-9, "velocities");
    near(p->point[0].x, q->point[0].x, 3, 1e-10, "place of the sink");
    near(p->point[0].spin, q->point[0].spin, 3, 1e-10, "spin of the sink");
    sim_close(&sim[0]), sim_close(&sim[1]);
    part_free(p), part_free(q);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(exchange), cmocka_unit_test(leaving)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
