/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Point masses beside the particles: stars, planets, sinks. There are few of them; they live on the
 * host, take part in the passes that move particles, so in every integrator with its own weights,
 * and exchange pulls with the particles wherever gravity is evaluated. A particle's pull on a point
 * mass is minus that of the point mass on the particle, so momentum is kept to rounding. */
#ifndef POINTS_H
#define POINTS_H

#include "../lib/part.h"
#include "../physics/softening.h"
#include "param.h"
#include "passes.h"

typedef struct Sim Sim;
typedef struct Sums Sums;

enum { POINTS = PARAM_POINTS };

/* The masses as a backend sees them. */
typedef struct {
  double x[3], gm, h; /* m, m^3/s^2, m */
} PointSource;
typedef struct {
  int n;
  PointSource at[POINTS];
} PointField;

/* What one of them does to all particles: force [N] and potential energy [J]. */
typedef struct {
  double f[3], energy;
} PointReaction;

typedef struct {
  int n;
  PointMass p[POINTS];
  double acc[POINTS][3];                                       /* of this evaluation */
  double felt[POINTS][3], was_felt[STATE_SLOTS][POINTS][3];    /* what of it particles pull */
  double x[STATE_SLOTS][POINTS][3], v[STATE_SLOTS][POINTS][3]; /* as Saved */
  double energy; /* potential energy among them and with the particles [J] */
} PointMasses;

/* points_pull: adds the pull of all masses at a particle's place to acc. */
HD void points_pull(const PointField *f, const double x[3], double acc[3])
{
  for (int k = 0; k < f->n; k++) {
    const PointSource *p = &f->at[k];
    const double d[3] = {p->x[0] - x[0], p->x[1] - x[1], p->x[2] - x[2]};
    softening_pull(p->gm, p->h, d, acc);
  }
}

/* points_react: adds what p does to a particle of mass m at x. */
HD void points_react(PointReaction *o, const PointSource *p, double m, const double x[3])
{
  const double d[3] = {p->x[0] - x[0], p->x[1] - x[1], p->x[2] - x[2]};
  double a[3] = {0, 0, 0};
  o->energy += m * softening_pull(p->gm, p->h, d, a);
  for (int k = 0; k < 3; k++) o->f[k] += m * a[k];
}

/* points_merge: two partial sums. */
HD void points_merge(PointReaction *a, const PointReaction *b)
{
  a->energy += b->energy;
  for (int k = 0; k < 3; k++) a->f[k] += b->f[k];
}

/* points_sinks: whether any of them takes particles. */
int points_sinks(const Sim *sim);

/* points_field: the masses as a backend sees them. points_take: p becomes one with a particle of
 * mass m at x with velocity v: mass, momentum, centre of mass, angular momentum stay, the last as
 * spin; what is fixed stays where it is. */
void points_field(const Sim *sim, PointField *field);
void points_take(PointMass *p, double m, const double x[3], const double v[3]);

/* points_open: those of the file if it has any, else those of the settings; checks them.
 * points_store: into parts.
 */
int points_open(Sim *sim, const Parts *p, Err *err);
int points_store(const Sim *sim, Parts *p, Err *err);

/* points_pass: what a pass does to a particle's motion, done to the masses. Backends call it in
 * theirs. */
void points_pass(Sim *sim, int pass, const Step *k);

/* points_exchange: with all at their places: adds the masses' pull to the particles' acc and sets
 * their own. Backends call it when they evaluate gravity. */
int points_exchange(Sim *sim, Err *err);

/* points_orbit: after the passes of a step of length dt from saved[0] this takes the masses there
 * by the Runge-Kutta scheme of fourth order, in equal substeps of at most step.points times what
 * points_limit has. The particles' pull goes linearly from that of the evaluation saved as slot
 * `from` to that of slot `to`; its impulse is that of their mean, whatever the substeps. */
void points_orbit(Sim *sim, double dt, int from, int to);

/* points_error: for rk2-adaptive: the largest error of a step of length dt over what a tolerance of
 * 1 would allow: positions by the distance to the next mass, speeds by that of an orbit there. */
double points_error(const Sim *sim, double dt);

/* points_limit: step.points times the smallest sqrt(r^3/(G (m_1 + m_2))) of two masses [s];
 * infinite without two; that many times as long as the integrator lets them take substeps. */
double points_limit(const Sim *sim);

/* points_sums: adds the masses to the sums over the particles, spins and potential energies
 * included. */
void points_sums(const Sim *sim, Sums *s);

#endif
