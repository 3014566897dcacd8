/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polytrope: p = K rho^gamma, c^2 = gamma K rho^(gamma - 1) (the gamma is missing in miluphcuda).
 */
#ifndef EOS_POLYTROPIC_H
#define EOS_POLYTROPIC_H

/* clang-format off */
#define EOS_POLYTROPIC_ROWS(X) \
  X(K,     "1", NULL, 1e-300, 1e300, "p/rho^gamma in SI units, Pa (m^3/kg)^gamma") \
  X(gamma, "1", NULL, 1e-3,   100,   "exponent, 1 + 1/n")
/* clang-format on */

struct eos_polytropic {
#define EOS_ROW(MEMBER, ...) double MEMBER;
  EOS_POLYTROPIC_ROWS(EOS_ROW)
#undef EOS_ROW
};

HD double eos_polytropic_rho0(const struct eos_polytropic *e)
{
  (void)e;
  return 0;
}

HD EosPoint eos_polytropic(const struct eos_polytropic *e, double rho, double u, double r)
{
  double power = e->K * pow(rho, e->gamma - 1);
  (void)u, (void)r;
  return eos_point(power * rho, e->gamma * power, 0);
}

#endif
