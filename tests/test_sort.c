/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orders against the definition: ascending, equal keys in their order, a permutation; for any
 * number of threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include "lib/rng.h"
#include "lib/sort.h"

enum { N = 30000 };
static const long sizes[] = {0, 1, 2, 3, 100, 4096, 4097, N};

static uint64_t draw(long k, int kind)
{
  uint64_t r = (uint64_t)(rng_uniform(7, (uint64_t)k, 0) * 0x1p53);
  switch (kind) {
  case 0: return r << 11 ^ r;        /* all bits */
  case 1: return r % 5;              /* many equal */
  case 2: return (r % 3) << 62 | 77; /* only the highest bits differ */
  case 3: return (uint64_t)k;        /* sorted */
  default: return (uint64_t)(N - k); /* the wrong way round */
  }
}

static void is_permutation(long n, const long *order)
{
  char *seen = calloc((size_t)n + 1, 1);
  for (long k = 0; k < n; k++) {
    assert_in_range(order[k], 0, n - 1);
    assert_int_equal(seen[order[k]]++, 0);
  }
  free(seen);
}

static void keys(void **state)
{
  (void)state;
  static uint64_t key[N];
  static long order[N], again[N];
  for (int kind = 0; kind < 5; kind++)
    for (int s = 0; s < 8; s++) {
      const long n = sizes[s];
      for (long k = 0; k < n; k++) key[k] = draw(k, kind);
      omp_set_num_threads(2);
      assert_int_equal(sort_keys(n, key, order), 0);
      is_permutation(n, order);
      for (long k = 1; k < n; k++) {
        const uint64_t a = key[order[k - 1]], b = key[order[k]];
        assert_true(a < b || (a == b && order[k - 1] < order[k]));
      }
      omp_set_num_threads(5);
      assert_int_equal(sort_keys(n, key, again), 0);
      assert_memory_equal(order, again, (size_t)n * sizeof *order);
    }
  omp_set_num_threads(2);
}

static void signed_and_real(void **state)
{
  (void)state;
  static int64_t id[N];
  static double x[N];
  static long order[N];
  for (int s = 0; s < 8; s++) {
    const long n = sizes[s];
    for (long k = 0; k < n; k++) {
      id[k] = (int64_t)draw(k, 0) >> (k % 60);
      x[k] = ldexp(rng_normal(3, (uint64_t)k, 0), (int)(k % 700) - 350);
      if (k % 1000 == 0) id[k] = INT64_MIN + k, x[k] = k % 2000 ? -INFINITY : INFINITY;
    }
    assert_int_equal(sort_ids(n, id, order), 0);
    is_permutation(n, order);
    for (long k = 1; k < n; k++) assert_true(id[order[k - 1]] <= id[order[k]]);
    assert_int_equal(sort_reals(n, x, order), 0);
    is_permutation(n, order);
    for (long k = 1; k < n; k++) assert_true(x[order[k - 1]] <= x[order[k]]);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(keys), cmocka_unit_test(signed_and_real)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
