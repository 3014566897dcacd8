/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is done to particles from outside at the edges of a target: bodies that are walls, held or
 * moved at a given velocity, and layers before a face that swallow waves. */
#ifndef HOLD_H
#define HOLD_H

#include "state.h"

enum { BODIES = 8 };

typedef struct {
  int on;                 /* any of these */
  unsigned walls;         /* bit b: body b is a wall */
  double wall[BODIES][3]; /* and moves so [m/s] */
  double low[3], high[3]; /* widths of the layers before each face; 0: none [m] */
  double strength;        /* of a layer: damping rate at the face times its width over c_l */
} Hold;

/* hold_wall: whether particle i is of a wall. */
HD int hold_wall(const State *s, const Hold *h, long i)
{
  const int b = s->body[i];
  return h->walls && b >= 0 && b < BODIES && h->walls >> b & 1;
}

/* hold_depth: how deep x is in a layer of that width, 0 .. 1, from its inner side to the face and
 * beyond. */
HD double hold_depth(double width, double to_face)
{
  const double depth = 1 - to_face / width;
  return width > 0 && depth > 0 ? (depth < 1 ? depth : 1) : 0;
}

/* hold_rate: the damping rate [1/s] at x, a sponge (Israeli & Orszag 1981, J. Comput. Phys. 41,
 * 115) that begins at 0 and grows with the depth to strength c_l/width at the face; the strongest
 * layer counts. At strength 7 less than 1 % of the energy of waves returns that are at most one and
 * a half times as long as it is wide (docs/theory.md 2.8). */
HD double hold_rate(const State *s, const Hold *h, long i)
{
  const Bounds *b = &s->bounds;
  double most = 0;
  for (int d = 0; d < 3; d++) {
    const double x = s->x[3 * i + d];
    const double low = hold_depth(h->low[d], x - b->lo[d]),
                 high = hold_depth(h->high[d], b->hi[d] - x);
    if (low > 0) most = fmax(most, low / h->low[d]);
    if (high > 0) most = fmax(most, high / h->high[d]);
  }
  return h->strength * s->cl[i] * most;
}

/* hold_particle: after all accelerations of an evaluation with velocities vp. */
HD void hold_particle(const State *s, const Hold *h, long i)
{
  const int wall = hold_wall(s, h, i);
  const double rate = wall ? 0 : hold_rate(s, h, i);
  for (int d = 0; d < 3; d++) {
    const long j = 3 * i + d;
    if (wall) {
      s->acc[j] = 0, s->v[j] = s->vp[j] = h->wall[s->body[i]][d];
      if (s->pull) s->pull[j] = 0;
    } else {
      s->acc[j] -= rate * s->vp[j];
    }
  }
}

#endif
