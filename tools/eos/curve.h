/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States of a material from other quantities than density and energy. */
#ifndef CURVE_H
#define CURVE_H

#include "../../lib/material.h"

/* What stands for the energy. */
typedef enum { CURVE_ENERGY, CURVE_TEMPERATURE, CURVE_ENTROPY } CurveKind;

/* curve_energy: u [J/kg] at a density and a u, T [K] or s [J/K/kg]; NAN where there is none. */
double curve_energy(const Material *m, CurveKind kind, double value, double rho);

/* curve_density: the largest density [kg/m^3] at a pressure [Pa] and a u, T or s; NAN where there
 * is none. */
double curve_density(const Material *m, CurveKind kind, double value, double p);

/* curve_shock: the state behind a shock into rho1, u1 that moves matter at up [m/s] > 0: its speed
 * us, density and energy (Rankine, Hugoniot); -1 when there is none. */
int curve_shock(const Material *m, double rho1, double u1, double up, double *us, double *rho,
                double *u);

#endif
