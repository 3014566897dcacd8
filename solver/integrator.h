/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time integrators: one const struct a scheme, in integrator/. They call passes of the backend and
 * know no particle. */
#ifndef INTEGRATOR_H
#define INTEGRATOR_H

#include "backend.h"

/* X(name in run.cfg, C name) */
/* clang-format off */
#define INTEGRATORS(X) \
  X("leapfrog", leapfrog) X("rk2-adaptive", rk2_adaptive) X("rk3-tvd", rk3_tvd) \
  X("predictor-corrector", predictor_corrector) X("heun-rk4", heun_rk4) X("ab2", ab2) \
  X("euler", euler)
/* clang-format on */

struct integrator {
  const char *name, *about;
  int order;  /* of convergence */
  int slots;  /* saved states it needs (state.h) */
  int memory; /* whether it needs the rates of the step before (fields old_*) */
  /* start: brings a fresh state (no rates) to where step can begin. Not called after a restart. */
  int (*start)(Sim *sim, Err *err);
  /* step: advances by *dt, or by less when a limit was violated (then *dt is what was done); leaves
   * the rates for the next step and sim->dt at the step that the scheme's own error control allows
   * (INFINITY: none). */
  int (*step)(Sim *sim, double *dt, Err *err);
  /* potential: phi at the state that step has reached; changes nothing that a later step reads.
   * NULL: step leaves it so. */
  int (*potential)(Sim *sim, Err *err);
  /* substeps: into how many steps of their own point masses may divide one of the particles; 0:
   * they take the same, by the same scheme. */
  int substeps;
};

#define INTEGRATOR_EXTERN(WORD, NAME) extern const struct integrator integrator_##NAME;
INTEGRATORS(INTEGRATOR_EXTERN)
#undef INTEGRATOR_EXTERN

/* integrator_of: the struct of a Param.integrator. */
const struct integrator *integrator_of(int index);

/* integrator_gravity: adds what acts from afar to the accelerations: self-gravity, body force. */
int integrator_gravity(Sim *sim, Err *err);

/* integrator_rates: one evaluation of everything at x, v, rho, u, s, h: search, loop A (at y = x),
 * EOS, gravity, loop B. */
int integrator_rates(Sim *sim, Step *step, Err *err);

/* What schemes share that put states and rates aside (state.h: saved[0] the state that a step
 * begins with, saved[1] to saved[3] rates). */

/* integrator_begin: their start. */
int integrator_begin(Sim *sim, Err *err);

/* integrator_save: the present state into saved[0]. */
void integrator_save(Sim *sim);

/* integrator_stage: evaluates the rates of the present state, damped, into saved[slot]. */
int integrator_stage(Sim *sim, Step *step, int slot, Err *err);

/* integrator_combine: state = saved[0] + dt sum_k weight[k] saved[1 + k]. */
void integrator_combine(Sim *sim, Step *step, const double weight[3]);

/* integrator_stages: a Runge-Kutta step, stage by stage from saved[0]; row k of the weights makes
 * the state after evaluation k, the last row that of the step's end. */
int integrator_stages(Sim *sim, Step *step, const double (*weight)[3], int stages, Err *err);

/* integrator_settle: EOS, yield and h of the state that the step has reached; accelerations and
 * limits that the run loop looks at, from the last evaluation. */
void integrator_settle(Sim *sim, double dt);

/* integrator_potential: the potential of that state, as the last evaluation was at another. */
int integrator_potential(Sim *sim, Err *err);

#endif
