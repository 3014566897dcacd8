/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Epsilon-alpha: Wuennemann, Collins & Melosh (2006), Icarus 180, 514; Collins, Melosh & Wuennemann
 * (2011), Int. J. Impact Eng. 38, 434. Pores close with the volumetric strain e (negative in
 * compression) since the density rho0/alpha_0:
 *
 *   alpha_0                                               e > epsilon_e
 *   alpha_0 exp(kappa (e - epsilon_e))                    down to epsilon_x, where it is alpha_x
 *   1 + (alpha_x - 1) ((e_c - e)/(e_c - epsilon_x))^2     down to e_c, then 1
 *
 * e_c = 2 (1 - alpha_x)/(kappa alpha_x) + epsilon_x makes the slope continuous. Heat expands the
 * solid: what that takes up, gamma u/c^2, is not left to the pores and counts as strain (2011). */
#ifndef POROSITY_EPSILON_ALPHA_H
#define POROSITY_EPSILON_ALPHA_H

/* clang-format off */
#define POROSITY_EPSILON_ALPHA_ROWS(X) \
  X(kappa,     "1", NULL, 1e-3, 1,  "rate of crushing, d ln(alpha)/de") \
  X(epsilon_e, "1", "0",  -10,  0,  "strain at which pores begin to crush") \
  X(epsilon_x, "1", NULL, -10,  0,  "strain at which the exponential ends") \
  X(gamma,     "1", "0",  0,    10, "Grueneisen parameter of the thermal expansion; 0: none")
/* clang-format on */

struct porosity_epsilon_alpha {
#define POROSITY_ROW(MEMBER, ...) double MEMBER;
  POROSITY_EPSILON_ALPHA_ROWS(POROSITY_ROW)
#undef POROSITY_ROW
};

HD double porosity_epsilon_alpha_crush(const struct porosity_epsilon_alpha *q, double alpha0,
                                       double e)
{
  double end = alpha0 * exp(q->kappa * (q->epsilon_x - q->epsilon_e)), closed, x;
  if (e >= q->epsilon_e) return alpha0;
  if (e >= q->epsilon_x) return alpha0 * exp(q->kappa * (e - q->epsilon_e));
  closed = 2 * (1 - end) / (q->kappa * end) + q->epsilon_x;
  x = (closed - e) / (closed - q->epsilon_x);
  return e > closed && end > 1 ? 1 + (end - 1) * x * x : 1;
}

#endif
