/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Opening, advancing and storing a simulation, whatever the backend and the integrator. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../lib/material.h"
#include "conflict.h"
#include "late.h"
#include "sim.h"

static const char *const bad_names[] = {"nothing",
                                        "position is not finite",
                                        "velocity is not finite",
                                        "density is not positive",
                                        "internal energy is not finite",
                                        "smoothing length is not positive",
                                        "acceleration is not finite",
                                        "stress is not finite"};

/* The energy from outside in a step that begins now: what of it lies within begin and end. */
static Deposit deposit_of(const Sim *sim, double dt)
{
  const Param *p = &sim->par;
  const double from = fmax(sim->time, p->deposit_begin), to = fmin(sim->time + dt, p->deposit_end);
  Deposit q = {0, {0, 0, 0}, p->deposit_radius, p->deposit_profile, p->deposit_axis};
  memcpy(q.centre, p->deposit_centre, sizeof q.centre);
  if (dt > 0 && to > from) q.rate = p->deposit * (to - from) / dt;
  return q;
}

/* The rotation that bodies are brought to. */
static void spin_of(const Param *p, Step *k)
{
  const double *a = p->spin_axis, length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  k->spin_rate = p->spin_rate;
  for (int d = 0; d < 3 && p->spin_period != 0; d++)
    k->spin[d] = 2 * 3.14159265358979323846 / p->spin_period * a[d] / length;
}

Step sim_step(const Sim *sim, double dt)
{
  const Param *p = &sim->par;
  Step k;
  memset(&k, 0, sizeof k);
  k.dt = dt;
  k.volumes = p->pressure == PARAM_PRODUCT, k.density = p->density, k.summed = param_summed(p),
  k.energy = p->energy, k.smoothing = p->grad_h ? PARAM_DENSITY : p->smoothing;
  k.strength = sim->solid, k.damage = sim->solid && p->damage && !sim->late;
  k.neighbours = p->neighbours, k.h_min = p->h_min, k.h_max = p->h_max;
  k.density_floor = p->density_floor, k.energy_floor = p->energy_floor;
  k.outer = p->outer_pressure;
  k.self = kernel_sigma(p->kernel, sim->s.dimension) * kernel_w(p->kernel, sim->s.dimension, 0);
  k.cfl = p->cfl, k.acceleration = p->step_acceleration;
  k.step_density = p->step_density;
  k.limit[LIMIT_ENERGY] = p->step_energy, k.limit[LIMIT_SMOOTHING] = p->step_smoothing;
  k.limit[LIMIT_STRESS] = p->step_stress, k.limit[LIMIT_DAMAGE] = p->step_damage;
  k.limit[LIMIT_DISTENTION] = p->step_distention, k.limit[LIMIT_PRESSURE] = p->step_pressure;
  for (int c = 0; c < LIMITS; c++) k.limited |= k.limit[c] > 0;
  k.energy_least = p->energy_least, k.stress_least = p->stress_least;
  k.damage_least = p->damage_least;
  k.few = p->fewest * p->neighbours, k.many = p->most * p->neighbours, k.width = p->width;
  k.dilation = sim->dilation;
  k.error.x = p->error_position / p->step_error, k.error.v = p->error_velocity / p->step_error;
  k.error.rho = p->error_density / p->step_error, k.error.u = p->error_energy / p->step_error;
  k.error.s = p->error_stress / p->step_error, k.error.crack = p->error_damage / p->step_error;
  k.damping = p->damping, k.damping_radial = p->damping_radial;
  k.framed = p->damping > 0 || p->spin_rate > 0;
  spin_of(p, &k);
  k.viscous = sim->viscous, k.rich = sim->rich, k.more = rich_step(sim);
  k.fluid = (Fluid){p->shear, p->bulk, p->shakura, p->aspect, p->compression};
  k.deposit = deposit_of(sim, dt);
  k.hold = sim->hold;
  return k;
}

/* h_min and h_max are given in units of the smallest and the largest h of the input. */
static void smoothing_range(Sim *sim, const Parts *p)
{
  double low = INFINITY, high = 0;
  for (long i = 0; i < p->n; i++) low = fmin(low, p->h[i]), high = fmax(high, p->h[i]);
  sim->par.h_min *= low, sim->par.h_max *= high;
}

/* The faces of the box. */
static void set_bounds(Sim *sim, const Param *p)
{
  static const struct {
    int low, high;
  } KIND[] = {[PARAM_OPEN] = {BOUNDS_OPEN, BOUNDS_OPEN},
              [PARAM_PERIODIC] = {BOUNDS_PERIODIC, BOUNDS_PERIODIC},
              [PARAM_MIRROR] = {BOUNDS_MIRROR, BOUNDS_MIRROR},
              [PARAM_MIRROR_LOW] = {BOUNDS_MIRROR, BOUNDS_OPEN},
              [PARAM_MIRROR_HIGH] = {BOUNDS_OPEN, BOUNDS_MIRROR},
              [PARAM_NO_SLIP] = {BOUNDS_NO_SLIP, BOUNDS_NO_SLIP},
              [PARAM_NO_SLIP_LOW] = {BOUNDS_NO_SLIP, BOUNDS_OPEN},
              [PARAM_NO_SLIP_HIGH] = {BOUNDS_OPEN, BOUNDS_NO_SLIP}};
  Bounds *b = &sim->bounds;
  for (int d = 0; d < 3; d++) {
    const int faces = p->faces[d];
    b->low[d] = KIND[faces].low, b->high[d] = KIND[faces].high;
    b->lo[d] = p->low[d], b->hi[d] = p->high[d];
    b->on |= faces != PARAM_OPEN;
  }
}

static int open_common(Sim *sim, const Param *par, const Parts *p, const char *device, Err *err)
{
  memset(sim, 0, sizeof *sim);
  if (part_need(p, SIM_FIELDS, "input", err) || part_check(p, "input", err)) return -1;
  if (!(sim->b = backend_find(device, &sim->card, err))) return -1;
  for (long i = 0; i < p->n && (par->damping > 0 || par->spin_rate > 0); i++)
    if (p->body[i] < 0 || p->body[i] >= BODIES)
      return err_set(err, "particle %lld is of body %d: damping and spin know bodies 0 to %d",
                     (long long)p->id[i], (int)p->body[i], BODIES - 1);
  sim->par = *par;
  sim->pull_due = 1;
  sim->time = p->time;
  sim->materials = p->materials;
  sim->slots = integrator_of(par->integrator)->slots;
  sim->memory = integrator_of(par->integrator)->memory;
  set_bounds(sim, par);
  if (hold_open(sim, p, err)) return -1;
  sim->miscible = par->density == PARAM_MISCIBLE || par->density == PARAM_MISCIBLE_CONTINUITY;
  if (!(sim->material = material_load(p, err))) return -1;
  for (int k = 0; k < p->materials; k++) {
    const Material *m = &sim->material[k];
    if (par->strength && m->mu > 0)
      sim->solid = 1;
    else
      sim->fluid = 1;
    sim->stiffest = fmax(sim->stiffest, eos_bulk(&m->eos));
    sim->rare |= material_rare(m);
    sim->porous |= material_distends(m);
    sim->crushes |= m->porosity.start > 0;
    sim->heated |= par->strength && material_heats(m);
    sim->central |= m->eos.form == EOS_LOCAL_ISOTHERMAL || par->shakura > 0;
  }
  sim->viscous = par->shear > 0 || par->bulk > 0 || par->shakura > 0 || par->compression > 0;
  rich_open(sim, p);
  sim->tensor = sim->solid || sim->viscous || sim->rich;
  sim->s.dimension = p->dimension;
  return points_open(sim, p, err) || conflict_check(par, sim, err) ? -1 : 0;
}

/* A porous particle without Distention must have the density of its bulk. */
static int bulk_check(const Sim *sim, const Parts *p, long i, Err *err)
{
  const Material *m = &sim->material[p->mat[i]];
  double rho0 = eos_rho0(&m->eos), alpha = material_distention(m);
  if (p->rho[i] <= 0.5 * rho0 * (1 + 1 / alpha) || alpha <= 1) return 0;
  return err_set(
      err,
      "particle %lld has no Distention, and with %g kg/m^3 it is as dense as the solid of "
      "'%s': its bulk has %g",
      (long long)p->id[i], p->rho[i], p->material[p->mat[i]].name, rho0 / alpha);
}

/* hand_over: the particles to the backend; what a material begins with where the file says nothing
 * (no such field, or 0, as it is where bodies were joined) is filled in before. */
static int hand_over(Sim *sim, const Parts *p, Err *err)
{
  Parts whole = *p;
  const Step k = sim_step(sim, 0);
  size_t n = (size_t)p->n;
  double *T = sim->heated ? calloc(n + 1, sizeof *T) : NULL;
  double *alpha = sim->porous ? calloc(n + 1, sizeof *alpha) : NULL;
  int bad = (sim->heated && !T) || (sim->porous && !alpha);
  if (bad) err_set(err, "not enough memory for %ld particles", p->n);
  for (long i = 0; !bad && i < p->n; i++) {
    const Material *m = &sim->material[p->mat[i]];
    if (T) T[i] = p->T && p->T[i] > 0 ? p->T[i] : material_heats(m) ? m->yield.johnson_cook.T0 : 0;
    if (!alpha) continue;
    alpha[i] = p->alpha && p->alpha[i] >= 1 ? p->alpha[i] : material_distention(m);
    if (!(p->alpha && p->alpha[i] >= 1)) bad = bulk_check(sim, p, i, err);
  }
  if (T) whole.T = T;
  if (alpha) whole.alpha = alpha;
  bad = bad || sim->b->open(sim, &whole, err);
  free(T), free(alpha);
  memcpy(sim->s.force, sim->par.force, sizeof sim->s.force);
  sim->s.sheet = sim->par.gradient_raw ? INFINITY : 0.01;
  sim->s.margin = sim->par.grad_h ? GRAD_MARGIN : 0;
  sim->s.integrated = sim->par.density == PARAM_MISCIBLE_CONTINUITY;
  sim->s.floors = (Floors){sim->par.pressure_floor > -1e300, sim->par.pressure_floor,
                           sim->par.energy_floor, k.density_floor * k.self};
  return bad ? -1 : 0;
}

/* What has left the box comes back. */
static void fold(Sim *sim)
{
  const Step k = sim_step(sim, 0);
  if (sim->bounds.on) sim->b->pass(sim, PASS_FOLD, &k);
}

/* Walls begin to move. */
static void hold(Sim *sim)
{
  const Step k = sim_step(sim, 0);
  if (sim->hold.walls) sim->b->pass(sim, PASS_HOLD, &k);
}

/* Nothing can be behind a mirror or a wall. */
static int inside(const Bounds *b, const Parts *p, Err *err)
{
  double plane;
  for (long i = 0; i < p->n && b->on; i++)
    for (int d = 0; d < 3; d++)
      if (bounds_beyond(b, d, p->x[3 * i + d], &plane))
        return err_set(err, "particle %lld is at %c = %g m, behind the face at %g",
                       (long long)p->id[i], "xyz"[d], p -> x[3 * i + d], plane);
  return 0;
}

int sim_open(Sim *sim, const Param *par, const Parts *p, const char *device, Err *err)
{
  memset(sim, 0, sizeof *sim);
  if (p->points && par->points)
    return err_set(err, "the input has %d point mass(es) already, and the settings list %d",
                   p->points, par->points);
  if (open_common(sim, par, p, device, err) || inside(&sim->bounds, p, err))
    return sim_close(sim), -1;
  smoothing_range(sim, p);
  if (hand_over(sim, p, err)) return sim_close(sim), -1;
  fold(sim), hold(sim);
  if (grad_open(sim, err)) return sim_close(sim), -1;
  if (integrator_of(sim->par.integrator)->start(sim, err)) return sim_close(sim), -1;
  return 0;
}

/* Where in its steps gravity stands. */
static int restart_outer(Sim *sim, const Parts *p, Err *err)
{
  double step = part_number(p, "run", "OuterStep"), steps = part_number(p, "run", "OuterSteps");
  if (part_need(p, "pull", "checkpoint", err)) return -1;
  sim->outer_time = part_number(p, "run", "OuterTime");
  sim->outer_kick = part_number(p, "run", "OuterKick");
  sim->outer_span = part_number(p, "run", "OuterSpan");
  if (!(step >= 0 && steps >= 0 && sim->outer_time >= 0 && sim->outer_kick >= 0 &&
        sim->outer_span >= 0))
    return err_set(err, "the checkpoint lacks the attributes of /Run for gravity.every");
  sim->outer = (int)step, sim->outer_steps = (int)steps;
  return 0;
}

static const char memory[] = "old_x old_v old_rho old_u old_s old_crack old_h";

/* What files hold of this run besides. */
static const char *also_stored(const Sim *sim, char text[64])
{
  snprintf(text, 64, "%s%s%s%s", sim->porous ? "alpha dalpha " : "", sim->heated ? "T Tmax " : "",
           sim->par.viscous_work ? "shock " : "", sim->par.energy_floor > -1e300 ? "lifted" : "");
  return text;
}

int sim_restart(Sim *sim, const Param *par, const Parts *p, const char *device, Err *err)
{
  char also[64], names[RICH_NAMES];
  if (open_common(sim, par, p, device, err)) return sim_close(sim), -1;
  if (part_need(p, "a dudt dqdt divv p cs s nact signal dcrack nngb", "checkpoint", err))
    return sim_close(sim), -1;
  if (part_need(p, also_stored(sim, also), "checkpoint", err) ||
      part_need(p, rich_fields(sim, names), "checkpoint", err))
    return sim_close(sim), -1;
  sim->par.h_min = part_number(p, "run", "SmoothingMin"),
  sim->par.h_max = part_number(p, "run", "SmoothingMax");
  if (par->artificial > 0) sim->par.spacing = part_number(p, "run", "StressSpacing");
  if (par->grad_h) sim->par.eta = part_number(p, "run", "SmoothingEta");
  rich_open(sim, p);
  sim->dt = part_number(p, "run", "NextStep");
  sim->step = (long)part_number(p, "run", "Step");
  if (sim->memory) {
    if (part_need(p, memory, "checkpoint", err)) return sim_close(sim), -1;
    sim->dt_before = part_number(p, "run", "LastStep");
  }
  if (!(sim->dt > 0) || !(sim->par.h_min > 0)) {
    sim_close(sim);
    return err_set(
        err, "the checkpoint lacks the attributes of /Run: it is a snapshot, not a checkpoint");
  }
  if ((par->gravity_every > 1 && restart_outer(sim, p, err)) || leave_load(sim, p, err))
    return sim_close(sim), -1;
  if (hand_over(sim, p, err) || (part_number(p, "run", "Late") > 0 && late_soften(sim, err)))
    return sim_close(sim), -1;
  return 0;
}

void sim_close(Sim *sim)
{
  if (sim->b && sim->own) sim->b->close(sim);
  material_free(sim->material, sim->materials);
  sim->material = NULL;
}

const char *sim_limit_name(int limit)
{
  static const char *const names[] = {
#define SIM_LIMIT(CAPITAL, NAME) NAME,
      LIMIT_NAMES(SIM_LIMIT)
#undef SIM_LIMIT
          "output",
      "error", "max", "points", "first"};
  return limit >= 0 && limit < LIMITS + 5 ? names[limit] : "?";
}

/* What a file of the solver holds. */
static const char stored[] = "id x v m rho u h mat body p cs s damage nact phi pmax strain nngb a "
                             "dudt dqdt divv delta signal dcrack";

/* The criteria of the present state, which must make sense. */
static int limits_of(Sim *sim, Limits *l, Err *err)
{
  Step k = sim_step(sim, 0);
  char look[512];
  if (sim->b->limits(sim, &k, l, err)) return -1;
  if (k.smoothing == PARAM_OVERCORRECTED && k.limit[LIMIT_SMOOTHING] > 0) { /* of this dilation */
    k.dilation = l->dilation;
    if (sim->b->limits(sim, &k, l, err)) return -1;
  }
  if (l->bad < 0) return 0;
  backend_look(sim, l->bad, look, sizeof look);
  return err_set(err, "the state broke down at t = %.9g s, step %ld: %s: %s", sim->time, sim->step,
                 bad_names[l->bad_reason], look);
}

/* The next step as the criteria have it, and who says so. */
static int next_limits(Sim *sim, SimStep *next, Err *err)
{
  Limits l;
  if (limits_of(sim, &l, err)) return -1;
  next->dt = l.dt, next->limit = l.dt < INFINITY ? l.which : LIMITS + 2, next->id = l.id;
  sim->dilation = l.dilation;
  if (points_limit(sim) < next->dt)
    next->dt = points_limit(sim), next->limit = LIMITS + 3, next->id = -1;
  return 0;
}

/* Whether the next step, dt of what is left to an output, ends with an evaluation of gravity: every
 * so many steps, at log lines, and close to an output in each step, as dt is cut there. */
static void plan_gravity(Sim *sim, double dt, double left)
{
  const Param *p = &sim->par;
  if (sim->outer == 0) {
    long log = p->log_every - sim->step % p->log_every;
    sim->outer_steps = log < p->gravity_every ? (int)log : p->gravity_every;
    if (p->gravity_tolerance > 0 && sim->outer_span < sim->outer_steps * dt)
      sim->outer_steps = sim->outer_span > dt ? (int)(sim->outer_span / dt) : 1;
    if (left < ((p->gravity_tolerance > 0 ? sim->outer_steps : p->gravity_every) + 1) * dt)
      sim->outer_steps = 1;
  }
  sim->pull_due =
      dt >= left || sim->outer + 1 >= sim->outer_steps ||
      (p->gravity_tolerance > 0 && sim->outer_time + 2 * dt > fmax(sim->outer_span, dt));
}

/* After an evaluation of gravity and a step dt: how long the next change will take. As rates change
 * on the way it aims at half the tolerance, and lets the time grow by half and a step at most. */
static int plan_span(Sim *sim, double dt, Err *err)
{
  if (!(sim->par.gravity_tolerance > 0) || sim->outer > 0) return 0;
  if (sim->b->change(sim, &sim->pull_change, err)) return -1;
  sim->outer_span =
      fmin(1.5 * sim->pull_time + dt,
           0.5 * sim->pull_time * sim->par.gravity_tolerance / fmax(sim->pull_change, 1e-300));
  return 0;
}

int sim_advance(Sim *sim, double until, SimStep *done, Err *err)
{
  const struct integrator *in = integrator_of(sim->par.integrator);
  double left, dt;
  char look[512] = "";
  until = late_until(sim, until), left = until - sim->time;
  if (late_due(sim) && (late_enter(sim, err) || in->start(sim, err))) return -1;
  if (next_limits(sim, done, err)) return -1;
  if (sim->dt > 0 && sim->dt < done->dt)
    done->dt = sim->dt, done->limit = LIMITS + 1, done->id = -1;
  if (sim->par.step_max > 0 && sim->par.step_max < done->dt)
    done->dt = sim->par.step_max, done->limit = LIMITS + 2, done->id = -1;
  if (sim->par.step_first > 0 && sim->step == 0 && sim->par.step_first < done->dt)
    done->dt = sim->par.step_first, done->limit = LIMITS + 4, done->id = -1;
  if (!(done->dt > sim->par.step_min)) {
    if (done->id >= 0) backend_look(sim, done->id, look, sizeof look);
    return err_set(err, "the time step collapsed to %.3g s (%s) at t = %.9g s: %s", done->dt,
                   sim_limit_name(done->limit), sim->time, look);
  }
  if (left <= done->dt)
    done->dt = left, done->limit = LIMITS, done->id = -1;
  else if (left < 2 * done->dt)
    done->dt = 0.5 * left;
  dt = done->dt;
  plan_gravity(sim, dt, left);
  if (in->step(sim, &dt, err)) return -1;
  fold(sim);
  if (dt < done->dt) done->limit = LIMITS + 1, done->id = -1;
  if (plan_span(sim, dt, err)) return -1;
  done->dt = sim->dt_before = dt;
  sim->time = dt >= left ? until : sim->time + dt;
  sim->step++;
  return 0;
}

int sim_sums(Sim *sim, Sums *out, Err *err)
{
  const struct integrator *in = integrator_of(sim->par.integrator);
  if ((in->potential && in->potential(sim, err)) || sim->b->sums(sim, out, err)) return -1;
  points_sums(sim, out);
  return 0;
}

int sim_send(Sim *sim, Parts *p, Err *err)
{
  Limits l;
  char also[64], names[RICH_NAMES];
  if (limits_of(sim, &l, err) || part_add(p, stored, err) ||
      part_add(p, rich_fields(sim, names), err) ||
      (sim->par.gravity_every > 1 && part_add(p, "pull", err)) ||
      part_add(p, also_stored(sim, also), err) ||
      (sim->memory &&
       (part_add(p, memory, err) || part_set_number(p, "run", "LastStep", sim->dt_before, err))) ||
      points_store(sim, p, err) || leave_store(sim, p, err) || sim->b->store(sim, p, err))
    return -1;
  p->time = sim->time;
  if (sim->late && part_set_number(p, "run", "Late", 1, err)) return -1;
  if (sim->par.grad_h && part_set_number(p, "run", "SmoothingEta", sim->par.eta, err)) return -1;
  if (sim->par.artificial > 0 && part_set_number(p, "run", "StressSpacing", sim->par.spacing, err))
    return -1;
  if (sim->par.gravity_every > 1 &&
      (part_set_number(p, "run", "OuterStep", sim->outer, err) ||
       part_set_number(p, "run", "OuterSteps", sim->outer_steps, err) ||
       part_set_number(p, "run", "OuterTime", sim->outer_time, err) ||
       part_set_number(p, "run", "OuterSpan", sim->outer_span, err) ||
       part_set_number(p, "run", "OuterKick", sim->outer_kick, err)))
    return -1;
  return part_set_number(p, "run", "SmoothingMin", sim->par.h_min, err) |
         part_set_number(p, "run", "SmoothingMax", sim->par.h_max, err) |
         part_set_number(p, "run", "NextStep", sim->dt, err) |
         part_set_number(p, "run", "Step", (double)sim->step, err);
}

int sim_store(Sim *sim, Parts *p, Err *err)
{
  return sim_send(sim, p, err) || sim->b->fetch(sim, p, err) ? -1 : 0;
}
