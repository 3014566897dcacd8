/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Adams-Bashforth predictor of second order, trapezoidal corrector (004 eq. 2.39 to 2.44, its
 * correctors with q' + q' and its predictors with the weights of unequal steps, w = dt/dt_before):
 * q_p = q + dt ((1 + w/2) q' - w/2 q'_before), then q + dt/2 (q_p' + q'); second order, two
 * evaluations. The first step of a run has no rates before it: w = 0. */
#include "../sim.h"

static int step(Sim *sim, double *dt, Err *err)
{
  Step k = sim_step(sim, *dt);
  double w = sim->dt_before > 0 ? *dt / sim->dt_before : 0;
  const double predictor[3] = {1 + 0.5 * w, 0, -0.5 * w}, corrector[3] = {0.5, 0.5, 0};
  integrator_save(sim);
  if (integrator_stage(sim, &k, 1, err)) return -1;
  k.slot = 3;
  sim->b->pass(sim, PASS_RECALL, &k);
  integrator_combine(sim, &k, predictor);
  if (integrator_stage(sim, &k, 2, err)) return -1;
  integrator_combine(sim, &k, corrector);
  k.slot = 1;
  sim->b->pass(sim, PASS_REMEMBER, &k);
  integrator_settle(sim, *dt);
  return 0;
}

const struct integrator integrator_ab2 = {
    "ab2", "Adams-Bashforth predictor, trapezoidal corrector, two evaluations a step",
    2,     4,
    1,     integrator_begin,
    step,  integrator_potential,
    0};
