/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bounds on what a run may lose of what it should keep. */
#ifndef GUARD_H
#define GUARD_H

#include "sim.h"

/* What a run began with. */
typedef struct {
  double energy, momentum[3], angular[3]; /* J, kg m/s, kg m^2/s */
} Guard;

/* guard_start: of the sums at the start, kept in the attributes of /Run. guard_resume: from there;
 * -1: they are not. */
int guard_start(Guard *g, const Sums *sums, Parts *parts, Err *err);
int guard_resume(Guard *g, const Parts *checkpoint, Err *err);

/* guard_check: -1 with a message when something has drifted by more than the settings allow: the
 * change since the start, without what floors have added, with what has left the run, over what
 * guard.* says. */
int guard_check(const Guard *g, const Sums *sums, const Sim *sim, Err *err);

#endif
