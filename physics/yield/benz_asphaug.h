/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Von Mises as printed by Benz & Asphaug (1994, 1995) and 001 eq. 17: f = min(Y^2/(3 J2), 1). It
 * overshoots, sqrt(3 J2) = 2 Y comes back to Y/2, and reaches Y only when applied in many small
 * steps. To compare with results of codes that use it. */
#ifndef YIELD_BENZ_ASPHAUG_H
#define YIELD_BENZ_ASPHAUG_H

/* clang-format off */
#define YIELD_BENZ_ASPHAUG_ROWS(X) \
  X(Y, "Pa", NULL, 0, 1e300, "yield stress in uniaxial tension")
/* clang-format on */

struct yield_benz_asphaug {
#define YIELD_ROW(MEMBER, ...) double MEMBER;
  YIELD_BENZ_ASPHAUG_ROWS(YIELD_ROW)
#undef YIELD_ROW
};

HD double yield_benz_asphaug(const struct yield_benz_asphaug *y, const YieldPoint *at)
{
  double limit = y->Y * at->soft * at->weak, limit2 = limit * limit;
  return 3 * at->j2 > limit2 ? limit2 / (3 * at->j2) : 1;
}

#endif
