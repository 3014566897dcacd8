/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Embedded Runge-Kutta 3(2) of 001 eq. 58-65: the third-order step is kept, its difference to the
 * midpoint rule is the error estimate that controls the step; three evaluations, repeated with a
 * shorter step when the error exceeds step.error. */
#include <math.h>
#include "../sim.h"

static const double STAGES[3][3] = {{0.5, 0, 0}, {-1, 2, 0}, {1. / 6, 4. / 6, 1. / 6}};

/* The rates of the present state into saved[slot]. */
static int rates(Sim *sim, Step *k, int slot, Err *err)
{
  double dt = k->dt;
  k->dt = 0;
  if (integrator_rates(sim, k, err)) return -1;
  if (k->damping > 0) {
    if (sim->b->bodies(sim, k, err)) return -1;
    sim->b->pass(sim, PASS_DAMP, k);
  }
  k->dt = dt, k->slot = slot, k->rates = 1;
  sim->b->pass(sim, PASS_SAVE, k);
  return 0;
}

static void combine(Sim *sim, Step *k, int stage)
{
  for (int w = 0; w < 3; w++) k->weight[w] = STAGES[stage][w];
  sim->b->pass(sim, PASS_COMBINE, k);
}

/* One trial step of length dt from saved[0]; its error over the tolerance. */
static int trial(Sim *sim, double dt, double *error, Err *err)
{
  Step k = sim_step(sim, dt);
  for (int stage = 0; stage < 3; stage++) {
    if (rates(sim, &k, stage + 1, err)) return -1;
    combine(sim, &k, stage);
  }
  if (sim->b->error(sim, &k, error, err)) return -1;
  *error /= sim->par.step_error;
  return 0;
}

/* The accelerations and limits that the run loop looks at, from the last evaluation (which is
 * damped already). */
static void keep(Sim *sim)
{
  Step k = sim_step(sim, 0);
  k.energy = PARAM_FROZEN, k.damping = 0;
  sim->b->pass(sim, PASS_FINISH, &k);
}

static int start(Sim *sim, Err *err)
{
  Step k = sim_step(sim, 0);
  if (integrator_rates(sim, &k, err)) return -1;
  keep(sim);
  sim->dt = INFINITY;
  return 0;
}

static int step(Sim *sim, double *dt, Err *err)
{
  Step k = sim_step(sim, 0);
  double error, factor;
  sim->b->pass(sim, PASS_SAVE, &k);
  for (;;) {
    if (trial(sim, *dt, &error, err)) return -1;
    if (!(error > 1)) break;
    *dt *= fmax(0.2, 0.9 * pow(error, -1. / 4));
    if (!(*dt > sim->par.step_min))
      return err_set(err, "the error control wants a step of %.3g s", *dt);
    sim->b->pass(sim, PASS_COMBINE, &k);
  }
  factor = error > 0 ? 0.9 * pow(error, -0.3) : 2;
  sim->dt = *dt * fmin(2, fmax(1, factor));
  k.dt = *dt;
  sim->b->pass(sim, PASS_SETTLE, &k);
  keep(sim);
  return 0;
}

/* The last evaluation was at the third stage, not at the combination that is kept. Only phi and
 * work arrays change: the next evaluation begins with the same order, tree and lists. */
static int potential(Sim *sim, Err *err)
{
  Step k = sim_step(sim, 0);
  if (sim->par.gravity == PARAM_NONE) return 0;
  sim->b->pass(sim, PASS_STILL, &k);
  return sim->b->search(sim, err) || sim->b->gravity(sim, err) ? -1 : 0;
}

const struct integrator integrator_rk2_adaptive = {
    "rk2-adaptive",
    "embedded Runge-Kutta 3(2) with error control, three evaluations a step",
    4,
    start,
    step,
    potential};
