/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Settings that do not go together are refused with one line that says which and why; the key of
 * every row is one that exists and is seen to refuse and to let pass. */
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
    {"gravity.tolerance=0.1", "gravity.every=1", "gravity.every=2",
     "gravity.tolerance = 0.1 has no effect: gravity.every = 1"},
    {"gravity.softening=plummer", "gravity.method=none", "gravity.method=tree gravity.epsilon=1",
     "gravity.softening = plummer has no effect: gravity.method = none"},
    {"gravity.epsilon=1", "gravity.method=none", "gravity.method=tree",
     "gravity.epsilon = 1 has no effect: gravity.method = none"},
    {"gravity.every=2", "gravity.method=none", "gravity.method=tree",
     "gravity.every = 2 has no effect: gravity.method = none"},
    {"stress_form=squares", "strength.on=true", "strength.on=true",
     "stress_form = squares has no effect: no matter here has a shear stress"},
    {"form.gradient=raw", "gravity.method=tree", "gravity.method=tree",
     "form.gradient = raw has no effect: no matter here needs the gradient of the velocity"},
    {"form.diffusion=0.1", "density=sum", "density=continuity",
     "form.diffusion = 0.1 has no effect: density = sum"},
    {"stress.exponent=2", "stress.artificial=0", "stress.artificial=0.1",
     "stress.exponent = 2 has no effect: stress.artificial = 0"},
    {"stress.spacing=0.4", "stress.artificial=0", "stress.artificial=0.1",
     "stress.spacing = 0.4 has no effect: stress.artificial = 0"},
    {"viscosity.switch=morris_monaghan", "viscosity.alpha=0 viscosity.beta=0", "viscosity.alpha=1",
     "viscosity.switch = morris_monaghan has no effect: no artificial viscosity"},
    {"viscosity.balsara=true", "viscosity.alpha=0 viscosity.beta=0", "viscosity.alpha=1",
     "viscosity.balsara = true has no effect: no artificial viscosity"},
    {"viscosity.least=0.2", "viscosity.switch=none", "viscosity.switch=cullen_dehnen",
     "viscosity.least = 0.2 has no effect: viscosity.switch = none"},
    {"smoothing.neighbours=60", "smoothing.mode=density", "smoothing.mode=neighbours",
     "smoothing.neighbours = 60 has no effect: smoothing.mode = density"},
    {"smoothing.min=0.5", "smoothing.mode=fixed", "smoothing.mode=density",
     "smoothing.min = 0.5 has no effect: smoothing.mode = fixed"},
    {"smoothing.max=2", "smoothing.mode=fixed", "smoothing.mode=density",
     "smoothing.max = 2 has no effect: smoothing.mode = fixed"},
    {"disk.point=0", "gravity.method=tree", "gravity.method=tree",
     "disk.point = 0 has no effect: no law here has a centre"},
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
    {"smoothing.fewest=0.5", "smoothing.mode=density", "smoothing.mode=overcorrected",
     "smoothing.fewest = 0.5 has no effect: smoothing.mode = density"},
    {"smoothing.most=2", "smoothing.mode=density", "smoothing.mode=overcorrected",
     "smoothing.most = 2 has no effect: smoothing.mode = density"},
    {"smoothing.width=2", "smoothing.mode=density", "smoothing.mode=overcorrected",
     "smoothing.width = 2 has no effect: smoothing.mode = density"},
    {"step.growth=5", "integrator=leapfrog", "integrator=rk2-adaptive",
     "step.growth = 5 has no effect: integrator = leapfrog"},
    {"step.energy=1", "energy=frozen", "energy=full",
     "step.energy = 1 has no effect: energy = frozen"},
    {"step.energy_least=1", "step.energy=0", "step.energy=1",
     "step.energy_least = 1 has no effect: step.energy = 0"},
    {"step.smoothing=1", "smoothing.mode=fixed", "smoothing.mode=density",
     "step.smoothing = 1 has no effect: smoothing.mode = fixed"},
    {"step.stress=1", "gravity.method=none", "gravity.method=none",
     "step.stress = 1 has no effect: no material has a deviatoric stress in this run"},
    {"step.stress_least=1", "step.stress=0", "step.stress=1",
     "step.stress_least = 1 has no effect: step.stress = 0"},
    {"step.damage=1", "strength.damage=false", "strength.damage=true",
     "step.damage = 1 has no effect: there is no damage in this run"},
    {"step.damage_least=1", "step.damage=0", "step.damage=1",
     "step.damage_least = 1 has no effect: step.damage = 0"},
    {"step.distention=1", "gravity.method=none", "gravity.method=none",
     "step.distention = 1 has no effect: no material has pores"},
    {"step.pressure=1", "gravity.method=none", "gravity.method=none",
     "step.pressure = 1 has no effect: no pores here begin to crush at a pressure"},
    {"error.position=0", "integrator=leapfrog", "integrator=rk2-adaptive",
     "error.position = 0 has no effect: integrator = leapfrog"},
    {"error.velocity=0", "integrator=leapfrog", "integrator=rk2-adaptive",
     "error.velocity = 0 has no effect: integrator = leapfrog"},
    {"error.density=0", "integrator=leapfrog", "integrator=rk2-adaptive",
     "error.density = 0 has no effect: integrator = leapfrog"},
    {"error.energy=0", "integrator=leapfrog", "integrator=rk2-adaptive",
     "error.energy = 0 has no effect: integrator = leapfrog"},
    {"error.stress=0", "integrator=leapfrog", "integrator=rk2-adaptive",
     "error.stress = 0 has no effect: integrator = leapfrog"},
    {"error.damage=0", "integrator=leapfrog", "integrator=rk2-adaptive",
     "error.damage = 0 has no effect: integrator = leapfrog"},
    {"analysis.method=grow", "analysis.every=0", "analysis.every=1",
     "analysis.method = grow has no effect: analysis.every = 0"},
    {"analysis.criterion=thermal", "analysis.every=0", "analysis.every=1",
     "analysis.criterion = thermal has no effect: analysis.every = 0"},
    {"analysis.points=false", "analysis.every=0", "analysis.every=1",
     "analysis.points = false has no effect: analysis.every = 0"},
    {"analysis.points=false", "analysis.every=1", "analysis.every=1",
     "analysis.points = false has no effect: there are no point masses"},
    {"analysis.min_particles=30", "analysis.every=0", "analysis.every=1",
     "analysis.min_particles = 30 has no effect: analysis.every = 0"},
    {"analysis.link=2", "analysis.every=0", "analysis.every=1",
     "analysis.link = 2 has no effect: analysis.every = 0"},
    {"analysis.link=2", "analysis.every=1 analysis.method=grow", "analysis.every=1",
     "analysis.link = 2 has no effect: analysis.method = grow"},
    {"analysis.theta=0.5", "analysis.every=0", "analysis.every=1",
     "analysis.theta = 0.5 has no effect: analysis.every = 0"},
    {"analysis.max_virial=1", "analysis.every=0", "analysis.every=1",
     "analysis.max_virial = 1 has no effect: analysis.every = 0"},
    {"analysis.converged=0.1", "analysis.every=0", "analysis.every=1",
     "analysis.converged = 0.1 has no effect: analysis.every = 0"},
    {"analysis.window=5", "analysis.converged=0", "analysis.converged=0.1 analysis.every=1",
     "analysis.window = 5 has no effect: analysis.converged = 0"},
    {"analysis.after=5", "analysis.converged=0", "analysis.converged=0.1 analysis.every=1",
     "analysis.after = 5 has no effect: analysis.converged = 0"},
    {"late.bulk_modulus=1", "gravity.method=none", "gravity.method=none",
     "late.bulk_modulus = 1 has no effect: no material is stiffer"},
    {"late.time=5", "late.bulk_modulus=0", "late.bulk_modulus=1",
     "late.time = 5 has no effect: late.bulk_modulus = 0"},
    {"late.poisson=0.3", "late.bulk_modulus=0", "late.bulk_modulus=1",
     "late.poisson = 0.3 has no effect: late.bulk_modulus = 0"},
    {"late.rho_min=0.5", "late.bulk_modulus=0", "late.bulk_modulus=1",
     "late.rho_min = 0.5 has no effect: late.bulk_modulus = 0"},
    {"boundary.low=1,0,0", "gravity.method=none", "gravity.method=none",
     "boundary.low = 1,0,0 has no effect: no axis of boundary has a face, nor a layer"},
    {"boundary.high=1,0,0", "gravity.method=none", "gravity.method=none",
     "boundary.high = 1,0,0 has no effect: no axis of boundary has a face, nor a layer"},
    {"layer.strength=5", "gravity.method=none", "gravity.method=none",
     "layer.strength = 5 has no effect: there is no layer"},
    {"spin.period=5", "spin.rate=0", "spin.rate=1", "spin.period = 5 has no effect: spin.rate = 0"},
    {"spin.axis=1,0,0", "spin.rate=0", "spin.rate=1 spin.period=1",
     "spin.axis = 1,0,0 has no effect: spin.rate = 0"},
    {"spin.axis=1,0,0", "spin.rate=1 spin.period=0", "spin.rate=1 spin.period=1",
     "spin.axis = 1,0,0 has no effect: spin.period = 0"},
    {"watch.viscous_work=true", "energy=frozen", "energy=full",
     "watch.viscous_work = true has no effect: energy = frozen"},
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
    {"gravity.softening=plummer", "gravity.epsilon=0", "gravity.epsilon=1",
     "gravity.softening = plummer cannot go with gravity.epsilon = 0: it needs one length for all"},
    {"escape.from=deepest", "gravity.method=none", "gravity.method=tree",
     "escape.from = deepest cannot go with gravity.method = none: without self-gravity no particle "
     "lies deepest"},
    {"pressure_form=product", "density=sum", "density=continuity",
     "pressure_form = product cannot go with density = sum: the product goes with the density by "
     "continuity"},
    {"stress_form=squares", "density=miscible_continuity", "density=miscible",
     "stress_form = squares cannot go with density = miscible_continuity: its stress goes with the "
     "particles' own volumes"},
    {"form.grad_h=true", "density=continuity", "density=sum",
     "form.grad_h = true cannot go with density = continuity: by continuity density and forces "
     "agree as it is"},
    {"form.grad_h=true", "density=sum smoothing.mode=fixed", "density=sum",
     "form.grad_h = true cannot go with smoothing.mode = fixed: h must follow from the density"},
    {"form.shepard=true", "density=sum", "density=continuity",
     "form.shepard = true cannot go with density = sum: it is for the density by continuity"},
    {"viscosity.balsara=true", "viscosity.switch=cullen_dehnen", "viscosity.switch=morris_monaghan",
     "viscosity.balsara = true cannot go with viscosity.switch = cullen_dehnen: it has a limiter "
     "of "
     "its own"},
    {"stress.artificial=0.2", "stress.spacing=1", "stress.spacing=0.4",
     "stress.artificial = 0.2 cannot go with stress.spacing = 1: particles are farther apart than "
     "h"},
    {"step.max=1e-3", "step.min=1e-2", "step.min=1e-4",
     "step.max = 0.001 cannot go with step.min = 0.01: no step is left between the two"},
    {"spin.axis=0,0,0", "spin.rate=1", "spin.rate=0",
     "spin.axis = 0,0,0 cannot go with spin.rate = 1: it is no direction"},
    {"heating.profile=gaussian", "heating.radius=0", "heating.radius=1",
     "heating.profile = gaussian cannot go with heating.radius = 0: it needs a radius"},
    {"heating.begin=2", "heating.end=1", "heating.end=3",
     "heating.begin = 2 cannot go with heating.end = 1: no time is left between the two"},
    {"guard.energy=0.1", "energy=frozen", "energy=full",
     "guard.energy = 0.1 cannot go with energy = frozen: energy is not kept then"},
    {"guard.energy=0.1", "heating.rate=1", "heating.rate=0",
     "guard.energy = 0.1 cannot go with heating.rate = 1: energy comes from outside"},
    {"guard.energy=0.1", "damping.rate=1", "damping.rate=0",
     "guard.energy = 0.1 cannot go with damping.rate = 1: energy is taken away"},
    {"guard.momentum=0.1", "boundary.x=mirror_low gravity.method=none", "boundary.x=open",
     "guard.momentum = 0.1 cannot go with a mirror or wall of boundary: it takes momentum up"},
    {"guard.angular_momentum=0.1", "gravity.method=none", "gravity.method=none",
     "guard.angular_momentum = 0.1 cannot go with walls or a layer: they exert torques"},
    {"boundary.x=periodic", "gravity.method=none", "boundary.high=1,1,1 gravity.method=none",
     "boundary.x = periodic cannot go with boundary.high = 0,0,0: the upper face must be above the "
     "lower one"},
    {"boundary.y=mirror_low", "gravity.method=tree", "gravity.method=none",
     "boundary.y = mirror_low cannot go with gravity.method = tree: images do not pull"},
    {"boundary.z=mirror_low", "gravity.method=none", "gravity.method=none",
     "boundary.z = mirror_low cannot go with a run of fewer dimensions: nothing moves along that "
     "axis"},
};

/* A run of rock that has all, one of gas with nothing, one of rock alone, one in the plane. */
static const Sim full = {.solid = 1,
                         .tensor = 1,
                         .porous = 1,
                         .crushes = 1,
                         .fluid = 1,
                         .central = 1,
                         .points.n = 2,
                         .points.p[1].radius = 1,
                         .stiffest = 1e9,
                         .s.dimension = 3,
                         .hold.on = 1,
                         .bounds.on = 1};
static const Sim gas = {.fluid = 1, .s.dimension = 3}, rock = {.solid = 1, .s.dimension = 3};
static const Sim walled = {.fluid = 1, .s.dimension = 3, .hold.on = 1};
static const Sim plane = {.fluid = 1, .s.dimension = 2}, far = {.rich = 1};

static void check(const Case *c, long n, int (*look)(const Param *, const Sim *, Err *))
{
  for (long k = 0; k < n; k++) {
    Param bad = lab_param(c[k].key, NULL), good = bad, without = lab_param(NULL);
    const Sim *sim = strstr(c[k].text, "all matter")  ? &rock
                     : strstr(c[k].text, "dimension") ? &plane
                     : strstr(c[k].text, "walls or")  ? &walled
                     : strstr(c[k].text, "than h")    ? &far
                                                      : &gas; /* that it is refused for */
    Err err;
    lab_set(&bad, c[k].with), lab_set(&without, c[k].with), lab_set(&good, c[k].fine);
    assert_int_equal(look(&bad, sim, &err), -1);
    assert_string_equal(err.text, c[k].text);
    if (look(&without, sim, &err) ||
        look(&good, strncmp(c[k].key, "guard", 5) ? &full : &gas, &err))
      fail_msg("%s", err.text);
  }
}

static void unused_settings(void **state)
{
  (void)state;
  check(unused, sizeof unused / sizeof *unused, conflict_unused);
}

static void contradictions(void **state)
{
  (void)state;
  check(conflicts, sizeof conflicts / sizeof *conflicts, conflict_check);
}

/* A row's key exists and has a case. */
static void key(const char *name, const Case *c, size_t n)
{
  const Param p = lab_param(NULL);
  const size_t length = strlen(name);
  char text[128];
  size_t k = 0;
  assert_non_null(param_text(&p, name, text, sizeof text));
  while (k < n && (strncmp(c[k].key, name, length) || c[k].key[length] != '=')) k++;
  if (k == n) fail_msg("no case for %s", name);
}

static void keys(void **state)
{
  const Param p = lab_param(NULL);
  char text[128];
  (void)state;
#define CONFLICT_KEYS(KEY, ...) key(KEY, conflicts, sizeof conflicts / sizeof *conflicts);
#define UNUSED_KEYS(KEY, ...)   key(KEY, unused, sizeof unused / sizeof *unused);
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
