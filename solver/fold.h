/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What has left the box, at the end of a step. */
#ifndef FOLD_H
#define FOLD_H

#include "state.h"

/* fold_vector: three components, times w. */
HD void fold_vector(double *v, const double w[3])
{
  for (int d = 0; d < 3; d++) v[d] *= w[d];
}

/* fold_tensor: six numbers of a tensor, times w w. */
HD void fold_tensor(double *t, const double w[3])
{
  t[1] *= w[0] * w[1], t[2] *= w[0] * w[2], t[4] *= w[1] * w[2];
}

/* fold_turn: what particle i carries into the next step, behind a face that does w to vectors. */
HD void fold_turn(const State *s, long i, const double w[3])
{
  const long j = 3 * i;
  fold_vector(&s->v[j], w), fold_vector(&s->vp[j], w), fold_vector(&s->a[j], w);
  if (s->pull) fold_vector(&s->pull[j], w);
  if (s->wander) fold_vector(&s->wander[j], w);
  if (s->s) fold_tensor(&s->s[6 * i], w);
  if (s->old_x) fold_vector(&s->old_x[j], w), fold_vector(&s->old_v[j], w);
  if (s->old_s) fold_tensor(&s->old_s[6 * i], w);
}

/* fold_particle: through a periodic face it comes back at the other one; where it has passed a
 * mirror or a no-slip face it changes places with its image. */
HD void fold_particle(const State *s, long i)
{
  for (int d = 0; d < s->dimension; d++) {
    double *x = &s->x[3 * i + d], plane, w[3] = {1, 1, 1};
    *x = bounds_wrap(&s->bounds, d, *x);
    const int kind = bounds_beyond(&s->bounds, d, *x, &plane);
    if (!kind) continue;
    *x = plane - (*x - plane);
    bounds_turn(kind, d, w);
    fold_turn(s, i, w);
  }
}

#endif
