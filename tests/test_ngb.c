/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Neighbour lists equal brute force: all shapes, one and two sets of positions, h that differ by a
 * factor 5. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "cloud.h"
#include "lib/ngb.h"

#define PI 3.14159265358979323846

static Err err;
static const long SIZES[] = {1, 2, 17, 500, 2000};
#define FOR_SIZES(N) for (const long *N = SIZES; N < SIZES + sizeof SIZES / sizeof *SIZES; N++)

static double distance2(const double *a, const double *b)
{
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

static int neighbours(const Cloud *c, const double *y, double factor, long i, long j)
{
  const double l = 0.5 * factor * (c->h[i] + c->h[j]);
  return distance2(c->x + 3 * i, c->x + 3 * j) < l * l ||
         (y && distance2(y + 3 * i, y + 3 * j) < l * l);
}

/* Returns the number of pairs. */
static int64_t check_lists(const Ngb *g, const Cloud *c, const double *y, double factor)
{
  assert_true(g->n == c->n && g->start[0] == 0);
  for (long i = 0; i < c->n; i++) {
    int64_t at = g->start[i];
    for (long j = 0; j < c->n; j++)
      if (j != i && neighbours(c, y, factor, i, j)) {
        assert_true(at < g->start[i + 1]);
        assert_true(g->list[at++] == (uint32_t)j);
      }
    assert_true(at == g->start[i + 1]);
  }
  return g->start[c->n];
}

static void lists_equal_brute_force(void **state)
{
  (void)state;
  Tree t = {0};
  Ngb g = {0};
  for (int shape = 0; shape < SHAPES; shape++) FOR_SIZES(n) for (int kind = 0; kind < 4; kind++)
    {
      Cloud c = cloud_new(shape, *n, kind, kind % 2 ? 5 : 1);
      const double *y = kind / 2 ? c.y : NULL, factor = kind == 3 ? 1.3 : 1;
      assert_int_equal(tree_build(&t, c.n, c.x, NULL, c.h, &err), 0);
      assert_int_equal(ngb_search(&g, &t, c.x, y, c.h, factor, &err), 0);
      int64_t pairs = check_lists(&g, &c, y, factor);
      if (*n >= 500) assert_true(pairs > 0);
      cloud_free(&c);
    }
  tree_free(&t), ngb_free(&g);
}

typedef struct {
  const Ngb *lists;
  int seen[2000], wrong;
} Visits;

static void visited(long i, const uint32_t *j, long n, void *data)
{
  Visits *s = data;
  const int64_t b = s->lists->start[i];
  s->seen[i]++;
  if (n != s->lists->start[i + 1] - b || memcmp(j, s->lists->list + b, (size_t)n * sizeof *j))
#pragma omp atomic
    s->wrong++;
}

/* Each particle is visited once, with the neighbours of its list. */
static void each_sees_its_list(void **state)
{
  (void)state;
  Tree t = {0};
  Ngb g = {0};
  for (int shape = 0; shape < SHAPES; shape++) FOR_SIZES(n)
    {
      static Visits s;
      Cloud c = cloud_new(shape, *n, 5, 5);
      s = (Visits){.lists = &g};
      assert_int_equal(tree_build(&t, c.n, c.x, NULL, c.h, &err), 0);
      assert_int_equal(ngb_search(&g, &t, c.x, NULL, c.h, 1.2, &err), 0);
      assert_int_equal(ngb_each(&t, c.x, c.h, 1.2, visited, &s, &err), 0);
      assert_int_equal(s.wrong, 0);
      for (long i = 0; i < c.n; i++) assert_int_equal(s.seen[i], 1);
      cloud_free(&c);
    }
  tree_free(&t), ngb_free(&g);
}

/* A tree that was refitted to moved particles misses nothing. */
static void refitted_trees_serve(void **state)
{
  (void)state;
  Tree t = {0};
  Ngb g = {0};
  Cloud c = cloud_new(CLUSTERS, 2000, 7, 5);
  assert_int_equal(tree_build(&t, c.n, c.x, NULL, c.h, &err), 0);
  for (long i = 0; i < c.n; i++) {
    c.h[i] *= 1.2;
    for (int d = 0; d < 3; d++) c.x[3 * i + d] = 2 * c.x[3 * i + d] - c.y[3 * i + d];
  }
  tree_refit(&t, c.x, NULL, c.h);
  assert_int_equal(ngb_search(&g, &t, c.x, NULL, c.h, 1, &err), 0);
  check_lists(&g, &c, NULL, 1);
  tree_free(&t), ngb_free(&g), cloud_free(&c);
}

/* Pairs of PAIRS stand within 1e-13 of the limit, far inside the rounding of single precision: some
 * are listed, some are not, and both members agree. */
static void the_limit_is_sharp(void **state)
{
  (void)state;
  Tree t = {0};
  Ngb g = {0};
  Cloud c = cloud_new(PAIRS, 2000, 8, 1);
  long in = 0, out = 0;
  assert_int_equal(tree_build(&t, c.n, c.x, NULL, c.h, &err), 0);
  assert_int_equal(ngb_search(&g, &t, c.x, NULL, c.h, 1, &err), 0);
  for (long i = 0; i < c.n; i++)
    for (long j = 0; j < c.n; j++)
      if (fabs(sqrt(distance2(c.x + 3 * i, c.x + 3 * j)) - 1e5) < 1e-7) {
        int found = 0;
        for (int64_t k = g.start[i]; k < g.start[i + 1]; k++) found |= g.list[k] == (uint32_t)j;
        assert_true(found == neighbours(&c, NULL, 1, i, j));
        in += found, out += !found;
      }
  assert_true(in > 100 && out > 100);
  tree_free(&t), ngb_free(&g), cloud_free(&c);
}

/* Simple cubic lattice of unit spacing, h = 2: 6 + 12 + 8 neighbours at 1, sqrt 2, sqrt 3; those at
 * 2 do not interact. */
static void lattice_shells(void **state)
{
  (void)state;
  enum { W = 9, N = W * W * W };
  static double raw[3 * N], x[3 * N], h[N];
  static long order[N];
  for (int i = 0; i < N; i++)
    raw[3 * i] = i % W, raw[3 * i + 1] = i / W % W, raw[3 * i + 2] = i / W / W, h[i] = 2;
  assert_int_equal(tree_order(N, raw, NULL, 0, order, &err), 0);
  for (int k = 0; k < N; k++) memcpy(x + 3 * k, raw + 3 * order[k], 24);
  Tree t = {0};
  Ngb g = {0};
  assert_int_equal(tree_build(&t, N, x, NULL, h, &err), 0);
  assert_int_equal(ngb_search(&g, &t, x, NULL, h, 1, &err), 0);
  for (int k = 0; k < N; k++) {
    int inside = 1;
    for (int d = 0; d < 3; d++) inside &= x[3 * k + d] > 1 && x[3 * k + d] < W - 2;
    if (inside) assert_int_equal(g.start[k + 1] - g.start[k], 26);
  }
  tree_free(&t), ngb_free(&g);
}

/* Particles much closer together than h, 1e-25 of it: all are neighbours, and nothing else is. */
static void far_below_h(void **state)
{
  (void)state;
  Tree t = {0};
  Ngb g = {0};
  Cloud c = cloud_new(SPHERE, 300, 14, 1);
  for (long i = 0; i < 3 * c.n; i++) c.x[i] *= 1e-25;
  assert_int_equal(tree_build(&t, c.n, c.x, NULL, c.h, &err), 0);
  assert_int_equal(ngb_search(&g, &t, c.x, NULL, c.h, 1, &err), 0);
  assert_true(check_lists(&g, &c, NULL, 1) == c.n * (c.n - 1));
  tree_free(&t), ngb_free(&g), cloud_free(&c);
}

static void threads_do_not_matter(void **state)
{
  (void)state;
  Cloud c = cloud_new(CLUSTERS, 3000, 9, 5);
  Tree t = {0};
  Ngb a = {0}, b = {0};
  const int threads = omp_get_max_threads();
  assert_int_equal(tree_build(&t, c.n, c.x, NULL, c.h, &err), 0);
  omp_set_num_threads(1);
  assert_int_equal(ngb_search(&a, &t, c.x, c.y, c.h, 1, &err), 0);
  omp_set_num_threads(3);
  assert_int_equal(ngb_search(&b, &t, c.x, c.y, c.h, 1, &err), 0);
  omp_set_num_threads(threads);
  assert_memory_equal(a.start, b.start, (size_t)(c.n + 1) * sizeof *a.start);
  assert_memory_equal(a.list, b.list, (size_t)a.start[c.n] * sizeof *a.list);
  tree_free(&t), ngb_free(&a), ngb_free(&b), cloud_free(&c);
}

static void bad_input_is_refused(void **state)
{
  (void)state;
  Cloud c = cloud_new(SPHERE, 500, 10, 5);
  Tree t = {0};
  Ngb g = {0};
  assert_int_equal(tree_build(&t, c.n, c.x, NULL, c.h, &err), 0);
  double *wrong[] = {&c.x[3 * 77 + 2], &c.y[3 * 77], &c.h[77], &c.h[77]};
  const double value[] = {1e9, NAN, 1e9, -1};
  for (int k = 0; k < 4; k++) {
    const double keep = *wrong[k];
    *wrong[k] = value[k];
    assert_int_equal(ngb_search(&g, &t, c.x, c.y, c.h, 1, &err), -1);
    assert_non_null(strstr(err.text, "particle number 77 "));
    *wrong[k] = keep;
  }
  assert_int_equal(ngb_search(&g, &t, c.x, c.y, c.h, 1, &err), 0);
  tree_free(&t), ngb_free(&g), cloud_free(&c);
}

typedef struct {
  long n, last;
  double sum;
} Seen;

static void see(long j, double r2, void *data)
{
  Seen *s = data;
  assert_true(j > s->last);
  s->last = j, s->n++, s->sum += r2 * (double)(j + 1);
}

static void point_visits_all_within_reach(void **state)
{
  (void)state;
  Tree t = {0};
  for (int shape = 0; shape < SHAPES; shape++) {
    Cloud c = cloud_new(shape, 2000, 11, 5);
    assert_int_equal(tree_build(&t, c.n, c.x, NULL, c.h, &err), 0);
    for (int k = 0; k < 60; k++) { /* beside particles, with and without h, radius 0 to a body */
      double x0[3], radius = k % 3 ? 1e5 * (k % 7) : 0;
      const double *h = k % 2 ? c.h : NULL;
      for (int d = 0; d < 3; d++) x0[d] = c.x[3 * (33 * k) + d] + 1e5 * cloud_random(1, k, d);
      Seen s = {0, -1, 0}, all = s;
      ngb_point(&t, c.x, h, x0, radius, see, &s);
      for (long j = 0; j < c.n; j++) {
        const double r2 = distance2(x0, c.x + 3 * j), reach = h ? fmax(radius, h[j]) : radius;
        if (r2 < reach * reach) see(j, r2, &all);
      }
      assert_true(s.n == all.n && s.last == all.last);
      assert_true(fabs(s.sum - all.sum) <= 1e-12 * all.sum);
    }
    cloud_free(&c);
  }
  tree_free(&t);
}

/* V n for h of particle i with the kernel's own normalisation, by brute force. sigma: 3/2, 7/pi,
 * 21/2pi integrate (1-q)^4 (1+4q) to 1 in 1D, 2D, 3D. */
static double held(const Cloud *c, int dimension, long i)
{
  const double h = c->h[i], volume[] = {0, 2 * h, PI * h * h, 4 * PI / 3 * h * h * h};
  const double sigma[] = {0, 1.5 / h, 7 / PI / (h * h), 21 / (2 * PI) / (h * h * h)};
  double n = 0;
  for (long j = 0; j < c->n; j++) {
    const double q = sqrt(distance2(c->x + 3 * i, c->x + 3 * j)) / h;
    if (q < 1) n += pow(1 - q, 4) * (1 + 4 * q);
  }
  return volume[dimension] * sigma[dimension] * n;
}

static void smoothing_holds_what_is_wanted(void **state)
{
  (void)state;
  Tree t = {0};
  const struct {
    CloudShape shape;
    int dimension;
    double want;
  } cases[] = {{LINE, 1, 7}, {PLANE, 2, 20}, {SPHERE, 3, 57}, {CLUSTERS, 3, 100}, {OUTLIER, 3, 30}};
  for (int k = 0; k < 5; k++) {
    Cloud c = cloud_new(cases[k].shape, 1000, 12, 1);
    assert_int_equal(tree_build(&t, c.n, c.x, NULL, NULL, &err), 0);
    assert_int_equal(ngb_smoothing(&t, c.x, cases[k].dimension, cases[k].want, c.h, &err), 0);
    for (long i = 0; i < c.n; i += 7)
      assert_true(fabs(held(&c, cases[k].dimension, i) / cases[k].want - 1) < 1e-5);
    cloud_free(&c);
  }
  tree_free(&t);
}

/* In a lattice of unit density V(h) = want to the accuracy of the kernel sum. */
static void smoothing_of_a_lattice(void **state)
{
  (void)state;
  enum { W = 11, N = W * W * W };
  static double raw[3 * N], x[3 * N], h[N];
  static long order[N];
  for (int i = 0; i < N; i++)
    raw[3 * i] = i % W, raw[3 * i + 1] = i / W % W, raw[3 * i + 2] = i / W / W;
  assert_int_equal(tree_order(N, raw, NULL, 0, order, &err), 0);
  for (int k = 0; k < N; k++) memcpy(x + 3 * k, raw + 3 * order[k], 24);
  Tree t = {0};
  assert_int_equal(tree_build(&t, N, x, NULL, NULL, &err), 0);
  assert_int_equal(ngb_smoothing(&t, x, 3, 57, h, &err), 0);
  for (int k = 0; k < N; k++)
    if (x[3 * k] == 5 && x[3 * k + 1] == 5 && x[3 * k + 2] == 5)
      assert_true(fabs(4 * PI / 3 * pow(h[k], 3) / 57 - 1) < 0.03);
  tree_free(&t);
}

static void smoothing_that_cannot_be(void **state)
{
  (void)state;
  Tree t = {0};
  Cloud few = cloud_new(SPHERE, 4, 13, 1), same = cloud_new(COINCIDENT, 200, 13, 1);
  assert_int_equal(tree_build(&t, few.n, few.x, NULL, NULL, &err), 0);
  assert_int_equal(ngb_smoothing(&t, few.x, 3, 57, few.h, &err), -1);
  assert_int_equal(ngb_smoothing(&t, few.x, 3, NAN, few.h, &err), -1);
  assert_int_equal(tree_build(&t, same.n, same.x, NULL, NULL, &err), 0);
  assert_int_equal(ngb_smoothing(&t, same.x, 3, 57, same.h, &err), -1);
  assert_non_null(strstr(err.text, "at one place"));
  tree_free(&t), cloud_free(&few), cloud_free(&same);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lists_equal_brute_force),
      cmocka_unit_test(each_sees_its_list),
      cmocka_unit_test(refitted_trees_serve),
      cmocka_unit_test(the_limit_is_sharp),
      cmocka_unit_test(lattice_shells),
      cmocka_unit_test(far_below_h),
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(bad_input_is_refused),
      cmocka_unit_test(point_visits_all_within_reach),
      cmocka_unit_test(smoothing_holds_what_is_wanted),
      cmocka_unit_test(smoothing_of_a_lattice),
      cmocka_unit_test(smoothing_that_cannot_be),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
