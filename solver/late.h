/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The late stage of an impact (Raducan & Jutzi 2022, Planet. Sci. J. 3, 128; Jutzi, Raducan, Zhang,
 * Michel & Arakawa 2022, Nat. Commun. 13, 7134): long after the shock, what moves is slow against
 * the sound of rock. From late.time on all matter stiffer than late.bulk_modulus K has p = K
 * (rho/rho0 - 1) and a shear modulus of K, so that steps grow by the ratio of the sound speeds. */
#ifndef LATE_H
#define LATE_H

#include "backend.h"

/* late_until: `until`, or late.time where that comes first, so that a step ends there. */
double late_until(const Sim *sim, double until);

/* late_due: whether the stage begins now. */
int late_due(const Sim *sim);

/* late_soften: the laws of the stage, in sim->material and on the backend; sim->late = 1. Returns 0
 * or -1. */
int late_soften(Sim *sim, Err *err);

/* late_enter: these, and S as the same elastic strain makes it with the new shear modulus. u stays
 * as it is, so the energy does, too. New rates are the caller's. */
int late_enter(Sim *sim, Err *err);

#endif
