/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What limits a step is named, with the particle and the value that the formula has (001 eq.
 * 54-57 with the errata of docs/theory.md 9); a state that makes no sense, or a step that
 * collapses, stops the run with the particle's id and state. */
#include <omp.h>
#include "lab.h"

static const char GAS[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";
static const char JELLY[] =
    "name = \"jelly\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };"
    "strength = { shear_modulus = 1.; form = \"none\"; };";

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* A ball with energy u that expands at the rate `hubble`. */
static Parts *ball_of(const char *material, double u, double hubble)
{
  double dx = .31;
  long n = lab_lattice(dx, 5, 3, in_ball, NULL, NULL);
  Parts *p = lab_parts(n, 3, material);
  lab_lattice(dx, 5, 3, in_ball, NULL, p->x);
  for (long i = 0; i < n; i++) {
    for (int d = 0; d < 3; d++) p->v[3 * i + d] = hubble * p->x[3 * i + d];
    p->id[i] = 100 + i, p->m[i] = dx * dx * dx, p->rho[i] = 1, p->u[i] = u, p->h[i] = 2.2 * dx;
  }
  return p;
}

static Parts *ball(double u, double hubble) { return ball_of(GAS, u, hubble); }

/* The `steps`-th step of a run; checks that dt, limit and particle agree with the state before
 * it. */
static void limit(const char *want, Parts *p, Param par, int steps, double until)
{
  Sim sim;
  Err err;
  SimStep done;
  double expect = 0;
  lab_open(&sim, &par, p);
  for (int k = 0; k < steps; k++) {
    State now = lab_state(&sim);
    const State *s = &now;
    expect = INFINITY;
    for (long i = 0; i < s->n; i++) {
      const double *a = &s->a[3 * i];
      double one = strcmp(want, "cfl") == 0 ? par.cfl * s->h[i] / s->signal[i]
                   : strcmp(want, "density") == 0
                       ? par.step_density / fabs(s->divv[i])
                       : par.step_acceleration *
                             sqrt(s->h[i] / sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]));
      expect = fmin(expect, one);
    }
    lab_forget(&now);
    if (sim_advance(&sim, until, &done, &err)) fail_msg("%s", err.text);
  }
  print_message("%s: %.4g s, particle %ld\n", sim_limit_name(done.limit), done.dt, (long)done.id);
  assert_string_equal(sim_limit_name(done.limit), want);
  if (done.limit < LIMITS) {
    assert_true(fabs(done.dt / expect - 1) < 1e-12);
    assert_true(done.id >= 100);
  } else
    assert_int_equal(done.id, -1);
  sim_close(&sim);
  part_free(p);
}

static void names(void **state)
{
  const char *none = "gravity.method=none";
  (void)state;
  limit("cfl", ball(1, 0), lab_param(none, "step.acceleration=2", NULL), 1, 1e9);
  limit("acceleration", ball(1e-9, 0), lab_param("gravity.G=1", NULL), 1, 1e9);
  limit("density", ball(1e-9, 1), lab_param(none, NULL), 1, 1e9);
  limit("max", ball(1, 0), lab_param(none, "step.max=1e-3", NULL), 1, 1e9);
  limit("output", ball(1, 0), lab_param(none, NULL), 1, 1e-3);
  for (int steps = 1; steps <= 2; steps++) /* shortened by the error, then begun as it allows */
    limit("error", ball(1, 0), lab_param(none, "integrator=rk2-adaptive", "step.error=1e-9", NULL),
          steps, 1e9);
}

/* A step ends exactly where it is asked to, and the last two before it are equal. */
static void landing(void **state)
{
  Parts *p = ball(1, 0);
  Param par = lab_param("gravity.method=none", NULL);
  Sim sim;
  Err err;
  SimStep done, first;
  (void)state;
  lab_open(&sim, &par, p);
  assert_return_code(sim_advance(&sim, 1e9, &first, &err), 0);
  double until = sim.time + 1.2 * first.dt, start = sim.time;
  assert_return_code(sim_advance(&sim, until, &done, &err), 0);
  assert_true(fabs(done.dt / (until - start) - .5) < 1e-9);
  assert_return_code(sim_advance(&sim, until, &done, &err), 0);
  assert_true(sim.time == until);
  sim_close(&sim);
  part_free(p);
}

static void broken(int what, const char *message)
{
  Parts *p = ball_of(JELLY, 1, 0);
  Param par = lab_param("gravity.method=none", NULL);
  Sim sim;
  Err err;
  SimStep done;
  char id[32];
  lab_open(&sim, &par, p);
  assert_return_code(sim_advance(&sim, 1e9, &done, &err), 0);
  State s = lab_state(&sim);
  snprintf(id, sizeof id, "particle %ld of body 0", (long)s.id[7]);
  double *const at[] = {&s.x[22], &s.v[22], &s.rho[7], &s.u[7], &s.h[7], &s.a[22], &s.s[44]};
  *at[what] = what == 2 ? -1 : what == 4 ? 0 : NAN;
  lab_keep(&sim, &s), lab_forget(&s);
  assert_int_equal(sim_store(&sim, p, &err), -1);
  assert_non_null(strstr(err.text, message));
  assert_int_equal(sim_advance(&sim, 1e9, &done, &err), -1);
  assert_non_null(strstr(err.text, message));
  assert_non_null(strstr(err.text, id));
  assert_non_null(strstr(err.text, "step 1"));
  sim_close(&sim);
  part_free(p);
}

static void breakdown(void **state)
{
  (void)state;
  broken(0, "position is not finite");
  broken(1, "velocity is not finite");
  broken(2, "density is not positive");
  broken(3, "internal energy is not finite");
  broken(4, "smoothing length is not positive");
  broken(5, "acceleration is not finite");
  broken(6, "stress is not finite");
}

/* Bad particles do not get in. */
static void input(void **state)
{
  Param par = lab_param("gravity.method=none", NULL);
  const char *const words[] = {"Masses", "InternalEnergy", "Density", "SmoothingLength"};
  (void)state;
  for (int k = 0; k < 5; k++) {
    Parts *p = ball(1, 0);
    Sim sim;
    Err err;
    if (k == 0) p->m[3] = -1;
    if (k == 1) p->u[3] = NAN;
    if (k == 2) p->rho[3] = 0;
    if (k == 3) p->h[3] = INFINITY;
    if (k == 4) p->id[3] = p->id[4];
    assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
    if (k < 4) assert_non_null(strstr(err.text, words[k]));
    assert_non_null(strstr(err.text, k < 4 ? "particle 103" : "104"));
    part_free(p);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(names), cmocka_unit_test(landing),
                                     cmocka_unit_test(breakdown), cmocka_unit_test(input)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
