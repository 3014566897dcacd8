/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Faces of the computational box: periodic, mirror, no-slip. Particles near a face have images
 * behind it, which the search lists like particles and the pair loops read as their owner's record
 * at another place; nothing else knows of them. At most one image through each face, so the box
 * must be wider than what interacts. */
#ifndef BOUNDS_H
#define BOUNDS_H

#include <stdint.h>
#include "../physics/hd.h"

enum { BOUNDS_OPEN, BOUNDS_PERIODIC, BOUNDS_MIRROR, BOUNDS_NO_SLIP };
enum { BOUNDS_SELF, BOUNDS_LOW, BOUNDS_HIGH }; /* through which face an image is seen */
enum { BOUNDS_CODES = 27 };

typedef struct {
  int on;              /* any face that is not open */
  int low[3], high[3]; /* what the faces of each axis are */
  double lo[3], hi[3]; /* where they are [m] */
} Bounds;

/* Row n + k of x, y, h, ha, m and id is image k. */
typedef struct {
  uint32_t owner; /* row of the particle */
  uint32_t code;  /* through which faces: x + 3 y + 9 z of BOUNDS_SELF, LOW, HIGH */
} Image;

/* How far particles interact across faces: the largest support, and how far anything has left the
 * box. */
typedef struct {
  double h, out; /* m */
} BoundsReach;

/* bounds_reach: what particle i at x and (loop A) y with supports h and ha adds to it. */
HD void bounds_reach(const Bounds *b, const double x[3], const double y[3], double h, double ha,
                     BoundsReach *r)
{
  r->h = fmax(r->h, fmax(h, ha));
  for (int d = 0; d < 3; d++) {
    if (b->low[d]) r->out = fmax(r->out, b->lo[d] - fmin(x[d], y[d]));
    if (b->high[d]) r->out = fmax(r->out, fmax(x[d], y[d]) - b->hi[d]);
  }
}

/* bounds_fits: the axis along which the box is too narrow for one image a face, or -1. */
HD int bounds_fits(const Bounds *b, const BoundsReach *r)
{
  for (int d = 0; d < 3; d++)
    if (b->low[d] && b->high[d] && !(b->hi[d] - b->lo[d] > r->h + 2 * r->out)) return d;
  return -1;
}

/* bounds_faces: which faces a particle is seen through: for axis d bits 3 d + BOUNDS_SELF (always),
 * LOW and HIGH. */
HD int bounds_faces(const Bounds *b, const double x[3], const double y[3], const BoundsReach *r)
{
  const double far = r->h + r->out;
  int faces = 0;
  for (int d = 0; d < 3; d++) {
    const int low = b->low[d] && fmin(x[d], y[d]) - b->lo[d] < far;
    const int high = b->high[d] && b->hi[d] - fmax(x[d], y[d]) < far;
    faces |= (1 | low << BOUNDS_LOW | high << BOUNDS_HIGH) << 3 * d;
  }
  return faces;
}

/* bounds_seen: whether there is an image of this code, 1 .. BOUNDS_CODES - 1. */
HD int bounds_seen(int faces, int code)
{
  return (faces >> (code % 3)) & (faces >> (3 + code / 3 % 3)) & (faces >> (6 + code / 9)) & 1;
}

/* bounds_count: how many images there are. */
HD int bounds_count(int faces)
{
  int n = 1;
  for (int d = 0; d < 3; d++) n *= 1 + (faces >> (3 * d + 1) & 1) + (faces >> (3 * d + 2) & 1);
  return n - 1;
}

/* bounds_face: through which face of axis d an image of this code is seen. */
HD int bounds_face(uint32_t code, int d)
{
  return (int)(d == 0 ? code % 3 : d == 1 ? code / 3 % 3 : code / 9);
}

/* bounds_kind: what the face is through which an image of this code is seen along axis d. */
HD int bounds_kind(const Bounds *b, uint32_t code, int d)
{
  const int face = bounds_face(code, d);
  return face == BOUNDS_SELF ? BOUNDS_OPEN : face == BOUNDS_LOW ? b->low[d] : b->high[d];
}

/* bounds_turn: w times what a face across axis d does to vectors: a mirror turns the component
 * across it around, a no-slip face all of them, so that velocities go through zero there. */
HD void bounds_turn(int kind, int d, double w[3])
{
  for (int k = 0; k < 3; k++)
    if (kind == BOUNDS_NO_SLIP || (kind == BOUNDS_MIRROR && k == d)) w[k] = -w[k];
}

/* bounds_place: where the image is of what is at x. */
HD void bounds_place(const Bounds *b, uint32_t code, const double x[3], double out[3])
{
  for (int d = 0; d < 3; d++) {
    const int face = bounds_face(code, d);
    const double plane = face == BOUNDS_LOW ? b->lo[d] : b->hi[d], width = b->hi[d] - b->lo[d];
    if (face == BOUNDS_SELF)
      out[d] = x[d];
    else if (bounds_kind(b, code, d) != BOUNDS_PERIODIC)
      out[d] = plane - (x[d] - plane);
    else
      out[d] = face == BOUNDS_LOW ? x[d] + width : x[d] - width;
  }
}

/* bounds_wrap: coordinate x of axis d back into the box, where that is periodic. */
HD double bounds_wrap(const Bounds *b, int d, double x)
{
  const double width = b->hi[d] - b->lo[d], turns = floor((x - b->lo[d]) / width);
  if (b->low[d] != BOUNDS_PERIODIC || turns == 0) return x;
  x -= turns * width;
  return x < b->hi[d] ? x : b->lo[d];
}

/* bounds_beyond: the kind of the mirror or no-slip face that x lies behind, and where that is; or
 * 0. */
HD int bounds_beyond(const Bounds *b, int d, double x, double *plane)
{
  const int low = x < b->lo[d], kind = low ? b->low[d] : x > b->hi[d] ? b->high[d] : BOUNDS_OPEN;
  *plane = low ? b->lo[d] : b->hi[d];
  return kind == BOUNDS_PERIODIC ? BOUNDS_OPEN : kind;
}

#endif
