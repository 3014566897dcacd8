/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Von Mises, radial return: f = min(Y/sqrt(3 J2), 1), so that sqrt(3 J2) = Y after it. 001 eq. 17
 * prints Y^2/(3 J2) instead, which is benz_asphaug.h. */
#ifndef YIELD_VON_MISES_H
#define YIELD_VON_MISES_H

/* The parameters: X(member, SI unit, default or NULL, min, max, meaning). */
/* clang-format off */
#define YIELD_VON_MISES_ROWS(X) \
  X(Y, "Pa", NULL, 0, 1e300, "yield stress in uniaxial tension")
/* clang-format on */

struct yield_von_mises {
#define YIELD_ROW(MEMBER, ...) double MEMBER;
  YIELD_VON_MISES_ROWS(YIELD_ROW)
#undef YIELD_ROW
};

HD double yield_von_mises(const struct yield_von_mises *y, const YieldPoint *at)
{
  return yield_return(sqrt(3 * at->j2), y->Y * at->soft * at->weak);
}

#endif
