/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gravitationally bound bodies. Two methods:
 * potential: a friends-of-friends fragment is unbound layer by layer: from a core around its
 * deepest particle (larger and larger ones, as what is hot holds only as a whole), members are
 * those of the fragment with e_j < 0 in the potential of the current members and in the frame of
 * their most bound tenth, until nothing changes; what is left is searched again, and at the end
 * loose particles join the body that binds them most. A moon that is a fragment of its own stays a
 * body of its own. grow: 004 fig. 2.29 in batch form: from the deepest free particle, members are
 * all free particles bound to the point mass of the current members, e_j = v^2/2 - G M/r, until
 * nothing changes; a body and its moons are one. Neither depends on the order of particles or on
 * the frame of reference. Rows of point masses (pointmass_rows) are members as particles are, and
 * hold bodies of any size: alone (potential: what they bind joins; grow: they are the first seeds).
 * With them a loose particle joins the body about which its orbit is the smallest. */
#ifndef CLUMP_H
#define CLUMP_H

#include "part.h"

/* What is counted against the potential: v^2/2; + u; + max(p, 0)/rho (energies of gas that will
 * expand). */
typedef enum { CLUMP_KINETIC, CLUMP_THERMAL, CLUMP_ENTHALPY, CLUMP_LEVELS } ClumpLevel;

typedef struct {
  int grow; /* method: 0 potential, 1 grow */
  ClumpLevel level;
  double link;  /* friends when r_ij < link (h_i + h_j)/2 */
  double theta; /* opening angle of the tree */
  long least;   /* smallest number of particles of a body */
} ClumpOptions;

/* clump_find: id [p->n] = 1, 2, ... by descending mass, 0: in no body. phi [p->n] J/kg: the
 * potential that a particle's body makes at it, NAN in no body. Needs id x v m h, u from
 * CLUMP_THERMAL on, p and rho for CLUMP_ENTHALPY. Returns the number of bodies, or -1. */
long clump_find(const Parts *p, const ClumpOptions *o, int32_t *id, double *phi, Err *err);

/* clump_levels: mass [kg] of the members list [n] (ascending ids) that is bound at each level, with
 * phi as from clump_find; NAN where a field is missing. */
int clump_levels(const Parts *p, const long *list, long n, const double *phi,
                 double mass[CLUMP_LEVELS], Err *err);

#endif
