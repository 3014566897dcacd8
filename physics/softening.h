/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pull of one mass on another: Newton's, softened within a distance h as if the mass had the
 * profile of a Wendland C2 kernel W = 21/(2 pi h^3) (1-q)^4 (1+4q), q = r/h. With the mass in q,
 * M(q) = 14q^3 - 84q^5 + 140q^6 - 90q^7 + 21q^8:  a = -G m F r/h^3, F = M/q^3;  phi = -G m P/h,
 * P = 1 + integral_q^1 M/q'^2 dq'. Both are 1 at q = 1. */
#ifndef SOFTENING_H
#define SOFTENING_H

#include "hd.h"

/* F(q) and P(q), in whatever precision q has. */
#define SOFTENING_FORCE(q) (14 + (q) * (q) * (-84 + (q) * (140 + (q) * (-90 + (q)*21))))
#define SOFTENING_POTENTIAL(q)                                                                     \
  (3 + (q) * (q) * (-7 + (q) * (q) * (21 + (q) * (-28 + (q) * (15 - (q)*3)))))

/* softening_pull: adds to a the acceleration [m/s^2] towards a mass with G m = gm [m^3/s^2], d [m]
 * away (from the target to the mass), softened within h [m] >= 0; returns the potential [J/kg].
 * What
 * coincides with an unsoftened mass feels nothing. */
HD double softening_pull(double gm, double h, const double d[3], double a[3])
{
  const double r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  double c, phi;
  if (r2 < h * h) {
    const double q = sqrt(r2) / h;
    c = gm * SOFTENING_FORCE(q) / (h * h * h), phi = -gm * SOFTENING_POTENTIAL(q) / h;
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
