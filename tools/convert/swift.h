/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Initial conditions and snapshots of SWIFT and WoMa, and others in the GADGET layout, in the units
 * that their /Units name. SWIFT's smoothing length is twice the standard deviation of the kernel:
 * the kernel vanishes at 1.825742 times it (cubic spline). */
#ifndef SWIFT_H
#define SWIFT_H

#include <hdf5.h>
#include "lib/part.h"

int swift_is(hid_t file);
Parts *swift_read(hid_t file, Err *err);

/* swift_material: the name of the material here that one of SWIFT's numbers means, or NULL. */
const char *swift_material(long number);

#endif
