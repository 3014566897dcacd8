/* SPDX-License-Identifier: GPL-3.0-or-later */
/* P-alpha with the crush curve of Blum et al. (2023) for granular dust, as miluphcuda has it:
 *
 *   alpha = (p_0/p)^((1 + b p)/x) + 1/phi_max
 *
 * from where that is alpha_0. */
#ifndef POROSITY_P_ALPHA_BLUM_H
#define POROSITY_P_ALPHA_BLUM_H

/* clang-format off */
#define POROSITY_P_ALPHA_BLUM_ROWS(X) \
  X(p_0,     "Pa",   "0.044e6", 1e-30, 1e30, "scale of the pressure") \
  X(x,       "1",    "8.915",   1e-3,  1e3,  "inverse slope of log alpha") \
  X(b,       "1/Pa", "7e-10",   0,     1e30, "growth of the slope") \
  X(phi_max, "1",    "0.875",   1e-3,  1,    "filling at high pressure")
/* clang-format on */

struct porosity_p_alpha_blum {
#define POROSITY_ROW(MEMBER, ...) double MEMBER;
  POROSITY_P_ALPHA_BLUM_ROWS(POROSITY_ROW)
#undef POROSITY_ROW
};

HD double porosity_p_alpha_blum_crush(const struct porosity_p_alpha_blum *q, double alpha0,
                                      double p)
{
  return p > 0 ? pow(q->p_0 / p, (1 + q->b * p) / q->x) + 1 / q->phi_max : alpha0;
}

#endif
