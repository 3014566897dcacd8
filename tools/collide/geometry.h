/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From what the user gives to the approach and how it lies in space. */
#ifndef COLLIDE_GEOMETRY_H
#define COLLIDE_GEOMETRY_H

#include "body.h"
#include "lib/orbit.h"

/* Not given: NAN or NULL. */
typedef struct {
  double angle, momentum;     /* rad; kg m^2/s */
  const char *b;              /* impact parameter: a number of r1 + r2, or a length */
  const char *speed;          /* 3km/s, 1.7vesc, 700vinf, 0.5vescvinf */
  const char *distance;       /* a number of r1 + r2, or a length */
  double time;                /* before contact [s] */
  const char *state;          /* "files", or X,Y,Z,VX,VY,VZ */
  const char *contact, *pole; /* x, -y, ... or X,Y,Z */
  int no_gravity;
} GeometryInput;

typedef struct {
  OrbitApproach a;
  double e[3][3];    /* unit vectors: x of the orbit's plane, contact (y), angular momentum (z) */
  double x[3], v[3]; /* of the second body relative to the first at the start [m, m/s] */
  double reduced;    /* reduced mass [kg] */
} Geometry;

/* geometry_check: ends the program when the options contradict each other or some are missing. */
void geometry_check(const GeometryInput *in);

/* geometry_find: the geometry of two measured bodies with radii. */
int geometry_find(Geometry *g, const GeometryInput *in, const Body b[2], Err *err);

/* geometry_apart: error when the bodies overlap at the start: their spheres do, and no plane across
 * the line of centres or the direction of contact parts their particles. */
int geometry_apart(const Geometry *g, const Body b[2], Err *err);

#endif
