/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hilbert keys (hilbert.h) for a block of particles at a time, so that the loops over the block are
 * vectors. A node is a range of equal leading key digits; its children follow from the first keys
 * with another digit. Moments go up from the leaves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "hilbert.h"
#include "rng.h"
#include "sort.h"
#include "tree.h"

enum { BLOCK = 256, SERIAL = 4096 }; /* SERIAL: fewer particles are not worth a second thread */
static const double FAR = 1e150;     /* squares of coordinates must stay finite */

typedef struct {
  double lo[3], edge;
} Cube;

static void hilbert_block(uint32_t c[3][BLOCK], int n, uint64_t *key)
{
  for (uint32_t bit = 1u << (TREE_LEVELS - 1); bit > 1; bit >>= 1)
    for (int d = 0; d < 3; d++)
      for (int k = 0; k < n; k++) hilbert_turn(bit, d, &c[0][k], &c[d][k]);
  for (int k = 0; k < n; k++) key[k] = hilbert_join(c[0][k], c[1][k], c[2][k]);
}

static void hilbert_keys(const Cube *cube, long n, const double *x, uint64_t *key)
{
  const double scale = (1 << TREE_LEVELS) / cube->edge;
#pragma omp parallel for schedule(static) if (n > SERIAL)
  for (long b = 0; b < n; b += BLOCK) {
    uint32_t c[3][BLOCK];
    int m = (int)(n - b < BLOCK ? n - b : BLOCK);
    for (int d = 0; d < 3; d++)
      for (int k = 0; k < m; k++) c[d][k] = hilbert_cell(x[3 * (b + k) + d], cube->lo[d], scale);
    hilbert_block(c, m, key + b);
  }
}

/* Two parts: the first digit says which; the last one gives way. */
static void split_keys(long n, long split, uint64_t *key)
{
  for (long i = 0; split && i < n; i++)
    key[i] = key[i] >> 3 | (uint64_t)(i >= split) << 3 * (TREE_LEVELS - 1);
}

/* The root cube, drawn by shift unless that is 0; -1 - k when the k-th coordinate is bad. */
static long find_cube(long n, const double *x, uint64_t shift, Cube *cube)
{
  double x0 = FAR, y0 = FAR, z0 = FAR, x1 = -FAR, y1 = -FAR, z1 = -FAR;
  long bad = 3 * n;
#pragma omp parallel for reduction(min : x0, y0, z0, bad) reduction(max : x1, y1, z1)
  for (long i = 0; i < n; i++) {
    const double *p = x + 3 * i;
    x0 = p[0] < x0 ? p[0] : x0, x1 = p[0] > x1 ? p[0] : x1;
    y0 = p[1] < y0 ? p[1] : y0, y1 = p[1] > y1 ? p[1] : y1;
    z0 = p[2] < z0 ? p[2] : z0, z1 = p[2] > z1 ? p[2] : z1;
    for (int d = 0; d < 3; d++)
      if (!(fabs(p[d]) < FAR) && 3 * i + d < bad) bad = 3 * i + d;
  }
  const double lo[3] = {x0, y0, z0}, hi[3] = {x1, y1, z1};
  double draw[3];
  for (uint32_t d = 0; d < 3; d++) draw[d] = rng_uniform(shift, 0, d);
  hilbert_cube(lo, hi, shift ? draw : NULL, cube->lo, &cube->edge);
  return bad < 3 * n ? -1 - bad : 0;
}

/* Particles of equal keys, first .. end-1 of the order, by id: insertion, for there are few. */
static void by_id(const int64_t *id, long *order, long first, long end)
{
  for (long k = first + 1; k < end; k++) {
    const long i = order[k];
    long at = k;
    for (; at > first && id[order[at - 1]] > id[i]; at--) order[at] = order[at - 1];
    order[at] = i;
  }
}

/* The order of id within runs of equal keys. A long run is sorted, as a whole tree in one place may
 * be. */
static int break_ties(long n, const uint64_t *key, const int64_t *id, long *order)
{
  enum { FEW = 64 };
  for (long b = 0, e; b < n; b = e) {
    for (e = b + 1; e < n && key[order[e]] == key[order[b]];) e++;
    if (e - b <= FEW) {
      by_id(id, order, b, e);
      continue;
    }
    int64_t *own = malloc((size_t)(e - b) * sizeof *own);
    long *old = malloc((size_t)(e - b) * sizeof *old), *by = malloc((size_t)(e - b) * sizeof *by);
    int failed = !own || !old || !by;
    for (long k = b; k < e && !failed; k++) old[k - b] = order[k], own[k - b] = id[order[k]];
    if (!failed) failed = sort_ids(e - b, own, by) != 0;
    for (long k = b; k < e && !failed; k++) order[k] = old[by[k - b]];
    free(own), free(old), free(by);
    if (failed) return -1;
  }
  return 0;
}

int tree_order_parts(long n, long split, const double *x, const int64_t *id, uint64_t shift,
                     long *order, Err *err)
{
  Cube cube;
  long bad = find_cube(n, x, shift, &cube);
  if (bad) {
    bad = -1 - bad;
    return err_set(err, "particle %lld: coordinate %g is out of range",
                   (long long)(id ? id[bad / 3] : bad / 3), x[bad]);
  }
  uint64_t *key = malloc((size_t)n * sizeof *key + 1);
  if (key) hilbert_keys(&cube, n, x, key), split_keys(n, split, key);
  int failed = !key || sort_keys(n, key, order) || (id && break_ties(n, key, id, order));
  free(key);
  return failed ? err_set(err, "cannot sort %ld particles: no memory", n) : 0;
}

int tree_order(long n, const double *x, const int64_t *id, uint64_t shift, long *order, Err *err)
{
  return tree_order_parts(n, 0, x, id, shift, order, err);
}

static int new_node(Tree *t)
{
  if (t->nodes == t->node_room) {
    int32_t room = t->node_room + t->node_room / 2 + 64;
    TreeNode *node = realloc(t->node, (size_t)room * sizeof *node);
    if (!node) return -1;
    t->node = node, t->node_room = room;
  }
  return t->nodes++;
}

static int new_group(Tree *t, int32_t first, int32_t count)
{
  if (t->groups == t->group_room) {
    int32_t room = t->group_room + t->group_room / 2 + 64;
    TreeGroup *group = realloc(t->group, (size_t)room * sizeof *group);
    if (!group) return -1;
    t->group = group, t->group_room = room;
  }
  t->group[t->groups++] = (TreeGroup){.first = first, .count = count};
  return 0;
}

/* The first key in b .. e-1 that is larger than top: steps double, then halve. */
static int32_t upper(const uint64_t *key, int32_t b, int32_t e, uint64_t top)
{
  int32_t step = 1;
  while (b + step < e && key[b + step] <= top) step *= 2;
  for (; step; step /= 2)
    if (b + step < e && key[b + step] <= top) b += step;
  return b + 1;
}

/* The subtree of particles b .. e-1, whose keys agree in the first `level` digits. */
static int grow(Tree *t, int32_t b, int32_t e, int level)
{
  const uint64_t *key = t->key;
  while (level < TREE_LEVELS && !((key[b] ^ key[e - 1]) >> 3 * (TREE_LEVELS - 1 - level))) level++;
  int me = new_node(t), leaf = e - b <= TREE_BUCKET || level == TREE_LEVELS;
  if (me < 0) return -1;
  t->node[me] =
      (TreeNode){.first = b, .count = e - b, .leaf = (int16_t)leaf, .level = (int16_t)level};
  while (!leaf && b < e) {
    uint64_t rest = ((uint64_t)1 << 3 * (TREE_LEVELS - 1 - level)) - 1;
    int32_t end = upper(key, b, e, key[b] | rest);
    if (grow(t, b, end, level + 1)) return -1;
    b = end;
  }
  t->node[me].skip = t->nodes;
  return 0;
}

/* Groups: consecutive children of one node are taken together while they are at most TREE_GROUP; so
 * no group reaches beyond the smallest cell that holds more. A child far smaller than the cell
 * stays alone, as the group's coordinates are to resolve it. Leaves that are too large are cut. */
static int make_groups(Tree *t, int32_t parent)
{
  const TreeNode *p = t->node + parent, *c;
  int32_t first = p->first, count = 0;
  for (int32_t k = parent + 1; k < p->skip; k = c->skip) {
    c = t->node + k;
    const int alone = c->count > TREE_GROUP || (c->count > 1 && c->level > p->level + 4);
    if (count && (alone || count + c->count > TREE_GROUP)) {
      if (new_group(t, first, count)) return -1;
      count = 0;
    }
    if (!count) first = c->first;
    if (!alone)
      count += c->count;
    else if (make_groups(t, k))
      return -1;
  }
  if (p->leaf) count = p->count;
  for (; count > TREE_GROUP; first += TREE_GROUP, count -= TREE_GROUP)
    if (new_group(t, first, TREE_GROUP)) return -1;
  return count ? new_group(t, first, count) : 0;
}

static void box_empty(double lo[3], double hi[3])
{
  for (int d = 0; d < 3; d++) lo[d] = FAR, hi[d] = -FAR;
}

static void box_add(double lo[3], double hi[3], const double a[3], const double b[3])
{
  for (int d = 0; d < 3; d++) {
    lo[d] = lo[d] < a[d] ? lo[d] : a[d];
    hi[d] = hi[d] > b[d] ? hi[d] : b[d];
  }
}

/* Adds m (3 r r - r^2 1). */
static void add_quadrupole(double q[6], double m, double x, double y, double z)
{
  double r2 = x * x + y * y + z * z;
  q[0] += m * (3 * x * x - r2), q[1] += m * 3 * x * y, q[2] += m * 3 * x * z;
  q[3] += m * (3 * y * y - r2), q[4] += m * 3 * y * z, q[5] += m * (3 * z * z - r2);
}

static void set_com(TreeNode *p, const double sum[3])
{
  for (int d = 0; d < 3; d++)
    p->com[d] = p->mass > 0 ? sum[d] / p->mass : 0.5 * (p->lo[d] + p->hi[d]);
}

static void sum_leaf(TreeNode *p, const double *x, const double *m, const double *h)
{
  const long b = p->first, e = b + p->count;
  double s[3] = {0};
  box_empty(p->lo, p->hi);
  p->mass = p->hmax = 0;
  for (long i = b; i < e; i++) {
    box_add(p->lo, p->hi, x + 3 * i, x + 3 * i);
    if (h && h[i] > p->hmax) p->hmax = h[i];
    if (m) p->mass += m[i];
    for (int d = 0; m && d < 3; d++) s[d] += m[i] * x[3 * i + d];
  }
  set_com(p, s);
  memset(p->q, 0, sizeof p->q);
  for (long i = b; m && i < e; i++)
    add_quadrupole(p->q, m[i], x[3 * i] - p->com[0], x[3 * i + 1] - p->com[1],
                   x[3 * i + 2] - p->com[2]);
}

static void sum_children(TreeNode *node, int32_t me)
{
  TreeNode *p = node + me;
  double s[3] = {0};
  box_empty(p->lo, p->hi);
  p->mass = p->hmax = 0;
  for (int32_t c = me + 1; c < p->skip; c = node[c].skip) {
    box_add(p->lo, p->hi, node[c].lo, node[c].hi);
    if (node[c].hmax > p->hmax) p->hmax = node[c].hmax;
    p->mass += node[c].mass;
    for (int d = 0; d < 3; d++) s[d] += node[c].mass * node[c].com[d];
  }
  set_com(p, s);
  memset(p->q, 0, sizeof p->q);
  for (int32_t c = me + 1; c < p->skip; c = node[c].skip) {
    for (int k = 0; k < 6; k++) p->q[k] += node[c].q[k];
    add_quadrupole(p->q, node[c].mass, node[c].com[0] - p->com[0], node[c].com[1] - p->com[1],
                   node[c].com[2] - p->com[2]);
  }
}

static void set_size(const Tree *t, TreeNode *p)
{
  p->size = ldexp(t->edge, -p->level);
  for (int d = 0; d < 3; d++) p->size = fmax(p->size, p->hi[d] - p->lo[d]);
}

void tree_outward(const Tree *t, const double lo[3], const double hi[3], float out_lo[3],
                  float out_hi[3])
{
  const double scale = 1 / t->edge;
  for (int d = 0; d < 3; d++) {
    float a = (float)((lo[d] - t->origin[d]) * scale), b = (float)((hi[d] - t->origin[d]) * scale);
    out_lo[d] = a - 0x1p-23f * fabsf(a);
    out_hi[d] = b + 0x1p-23f * fabsf(b);
  }
}

static void set_walk(const Tree *t, int32_t k)
{
  const TreeNode *p = t->node + k;
  TreeWalk *w = t->walk + k;
  const double scale = 1 / t->edge, up = (1 + 1e-7) * scale, whole = t->node[0].mass;
  tree_outward(t, p->lo, p->hi, w->lo, w->hi);
  for (int d = 0; d < 3; d++) w->com[d] = (float)((p->com[d] - t->origin[d]) * scale);
  w->open = (float)(p->size * up * (1 + (whole > 0 ? cbrt(p->mass / whole) : 0)));
  if (whole > 0 && p->mass <= 0) w->open = 0; /* there is nothing to see in it */
  w->hmax = (float)(p->hmax * up);
  w->first = p->first, w->count = p->count, w->skip = p->skip;
}

static void set_group(TreeGroup *g, const double *x, const double *h)
{
  box_empty(g->lo, g->hi);
  g->hmax = 0;
  for (long i = g->first; i < g->first + (long)g->count; i++) {
    box_add(g->lo, g->hi, x + 3 * i, x + 3 * i);
    if (h && h[i] > g->hmax) g->hmax = h[i];
  }
}

void tree_refit(Tree *t, const double *x, const double *m, const double *h)
{
#pragma omp parallel for schedule(static, 64) if (t->n > SERIAL)
  for (int32_t k = 0; k < t->nodes; k++)
    if (t->node[k].leaf) sum_leaf(t->node + k, x, m, h);
  for (int32_t k = t->nodes; k-- > 0;)
    if (!t->node[k].leaf) sum_children(t->node, k);
#pragma omp parallel for schedule(static, 64) if (t->n > SERIAL)
  for (int32_t k = 0; k < t->nodes; k++) set_size(t, t->node + k), set_walk(t, k);
#pragma omp parallel for schedule(static, 64) if (t->n > SERIAL)
  for (int32_t k = 0; k < t->groups; k++) set_group(t->group + k, x, h);
}

/* Nodes, groups and room for the walk's copy, from the keys. */
static int make_nodes(Tree *t)
{
  t->nodes = t->groups = 0;
  if (grow(t, 0, (int32_t)t->n, 0) || make_groups(t, 0)) return -1;
  if (t->nodes <= t->walk_room) return 0;
  free(t->walk);
  t->walk = malloc((size_t)t->node_room * sizeof *t->walk);
  t->walk_room = t->walk ? t->node_room : 0;
  return t->walk ? 0 : -1;
}

int tree_build(Tree *t, long n, const double *x, const double *m, const double *h, Err *err)
{
  Cube cube;
  if (n < 1 || n > INT32_MAX / 2) return err_set(err, "cannot build a tree of %ld particles", n);
  long bad = find_cube(n, x, t->shift, &cube);
  if (bad)
    return err_set(err, "particle number %ld: coordinate %g is out of range", (-1 - bad) / 3,
                   x[-1 - bad]);
  memcpy(t->origin, cube.lo, sizeof t->origin);
  t->edge = cube.edge, t->n = n;
  if (n > t->key_room) {
    free(t->key);
    t->key = malloc((size_t)n * sizeof *t->key);
    t->key_room = t->key ? n : 0;
  }
  if (!t->key) return err_set(err, "cannot build a tree of %ld particles: no memory", n);
  hilbert_keys(&cube, n, x, t->key);
  split_keys(n, t->split, t->key);
  for (long i = 1; i < n; i++)
    if (t->key[i - 1] > t->key[i])
      return err_set(err, "cannot build a tree: particle number %ld is not in Hilbert order", i);
  if (make_nodes(t)) return err_set(err, "cannot build a tree of %ld particles: no memory", n);
  tree_refit(t, x, m, h);
  return 0;
}

void tree_free(Tree *t)
{
  free(t->node), free(t->walk), free(t->group), free(t->key);
  *t = (Tree){0};
}
