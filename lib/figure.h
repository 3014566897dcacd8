/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figure of a body that spins: concentric oblate spheroids, each a level surface of gravity and
 * centrifugal force at its pole and its equator, in hydrostatic equilibrium between them. Exact for
 * constant density (Maclaurin spheroids); the idea is that of Hubbard (2013), ApJ 768, 43, without
 * higher harmonics. */
#ifndef FIGURE_H
#define FIGURE_H

#include "structure.h"

/* figure_spin: turns the structure of the body at rest into that of the body spinning about z with
 * omega [rad/s], layer masses and laws kept: r becomes the radius of the sphere of the same volume,
 * f the flattening, p rho u follow. Errors: no equilibrium, it spins too fast. */
int figure_spin(Structure *s, const StructureBody *body, double omega, Err *err);

/* figure_flatten: a point of the sphere of radius n->r to the spheroid. figure_level: the radius of
 * the sphere with the volume of the level surface through a point at height z above the equator and
 * distance w from the axis. */
void figure_flatten(const StructureNode *n, double x[3]);
double figure_level(const Structure *s, double w, double z);

/* figure_potential: of a homogeneous oblate spheroid with semi-axes a >= c and G rho = 1, at
 * distance w from the axis and height z, inside or outside; m^2. Source: Chandrasekhar (1969),
 * Ellipsoidal Figures of Equilibrium, ch. 3. */
double figure_potential(double a, double c, double w, double z);

#endif
