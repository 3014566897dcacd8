/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pull of one mass on another, softened. SPLINE: Newton's beyond a distance h, within it as if
 * the mass had the profile of a Wendland C2 kernel W = 21/(2 pi h^3) (1-q)^4 (1+4q), q = r/h. With
 * the mass in q, M(q) = 14q^3 - 84q^5 + 140q^6 - 90q^7 + 21q^8:  a = -G m F r/h^3, F = M/q^3;
 * phi = -G m P/h, P = 1 + integral_q^1 M/q'^2 dq'. Both are 1 at q = 1.
 * PLUMMER: phi = -G m/D, a = -G m r/D^3, D^2 = r^2 + epsilon^2, Newton's only far away (Plummer
 * 1911, MNRAS 71, 460). A spline is as deep as it, G m/epsilon, with h = 3 epsilon. */
#ifndef SOFTENING_H
#define SOFTENING_H

#include "hd.h"

enum { SOFTENING_SPLINE, SOFTENING_PLUMMER };
enum { SOFTENING_SUPPORT = 3 }; /* h over epsilon */

/* F(q) and P(q), in whatever precision q has. */
#define SOFTENING_FORCE(q) (14 + (q) * (q) * (-84 + (q) * (140 + (q) * (-90 + (q)*21))))
#define SOFTENING_POTENTIAL(q)                                                                     \
  (3 + (q) * (q) * (-7 + (q) * (q) * (21 + (q) * (-28 + (q) * (15 - (q)*3)))))

HD double softening_force(double q) { return SOFTENING_FORCE(q); }
HD double softening_potential(double q) { return SOFTENING_POTENTIAL(q); }

/* softening_pull: adds to a the acceleration [m/s^2] towards a mass with G m = gm [m^3/s^2], d [m]
 * away (from the target to the mass), softened by a spline within h [m] >= 0; returns the
 * potential [J/kg]. What coincides with an unsoftened mass feels nothing. */
HD double softening_pull(double gm, double h, const double d[3], double a[3])
{
  const double r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  double c, phi;
  if (r2 < h * h) {
    const double q = sqrt(r2) / h;
    c = gm * softening_force(q) / (h * h * h), phi = -gm * softening_potential(q) / h;
  } else if (r2 > 0) {
    const double r = sqrt(r2);
    c = gm / (r2 * r), phi = -gm / r;
  } else {
    return 0;
  }
  for (int k = 0; k < 3; k++) a[k] += c * d[k];
  return phi;
}

#endif
