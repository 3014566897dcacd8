/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SPHLATCH's dumps (Reufer 2011): groups Step#N of one or more steps, vectors as tables, cgs, and
 * temperatures in eV; its h is half the radius at which the kernel vanishes. */
#ifndef SPHLATCH_H
#define SPHLATCH_H

#include <hdf5.h>
#include "lib/part.h"

int sphlatch_is(hid_t file);

/* sphlatch_read: step N, or with a negative one the step that `current` names, else the last. */
Parts *sphlatch_read(hid_t file, long step, Err *err);

#endif
