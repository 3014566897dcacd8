/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the errors of a gravity tree leave over. An isolated system neither pulls nor turns itself;
 * the accelerations of a tree do a little, and bodies far apart then trade momentum over the
 * distance between them. Taken off is the smallest change (least squares of its size over w, by
 * mass) after which force and torque of all vanish: w times a mean and a rotation, w = |a|, so that
 * debris far away, where the pull is weak, is changed no more than it was wrong before. Backends
 * sum in two rounds, always in the same order: first RecoilForce over all particles, then with its
 * centre and mean RecoilTorque. */
#ifndef RECOIL_H
#define RECOIL_H

#include "../physics/tensor.h"

typedef struct {
  double w, x[3], a[3]; /* sums of m w, m w x, m a */
} RecoilForce;

typedef struct {
  double t[3]; /* sum of m r x a about the centre */
  Sym inertia; /* of m w */
} RecoilTorque;

/* What is to be taken off: w (mean + turn x (x - centre)) [m/s^2]; turn in 1/m. */
typedef struct {
  double centre[3], mean[3], turn[3];
} Recoil;

HD double recoil_weight(const double a[3]) { return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

HD void recoil_add_force(RecoilForce *o, double m, const double x[3], const double a[3])
{
  double w = m * recoil_weight(a);
  o->w += w;
  for (int d = 0; d < 3; d++) o->x[d] += w * x[d], o->a[d] += m * a[d];
}

HD void recoil_merge_force(RecoilForce *a, const RecoilForce *b)
{
  a->w += b->w;
  for (int d = 0; d < 3; d++) a->x[d] += b->x[d], a->a[d] += b->a[d];
}

/* recoil_mean: centre and mean; without pull there is nothing to take off. */
HD Recoil recoil_mean(const RecoilForce *f)
{
  Recoil o;
  for (int d = 0; d < 3; d++) {
    o.centre[d] = f->w > 0 ? f->x[d] / f->w : 0;
    o.mean[d] = f->w > 0 ? f->a[d] / f->w : 0;
    o.turn[d] = 0;
  }
  return o;
}

HD void recoil_add_torque(RecoilTorque *o, const Recoil *k, double m, const double x[3],
                          const double a[3])
{
  double r[3], r2 = 0;
  for (int d = 0; d < 3; d++) r[d] = x[d] - k->centre[d], r2 += r[d] * r[d];
  Sym part = {r2 - r[0] * r[0], -r[0] * r[1], -r[0] * r[2],
              r2 - r[1] * r[1], -r[1] * r[2], r2 - r[2] * r[2]};
  o->t[0] += m * (r[1] * a[2] - r[2] * a[1]);
  o->t[1] += m * (r[2] * a[0] - r[0] * a[2]);
  o->t[2] += m * (r[0] * a[1] - r[1] * a[0]);
  o->inertia = tensor_axpy(o->inertia, m * recoil_weight(a), part);
}

HD void recoil_merge_torque(RecoilTorque *a, const RecoilTorque *b)
{
  for (int d = 0; d < 3; d++) a->t[d] += b->t[d];
  a->inertia = tensor_axpy(a->inertia, 1, b->inertia);
}

/* recoil_turn: the rotation; none for particles on a line. */
HD void recoil_turn(Recoil *o, const RecoilTorque *k) { tensor_solve(k->inertia, k->t, o->turn); }

/* recoil_take: off the acceleration of a particle at x. */
HD void recoil_take(const Recoil *k, const double x[3], double a[3])
{
  const double r[3] = {x[0] - k->centre[0], x[1] - k->centre[1], x[2] - k->centre[2]};
  const double w = recoil_weight(a), *t = k->turn;
  a[0] -= w * (k->mean[0] + t[1] * r[2] - t[2] * r[1]);
  a[1] -= w * (k->mean[1] + t[2] * r[0] - t[0] * r[2]);
  a[2] -= w * (k->mean[2] + t[0] * r[1] - t[1] * r[0]);
}

#endif
