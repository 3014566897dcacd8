/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time integrators: one const struct a scheme, in integrator/. They call passes of the backend and
 * know no particle. */
#ifndef INTEGRATOR_H
#define INTEGRATOR_H

#include "backend.h"

/* X(name in run.cfg, C name) */
#define INTEGRATORS(X) X("leapfrog", leapfrog) X("rk2-adaptive", rk2_adaptive)

struct integrator {
  const char *name, *about;
  int slots; /* saved states it needs (state.h) */
  /* start: brings a fresh state (no rates) to where step can begin. Not called after a restart. */
  int (*start)(Sim *sim, Err *err);
  /* step: advances by *dt, or by less when a limit was violated (then *dt is what was done); leaves
   * the rates for the next step and sim->dt at the step that the scheme's own error control allows
   * (INFINITY: none). */
  int (*step)(Sim *sim, double *dt, Err *err);
  /* potential: phi at the state that step has reached; changes nothing that a later step reads.
   * NULL: step leaves it so. */
  int (*potential)(Sim *sim, Err *err);
};

#define INTEGRATOR_EXTERN(WORD, NAME) extern const struct integrator integrator_##NAME;
INTEGRATORS(INTEGRATOR_EXTERN)
#undef INTEGRATOR_EXTERN

/* integrator_of: the struct of a Param.integrator. */
const struct integrator *integrator_of(int index);

/* integrator_rates: one evaluation of everything at x, v, rho, u, s, h: search, loop A (at y = x),
 * EOS, gravity, loop B. */
int integrator_rates(Sim *sim, Step *step, Err *err);

#endif
