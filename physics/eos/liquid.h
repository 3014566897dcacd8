/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Liquid: p = c^2 (rho - rho0), the Murnaghan law with n = 1. 001 eq. 11, 12; Melosh (1996). */
#ifndef EOS_LIQUID_H
#define EOS_LIQUID_H

/* clang-format off */
#define EOS_LIQUID_ROWS(X) \
  X(rho0,    "kg/m^3", NULL,  1e-30, 1e30, "density at zero pressure") \
  X(c,       "m/s",    NULL,  1e-30, 1e30, "bulk sound speed") \
  X(rho_min, "1",      "0.9", 0,     1,    "no tension below rho_min x rho0 (droplets)")
/* clang-format on */

struct eos_liquid {
#define EOS_ROW(MEMBER, ...) double MEMBER;
  EOS_LIQUID_ROWS(EOS_ROW)
#undef EOS_ROW
};

HD double eos_liquid_rho0(const struct eos_liquid *e) { return e->rho0; }

HD EosPoint eos_liquid(const struct eos_liquid *e, double rho, double u, double r)
{
  double c2 = e->c * e->c, p = c2 * (rho - e->rho0);
  (void)u, (void)r;
  return eos_point(eos_no_tension(p, rho / e->rho0, e->rho_min), c2, 0);
}

#endif
