/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which precision the pair loops have. */
#include "loops.h"

static const LoopsOf *loops_of(const Sim *sim)
{
  return sim->par.precision == PARAM_MIXED ? &loops_mixed : &loops_double;
}

size_t cuda_loops_bytes(const Sim *sim) { return loops_of(sim)->bytes(sim); }
int cuda_loops_open(Sim *sim, Err *err) { return loops_of(sim)->open(sim, err); }
void cuda_loops_close(Sim *sim) { loops_of(sim)->close(sim); }
void cuda_gradient(Sim *sim) { loops_of(sim)->gradient(sim); }
void cuda_density(Sim *sim) { loops_of(sim)->density(sim); }
void cuda_force(Sim *sim) { loops_of(sim)->force(sim); }
