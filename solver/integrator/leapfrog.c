/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Staggered leapfrog (docs/theory.md 5.1): kick, drift, loop A at the middle of
 * the step with the mid-step velocity, local update of density, stress and damage, loop B at the
 * end with predicted velocities, kick. One evaluation of each loop and of gravity a step; second
 * order; positions for both loops share one tree and one set of lists.
 *
 * gravity.every = k: gravity is a kick of its own around k steps (impulse form; Tuckerman et al.
 * 1992, J. Chem. Phys. 97, 1990): it opens with k dt/2 and closes with what is left of the sum of
 * the steps, so that weights add up to the time whatever the steps become.
 *
 * gravity.tolerance: the number of steps is such that gravity changes by at most that much
 * (sim.c). */
#include <math.h>
#include "../sim.h"

static int start(Sim *sim, Err *err)
{
  Step k = sim_step(sim, 0);
  if (integrator_rates(sim, &k, err)) return -1;
  if (k.framed && sim->b->bodies(sim, &k, err)) return -1;
  sim->b->pass(sim, PASS_FINISH, &k);
  sim->dt = INFINITY;
  return 0;
}

/* Gravity in the kick that opens a step of length dt: after an evaluation for half of all the
 * steps up to the next one, else not at all. */
static double opening(Sim *sim, double dt)
{
  if (sim->outer > 0) return 0;
  sim->outer_kick = 0.5 * sim->outer_steps * dt;
  return sim->outer_steps;
}

/* And in the kick that closes it: with a new evaluation for the rest of these steps. */
static double closing(Sim *sim, double dt)
{
  sim->outer++, sim->outer_time += dt;
  if (!sim->pull_due) return 0;
  const double weight = 2 * (sim->outer_time - sim->outer_kick) / dt;
  sim->outer = 0, sim->pull_time = sim->outer_time, sim->outer_time = 0;
  return weight;
}

static int step(Sim *sim, double *dt, Err *err)
{
  Step k = sim_step(sim, *dt);
  k.dt = 0.5 * *dt, k.pull = opening(sim, *dt) - 1;
  sim->b->pass(sim, PASS_KICK, &k);
  k.dt = *dt;
  k.pull = closing(sim, *dt) - 1;
  sim->b->pass(sim, PASS_DRIFT, &k);
  if (sim->b->search(sim, err)) return -1;
  if (k.summed) sim->b->density(sim);
  sim->b->gradient(sim);
  sim->b->pass(sim, PASS_ADVANCE, &k);
  sim->b->force(sim);
  if (integrator_gravity(sim, err)) return -1;
  if (k.framed && sim->b->bodies(sim, &k, err)) return -1;
  sim->b->pass(sim, PASS_FINISH, &k);
  return 0;
}

const struct integrator integrator_leapfrog = {
    "leapfrog", "staggered leapfrog, one evaluation a step", 2, 0, 0, start, step, NULL, 0};
