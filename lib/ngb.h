/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact neighbour lists by group walks of the tree: j is a neighbour of i when r_ij < factor (h_i + h_j)/2, j != i; so lists are
 * symmetric. No particle is ever dropped: lists grow as they must. */
#ifndef NGB_H
#define NGB_H

#include "tree.h"

typedef struct {
  int64_t *start; /* [n + 1] */
  uint32_t *list; /* neighbours of i (sorted index, ascending): list[start[i]] .. list[start[i+1] - 1] */
  int64_t room;   /* allocated length of list */
  long n;
} Ngb;

/* ngb_search: lists for particles in tree order, x [n][3], h [n]. y [n][3] (or NULL) is a second set of positions of the same
 * particles, not far from x: a pair is listed when it interacts at x or at y (the solver evaluates one loop at each).
 * Parallel over groups; the result does not depend on the number of threads. */
int ngb_search(Ngb *g, const Tree *t, const double *x, const double *y, const double *h, double factor, Err *err);

/* ngb_point: calls visit(j, r2, data) for every particle of the tree with r < factor * max(radius, h_j) ... of a point x0 [3];
 * for interpolation (render) and for finding h: radius is a fixed search radius when h is NULL. */
void ngb_point(const Tree *t, const double *x, const double *h, const double x0[3], double radius,
               void (*visit)(long j, double r2, void *data), void *data);

/* ngb_smoothing: h [n] such that the kernel support holds `want` particles on average, 4/3 pi h^3 n = want with the local number
 * density (2D: pi h^2 n, 1D: 2 h n), from the distance of neighbours; iterated to 1 %. x in tree order. */
int ngb_smoothing(const Tree *t, const double *x, int dimension, double want, double *h, Err *err);
void ngb_free(Ngb *g);

#endif
