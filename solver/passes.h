/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The per-particle passes: the list, and what each does to particle i. A backend stamps a loop a
 * pass. What is once per particle (which laws) is a switch in here; what is once per run (modes) is
 * a number in Step. */
#ifndef PASSES_H
#define PASSES_H

#include "fold.h"
#include "record.h"

/* passes_work: (-p div v + S:e)/rho [W/kg] of i with p and S as damage leaves them (001 eq. 5, 20,
 * 21). */
HD double passes_work(const State *s, long i, double p, Sym dev, double rho, int solid)
{
  const double *g = &s->g[9 * i], damage = s->damage[i];
  double w = -(p < 0 ? (1 - damage) * p : p) * s->divv[i];
  if (solid)
    w += damage_shear(&s->material[s->mat[i]].damage, damage) *
         tensor_dot(dev, passes_strain_rate(g));
  return w / rho;
}

/* passes_deposit: the energy that i receives from outside in this step [J/kg]. */
HD double passes_deposit(const State *s, const Step *k, long i)
{
  return k->deposit.rate != 0 ? k->dt * fluid_deposit(&k->deposit, &s->x[3 * i]) : 0;
}

/* passes_outer: the part of du/dt [W/kg] that the force loop lacks: work against the pressure
 * outside, at a density. */
HD double passes_outer(const State *s, const Step *k, long i, double rho)
{
  return k->outer > 0 ? -k->outer * s->divv[i] / rho : 0;
}

/* passes_kick: the acceleration of a kick, component j: gravity counts 1 + k->pull times. */
HD double passes_kick(const State *s, const Step *k, long j)
{
  return k->pull != 0 ? s->a[j] + k->pull * s->pull[j] : s->a[j];
}

/* kick: v += a dt. */
HD void pass_kick(const State *s, const Step *k, long i)
{
  for (int d = 0; d < 3; d++) s->v[3 * i + d] += passes_kick(s, k, 3 * i + d) * k->dt;
}

/* passes_swell: dln(h)/dt as h follows the density (004 eq. 2.36); with too few or too many
 * neighbours it grows or shrinks as fast as anything does (004 eq. 2.37, 2.38, with the largest
 * |div v| of this step). */
HD double passes_swell(const State *s, const Step *k, long i)
{
  double rate = s->divv[i] / s->dimension, low, high;
  if (k->smoothing != 3) return rate;
  low = 0.5 * (1 - tanh((s->nngb[i] - k->few) / k->width));
  high = 0.5 * (1 + tanh((s->nngb[i] - k->many) / k->width));
  return (low - high) * k->dilation + (1 - low - high) * rate;
}

/* passes_follow: h after dt at that rate, within its limits. */
HD double passes_follow(const State *s, const Step *k, long i, double h, double dt)
{
  h *= exp(passes_swell(s, k, i) * dt);
  return h < k->h_min ? k->h_min : h > k->h_max ? k->h_max : h;
}

/* passes_crowd: the factor on h that goes towards the wanted number of neighbours (001 eq. 73), at
 * most 5 % a step. */
HD double passes_crowd(const State *s, const Step *k, long i)
{
  int n = s->nngb[i] > 0 ? s->nngb[i] : 1;
  double want = 0.5 * (1 + pow(k->neighbours / n, 1. / s->dimension));
  if (k->smoothing != 2) return 1;
  return want > 1.05 ? 1.05 : want < 0.95 ? 0.95 : want;
}

/* passes_motion: the velocity that a particle moves with, component j (001 eq. 40). */
HD double passes_motion(const State *s, long j)
{
  return s->wander ? s->v[j] + s->wander[j] : s->v[j];
}

/* drift: x to the end of the step, y at its middle for loop A, density and h predicted there, h at
 * the end with the divergence of the step before, and the velocity predicted for loop B. */
HD void pass_drift(const State *s, const Step *k, long i)
{
  double half = 0.5 * k->dt, h;
  for (int d = 0; d < 3; d++) {
    const double v = passes_motion(s, 3 * i + d);
    s->y[3 * i + d] = s->x[3 * i + d] + v * half;
    s->x[3 * i + d] += v * k->dt;
    s->vp[3 * i + d] = s->v[3 * i + d] + passes_kick(s, k, 3 * i + d) * half;
  }
  s->rhoa[i] = s->rho[i] * exp(-s->divv[i] * half);
  s->ha[i] = s->h[i];
  if (k->smoothing == 0) return;
  h = s->h[i] * passes_crowd(s, k, i);
  s->ha[i] = passes_follow(s, k, i, h, half);
  s->h[i] = passes_follow(s, k, i, h, k->dt);
}

/* passes_density: rho after dt by continuity; with a kernel sum it is there already. Never less
 * than a lone particle's own kernel makes, m W(0), times density_floor: volumes m/rho of
 * expanding debris stay bounded. */
HD void passes_density(const State *s, const Step *k, long i)
{
  double h = s->h[i], floor = k->density_floor * k->self * s->m[i] /
                              (s->dimension == 3   ? h * h * h
                               : s->dimension == 2 ? h * h
                                                   : h);
  if (!k->summed) s->rho[i] *= exp(-s->divv[i] * k->dt);
  if (s->drho) s->rho[i] += s->drho[i] * k->dt;
  if (s->rho[i] < floor) s->rho[i] = floor;
}

/* advance: after loop A, takes rho, S and D to the end of the step; the energy there is predicted
 * from the local work, once with the old pressure and once with the mean of both; then EOS, yield,
 * damage, and what the force loop needs. */
HD void pass_advance(const State *s, const Step *k, long i)
{
  const double *g = &s->g[9 * i], mu = k->strength ? s->material[s->mat[i]].mu : 0;
  const double alpha = matter_distention(s, i);
  int solid = mu > 0;
  double p = s->p[i], u = s->u[i] + passes_deposit(s, k, i), work;
  const double heat = k->energy == 0 ? s->dqdt[i] : 0;
  Sym old = passes_own_stress(s, i, solid), mid = old;
  passes_density(s, k, i);
  if (solid) {
    Sym now = passes_elastic(old, g, matter_shear(s, i), k->dt);
    passes_keep_stress(&s->s[6 * i], now);
    mid = tensor_scale(tensor_axpy(old, 1, now), 0.5);
  }
  if (k->energy == 2) {
    matter_eos(s, i, u, k->strength);
  } else {
    solid = solid && k->energy == 0;
    work = passes_work(s, i, p, mid, s->rhoa[i], solid);
    matter_eos(s, i, u + k->dt * (work + heat), k->strength);
    if (s->rare && s->alpha) s->alpha[i] = alpha;
    work = passes_work(s, i, 0.5 * (p + s->p[i]), mid, s->rhoa[i], solid);
    matter_eos(s, i, u + k->dt * (work + heat), k->strength);
  }
  if (s->rare && s->alpha) matter_compact(s, i, alpha, mu > 0, k->damage);
  if (s->rare && s->alpha) s->dalpha[i] = k->dt > 0 ? (s->alpha[i] - alpha) / k->dt : 0;
  if (mu > 0) matter_yield(s, i, 1, k->dt * heat + passes_deposit(s, k, i), k->dt);
  if (k->damage) passes_damage(s, i, k->dt);
  passes_pack(s, k, i, mu > 0, 0.5 * k->dt);
}

/* passes_damp: -(v - v_frame)/tau, radial part only or all of it, in the co-rotating frame of the
 * particle's body (docs/theory.md 6.3). */
HD void passes_damp(const State *s, const Step *k, long i, double *acc)
{
  int b = s->body[i] >= 0 && s->body[i] < BODIES ? s->body[i] : 0;
  const double *w = k->omega[b];
  double r[3], v[3], r2 = 0, vr = 0, f;
  if (hold_wall(s, &k->hold, i)) return;
  for (int d = 0; d < 3; d++) r[d] = s->x[3 * i + d] - k->centre[b][d];
  v[0] = w[1] * r[2] - w[2] * r[1], v[1] = w[2] * r[0] - w[0] * r[2],
  v[2] = w[0] * r[1] - w[1] * r[0];
  for (int d = 0; d < 3; d++) {
    v[d] = s->vp[3 * i + d] - k->velocity[b][d] - v[d];
    r2 += r[d] * r[d], vr += v[d] * r[d];
  }
  f = k->damping_radial && r2 > 0 ? vr / r2 : 0;
  for (int d = 0; d < 3; d++) acc[d] -= k->damping * (k->damping_radial ? f * r[d] : v[d]);
}

/* passes_viscous: what of du/dt is not local work: viscosity, mostly [W/kg]. */
HD double passes_viscous(const State *s, const Step *k, long i, int solid)
{
  return s->du[i] + passes_outer(s, k, i, s->rho[i]) -
         passes_work(s, i, s->p[i], passes_own_stress(s, i, solid), s->rho[i], solid);
}

/* passes_lift: the floor of the energy, and what it adds to an energy u. */
HD void passes_lift(const State *s, const Step *k, long i, double u)
{
  if (!(u < k->energy_floor)) return;
  s->u[i] = k->energy_floor;
  if (s->lifted) s->lifted[i] += k->energy_floor - u;
}

/* passes_spin: rate (W - omega) x r about the centre of the particle's body: a torque I (W -
 * omega) rate and no force, so omega' = rate (W - omega). */
HD void passes_spin(const State *s, const Step *k, long i, double *acc)
{
  const int b = s->body[i] >= 0 && s->body[i] < BODIES ? s->body[i] : 0;
  double r[3], w[3];
  for (int d = 0; d < 3; d++) {
    r[d] = s->x[3 * i + d] - k->centre[b][d];
    w[d] = k->spin_rate * (k->spin[d] - k->omega[b][d]);
  }
  acc[0] += w[1] * r[2] - w[2] * r[1], acc[1] += w[2] * r[0] - w[0] * r[2];
  acc[2] += w[0] * r[1] - w[1] * r[0];
}

/* finish: after loop B and gravity: closes the kick and the energy, keeps the rates for the next
 * step: du, and what of it is not local work (viscosity, mostly), so that the next prediction of
 * the energy is as du and stays of second order. h follows with the divergence of this step only
 * now (ha^2/h is what it began with): up to here it is the one that neighbours were searched with,
 * so that each list holds whoever interacts, and both of a pair have it. */
HD void pass_finish(const State *s, const Step *k, long i)
{
  double half = 0.5 * k->dt, mu = k->strength ? s->material[s->mat[i]].mu : 0;
  if (k->damping > 0) passes_damp(s, k, i, &s->acc[3 * i]);
  if (k->spin_rate > 0) passes_spin(s, k, i, &s->acc[3 * i]);
  for (int d = 0; d < 3; d++) {
    s->a[3 * i + d] = s->acc[3 * i + d];
    s->v[3 * i + d] += passes_kick(s, k, 3 * i + d) * half;
  }
  if (k->energy == 0) s->u[i] += half * (s->dudt[i] + s->du[i]);
  if (k->energy == 0 && k->outer > 0) s->u[i] += k->dt * passes_outer(s, k, i, s->rhoa[i]);
  if (k->deposit.rate != 0) s->u[i] += passes_deposit(s, k, i);
  if (k->energy == 1) s->u[i] = s->ue[i];
  if (s->shock && k->energy == 0) s->shock[i] += half * s->dqdt[i];
  passes_lift(s, k, i, s->u[i]);
  s->dudt[i] = s->du[i];
  s->dqdt[i] = passes_viscous(s, k, i, mu > 0);
  if (s->shock && k->energy == 0) s->shock[i] += half * s->dqdt[i];
  if (s->p[i] > s->pmax[i]) s->pmax[i] = s->p[i];
  if (s->Tmax && s->T[i] > s->Tmax[i]) s->Tmax[i] = s->T[i];
  if (k->more.viscosity && k->dt == 0) s->div0[i] = s->divv[i];
  if (k->smoothing && k->dt > 0 && !s->omega)
    s->h[i] = passes_follow(s, k, i, s->ha[i] * s->ha[i] / s->h[i], k->dt);
}

/* still: before an evaluation with everything at one instant: loop A at x, loop B with v. */
HD void pass_still(const State *s, const Step *k, long i)
{
  (void)k;
  for (int d = 0; d < 3; d++) s->y[3 * i + d] = s->x[3 * i + d], s->vp[3 * i + d] = s->v[3 * i + d];
  s->rhoa[i] = s->rho[i], s->ha[i] = s->h[i];
}

/* local: EOS, yield and damage of the present state, without advancing it; the rates of S (when
 * they are kept) and of the cracks. */
HD void pass_local(const State *s, const Step *k, long i)
{
  double mu = k->strength ? s->material[s->mat[i]].mu : 0, alpha = matter_distention(s, i);
  passes_density(s, k, i);
  matter_eos(s, i, s->u[i], k->strength);
  if (s->rare && s->alpha) matter_compact(s, i, alpha, mu > 0, k->damage);
  if (mu > 0) matter_yield(s, i, 0, 0, 0);
  if (k->damage) passes_damage(s, i, 0);
  if (s->ds)
    passes_keep_stress(&s->ds[6 * i], passes_jaumann(passes_stress(&s->s[6 * i]), &s->g[9 * i],
                                                     mu > 0 ? matter_shear(s, i) : 0));
  passes_pack(s, k, i, mu > 0, 0);
}

/* passes_heating: du/dt as the run's energy mode has it: all work, compression alone (frozen
 * entropy), or none. */
HD double passes_heating(const State *s, const Step *k, long i)
{
  if (k->energy == 0 && k->deposit.rate != 0)
    return s->du[i] + passes_outer(s, k, i, s->rho[i]) + fluid_deposit(&k->deposit, &s->x[3 * i]);
  if (k->energy == 0) return s->du[i] + passes_outer(s, k, i, s->rho[i]);
  return k->energy == 1 ? -s->p[i] * s->divv[i] / s->rho[i] : 0;
}

/* save: the evolved quantities, or their rates, into saved[slot]. Damage goes by its cube root,
 * which stops growing only where the step began at its limit. The first evaluation of a step is of
 * the state in saved[0]: with grad_h it finds h and rho anew. */
HD void pass_save(const State *s, const Step *k, long i)
{
  const Saved *to = &s->saved[k->slot];
  double div = s->divv[i];
  for (int d = 0; d < 3; d++) {
    to->x[3 * i + d] = k->rates ? passes_motion(s, 3 * i + d) : s->x[3 * i + d];
    to->v[3 * i + d] = k->rates ? s->acc[3 * i + d] : s->v[3 * i + d];
  }
  for (int d = 0; d < 6; d++) to->s[6 * i + d] = k->rates ? s->ds[6 * i + d] : s->s[6 * i + d];
  to->rho[i] = k->rates ? -s->rho[i] * div : s->rho[i];
  if (k->rates && s->drho) to->rho[i] += s->drho[i];
  to->u[i] = k->rates ? passes_heating(s, k, i) : s->u[i];
  to->h[i] = k->rates ? (k->smoothing ? s->h[i] * passes_swell(s, k, i) : 0) : s->h[i];
  if (!k->rates) to->crack[i] = cbrt(s->damage[i]);
  if (k->rates) to->crack[i] = k->damage ? passes_crack_rate(s, i, s->saved[0].crack[i]) : 0;
  if (s->alpha) to->alpha[i] = s->alpha[i];
  if (to->active && !k->rates) to->active[i] = s->nact[i];
  if (s->omega && k->rates && k->slot == 1)
    s->saved[0].h[i] = s->h[i], s->saved[0].rho[i] = s->rho[i];
}

/* remember: the rates of saved[slot] are those of the step before for the next step. recall: these
 * into saved[slot]. */
HD void pass_remember(const State *s, const Step *k, long i)
{
  const Saved *from = &s->saved[k->slot];
#define PASSES_REMEMBER(MEMBER, WIDTH)                                                             \
  for (int d = 0; d < (WIDTH); d++) s->old_##MEMBER[(WIDTH)*i + d] = from->MEMBER[(WIDTH)*i + d];
  RATE_FIELDS(PASSES_REMEMBER)
#undef PASSES_REMEMBER
}

HD void pass_recall(const State *s, const Step *k, long i)
{
  const Saved *to = &s->saved[k->slot];
#define PASSES_RECALL(MEMBER, WIDTH)                                                               \
  for (int d = 0; d < (WIDTH); d++) to->MEMBER[(WIDTH)*i + d] = s->old_##MEMBER[(WIDTH)*i + d];
  RATE_FIELDS(PASSES_RECALL)
#undef PASSES_RECALL
}

/* passes_sum: q + dt (w1 k1 + w2 k2 + w3 k3) of one number; q itself when dt is 0, whatever the k
 * are, and no k is read whose weight is 0. */
#define PASSES_TERM(SLOT, MEMBER, J)                                                               \
  (k->weight[SLOT - 1] != 0 ? k->weight[SLOT - 1] * s->saved[SLOT].MEMBER[J] : 0)
#define PASSES_SUM(MEMBER, J)                                                                      \
  (s->saved[0].MEMBER[J] + (k->dt > 0                                                              \
                                ? k->dt * (PASSES_TERM(1, MEMBER, J) + PASSES_TERM(2, MEMBER, J) + \
                                           PASSES_TERM(3, MEMBER, J))                              \
                                : 0))

/* combine: state = saved[0] + dt (weight . saved rates 1..3); with dt = 0 saved[0] itself, active
 * flaws too, whatever a step that failed has activated. */
HD void pass_combine(const State *s, const Step *k, long i)
{
  double h, crack = PASSES_SUM(crack, i);
  for (int d = 0; d < 3; d++) {
    s->x[3 * i + d] = PASSES_SUM(x, 3 * i + d);
    s->v[3 * i + d] = PASSES_SUM(v, 3 * i + d);
  }
  for (int d = 0; d < 6; d++) s->s[6 * i + d] = PASSES_SUM(s, 6 * i + d);
  s->rho[i] = PASSES_SUM(rho, i);
  s->u[i] = PASSES_SUM(u, i);
  s->ue[i] = s->u[i]; /* what settle, if this is kept, books */
  if (s->u[i] < k->energy_floor) s->u[i] = k->energy_floor;
  h = PASSES_SUM(h, i);
  s->h[i] = h < k->h_min ? k->h_min : h > k->h_max ? k->h_max : h;
  if (s->alpha) s->alpha[i] = s->saved[0].alpha[i];
  if (s->saved[0].active && !(k->dt > 0)) s->nact[i] = (int32_t)s->saved[0].active[i];
  if (k->damage) {
    double limit = s->nflaw[i] > 0 ? (double)s->nact[i] / s->nflaw[i] : 0,
           old = s->saved[0].crack[i], grown = crack * crack * crack;
    old = old * old * old;
    grown = grown > limit ? limit : grown;
    s->damage[i] = grown > old ? grown : old;
  }
}

/* damp: damping and spin of an evaluation of rk2-adaptive and the like. */
HD void pass_damp(const State *s, const Step *k, long i)
{
  if (k->damping > 0) passes_damp(s, k, i, &s->acc[3 * i]);
  if (k->spin_rate > 0) passes_spin(s, k, i, &s->acc[3 * i]);
}

/* body_force: adds the constant body force to an evaluation's accelerations. */
HD void pass_body_force(const State *s, const Step *k, long i)
{
  (void)k;
  for (int d = 0; d < 3; d++) s->acc[3 * i + d] += s->force[d];
}

/* settle: the state that combine has reached: h towards the wanted neighbours, EOS, yield. */
HD void pass_settle(const State *s, const Step *k, long i)
{
  if (k->more.viscosity) rich_switch(s, &k->more, i, k->dt);
  const int solid = k->strength && s->material[s->mat[i]].mu > 0;
  double h = s->h[i] * passes_crowd(s, k, i), alpha = matter_distention(s, i);
  s->h[i] = h < k->h_min ? k->h_min : h > k->h_max ? k->h_max : h;
  passes_lift(s, k, i, s->ue[i]);
  if (s->shock && k->energy == 0)
    s->shock[i] += 0.5 * k->dt * (s->dqdt[i] + passes_viscous(s, k, i, solid));
  matter_eos(s, i, s->u[i], k->strength);
  if (s->rare && s->alpha) matter_compact(s, i, alpha, solid, k->damage);
  if (s->rare && s->alpha) s->dalpha[i] = k->dt > 0 ? (s->alpha[i] - alpha) / k->dt : 0;
  if (solid)
    matter_yield(s, i, 1, (k->energy == 0 ? k->dt * s->dqdt[i] : 0) + passes_deposit(s, k, i),
                 k->dt);
}

/* pass_correct: divv, and the corrected velocity gradient g = raw C with C, the inverse of the
 * moment matrix m (001 eq. 42-44), kept in cm. Dimensions that are held count as the mean of the
 * others. Particles whose neighbours span no volume (det m < sheet, 1 %, of the cube of the mean
 * eigenvalue) or lie close together (m = 0, pair_wide) keep the raw gradient, as all do with
 * form.gradient = raw. */
HD void pass_correct(const State *s, long i, const double raw[9], Sym m)
{
  double *g = &s->g[9 * i], mean, det;
  Sym c = {1, 0, 0, 1, 0, 1};
  if (s->dimension == 1) m.yy = m.xx;
  if (s->dimension < 3) m.zz = 0.5 * (m.xx + m.yy);
  mean = (m.xx + m.yy + m.zz) / 3;
  det = tensor_det(m);
  if (det > s->sheet * mean * mean * mean) c = tensor_invert(m, det);
  passes_keep_stress(&s->cm[6 * i], c);
  s->divv[i] = raw[0] + raw[4] + raw[8];
  for (int a = 0; a < 9; a += 3) {
    g[a] = raw[a] * c.xx + raw[a + 1] * c.xy + raw[a + 2] * c.xz;
    g[a + 1] = raw[a] * c.xy + raw[a + 1] * c.yy + raw[a + 2] * c.yz;
    g[a + 2] = raw[a] * c.xz + raw[a + 1] * c.yz + raw[a + 2] * c.zz;
  }
}

/* pass_bad: whether the state of i makes no sense any more, and why. */
HD int pass_bad(const State *s, long i)
{
  double sum = 0;
  for (int d = 0; d < 3; d++) {
    if (!isfinite(s->x[3 * i + d])) return BAD_POSITION;
    if (!isfinite(s->v[3 * i + d])) return BAD_VELOCITY;
    if (!isfinite(s->a[3 * i + d])) return BAD_ACCELERATION;
  }
  for (int d = 0; d < 6 && s->s; d++) sum += s->s[6 * i + d];
  if (!isfinite(sum)) return BAD_STRESS;
  if (!(s->rho[i] > 0) || !isfinite(s->rho[i])) return BAD_DENSITY;
  if (!isfinite(s->u[i])) return BAD_ENERGY;
  if (!(s->h[i] > 0) || !isfinite(s->h[i])) return BAD_SMOOTHING;
  return BAD_NONE;
}

/* hold: walls and layers. */
HD void pass_hold(const State *s, const Step *k, long i) { hold_particle(s, &k->hold, i); }

/* fold: what has left the box comes back. */
HD void pass_fold(const State *s, const Step *k, long i)
{
  (void)k;
  fold_particle(s, i);
}

/* X(CAPITAL, name); those that evaluate the equation of state apart. */
/* clang-format off */
#define PASSES_EOS(X) X(ADVANCE, advance) X(LOCAL, local) X(SETTLE, settle)
#define PASSES(X) \
  X(KICK, kick) X(DRIFT, drift) X(FINISH, finish) X(STILL, still) X(SAVE, save) X(COMBINE, combine) \
  X(DAMP, damp) X(REMEMBER, remember) X(RECALL, recall) X(BODY_FORCE, body_force) \
  X(HOLD, hold) X(FOLD, fold) PASSES_EOS(X)
/* clang-format on */

enum {
#define PASS_ENUM(CAPITAL, NAME) PASS_##CAPITAL,
  PASSES(PASS_ENUM)
#undef PASS_ENUM
      PASS_COUNT,
  PASS_EOS_FIRST = PASS_ADVANCE /* from here on PASSES_EOS */
};

#endif
