/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reductions' physics: what one particle adds to a sum or holds against a minimum, how two
 * partial results become one, and what is made of the last. The order in which this happens is the
 * backend's and must be the same every time. */
#ifndef REDUCE_H
#define REDUCE_H

#include "backend.h"
#include "limits.h"

enum { REDUCE_SUMS = 24 };

/* Sums over all particles, as Sums has them. */
typedef struct {
  double v[REDUCE_SUMS];
} ReduceSums;

/* reduce_add_floors: what the floors have done to i: energy, and where it is at one. */
HD void reduce_add_floors(double v[4], const State *s, long i)
{
  const double h = s->h[i], least = s->floors.lone * s->m[i] /
                                    (s->dimension == 3   ? h * h * h
                                     : s->dimension == 2 ? h * h
                                                         : h);
  if (s->lifted) v[0] += s->m[i] * s->lifted[i];
  v[1] += s->u[i] <= s->floors.u;
  v[2] += s->rho[i] <= 1.01 * least;
  v[3] += s->floors.pressure && s->p[i] <= s->floors.p;
}

HD void reduce_add_sums(ReduceSums *o, const State *s, long i)
{
  const double *x = &s->x[3 * i], *v = &s->v[3 * i];
  double m = s->m[i], v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  double l[3] = {x[1] * v[2] - x[2] * v[1], x[2] * v[0] - x[0] * v[2], x[0] * v[1] - x[1] * v[0]};
  o->v[0] += m, o->v[1] += 0.5 * m * v2, o->v[2] += m * s->u[i], o->v[3] += 0.5 * m * s->phi[i];
  for (int d = 0; d < 3; d++)
    if (s->force[d] != 0) o->v[3] -= m * s->force[d] * x[d];
  for (int d = 0; d < 3; d++)
    o->v[4 + d] += m * v[d], o->v[7 + d] += m * l[d], o->v[10 + d] += m * x[d];
  o->v[13] += m * sqrt(v2), o->v[14] += m * sqrt(l[0] * l[0] + l[1] * l[1] + l[2] * l[2]);
  o->v[18] += s->h[i] <= s->h_min, o->v[19] += s->h[i] >= s->h_max;
  if (s->rare && s->material[s->mat[i]].eos.form == EOS_TABLE) {
    int outside = eos_table_outside(&s->material[s->mat[i]].eos.table,
                                    s->rho[i] * (s->alpha ? s->alpha[i] : 1), s->u[i]);
    for (int d = 0; d < 3; d++) o->v[15 + d] += outside >> d & 1;
  }
  reduce_add_floors(o->v + 20, s, i);
}

HD void reduce_merge_sums(ReduceSums *a, const ReduceSums *b)
{
  for (int k = 0; k < REDUCE_SUMS; k++) a->v[k] += b->v[k];
}

HD void reduce_sums(const ReduceSums *t, Sums *out)
{
  const double *v = t->v;
  out->mass = v[0], out->kinetic = v[1], out->internal = v[2], out->potential = v[3];
  for (int d = 0; d < 3; d++) {
    out->momentum[d] = v[4 + d], out->angular[d] = v[7 + d], out->outside[d] = v[15 + d];
    out->centre[d] = v[0] > 0 ? v[10 + d] / v[0] : 0;
  }
  out->lifted = v[20];
  for (int d = 0; d < 3; d++) out->at_floor[d] = v[21 + d];
  out->scale_momentum = v[13], out->scale_angular = v[14];
  out->held[0] = v[18], out->held[1] = v[19];
}

/* The limits of no particle. */
HD Limits reduce_no_limits(void)
{
  const Limits o = {INFINITY, LIMITS, -1, 0, -1, BAD_NONE};
  return o;
}

/* reduce_before: whether a step of b counts rather than that of a: the smaller, of equal ones that
 * of the first criterion, then that of the smaller id. */
HD int reduce_before(const Limits *b, const Limits *a)
{
  if (b->dt != a->dt) return b->dt < a->dt;
  return b->which != a->which ? b->which < a->which : b->id < a->id;
}

HD void reduce_merge_limits(Limits *a, const Limits *b)
{
  if (reduce_before(b, a)) a->dt = b->dt, a->which = b->which, a->id = b->id;
  if (b->dilation > a->dilation) a->dilation = b->dilation;
  if (b->bad >= 0 && (a->bad < 0 || b->bad < a->bad))
    a->bad = b->bad, a->bad_reason = b->bad_reason;
}

/* reduce_add_limits: asked: with the limits that may be off, k->limited; a literal where these
 * would cost registers. */
HD void reduce_add_limits(Limits *o, const State *s, const Step *k, long i, int asked)
{
  Limits one = reduce_no_limits();
  double dt[LIMITS];
  one.bad_reason = pass_bad(s, i), one.bad = one.bad_reason ? s->id[i] : -1;
  one.dilation = fabs(s->divv[i]);
  limits_of(s, k, i, asked, dt);
  for (int c = 0; c < LIMITS; c++)
    if (dt[c] < one.dt) one.dt = dt[c], one.which = c, one.id = s->id[i];
  reduce_merge_limits(o, &one);
}

/* How gravity changed: the largest square of a change; sums of m and of m |pull|^2. */
typedef struct {
  double most, mass, square;
} ReduceChange;

HD void reduce_add_change(ReduceChange *o, const State *s, long i)
{
  double change = 0, square = 0;
  for (int d = 0; d < 3; d++) {
    const double a = s->pull[3 * i + d], b = a - s->pull0[3 * i + d];
    change += b * b, square += a * a;
  }
  o->most = change > o->most ? change : o->most;
  o->mass += s->m[i], o->square += s->m[i] * square;
}

HD void reduce_merge_change(ReduceChange *a, const ReduceChange *b)
{
  a->most = b->most > a->most ? b->most : a->most;
  a->mass += b->mass, a->square += b->square;
}

/* reduce_change: over the mean size; 0 where nothing pulls. */
HD double reduce_change(const ReduceChange *o)
{
  return o->square > 0 ? sqrt(o->most * o->mass / o->square) : 0;
}

/* reduce_body: the frame of damping that particle i belongs to. */
HD int reduce_body(const State *s, long i)
{
  return s->body[i] >= 0 && s->body[i] < BODIES ? s->body[i] : 0;
}

/* Mass, and mass times position and velocity, of a body; of the predicted velocities, which are
 * what is damped. */
typedef struct {
  double m, x[3], v[3];
} ReduceMotion;

HD void reduce_add_motion(ReduceMotion *o, const State *s, long i)
{
  o->m += s->m[i];
  for (int d = 0; d < 3; d++)
    o->x[d] += s->m[i] * s->x[3 * i + d], o->v[d] += s->m[i] * s->vp[3 * i + d];
}

HD void reduce_merge_motion(ReduceMotion *a, const ReduceMotion *b)
{
  a->m += b->m;
  for (int d = 0; d < 3; d++) a->x[d] += b->x[d], a->v[d] += b->v[d];
}

/* reduce_motion: centre and velocity; those of no particles are 0. */
HD void reduce_motion(const ReduceMotion *t, double centre[3], double velocity[3])
{
  for (int d = 0; d < 3; d++) {
    centre[d] = t->m > 0 ? t->x[d] / t->m : 0;
    velocity[d] = t->m > 0 ? t->v[d] / t->m : 0;
  }
}

/* Angular momentum and inertia of a body about its own centre. */
typedef struct {
  double l[3];
  Sym inertia;
} ReduceSpin;

HD void reduce_add_spin(ReduceSpin *o, const State *s, const double centre[3],
                        const double velocity[3], long i)
{
  double r[3], v[3], r2 = 0;
  for (int d = 0; d < 3; d++) {
    r[d] = s->x[3 * i + d] - centre[d], v[d] = s->vp[3 * i + d] - velocity[d];
    r2 += r[d] * r[d];
  }
  o->l[0] += s->m[i] * (r[1] * v[2] - r[2] * v[1]);
  o->l[1] += s->m[i] * (r[2] * v[0] - r[0] * v[2]);
  o->l[2] += s->m[i] * (r[0] * v[1] - r[1] * v[0]);
  Sym part = {r2 - r[0] * r[0], -r[0] * r[1], -r[0] * r[2],
              r2 - r[1] * r[1], -r[1] * r[2], r2 - r[2] * r[2]};
  o->inertia = tensor_axpy(o->inertia, s->m[i], part);
}

HD void reduce_merge_spin(ReduceSpin *a, const ReduceSpin *b)
{
  for (int d = 0; d < 3; d++) a->l[d] += b->l[d];
  a->inertia = tensor_axpy(a->inertia, 1, b->inertia);
}

/* reduce_spin: omega = I^-1 L; 0 for particles on a line. */
HD void reduce_spin(const ReduceSpin *t, double omega[3]) { tensor_solve(t->inertia, t->l, omega); }

/* The error of one number of rk2-adaptive over size, times its weight, the largest so far kept in
 * worst. */
#define REDUCE_ERROR(MEMBER, J, SIZE)                                                              \
  e = k->error.MEMBER *                                                                            \
      fabs(dt * (b->MEMBER[J] - (a->MEMBER[J] + 4 * b->MEMBER[J] + c->MEMBER[J]) / 6)) / (SIZE);   \
  if (!(e <= worst)) worst = e <= 1e300 ? e : 1e300;

/* reduce_error: of the midpoint rule against the third-order step, over what is allowed: lengths by
 * h, speeds by the signal speed (or, in cold matter, h/1000 a step), the rest by its own size (001
 * eq. 63), so that nothing depends on the origin or on the frame. In the same way the change of the
 * distention, where it is limited. What is not finite is 1e300. */
HD double reduce_error(const State *s, const Step *k, long i)
{
  const Saved *a = &s->saved[1], *b = &s->saved[2], *c = &s->saved[3];
  const double dt = k->dt, cold = 1e-3 * s->h[i] / dt, scale = s->cl[i] > cold ? s->cl[i] : cold;
  double worst = 0, e;
  for (int d = 0; d < 3; d++) {
    REDUCE_ERROR(x, 3 * i + d, s->h[i])
    REDUCE_ERROR(v, 3 * i + d, scale)
  }
  for (int d = 0; d < 6; d++) { REDUCE_ERROR(s, 6 * i + d, s->rho[i] * scale * scale) }
  REDUCE_ERROR(rho, i, s->rho[i])
  REDUCE_ERROR(u, i, fabs(s->u[i]) + scale * scale)
  REDUCE_ERROR(crack, i, 1)
  if (s->alpha && k->limit[LIMIT_DISTENTION] > 0) {
    e = fabs(c->alpha[i] - s->saved[0].alpha[i]) / k->limit[LIMIT_DISTENTION];
    worst = e > worst ? e : worst;
  }
  return worst;
}
#undef REDUCE_ERROR

#endif
