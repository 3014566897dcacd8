/* SPDX-License-Identifier: GPL-3.0-or-later */
/* P-alpha with the quadratic crush curve of Jutzi, Benz & Michel (2008), Icarus 198, 242, after
 * Carroll & Holt (1972): alpha = 1 + (alpha_0 - 1) ((p_s - p)/(p_s - p_e))^2 from p_e to p_s. */
#ifndef POROSITY_P_ALPHA_H
#define POROSITY_P_ALPHA_H

/* clang-format off */
#define POROSITY_P_ALPHA_ROWS(X) \
  X(p_e, "Pa", NULL, 0,      1e30, "pressure at which pores begin to crush") \
  X(p_s, "Pa", NULL, 1e-30,  1e30, "pressure at which no pores are left")
/* clang-format on */

struct porosity_p_alpha {
#define POROSITY_ROW(MEMBER, ...) double MEMBER;
  POROSITY_P_ALPHA_ROWS(POROSITY_ROW)
#undef POROSITY_ROW
};

HD double porosity_p_alpha_crush(const struct porosity_p_alpha *q, double alpha0, double p)
{
  double x = (q->p_s - p) / (q->p_s - q->p_e);
  return p <= q->p_e ? alpha0 : p >= q->p_s ? 1 : 1 + (alpha0 - 1) * x * x;
}

#endif
