/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spheres packed at random into a shape, without overlap: the boulders of a rubble pile. */
#ifndef PACK_H
#define PACK_H

#include <stdint.h>
#include "shape.h"

typedef struct {
  double low, high; /* smallest and largest radius [m] */
  double slope;     /* N(>r) ~ r^-slope between them */
  double fill;      /* wanted volume of the spheres over that of the shape */
  long most;        /* spheres */
  uint64_t seed;
} PackOptions;

/* pack_spheres: x [n][3] and r [n], malloc'ed, from the largest to the smallest. Radii are drawn
 * until their volumes fill what is wanted; each sphere, the largest first, gets the first of many
 * random places where it fits; one that fits nowhere is left out. Returns n, or -1. */
long pack_spheres(const Shape *shape, const PackOptions *o, double **x, double **r, Err *err);

#endif
