/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One of the two bodies: a file, or a part of one, measured, numbered and moved to its place. */
#ifndef COLLIDE_BODY_H
#define COLLIDE_BODY_H

#include "lib/group.h"

typedef struct {
  const char *file;
  Parts *p;
  Group g;            /* mass, centre of mass, velocity, spin */
  double reach;       /* of the outermost particle from the centre [m] */
  double radius;      /* as used [m] */
  const char *source; /* where the radius is from */
  int selected;       /* only a part of the file */
  int first, bodies;  /* BodyIDs in the system: first .. first + bodies - 1 */
} Body;

/* body_read: the file, or what `select` names of it (body:N, fragment:N, clump:N; NULL: all).
 * radius: a length, "body" (/Body), "reach" (outermost particle and half a spacing), "volume" (of a
 * sphere of sum m/rho), NULL: /Body of a whole file of one body, volume of a selection, else
 * reach with a warning. */
int body_read(Body *b, const char *file, const char *select, const char *radius, Err *err);

/* body_measure: mass, centre, spin, reach of what is there now. */
int body_measure(Body *b, Err *err);

/* body_move: shifts positions and velocities such that the centre of mass has these. */
void body_move(Body *b, const double x[3], const double v[3]);

/* body_extent: of the particles from the centre along a unit vector, [0] backwards, [1] forwards,
 * both positive [m]. */
void body_extent(const Body *b, const double axis[3], double extent[2]);

/* body_rename: BodyIDs become b->first, b->first + 1 ... in their old order, the entries of /Body
 * with them; what is there of a former collision goes. */
int body_rename(Body *b, Err *err);

/* body_free_ids: what has to be added to the ids of b so that none of a occurs in it: 0 when there
 * is none; < 0 and *err when it cannot be done. */
int64_t body_free_ids(const Body *a, const Body *b, Err *err);

void body_free(Body *b);

#endif
