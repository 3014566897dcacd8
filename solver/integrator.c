/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The integrators by number, and the evaluation that they share. */
#include "integrator.h"

static const struct integrator *const integrators[] = {
#define INTEGRATOR_ROW(WORD, NAME) &integrator_##NAME,
    INTEGRATORS(INTEGRATOR_ROW)
#undef INTEGRATOR_ROW
};

const struct integrator *integrator_of(int index) { return integrators[index]; }

int integrator_rates(Sim *sim, Step *k, Err *err)
{
  sim->b->pass(sim, PASS_STILL, k);
  if (sim->b->search(sim, err)) return -1;
  if (k->density != PARAM_CONTINUITY) sim->b->density(sim);
  sim->b->pass(sim, PASS_STILL, k);
  sim->b->gradient(sim);
  sim->b->pass(sim, PASS_LOCAL, k);
  sim->b->force(sim);
  return sim->b->gravity(sim, err);
}
