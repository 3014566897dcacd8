/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fragments: equal to the connected components of all pairs by brute force, for any order of
 * particles and number of threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include "lib/fof.h"
#include "lib/rng.h"

static Parts *cloud(long n, uint64_t seed, double h)
{
  Parts *p = part_new(n);
  assert_int_equal(part_add(p, "id x m h", NULL), 0);
  for (long i = 0; i < n; i++) {
    p->id[i] = 10 * i + 3, p->m[i] = 1 + floor(3 * rng_uniform(seed, (uint64_t)i, 3));
    p->h[i] = h * exp(1.6 * rng_uniform(seed, (uint64_t)i, 4)); /* they differ by a factor 5 */
    for (int a = 0; a < 3; a++) p->x[3 * i + a] = rng_uniform(seed, (uint64_t)i, (uint32_t)a);
  }
  return p;
}

static int friends(const Parts *p, long i, long j, double link)
{
  double r2 = 0, l = link * (p->h[i] + p->h[j]) / 2;
  for (int a = 0; a < 3; a++) r2 += pow(p->x[3 * i + a] - p->x[3 * j + a], 2);
  return r2 < l * l;
}

/* Labels by flooding all pairs; keep as in fof_find. */
static long *flood(const Parts *p, double link, const unsigned char *keep)
{
  long *label = calloc((size_t)p->n, sizeof *label), *stack = malloc((size_t)p->n * sizeof *stack),
       labels = 0;
  for (long s = 0; s < p->n; s++) {
    long top = 0;
    if (label[s] || (keep && !keep[s])) continue;
    label[s] = ++labels, stack[top++] = s;
    while (top) {
      long i = stack[--top];
      for (long j = 0; j < p->n; j++)
        if (!label[j] && (!keep || keep[j]) && friends(p, i, j, link))
          label[j] = labels, stack[top++] = j;
    }
  }
  free(stack);
  return label;
}

/* Same partition, and ids in order of mass. */
static void compare(const Parts *p, const int32_t *id, long n, const long *label)
{
  double *mass = calloc((size_t)n + 1, sizeof *mass);
  int64_t *first = calloc((size_t)n + 1, sizeof *first);
  for (long i = 0; i < p->n; i++) {
    assert_int_equal(id[i] > 0, label[i] > 0);
    if (id[i] > 0) mass[id[i]] += p->m[i];
    if (id[i] > 0 && (!first[id[i]] || p->id[i] < first[id[i]])) first[id[i]] = p->id[i];
    for (long j = 0; j < i; j++)
      if (label[i] && label[j]) assert_int_equal(id[i] == id[j], label[i] == label[j]);
  }
  for (long k = 1; k < n; k++)
    assert_true(mass[k] > mass[k + 1] || (mass[k] == mass[k + 1] && first[k] < first[k + 1]));
  free(mass), free(first);
}

static void equals_brute_force(void **state)
{
  (void)state;
  const double scale[] = {0.02, 0.04, 0.055, 0.07,
                          0.1}; /* from mostly single particles to one fragment */
  for (int s = 0; s < 5; s++) {
    Parts *p = cloud(700, 11 + (uint64_t)s, scale[s]);
    unsigned char keep[700];
    int32_t id[700];
    for (int i = 0; i < 700; i++) keep[i] = rng_uniform(5, (uint64_t)i, 0) < 0.8;
    for (int part = 0; part < 2; part++) {
      long *label = flood(p, 0.9, part ? keep : NULL),
           n = fof_find(p, 0.9, part ? keep : NULL, 1, id, NULL);
      assert_true(n > 0);
      compare(p, id, n, label);
      free(label);
    }
    part_free(p);
  }
}

static void any_order_and_threads(void **state)
{
  (void)state;
  enum { N = 3000 };
  Parts *p = cloud(N, 7, 0.025);
  int32_t id[N], again[N];
  long order[N], n = fof_find(p, 1, NULL, 2, id, NULL);
  assert_in_range(n, 50, 500);
  omp_set_num_threads(4);
  assert_int_equal(fof_find(p, 1, NULL, 2, again, NULL), n);
  assert_memory_equal(id, again, sizeof id);
  omp_set_num_threads(1);
  for (long i = 0; i < N; i++) order[i] = (i * 1511) % N; /* 1511 is prime */
  assert_int_equal(part_permute(p, order, NULL), 0);
  assert_int_equal(fof_find(p, 1, NULL, 2, again, NULL), n);
  for (long i = 0; i < N; i++) assert_int_equal(again[i], id[order[i]]);
  omp_set_num_threads(2);
  part_free(p);
}

/* A pair with h = 1 and 3: friends below link x 2, not at it. The law of the mean h, both ways. */
static void link_is_mean_and_open(void **state)
{
  (void)state;
  Parts *p = cloud(2, 1, 1);
  int32_t id[2];
  for (int a = 0; a < 6; a++) p->x[a] = 0;
  for (int swap = 0; swap < 2; swap++) {
    p->h[swap] = 1, p->h[1 - swap] = 3;
    p->x[3] = 2, assert_int_equal(fof_find(p, 1, NULL, 1, id, NULL), 2);
    p->x[3] = nextafter(2, 0), assert_int_equal(fof_find(p, 1, NULL, 1, id, NULL), 1);
    p->x[3] = 2.9, assert_int_equal(fof_find(p, 1.5, NULL, 1, id, NULL), 1);
    p->x[3] = 3, assert_int_equal(fof_find(p, 1.5, NULL, 1, id, NULL), 2);
    p->x[3] = 0, assert_int_equal(fof_find(p, 1e-9, NULL, 1, id, NULL), 1); /* coincident */
  }
  part_free(p);
}

static void few_particles(void **state)
{
  (void)state;
  Parts *p = cloud(3, 1, 1e-6);
  int32_t id[3];
  unsigned char none[3] = {0}, one[3] = {0, 1, 0};
  assert_int_equal(fof_find(p, 1, none, 1, id, NULL), 0);
  assert_int_equal(id[0] + id[1] + id[2], 0);
  assert_int_equal(fof_find(p, 1, one, 1, id, NULL), 1);
  assert_int_equal(id[0], 0), assert_int_equal(id[1], 1), assert_int_equal(id[2], 0);
  assert_int_equal(fof_find(p, 1, NULL, 1, id, NULL), 3);
  assert_int_equal(fof_find(p, 1, NULL, 2, id, NULL), 0);
  p->n = 0;
  assert_int_equal(fof_find(p, 1, NULL, 1, id, NULL), 0);
  p->n = 3;
  part_free(p);
}

/* A chain of particles one link apart is one fragment, however long; cut in the middle it is two.
 */
static void chain(void **state)
{
  (void)state;
  enum { N = 5000 };
  Parts *p = cloud(N, 1, 1);
  static int32_t id[N];
  for (long i = 0; i < N; i++)
    p->h[i] = 1, p->x[3 * i] = 0.99 * (double)i, p->x[3 * i + 1] = p->x[3 * i + 2] = 0;
  assert_int_equal(fof_find(p, 1, NULL, 1, id, NULL), 1);
  for (long i = N / 2; i < N; i++) p->x[3 * i] += 0.02;
  assert_int_equal(fof_find(p, 1, NULL, 1, id, NULL), 2);
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(equals_brute_force),
                                     cmocka_unit_test(any_order_and_threads),
                                     cmocka_unit_test(link_is_mean_and_open),
                                     cmocka_unit_test(few_particles), cmocka_unit_test(chain)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
