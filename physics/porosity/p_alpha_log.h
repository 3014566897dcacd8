/* SPDX-License-Identifier: GPL-3.0-or-later */
/* P-alpha with a filling that grows with the logarithm of the pressure, 1/alpha = a + b lg(p/Pa),
 * from where that is 1/alpha_0: Malamud et al. (2023); their numbers, as miluphcuda has them (whose
 * slope has the wrong sign), are the defaults. */
#ifndef POROSITY_P_ALPHA_LOG_H
#define POROSITY_P_ALPHA_LOG_H

/* clang-format off */
#define POROSITY_P_ALPHA_LOG_ROWS(X) \
  X(a, "1", "-0.064", -10,   10, "filling at 1 Pa") \
  X(b, "1", "0.084",  1e-6,  10, "growth of the filling per decade")
/* clang-format on */

struct porosity_p_alpha_log {
#define POROSITY_ROW(MEMBER, ...) double MEMBER;
  POROSITY_P_ALPHA_LOG_ROWS(POROSITY_ROW)
#undef POROSITY_ROW
};

HD double porosity_p_alpha_log_crush(const struct porosity_p_alpha_log *q, double alpha0, double p)
{
  double filling = p > 0 ? q->a + q->b * log10(p) : 0;
  return filling * alpha0 > 1 ? 1 / filling : alpha0;
}

#endif
