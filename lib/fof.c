/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fragments: neighbours from the tree, joined as they are found by a lock-free union-find in which
 * the smaller index is always the root, so that the forest's roots do not depend on the threads
 * (Jayanti & Tarjan 2016, arXiv:1612.01514, with linking by index). */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "fof.h"
#include "group.h"
#include "ngb.h"
#include "pointmass.h"

/* The kept particles in Hilbert order. */
typedef struct {
  long n, *row; /* row in Parts */
  double *x, *h;
  _Atomic uint32_t *parent;
} Set;

static uint32_t find(_Atomic uint32_t *parent, uint32_t i)
{
  for (;;) {
    uint32_t up = atomic_load_explicit(&parent[i], memory_order_relaxed);
    if (up == i) return i;
    uint32_t over = atomic_load_explicit(&parent[up], memory_order_relaxed);
    if (over != up) atomic_compare_exchange_weak(&parent[i], &up, over); /* halve the path */
    i = over;
  }
}

static void join(_Atomic uint32_t *parent, uint32_t i, uint32_t j)
{
  for (;;) {
    i = find(parent, i), j = find(parent, j);
    if (i == j) return;
    if (i < j) {
      uint32_t swap = i;
      i = j, j = swap;
    }
    uint32_t root = i;
    if (atomic_compare_exchange_strong(&parent[i], &root, j)) return;
  }
}

static void set_free(Set *s) { free(s->row), free(s->x), free(s->h), free(s->parent); }

static int set_room(Set *s, long n, Err *err)
{
  size_t room = (size_t)n + 1;
  s->row = malloc(room * sizeof *s->row), s->parent = malloc(room * sizeof *s->parent);
  s->x = malloc(3 * room * sizeof *s->x), s->h = malloc(room * sizeof *s->h);
  if (s->row && s->parent && s->x && s->h) return 0;
  return err_set(err, "out of memory for %ld particles", n);
}

/* The kept particles: rows, then sorted along the curve. */
static int set_fill(Set *s, const Parts *p, const unsigned char *keep, Err *err)
{
  int64_t *id = malloc((size_t)(p->n + 1) * sizeof *id);
  long *order = malloc((size_t)(p->n + 1) * sizeof *order), *row = s->row;
  int failed = !id || !order ? err_set(err, "out of memory for %ld particles", p->n) : 0;
  for (long i = 0; i < p->n && !failed; i++) {
    if ((keep && !keep[i]) || pointmass_row(p, i)) continue;
    memcpy(s->x + 3 * s->n, p->x + 3 * i, 3 * sizeof *s->x);
    id[s->n] = p->id[i], row[s->n++] = i;
  }
  if (!failed && s->n) failed = tree_order(s->n, s->x, id, 0, order, err);
  for (long k = 0; k < s->n && !failed; k++) order[k] = row[order[k]];
  for (long k = 0; k < s->n && !failed; k++) {
    row[k] = order[k], s->h[k] = p->h[row[k]];
    memcpy(s->x + 3 * k, p->x + 3 * row[k], 3 * sizeof *s->x);
    atomic_init(&s->parent[k], (uint32_t)k);
  }
  free(id), free(order);
  return failed;
}

static void befriend(long i, const uint32_t *j, long n, void *parent)
{
  for (long k = 0; k < n; k++)
    if (j[k] < i) join(parent, (uint32_t)i, j[k]);
}

static int set_link(Set *s, double link, Err *err)
{
  Tree tree = {0};
  if (s->n < 2) return 0;
  int failed = tree_build(&tree, s->n, s->x, NULL, s->h, err) ||
               ngb_each(&tree, s->x, s->h, link, befriend, s->parent, err);
  tree_free(&tree);
  return failed ? -1 : 0;
}

/* The fragment that a point mass is in: of the particle nearest to it that it is a friend of. */
static int32_t fragment_of(const Parts *p, long i, double link, const int32_t *id)
{
  double least = INFINITY;
  int32_t found = 0;
  for (long j = 0; j < p->n - p->point_rows; j++) {
    const double r = id[j] ? group_apart(p->x + 3 * i, p->x + 3 * j) : (double)INFINITY;
    if (r < 0.5 * link * (p->h[i] + p->h[j]) && r < least) least = r, found = id[j];
  }
  return found;
}

long fof_find(const Parts *p, double link, const unsigned char *keep, long least, int32_t *id,
              Err *err)
{
  Set s = {0};
  long found = -1;
  if (!set_room(&s, p->n, err) && !set_fill(&s, p, keep, err) && !set_link(&s, link, err)) {
    memset(id, 0, (size_t)p->n * sizeof *id), found = 0;
    for (long k = 0; k < s.n; k++) { /* a root comes before the others of its fragment */
      const uint32_t root = find(s.parent, (uint32_t)k);
      id[s.row[k]] = root == k ? (int32_t)++found : id[s.row[root]];
    }
    found = group_rank(p, id, found, least, err);
    for (long i = p->n - p->point_rows; i < p->n && found > 0; i++)
      if (!keep || keep[i]) id[i] = fragment_of(p, i, link, id);
  }
  set_free(&s);
  return found;
}
