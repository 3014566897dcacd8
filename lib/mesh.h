/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed surfaces of triangles, from STL (text or binary) and OBJ files: shape models. */
#ifndef MESH_H
#define MESH_H

#include "err.h"

typedef struct {
  double *x;        /* [vertices][3] m */
  int (*corner)[3]; /* [triangles] */
  long vertices, triangles;
  double low[3], high[3]; /* box, m */
  double volume;          /* m^3 */
  long bins, *start, *in; /* triangles over each of bins x bins columns along z */
} Mesh;

/* mesh_read: scale: metres a unit of the file. Errors: not such a file, and a surface that is not
 * closed: an edge that does not belong to two triangles that run along it in opposite ways. */
int mesh_read(Mesh *m, const char *path, double scale, Err *err);
void mesh_free(Mesh *m);

/* mesh_inside: by the number of triangles above the point. On which side of an edge a point lies is
 * decided once for both triangles, ties as if the point were shifted a little: no point falls
 * between triangles. */
int mesh_inside(const Mesh *m, const double x[3]);

#endif
