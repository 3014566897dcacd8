/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Isothermal gas: p = c^2 rho, c^2 = R T/M. 001 sect. 4.2. */
#ifndef EOS_ISOTHERMAL_H
#define EOS_ISOTHERMAL_H

/* clang-format off */
#define EOS_ISOTHERMAL_ROWS(X) \
  X(c, "m/s", NULL, 1e-30, 1e30, "isothermal sound speed")
/* clang-format on */

struct eos_isothermal {
#define EOS_ROW(MEMBER, ...) double MEMBER;
  EOS_ISOTHERMAL_ROWS(EOS_ROW)
#undef EOS_ROW
};

HD double eos_isothermal_rho0(const struct eos_isothermal *e)
{
  (void)e;
  return 0;
}

HD EosPoint eos_isothermal(const struct eos_isothermal *e, double rho, double u, double r)
{
  double c2 = e->c * e->c;
  (void)u, (void)r;
  return eos_point(c2 * rho, c2, 0);
}

#endif
