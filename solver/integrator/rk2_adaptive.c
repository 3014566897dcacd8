/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Embedded Runge-Kutta 3(2) of 001 eq. 58-65: the third-order step is kept, its difference to the
 * midpoint rule is the error estimate that controls the step; three evaluations, repeated with a
 * shorter step when the error exceeds step.error. */
#include <math.h>
#include "../sim.h"

static const double STAGES[3][3] = {{0.5, 0, 0}, {-1, 2, 0}, {1. / 6, 4. / 6, 1. / 6}};

/* One trial step of length dt from saved[0]; its error over the tolerance. */
static int trial(Sim *sim, double dt, double *error, Err *err)
{
  Step k = sim_step(sim, dt);
  if (integrator_stages(sim, &k, STAGES, 3, err)) return -1;
  if (sim->b->error(sim, &k, error, err)) return -1;
  *error = fmax(*error, points_error(sim, dt) / sim->par.step_error);
  return 0;
}

static int step(Sim *sim, double *dt, Err *err)
{
  Step k = sim_step(sim, 0);
  double error, factor;
  integrator_save(sim);
  for (;;) {
    if (trial(sim, *dt, &error, err)) return -1;
    if (!(error > 1)) break;
    *dt *= fmax(0.2, 0.9 * pow(error, -1. / 4));
    if (!(*dt > sim->par.step_min))
      return err_set(err, "the error control wants a step of %.3g s", *dt);
    sim->b->pass(sim, PASS_COMBINE, &k);
  }
  factor = error > 0 ? 0.9 * pow(error, -0.3) : sim->par.step_growth;
  sim->dt = *dt * fmin(sim->par.step_growth, fmax(1, factor));
  integrator_settle(sim, *dt);
  return 0;
}

const struct integrator integrator_rk2_adaptive = {
    "rk2-adaptive",
    "embedded Runge-Kutta 3(2) with error control, three evaluations a step",
    3,
    4,
    0,
    integrator_begin,
    step,
    integrator_potential,
    0};
