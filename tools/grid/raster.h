/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fields on a regular grid, and the files that it can be written to. */
#ifndef RASTER_H
#define RASTER_H

#include "lib/err.h"

#define RASTER_FORMATS "hdf5|vtk|vti"

typedef struct {
  char name[128], unit[96];
  float *value; /* [n[2]][n[1]][n[0]] */
} RasterField;

typedef struct {
  int n[3];              /* cells along x, y, z; 1 across a plane */
  double lo[3], cell[3]; /* lower corner and edges of a cell, m */
  double time;           /* s */
  const char *about;     /* one line: how it was made */
  RasterField *field;    /* [fields] */
  int fields;
} Raster;

/* raster_write: values belong to cells. hdf5: datasets by name with unit, coordinates of the
 * centres in x, y, z, attributes Time, Origin, Spacing, About; vtk: legacy structured points,
 * binary; vti: XML image data. "-" is stdout; appears whole or not at all. */
int raster_write(const Raster *r, const char *path, const char *format, Err *err);

#endif
