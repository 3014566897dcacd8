/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A simulation as a library: what main.c drives for the solver and relax for the relaxation. */
#ifndef SIM_H
#define SIM_H

#include "integrator.h"

/* SIM_FIELDS: what the solver needs of its input. */
#define SIM_FIELDS "id x v m rho u h mat body"

/* sim_open: checks what the solver needs (SIM_FIELDS; density floor, units), parses the materials,
 * gives the particles to the backend named by device ("auto", "cpu", "cuda", "cuda:K") and, unless
 * parts come from a checkpoint, evaluates the first rates. parts stays the caller's. Returns 0 or
 * -1. */
int sim_open(Sim *sim, const Param *par, const Parts *parts, const char *device, Err *err);
void sim_close(Sim *sim);

/* sim_restart: the same from a checkpoint: continues with the rates, step and counters that are in
 * it, bit for bit. */
int sim_restart(Sim *sim, const Param *par, const Parts *parts, const char *device, Err *err);

/* Why the last step was as long as it was. */
typedef struct {
  double dt;  /* s */
  int limit;  /* enum of LIMIT_NAMES, or LIMITS (output), LIMITS + 1 (error control), LIMITS + 2
                 (step.max), LIMITS + 3 (point masses), LIMITS + 4 (step.first) */
  int64_t id; /* the particle, or -1 */
} SimStep;

/* sim_advance: one step, not past `until`. Fills done. Errors name the particle and its state: not
 * finite, density or h not positive, step collapsed. */
int sim_advance(Sim *sim, double until, SimStep *done, Err *err);

/* sim_sums: the sums over all particles, energies and all of the present state. */
int sim_sums(Sim *sim, Sums *out, Err *err);

/* sim_limit_name: the word for conserved.tsv and the log. */
const char *sim_limit_name(int limit);

/* sim_store: the present state into parts, with time and the counters that sim_restart needs. A
 * state that makes no sense is an error as in sim_advance, so that no file ever holds one. */
int sim_store(Sim *sim, Parts *parts, Err *err);

/* sim_send: the first part of it: the state as it is now, on its way. The rest, sim->b->fetch, is
 * for whoever needs parts, also in another thread while the run goes on. */
int sim_send(Sim *sim, Parts *parts, Err *err);

/* sim_step: the numbers of a step of length dt. */
Step sim_step(const Sim *sim, double dt);

/* hold_open: the walls and layers of the settings (hold.h), for these particles. */
int hold_open(Sim *sim, const Parts *parts, Err *err);

#endif
