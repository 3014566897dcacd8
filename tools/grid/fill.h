/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles onto the cells of a raster. */
#ifndef FILL_H
#define FILL_H

#include "lib/part.h"
#include "raster.h"

#define FILL_METHODS "interpolate|sum|mass"

typedef struct {
  const char *method; /* of FILL_METHODS */
  int axis[3];        /* of the grid: two in the plane, then across; 0 1 2 in a volume */
  int flat, column;   /* a plane; summed along the line of sight */
} FillHow;

/* fill_raster: the cells of r for its fields (names and units are filled in), from expressions text
 * [fields]; behind them, with the mass method or a column, the mass itself. Interpolated: sum V A W
 * / sum V W inside of the matter, NAN outside, kinds by the particle that weighs most; sum: sum V A
 * W; mass: MassDensity (ColumnDensity) holds the mass of the particles, means weighted by mass. */
int fill_raster(Raster *r, const Parts *p, const FillHow *how, const char *const *text,
                const char *const *name, int n, const char *file, Err *err);

#endif
