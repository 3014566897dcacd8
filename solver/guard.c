/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Drifts since the start, against the bounds of guard.*. */
#include <math.h>
#include <stdio.h>
#include "guard.h"

static const char *const names[] = {
    "StartEnergy",           "StartMomentumX",        "StartMomentumY",       "StartMomentumZ",
    "StartAngularMomentumX", "StartAngularMomentumY", "StartAngularMomentumZ"};
enum { NUMBERS = sizeof names / sizeof *names };

static double *number(Guard *g, int k)
{
  return k == 0 ? &g->energy : k < 4 ? &g->momentum[k - 1] : &g->angular[k - 4];
}

static double energy_of(const Sums *s)
{
  return s->kinetic + s->internal + s->potential - s->lifted;
}

int guard_start(Guard *g, const Sums *s, Parts *p, Err *err)
{
  g->energy = energy_of(s);
  for (int d = 0; d < 3; d++) g->momentum[d] = s->momentum[d], g->angular[d] = s->angular[d];
  for (int k = 0; k < NUMBERS; k++)
    if (part_set_number(p, "run", names[k], *number(g, k), err)) return -1;
  return 0;
}

int guard_resume(Guard *g, const Parts *p, Err *err)
{
  for (int k = 0; k < NUMBERS; k++) {
    *number(g, k) = part_number(p, "run", names[k]);
    if (!isfinite(*number(g, k)))
      return err_set(err, "the checkpoint lacks the attribute '%s' of /Run", names[k]);
  }
  return 0;
}

static int exceeds(const char *what, const char *key, double drift, double scale, double bound,
                   const Sim *sim, Err *err)
{
  if (!(bound > 0) || drift <= bound * scale) return 0;
  return err_set(err,
                 "%s has drifted by %.3g of its scale since the start, more than guard.%s = %g, at "
                 "step %ld, t = %.9g s",
                 what, drift / scale, key, bound, sim->step, sim->time);
}

static double distance(const double a[3], const double b[3])
{
  return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
              (a[2] - b[2]) * (a[2] - b[2]));
}

int guard_check(const Guard *g, const Sums *s, const Sim *sim, Err *err)
{
  const Param *par = &sim->par;
  const Gone *gone = &sim->gone;
  const double scale = s->kinetic + fabs(s->internal) + fabs(s->potential),
               energy = energy_of(s) + gone->energy - g->energy;
  double p[3], l[3];
  for (int d = 0; d < 3; d++)
    p[d] = s->momentum[d] + gone->momentum[d], l[d] = s->angular[d] + gone->angular[d];
  return exceeds("energy", "energy", fabs(energy), scale, par->guard_energy, sim, err) ||
                 exceeds("angular momentum", "angular_momentum", distance(l, g->angular),
                         s->scale_angular, par->guard_angular, sim, err) ||
                 exceeds("momentum", "momentum", distance(p, g->momentum), s->scale_momentum,
                         par->guard_momentum, sim, err)
             ? -1
             : 0;
}
