/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Self-gravity on the host: Barnes-Hut with quadrupoles, or direct sums. Groups of particles walk
 * the tree together: a node is accepted when size/d < theta/(1 + (M_node/M)^(1/3)), d the
 * smallest distance from the group's box to the node's centre of mass (the factor, because the few
 * heaviest nodes make most of the error), and only when the boxes are further apart than the
 * largest softening (h_group + h_node)/2; so never when they overlap. What is not accepted is
 * summed particle by particle.
 *
 * Softening is symmetric. SPLINE (physics/softening.h): each pair feels the mass profile of a
 * Wendland C2 kernel with the support h_ij = (h_i + h_j)/2, or 3 epsilon. With s = max(r, h_ij) and
 * q = min(r/h_ij, 1)
 *   a = -G m F(q) r/s^3,  phi = -G m P(q)/s,  F(1) = P(1) = 1: exactly Newtonian from r = h_ij on,
 * and smooth at 0. PLUMMER: with one epsilon for all, D^2 = r^2 + epsilon^2,
 *   a = -G m r/D^3,  phi = -G m/D;
 * nodes are taken by size/D, as their multipoles hold at any distance: with D for r and
 * rQr - epsilon^2 sum m r'^2 for rQr below. Multipoles (docs/theory.md 4; 004 eq. 2.72, 2.73
 * corrected), Q = sum m (3 r_a r_b - r^2 delta_ab): phi = -G (M/r + rQr/2r^5),
 * a = G (-M r/r^3 + Q r/r^5 - 5/2 rQr r/r^7). */
#ifndef GRAVITY_H
#define GRAVITY_H

#include "../physics/softening.h"
#include "tree.h"

typedef struct {
  double theta; /* opening angle >= 0, 0.7; 0 opens everything */
  double G;     /* m^3/kg/s^2 */
  int single; /* pair arithmetic in single precision, coordinates relative to the group's centre */
  int softening;  /* SOFTENING_SPLINE, SOFTENING_PLUMMER */
  double epsilon; /* m; 0: by each pair's h, splines only */
} GravityOptions;

/* gravity_tree: accelerations a [n][3] (overwritten) and potentials phi [n] (per mass, without
 * self-energy; may be NULL) of particles in tree order; x, m, h are those the tree was built with.
 * h [n] supports (NULL: none; without an epsilon coincident particles then do not act on each
 * other). The result does not depend on the number of threads. single: lengths in root edges or in
 * the largest h, masses in total masses, so that SI values neither overflow nor vanish; the error
 * is below 1e-5 of the mean |a|, except that unsoftened pairs closer than 1e-10 of it do not act on
 * each other. -1: no memory. */
int gravity_tree(const Tree *t, const double *x, const double *m, const double *h,
                 const GravityOptions *o, double *a, double *phi, Err *err);

/* gravity_potential: only phi, and only where only[i] != 0 (NULL: everywhere). */
int gravity_potential(const Tree *t, const double *x, const double *m, const double *h,
                      const GravityOptions *o, const unsigned char *only, double *phi, Err *err);

/* gravity_direct: the same by n^2 sums, always in double precision, any order of particles; a or
 * phi may be NULL; forces are antisymmetric to rounding. */
int gravity_direct(long n, const double *x, const double *m, const double *h,
                   const GravityOptions *o, double *a, double *phi, Err *err);

#endif
