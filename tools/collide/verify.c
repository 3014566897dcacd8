/* SPDX-License-Identifier: GPL-3.0-or-later */
/* In units of r_c and v_c. */
#include <math.h>
#include <stdio.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include "verify.h"

static const double TOLERANCE = 1e-9;

static int newton(double t, const double y[], double f[], void *mu)
{
  double r2 = y[0] * y[0] + y[1] * y[1] + y[2] * y[2], k = -*(double *)mu / (r2 * sqrt(r2));
  (void)t;
  for (int a = 0; a < 3; a++) f[a] = y[a + 3], f[a + 3] = k * y[a];
  return GSL_SUCCESS;
}

static int integrate(double mu, double t, double y[6], Err *err)
{
  gsl_odeiv2_system system = {newton, NULL, 6, &mu};
  gsl_odeiv2_driver *driver;
  int failed;
  if (!(t < 0)) return 0;
  driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, -t / 1e3, 1e-14, 1e-14);
  if (!driver) return err_set(err, "out of memory");
  failed = gsl_odeiv2_driver_apply(driver, &t, 0, y);
  gsl_odeiv2_driver_free(driver);
  return failed ? err_set(err, "the two-body problem could not be integrated: %s",
                          gsl_strerror(failed))
                : 0;
}

/* Centre and velocity of the particles as they are now. */
static void centre(const Parts *p, double x[3], double v[3])
{
  double mass = 0;
  for (int k = 0; k < 3; k++) x[k] = v[k] = 0;
  for (long i = 0; i < p->n; i++) {
    for (int k = 0; k < 3; k++)
      x[k] += p->m[i] * p->x[3 * i + k], v[k] += p->m[i] * p->v[3 * i + k];
    mass += p->m[i];
  }
  for (int k = 0; k < 3; k++) x[k] /= mass, v[k] /= mass;
}

int verify_contact(const Geometry *g, const Body b[2], Report *report, Err *err)
{
  const OrbitApproach *a = &g->a;
  double x[2][3], u[2][3], y[6], r2 = 0, rv = 0, v2 = 0, h2 = 0, aside = 0, r, off[5], worst = 0;
  for (int k = 0; k < 2; k++) centre(b[k].p, x[k], u[k]);
  for (int k = 0; k < 3; k++)
    y[k] = (x[1][k] - x[0][k]) / a->rc, y[k + 3] = (u[1][k] - u[0][k]) / a->vc;
  if (integrate(a->orbit.mu / (a->rc * a->vc * a->vc), a->t0 * a->vc / a->rc, y, err)) return -1;
  for (int k = 0; k < 3; k++) {
    int i = (k + 1) % 3, j = (k + 2) % 3;
    r2 += y[k] * y[k], rv += y[k] * y[k + 3], v2 += y[k + 3] * y[k + 3];
    h2 += pow(y[i] * y[j + 3] - y[j] * y[i + 3], 2);
  }
  r = sqrt(r2);
  for (int k = 0; k < 3; k++) aside += pow(y[k] / r - g->e[1][k], 2);
  off[0] = (r - 1) / fmax(-rv / r, 1e-3); /* grazing: 1e-3 is 89.94 deg */
  off[1] = r - 1, off[2] = sqrt(v2) - 1;
  off[3] = atan2(sqrt(h2), -rv) - a->angle, off[4] = sqrt(aside);
  report_add(report, "VerifiedTime", "s", "contact, integrated", off[0] * a->rc / a->vc);
  report_add(report, "VerifiedDistance", "m", "integrated, at t = 0", r * a->rc);
  report_add(report, "VerifiedSpeed", "m/s", "integrated, at t = 0", sqrt(v2) * a->vc);
  report_add(report, "VerifiedAngle", "rad", "integrated, at t = 0", off[3] + a->angle);
  report_add(report, "VerifiedDirection", "rad", "from that of contact", off[4]);
  fprintf(stderr,
          "collide: integrated to contact: time off by %.1e (r1 + r2)/v_c, distance by %.1e, speed "
          "by %.1e, angle by %.1e rad, direction by %.1e rad\n",
          off[0], off[1], off[2], off[3], off[4]);
  for (int k = 0; k < 5; k++) worst = fmax(worst, fabs(off[k]));
  return worst < TOLERANCE ? 0
                           : err_set(err, "the integrated orbit misses the contact by %.1e", worst);
}
