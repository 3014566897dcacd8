/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Johnson & Cook (1983), Proc. 7th Int. Symp. Ballistics, 541: flow stress of metals,
 *
 *   sqrt(3 J2) <= (A + B e^n) (1 + C ln(rate/rate0)) (1 - T*^m),    T* = (T - T0)/(Tmelt - T0)
 *
 * e the equivalent plastic strain; rates below rate0 count as rate0; T* in 0..1. The temperature is
 * one of its own (field Temperature): it rises with what viscosity (shocks) and plastic work leave
 * as heat, not with isentropic compression; `heating` of the plastic work becomes heat (Taylor &
 * Quinney 1934). Needs the material's heat_capacity. */
#ifndef YIELD_JOHNSON_COOK_H
#define YIELD_JOHNSON_COOK_H

/* clang-format off */
#define YIELD_JOHNSON_COOK_ROWS(X) \
  X(A,       "Pa",  NULL,     0,     1e300, "flow stress without strain, at rate0 and T0") \
  X(B,       "Pa",  "0",      0,     1e300, "strain hardening") \
  X(n,       "1",   "1",      0,     10,    "exponent of the plastic strain") \
  X(C,       "1",   "0",      0,     10,    "growth with the logarithm of the strain rate") \
  X(rate0,   "1/s", "1",      1e-30, 1e30,  "strain rate of reference") \
  X(m,       "1",   "1",      1e-3,  100,   "exponent of the temperature") \
  X(T0,      "K",   "298.15", 0,     1e6,   "temperature of reference, and of the input without Temperature") \
  X(Tmelt,   "K",   "1e300",  0,     1e300, "temperature at which nothing is left") \
  X(heating, "1",   "0.9",    0,     1,     "part of the plastic work that becomes heat")
/* clang-format on */

struct yield_johnson_cook {
#define YIELD_ROW(MEMBER, ...) double MEMBER;
  YIELD_JOHNSON_COOK_ROWS(YIELD_ROW)
#undef YIELD_ROW
};

HD double yield_johnson_cook(const struct yield_johnson_cook *y, const YieldPoint *at)
{
  double warm = (at->T - y->T0) / (y->Tmelt - y->T0), limit = y->A;
  if (warm >= 1) return 0;
  if (y->B > 0) limit += y->B * (at->strain > 0 ? pow(at->strain, y->n) : y->n > 0 ? 0 : 1);
  if (y->C > 0 && at->rate > y->rate0) limit *= 1 + y->C * log(at->rate / y->rate0);
  if (warm > 0) limit *= 1 - pow(warm, y->m);
  return yield_return(sqrt(3 * at->j2), limit * at->soft * at->weak);
}

#endif
