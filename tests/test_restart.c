/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run that is stored at some step and continued from there ends with the bits of the run that
 * went on, for both integrators, all density modes, both gravities, strength
 * and damage; and no result depends on the number of threads. */
#include <omp.h>
#include "lab.h"
#include "../lib/rng.h"
#include "../lib/weibull.h"
#include "../lib/material.h"

static const char ROCK[] =
    "name = \"rock\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };"
    "strength = { shear_modulus = 1.; form = \"von_mises\"; Y = 0.1; };"
    "damage = { form = \"grady_kipp\"; k = 1e10; m = 5.; };";
static const char PUMICE[] =
    "name = \"p\"; eos = { form = \"murnaghan\"; rho0 = 1.3; K = 1.; n = 2.; heat_capacity = 0.1; "
    "};"
    "strength = { shear_modulus = 1.; form = \"johnson_cook\"; A = 0.05; B = 0.1; n = 0.5; T0 = "
    "1.; };"
    "damage = { form = \"grady_kipp\"; k = 1e10; m = 5.; };"
    "porosity = { form = \"p_alpha\"; alpha_0 = 1.3; c_elastic = 0.5; p_e = 1e-3; p_s = 0.3; };";
static const char WATER[] =
    "name = \"w\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };";

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* Two balls that run into each other, in a row order that is not the tree's; flaws, two bodies,
 * three materials, one of them porous and hot. */
static Parts *collision(void)
{
  double dx = .36;
  long n = lab_lattice(dx, 4, 3, in_ball, NULL, NULL);
  Parts *p = lab_parts(2 * n, 3, ROCK);
  double *x = malloc(sizeof(double) * 3 * (size_t)n);
  WeibullGroup *group;
  Material *material;
  int groups;
  Err err;
  assert_int_equal(part_add_material(p, "water", WATER, &err), 1);
  assert_int_equal(part_add_material(p, "p", PUMICE, &err), 2);
  lab_lattice(dx, 4, 3, in_ball, NULL, x);
  for (long i = 0; i < p->n; i++) {
    long k = (i * 7919) % p->n, body = k % 2;
    p->id[i] = 1000 + k, p->body[i] = (int32_t)body;
    for (int d = 0; d < 3; d++) p->x[3 * i + d] = x[3 * (k / 2) + d] + (d == 0 ? body * 2.2 : 0);
    p->v[3 * i] = body ? -.3 : .3, p->v[3 * i + 1] = body ? -.1 : .1;
    p->mat[i] = body ? p->x[3 * i] > 2.2 : 2 * (p->x[3 * i + 1] > 0);
    p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.2 * dx;
  }
  free(x);
  if (!(material = material_load(p, &err))) fail_msg("%s", err.text);
  assert_return_code(weibull_assign(p, material, &(WeibullOptions){.seed = 3, .minimum = 1}, &group,
                                    &groups, &err),
                     0);
  free(group), free(material);
  return p;
}

static void steps(Sim *sim, int n)
{
  Err err;
  SimStep done;
  for (int k = 0; k < n; k++)
    if (sim_advance(sim, 1e9, &done, &err)) fail_msg("%s", err.text);
}

/* Every field, bit for bit; by id when the rows differ. */
static void same(const Parts *a, const Parts *b, const char *what)
{
  assert_true(a->time == b->time);
  for (long i = 0; i < a->n; i++) {
    long j = i;
    if (a->id[i] != b->id[j])
      for (j = 0; j < b->n && b->id[j] != a->id[i];) j++;
    for (int f = 0; f < part_field_count; f++) {
      const char *u = part_array(a, &part_fields[f]), *v = part_array(b, &part_fields[f]);
      size_t size = (size_t)part_fields[f].size;
      assert_true(!u == !v);
      if (u && memcmp(u + (size_t)i * size, v + (size_t)j * size, size))
        fail_msg("%s: %s of particle %ld differs", what, part_fields[f].name, (long)a->id[i]);
    }
  }
}

typedef struct {
  const char *integrator, *density, *gravity, *more;
} Case;

#define FLUID                                                                                      \
  "viscosity.kinematic=0.01 viscosity.compression=0.5 heating.rate=0.1 heating.end=0.1 "           \
  "force.x=0.1"
#define RICH                                                                                       \
  "pressure_form=product stress_form=squares form.xsph=0.5 form.diffusion=0.1 "                    \
  "viscosity.switch=cullen_dehnen stress.artificial=0.3"
static const Case cases[] = {
    {"integrator=leapfrog", "density=continuity", "gravity.method=tree", "step.cfl=0.4"},
    {"integrator=leapfrog", "density=sum", "gravity.method=direct", "damping.rate=0.1"},
    {"integrator=leapfrog", "density=continuity", "gravity.method=tree", "gravity.every=7"},
    {"integrator=leapfrog", "gravity.every=50", "output.log_every=1000", "gravity.tolerance=0.05"},
    {"integrator=leapfrog", "density=miscible", "gravity.method=tree", "precision=double"},
    {"integrator=leapfrog", "density=continuity", "gravity.method=none",
     "smoothing.mode=neighbours"},
    {"integrator=leapfrog", "density=continuity", "gravity.method=none", "energy=isentropic"},
    {"integrator=leapfrog", "density=continuity", "gravity.method=none", FLUID},
    {"integrator=rk2-adaptive", "density=continuity", "gravity.method=none", FLUID},
    {"integrator=leapfrog", "density=continuity", "gravity.method=none", RICH},
    {"integrator=leapfrog", "density=miscible_continuity", "gravity.method=none",
     "form.gradient=raw"},
    {"integrator=rk2-adaptive", "density=continuity", "gravity.method=none", "form.shepard=true"},
    {"integrator=leapfrog", "density=sum", "gravity.method=tree", "form.grad_h=true"},
    {"integrator=ab2", "density=continuity", "gravity.method=none", RICH},
    {"integrator=rk2-adaptive", "density=continuity", "gravity.method=tree", "step.error=1e-3"},
    {"integrator=rk2-adaptive", "density=sum", "gravity.method=direct", "step.error=1e-4"},
    {"integrator=rk2-adaptive", "density=miscible", "gravity.method=tree", "strength.on=false"},
    {"integrator=rk3-tvd", "density=continuity", "gravity.method=tree", "damping.rate=0.1"},
    {"integrator=predictor-corrector", "density=continuity", "gravity.method=none",
     "smoothing.mode=neighbours"},
    {"integrator=ab2", "density=continuity", "gravity.method=tree", "step.cfl=0.3"},
    {"integrator=ab2", "density=sum", "gravity.method=none", "precision=double"},
    {"integrator=leapfrog", "density=continuity", "gravity.method=none",
     "smoothing.mode=overcorrected smoothing.neighbours=90 step.smoothing=0.1 step.distention=0.01 "
     "step.stress=1"},
    {"integrator=leapfrog", "density=continuity", "gravity.method=tree",
     "late.time=0.5 late.bulk_modulus=0.1"},
    {"integrator=ab2", "density=continuity", "gravity.method=none",
     "late.time=0.8 late.bulk_modulus=0.1"},
    {"integrator=euler", "density=continuity", "gravity.method=tree", "step.cfl=0.1"},
};

static Param settings(const Case *c)
{
  Param par = lab_param("gravity.G=0.1", c->integrator, c->density, c->gravity, NULL);
  lab_set(&par, c->more);
  return par;
}

static double most(const double *a, long n)
{
  double top = 0;
  for (long i = 0; i < n; i++) top = fmax(top, a[i]);
  return top;
}

static void restart(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    Parts *p = collision(), *q = collision();
    Param par = settings(&cases[k]);
    int before = 20 + (int)(30 * rng_uniform(5, k, 0));
    Sim sim, again;
    Sums unused;
    Err err;
    lab_open(&sim, &par, p);
    steps(&sim, before);
    lab_store(&sim, q);
    lab_sums(&sim, &unused); /* which changes nothing */
    steps(&sim, 50);
    lab_store(&sim, p);
    if (sim_restart(&again, &par, q, lab_device(), &err)) fail_msg("%s", err.text);
    assert_true(again.step == before);
    steps(&again, 50);
    lab_store(&again, q);
    print_message("%s %s %s: %d + 50 steps, t = %.3f, damage to %.2f\n", cases[k].integrator,
                  cases[k].density, cases[k].more, before, sim.time, most(p->damage, p->n));
    same(p, q, cases[k].more);
    assert_true(sim.dt == again.dt && sim.step == again.step);
    sim_close(&sim), sim_close(&again);
    part_free(p), part_free(q);
  }
}

/* One thread or two, the rows in order or backwards: the same bits for each id. */
static void order(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    Parts *p[2] = {collision(), collision()};
    Param par = settings(&cases[k]);
    long *back = malloc(sizeof(long) * (size_t)p[1]->n);
    Err err;
    for (long i = 0; i < p[1]->n; i++) back[i] = p[1]->n - 1 - i;
    assert_return_code(part_permute(p[1], back, &err), 0);
    for (int way = 0; way < 2; way++) {
      Sim sim;
      omp_set_num_threads(1 + way);
      lab_open(&sim, &par, p[way]);
      steps(&sim, 12);
      lab_store(&sim, p[way]);
      sim_close(&sim);
    }
    same(p[0], p[1], cases[k].more);
    free(back);
    part_free(p[0]), part_free(p[1]);
  }
  omp_set_num_threads(1);
}

/* What cannot be continued is refused. */
static void refused(void **state)
{
  Parts *p = collision();
  Param par = lab_param("gravity.method=none", NULL);
  Sim sim;
  Err err;
  (void)state;
  assert_int_equal(sim_restart(&sim, &par, p, lab_device(), &err), -1);
  assert_non_null(strstr(err.text, "checkpoint"));
  assert_int_equal(sim_open(&sim, &par, p, "abacus", &err), -1);
  assert_non_null(strstr(err.text, "'abacus'"));
  par = lab_param("gravity.every=2", "integrator=rk2-adaptive", NULL);
  assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
  assert_non_null(strstr(err.text, "gravity.every"));
  part_free(p);
  p = collision(), par = lab_param("gravity.method=none", NULL); /* pores that are not there */
  for (long i = 0; i < p->n; i++) p->rho[i] = 1.3;
  assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
  assert_non_null(strstr(err.text, "as dense as the solid of 'p': its bulk has 1"));
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(restart), cmocka_unit_test(order),
                                     cmocka_unit_test(refused)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
