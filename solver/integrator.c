/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The integrators by number, and the evaluation that they share. */
#include <math.h>
#include "sim.h"

static const struct integrator *const integrators[] = {
#define INTEGRATOR_ROW(WORD, NAME) &integrator_##NAME,
    INTEGRATORS(INTEGRATOR_ROW)
#undef INTEGRATOR_ROW
};

const struct integrator *integrator_of(int index) { return integrators[index]; }

int integrator_gravity(Sim *sim, Err *err)
{
  const double *f = sim->par.force;
  const Step k = sim_step(sim, 0);
  if (sim->b->gravity(sim, err)) return -1;
  if (f[0] != 0 || f[1] != 0 || f[2] != 0) sim->b->pass(sim, PASS_BODY_FORCE, &k);
  if (sim->hold.on) sim->b->pass(sim, PASS_HOLD, &k);
  return 0;
}

int integrator_rates(Sim *sim, Step *k, Err *err)
{
  sim->b->pass(sim, PASS_STILL, k);
  if (sim->b->search(sim, err)) return -1;
  if (k->summed) sim->b->density(sim);
  sim->b->pass(sim, PASS_STILL, k);
  sim->b->gradient(sim);
  sim->b->pass(sim, PASS_LOCAL, k);
  sim->b->force(sim);
  return integrator_gravity(sim, err);
}

int integrator_stage(Sim *sim, Step *k, int slot, Err *err)
{
  double dt = k->dt;
  k->dt = 0;
  if (integrator_rates(sim, k, err)) return -1;
  if (k->framed) {
    if (sim->b->bodies(sim, k, err)) return -1;
    sim->b->pass(sim, PASS_DAMP, k);
  }
  k->dt = dt, k->slot = slot, k->rates = 1;
  sim->b->pass(sim, PASS_SAVE, k);
  return 0;
}

void integrator_save(Sim *sim)
{
  Step k = sim_step(sim, 0);
  sim->b->pass(sim, PASS_SAVE, &k);
}

void integrator_combine(Sim *sim, Step *k, const double weight[3])
{
  for (int w = 0; w < 3; w++) k->weight[w] = weight[w];
  sim->b->pass(sim, PASS_COMBINE, k);
}

int integrator_stages(Sim *sim, Step *k, const double (*weight)[3], int stages, Err *err)
{
  for (int stage = 0; stage < stages; stage++) {
    if (integrator_stage(sim, k, stage + 1, err)) return -1;
    integrator_combine(sim, k, weight[stage]);
  }
  return 0;
}

/* The accelerations and limits of the last evaluation, which is damped already. */
static void keep(Sim *sim)
{
  Step k = sim_step(sim, 0);
  k.energy = PARAM_FROZEN, k.damping = k.spin_rate = 0;
  sim->b->pass(sim, PASS_FINISH, &k);
}

void integrator_settle(Sim *sim, double dt)
{
  Step k = sim_step(sim, dt);
  sim->b->pass(sim, PASS_SETTLE, &k);
  keep(sim);
}

int integrator_begin(Sim *sim, Err *err)
{
  Step k = sim_step(sim, 0);
  if (integrator_rates(sim, &k, err)) return -1;
  keep(sim);
  sim->dt = INFINITY;
  return 0;
}

/* Only phi and work arrays change: the next evaluation begins with the same order, tree and
 * lists. */
int integrator_potential(Sim *sim, Err *err)
{
  Step k = sim_step(sim, 0);
  if (sim->par.gravity == PARAM_NONE && !sim->points.n) return 0;
  sim->b->pass(sim, PASS_STILL, &k);
  return sim->b->search(sim, err) || sim->b->gravity(sim, err) ? -1 : 0;
}
