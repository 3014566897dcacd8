/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is looked at, from where: a parallel projection onto one of the coordinate planes. */
#ifndef CAMERA_H
#define CAMERA_H

#include "lib/part.h"

typedef struct {
  double centre[3];   /* m */
  double scale;       /* px/m */
  double offset;      /* of the cutting plane from the centre, towards the viewer, m */
  int right, up, out; /* axes to the right, upwards and towards the viewer */
  double sign;        /* of the last */
  int w, h;           /* px */
} Camera;

/* camera_plane: xy (seen from +z), xz (from -y) or yz (from +x). */
void camera_plane(Camera *c, const char *plane);

/* camera_centre: com, body:K, fragment:K, clump:K (their centres of mass) or X,Y,Z with units. */
int camera_centre(Camera *c, const Parts *p, const char *text, const char *file, Err *err);

/* camera_extent: width [m] of a picture of c->w x c->h that shows 99 % of the mass with a margin.
 * Needs plane and centre. */
double camera_extent(const Camera *c, const Parts *p);

/* camera_see: position in px, u to the right and v downwards, and depth towards the viewer from the
 * cutting plane, px. */
void camera_see(const Camera *c, const double x[3], double *u, double *v, double *depth);

#endif
