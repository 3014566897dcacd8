/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Roots are bracketed in steps, then halved. */
#include <math.h>
#include "../../lib/thermal.h"
#include "curve.h"

double curve_energy(const Material *m, CurveKind kind, double value, double rho)
{
  double rho0 = eos_rho0(&m->eos);
  if (kind == CURVE_ENERGY) return value;
  if (kind == CURVE_TEMPERATURE) return thermal_energy(m, rho, value);
  if (m->eos.form == EOS_TABLE) return eos_table_state(&m->eos.table, rho, EOS_TABLE_S, value).u;
  return thermal_isentrope(&m->eos, rho0, thermal_at_entropy(m, value), rho);
}

double curve_density(const Material *m, CurveKind kind, double value, double p)
{
  double rho0 = eos_rho0(&m->eos), high = rho0 > 0 ? rho0 : 1, low;
  const double least = 1e-12 * high, most = 1e9 * high;
#define PRESSURE(RHO) eos_eval(&m->eos, RHO, curve_energy(m, kind, value, RHO), 0).p
  while (high < most && PRESSURE(high) <= p) high *= 1.5;
  if (!(PRESSURE(high) > p)) return NAN;
  for (low = high; low > least && PRESSURE(low) > p;) high = low, low *= 0.98;
  if (!(PRESSURE(low) <= p)) return NAN;
  for (int k = 0; k < 100; k++) {
    double middle = 0.5 * (low + high);
    if (PRESSURE(middle) > p)
      high = middle;
    else
      low = middle;
  }
#undef PRESSURE
  return high;
}

int curve_shock(const Material *m, double rho1, double u1, double up, double *us, double *rho,
                double *u)
{
  EosPoint rest = eos_eval(&m->eos, rho1, u1, 0);
  double low = up * (1 + 1e-6), high = 2 * (up + rest.cs), excess;
  for (int k = 0; k < 200; k++) {
    *us = k < 100 ? high : 0.5 * (low + high);
    *rho = rho1 * *us / (*us - up);
    *u = u1 + 0.5 * up * up + rest.p * up / (rho1 * *us);
    excess = eos_eval(&m->eos, *rho, *u, 0).p - rest.p - rho1 * *us * up;
    if (k < 100 && excess > 0)
      low = high, high *= 2;
    else if (k < 100)
      k = 99;
    else if (excess > 0)
      low = *us;
    else
      high = *us;
  }
  return fabs(excess) <= 1e-6 * (fabs(rest.p) + rho1 * *us * up) ? 0 : -1;
}
