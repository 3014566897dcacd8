/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The solver as relax drives it: friction in two stages, a run without, forces at an instant. */
#ifndef RUN_H
#define RUN_H

#include "../../solver/sim.h"
#include "body.h"
#include "measure.h"

/* run_settings: those of the solver; tau [s] of the friction, 0: none, with full strength and
 * energy; outer: pressure outside [Pa]. Exits on a bad --set. */
Param run_settings(const Options *o, double tau, double outer);

/* run_time: s of a time that may be given in the body's free-fall times. */
double run_time(const Body *b, Span time);

/* run_damped: until the body has been quiet for a free-fall time and its density no longer
 * improves. *took: how long it ran [s]. Returns 0, -1, or ERR_STOPPED when a signal has ended it
 * and the checkpoint holds the state. */
int run_damped(Body *b, const Options *o, double *took, Err *err);

/* run_free: without friction, for `time`. */
int run_free(Body *b, const Options *o, double time, Err *err);

/* run_residual: rms of the acceleration that is left of gravity and pressure, in the frame that
 * turns with the body, over gravity at the surface. The body is not changed. */
int run_residual(const Body *b, const Options *o, double *residual, Err *err);

#endif
