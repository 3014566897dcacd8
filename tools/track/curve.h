/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The masses of the largest objects against time. */
#ifndef CURVE_H
#define CURVE_H

#include "lib/group.h"

enum { CURVE_TOP = 5 };

typedef struct {
  double time, total, held, mass[CURVE_TOP]; /* s, kg; held: in objects */
  double xi, u, heating; /* accretion efficiency; internal energy J; its gain over 1/2 mu v^2 */
  long objects;
} CurvePoint;

typedef struct {
  CurvePoint *point; /* [n] */
  long n;
} Curve;

/* curve_add: a dump: its system, and its objects g [n] by descending mass. Material of body 0 is
 * the target's, of body 1 the impactor's; mu is their reduced mass, v the contact speed of
 * /Collision (nan without). */
int curve_add(Curve *c, double time, const Group *system, const Group *g, long n, const Parts *p,
              Err *err);
void curve_free(Curve *c);

/* curve_write: a table; above it mean and standard deviation of each column over the dumps of the
 * last tenth of the time, at least two. curve_draw: a picture. */
int curve_write(const char *path, const Curve *c, Err *err);
int curve_draw(const char *path, const Curve *c, const char *title, Err *err);

#endif
