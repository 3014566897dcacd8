/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Who of a set is bound, with the potential known: energies in the frame of what lies deepest. */
#ifndef BOUND_H
#define BOUND_H

#include <math.h>
#include "clump.h"

/* Mass fraction of a body that carries its frame. */
#define BOUND_CORE 0.1

/* bound_heat: what counts against the potential besides v^2/2 [J/kg]. */
static inline double bound_heat(const Parts *p, long i, ClumpLevel level)
{
  double e = level >= CLUMP_THERMAL ? p->u[i] : 0;
  return level >= CLUMP_ENTHALPY ? e + fmax(0, p->p[i]) / p->rho[i] : e;
}

/* bound_speed2: |a - b|^2. */
static inline double bound_speed2(const double *a, const double *b)
{
  double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

/* bound_frame: velocity of the particles with the lowest potential, a tenth of the mass: phi [n]
 * J/kg (INFINITY: not of them), masses m, velocities v [n][3]. Equal potentials: the first first.
 * order [n]: scratch. */
int bound_frame(long n, const double *phi, const double *m, const double *v, long *order,
                double out[3], Err *err);

/* bound_count: of the particles list [n] with potential own [n] J/kg: how many are bound at a
 * level, and their mass [kg]. Point masses are: the others are bound to them. */
long bound_count(const Parts *p, const long *list, long n, const double *own, ClumpLevel level,
                 double *mass, Err *err);

#endif
