/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What has left the box, at the end of a step. */
#ifndef FOLD_H
#define FOLD_H

#include "state.h"

/* fold_tensor: six numbers of a tensor, seen in a mirror across axis d. */
HD void fold_tensor(double *t, int d)
{
  if (d != 2) t[1] = -t[1];
  if (d != 1) t[2] = -t[2];
  if (d != 0) t[4] = -t[4];
}

/* fold_mirror: what particle i carries into the next step, behind a mirror across axis d. */
HD void fold_mirror(const State *s, long i, int d)
{
  const long j = 3 * i + d;
  s->v[j] = -s->v[j], s->vp[j] = -s->vp[j], s->a[j] = -s->a[j];
  if (s->pull) s->pull[j] = -s->pull[j];
  if (s->wander) s->wander[j] = -s->wander[j];
  if (s->s) fold_tensor(&s->s[6 * i], d);
  if (s->old_x) s->old_x[j] = -s->old_x[j], s->old_v[j] = -s->old_v[j];
  if (s->old_s) fold_tensor(&s->old_s[6 * i], d);
}

/* fold_particle: through a periodic face it comes back at the other one; where it has passed a
 * mirror it changes places with its image. */
HD void fold_particle(const State *s, long i)
{
  for (int d = 0; d < s->dimension; d++) {
    double *x = &s->x[3 * i + d], plane;
    *x = bounds_wrap(&s->bounds, d, *x);
    if (!bounds_beyond(&s->bounds, d, *x, &plane)) continue;
    *x = plane - (*x - plane);
    fold_mirror(s, i, d);
  }
}

#endif
