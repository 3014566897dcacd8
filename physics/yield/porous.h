/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dust aggregates with the porosity law sirono: sqrt(3 J2) <= factor sqrt(C T), the geometric mean
 * of compressive and tensile strength (Sirono 2004, Icarus 167, 431; Geretshauser et al. 2010, A&A
 * 513, A58). */
#ifndef YIELD_POROUS_H
#define YIELD_POROUS_H

/* clang-format off */
#define YIELD_POROUS_ROWS(X) \
  X(factor, "1", "1", 0, 1e30, "shear strength over sqrt(C T)")
/* clang-format on */

struct yield_porous {
#define YIELD_ROW(MEMBER, ...) double MEMBER;
  YIELD_POROUS_ROWS(YIELD_ROW)
#undef YIELD_ROW
};

HD double yield_porous(const struct yield_porous *y, const YieldPoint *at)
{
  return yield_return(sqrt(3 * at->j2), y->factor * at->pores * at->soft * at->weak);
}

#endif
