/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The octree: the order is Hilbert's, nodes and groups are what tree.h says, for all shapes of
 * clouds. */
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <stdarg.h>
#include <stdint.h>
#include <cmocka.h>
#include "cloud.h"

static Err err;
static const long SIZES[] = {1, 2, 17, 65, 3000};
#define FOR_SIZES(N) for (const long *N = SIZES; N < SIZES + sizeof SIZES / sizeof *SIZES; N++)

/* Successive cells of a Hilbert curve share a face (Hilbert 1891); Morton order fails at every
 * second step. */
static void order_is_hilbert(void **state)
{
  (void)state;
  enum { W = 16, N = W * W * W };
  static double x[3 * N];
  static long order[N];
  for (long i = 0; i < N; i++)
    x[3 * i] = (double)(i % W), x[3 * i + 1] = (double)(i / W % W),
          x[3 * i + 2] = (double)(i / W / W);
  assert_int_equal(tree_order(N, x, NULL, 0, order, &err), 0);
  for (long k = 1; k < N; k++) {
    const double *a = x + 3 * order[k - 1], *b = x + 3 * order[k];
    assert_true(fabs(a[0] - b[0]) + fabs(a[1] - b[1]) + fabs(a[2] - b[2]) == 1);
  }
}

/* Reversed input gives the same sequence of ids, also where keys are equal. */
static void order_ignores_input(void **state)
{
  (void)state;
  for (int shape = 0; shape < SHAPES; shape++) {
    FOR_SIZES(n)
    {
      Cloud c = cloud_new(shape, *n, 1, 1);
      long *order = malloc(8 * *n);
      int64_t *id = malloc(8 * *n);
      for (long i = 0; i < *n; i++) {
        memcpy(c.y + 3 * i, c.x + 3 * (*n - 1 - i), 24);
        id[i] = c.id[*n - 1 - i];
      }
      assert_int_equal(tree_order(*n, c.y, id, 0, order, &err), 0);
      for (long k = 0; k < *n; k++) assert_true(id[order[k]] == c.id[k]);
      if (shape == COINCIDENT)
        for (long k = 1; k < *n; k++)
          assert_true(c.id[k - 1] < c.id[k] || k == *n / 2 || k == (*n + 1) / 2);
      free(order), free(id), cloud_free(&c);
    }
  }
}

static void near(double a, double b, double scale) { assert_true(fabs(a - b) <= 1e-12 * scale); }

/* Everything a node says of its particles, summed again. */
static void check_node(const Tree *t, const TreeNode *p, const Cloud *c)
{
  double m = 0, s[3] = {0}, lo[3], hi[3], h = 0, q[6] = {0}, width = 0;
  memcpy(lo, c->x + 3 * p->first, sizeof lo), memcpy(hi, lo, sizeof hi);
  for (long i = p->first; i < p->first + p->count; i++) {
    m += c->m[i], h = fmax(h, c->h[i]);
    for (int d = 0; d < 3; d++) {
      s[d] += c->m[i] * c->x[3 * i + d];
      lo[d] = fmin(lo[d], c->x[3 * i + d]), hi[d] = fmax(hi[d], c->x[3 * i + d]);
    }
  }
  near(p->mass, m, m);
  assert_true(p->hmax == h);
  for (int d = 0; d < 3; d++) {
    assert_true(p->lo[d] == lo[d] && p->hi[d] == hi[d]);
    near(p->com[d], s[d] / m, t->edge + fabs(s[d] / m));
    width = fmax(width, hi[d] - lo[d]);
  }
  assert_true(p->size >= width * (1 - 1e-9) && p->size >= t->edge / (1 << TREE_LEVELS));
  for (long i = p->first; i < p->first + p->count; i++) {
    const double r[3] = {c->x[3 * i] - p->com[0], c->x[3 * i + 1] - p->com[1],
                         c->x[3 * i + 2] - p->com[2]};
    const double r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
    for (int a = 0, k = 0; a < 3; a++)
      for (int b = a; b < 3; b++, k++) q[k] += c->m[i] * (3 * r[a] * r[b] - (a == b) * r2);
  }
  for (int k = 0; k < 6; k++)
    assert_true(fabs(p->q[k] - q[k]) <= 1e-9 * m * (width * width + 1e-6 * t->edge));
}

static void check_walk(const Tree *t, int32_t k)
{
  const TreeNode *p = t->node + k;
  const TreeWalk *w = t->walk + k;
  assert_true(w->first == p->first && w->count == p->count && w->skip == p->skip);
  assert_true((w->skip == k + 1) == p->leaf);
  assert_true((double)w->hmax * t->edge >= p->hmax && (double)w->open * t->edge >= p->size);
  for (int d = 0; d < 3; d++) {
    assert_true((double)w->lo[d] * t->edge <= (p->lo[d] - t->origin[d]) * (1 + 1e-15));
    assert_true((double)w->hi[d] * t->edge >= (p->hi[d] - t->origin[d]) * (1 - 1e-15));
  }
}

static void check_tree(const Tree *t, const Cloud *c)
{
  assert_true(t->node[0].first == 0 && t->node[0].count == c->n && t->node[0].skip == t->nodes);
  for (int32_t k = 0; k < t->nodes; k++) {
    const TreeNode *p = t->node + k;
    check_node(t, p, c), check_walk(t, k);
    if (p->leaf) {
      assert_true(p->skip == k + 1 && (p->count <= TREE_BUCKET || p->level == TREE_LEVELS));
      continue;
    }
    int32_t first = p->first, children = 0;
    for (int32_t b = k + 1; b < p->skip; b = t->node[b].skip, children++) {
      assert_true(t->node[b].first == first && t->node[b].level > p->level);
      first += t->node[b].count;
    }
    assert_true(first == p->first + p->count && children >= 2 && children <= 8);
  }
  int32_t first = 0;
  for (const TreeGroup *g = t->group; g < t->group + t->groups; g++) {
    assert_true(g->first == first && g->count >= 1 && g->count <= TREE_GROUP);
    first += g->count;
    for (long i = g->first; i < first; i++) {
      assert_true(c->h[i] <= g->hmax);
      for (int d = 0; d < 3; d++)
        assert_true(c->x[3 * i + d] >= g->lo[d] && c->x[3 * i + d] <= g->hi[d]);
    }
  }
  assert_true(first == c->n);
}

static void nodes_sum_their_particles(void **state)
{
  (void)state;
  Tree t = {0}; /* the same memory for all */
  for (int shape = 0; shape < SHAPES; shape++) {
    FOR_SIZES(n)
    {
      Cloud c = cloud_new(shape, *n, 2, 5);
      assert_int_equal(tree_build(&t, *n, c.x, c.m, c.h, &err), 0);
      check_tree(&t, &c);
      double *x = c.x;
      c.x = c.y; /* moved */
      tree_refit(&t, c.x, c.m, c.h);
      check_tree(&t, &c);
      c.x = x;
      cloud_free(&c);
    }
  }
  tree_free(&t);
}

/* Cells of the same level do not overlap: siblings' boxes share no inner point. */
static void siblings_are_apart(void **state)
{
  (void)state;
  Cloud c = cloud_new(CLUSTERS, 3000, 3, 1);
  Tree t = {0};
  assert_int_equal(tree_build(&t, c.n, c.x, NULL, NULL, &err), 0);
  for (int32_t k = 0; k < t.nodes; k++)
    for (int32_t a = k + 1; a < t.node[k].skip; a = t.node[a].skip)
      for (int32_t b = t.node[a].skip; b < t.node[k].skip; b = t.node[b].skip) {
        int apart = 0;
        for (int d = 0; d < 3; d++)
          apart |= t.node[a].hi[d] <= t.node[b].lo[d] || t.node[b].hi[d] <= t.node[a].lo[d];
        assert_true(apart);
      }
  assert_true(t.node[0].mass == 0 && t.node[0].hmax == 0);
  tree_free(&t), cloud_free(&c);
}

static void threads_do_not_matter(void **state)
{
  (void)state;
  Cloud c = cloud_new(CLUSTERS, 3000, 4, 5);
  Tree a = {0}, b = {0};
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  assert_int_equal(tree_build(&a, c.n, c.x, c.m, c.h, &err), 0);
  omp_set_num_threads(3);
  assert_int_equal(tree_build(&b, c.n, c.x, c.m, c.h, &err), 0);
  omp_set_num_threads(threads);
  assert_true(a.nodes == b.nodes && a.groups == b.groups);
  assert_memory_equal(a.node, b.node, (size_t)a.nodes * sizeof *a.node);
  assert_memory_equal(a.group, b.group, (size_t)a.groups * sizeof *a.group);
  tree_free(&a), tree_free(&b), cloud_free(&c);
}

static void bad_input_is_refused(void **state)
{
  (void)state;
  const double bad[] = {NAN, INFINITY, -INFINITY, 1e200};
  Cloud c = cloud_new(SPHERE, 100, 5, 1);
  Tree t = {0};
  long order[100];
  for (int k = 0; k < 4; k++) {
    const double keep = c.x[3 * 41 + 1];
    char name[64];
    snprintf(name, sizeof name, "particle %lld:", (long long)c.id[41]);
    c.x[3 * 41 + 1] = bad[k];
    assert_int_equal(tree_order(c.n, c.x, c.id, 0, order, &err), -1);
    assert_non_null(strstr(err.text, name));
    assert_int_equal(tree_build(&t, c.n, c.x, c.m, c.h, &err), -1);
    assert_non_null(strstr(err.text, "particle number 41"));
    c.x[3 * 41 + 1] = keep;
  }
  double swap = c.x[30];
  c.x[30] = c.x[240], c.x[240] = swap;
  assert_int_equal(tree_build(&t, c.n, c.x, c.m, c.h, &err), -1);
  assert_non_null(strstr(err.text, "not in Hilbert order"));
  assert_int_equal(tree_build(&t, 0, c.x, c.m, c.h, &err), -1);
  tree_free(&t), cloud_free(&c);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(order_is_hilbert),          cmocka_unit_test(order_ignores_input),
      cmocka_unit_test(nodes_sum_their_particles), cmocka_unit_test(siblings_are_apart),
      cmocka_unit_test(threads_do_not_matter),     cmocka_unit_test(bad_input_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
