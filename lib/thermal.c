/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The isentrope is integrated over ln rho, where du = p/rho dln(rho). */
#include <math.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include "thermal.h"

static const double EXACT = 1e-12; /* entropy is counted from 1 K */

static int slope(double log_rho, const double u[], double du[], void *eos)
{
  double rho = exp(log_rho);
  du[0] = eos_eval(eos, rho, u[0], 0).p / rho;
  return isfinite(du[0]) ? GSL_SUCCESS : GSL_EBADFUNC;
}

double thermal_isentrope(const Eos *eos, double rho1, double u1, double rho)
{
  double x = log(rho1), end = log(rho), c = eos_eval(eos, rho, u1, 0).cs;
  gsl_odeiv2_system system = {slope, NULL, 1, (void *)eos};
  gsl_odeiv2_driver *driver;
  int status;
  if (rho == rho1) return u1;
  if (!(rho > 0 && rho1 > 0 && isfinite(u1) && isfinite(c))) return NAN;
  gsl_set_error_handler_off(); /* statuses are looked at */
  driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, (end - x) / 4,
                                         EXACT * (c * c + fabs(u1)), EXACT);
  if (!driver) return NAN;
  status = gsl_odeiv2_driver_apply(driver, &x, end, &u1);
  gsl_odeiv2_driver_free(driver);
  return status == GSL_SUCCESS ? u1 : NAN;
}

double thermal_cold(const Eos *eos, double rho)
{
  double rho0 = eos_rho0(eos);
  return rho0 > 0 ? thermal_isentrope(eos, rho0, 0, rho) : 0;
}

/* What a table says. */
static EosTableState look(const Material *m, double rho, int part, double value)
{
  return eos_table_state(&m->eos.table, rho, part, value);
}

double thermal_temperature(const Material *m, double rho, double u)
{
  if (m->eos.form == EOS_TABLE) return look(m, rho, EOS_TABLE_U, u).T;
  return m->heat > 0 ? (u - thermal_cold(&m->eos, rho)) / m->heat : NAN;
}

double thermal_energy(const Material *m, double rho, double t)
{
  if (m->eos.form == EOS_TABLE) return look(m, rho, EOS_TABLE_T, t).u;
  return m->heat > 0 ? thermal_cold(&m->eos, rho) + m->heat * t : NAN;
}

/* u = u_cold + C_V T, so that u_cold need not be known. */
double thermal_slope(const Material *m, double rho, double u, double t, double a)
{
  double cold;
  if (m->eos.form == EOS_TABLE) {
    EosTableState at = look(m, rho, EOS_TABLE_T, t);
    return at.u_rho + at.u_T * t * a / rho;
  }
  cold = eos_rho0(&m->eos) > 0 ? eos_eval(&m->eos, rho, u - m->heat * t, 0).p : 0;
  return m->heat > 0 ? cold / (rho * rho) + m->heat * t * a / rho : NAN;
}

double thermal_entropy(const Material *m, double rho, double u)
{
  double rho0 = eos_rho0(&m->eos);
  if (m->eos.form == EOS_TABLE) return look(m, rho, EOS_TABLE_U, u).s;
  if (!(m->heat > 0 && rho0 > 0)) return NAN;
  u = thermal_isentrope(&m->eos, rho, u, rho0);
  return m->heat * log(fmax(u, 0) / m->heat);
}

double thermal_at_entropy(const Material *m, double s)
{
  if (m->eos.form == EOS_TABLE) return look(m, eos_rho0(&m->eos), EOS_TABLE_S, s).u;
  return m->heat > 0 && eos_rho0(&m->eos) > 0 ? m->heat * exp(s / m->heat) : NAN;
}
