/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What does not fit on a card is refused with one line before anything is computed, and leaves
 * nothing there; what fits is told beforehand. */
#include <math.h>
#include <stdlib.h>
#include "gpu.h"
extern "C" {
#include "lib/part.h"
#include "solver/sim.h"
}

static const size_t SPARE = (size_t)200 << 20, /* bytes left on the card */
    ALLOCATOR = (size_t)4 << 20;               /* that it may keep of what was freed */

/* n particles of gas on a lattice. */
static Parts *gas(long n)
{
  static const char text[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";
  const long side = (long)ceil(cbrt((double)n));
  Err err;
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
  char *others = nullptr;
  Parts *p = gas(200000), *few = gas(50);
  Param par;
  Sim sim;
  Err err;
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
  const CMUnitTest tests[] = {cmocka_unit_test(too_many)};
  return cmocka_run_group_tests(tests, nullptr, nullptr);
}
