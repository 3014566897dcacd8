/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ideal gas: p = (gamma - 1) rho u, c^2 = gamma (gamma - 1) u. */
#ifndef EOS_IDEAL_H
#define EOS_IDEAL_H

/* clang-format off */
#define EOS_IDEAL_ROWS(X) \
  X(gamma,  "1",   NULL, 1.000001, 100,  "ratio of the specific heats") \
  X(c_min,  "m/s", "0",  0,        1e30, "floor of the sound speed, for u = 0")
/* clang-format on */

struct eos_ideal {
#define EOS_ROW(MEMBER, ...) double MEMBER;
  EOS_IDEAL_ROWS(EOS_ROW)
#undef EOS_ROW
};

HD double eos_ideal_rho0(const struct eos_ideal *e)
{
  (void)e;
  return 0;
}

HD EosPoint eos_ideal(const struct eos_ideal *e, double rho, double u, double r)
{
  (void)r;
  return eos_point((e->gamma - 1) * rho * u, e->gamma * (e->gamma - 1) * u, e->c_min);
}

#endif
