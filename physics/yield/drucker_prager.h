/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Drucker & Prager (1952), Q. Appl. Math. 10, 157, the cone through the corners of Mohr-Coulomb in
 * triaxial compression: sqrt(J2) <= (6 c cos(phi) + 6 p sin(phi))/(sqrt(3) (3 - sin(phi))). No
 * tension beyond its apex, p = -c/tan(phi). */
#ifndef YIELD_DRUCKER_PRAGER_H
#define YIELD_DRUCKER_PRAGER_H

/* clang-format off */
#define YIELD_DRUCKER_PRAGER_ROWS(X) \
  X(cohesion, "Pa",  NULL, 0, 1e300, "cohesion c") \
  X(friction, "rad", NULL, 0, 1.57,  "angle of internal friction phi")
/* clang-format on */

struct yield_drucker_prager {
#define YIELD_ROW(MEMBER, ...) double MEMBER;
  YIELD_DRUCKER_PRAGER_ROWS(YIELD_ROW)
#undef YIELD_ROW
};

HD double yield_drucker_prager_apex(const struct yield_drucker_prager *y, double weak)
{
  return y->friction > 0 ? weak * y->cohesion / tan(y->friction) : INFINITY;
}

HD double yield_drucker_prager(const struct yield_drucker_prager *y, const YieldPoint *at)
{
  double s = sin(y->friction), c = cos(y->friction), root3 = 1.7320508075688773;
  double limit = 6 * (at->weak * y->cohesion * c + at->p * s) / (root3 * (3 - s));
  return yield_return(sqrt(at->j2), at->soft * limit);
}

#endif
