/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Settings that do not go together: a row here, and a run that has them is refused with one line
 * that says which and why. In a condition p is the Param, s the Sim with what its materials are
 * (solid, rare, porous, heated, s.dimension). */
#ifndef CONFLICT_H
#define CONFLICT_H

#include "sim.h"

/* conflict_mirrors: whether a face is a mirror or a no-slip wall. */
static inline int conflict_mirrors(const Param *p)
{
  int any = 0;
  for (int d = 0; d < 3; d++) any |= p->faces[d] != PARAM_OPEN && p->faces[d] != PARAM_PERIODIC;
  return any;
}

/* C(key, other key, condition, why): both cannot be as they are. */
/* clang-format off */
#define CONFLICTS(C) \
  C("gravity.every", "integrator", p->gravity_every > 1 && integrator_of(p->integrator) != &integrator_leapfrog, \
    "only leapfrog kicks with gravity in steps of its own") \
  C("gravity.softening", "gravity.epsilon", \
    p->softening == SOFTENING_PLUMMER && p->gravity != PARAM_NONE && !(p->epsilon > 0), "it needs one length for all") \
  C("escape.from", "gravity.method", p->escape_from == PARAM_DEEPEST && p->gravity == PARAM_NONE, \
    "without self-gravity no particle lies deepest") \
  C("pressure_form", "density", p->pressure == PARAM_PRODUCT && p->density != PARAM_CONTINUITY, \
    "the product goes with the density by continuity") \
  C("stress_form", "density", p->stress_form == PARAM_SQUARES && p->density == PARAM_MISCIBLE_CONTINUITY, \
    "its stress goes with the particles' own volumes") \
  C("form.grad_h", "density", p->grad_h && !param_summed(p), "by continuity density and forces agree as it is") \
  C("form.grad_h", "smoothing.mode", \
    p->grad_h && p->smoothing != PARAM_DENSITY && p->smoothing != PARAM_NEIGHBOURS, "h must follow from the density") \
  C("form.shepard", "density", p->shepard && p->density != PARAM_CONTINUITY, \
    "it is for the density by continuity") \
  C("viscosity.balsara", "viscosity.switch", p->balsara && p->viscosity_switch == RICH_CULLEN_DEHNEN, \
    "it has a limiter of its own") \
  C("stress.artificial", "stress.spacing", p->artificial > 0 && s->rich && !(s->more.over > 0), \
    "particles are farther apart than h") \
  C("step.max", "step.min", p->step_max > 0 && p->step_max <= p->step_min, "no step is left between the two") \
  C("spin.axis", "spin.rate", p->spin_rate > 0 && p->spin_axis[0] == 0 && p->spin_axis[1] == 0 && p->spin_axis[2] == 0, \
    "it is no direction") \
  C("heating.profile", "heating.radius", p->deposit_profile && p->deposit_radius == 0, "it needs a radius") \
  C("heating.begin", "heating.end", p->deposit_begin >= p->deposit_end, "no time is left between the two") \
  C("guard.energy", "energy", p->guard_energy > 0 && p->energy != PARAM_FULL, "energy is not kept then") \
  C("guard.energy", "heating.rate", p->guard_energy > 0 && p->deposit != 0, "energy comes from outside") \
  C("guard.energy", "damping.rate", p->guard_energy > 0 && p->damping > 0, "energy is taken away") \
  C("guard.energy", "walls or a layer", p->guard_energy > 0 && s->hold.on, "they give and take energy") \
  C("guard.momentum", "walls or a layer", p->guard_momentum > 0 && s->hold.on, "they give and take momentum") \
  C("guard.angular_momentum", "walls or a layer", p->guard_angular > 0 && s->hold.on, "they exert torques") \
  C("guard.angular_momentum", "faces of boundary", p->guard_angular > 0 && s->bounds.on, "they exert torques") \
  C("guard.momentum", "a mirror or wall of boundary", p->guard_momentum > 0 && conflict_mirrors(p), "it takes momentum up") \
  CONFLICT_AXES(C)

/* The same for each axis. */
#define CONFLICT_AXES(C) CONFLICT_AXIS(C, "x", 0) CONFLICT_AXIS(C, "y", 1) CONFLICT_AXIS(C, "z", 2)
#define CONFLICT_AXIS(C, X, D) \
  C("boundary." X, "boundary.high", \
    (p->faces[D] == PARAM_PERIODIC || p->faces[D] == PARAM_MIRROR || p->faces[D] == PARAM_NO_SLIP) && !(p->high[D] > p->low[D]), \
    "the upper face must be above the lower one") \
  C("boundary." X, "a run of fewer dimensions", p->faces[D] != PARAM_OPEN && D >= s->s.dimension, \
    "nothing moves along that axis") \
  C("boundary." X, "gravity.method", p->faces[D] != PARAM_OPEN && p->gravity != PARAM_NONE, \
    "images do not pull")

/* U(key, condition, because): the key, when it is not at its default, has no effect on this run
 * because of `because`: a key, whose value is then said, or a reason in words. */
#define UNUSED_SETTINGS(U) \
  U("density_floor", param_summed(p) && p->density_floor <= 1, "density") \
  U("gravity.theta", p->gravity != PARAM_TREE, "gravity.method") \
  U("gravity.G", p->gravity == PARAM_NONE && !s->points.n, "gravity.method") \
  U("gravity.softening", p->gravity == PARAM_NONE, "gravity.method") \
  U("gravity.epsilon", p->gravity == PARAM_NONE, "gravity.method") \
  U("gravity.tolerance", p->gravity_every == 1, "gravity.every") \
  U("gravity.every", p->gravity == PARAM_NONE, "gravity.method") \
  U("smoothing.neighbours", p->smoothing != PARAM_NEIGHBOURS && p->smoothing != PARAM_OVERCORRECTED, "smoothing.mode") \
  U("smoothing.fewest", p->smoothing != PARAM_OVERCORRECTED, "smoothing.mode") \
  U("smoothing.most", p->smoothing != PARAM_OVERCORRECTED, "smoothing.mode") \
  U("smoothing.width", p->smoothing != PARAM_OVERCORRECTED, "smoothing.mode") \
  U("stress_form", s->fluid && !s->solid && !s->viscous, "no matter here has a shear stress") \
  U("form.gradient", !s->tensor, "no matter here needs the gradient of the velocity") \
  U("form.diffusion", p->density != PARAM_CONTINUITY, "density") \
  U("stress.exponent", !(p->artificial > 0), "stress.artificial") \
  U("stress.spacing", !(p->artificial > 0), "stress.artificial") \
  U("viscosity.switch", p->alpha == 0 && p->beta == 0, "no artificial viscosity") \
  U("viscosity.balsara", p->alpha == 0 && p->beta == 0, "no artificial viscosity") \
  U("viscosity.least", p->viscosity_switch == RICH_NONE, "viscosity.switch") \
  U("smoothing.min", p->smoothing == PARAM_FIXED, "smoothing.mode") \
  U("smoothing.max", p->smoothing == PARAM_FIXED, "smoothing.mode") \
  U("disk.point", !s->central, "no law here has a centre") \
  U("sink.rule", !points_sinks(s), "no point mass has a radius") \
  U("sink.every", !points_sinks(s), "no point mass has a radius") \
  U("escape.from", !(p->escape_distance > 0), "escape.distance") \
  U("escape.unbound", !(p->escape_distance > 0), "escape.distance") \
  U("escape.every", !(p->escape_distance > 0), "escape.distance") \
  U("step.points", s->points.n < 2, "there are no two point masses") \
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
  U("step.pressure", !s->crushes, "no pores here begin to crush at a pressure") \
  U("error.position", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("error.velocity", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("error.density", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("error.energy", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("error.stress", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("error.damage", integrator_of(p->integrator) != &integrator_rk2_adaptive, "integrator") \
  U("late.bulk_modulus", p->late_bulk >= s->stiffest, "no material is stiffer") \
  U("late.time", !(p->late_bulk > 0), "late.bulk_modulus") \
  U("late.poisson", !(p->late_bulk > 0), "late.bulk_modulus") \
  U("late.rho_min", !(p->late_bulk > 0), "late.bulk_modulus") \
  U("spin.period", !(p->spin_rate > 0), "spin.rate") \
  U("spin.axis", !(p->spin_rate > 0), "spin.rate") \
  U("spin.axis", p->spin_period == 0, "spin.period") \
  U("damping.radial", !(p->damping > 0), "damping.rate") \
  U("analysis.method", !(p->analysis_every > 0), "analysis.every") \
  U("analysis.criterion", !(p->analysis_every > 0), "analysis.every") \
  U("analysis.points", !(p->analysis_every > 0), "analysis.every") \
  U("analysis.points", !s->points.n, "there are no point masses") \
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
  U("heating.end", p->deposit == 0, "heating.rate") \
  U("boundary.low", !s->bounds.on && !s->hold.on, "no axis of boundary has a face, nor a layer") \
  U("boundary.high", !s->bounds.on && !s->hold.on, "no axis of boundary has a face, nor a layer") \
  U("watch.viscous_work", p->viscous_work && p->energy != PARAM_FULL, "energy") \
  U("layer.strength", !s->hold.on, "there is no layer")
/* clang-format on */

/* conflict_check: the first row of CONFLICTS that holds, as `a = 1 cannot go with b = 2: why`; 0 if
 * there is none, else -1. sim_open calls it. */
int conflict_check(const Param *p, const Sim *s, Err *err);

/* conflict_unused: the same for UNUSED_SETTINGS, as `a = 1 has no effect: b = 2`. Programs call it
 * after sim_open; so tests and other users of the library may leave such keys set. */
int conflict_unused(const Param *p, const Sim *s, Err *err);

#endif
