/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Neighbour lists of the CUDA backend against brute force: who interacts at x or at y is listed,
 * ascending, once; who does not is not, as long as neighbours move together. All shapes, sizes
 * around those of warps, tiles and what the tiles hold; lists that must grow. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include "tree_lab.cuh"
extern "C" {
#include <cmocka.h>
}
#include "small.h"

typedef struct {
  size_t n;
  std::vector<double> x, y, h, ha;
  std::vector<int64_t> start;
  std::vector<int> count;
  std::vector<uint32_t> list;
} Found;

static Found search(TreeLab *l)
{
  tree_lab_search(l);
  const size_t n = (size_t)l->n;
  const Lists &d = cuda_of(&l->sim)->lists;
  const State &s = l->sim.s;
  return {n,
          tree_lab_get(l, s.x, 3 * n),
          tree_lab_get(l, s.y, 3 * n),
          tree_lab_get(l, s.h, n),
          tree_lab_get(l, s.ha, n),
          tree_lab_get(l, d.start, (n + 31) / 32),
          tree_lab_get(l, d.count, n),
          tree_lab_get(l, d.list, (size_t)d.room)};
}

static double distance(const std::vector<double> &x, size_t i, size_t j)
{
  double r2 = 0;
  for (size_t d = 0; d < 3; d++)
    r2 += (x[3 * i + d] - x[3 * j + d]) * (x[3 * i + d] - x[3 * j + d]);
  return sqrt(r2);
}

/* slack: how much further apart than their support a listed pair may be; returns the number of
 * listed pairs that do not interact. */
static long check_lists(const Found &f, double slack)
{
  long more = 0;
  for (size_t i = 0; i < f.n; i++) {
    int k = 0;
    for (size_t j = 0; j < f.n; j++) {
      const double r = distance(f.x, i, j), h = 0.5 * (f.h[i] + f.h[j]);
      const bool near = r < h || distance(f.y, i, j) < 0.5 * (f.ha[i] + f.ha[j]);
      const bool listed = k < f.count[i] &&
                          f.list[(size_t)f.start[i / 32] + 32 * (size_t)k + i % 32] == (uint32_t)j;
      k += listed;
      if (i == j ? listed : near && !listed)
        fail_msg("%zu of %zu lacks (or is its own) neighbour %zu: %g of %g", i, f.n, j, r, h);
      if (listed && !(r < h * (1 + 3e-5) + slack))
        fail_msg("%zu has %zu: %g, more than %g", i, j, r, h);
      more += listed && !near;
    }
    assert_int_equal(k, f.count[i]); /* all entries seen, so ascending */
  }
  return more;
}

static Cloud still(int shape, long n, int seed, double spread)
{
  Cloud c = cloud_new((CloudShape)shape, n, seed, spread);
  memcpy(c.y, c.x, 24 * (size_t)n);
  return c;
}

static void at_x(void **state)
{
  (void)state;
  const std::vector<long> sizes = small_or(0, 1) ? std::vector<long>{1, 33, 300}
                                                 : std::vector<long>{1, 2, 17, 33, 64, 300, 1200};
  for (int shape = 0; shape < SHAPES; shape++)
    for (long n : sizes) {
      Cloud c = still(shape, n, 3, shape % 2 ? 5 : 1);
      TreeLab *l = tree_lab_open(&c, NULL);
      l->sim.step = 4 * n;
      const Found f = search(l);
      const Root root = tree_lab_get(l, cuda_of(&l->sim)->root, 1)[0];
      const long more = check_lists(f, 3 * root.edge * PLACE_CELL);
      if (shape != PAIRS) assert_true(more <= n / 100);
      cloud_free(&c), tree_lab_close(l);
    }
}

/* y: moved by 40 h as a whole, and by 0.15 h each. */
static void at_x_and_y(void **state)
{
  (void)state;
  for (int shape = 0; shape < SHAPES; shape++)
    for (long n : {40L, 1000L}) {
      Cloud c = cloud_new((CloudShape)shape, n, 4, 3);
      TreeLab *l = tree_lab_open(&c, NULL);
      const double apart = 0.3 * (shape == PAIRS ? 1e5 : 1e6 * cbrt(40 / (double)n));
      check_lists(search(l), 2 * sqrt(3.) * apart);
      cloud_free(&c), tree_lab_close(l);
    }
}

/* Two bodies that pass each other at many h a step: no list holds more than what interacts. */
static void bodies_that_pass(void **state)
{
  (void)state;
  Cloud c = still(TWO_BODIES, 1000, 5, 1);
  for (long i = 0; i < c.n; i++) c.y[3 * i] += c.x[3 * i] > 2.1e6 ? 3e6 : -5e6;
  TreeLab *l = tree_lab_open(&c, NULL);
  const Found f = search(l);
  long pairs = 0;
  for (int k : f.count) pairs += k;
  assert_true(check_lists(f, 8e6) < pairs / 100);
  cloud_free(&c), tree_lab_close(l);
}

/* h that differ by 100; particles scattered over a box 1000 times as wide; all within reach of all:
 * more candidates than the tiles hold, lists longer than there was room for. */
static void hard_cases(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    Cloud c = still(k == 3 ? COINCIDENT : SPHERE, 1500, 6, 1);
    for (long i = 0; i < c.n; i++) {
      if (k == 0 && i % 97 == 0) c.h[i] *= 100;
      if (k == 0 && i % 89 == 0) c.h[i] /= 100;
      for (int d = 0; d < 3 && k == 1 && i % 3 == 0; d++)
        c.x[3 * i + d] *= 1000 * cloud_random(8, i, d);
      if (k >= 2) c.h[i] = 2.1e6 * (k == 3 ? 0.1 : 1);
    }
    memcpy(c.y, c.x, 24 * (size_t)c.n);
    TreeLab *l = tree_lab_open(&c, NULL);
    const Found f = search(l);
    check_lists(f, 0);
    const int scattered = cuda_of(&l->sim)->order->host->scattered;
    if (k == 1) assert_true(scattered > order_first(c.n)); /* more than may go first */
    if (k == 2) assert_true(scattered == 0 && f.count[0] == 1499);
    if (k == 3) assert_true(f.count[0] == 749);
    cloud_free(&c), tree_lab_close(l);
  }
}

/* Few groups of debris among many that are not: these go first, and all are there. */
static void debris_first(void **state)
{
  (void)state;
  Cloud c = still(SPHERE, 1500, 12, 1);
  for (long i = 0; i < 60; i++)
    for (int d = 0; d < 3; d++) c.x[3 * i + d] *= 1000 * cloud_random(13, i, d);
  memcpy(c.y, c.x, 24 * (size_t)c.n);
  TreeLab *l = tree_lab_open(&c, NULL);
  check_lists(search(l), 0);
  const struct CudaOrder *o = cuda_of(&l->sim)->order;
  const size_t groups = (size_t)(c.n + 31) / 32;
  const int scattered = o->host->scattered;
  assert_true(scattered > 0 && scattered <= order_first(c.n));
  std::vector<char> is = tree_lab_get(l, o->is_first, groups);
  for (int group : tree_lab_get(l, o->first, (size_t)scattered))
    assert_int_equal(is[(size_t)group]--, 1);
  for (char left : is) assert_int_equal(left, 0);
  cloud_free(&c), tree_lab_close(l);
}

/* ha larger than h, and the other way round. */
static void two_supports(void **state)
{
  (void)state;
  Cloud c = cloud_new(SPHERE, 600, 9, 2);
  TreeLab *l = tree_lab_open(&c, NULL);
  std::vector<double> ha(600);
  for (size_t i = 0; i < 600; i++) ha[i] = c.h[i] * (0.8 + 0.4 * cloud_random(10, (long)i, 0));
  tree_lab_put(l, l->sim.s.ha, ha.data(), 600);
  check_lists(search(l), 1e6);
  cloud_free(&c), tree_lab_close(l);
}

/* A regular lattice, h = 2 spacings: 26 neighbours inside (those at exactly 2 may be listed). */
static void lattice_shells(void **state)
{
  (void)state;
  Cloud c = still(SPHERE, 729, 11, 1);
  for (long i = 0; i < 729; i++) {
    c.h[i] = 2, c.id[i] = i;
    for (int d = 0, k = (int)i; d < 3; d++, k /= 9) c.x[3 * i + d] = k % 9;
  }
  memcpy(c.y, c.x, 24 * 729);
  TreeLab *l = tree_lab_open(&c, NULL);
  const Found f = search(l);
  check_lists(f, 0);
  for (size_t i = 0; i < 729; i++) {
    int near = 0, inside = 1;
    for (int k = 0; k < f.count[i]; k++)
      near += distance(f.x, i, f.list[(size_t)f.start[i / 32] + 32 * (size_t)k + i % 32]) < 1.9;
    for (size_t d = 0; d < 3; d++) inside &= f.x[3 * i + d] > 1 && f.x[3 * i + d] < 7;
    if (inside) assert_int_equal(near, 26);
  }
  cloud_free(&c), tree_lab_close(l);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(at_x),
                                     cmocka_unit_test(at_x_and_y),
                                     cmocka_unit_test(bodies_that_pass),
                                     cmocka_unit_test(hard_cases),
                                     cmocka_unit_test(debris_first),
                                     cmocka_unit_test(two_supports),
                                     cmocka_unit_test(lattice_shells)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
