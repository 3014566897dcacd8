/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BINS_H
#define BINS_H

#include "lib/disk.h"

/* bins_write: the particles of class disk in bins of equal width from the body's radius to the
 * outermost of them: floor((r - r_min)/dr), centres at r_min + (j + 1/2) dr; mass, surface density
 * and angular momentum about the direction `axis`, in all and by material and body of origin. */
int bins_write(const char *path, const Parts *p, const DiskBody *b, const double axis[3], long bins,
               Err *err);

#endif
