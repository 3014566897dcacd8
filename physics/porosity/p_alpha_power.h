/* SPDX-License-Identifier: GPL-3.0-or-later */
/* P-alpha with a filling that is a power of the pressure, 1/alpha = a (p/MPa)^b, from where that is
 * 1/alpha_0: Malamud et al. (2023), as miluphcuda has it; their numbers are the defaults. */
#ifndef POROSITY_P_ALPHA_POWER_H
#define POROSITY_P_ALPHA_POWER_H

/* clang-format off */
#define POROSITY_P_ALPHA_POWER_ROWS(X) \
  X(a, "1", "0.41", 1e-6, 1,  "filling at 1 MPa") \
  X(b, "1", "0.09", 1e-6, 10, "power")
/* clang-format on */

struct porosity_p_alpha_power {
#define POROSITY_ROW(MEMBER, ...) double MEMBER;
  POROSITY_P_ALPHA_POWER_ROWS(POROSITY_ROW)
#undef POROSITY_ROW
};

HD double porosity_p_alpha_power_crush(const struct porosity_p_alpha_power *q, double alpha0,
                                       double p)
{
  double filling = p > 0 ? q->a * pow(1e-6 * p, q->b) : 0;
  return filling * alpha0 > 1 ? 1 / filling : alpha0;
}

#endif
