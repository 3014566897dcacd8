/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runge-Kutta of third order whose stages are means of Euler steps, so that no variation grows that
 * would not in these (TVD; Gottlieb & Shu 1998, Math. Comput. 67, 73; 003 sect. 2.3): q1 = q + dt
 * q', q2 = 3/4 q + 1/4 (q1 + dt q1'), 1/3 q + 2/3 (q2 + dt q2'); three evaluations. */
#include "../sim.h"

static int step(Sim *sim, double *dt, Err *err)
{
  static const double stages[3][3] = {{1, 0, 0}, {1. / 4, 1. / 4, 0}, {1. / 6, 1. / 6, 2. / 3}};
  Step k = sim_step(sim, *dt);
  integrator_save(sim);
  if (integrator_stages(sim, &k, stages, 3, err)) return -1;
  integrator_settle(sim, *dt);
  return 0;
}

const struct integrator integrator_rk3_tvd = {
    "rk3-tvd", "TVD Runge-Kutta of third order, three evaluations",
    3,         4,
    0,         integrator_begin,
    step,      integrator_potential,
    0};
