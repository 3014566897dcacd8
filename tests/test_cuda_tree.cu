/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Order and tree of the CUDA backend against lib/tree and brute force: the same order, everything
 * that belongs to a particle moves with it, every node of lib/tree is there with its size, boxes
 * and moments are those of the particles. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <map>
#include <algorithm>
#include "tree_lab.cuh"
extern "C" {
#include <cmocka.h>
}
#include "small.h"

static std::vector<long> sizes(void)
{
  return small_or(0, 1) ? std::vector<long>{1, 17, 300}
                        : std::vector<long>{1, 2, 16, 17, 255, 256, 1500};
}

/* Rows that have nothing to do with the order. */
static std::vector<long> shuffled(long n)
{
  std::vector<long> row((size_t)n);
  for (long k = 0; k < n; k++) row[(size_t)k] = k;
  for (long k = n - 1; k > 0; k--)
    std::swap(row[(size_t)k], row[(size_t)(cloud_random(77, k, 0) * (double)(k + 1))]);
  return row;
}

static TreeLab *open_shape(int shape, long n, int seed, double spread, Cloud *c)
{
  *c = cloud_new((CloudShape)shape, n, seed, spread);
  return tree_lab_open(c, shuffled(n).data());
}

/* The order is tree_order's, for several cubes, and x, y, h, row, saved slots keep together. */
static void check_order(TreeLab *l, const Cloud *c)
{
  const State &s = l->sim.s;
  const size_t n = (size_t)l->n;
  const std::vector<double> x = tree_lab_get(l, s.x, 3 * n), y = tree_lab_get(l, s.y, 3 * n),
                            h = tree_lab_get(l, s.h, n), m = tree_lab_get(l, s.m, n);
  const std::vector<int64_t> id = tree_lab_get(l, s.id, n), row = tree_lab_get(l, s.row, n);
  std::vector<long> order(n);
  Err err;
  assert_int_equal(tree_order(c->n, c->x, c->id, hilbert_shift(l->sim.step), order.data(), &err),
                   0);
  for (size_t k = 0; k < n; k++) {
    const size_t i = (size_t)order[k];
    assert_true(id[k] == c->id[i] && l->parts->id[row[k]] == id[k]);
    assert_true(h[k] == c->h[i] && m[k] == c->m[i]);
    assert_memory_equal(&x[3 * k], c->x + 3 * i, 24);
    assert_memory_equal(&y[3 * k], c->y + 3 * i, 24);
  }
}

static void order_is_the_host_s(void **state)
{
  (void)state;
  for (int shape = 0; shape < SHAPES; shape++)
    for (long n : sizes()) {
      Cloud c;
      TreeLab *l = open_shape(shape, n, 21, 5, &c);
      for (l->sim.step = 0; l->sim.step < 9; l->sim.step += small_or(2, 6))
        tree_lab_search(l), check_order(l, &c);
      cloud_free(&c), tree_lab_close(l);
    }
}

/* Points are x - origin to 2^-48 of it. */
static void check_points(TreeLab *l, const Root &root)
{
  Cuda *d = cuda_of(&l->sim);
  const size_t n = (size_t)l->n;
  const std::vector<double> x = tree_lab_get(l, l->sim.s.x, 3 * n);
  const std::vector<float4> hi = tree_lab_get(l, d->x.hi, n), lo = tree_lab_get(l, d->x.lo, n);
  for (size_t i = 0; i < n; i++) {
    const float a[3] = {hi[i].x, hi[i].y, hi[i].z}, b[3] = {lo[i].x, lo[i].y, lo[i].z};
    for (int e = 0; e < 3; e++) {
      const double u = (x[3 * i + e] - root.origin[e]) / d->unit.length;
      assert_true(fabs((double)a[e] + (double)b[e] - u) <= ldexp(fabs(u), -48));
    }
  }
}

typedef std::pair<int, int> Range;

typedef struct {
  TreeLab *l;
  Cuda *d;
  Root root;
  std::vector<double> x, m, h, moment;
  std::vector<int4> link;
  std::vector<float4> lo, hi, com;
  std::vector<Pole> pole;
  std::vector<int> level;
} Copy;

static Copy copy_tree(TreeLab *l)
{
  Cuda *d = cuda_of(&l->sim);
  const DeviceTree &t = d->tree;
  const size_t n = (size_t)l->n, nodes = (size_t)t.nodes;
  return {l,
          d,
          tree_lab_get(l, d->root, 1)[0],
          tree_lab_get(l, l->sim.s.x, 3 * n),
          tree_lab_get(l, l->sim.s.m, n),
          tree_lab_get(l, l->sim.s.h, n),
          tree_lab_get(l, t.moment, 10 * nodes),
          tree_lab_get(l, t.link, nodes),
          tree_lab_get(l, t.lo, nodes),
          tree_lab_get(l, t.hi, nodes),
          tree_lab_get(l, t.com, nodes),
          tree_lab_get(l, t.pole, nodes),
          tree_lab_get(l, t.level, CUDA_LEVELS + 2)};
}

/* Children tile their parent, in order; levels are consecutive; leaves hold few. */
static void check_links(const Copy &c)
{
  const int nodes = c.d->tree.nodes;
  assert_true(c.level[0] == 0 && c.level[1] == 1 && c.level[CUDA_LEVELS + 1] == nodes);
  assert_true(c.link[0].z == 0 && c.link[0].w == c.l->n);
  int next = 1;
  for (int l = 0; l <= CUDA_LEVELS; l++)
    for (int k = c.level[(size_t)l]; k < c.level[(size_t)l + 1]; k++) {
      const int4 p = c.link[(size_t)k];
      assert_true(p.w > 0 && p.y <= 8);
      assert_true((p.y == 0) == (p.w <= TREE_BUCKET || l == CUDA_LEVELS));
      if (!p.y) continue;
      assert_int_equal(p.x, next);
      int at = p.z;
      for (int j = p.x; j < p.x + p.y; j++) {
        assert_true(c.link[(size_t)j].z == at && j >= c.level[(size_t)l + 1]);
        at += c.link[(size_t)j].w;
      }
      assert_int_equal(at, p.z + p.w);
      next += p.y;
    }
  assert_int_equal(next, nodes);
}

/* A box is the float just outside of each face; h_max too. */
static void check_box(const Copy &c, size_t k)
{
  const int4 p = c.link[k];
  const double il = 1 / c.d->unit.length;
  const float a[3] = {c.lo[k].x, c.lo[k].y, c.lo[k].z}, b[3] = {c.hi[k].x, c.hi[k].y, c.hi[k].z};
  double h = 0;
  for (int e = 0; e < 3; e++) {
    double lo = 1e300, hi = -1e300;
    for (size_t i = (size_t)p.z; i < (size_t)(p.z + p.w); i++) {
      const double u = (c.x[3 * i + e] - c.root.origin[e]) * il;
      lo = fmin(lo, u), hi = fmax(hi, u), h = fmax(h, c.h[i] * il);
    }
    assert_true((double)a[e] <= lo && (double)nextafterf(a[e], 3e38f) >= lo);
    assert_true((double)b[e] >= hi && (double)nextafterf(b[e], -3e38f) <= hi);
  }
  assert_true((double)c.hi[k].w >= h && (double)c.hi[k].w <= h * (1 + 2e-7));
}

/* Moments in SI to rounding, the pole to that of floats. */
static void check_moments(const Copy &c, size_t k)
{
  const int4 p = c.link[k];
  const double *got = &c.moment[10 * k], il = 1 / c.d->unit.length, im = 1 / c.d->unit.mass;
  double m = 0, com[3] = {0, 0, 0}, q[6] = {0, 0, 0, 0, 0, 0}, scale = 0, far = 0, trace = 0;
  for (size_t i = (size_t)p.z; i < (size_t)(p.z + p.w); i++) {
    m += c.m[i];
    for (int e = 0; e < 3; e++)
      com[e] += c.m[i] * c.x[3 * i + e], far = fmax(far, fabs(c.x[3 * i + e]));
  }
  for (int e = 0; e < 3; e++) com[e] /= m;
  for (size_t i = (size_t)p.z; i < (size_t)(p.z + p.w); i++) {
    double r[3], r2 = 0;
    for (int e = 0; e < 3; e++) r[e] = c.x[3 * i + e] - com[e], r2 += r[e] * r[e];
    for (int a = 0, e = 0; a < 3; a++)
      for (int b = a; b < 3; b++) q[e++] += c.m[i] * (3 * r[a] * r[b] - (a == b) * r2);
    trace += c.m[i] * r2;
    scale += c.m[i] * (r2 + 1e-3 * sqrt(r2) * far + 1e-13 * far * far);
  }
  const Pole &o = c.pole[k];
  assert_true(fabs(got[0] - m) < 1e-13 * m && fabs((double)o.mass - m * im) < 1e-7 * m * im);
  for (int e = 0; e < 3; e++) {
    const double u = (com[e] - c.root.origin[e]) * il;
    assert_true(fabs(got[1 + e] - com[e]) < 1e-13 * far);
    assert_true(fabs((double)o.hi[e] + (double)o.lo[e] - u) < 1e-13 * (far * il + fabs(u)));
  }
  for (int e = 0; e < 6; e++) {
    assert_true(fabs(got[4 + e] - q[e]) < 1e-12 * scale);
    assert_true(fabs((double)o.q[e] - q[e] * im * il * il) < 3e-7 * scale * im * il * il);
  }
  if (c.l->sim.par.softening == SOFTENING_SPLINE) trace = 0;
  assert_true(fabs((double)o.trace - trace * im * il * il) < 1e-6 * scale * im * il * il);
  assert_true(c.com[k].x == o.hi[0] && c.com[k].w == o.mass);
}

/* Every node of lib/tree is one of ours, and of the same size. */
static void check_host_tree(const Copy &c)
{
  Tree t = {};
  Err err;
  std::map<Range, size_t> at;
  for (size_t k = 0; k < c.link.size(); k++) at[Range(c.link[k].z, c.link[k].w)] = k;
  t.shift = hilbert_shift(c.l->sim.step);
  assert_int_equal(tree_build(&t, c.l->n, c.x.data(), c.m.data(), c.h.data(), &err), 0);
  assert_true(t.edge == c.root.edge && memcmp(t.origin, c.root.origin, sizeof t.origin) == 0);
  for (int k = 0; k < t.nodes; k++) {
    const TreeNode &p = t.node[k];
    const std::map<Range, size_t>::iterator f = at.find(Range(p.first, p.count));
    assert_true(f != at.end());
    assert_true(fabs((double)c.lo[f->second].w * c.d->unit.length / p.size - 1) < 2e-7);
  }
  tree_free(&t);
}

static void tree_is_the_host_s(void **state)
{
  (void)state;
  for (int shape = 0; shape < SHAPES; shape++)
    for (long n : sizes()) {
      Cloud cloud;
      TreeLab *l = open_shape(shape, n, 22, 5, &cloud);
      l->sim.step = 4 * shape;
      l->sim.par.softening = shape % 2 ? SOFTENING_PLUMMER : SOFTENING_SPLINE;
      tree_lab_search(l);
      const Copy c = copy_tree(l);
      check_points(l, c.root), check_links(c), check_host_tree(c);
      for (size_t k = 0; k < c.link.size(); k++) check_box(c, k), check_moments(c, k);
      cloud_free(&cloud), tree_lab_close(l);
    }
}

/* A million times denser than the rest, and more nodes than there was room for. */
static void depth_and_growth(void **state)
{
  (void)state;
  Cloud cloud = cloud_new(SPHERE, 2000, 23, 1);
  for (long i = 0; i < 1000; i++)
    for (int d = 0; d < 3; d++) cloud.x[3 * i + d] = 1e6 + 1e-6 * (cloud.x[3 * i + d] - 1e6);
  for (long i = 1000; i < 1100; i++)
    for (int d = 0; d < 3; d++) cloud.x[3 * i + d] = 1e6 + 1e-4 * (i / 50);
  TreeLab *l = tree_lab_open(&cloud, NULL);
  Cuda *d = cuda_of(&l->sim);
  Err err;
  assert_int_equal(cuda_tree_grow(&l->sim, 100, &err), 0);
  for (l->sim.step = 0; l->sim.step < 8; l->sim.step += 3) {
    tree_lab_search(l);
    assert_true(d->tree.levels > 12 && d->tree.nodes <= d->tree.room && d->tree.nodes > 100);
    const Copy c = copy_tree(l);
    check_links(c), check_host_tree(c);
    for (size_t k = 0; k < c.link.size(); k++) check_box(c, k), check_moments(c, k);
  }
  cloud_free(&cloud), tree_lab_close(l);
}

/* Massless particles: the centre of the box. */
static void without_mass(void **state)
{
  (void)state;
  Cloud cloud;
  TreeLab *l = open_shape(SPHERE, 300, 24, 1, &cloud);
  const std::vector<double> none(300, 0.);
  tree_lab_put(l, l->sim.s.m, none.data(), 300);
  tree_lab_search(l);
  const Copy c = copy_tree(l);
  for (size_t k = 0; k < c.link.size(); k++) {
    const double mid = 0.5 * ((double)c.lo[k].x + (double)c.hi[k].x) * c.d->unit.length;
    assert_true(c.moment[10 * k] == 0 && c.pole[k].q[0] == 0);
    assert_true(fabs(c.moment[10 * k + 1] - c.root.origin[0] - mid) < 1e-9 * c.root.edge);
  }
  cloud_free(&cloud), tree_lab_close(l);
}

/* Between evaluations of gravity: the same boxes; masses stay as they were. */
static void without_gravity(void **state)
{
  (void)state;
  Cloud cloud;
  TreeLab *l = open_shape(TWO_BODIES, 700, 26, 1, &cloud);
  tree_lab_search(l);
  Copy c = copy_tree(l);
  const DeviceTree &t = c.d->tree;
  const size_t nodes = (size_t)t.nodes;
  const std::vector<double> none(10 * nodes, -1.);
  const std::vector<float4> drift = tree_lab_get(l, c.d->build->drift, nodes);
  tree_lab_put(l, t.moment, none.data(), 10 * nodes);
  l->sim.pull_due = 0;
  tree_lab_search(l);
  const Copy again = copy_tree(l);
  assert_true(again.moment == none);
  assert_memory_equal(again.link.data(), c.link.data(), nodes * sizeof(int4));
  assert_memory_equal(again.lo.data(), c.lo.data(), nodes * sizeof(float4));
  assert_memory_equal(again.hi.data(), c.hi.data(), nodes * sizeof(float4));
  assert_memory_equal(tree_lab_get(l, c.d->build->drift, nodes).data(), drift.data(),
                      nodes * sizeof(float4));
  cloud_free(&cloud), tree_lab_close(l);
}

/* A value that cannot be, anywhere in x, y or h: the search fails and names the particle; once that
 * is mended it works again. */
static void bad_particles_are_named(void **state)
{
  (void)state;
  Cloud cloud;
  TreeLab *l = open_shape(SPHERE, 500, 25, 1, &cloud);
  const double value[] = {NAN, 1e200, INFINITY, -1};
  Err err;
  for (int k = 0; k < 4; k++) {
    const auto array = k < 2 ? &State::x : k == 2 ? &State::y : &State::h;
    const size_t width = k < 3 ? 3 : 1, part = k < 3 ? (size_t)(k + 1) % 3 : 0;
    double old = 0;
    int64_t id = -1;
    char name[64];
    for (int mended = 0; mended < 2; mended++) {
      const std::vector<int64_t> ids = tree_lab_get(l, l->sim.s.id, 500);
      const size_t at = id < 0 ? 77 : (size_t)(std::find(ids.begin(), ids.end(), id) - ids.begin());
      double *to = l->sim.s.*array + width * at + part;
      if (mended) {
        tree_lab_put(l, to, &old, 1);
        tree_lab_search(l);
        continue;
      }
      id = ids[at], old = tree_lab_get(l, to, 1)[0];
      tree_lab_put(l, to, &value[k], 1);
      assert_int_equal(tree_lab_try(l, &err), -1);
      snprintf(name, sizeof name, "particle %lld:", (long long)id);
      if (!strstr(err.text, name)) fail_msg("%s instead of %s", err.text, name);
    }
  }
  cloud_free(&cloud), tree_lab_close(l);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(order_is_the_host_s), cmocka_unit_test(tree_is_the_host_s),
      cmocka_unit_test(depth_and_growth),    cmocka_unit_test(without_mass),
      cmocka_unit_test(without_gravity),     cmocka_unit_test(bad_particles_are_named)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
