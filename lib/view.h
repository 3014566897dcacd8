/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Step#0: the particles as one-dimensional datasets, as ParaView's H5Part reader wants them,
 * without a second copy: scalars are hard links, components are virtual datasets of the same file.
 * Coordinates become x, y, z; the others NAME_0, NAME_1, ... */
#ifndef VIEW_H
#define VIEW_H

#include <hdf5.h>
#include "err.h"

/* view_open: the group Step#0 with its TimeValue [s]; or -1. */
hid_t view_open(hid_t file, double time, Err *err);

/* view_add: links for one dataset of /PartType0. Only numbers, with at most 9 of them a row, have a
 * view; a name that the view has already is left alone. */
int view_add(hid_t step, hid_t particles, const char *name, Err *err);

#endif
