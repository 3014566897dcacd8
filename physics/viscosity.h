/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Artificial viscosity of Monaghan & Gingold (1983), 001 eq. 32, 33: for approaching pairs
 *   Pi = (-alpha c nu + beta nu^2)/rho,  nu = h v_ij.r_ij/(r^2 + 0.01 h^2) < 0.
 * Pi >= 0 is a pressure over rho^2, so it enters the stress as -Pi 1 (001 eq. 34 prints +Pi). As in
 * 001 h is the full support of the kernel; 004 uses half of it: its alpha 1, beta 2 are alpha 0.5,
 * beta 0.5 here. */
#ifndef VISCOSITY_H
#define VISCOSITY_H

#include "hd.h"

/* viscosity_nu: [m/s], 0 for receding pairs. vr = v_ij . r_ij [m^2/s], r2 = r_ij^2 [m^2], h the
 * pair's support radius [m]. */
HD real viscosity_nu(real vr, real r2, real h)
{
  return vr < 0 ? h * vr * real_inverse(r2 + (real)0.01 * h * h) : 0;
}

/* viscosity_pi: [m^5/kg/s^2] for the pair's mean sound speed c and mean density rho; >= 0. */
HD real viscosity_pi(real nu, real c, real rho, real alpha, real beta)
{
  return (beta * nu - alpha * c) * nu * real_inverse(rho);
}

#endif
