/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Soil as a viscous fluid that slides (Ulrich, Schraepler et al. 2013, as in miluphcuda): S = 2 eta
 * e, e the deviatoric strain rate, with
 *
 *   eta = min(viscosity, (c + p tan(phi))/rate),   rate = sqrt(2 e:e)
 *
 * so that sqrt(J2) <= c + p tan(phi); no elastic stress. No shear strength under tension. */
#ifndef YIELD_VISCOUS_REGOLITH_H
#define YIELD_VISCOUS_REGOLITH_H

/* clang-format off */
#define YIELD_VISCOUS_REGOLITH_ROWS(X) \
  X(cohesion,  "Pa",   NULL,  0, 1e300, "cohesion c") \
  X(friction,  "rad",  NULL,  0, 1.57,  "angle of internal friction phi") \
  X(viscosity, "Pa s", "2e3", 0, 1e300, "largest dynamic viscosity, where hardly anything slides")
/* clang-format on */

struct yield_viscous_regolith {
#define YIELD_ROW(MEMBER, ...) double MEMBER;
  YIELD_VISCOUS_REGOLITH_ROWS(YIELD_ROW)
#undef YIELD_ROW
};

/* yield_viscous_regolith_eta: the dynamic viscosity [Pa s] at p and rate [1/s]; left: of the
 * cohesion. */
HD double yield_viscous_regolith_eta(const struct yield_viscous_regolith *y, double p, double rate,
                                     double left)
{
  double limit = left * y->cohesion + p * tan(y->friction);
  if (limit <= 0) return 0;
  return limit < y->viscosity * rate ? limit / rate : y->viscosity;
}

/* The stress is made within its limit. */
HD double yield_viscous_regolith(const struct yield_viscous_regolith *y, const YieldPoint *at)
{
  (void)y, (void)at;
  return 1;
}

#endif
