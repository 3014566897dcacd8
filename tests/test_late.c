/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The late stage (solver/late.h): stiff matter gets the soft laws at its time and not before, gas
 * keeps its own; stress follows the strain, momentum and energy stay, damage is frozen, steps are
 * longer by the ratio of the sound speeds. */
#include <omp.h>
#include "lab.h"
#include "../solver/late.h"

static const char ROCK[] = "name = \"r\"; eos = { form = \"tillotson\"; rho0 = 1.; A = 1.; B = 1.; "
                           "E0 = 1.; Eiv = 1.; Ecv = 2.; a = 0.5; b = 1.; alpha = 5.; beta = 5.; };"
                           "strength = { shear_modulus = 0.8; form = \"none\"; };"
                           "damage = { form = \"grady_kipp\"; k = 1e10; m = 5.; };";
static const char GAS[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* A ball of rock that is sheared and squeezed, with a flaw in each particle, and one of gas far
 * away. */
static Parts *balls(void)
{
  double dx = .36;
  long n = lab_lattice(dx, 4, 3, in_ball, NULL, NULL);
  Parts *p = lab_parts(2 * n, 3, ROCK);
  Err err;
  assert_int_equal(part_add_material(p, "gas", GAS, &err), 1);
  for (int b = 0; b < 2; b++) lab_lattice(dx, 4, 3, in_ball, NULL, p->x + 3 * n * b);
  p->nflaw = malloc(sizeof *p->nflaw * (size_t)p->n);
  p->flaw = malloc(sizeof *p->flaw * (size_t)p->n);
  for (long i = 0; i < p->n; i++) {
    double *x = &p->x[3 * i];
    p->v[3 * i] = .02 * x[1], p->v[3 * i + 1] = -.02 * x[1];
    p->mat[i] = i >= n, p->u[i] = i >= n ? .01 : 0;
    if (i >= n) x[0] += 20;
    p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.2 * dx;
    p->nflaw[i] = i < n && i % 7 == 0;
    if (p->nflaw[i]) p->flaw[p->flaws++] = 5e-4;
  }
  return p;
}

static double energy(Sim *sim)
{
  Sums s;
  lab_sums(sim, &s);
  return s.kinetic + s.internal;
}

static Param settings(const char *integrator)
{
  return lab_param("gravity.method=none", "late.time=0.7", "late.bulk_modulus=0.01",
                   "late.poisson=0.3", "late.rho_min=0", "step.cfl=0.2", integrator, NULL);
}

static void stage(void **state)
{
  static const char *const integrators[] = {"integrator=leapfrog", "integrator=ab2"};
  const double K = .01, mu = 1.5 * K * (1 - 2 * .3) / 1.3;
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = balls();
    Param par = settings(integrators[k]);
    Sim sim;
    SimStep before, after;
    Sums s;
    Err err;
    double e, damage = 0;
    lab_open(&sim, &par, p);
    while (sim.time < .7)
      if (sim_advance(&sim, 1e9, &before, &err)) fail_msg("%s", err.text);
    assert_true(sim.time == .7 && !sim.late);
    lab_store(&sim, p), e = energy(&sim);
    for (long i = 0; i < p->n; i++) damage += p->damage[i];
    assert_true(damage > 0);
    if (sim_advance(&sim, 1e9, &after, &err)) fail_msg("%s", err.text);
    assert_true(sim.late && fabs(sim.late_speed / .1 - 1) < 1e-12);
    print_message("%s: step %.3g s, then %.3g s, energy %.1e\n", integrators[k], before.dt,
                  after.dt, energy(&sim) / e - 1);
    assert_true(after.dt > 3 * before.dt);
    assert_true(fabs(energy(&sim) / e - 1) < 1e-6);
    lab_run(&sim, 1.5);
    lab_sums(&sim, &s);
    for (int d = 0; d < 3; d++) assert_true(fabs(s.momentum[d]) < 1e-13 * s.scale_momentum);
    State now = lab_state(&sim);
    for (long i = 0; i < now.n; i++) {
      const double rho = now.rho[i], p0 = now.mat[i] ? .4 * rho * now.ue[i] : K * (rho - 1);
      const double c2 = now.mat[i] ? 1.4 * p0 / rho : K + 4. / 3 * mu / rho;
      assert_true(fabs(now.p[i] - p0) < 1e-14);
      assert_true(fabs(now.cl[i] * now.cl[i] / c2 - 1) < 1e-9);
      damage -= now.damage[i];
    }
    assert_true(fabs(damage) < 1e-12);
    lab_forget(&now), sim_close(&sim), part_free(p);
  }
}

/* S goes down as the shear modulus does, at once. */
static void stress(void **state)
{
  Parts *p = balls();
  Param par = settings("integrator=leapfrog");
  const double left = 1.5 * .01 * .4 / 1.3 / .8;
  Sim sim;
  Err err;
  double most = 0;
  (void)state;
  lab_open(&sim, &par, p);
  lab_run(&sim, .5);
  State before = lab_state(&sim);
  if (late_enter(&sim, &err)) fail_msg("%s", err.text);
  State after = lab_state(&sim);
  for (long i = 0; i < 6 * before.n; i++) {
    most = fmax(most, fabs(before.s[i]));
    assert_true(fabs(after.s[i] - left * before.s[i]) <= 1e-14 * fabs(before.s[i]));
  }
  assert_true(most > 1e-3);
  lab_forget(&before), lab_forget(&after), sim_close(&sim), part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(stage), cmocka_unit_test(stress)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
