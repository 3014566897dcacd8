/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a run takes of a card's memory: what was said before, for every kind of run; with little of
 * it the same bits as with plenty. What does not fit is refused with one line before anything is
 * computed, and leaves nothing there. */
#include <math.h>
#include <stdlib.h>
#include "gpu.h"
#include "small.h"
#include "solver/cuda/cuda.h"
extern "C" {
#include "lib/lattice.h"
#include "lib/material.h"
#include "lib/weibull.h"
#include "solver/sim.h"
}

static const char rock[] =
    "name = \"rock\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };"
    "strength = { shear_modulus = 1.; form = \"von_mises\"; Y = 0.1; melt_energy = 1.5; };"
    "damage = { form = \"grady_kipp\"; k = 1e10; m = 5.; };";

static Err err;

static void need(int failed)
{
  if (failed) fail_msg("%s", err.text);
}

/* A ball of 57 neighbours a particle, falling apart. */
static Parts *ball(long n)
{
  LatticeBall b;
  WeibullGroup *group;
  WeibullOptions flaws = {};
  int groups;
  flaws.seed = 3, flaws.minimum = 1;
  need(lattice_ball(&b, LATTICE_HCP, 3, n, &err));
  Parts *p = part_new(b.n);
  need(part_add(p, "id x v m rho u h mat body", &err) || part_add_material(p, "rock", rock, &err));
  p->dimension = 3;
  for (long i = 0; i < b.n; i++) {
    for (int d = 0; d < 3; d++)
      p->x[3 * i + d] = b.x[3 * i + d], p->v[3 * i + d] = 0.01 * p->x[3 * i + d];
    p->id[i] = i, p->rho[i] = 1, p->m[i] = b.volume, p->u[i] = 1e-3;
    p->h[i] = cbrt(57 * 3 / (4 * 3.14159265358979) * b.volume);
  }
  Material *material = material_load(p, &err);
  need(!material || weibull_assign(p, material, &flaws, &group, &groups, &err));
  free(group), free(material), lattice_free(&b);
  return p;
}

/* Runs of every kind; what 1e8 particles may take of a card of 150 GB, flaws aside [B each]. */
typedef struct {
  const char *set[4];
  double most;
} Kind;
static const Kind kinds[] = {{{"precision=mixed"}, 1200},
                             {{"precision=double"}, 1300},
                             {{"strength.on=false"}, 900},
                             {{"strength.on=false", "density=sum", "gravity.every=3"}, 950},
                             {{"strength.damage=false", "gravity.method=none"}, 1050},
                             {{"strength.on=false", "gravity.method=none", "gravity.every=2"}, 800},
                             {{"density=miscible", "gravity.method=direct"}, 1150},
                             {{"integrator=rk2-adaptive", "gravity.method=direct"}, 2100}};

static Sim open_kind(const Kind *k, const Parts *p)
{
  Param par;
  Sim sim;
  param_defaults(&par);
  for (int s = 0; s < 4 && k->set[s]; s++) need(param_set(&par, k->set[s], &err));
  need(sim_open(&sim, &par, p, "cuda", &err));
  return sim;
}

/* To 2 %, once there are lists; and what a hundred million would take. */
static void as_announced(void **state)
{
  (void)state;
  Parts *p = ball(1500);
  for (const Kind &k : kinds) {
    Sim sim = open_kind(&k, p);
    Cuda *c = cuda_of(&sim);
    const double said = (double)cuda_bytes(&sim, p), taken = (double)c->bytes;
    sim.s.n = sim.s.room = 100000000, c->ample = 0;
    const double each = (double)(cuda_bytes(&sim, p)) * 1e-8;
    print_message("%s: said %.0f, taken %.0f B a particle; 1e8: %.0f\n", k.set[0],
                  said / (double)p->n, taken / (double)p->n, each);
    assert_true(fabs(said - taken) < 0.02 * said);
    assert_true(each < k.most);
    sim.s.n = sim.s.room = p->n;
    sim_close(&sim);
  }
  part_free(p);
}

/* The particles after some steps; little: with the spares and the staging of a full card. */
static Parts *after(const Kind *k, bool little)
{
  Parts *p = ball(300);
  Sim sim = open_kind(k, p);
  SimStep done;
  if (little) {
    cuda_order_close(&sim), cuda_store_close(&sim);
    cuda_of(&sim)->ample = 0;
    need(cuda_order_open(&sim, &err) || cuda_store_open(&sim, &err));
  }
  for (long n = small_or(5, 1); n > 0; n--) need(sim_advance(&sim, 1e9, &done, &err));
  need(sim_store(&sim, p, &err));
  sim_close(&sim);
  return p;
}

static void little_is_enough(void **state)
{
  (void)state;
  for (const Kind &k : kinds) {
    Parts *a = after(&k, false), *b = after(&k, true);
    for (int f = 0; f < part_field_count; f++) {
      const void *u = part_array(a, &part_fields[f]), *v = part_array(b, &part_fields[f]);
      assert_true(!u == !v);
      if (u && memcmp(u, v, (size_t)a->n * (size_t)part_fields[f].size))
        fail_msg("%s: %s differs", k.set[0], part_fields[f].name);
    }
    part_free(a), part_free(b);
  }
}

static const size_t SPARE = (size_t)200 << 20, /* bytes left on the card */
    ALLOCATOR = (size_t)4 << 20;               /* that it may keep of what was freed */

/* n particles of gas on a lattice. */
static Parts *gas(long n)
{
  static const char text[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";
  const long side = (long)ceil(cbrt((double)n));
  Parts *p = part_new(n);
  if (!p || part_add(p, "id x v m rho u h mat body", &err) ||
      part_add_material(p, "gas", text, &err))
    fail_msg("%s", p ? err.text : "no memory");
  p->dimension = 3;
  for (long i = 0; i < n; i++) {
    const long at[3] = {i % side, i / side % side, i / side / side};
    for (int d = 0; d < 3; d++) p->x[3 * i + d] = (double)at[d];
    p->id[i] = i, p->m[i] = p->rho[i] = p->u[i] = 1, p->h[i] = 2.4;
  }
  return p;
}

static size_t unused(void)
{
  size_t available = 0, total;
  CHECK(cudaMemGetInfo(&available, &total));
  expect_success();
  return available;
}

/* A card that is full but for SPARE. */
static void too_many(void **)
{
  if (small_or(0, 1)) skip(); /* others are on the card, too */
  char *others = nullptr;
  Parts *p = gas(200000), *few = gas(50);
  Param par;
  Sim sim;
  setenv("HOST_CUDA_MEMORY", "300000000", 1); /* on the host; a card has what it has */
  param_defaults(&par);
  assert_true(backend_cuda.cards() > 0);
  if (sim_open(&sim, &par, few, "cuda", &err)) fail_msg("%s", err.text); /* takes a context */
  sim_close(&sim);
  CHECK(cudaMalloc(&others, unused() - SPARE));
  const size_t before = unused();
  assert_int_equal(sim_open(&sim, &par, p, "cuda", &err), -1);
  print_message("%s\n", err.text);
  long enough = 0;
  const char *end = strstr(err.text, "enough for ");
  assert_non_null(strstr(err.text, "200000 particles do not fit on card 0: they need 0."));
  assert_non_null(end);
  assert_int_equal(sscanf(end, "enough for %ld", &enough), 1);
  assert_true(enough > 1000 && enough < 200000);
  assert_true(unused() + ALLOCATOR >= before);
  if (sim_open(&sim, &par, few, "cuda", &err)) fail_msg("%s", err.text); /* these fit */
  assert_non_null(strstr(sim.about, " B a particle"));
  sim_close(&sim);
  assert_true(unused() + ALLOCATOR >= before);
  CHECK(cudaFree(others));
  expect_success();
  part_free(p), part_free(few);
}

int main()
{
  const CMUnitTest tests[] = {cmocka_unit_test(as_announced), cmocka_unit_test(little_is_enough),
                              cmocka_unit_test(too_many)};
  return cmocka_run_group_tests(tests, nullptr, nullptr);
}
