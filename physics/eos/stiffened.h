/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stiffened polynomial: p = rho0 c^2/gamma (eta^gamma - 1) + A2 mu^2 + A3 mu^3 + G rho0 u, eta =
 * rho/rho0, mu = eta - 1. The defaults are the water of 003 eq. 8 (gamma = 7). gamma = 1 is the
 * cubic polynomial with Grueneisen term of its mercury (003 sect. 6.2, coefficients not printed):
 * A1 = rho0 c^2, and A2 = A1 (2 s - 1), A3 = A1 (s - 1)(3 s - 1) follow a shock Us = c + s up. */
#ifndef EOS_STIFFENED_H
#define EOS_STIFFENED_H

/* clang-format off */
#define EOS_STIFFENED_ROWS(X) \
  X(rho0,    "kg/m^3", NULL, 1e-30, 1e30, "density at zero pressure and energy") \
  X(c,       "m/s",    NULL, 1e-30, 1e30, "sound speed at zero pressure and energy") \
  X(gamma,   "1",      "7",  1e-3,  1e3,  "exponent; 1: polynomial in mu") \
  X(A2,      "Pa",     "0",  -1e30, 1e30, "coefficient of mu^2") \
  X(A3,      "Pa",     "0",  -1e30, 1e30, "coefficient of mu^3") \
  X(G,       "1",      "0",  0,     100,  "Grueneisen parameter at rho0, G rho constant") \
  X(rho_min, "1",      "0",  0,     1,    "no tension below rho_min x rho0; 0: never cut")
/* clang-format on */

struct eos_stiffened {
#define EOS_ROW(MEMBER, ...) double MEMBER;
  EOS_STIFFENED_ROWS(EOS_ROW)
#undef EOS_ROW
};

HD double eos_stiffened_rho0(const struct eos_stiffened *e) { return e->rho0; }

/* c^2 = c0^2 eta^(gamma-1) + (2 A2 mu + 3 A3 mu^2)/rho0 + G rho0 p/rho^2. */
HD EosPoint eos_stiffened(const struct eos_stiffened *e, double rho, double u, double r)
{
  double eta = rho / e->rho0, mu = eta - 1, c02 = e->c * e->c, power = pow(eta, e->gamma - 1);
  double p = e->rho0 * c02 / e->gamma * (power * eta - 1) + (e->A2 + e->A3 * mu) * mu * mu +
             e->G * e->rho0 * u;
  double slope = c02 * power + (2 * e->A2 + 3 * e->A3 * mu) * mu / e->rho0;
  (void)r;
  return eos_point(eos_no_tension(p, eta, e->rho_min), slope + e->G * p / (eta * rho),
                   EOS_FLOOR * e->c);
}

#endif
