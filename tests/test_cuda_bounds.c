/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Faces, walls and layers on the CUDA backend against the CPU's: the same state after some steps,
 * by every integrator, and the same bits twice. Runs on a device, and on the host (tests/host). */
#include "lab.h"
#include "../lib/rng.h"
#include "small.h"

static const char ROCK[] =
    "name = \"rock\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 1.; };"
    "strength = { shear_modulus = 0.6; form = \"none\"; };";
enum { SIDE = 6, N = SIDE * SIDE * SIDE };

/* Rock in disorder; a plane of it is body 1. */
static Parts *rock(void)
{
  Parts *p = lab_parts(N, 3, ROCK);
  for (int i = 0; i < N; i++) {
    const int at[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
    for (int d = 0; d < 3; d++) {
      p->x[3 * i + d] = (at[d] + .5) / SIDE;
      p->v[3 * i + d] = .4 * (rng_uniform(5, (uint64_t)i, (uint32_t)d) - .5);
    }
    p->m[i] = 1. / N, p->rho[i] = 1, p->h[i] = 2.2 / SIDE, p->body[i] = at[0] == 2;
  }
  return p;
}

static Parts *run(const Param *par, const char *device)
{
  Parts *p = rock();
  Sim sim;
  Err err;
  if (sim_open(&sim, par, p, device, &err)) fail_msg("%s", err.text);
  lab_run(&sim, 0.01 * (double)small_or(30, 2));
  lab_store(&sim, p);
  sim_close(&sim);
  return p;
}

static void same(void **state)
{
  static const char *const integrators[] = {"integrator=leapfrog", "integrator=rk2-adaptive",
                                            "integrator=ab2"};
  static const char *const densities[] = {"density=continuity", "density=sum", "density=miscible"};
  static const char *const forms[] = {
      "pressure_form=product stress_form=squares form.xsph=0.5 form.diffusion=0.1 "
      "viscosity.switch=cullen_dehnen stress.artificial=0.3",
      "viscosity.kinematic=0.02 viscosity.bulk=0.01 viscosity.compression=0.5 strength.on=false",
      "density=miscible_continuity form.xsph=0.3 viscosity.balsara=true stress.artificial=0.2",
      "form.shepard=true form.xsph=0.5 stress_form=squares",
      "form.grad_h=true density=sum smoothing.max=1.15"};
  (void)state;
  for (int at = 0; at < 8; at++) {
    const int k = at % 3;
    const char *more = at < 3 ? "" : forms[at - 3];
    Param par = lab_param("gravity.method=none", "boundary.x=periodic", "boundary.y=mirror",
                          "boundary.z=mirror_low", "boundary.high=1,1,1", "walls.body1=0.1,0,0",
                          "layer.low=0,0,0", integrators[k],
                          at < 3 ? densities[k] : "density=continuity", NULL);
    Err err;
    lab_set(&par, more);
    par.precision = PARAM_DOUBLE;
    if (k == 2) par.faces[2] = PARAM_NO_SLIP_LOW;
    if (k == 0) par.faces[2] = PARAM_OPEN, par.layer_high[2] = 4 * 2.2 / SIDE;
    assert_return_code(param_set(&par, "step.max=0.02", &err), 0);
    Parts *a = run(&par, "cpu"), *b = run(&par, "cuda"), *c = run(&par, "cuda");
    double worst = 0;
    for (int i = 0; i < N; i++) {
      worst = fmax(worst, fabs(a->rho[i] - b->rho[i]));
      for (int d = 0; d < 3; d++)
        worst = fmax(worst, fabs(a->x[3 * i + d] - b->x[3 * i + d]) +
                                fabs(a->v[3 * i + d] - b->v[3 * i + d]));
      for (int d = 0; d < 6 && par.strength; d++)
        worst = fmax(worst, fabs(a->s[6 * i + d] - b->s[6 * i + d]));
    }
    print_message("%s %s: %.1e\n", integrators[k], *more ? more : densities[k], worst);
    assert_true(worst < 1e-11);
    assert_memory_equal(b->x, c->x, sizeof(double) * 3 * N);
    assert_memory_equal(b->v, c->v, sizeof(double) * 3 * N);
    part_free(a), part_free(b), part_free(c);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(same)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
