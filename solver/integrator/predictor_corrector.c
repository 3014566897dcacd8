/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Predictor-corrector of 001 eq. 52, 53 (Monaghan 1989, J. Comput. Phys. 82, 1): everything is
 * predicted to the middle of the step, and its rates there make the step; second order, two
 * evaluations. */
#include "../sim.h"

static int step(Sim *sim, double *dt, Err *err)
{
  static const double stages[2][3] = {{0.5, 0, 0}, {0, 1, 0}};
  Step k = sim_step(sim, *dt);
  integrator_save(sim);
  if (integrator_stages(sim, &k, stages, 2, err)) return -1;
  integrator_settle(sim, *dt);
  return 0;
}

const struct integrator integrator_predictor_corrector = {
    "predictor-corrector",
    "predictor-corrector by the middle of the step, two evaluations",
    2,
    3,
    0,
    integrator_begin,
    step,
    integrator_potential,
    0};
