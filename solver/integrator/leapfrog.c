/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Staggered leapfrog (docs/theory.md 5.1): kick, drift, loop A at the middle of
 * the step with the mid-step velocity, local update of density, stress and damage, loop B at the
 * end with predicted velocities, kick. One evaluation of each loop and of gravity a step; second
 * order; positions for both loops share one tree and one set of lists. */
#include <math.h>
#include "../sim.h"

static int start(Sim *sim, Err *err)
{
  Step k = sim_step(sim, 0);
  if (integrator_rates(sim, &k, err)) return -1;
  if (k.damping > 0 && sim->b->bodies(sim, &k, err)) return -1;
  sim->b->pass(sim, PASS_FINISH, &k);
  sim->dt = INFINITY;
  return 0;
}

static int step(Sim *sim, double *dt, Err *err)
{
  Step k = sim_step(sim, 0.5 * *dt);
  sim->b->pass(sim, PASS_KICK, &k);
  k.dt = *dt;
  sim->b->pass(sim, PASS_DRIFT, &k);
  if (sim->b->search(sim, err)) return -1;
  if (k.density != PARAM_CONTINUITY) sim->b->density(sim);
  sim->b->gradient(sim);
  sim->b->pass(sim, PASS_ADVANCE, &k);
  sim->b->force(sim);
  if (sim->b->gravity(sim, err)) return -1;
  if (k.damping > 0 && sim->b->bodies(sim, &k, err)) return -1;
  sim->b->pass(sim, PASS_FINISH, &k);
  return 0;
}

const struct integrator integrator_leapfrog = {
    "leapfrog", "staggered leapfrog, one evaluation a step", 0, start, step, NULL};
