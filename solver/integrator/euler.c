/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forward Euler, q += dt q'(q): first order, one evaluation a step. For comparisons; waves grow in
 * it. */
#include "../sim.h"

static int step(Sim *sim, double *dt, Err *err)
{
  static const double whole[1][3] = {{1, 0, 0}};
  Step k = sim_step(sim, *dt);
  integrator_save(sim);
  if (integrator_stages(sim, &k, whole, 1, err)) return -1;
  integrator_settle(sim, *dt);
  return 0;
}

const struct integrator integrator_euler = {"euler", "forward Euler, one evaluation a step",
                                            1,       2,
                                            0,       integrator_begin,
                                            step,    integrator_potential,
                                            0};
