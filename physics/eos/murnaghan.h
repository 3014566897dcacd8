/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Murnaghan: p = K/n ((rho/rho0)^n - 1), isothermal. 001 eq. 13; Melosh (1996). */
#ifndef EOS_MURNAGHAN_H
#define EOS_MURNAGHAN_H

/* The parameters: X(member, SI unit, default or NULL, min, max, meaning). The struct, the reader
 * and the docs are made from them. */
/* clang-format off */
#define EOS_MURNAGHAN_ROWS(X) \
  X(rho0,    "kg/m^3", NULL, 1e-30, 1e30, "density at zero pressure") \
  X(K,       "Pa",     NULL, 1e-30, 1e30, "bulk modulus at zero pressure") \
  X(n,       "1",      NULL, 1e-3,  1e3,  "dK/dp") \
  X(rho_min, "1",      "0",  0,     1,    "no tension below rho_min x rho0; 0: never cut")
/* clang-format on */

struct eos_murnaghan {
#define EOS_ROW(MEMBER, ...) double MEMBER;
  EOS_MURNAGHAN_ROWS(EOS_ROW)
#undef EOS_ROW
};

HD double eos_murnaghan_rho0(const struct eos_murnaghan *e) { return e->rho0; }

/* c^2 = K/rho0 eta^(n-1). */
HD EosPoint eos_murnaghan(const struct eos_murnaghan *e, double rho, double u, double r)
{
  double eta = rho / e->rho0, power = pow(eta, e->n - 1), c0 = sqrt(e->K / e->rho0);
  double p = e->K / e->n * (power * eta - 1);
  (void)u, (void)r;
  return eos_point(eos_no_tension(p, eta, e->rho_min), c0 * c0 * power, EOS_FLOOR * c0);
}

#endif
