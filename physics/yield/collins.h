/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Collins, Melosh & Ivanov (2004), Meteorit. Planet. Sci. 39, 217: shear strength of rock between
 * intact and shattered,
 *
 *   intact:    Y_i = c + mu p/(1 + mu p/(Y_M - c)) for p > 0, else c
 *   damaged:   Y_d = c_d + mu_d p for p > 0, else c_d + p; at most Y_i
 *   sqrt(J2) <= (1 - D) Y_i + D Y_d
 *
 * Heat takes off all of it, low density the cohesion of the damaged rock. Tension ends at (1 - D) c
 * + D c_d. As D is in here, it must not be taken off S again: damage.shear = 0. */
#ifndef YIELD_COLLINS_H
#define YIELD_COLLINS_H

/* clang-format off */
#define YIELD_COLLINS_ROWS(X) \
  X(cohesion,         "Pa", NULL, 0, 1e300, "shear strength of intact rock at zero pressure c") \
  X(friction,         "1",  NULL, 0, 100,   "coefficient of internal friction of intact rock mu") \
  X(limit,            "Pa", NULL, 0, 1e300, "shear strength at high pressure Y_M") \
  X(cohesion_damaged, "Pa", "0",  0, 1e300, "cohesion of shattered rock c_d") \
  X(friction_damaged, "1",  NULL, 0, 100,   "coefficient of friction of shattered rock mu_d")
/* clang-format on */

struct yield_collins {
#define YIELD_ROW(MEMBER, ...) double MEMBER;
  YIELD_COLLINS_ROWS(YIELD_ROW)
#undef YIELD_ROW
};

HD double yield_collins_apex(const struct yield_collins *y, double damage, double weak)
{
  return (1 - damage) * y->cohesion + damage * weak * y->cohesion_damaged;
}

HD double yield_collins(const struct yield_collins *y, const YieldPoint *at)
{
  double p = at->p, loose = at->weak * y->cohesion_damaged;
  double intact = p > 0 ? yield_lundborg_curve(y->cohesion, y->friction, y->limit, p) : y->cohesion;
  double damaged = loose + (p > 0 ? y->friction_damaged * p : p);
  damaged = damaged < 0 ? 0 : damaged > intact ? intact : damaged;
  return yield_return(sqrt(at->j2), at->soft * ((1 - at->damage) * intact + at->damage * damaged));
}

#endif
