/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Locally isothermal disk: p = c^2 rho, c = H/r v_Kepler = aspect sqrt(G M/r), r the distance from
 * the central mass (000, EOS 12): in a run that of disk.point. */
#ifndef EOS_LOCAL_ISOTHERMAL_H
#define EOS_LOCAL_ISOTHERMAL_H

#define EOS_GRAVITY 6.67430e-11 /* m^3/kg/s^2, CODATA 2018 */

/* clang-format off */
#define EOS_LOCAL_ISOTHERMAL_ROWS(X) \
  X(aspect, "1",  NULL, 1e-6,  1,     "scale height over radius, H/r") \
  X(mass,   "kg", NULL, 1e-30, 1e300, "central mass") \
  X(r_min,  "m",  "1",  1e-30, 1e300, "inside r_min the sound speed stays as at r_min")
/* clang-format on */

struct eos_local_isothermal {
#define EOS_ROW(MEMBER, ...) double MEMBER;
  EOS_LOCAL_ISOTHERMAL_ROWS(EOS_ROW)
#undef EOS_ROW
};

HD double eos_local_isothermal_rho0(const struct eos_local_isothermal *e)
{
  (void)e;
  return 0;
}

HD EosPoint eos_local_isothermal(const struct eos_local_isothermal *e, double rho, double u,
                                 double r)
{
  double c2 = e->aspect * e->aspect * EOS_GRAVITY * e->mass / (r > e->r_min ? r : e->r_min);
  (void)u;
  return eos_point(c2 * rho, c2, 0);
}

#endif
