/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gravitational potential that some of a set of particles make at any of them: by direct sums
 * for few, by the tree for many. Who makes it may change from sum to sum, the particles stay: the
 * tree is built once. Rows of point masses pull as in the solver, softened within their own h
 * alone, and are no part of the tree. */
#ifndef POTENTIAL_H
#define POTENTIAL_H

#include "part.h"
#include "tree.h"

typedef struct {
  long n, *order; /* particle k of the sums is order[k] of the list; behind these [points] */
  long points;    /* rows of point masses in the list */
  double *x, *m, *h, *phi; /* [n][3] m; kg, J/kg, in that order; m: as they act now */
  const Parts *p;
  const long *list;
  Tree tree;
} Potential;

/* potential_open: for the particles list [n], which must stay until potential_close. */
int potential_open(Potential *s, const Parts *p, const long *list, long n, Err *err);

/* potential_sum: phi [n] J/kg at those with at[k] != 0, made by those with in[k] != 0, without
 * self-energy; NULL: all. Pairs are softened with their h as in gravity.h, whatever a run's
 * gravity.softening was; theta is the tree's opening angle. */
int potential_sum(Potential *s, const unsigned char *in, const unsigned char *at, double theta,
                  double *phi, Err *err);
void potential_close(Potential *s);

/* potential_own: phi [n] that list [n] makes at itself, at once. */
int potential_own(const Parts *p, const long *list, long n, double theta, double *phi, Err *err);

#endif
