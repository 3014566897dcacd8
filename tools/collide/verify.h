/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The proof of the geometry: the bodies as they stand, as two points, integrated to contact. */
#ifndef COLLIDE_VERIFY_H
#define COLLIDE_VERIFY_H

#include "report.h"

/* verify_contact: integrates Newton's law (8th order, GSL) from the centres of mass of the
 * particles over the time to contact; adds the differences from what was asked for to the report
 * and says them on stderr. Error when one is above 1e-9 (of r1 + r2, of the speed, of 1 rad, of the
 * time r1 + r2 takes at that speed). */
int verify_contact(const Geometry *g, const Body b[2], Report *r, Err *err);

#endif
