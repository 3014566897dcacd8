/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is looked at, from where: a parallel or perspective projection in any direction. */
#ifndef CAMERA_H
#define CAMERA_H

#include "lib/part.h"

typedef struct {
  double centre[3];  /* m */
  double axis[3][3]; /* unit vectors to the right, upwards and towards the viewer */
  double scale;      /* px/m, in perspective at the centre */
  double offset;     /* of the cutting plane from the centre, towards the viewer, m */
  double distance;   /* of the eye from the centre, m; INFINITY: parallel */
  int w, h;          /* px */
} Camera;

/* camera_turn: seen from azimuth (0: +x, 90 degrees: +y) and elevation above the xy plane, rolled
 * clockwise, rad; +z is up, at elevation 90 degrees what lies at azimuth + 180. Parallel until a
 * distance is set. camera_plane: xy (seen from +z), xz (from -y) or yz (from +x). */
void camera_turn(Camera *c, double azimuth, double elevation, double roll);
void camera_plane(Camera *c, const char *plane);

/* camera_extent: width [m] of a picture of c->w x c->h that shows 99 % of the mass with a margin.
 * Needs axes and centre. slope: tangent of half the angle of a perspective, 0: parallel. */
double camera_extent(const Camera *c, const Parts *p, double slope);

/* camera_see: position in px, u to the right and v downwards, and depth towards the viewer from the
 * cutting plane, px at the centre. Returns how much larger things are there than at the centre: 1
 * without perspective, 0 where they are beside or behind the eye. */
double camera_see(const Camera *c, const double x[3], double *u, double *v, double *depth);

#endif
