/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Settings that do not go together: a row here, and a run that has them is refused with one line
 * that says which and why. In a condition p is the Param, s the Sim with what its materials are
 * (solid, rare, porous, heated, s.dimension). */
#ifndef CONFLICT_H
#define CONFLICT_H

#include "sim.h"

/* C(key, other key, condition, why): both cannot be as they are. */
/* clang-format off */
#define CONFLICTS(C) \
  C("gravity.every", "integrator", p->gravity_every > 1 && integrator_of(p->integrator) != &integrator_leapfrog, \
    "only leapfrog kicks with gravity in steps of its own") \
  C("step.max", "step.min", p->step_max > 0 && p->step_max <= p->step_min, "no step is left between the two") \
  C("heating.profile", "heating.radius", p->deposit_profile && p->deposit_radius == 0, "it needs a radius") \
  C("heating.begin", "heating.end", p->deposit_begin >= p->deposit_end, "no time is left between the two")

/* U(key, condition, because): the key, when it is not at its default, has no effect on this run
 * because of `because`: a key, whose value is then said, or a reason in words. */
#define UNUSED_SETTINGS(U) \
  U("density_floor", p->density != PARAM_CONTINUITY && p->density_floor <= 1, "density") \
  U("gravity.theta", p->gravity != PARAM_TREE, "gravity.method") \
  U("gravity.G", p->gravity == PARAM_NONE, "gravity.method") \
  U("gravity.every", p->gravity == PARAM_NONE, "gravity.method") \
  U("smoothing.neighbours", p->smoothing != PARAM_NEIGHBOURS && p->smoothing != PARAM_OVERCORRECTED, "smoothing.mode") \
  U("smoothing.fewest", p->smoothing != PARAM_OVERCORRECTED, "smoothing.mode") \
  U("smoothing.most", p->smoothing != PARAM_OVERCORRECTED, "smoothing.mode") \
  U("smoothing.width", p->smoothing != PARAM_OVERCORRECTED, "smoothing.mode") \
  U("smoothing.min", p->smoothing == PARAM_FIXED, "smoothing.mode") \
  U("smoothing.max", p->smoothing == PARAM_FIXED, "smoothing.mode") \
  U("step.error", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("step.growth", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("step.energy", p->energy == PARAM_FROZEN, "energy") \
  U("step.energy_least", !(p->step_energy > 0), "step.energy") \
  U("step.smoothing", p->smoothing == PARAM_FIXED, "smoothing.mode") \
  U("step.stress", !s->solid, "no material has a deviatoric stress in this run") \
  U("step.stress_least", !(p->step_stress > 0), "step.stress") \
  U("step.damage", !(s->solid && p->damage), "there is no damage in this run") \
  U("step.damage_least", !(p->step_damage > 0), "step.damage") \
  U("step.distention", !s->porous, "no material has pores") \
  U("step.pressure", !s->porous, "no material has pores") \
  U("error.position", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("error.velocity", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("error.density", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("error.energy", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("error.stress", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("error.damage", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("damping.radial", !(p->damping > 0), "damping.rate") \
  U("analysis.method", !(p->analysis_every > 0), "analysis.every") \
  U("analysis.criterion", !(p->analysis_every > 0), "analysis.every") \
  U("analysis.min_particles", !(p->analysis_every > 0), "analysis.every") \
  U("analysis.link", !(p->analysis_every > 0), "analysis.every") \
  U("analysis.link", p->analysis_method != 0, "analysis.method") \
  U("analysis.theta", !(p->analysis_every > 0), "analysis.every") \
  U("analysis.max_virial", !(p->analysis_every > 0), "analysis.every") \
  U("analysis.converged", !(p->analysis_every > 0), "analysis.every") \
  U("analysis.window", !(p->analysis_converged > 0), "analysis.converged") \
  U("analysis.after", !(p->analysis_converged > 0), "analysis.converged") \
  U("viscosity.kinematic", s->solid && !s->fluid, "all matter here has a shear modulus") \
  U("viscosity.shakura_sunyaev", s->solid && !s->fluid, "all matter here has a shear modulus") \
  U("viscosity.aspect", !(p->shakura > 0), "viscosity.shakura_sunyaev") \
  U("viscosity.bulk", s->solid && !s->fluid, "all matter here has a shear modulus") \
  U("viscosity.compression", s->solid && !s->fluid, "all matter here has a shear modulus") \
  U("heating.rate", p->energy != PARAM_FULL, "energy") \
  U("heating.profile", p->deposit == 0, "heating.rate") \
  U("heating.radius", p->deposit == 0, "heating.rate") \
  U("heating.axis", p->deposit_radius == 0, "heating.radius") \
  U("heating.x", p->deposit_radius == 0, "heating.radius") \
  U("heating.y", p->deposit_radius == 0, "heating.radius") \
  U("heating.z", p->deposit_radius == 0, "heating.radius") \
  U("heating.begin", p->deposit == 0, "heating.rate") \
  U("heating.end", p->deposit == 0, "heating.rate")
/* clang-format on */

/* conflict_check: the first row of CONFLICTS that holds, as `a = 1 cannot go with b = 2: why`; 0 if
 * there is none, else -1. sim_open calls it. */
int conflict_check(const Param *p, const Sim *s, Err *err);

/* conflict_unused: the same for UNUSED_SETTINGS, as `a = 1 has no effect: b = 2`. Programs call it
 * after sim_open; so tests and other users of the library may leave such keys set. */
int conflict_unused(const Param *p, const Sim *s, Err *err);

#endif
