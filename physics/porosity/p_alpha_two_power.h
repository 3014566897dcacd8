/* SPDX-License-Identifier: GPL-3.0-or-later */
/* P-alpha with a crush curve of two powers, Jutzi, Michel, Hiraoka, Nakamura & Benz (2009), Icarus
 * 201, 802:
 *
 *   alpha = 1 + (alpha_0 - 1)/(alpha_e - 1) [(alpha_e - alpha_t) ((p_t - p)/(p_t - p_e))^n1
 *                                            + (alpha_t - 1) ((p_s - p)/(p_s - p_e))^n2]
 *
 * the first term for p < p_t only. alpha_e and alpha_t were fitted to one sample; the factor in
 * front fits them to another alpha_0, as miluphcuda does. */
#ifndef POROSITY_P_ALPHA_TWO_POWER_H
#define POROSITY_P_ALPHA_TWO_POWER_H

/* clang-format off */
#define POROSITY_P_ALPHA_TWO_POWER_ROWS(X) \
  X(p_e,     "Pa", NULL, 0,     1e30, "pressure at which pores begin to crush") \
  X(p_t,     "Pa", NULL, 1e-30, 1e30, "pressure at which the steep part ends") \
  X(p_s,     "Pa", NULL, 1e-30, 1e30, "pressure at which no pores are left") \
  X(alpha_e, "1",  NULL, 1.000001, 100, "distention of the curve at p_e") \
  X(alpha_t, "1",  NULL, 1,     100,  "distention at which the steep part would end") \
  X(n1,      "1",  NULL, 1,     1000, "power of the steep part") \
  X(n2,      "1",  NULL, 1,     1000, "power of the rest")
/* clang-format on */

struct porosity_p_alpha_two_power {
#define POROSITY_ROW(MEMBER, ...) double MEMBER;
  POROSITY_P_ALPHA_TWO_POWER_ROWS(POROSITY_ROW)
#undef POROSITY_ROW
};

HD double porosity_p_alpha_two_power_crush(const struct porosity_p_alpha_two_power *q,
                                           double alpha0, double p)
{
  double sum;
  if (p <= q->p_e) return alpha0;
  if (p >= q->p_s) return 1;
  sum = (q->alpha_t - 1) * pow((q->p_s - p) / (q->p_s - q->p_e), q->n2);
  if (p < q->p_t) sum += (q->alpha_e - q->alpha_t) * pow((q->p_t - p) / (q->p_t - q->p_e), q->n1);
  return 1 + (alpha0 - 1) / (q->alpha_e - 1) * sum;
}

#endif
