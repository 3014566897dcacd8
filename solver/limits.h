/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The limits of the time step, what each allows to particle i. Rates are those of the last
 * evaluation. The first three are always looked at (001 eq. 54 to 56 with the errata; 004 eq.
 * 2.45); the others, the step over which a quantity may change by a part of itself or by so much
 * (001 eq. 57; 004 eq. 2.46, corrected; miluphcuda), only where run.cfg asks for them. */
#ifndef LIMITS_H
#define LIMITS_H

#include "passes.h"

/* limits_ratio: the step in which something of size `is` changes by the part `of` of it. */
HD double limits_ratio(double of, double is, double rate)
{
  return of > 0 && rate != 0 ? of * is / fabs(rate) : INFINITY;
}

/* limits_stress: of (|S| + stress_least)/|dS/dt|, |S| = sqrt(S:S). */
HD_CALL double limits_stress(const State *s, const Step *k, long i)
{
  const Material *m = &s->material[s->mat[i]];
  if (!(k->limit[LIMIT_STRESS] > 0) || !k->strength || m->mu <= 0) return INFINITY;
  const Sym now = passes_stress(&s->s[6 * i]),
            rate = passes_jaumann(now, &s->g[9 * i], matter_shear(s, i));
  return limits_ratio(k->limit[LIMIT_STRESS], sqrt(tensor_dot(now, now)) + k->stress_least,
                      sqrt(tensor_dot(rate, rate)));
}

/* limits_pores: so that alpha changes by limit[LIMIT_DISTENTION], and p by limit[LIMIT_PRESSURE] of
 * the pressure at which pores begin to crush. */
HD_CALL void limits_pores(const State *s, const Step *k, long i, double *dt)
{
  const Material *m = &s->material[s->mat[i]];
  const double c = s->cs[i], start = m->porosity.start;
  if (!matter_porous(s, m)) return;
  dt[LIMIT_DISTENTION] = limits_ratio(k->limit[LIMIT_DISTENTION], 1, s->dalpha[i]);
  if (start > 0)
    dt[LIMIT_PRESSURE] =
        limits_ratio(k->limit[LIMIT_PRESSURE], start, s->rho[i] * c * c * s->divv[i]);
}

/* limits_asked: those that are off unless asked for. Energy counts only where it falls, as in 004:
 * what is heated by a shock is limited by its signal speed. */
HD_CALL void limits_asked(const State *s, const Step *k, long i, double *dt)
{
  const double *of = k->limit;
  if (s->dudt[i] < 0)
    dt[LIMIT_ENERGY] = limits_ratio(of[LIMIT_ENERGY], fabs(s->u[i]) + k->energy_least, s->dudt[i]);
  dt[LIMIT_SMOOTHING] = limits_ratio(of[LIMIT_SMOOTHING], 1, passes_swell(s, k, i));
  dt[LIMIT_STRESS] = limits_stress(s, k, i);
  if (k->damage && of[LIMIT_DAMAGE] > 0) {
    const double root = cbrt(s->damage[i]);
    dt[LIMIT_DAMAGE] =
        limits_ratio(of[LIMIT_DAMAGE], root + k->damage_least, passes_crack_rate(s, i, root));
  }
  if (s->rare && s->alpha) limits_pores(s, k, i, dt);
}

/* limits_of: the step [s] that each criterion allows to particle i, dt[LIMITS]; asked: also those
 * that may be off. */
HD void limits_of(const State *s, const Step *k, long i, int asked, double *dt)
{
  const double *a = &s->a[3 * i];
  double pull = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  for (int c = 0; c < LIMITS; c++) dt[c] = INFINITY;
  dt[LIMIT_CFL] = k->cfl * s->h[i] / s->signal[i];
  if (pull > 0) dt[LIMIT_ACCELERATION] = k->acceleration * sqrt(s->h[i] / pull);
  if (s->divv[i] != 0) dt[LIMIT_DENSITY] = k->step_density / fabs(s->divv[i]);
  if (asked) limits_asked(s, k, i, dt);
}

#endif
