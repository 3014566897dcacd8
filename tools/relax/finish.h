/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is done to a body that has come to rest. */
#ifndef FINISH_H
#define FINISH_H

#include "body.h"
#include "measure.h"

/* finish_eject: drops what is not bound, or beyond 1.5 radii; reports it. */
int finish_eject(Body *b, Err *err);

/* finish_settle: centre of mass to 0; mean velocity off; without a wanted spin the angular momentum
 * off too; with `rigid` all velocities become those of rigid rotation. Reports the spin. */
int finish_settle(Body *b, int rigid, Err *err);

/* finish_reset: damage, histories and time back to nothing, with `fluid` the stress too; radii into
 * /Body. */
int finish_reset(Body *b, int fluid, const Measure *m, Err *err);

#endif
