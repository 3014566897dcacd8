/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Temperature of a material whose law knows only energies: T = (u - u_cold(rho))/heat_capacity,
 * where u_cold is the energy along the isentrope du = p/rho^2 drho that passes through rho0 with no
 * energy (a gas: 0). Entropy is counted from rho0 at 1 K: it is constant along an isentrope,
 * and at rho0 du = T ds, so that s = heat_capacity ln(T(rho0)/1 K) of the isentrope's
 * temperature at rho0. A table has temperatures and entropies of its own, which are taken. */
#ifndef THERMAL_H
#define THERMAL_H

#include "../physics/material.h"

/* thermal_isentrope: energy [J/kg] at density rho [kg/m^3] > 0 on the isentrope through rho1, u1,
 * to 1e-11. NAN when the law is not defined on the way. */
double thermal_isentrope(const Eos *eos, double rho1, double u1, double rho);

/* thermal_cold: u_cold at rho. */
double thermal_cold(const Eos *eos, double rho);

/* thermal_temperature [K], thermal_energy [J/kg]: one from the other at rho; NAN when the material
 * has no heat capacity. */
double thermal_temperature(const Material *m, double rho, double u);
double thermal_energy(const Material *m, double rho, double t);

/* thermal_slope: du/drho [J m^3/kg^2] at rho, u of a state that moves along T ~ rho^a, with t [K]
 * its temperature there; a = 0 is an isotherm. NAN without heat capacity. */
double thermal_slope(const Material *m, double rho, double u, double t, double a);

/* thermal_entropy: J/K/kg at rho, u (-infinity at T = 0). thermal_at_entropy: the energy at rho0 of
 * the isentrope with that entropy. NAN without heat capacity, or for a gas. */
double thermal_entropy(const Material *m, double rho, double u);
double thermal_at_entropy(const Material *m, double s);

#endif
