/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Settings that do not go together are refused with one line that says which and why; every row of
 * the lists names keys that exist and is seen to refuse and to let pass. */
#include "lab.h"
#include "../solver/conflict.h"

/* What a row refuses, one that is far from its default, with what makes it so; and a setting under
 * which the same key has an effect. */
typedef struct {
  const char *key, *with, *fine, *text;
} Case;

static const Case unused[] = {
    {"density_floor=0.5", "density=sum", "density=continuity",
     "density_floor = 0.5 has no effect: density = sum"},
    {"gravity.theta=0.5", "gravity.method=direct", "gravity.method=tree",
     "gravity.theta = 0.5 has no effect: gravity.method = direct"},
    {"gravity.G=1", "gravity.method=none", "gravity.method=tree",
     "gravity.G = 1 has no effect: gravity.method = none"},
    {"gravity.every=2", "gravity.method=none", "gravity.method=tree",
     "gravity.every = 2 has no effect: gravity.method = none"},
    {"smoothing.neighbours=60", "smoothing.mode=density", "smoothing.mode=neighbours",
     "smoothing.neighbours = 60 has no effect: smoothing.mode = density"},
    {"smoothing.min=0.5", "smoothing.mode=fixed", "smoothing.mode=density",
     "smoothing.min = 0.5 has no effect: smoothing.mode = fixed"},
    {"smoothing.max=2", "smoothing.mode=fixed", "smoothing.mode=density",
     "smoothing.max = 2 has no effect: smoothing.mode = fixed"},
    {"sink.rule=bound", "gravity.method=tree", "gravity.method=tree",
     "sink.rule = bound has no effect: no point mass has a radius"},
    {"sink.every=3", "gravity.method=tree", "gravity.method=tree",
     "sink.every = 3 has no effect: no point mass has a radius"},
    {"escape.from=origin", "escape.distance=0", "escape.distance=1",
     "escape.from = origin has no effect: escape.distance = 0"},
    {"escape.unbound=false", "escape.distance=0", "escape.distance=1",
     "escape.unbound = false has no effect: escape.distance = 0"},
    {"escape.every=3", "escape.distance=0", "escape.distance=1",
     "escape.every = 3 has no effect: escape.distance = 0"},
    {"step.points=0.1", "gravity.method=tree", "gravity.method=tree",
     "step.points = 0.1 has no effect: there are no two point masses"},
    {"step.error=1e-3", "integrator=leapfrog", "integrator=rk2-adaptive",
     "step.error = 0.001 has no effect: integrator = leapfrog"},
    {"damping.radial=true", "damping.rate=0", "damping.rate=1",
     "damping.radial = true has no effect: damping.rate = 0"},
    {"viscosity.kinematic=1", "strength.on=true", "strength.on=true",
     "viscosity.kinematic = 1 has no effect: all matter here has a shear modulus"},
    {"viscosity.shakura_sunyaev=1", "strength.on=true", "strength.on=true",
     "viscosity.shakura_sunyaev = 1 has no effect: all matter here has a shear modulus"},
    {"viscosity.aspect=1", "viscosity.shakura_sunyaev=0", "viscosity.shakura_sunyaev=0.1",
     "viscosity.aspect = 1 has no effect: viscosity.shakura_sunyaev = 0"},
    {"viscosity.bulk=1", "strength.on=true", "strength.on=true",
     "viscosity.bulk = 1 has no effect: all matter here has a shear modulus"},
    {"viscosity.compression=1", "strength.on=true", "strength.on=true",
     "viscosity.compression = 1 has no effect: all matter here has a shear modulus"},
    {"heating.rate=1", "energy=frozen", "energy=full",
     "heating.rate = 1 has no effect: energy = frozen"},
    {"heating.profile=gaussian", "heating.rate=0", "heating.rate=1",
     "heating.profile = gaussian has no effect: heating.rate = 0"},
    {"heating.radius=1", "heating.rate=0", "heating.rate=1",
     "heating.radius = 1 has no effect: heating.rate = 0"},
    {"heating.axis=x", "heating.radius=0", "heating.radius=1 heating.rate=1",
     "heating.axis = x has no effect: heating.radius = 0"},
    {"heating.x=1", "heating.radius=0", "heating.radius=1 heating.rate=1",
     "heating.x = 1 has no effect: heating.radius = 0"},
    {"heating.y=1", "heating.radius=0", "heating.radius=1 heating.rate=1",
     "heating.y = 1 has no effect: heating.radius = 0"},
    {"heating.z=1", "heating.radius=0", "heating.radius=1 heating.rate=1",
     "heating.z = 1 has no effect: heating.radius = 0"},
    {"heating.begin=1", "heating.rate=0", "heating.rate=1",
     "heating.begin = 1 has no effect: heating.rate = 0"},
    {"heating.end=1", "heating.rate=0", "heating.rate=1",
     "heating.end = 1 has no effect: heating.rate = 0"},
};

static const Case conflicts[] = {
    {"gravity.every=2", "integrator=rk2-adaptive", "integrator=leapfrog",
     "gravity.every = 2 cannot go with integrator = rk2-adaptive: only leapfrog kicks with gravity "
     "in steps of its own"},
    {"escape.from=deepest", "gravity.method=none", "gravity.method=tree",
     "escape.from = deepest cannot go with gravity.method = none: without self-gravity no particle "
     "lies deepest"},
    {"pressure_form=product", "density=sum", "density=continuity",
     "pressure_form = product cannot go with density = sum: the product goes with the density by "
     "continuity"},
    {"step.max=1e-3", "step.min=1e-2", "step.min=1e-4",
     "step.max = 0.001 cannot go with step.min = 0.01: no step is left between the two"},
    {"heating.profile=gaussian", "heating.radius=0", "heating.radius=1",
     "heating.profile = gaussian cannot go with heating.radius = 0: it needs a radius"},
    {"heating.begin=2", "heating.end=1", "heating.end=3",
     "heating.begin = 2 cannot go with heating.end = 1: no time is left between the two"},
};

static void check(const Case *c, long n, long rows, int (*look)(const Param *, const Sim *, Err *))
{
  const Sim none = {0}, rock = {.solid = 1};
  Sim some = {0};
  assert_int_equal(n, rows);
  for (long k = 0; k < n; k++) {
    Param bad = lab_param(c[k].key, c[k].with, NULL), good = lab_param(c[k].key, NULL),
          without = lab_param(c[k].with, NULL);
    lab_set(&good, c[k].fine);
    const Sim *sim = strstr(c[k].text, "all matter") ? &rock : &none; /* that it is refused for */
    Err err;
    assert_int_equal(look(&bad, sim, &err), -1);
    assert_string_equal(err.text, c[k].text);
    some.points.n = strstr(c[k].text, "point mass") ? 2 : 0; /* makes it fine */
    some.points.p[1].radius = 1;
    if (look(&good, &some, &err) || look(&without, sim, &err)) fail_msg("%s", err.text);
  }
}

#define COUNT(...) +1

static void unused_settings(void **state)
{
  (void)state;
  check(unused, sizeof unused / sizeof *unused, UNUSED_SETTINGS(COUNT), conflict_unused);
}

static void contradictions(void **state)
{
  (void)state;
  check(conflicts, sizeof conflicts / sizeof *conflicts, CONFLICTS(COUNT), conflict_check);
}

/* The keys that the rows speak of are there. */
static void keys(void **state)
{
  const Param p = lab_param(NULL);
  char text[128];
  (void)state;
#define CONFLICT_KEYS(KEY, OTHER, ...)                                                             \
  assert_non_null(param_text(&p, KEY, text, sizeof text));                                         \
  assert_non_null(param_text(&p, OTHER, text, sizeof text));
#define UNUSED_KEYS(KEY, ...) assert_non_null(param_text(&p, KEY, text, sizeof text));
  CONFLICTS(CONFLICT_KEYS)
  UNUSED_SETTINGS(UNUSED_KEYS)
  assert_null(param_text(&p, "gravity", text, sizeof text));
  assert_null(param_text(&p, "step.theta", text, sizeof text));
}

/* Defaults are in no conflict, and sim_open looks at the contradictions. */
static void opened(void **state)
{
  Parts *p = lab_parts(1, 3, "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };");
  Param par = lab_param("gravity.every=2", "integrator=rk2-adaptive", NULL), none = lab_param(NULL);
  Sim sim;
  Err err;
  (void)state;
  p->m[0] = p->rho[0] = p->h[0] = p->u[0] = 1;
  assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
  assert_non_null(strstr(err.text, "cannot go with"));
  lab_open(&sim, &none, p);
  if (conflict_unused(&none, &sim, &err)) fail_msg("%s", err.text);
  sim_close(&sim);
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(unused_settings),
                                     cmocka_unit_test(contradictions), cmocka_unit_test(keys),
                                     cmocka_unit_test(opened)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
