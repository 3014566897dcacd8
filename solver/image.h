/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a backend needs to make images (bounds.h) of the particles of a State. */
#ifndef IMAGE_H
#define IMAGE_H

#include "../lib/err.h"
#include "state.h"

/* image_owner: the particle that row i is, or is an image of. */
HD long image_owner(const State *s, long i)
{
  return i < s->n ? i : (long)s->image[i - s->n].owner;
}

/* image_signs: what the components of a vector of the owner are to be multiplied by at row i. */
HD void image_signs(const State *s, long i, double sign[3])
{
  for (int d = 0; d < 3; d++) sign[d] = 1;
  for (int d = 0; d < 3 && i >= s->n; d++)
    bounds_turn(bounds_kind(&s->bounds, s->image[i - s->n].code, d), d, sign);
}

/* image_fill: row i >= n from its owner. */
HD void image_fill(const State *s, long i)
{
  const Image *m = &s->image[i - s->n];
  const long o = (long)m->owner;
  bounds_place(&s->bounds, m->code, &s->x[3 * o], &s->x[3 * i]);
  bounds_place(&s->bounds, m->code, &s->y[3 * o], &s->y[3 * i]);
  s->h[i] = s->h[o], s->ha[i] = s->ha[o], s->m[i] = s->m[o], s->id[i] = s->id[o];
}

/* image_reach: what particle i adds to the reach of all. */
HD void image_reach(const State *s, long i, BoundsReach *r)
{
  const double wide = 1 + s->margin;
  bounds_reach(&s->bounds, &s->x[3 * i], &s->y[3 * i], wide * s->h[i], wide * s->ha[i], r);
}

/* image_check: -1 when the box is too narrow for that reach. */
static inline int image_check(const State *s, const BoundsReach *r, Err *err)
{
  const int d = bounds_fits(&s->bounds, r);
  if (d < 0) return 0;
  return err_set(err,
                 "the box is %g m wide in %c, but particles interact over %g m across its faces",
                 s->bounds.hi[d] - s->bounds.lo[d], "xyz"[d], r -> h + 2 * r -> out);
}

/* image_faces: the faces that particle i is seen through. */
HD int image_faces(const State *s, long i, const BoundsReach *r)
{
  return bounds_faces(&s->bounds, &s->x[3 * i], &s->y[3 * i], r);
}

#endif
