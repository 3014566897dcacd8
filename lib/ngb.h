/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact neighbour lists by group walks of the tree: j is a neighbour of i when r_ij < factor (h_i +
 * h_j)/2, j != i; so lists are symmetric. No particle is ever dropped: lists grow as they must.
 * Zero an Ngb before its first use. */
#ifndef NGB_H
#define NGB_H

#include "tree.h"

typedef struct {
  int64_t *start; /* [n + 1] */
  uint32_t
      *list; /* neighbours of i (sorted index, ascending): list[start[i]] .. list[start[i+1] - 1] */
  int64_t room; /* allocated length of list */
  long n;
  struct NgbShare *share; /* private to ngb.c: what each thread found */
  int shares;
} Ngb;

/* ngb_search: lists for particles in tree order, x [n][3] and h [n] as the tree was built with. y
 * [n][3] (or NULL) is a second set of positions of the same particles, not far from x up to common
 * motion: a pair is listed when it interacts at x or at y (the solver evaluates one loop at each).
 * Parallel over groups; the result does not depend on the number of threads. Of a tree in two parts
 * (Tree.split) the second is listed only: its own lists are empty or not. -1: no memory, x or h
 * not those of the tree, or a y that is not finite. */
int ngb_search(Ngb *g, const Tree *t, const double *x, const double *y, const double *h,
               double factor, Err *err);

/* ngb_each: the same neighbours without lists in memory: visit is called once for every particle i
 * with those of it, j [n], by all threads at once, in any order. */
int ngb_each(const Tree *t, const double *x, const double *h, double factor,
             void (*visit)(long i, const uint32_t *j, long n, void *data), void *data, Err *err);

/* ngb_point: calls visit for every particle of the tree with r < max(radius, h_j) of a point x0
 * [3], in tree order; h [n] as the tree was built with, or NULL: r < radius. r2 is r^2. */
void ngb_point(const Tree *t, const double *x, const double *h, const double x0[3], double radius,
               void (*visit)(long j, double r2, void *data), void *data);

/* ngb_smoothing: h [n] such that a support holds `want` particles (itself among them): V(h) n =
 * want with V = 4/3 pi h^3 (2D: pi h^2, 1D: 2 h) and the local number density n = sum_j W(r_ij, h)
 * of a Wendland C2 kernel, self included; solved to 1e-6. Beside a free surface n is the kernel's,
 * so h grows there. x in tree order. -1: too few particles for `want`, too many at one place, no
 * memory. */
int ngb_smoothing(const Tree *t, const double *x, int dimension, double want, double *h, Err *err);
void ngb_free(Ngb *g);

#endif
