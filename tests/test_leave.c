/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What leaves a run: sinks keep mass, momentum, angular momentum to rounding; escapees are booked
 * with all they had; rows stay in order; a run that goes on from a checkpoint has the same bits. */
#include <omp.h>
#include <unistd.h>
#include "lab.h"
#include "../lib/snap.h"
#include "../solver/archive.h"

static const char GAS[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* A turning ball of gas that falls on a moving sink; two particles on their way out; rows in an
 * order of their own. */
static Parts *cloud(double radius)
{
  const double dx = .31;
  const long n = lab_lattice(dx, 4, 3, in_ball, NULL, NULL);
  Parts *p = lab_parts(n, 3, GAS);
  double *x = malloc(3 * (size_t)n * sizeof *x);
  assert_non_null(x);
  lab_lattice(dx, 4, 3, in_ball, NULL, x);
  for (long i = 0; i < n; i++) {
    const double *q = &x[3 * ((i * 37) % n)];
    p->id[i] = 5000 - i;
    p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.2 * dx, p->u[i] = .05;
    for (int d = 0; d < 3; d++) p->x[3 * i + d] = q[d];
    p->v[3 * i] = -.3 * q[1] - .1, p->v[3 * i + 1] = .3 * q[0];
  }
  for (long i = 3; i < n; i += n / 2) p->x[3 * i + 1] += 5, p->v[3 * i + 1] = 4;
  free(x);
  p->point = calloc(1, sizeof *p->point), p->points = 1;
  assert_non_null(p->point);
  p->point[0] = (PointMass){.m = 3, .x = {.1, 0, 0}, .v = {.1, 0, .2}, .radius = radius};
  return p;
}

static Param settings(const char *integrator, const char *more)
{
  Param par = lab_param("gravity.G=0.3", "precision=double", "gravity.method=direct",
                        "smoothing.mode=fixed", "step.max=0.02", integrator, NULL);
  lab_set(&par, more);
  return par;
}

static void step(Sim *sim)
{
  Err err;
  SimStep done;
  if (sim_advance(sim, 1e9, &done, &err)) fail_msg("%s", err.text);
}

/* What leaves after a step; the number. */
static long look(Sim *sim, Parts *p, Archive *a)
{
  const long n = sim->s.n;
  Err err;
  LeaveFound found;
  Parts *gone[ARCHIVES];
  if (leave_find(sim, &found, &err)) fail_msg("%s", err.text);
  if (!found.where) return 0;
  if (leave_take(sim, &found, p, &gone[0], &gone[1], &err)) fail_msg("%s", err.text);
  for (int k = 0; k < ARCHIVES; k++)
    if (archive_add(a, k, gone[k], &err)) fail_msg("%s", err.text);
  assert_true(found.leaving == n - sim->s.n && p->n == sim->s.n);
  return n - sim->s.n;
}

static long go(Sim *sim, Parts *p, Archive *a)
{
  step(sim);
  return look(sim, p, a);
}

/* Mass, momentum, angular momentum, energy: of what is there and what has gone. */
static void totals(Sim *sim, double t[8], double scale[8])
{
  Sums s;
  lab_sums(sim, &s);
  t[0] = s.mass + sim->gone.mass, scale[0] = t[0];
  for (int d = 0; d < 3; d++) {
    t[1 + d] = s.momentum[d] + sim->gone.momentum[d], scale[1 + d] = s.scale_momentum;
    t[4 + d] = s.angular[d] + sim->gone.angular[d], scale[4 + d] = s.scale_angular;
  }
  t[7] = s.kinetic + s.internal + s.potential + sim->gone.energy, scale[7] = s.kinetic;
}

static void books_are_closed(void **state)
{
  static const char *const more[] = {"escape.distance=2 escape.every=3",
                                     "escape.distance=2 sink.rule=bound sink.every=2",
                                     "escape.distance=2 escape.from=point escape.unbound=false",
                                     "escape.distance=2 escape.from=deepest"};
  (void)state;
  for (int k = 0; k < 4; k++)
    for (int fixed = 0; fixed < 2; fixed++) {
      Parts *p = cloud(.5);
      Param par = settings("integrator=leapfrog", more[k]);
      Archive a = {0};
      Sim sim;
      long left = 0;
      double worst = 0, first[8], last[8], scale[8], before[8];
      if (fixed) p->point[0].fixed = 1, memset(p->point[0].v, 0, sizeof p->point[0].v);
      lab_open(&sim, &par, p);
      totals(&sim, first, scale);
      for (int n = 0; n < 25; n++) {
        totals(&sim, before, scale);
        const long now = go(&sim, p, &a);
        left += now;
        totals(&sim, last, scale);
        for (int d = 1; d < 7 && !fixed; d++)
          assert_true(fabs(last[d] - before[d]) < 1e-14 * scale[d]);
        if (!now) /* else gas was close to the bare mass within the step */
          worst = fmax(worst, fabs(last[7] - before[7]) / scale[7]);
      }
      print_message("%s%s: %ld left, %g escaped, %g in the sink, spin %.3g, E %.1e a step\n",
                    more[k], fixed ? ", fixed" : "", left, sim.gone.escaped, sim.gone.accreted,
                    sim.points.p[0].spin[2], worst);
      assert_true(fabs(last[0] - first[0]) < 1e-14 * first[0]);
      assert_true(k == 1 || worst < 1e-3); /* 1: the sink lets gas pass close by */
      assert_true(sim.gone.escaped >= 2 && sim.gone.accreted > 3);
      assert_true(sim.points.p[0].count == (int64_t)sim.gone.accreted);
      assert_true(fabs(sim.points.p[0].m - 3 - sim.points.p[0].taken) < 1e-13);
      assert_true(left == (long)(sim.gone.escaped + sim.gone.accreted));
      lab_store(&sim, p);
      for (long i = 1; i < p->n; i++) assert_true(p->id[i] < p->id[i - 1]); /* rows in order */
      sim_close(&sim);
      archive_free(&a);
      part_free(p);
    }
}

/* The particles in the pieces of an archive. */
static double kept(const Archive *a, int which)
{
  double n = 0;
  for (int k = 0; k < a->list[which].pieces; k++) n += (double)a->list[which].piece[k]->n;
  return n;
}

/* Every integrator in an open, a periodic and a mirrored box: what leaves takes nothing with it but
 * what is booked, the steps between keep momentum where no mirror takes it up, nobody is lost. */
static void faces_and_integrators(void **state)
{
  static const char *const boxes[] = {
      "gravity.method=none", "boundary.x=periodic boundary.low=-1.1,-1.1,0 boundary.high=1.1,9,0",
      "boundary.x=mirror boundary.y=mirror_low boundary.low=-1.1,-1.1,0 boundary.high=1.1,9,0"};
#define INTEGRATOR(WORD, NAME) "integrator=" WORD,
  static const char *const all[] = {INTEGRATORS(INTEGRATOR)};
  (void)state;
  for (size_t k = 0; k < 3 * sizeof all / sizeof *all; k++) {
    Parts *p = cloud(.5);
    Param par = settings(all[k / 3], boxes[k % 3]);
    Archive a = {0};
    Sim sim;
    double first[8], before[8], after[8], scale[8];
    const double n = (double)p->n;
    lab_set(&par, "gravity.method=none escape.distance=2.5 escape.every=3 step.max=0.05");
    lab_open(&sim, &par, p);
    totals(&sim, first, scale);
    for (int s = 0; s < 12; s++) {
      totals(&sim, before, scale), step(&sim), totals(&sim, after, scale);
      for (int d = 1; d < 4 && k % 3 < 2; d++)
        assert_true(fabs(after[d] - before[d]) < 1e-13 * scale[d]);
      look(&sim, p, &a), totals(&sim, before, scale);
      for (int d = 0; d < 8; d++) assert_true(fabs(after[d] - before[d]) < 1e-13 * scale[d]);
    }
    print_message("%s, %s: %g escaped, %g accreted\n", all[k / 3], boxes[k % 3], sim.gone.escaped,
                  sim.gone.accreted);
    assert_true(fabs(after[0] - first[0]) < 1e-14 * first[0]);
    assert_true(sim.gone.escaped >= 2 && sim.gone.accreted > 10);
    assert_true(n == (double)sim.s.n + sim.gone.escaped + sim.gone.accreted);
    assert_true(kept(&a, ARCHIVE_ESCAPED) == sim.gone.escaped &&
                kept(&a, ARCHIVE_ACCRETED) == sim.gone.accreted);
    lab_store(&sim, p);
    for (long i = 0; i < p->n && k % 3; i++) assert_true(fabs(p->x[3 * i]) <= 1.1);
    sim_close(&sim), archive_free(&a), part_free(p);
  }
}

/* A sink that crosses a face comes back at the other one, or turns round, as its image does. */
static void sink_at_a_face(void **state)
{
  static const char *const boxes[] = {"boundary.x=periodic", "boundary.x=mirror"};
  (void)state;
  for (int mirror = 0; mirror < 2; mirror++) {
    Parts *p = lab_parts(1, 3, GAS);
    Param par = settings("integrator=leapfrog", "gravity.method=none boundary.low=-1,0,0");
    Sim sim;
    Err err;
    lab_set(&par, "gravity.G=1e-30 boundary.high=1,0,0"), lab_set(&par, boxes[mirror]);
    p->m[0] = p->rho[0] = p->u[0] = 1, p->h[0] = .3;
    p->point = calloc(1, sizeof *p->point), p->points = 1;
    p->point[0] = (PointMass){.m = 3, .x = {.5}, .v = {.7, .2}, .spin = {1, 2, 3}};
    lab_open(&sim, &par, p), lab_run(&sim, 1), lab_store(&sim, p);
    const PointMass *q = p->point;
    assert_true(fabs(q->x[0] - (mirror ? .8 : -.8)) < 1e-12 && fabs(q->x[1] - .2) < 1e-12);
    assert_true(q->v[0] == (mirror ? -.7 : .7) && q->spin[0] == 1);
    assert_true(q->spin[1] == (mirror ? -2 : 2) && q->spin[2] == (mirror ? -3 : 3));
    sim_close(&sim);
    p->point[0].x[0] = 1.5;
    if (mirror) {
      assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
      assert_string_equal(err.text, "point mass 1 is at x = 1.5 m, behind the mirror at 1");
    }
    part_free(p);
  }
}

/* One that takes leave of three: what is booked is its own energy, kinetic, internal and in the
 * field of all others, exactly. */
static void energy_of_one(void **state)
{
  Parts *p = lab_parts(4, 3, GAS);
  Param par = settings("integrator=leapfrog",
                       "escape.distance=8 escape.every=1 escape.from=origin step.max=1e-3");
  Archive a = {0};
  Sim sim;
  double want;
  (void)state;
  for (long i = 0; i < 4; i++) {
    p->m[i] = 1 + .1 * (double)i, p->rho[i] = 1, p->h[i] = .5, p->u[i] = .1;
    p->x[3 * i] = i < 3 ? 2 * (double)i : 30, p->v[3 * i] = i < 3 ? 0 : 7;
  }
  lab_open(&sim, &par, p);
  assert_int_equal(go(&sim, p, &a), 1);
  assert_int_equal(p->n, 3);
  const Parts *q = a.list[ARCHIVE_ESCAPED].piece[0];
  assert_true(q->n == 1 && q->id[0] == 3);
  want = q->m[0] * (.5 * q->v[0] * q->v[0] + q->u[0]);
  for (long i = 0; i < 3; i++) want -= .3 * q->m[0] * p->m[i] / (q->x[0] - p->x[3 * i]);
  assert_true(fabs(sim.gone.energy / want - 1) < 1e-12);
  assert_true(sim.gone.mass == q->m[0] && sim.gone.momentum[0] == q->m[0] * q->v[0]);
  sim_close(&sim);
  archive_free(&a);
  part_free(p);
}

/* What sinks leave alone: what passes by too fast, when it has to be bound. */
static void rules(void **state)
{
  const double x[3] = {.5, 0, 0}, slow[3] = {0, .3, 0}, fast[3] = {0, 2, 0}, round[3] = {0, 1.1, 0};
  Leave l = {.field = {.n = 1, .at = {{.gm = 1}}}, .r2 = {1}};
  double r2;
  (void)state;
  for (l.bound = 0; l.bound < 2; l.bound++) {
    assert_true(leave_sink(&l, 0, x, slow, &r2) && r2 == .25);
    assert_int_equal(leave_sink(&l, 0, x, fast, &r2), !l.bound); /* v^2/2 = G m/r */
    assert_int_equal(leave_sink(&l, 0, x, round, &r2), 1);       /* r v = .55 */
  }
  l.bound = 1;
  const double out[3] = {.99, 0, 0}, turning[3] = {0, 1.05, 0};
  assert_int_equal(leave_sink(&l, 0, out, turning, &r2), 0); /* r v = 1.04 of at most 1 */
  l.r2[0] = .2;
  assert_int_equal(leave_sink(&l, 0, x, slow, &r2), 0);
}

static void same_parts(const Parts *p, const Parts *q)
{
  assert_int_equal(p->n, q->n);
  assert_memory_equal(p->id, q->id, (size_t)p->n * sizeof *p->id);
  assert_memory_equal(p->x, q->x, 3 * (size_t)p->n * sizeof *p->x);
  assert_memory_equal(p->v, q->v, 3 * (size_t)p->n * sizeof *p->v);
  assert_memory_equal(p->u, q->u, (size_t)p->n * sizeof *p->u);
  assert_memory_equal(p->point, q->point, sizeof *p->point);
}

/* Through a file, after some have left. */
static void restart(void **state)
{
  static const char *const integrators[] = {"integrator=leapfrog", "integrator=rk2-adaptive",
                                            "integrator=ab2"};
  (void)state;
  for (int k = 0; k < 3; k++) {
    char path[] = "/tmp/test_leave_XXXXXX"; /* lint: made by mkstemp */
    Parts *p = cloud(.5), *q;
    Param par = settings(integrators[k], "escape.distance=2 escape.every=3");
    Archive a = {0}, b = {0};
    Sim sim, again;
    Err err;
    long left = 0, later = 0;
    close(mkstemp(path));
    lab_open(&sim, &par, p);
    for (int n = 0; n < 12; n++) left += go(&sim, p, &a);
    lab_store(&sim, p);
    if (snap_write(p, path, 1, &err)) fail_msg("%s", err.text);
    if (!(q = snap_read(path, &err))) fail_msg("%s", err.text);
    if (sim_restart(&again, &par, q, lab_device(), &err)) fail_msg("%s", err.text);
    for (int n = 0; n < 12; n++) later += go(&sim, p, &a), go(&again, q, &b);
    print_message("%s: %ld and %ld left\n", integrators[k], left, later);
    assert_true(left > 2 && later > 0);
    lab_store(&sim, p), lab_store(&again, q);
    assert_memory_equal(&sim.gone, &again.gone, sizeof sim.gone);
    same_parts(p, q);
    sim_close(&sim), sim_close(&again);
    archive_free(&a), archive_free(&b);
    part_free(p), part_free(q);
    unlink(path);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(books_are_closed),
                                     cmocka_unit_test(faces_and_integrators),
                                     cmocka_unit_test(sink_at_a_face),
                                     cmocka_unit_test(energy_of_one),
                                     cmocka_unit_test(rules),
                                     cmocka_unit_test(restart)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
