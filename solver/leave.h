/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles that leave a run: what comes close to a sink becomes part of it, what is far away and
 * goes on is put into a file of its own. Looked for between steps, by a test that runs where the
 * particles are; when there is something, the rest closes ranks in the same order and is evaluated
 * anew, so that the next step starts from what is there. What left is booked (Gone), so that mass,
 * momentum, angular momentum and energy stay closed. */
#ifndef LEAVE_H
#define LEAVE_H

#include "points.h"

enum { LEAVE_STAYS = -1, LEAVE_ESCAPES = POINTS }; /* between them: the number of its sink */

/* What has left, as numbers that all are in /Run of a checkpoint. Escaped: number, mass, momentum,
 * angular momentum, and what fixed sinks took of the latter two; accreted: number. Energy: what the
 * particles had less after all of these. */
typedef struct {
  double escaped, accreted, mass, energy, momentum[3], angular[3];
} Gone;
enum { LEAVE_GONE = sizeof(Gone) / sizeof(double) };

/* The test of a look. */
typedef struct {
  PointField field;                /* all point masses */
  double v[POINTS][3], r2[POINTS]; /* of the sinks; r2 0: it takes nothing */
  int bound;                       /* sinks take only what is bound and slow enough */
  double far2;                     /* squared distance beyond which particles escape; 0: none do */
  int unbound;                     /* only those that are not bound */
  double centre[3], velocity[3];   /* of what they leave */
} Leave;

/* leave_sink: whether sink k takes what is at x with velocity v: within its radius and, if asked
 * for, bound to it, with less angular momentum than a circular orbit there (Bate, Bonnell &
 * Price 1995, MNRAS 277, 362). *r2: the distance squared. */
HD int leave_sink(const Leave *l, int k, const double *x, const double *v, double *r2)
{
  const PointSource *p = &l->field.at[k];
  double d[3], w[3], a[3] = {0, 0, 0}, w2 = 0, dw = 0;
  *r2 = 0;
  for (int c = 0; c < 3; c++) {
    d[c] = x[c] - p->x[c], w[c] = v[c] - l->v[k][c];
    *r2 += d[c] * d[c], w2 += w[c] * w[c], dw += d[c] * w[c];
  }
  if (!(*r2 < l->r2[k])) return 0;
  if (!l->bound) return 1;
  return 0.5 * w2 + softening_pull(p->gm, p->h, d, a) < 0 &&
         *r2 * w2 - dw * dw < p->gm * sqrt(l->r2[k]);
}

/* leave_escapes: whether particle i is far away and, if asked for, not bound. */
HD int leave_escapes(const Leave *l, const State *s, long i)
{
  const double *x = &s->x[3 * i], *v = &s->v[3 * i];
  double r2 = 0, energy = s->phi ? s->phi[i] : 0, a[3] = {0, 0, 0};
  for (int c = 0; c < 3; c++) {
    const double d = x[c] - l->centre[c], w = v[c] - l->velocity[c];
    r2 += d * d, energy += 0.5 * w * w;
  }
  if (!(l->far2 > 0 && r2 > l->far2)) return 0;
  for (int k = 0; k < l->field.n && l->unbound; k++) {
    const PointSource *p = &l->field.at[k];
    const double d[3] = {p->x[0] - x[0], p->x[1] - x[1], p->x[2] - x[2]};
    energy += softening_pull(p->gm, p->h, d, a);
  }
  return !l->unbound || energy > 0;
}

/* leave_where: where particle i goes: the nearest sink that takes it, LEAVE_ESCAPES or LEAVE_STAYS.
 */
HD int leave_where(const Leave *l, const State *s, long i)
{
  double least = INFINITY, r2;
  int where = leave_escapes(l, s, i) ? LEAVE_ESCAPES : LEAVE_STAYS;
  for (int k = 0; k < l->field.n; k++)
    if (leave_sink(l, k, &s->x[3 * i], &s->v[3 * i], &r2) && r2 < least) least = r2, where = k;
  return where;
}

/* What a look has found. */
typedef struct {
  signed char *where; /* [n] as the state has them; NULL: nothing leaves */
  long leaving;
  double energy; /* of all before [J] */
} LeaveFound;

/* leave_find: a look, when one is due after this step. leave_take: what it has found leaves: the
 * state and parts close ranks; *escaped and *accreted are the particles as they were (NULL: none),
 * with the fields RemovalTime, RemovalStep, SinkNumber; to be freed. leave_possible: whether
 * there is anything to look for. */
int leave_possible(const Sim *sim);
int leave_find(Sim *sim, LeaveFound *found, Err *err);
int leave_take(Sim *sim, LeaveFound *found, Parts *parts, Parts **escaped, Parts **accreted,
               Err *err);

/* leave_store, leave_load: Gone into /Run and back. */
int leave_store(const Sim *sim, Parts *p, Err *err);
int leave_load(Sim *sim, const Parts *p, Err *err);

#endif
