/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Heun's method for the particles, q + dt/2 (q'(q) + q'(q + dt q'(q))): second order, two
 * evaluations; the classical Runge-Kutta scheme of fourth order for point masses (points_orbit), in
 * steps as short as their orbits ask for (miluphcuda; Thun & Kley 2018, A&A 616, A47). There the
 * particles' pull on them stays as it is for the whole step; here it changes linearly to what it
 * becomes, so that momentum is kept to rounding and the coupling is of second order, too. */
#include "../sim.h"

static int step(Sim *sim, double *dt, Err *err)
{
  static const double predictor[3] = {1, 0, 0}, corrector[3] = {0.5, 0.5, 0};
  Step k = sim_step(sim, *dt);
  integrator_save(sim);
  if (integrator_stage(sim, &k, 1, err)) return -1;
  integrator_combine(sim, &k, predictor);
  points_orbit(sim, *dt, 1, 1);
  if (integrator_stage(sim, &k, 2, err)) return -1;
  integrator_combine(sim, &k, corrector);
  points_orbit(sim, *dt, 1, 2);
  integrator_settle(sim, *dt);
  return 0;
}

const struct integrator integrator_heun_rk4 = {
    "heun-rk4",
    "Heun's method, two evaluations a step; point masses by Runge-Kutta of fourth order",
    2,
    3,
    0,
    integrator_begin,
    step,
    integrator_potential,
    8};
