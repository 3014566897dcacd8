/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lundborg (1968), Int. J. Rock Mech. Min. Sci. 5, 427: shear strength of intact rock,
 *
 *   sqrt(J2) <= c + mu p/(1 + mu p/(Y_M - c))     p > 0
 *   sqrt(J2) <= c + p                             p <= 0
 *
 * with no tension beyond p = -c. Y_M large: linear friction. */
#ifndef YIELD_LUNDBORG_H
#define YIELD_LUNDBORG_H

/* clang-format off */
#define YIELD_LUNDBORG_ROWS(X) \
  X(cohesion, "Pa", NULL,    0, 1e300, "shear strength at zero pressure c") \
  X(friction, "1",  NULL,    0, 100,   "coefficient of internal friction mu") \
  X(limit,    "Pa", "1e300", 0, 1e300, "shear strength at high pressure Y_M")
/* clang-format on */

struct yield_lundborg {
#define YIELD_ROW(MEMBER, ...) double MEMBER;
  YIELD_LUNDBORG_ROWS(YIELD_ROW)
#undef YIELD_ROW
};

/* yield_lundborg_curve: the limit of sqrt(J2) [Pa] at p > 0. */
HD double yield_lundborg_curve(double cohesion, double friction, double limit, double p)
{
  double x = friction * p, room = limit - cohesion;
  return cohesion + (room > 0 ? x / (1 + x / room) : 0);
}

HD double yield_lundborg(const struct yield_lundborg *y, const YieldPoint *at)
{
  double c = y->cohesion * at->weak;
  double limit = at->p > 0 ? yield_lundborg_curve(c, y->friction, y->limit, at->p) : c + at->p;
  return yield_return(sqrt(at->j2), at->soft * limit);
}

#endif
