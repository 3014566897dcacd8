/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Self-gravity on the host: Barnes-Hut with quadrupoles, or direct sums. Groups of particles walk the tree together: a node is
 * accepted when size/d < theta, d the smallest distance from the group's box to the node's centre of mass, and never when its box
 * and the group's overlap. Softening is symmetric: each particle is the mass profile of a Wendland C2 kernel, with the pair's mean support
 * h_ij = (h_i + h_j)/2: a = -G m f(min(r/h_ij, 1))/max(r, h_ij)^3 r, f(1) = 1, exactly Newtonian from r = h_ij on.
 * Multipoles: validation.md A9 and C2 (004 eq. 2.72, 2.73 corrected). */
#ifndef GRAVITY_H
#define GRAVITY_H

#include "tree.h"

typedef struct {
  double theta; /* opening angle, 0.7 */
  double G;     /* m^3/kg/s^2 */
  int single;   /* pair arithmetic in single precision relative to the group (scaled, so that SI values do not overflow) */
} GravityOptions;

/* gravity_tree: accelerations a [n][3] (overwritten) and potentials phi [n] (per mass, without self-energy; may be NULL) of
 * particles in tree order. h [n] supports (NULL: none, then coincident particles do not act on each other). */
int gravity_tree(const Tree *t, const double *x, const double *m, const double *h, const GravityOptions *o, double *a,
                 double *phi, Err *err);

/* gravity_direct: the same by n^2 sums in double precision, any order of particles; forces are antisymmetric to rounding. */
int gravity_direct(long n, const double *x, const double *m, const double *h, double G, double *a, double *phi, Err *err);

/* gravity_soft: f(q) and the potential's factor g(q), phi = -G m g(min(q,1))/max(r,h), for q = r/h in 0..1; f(1) = g(1) = 1. */
double gravity_soft_force(double q);
double gravity_soft_potential(double q);

#endif
