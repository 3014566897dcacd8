/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The host octree: particles sorted along a Hilbert curve (63-bit keys, ties by id), nodes as
 * contiguous ranges of the sorted order, depth first, with skip pointers. One tree serves gravity
 * (gravity.h) and the neighbour search (ngb.h), in the solver's CPU backend and in fof, clumps,
 * relax and render. Built from scratch it depends on the particles only, neither on their order nor
 * on the number of threads.
 *
 * The root cube spans the particles; a key resolves 2^-21 of its edge, and what lies closer
 * together shares a leaf, however many they are. Dimensions in which all coordinates are equal do
 * no harm (1D, 2D). */
#ifndef TREE_H
#define TREE_H

#include <stdint.h>
#include "err.h"

enum { TREE_BUCKET = 16, TREE_GROUP = 64, TREE_LEVELS = 21 };

typedef struct {
  double lo[3], hi[3];  /* tight box of the particles [m] */
  double com[3], mass;  /* m, kg; without masses, or all zero: the centre of the box, 0 */
  double q[6];          /* sum m (3 r_a r_b - r^2 delta_ab) about com, xx xy xz yy yz zz [kg m^2] */
  double hmax;          /* largest h below [m] */
  double size;          /* edge of the smallest cell, or of the box if longer (refit) [m] */
  int32_t first, count; /* particles first .. first+count-1 of the sorted order */
  int32_t skip;         /* the next node if this one is not opened; children start at the next */
  int16_t leaf;         /* 1: no children */
  int16_t level;        /* the cell is edge/2^level wide; levels without branching are left out */
} TreeNode;

/* What a walk reads of a node, in few bytes: lengths in root edges from the origin; boxes, open and
 * hmax are rounded outwards, so that a walk misses nothing. Node k is a leaf when skip == k + 1. */
typedef struct {
  float lo[3], hi[3], com[3];
  float open, hmax; /* open: size (1 + (mass/all mass)^(1/3)), 0 for no mass among some */
  int32_t first, count, skip;
} TreeWalk;

typedef struct {
  int32_t first, count; /* 1 .. TREE_GROUP consecutive sorted particles that share one walk */
  double lo[3], hi[3];  /* m */
  double hmax;          /* m */
} TreeGroup;

typedef struct {
  long n;
  TreeNode *node;
  TreeWalk *walk; /* [nodes] */
  int32_t nodes;
  TreeGroup *group;
  int32_t groups;
  double origin[3], edge; /* the root cube [m]; edge 1 when all particles coincide */
  uint64_t shift;         /* as given to tree_order; set it before tree_build */
  long split;             /* the same */
  /* private to tree.c: allocated lengths, and the keys */
  int32_t node_room, walk_room, group_room;
  uint64_t *key;
  long key_room;
} Tree;

/* tree_order: the Hilbert order of particles at x [n][3]: order[k] is the particle that comes k-th;
 * equal keys by id (NULL: by index). shift: 0, or a number that draws where the root cube lies: the
 * errors of gravity then differ from tree to tree and do not add up over a run. Returns 0, or -1:
 * no memory, or a coordinate that is not finite (or beyond 1e150); the message names the
 * particle's id. */
int tree_order(long n, const double *x, const int64_t *id, uint64_t shift, long *order, Err *err);

/* tree_order_parts: the same for a tree of two parts: particles split .. n-1 come after all others,
 * both in Hilbert order (0: one part). */
int tree_order_parts(long n, long split, const double *x, const int64_t *id, uint64_t shift,
                     long *order, Err *err);

/* tree_build: nodes and groups of particles that ARE in Hilbert order (see tree_order) at x [n][3],
 * n > 0, with masses m (NULL: none, for searches only) and supports h (NULL: zeros). Reuses the
 * memory of *t (zero it first). -1: no memory, a bad coordinate, or not in order. */
int tree_build(Tree *t, long n, const double *x, const double *m, const double *h, Err *err);

/* tree_refit: boxes, moments and sizes for new x, m, h of the same particles in the same order.
 * What walks the tree stays exact; it gets slower the further the particles have moved since
 * tree_build. */
void tree_refit(Tree *t, const double *x, const double *m, const double *h);

/* tree_outward: a box [m] as walks use it: root edges from the origin, rounded outwards. */
void tree_outward(const Tree *t, const double lo[3], const double hi[3], float out_lo[3],
                  float out_hi[3]);

/* tree_gap2: squared distance of two boxes, 0 when they overlap. */
static inline float tree_gap2(const float alo[3], const float ahi[3], const float blo[3],
                              const float bhi[3])
{
  float sum = 0;
  for (int d = 0; d < 3; d++) {
    float u = alo[d] - bhi[d], v = blo[d] - ahi[d], w = u > v ? u : v;
    w = w > 0 ? w : 0;
    sum += w * w;
  }
  return sum;
}
void tree_free(Tree *t);

#endif
