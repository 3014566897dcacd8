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

static const char PUMICE[] =
    "name = \"p\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };"
    "strength = { shear_modulus = 1.; form = \"none\"; };"
    "porosity = { form = \"p_alpha\"; alpha_0 = 1.3; p_e = 1e-3; p_s = 0.1; };";
static const char DUST[] =
    "name = \"p\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };"
    "strength = { shear_modulus = 1.; form = \"none\"; };"
    "porosity = { form = \"p_alpha_power\"; alpha_0 = 1.3; a = 0.946; b = 0.01; };";
static double crush = 1e-3; /* pressure at which the pores of a run begin to crush */
static const char BRITTLE[] =
    "name = \"b\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };"
    "strength = { shear_modulus = 1.; form = \"none\"; };"
    "damage = { form = \"grady_kipp\"; k = 1e10; m = 5.; };";

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

/* Crushes and shears: PUMICE or DUST, rather loose. */
static Parts *pores(const char *material)
{
  Parts *p = ball_of(material, 0, -.05);
  for (long i = 0; i < p->n; i++) p->rho[i] = .77, p->v[3 * i] += .1 * p->x[3 * i + 1];
  return p;
}

/* JELLY that tears, with one flaw each. */
static Parts *flaws(void)
{
  Parts *p = ball_of(BRITTLE, 0, .05);
  p->nflaw = malloc(sizeof *p->nflaw * (size_t)p->n);
  p->flaw = malloc(sizeof *p->flaw * (size_t)p->n);
  p->flaws = p->n;
  for (long i = 0; i < p->n; i++) p->nflaw[i] = 1, p->flaw[i] = 1e-4;
  return p;
}

/* The step that criterion `want` allows to particle i (theory, 5.4). */
static double allowed(const char *want, const State *s, const Param *par, double dilation, long i)
{
  const double *a = &s->a[3 * i], *t = &s->s[6 * i], c = s->cs[i], n = s->nngb[i];
  const double few = .5 * (1 - tanh((n - par->fewest * par->neighbours) / par->width)),
               many = .5 * (1 + tanh((n - par->most * par->neighbours) / par->width));
  double rate = s->divv[i] / 3, size = 0, change = 0;
  if (par->smoothing == PARAM_OVERCORRECTED)
    rate = few * dilation + (1 - few - many) * rate - many * dilation;
  if (!strcmp(want, "cfl")) return par->cfl * s->h[i] / s->signal[i];
  if (!strcmp(want, "density")) return par->step_density / fabs(s->divv[i]);
  if (!strcmp(want, "energy"))
    return s->dudt[i] < 0 ? par->step_energy * (s->u[i] + par->energy_least) / -s->dudt[i]
                          : INFINITY;
  if (!strcmp(want, "smoothing")) return par->step_smoothing / fabs(rate);
  if (!strcmp(want, "damage"))
    return par->step_damage * (cbrt(s->damage[i]) + par->damage_least) / s->dcrack[i];
  if (!strcmp(want, "distention")) return par->step_distention / fabs(s->dalpha[i]);
  if (!strcmp(want, "pressure"))
    return par->step_pressure * crush / (s->rho[i] * c * c * fabs(s->divv[i]));
  if (!strcmp(want, "stress")) {
    const double *g = &s->g[9 * i];
    Sym now = {t[0], t[1], t[2], t[3], t[4], t[5]}, r = passes_jaumann(now, g, 1);
    size = now.xx * now.xx + now.yy * now.yy + now.zz * now.zz +
           2 * (now.xy * now.xy + now.xz * now.xz + now.yz * now.yz);
    change =
        r.xx * r.xx + r.yy * r.yy + r.zz * r.zz + 2 * (r.xy * r.xy + r.xz * r.xz + r.yz * r.yz);
    return par->step_stress * (sqrt(size) + par->stress_least) / sqrt(change);
  }
  return par->step_acceleration * sqrt(s->h[i] / sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]));
}

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
    double dilation = 0;
    expect = INFINITY;
    for (long i = 0; i < s->n; i++) dilation = fmax(dilation, fabs(s->divv[i]));
    for (long i = 0; i < s->n; i++) expect = fmin(expect, allowed(want, s, &par, dilation, i));
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
  limit("first", ball(1, 0), lab_param(none, "step.first=1e-3", NULL), 1, 1e9);
  limit("energy", ball(1, 1), lab_param(none, "step.energy=0.001", "step.energy_least=0.1", NULL),
        3, 1e9);
  limit("smoothing", ball(1, 1), lab_param(none, "step.smoothing=0.001", NULL), 3, 1e9);
  limit("smoothing", ball(1, 1),
        lab_param(none, "step.smoothing=0.001", "smoothing.mode=overcorrected", NULL), 3, 1e9);
  limit("stress", ball_of(JELLY, 0, .1),
        lab_param(none, "step.stress=0.001", "step.stress_least=0.1", NULL), 3, 1e9);
  limit("damage", flaws(), lab_param(none, "step.damage=0.001", "step.damage_least=0.1", NULL), 9,
        1e9);
  for (int rk = 0; rk < 2; rk++) {
    const char *integrator = rk ? "integrator=rk3-tvd" : "integrator=leapfrog";
    limit("distention", pores(PUMICE), lab_param(none, integrator, "step.distention=1e-6", NULL), 3,
          1e9);
    crush = 1e-3;
    limit("pressure", pores(PUMICE), lab_param(none, integrator, "step.pressure=1e-3", NULL), 3,
          1e9);
    crush = 1e6 * pow(.946 * 1.3, -100);
    limit("pressure", pores(DUST), lab_param(none, integrator, "step.pressure=1e-3", NULL), 3, 1e9);
  }
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

/* A step that fails leaves no trace: flaws that only it has activated are not active afterwards.
 * The state is that of a run whose first step is as short at once. */
static void rejected(void **state)
{
  enum { FLAWS = 64 };
  Parts *p[2];
  double dt = 0;
  (void)state;
  for (int run = 0; run < 2; run++) {
    Param par = lab_param("gravity.method=none", "integrator=rk2-adaptive", "step.error=1e-5",
                          "step.cfl=2", "step.density=10", "smoothing.mode=fixed", NULL);
    Sim sim;
    Err err;
    SimStep done;
    p[run] = ball_of(BRITTLE, 0, .05);
    p[run]->flaws = FLAWS * p[run]->n;
    p[run]->nflaw = malloc(sizeof(int32_t) * (size_t)p[run]->n);
    p[run]->flaw = malloc(sizeof(double) * (size_t)p[run]->flaws);
    for (long i = 0; i < p[run]->n; i++) p[run]->nflaw[i] = FLAWS;
    for (long i = 0; i < p[run]->flaws; i++) p[run]->flaw[i] = 2e-6 * (double)(i % FLAWS + 1);
    if (run) par.step_max = dt;
    lab_open(&sim, &par, p[run]);
    if (sim_advance(&sim, 1e9, &done, &err)) fail_msg("%s", err.text);
    assert_string_equal(sim_limit_name(done.limit), run ? "max" : "error");
    dt = done.dt;
    lab_store(&sim, p[run]);
    sim_close(&sim);
  }
  long active = 0;
  for (long i = 0; i < p[0]->n; i++) active += p[0]->nact[i];
  print_message("after a step of %.3g: %ld flaws active\n", dt, active);
  assert_true(active > 0 && active < p[0]->flaws / 2);
  assert_memory_equal(p[0]->nact, p[1]->nact, (size_t)p[0]->n * sizeof *p[0]->nact);
  assert_memory_equal(p[0]->damage, p[1]->damage, (size_t)p[0]->n * sizeof *p[0]->damage);
  assert_memory_equal(p[0]->x, p[1]->x, 3 * (size_t)p[0]->n * sizeof *p[0]->x);
  part_free(p[0]), part_free(p[1]);
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
                                     cmocka_unit_test(rejected), cmocka_unit_test(breakdown),
                                     cmocka_unit_test(input)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
