/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rotation asked for: a vector, or a period and how the body lies to the plane of the orbit. */
#ifndef COLLIDE_SPIN_H
#define COLLIDE_SPIN_H

#include "body.h"
#include "geometry.h"

typedef struct {
  int given, turned; /* turned: also laid as the angles or the vector say */
  int vector;        /* omega is given in space */
  double omega[3];   /* rad/s */
  double rate;       /* rad/s about the pole; negative: clockwise */
  double obliquity,  /* of the pole to the angular momentum of the orbit [rad] */
      node,          /* of the equator's ascending node from the direction of contact [rad] */
      meridian;      /* by which the body is turned about its pole first [rad] */
} Spin;

/* spin_parse: "PERIOD[,OBLIQUITY[,NODE[,MERIDIAN]]]" with "none" for no rotation, or three
 * components with a unit like rad/s. */
int spin_parse(Spin *s, const char *text, Err *err);

/* spin_apply: turns the body, its pole (of its own rotation when that is most of its motion, else
 * the z axis) and its equator, then makes its rotation the one asked for; what else moves in it
 * stays. Then measures it. */
int spin_apply(const Spin *s, Body *b, const Geometry *g, Err *err);

#endif
