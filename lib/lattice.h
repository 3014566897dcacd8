/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Balls cut out of lattices (a disc in 2D, a segment in 1D). The ball is centred on a site and only
 * whole shells of equidistant sites are taken, so its centre of mass is its centre, for every
 * shell. */
#ifndef LATTICE_H
#define LATTICE_H

#include "err.h"

/* X(CAPITAL, name): hcp is the close packing with rows along x (2D: hexagonal); cubic the simple
 * cubic one (2D: square). */
#define LATTICES(X) X(HCP, hcp) X(CUBIC, cubic)

typedef enum {
#define LATTICE_ENUM(CAPITAL, NAME) LATTICE_##CAPITAL,
  LATTICES(LATTICE_ENUM)
#undef LATTICE_ENUM
      LATTICE_COUNT
} Lattice;

typedef struct {
  long n;
  double *x;    /* [n][3] in units of the spacing, z slowest; y, z = 0 in fewer dimensions */
  long *shell;  /* [n] shell of the site, counted from 0 outwards */
  long *within; /* [shells] sites in this shell and all inside it */
  long shells;
  double volume; /* per site in units of spacing^dimension: HCP 1/sqrt(2) */
} LatticeBall;

/* lattice_ball: the ball whose number of sites is closest to `want` >= 1; dimension 1, 2 or 3. In
 * 1D the number is exact. */
int lattice_ball(LatticeBall *ball, Lattice lattice, int dimension, long want, Err *err);
void lattice_free(LatticeBall *ball);

/* lattice_cut: the number of innermost whole shells whose sites come closest to `want`. */
long lattice_cut(const LatticeBall *ball, double want);

/* lattice_sites: calls visit for every site within r of the origin, which is one, in the order of
 * LatticeBall; lengths in units of the spacing. lattice_volume: of a site. */
typedef void LatticeVisit(void *to, const double x[3]);
void lattice_sites(Lattice lattice, int dimension, double r, LatticeVisit *visit, void *to);
double lattice_volume(Lattice lattice, int dimension);

#endif
