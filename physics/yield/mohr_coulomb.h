/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mohr-Coulomb: no plane bears more shear than c + sigma_n tan(phi), that is, for the largest and
 * the smallest principal stress (tension positive), (s1 - s3)/2 + (s1 + s3)/2 sin(phi) <= c
 * cos(phi). Scaling S keeps the Lode angle, so the return is exact. Jaeger, Cook & Zimmerman
 * (2007), Fundamentals of Rock Mechanics, 4.5. No tension beyond the apex, p = -c/tan(phi). What
 * miluphcuda calls Mohr-Coulomb, sqrt(J2) <= c + p tan(phi), is lundborg.h without a limit. */
#ifndef YIELD_MOHR_COULOMB_H
#define YIELD_MOHR_COULOMB_H

/* clang-format off */
#define YIELD_MOHR_COULOMB_ROWS(X) \
  X(cohesion, "Pa",  NULL,    0, 1e300, "cohesion c") \
  X(friction, "rad", NULL,    0, 1.57,  "angle of internal friction phi") \
  X(limit,    "Pa",  "1e300", 0, 1e300, "largest sqrt(J2), whatever the pressure")
/* clang-format on */

struct yield_mohr_coulomb {
#define YIELD_ROW(MEMBER, ...) double MEMBER;
  YIELD_MOHR_COULOMB_ROWS(YIELD_ROW)
#undef YIELD_ROW
};

HD double yield_mohr_coulomb_apex(const struct yield_mohr_coulomb *y, double weak)
{
  return y->friction > 0 ? weak * y->cohesion / tan(y->friction) : INFINITY;
}

/* Principal values of S: 2 sqrt(J2/3) (cos t, cos(t - 2 pi/3), cos(t + 2 pi/3)), t the Lode angle
 * from triaxial extension (0) to compression (pi/3). */
HD double yield_mohr_coulomb(const struct yield_mohr_coulomb *y, const YieldPoint *at)
{
  const double third = 2.0943951023931953; /* 2 pi/3 */
  double s = sin(y->friction), c = cos(y->friction), root = sqrt(at->j2 / 3), angle, high, low;
  double limit = 1.7320508075688773 * (at->weak * y->cohesion * c + at->p * s);
  if (root <= 0) return 1;
  angle = tensor_det(at->s) / (2 * root * root * root);
  angle = acos(angle < -1 ? -1 : angle > 1 ? 1 : angle) / 3;
  high = cos(angle), low = cos(angle + third);
  limit /= high - low + (high + low) * s;
  return yield_return(sqrt(at->j2), at->soft * (limit < y->limit ? limit : y->limit));
}

#endif
