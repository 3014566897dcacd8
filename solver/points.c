/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Point masses on the host: the same passes as for particles, over a handful of them. */
#include <math.h>
#include <string.h>
#include "../lib/pointmass.h"
#include "sim.h"

int points_open(Sim *sim, const Parts *p, Err *err)
{
  PointMasses *q = &sim->points;
  const Param *par = &sim->par;
  const PointMass *from = p->points ? p->point : par->point;
  double plane;
  q->n = p->points ? p->points : par->points;
  if (q->n > POINTS)
    return err_set(err, "the input has %d point masses, a run takes %d", q->n, POINTS);
  memcpy(q->p, from, (size_t)q->n * sizeof *from);
  if (par->escape_distance > 0 && par->escape_from == PARAM_POINT && !q->n)
    return err_set(err, "escape.from = point: there is no point mass");
  if (par->disk_point > 1 && par->disk_point > q->n)
    return err_set(err, "disk.point = %d: there are %d point masses", par->disk_point, q->n);
  for (int k = 0; k < q->n; k++)
    for (int d = 0; d < 3; d++)
      if (bounds_beyond(&sim->bounds, d, q->p[k].x[d], &plane))
        return err_set(err, "point mass %d is at %c = %g m, behind the mirror at %g", k + 1,
                       "xyz"[d], q -> p[k].x[d], plane);
  return pointmass_check(q->p, q->n, p->dimension, err);
}

int points_store(const Sim *sim, Parts *p, Err *err)
{
  p->points = 0;
  return pointmass_append(&p->point, &p->points, sim->points.p, sim->points.n, err);
}

/* saved[0] + dt (weight . saved rates 1..3), as pass_combine has it. */
static double combined(const Step *k, double (*saved)[POINTS][3], int i, int d)
{
  double sum = 0;
  for (int slot = 1; slot < STATE_SLOTS && k->dt > 0; slot++)
    if (k->weight[slot - 1] != 0) sum += k->weight[slot - 1] * saved[slot][i][d];
  return saved[0][i][d] + k->dt * sum;
}

static void pass_one(PointMasses *q, int pass, const Step *k, int i, int d)
{
  PointMass *p = &q->p[i];
  switch (pass) {
  case PASS_KICK: p->v[d] += p->a[d] * k->dt; break;
  case PASS_DRIFT: p->x[d] += p->v[d] * k->dt; break;
  case PASS_FINISH: p->a[d] = q->acc[i][d], p->v[d] += 0.5 * k->dt * p->a[d]; break;
  case PASS_SAVE:
    q->x[k->slot][i][d] = k->rates ? p->v[d] : p->x[d];
    q->v[k->slot][i][d] = k->rates ? q->acc[i][d] : p->v[d];
    q->was_felt[k->slot][i][d] = q->felt[i][d];
    break;
  case PASS_COMBINE: p->x[d] = combined(k, q->x, i, d), p->v[d] = combined(k, q->v, i, d); break;
  case PASS_REMEMBER: p->old_x[d] = q->x[k->slot][i][d], p->old_v[d] = q->v[k->slot][i][d]; break;
  case PASS_RECALL: q->x[k->slot][i][d] = p->old_x[d], q->v[k->slot][i][d] = p->old_v[d]; break;
  default: break; /* the others move nothing */
  }
}

/* As fold_particle: a mass that has passed a mirror changes places with its image. */
static void fold_one(const Bounds *b, PointMass *p, int d)
{
  double plane;
  p->x[d] = bounds_wrap(b, d, p->x[d]);
  if (!bounds_beyond(b, d, p->x[d], &plane)) return;
  p->x[d] = plane - (p->x[d] - plane);
  p->v[d] = -p->v[d], p->a[d] = -p->a[d], p->old_x[d] = -p->old_x[d], p->old_v[d] = -p->old_v[d];
  for (int e = 1; e < 3; e++) p->spin[(d + e) % 3] = -p->spin[(d + e) % 3];
}

void points_pass(Sim *sim, int pass, const Step *k)
{
  PointMasses *q = &sim->points;
  for (int i = 0; i < q->n; i++)
    for (int d = 0; d < 3 && !q->p[i].fixed; d++)
      if (pass == PASS_FOLD)
        fold_one(&sim->bounds, &q->p[i], d);
      else
        pass_one(q, pass, k, i, d);
  if (q->n && sim->par.disk_point)
    memcpy(sim->s.centre, q->p[sim->par.disk_point - 1].x, sizeof sim->s.centre);
}

/* From the place x to y. */
static double between(const double x[3], const double y[3], double d[3])
{
  for (int k = 0; k < 3; k++) d[k] = y[k] - x[k];
  return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/* Places and velocities of all, or their rates. */
typedef struct {
  double x[POINTS][3], v[POINTS][3];
} Orbits;

/* The pull of each pair at these places, added to acc: equal and opposite forces; the larger
 * softening of both. Returns the energy [J]. */
static double pull_each_other(const PointMasses *q, double G, const Orbits *at, double (*acc)[3])
{
  double energy = 0;
  for (int i = 0; i < q->n; i++)
    for (int j = 0; j < i; j++) {
      const PointMass *a = &q->p[i], *b = &q->p[j];
      double d[3], f[3] = {0, 0, 0};
      between(at->x[i], at->x[j], d);
      energy += a->m * softening_pull(G * b->m, fmax(a->h, b->h), d, f);
      for (int k = 0; k < 3; k++) acc[i][k] += f[k], acc[j][k] -= f[k] * (a->m / b->m);
    }
  return energy;
}

int points_sinks(const Sim *sim)
{
  for (int k = 0; k < sim->points.n; k++)
    if (sim->points.p[k].radius > 0) return 1;
  return 0;
}

void points_field(const Sim *sim, PointField *field)
{
  field->n = sim->points.n;
  for (int i = 0; i < field->n; i++) {
    PointSource *s = &field->at[i];
    memcpy(s->x, sim->points.p[i].x, sizeof s->x);
    s->gm = sim->par.G * sim->points.p[i].m, s->h = sim->points.p[i].h;
  }
}

void points_take(PointMass *p, double m, const double x[3], const double v[3])
{
  const double part = p->fixed ? 0 : m / (p->m + m), reduced = p->fixed ? m : p->m * part;
  double d[3], w[3];
  for (int k = 0; k < 3; k++) d[k] = x[k] - p->x[k], w[k] = v[k] - p->v[k];
  for (int k = 0; k < 3; k++) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    p->spin[k] += reduced * (d[a] * w[b] - d[b] * w[a]);
    p->x[k] += part * d[k], p->v[k] += part * w[k];
  }
  p->m += m, p->taken += m, p->count++;
}

int points_exchange(Sim *sim, Err *err)
{
  PointMasses *q = &sim->points;
  PointReaction r[POINTS];
  PointField field;
  Orbits at;
  if (!q->n) return 0;
  points_field(sim, &field);
  if (sim->b->points(sim, &field, r, err)) return -1;
  q->energy = 0;
  for (int i = 0; i < q->n; i++) {
    q->energy += r[i].energy;
    memcpy(at.x[i], q->p[i].x, sizeof at.x[i]);
    for (int d = 0; d < 3; d++)
      q->acc[i][d] = q->felt[i][d] = q->p[i].deaf ? 0 : -r[i].f[d] / q->p[i].m;
  }
  q->energy += pull_each_other(q, sim->par.G, &at, q->acc);
  return 0;
}

/* The distance to the next other mass, and the speed of an orbit there; 0 when there is none. */
static double nearest(const Sim *sim, int i, double *speed)
{
  const PointMasses *q = &sim->points;
  double least = INFINITY, d[3];
  for (int j = 0; j < q->n; j++) {
    const double r = j == i ? INFINITY : fmax(between(q->p[i].x, q->p[j].x, d), q->p[i].h);
    if (!(r < least)) continue;
    least = r, *speed = sqrt(sim->par.G * (q->p[i].m + q->p[j].m) / r);
  }
  return least < INFINITY ? least : 0;
}

double points_error(const Sim *sim, double dt)
{
  const PointMasses *q = &sim->points;
  double worst = 0, speed = 0;
  for (int i = 0; i < q->n; i++) {
    const double r = nearest(sim, i, &speed);
    for (int d = 0; d < 3 && r > 0 && !q->p[i].fixed; d++) {
      const double x = q->x[2][i][d] - (q->x[1][i][d] + 4 * q->x[2][i][d] + q->x[3][i][d]) / 6;
      const double v = q->v[2][i][d] - (q->v[1][i][d] + 4 * q->v[2][i][d] + q->v[3][i][d]) / 6;
      worst = fmax(worst, dt * fmax(fabs(x) / r, fabs(v) / speed));
    }
  }
  return worst;
}

/* step.points times the least time of an orbit of two. */
static double shortest(const Sim *sim)
{
  const PointMasses *q = &sim->points;
  double least = INFINITY, speed;
  for (int i = 0; i < q->n && q->n > 1; i++) {
    const double r = nearest(sim, i, &speed);
    if (!q->p[i].fixed && r > 0) least = fmin(least, r / speed);
  }
  return sim->par.step_points * least;
}

double points_limit(const Sim *sim)
{
  const int substeps = integrator_of(sim->par.integrator)->substeps;
  return (substeps ? substeps : 1) * shortest(sim);
}

/* Rates at `at`, when this share of the step is over. */
static void rates(const Sim *sim, const Orbits *at, double share, int from, int to, Orbits *out)
{
  const PointMasses *q = &sim->points;
  memcpy(out->x, at->v, sizeof out->x);
  for (int i = 0; i < q->n; i++)
    for (int d = 0; d < 3; d++)
      out->v[i][d] = (1 - share) * q->was_felt[from][i][d] + share * q->was_felt[to][i][d];
  pull_each_other(q, sim->par.G, at, out->v);
  for (int i = 0; i < q->n; i++)
    for (int d = 0; d < 3 && q->p[i].fixed; d++) out->x[i][d] = out->v[i][d] = 0;
}

/* out = a + dt b; out may be a. */
static void move(int n, const Orbits *a, double dt, const Orbits *b, Orbits *out)
{
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 3; d++)
      out->x[i][d] = a->x[i][d] + dt * b->x[i][d], out->v[i][d] = a->v[i][d] + dt * b->v[i][d];
}

void points_orbit(Sim *sim, double dt, int from, int to)
{
  static const double weight[4] = {1. / 6, 2. / 6, 2. / 6, 1. / 6}, node[5] = {0, .5, .5, 1, 0};
  PointMasses *q = &sim->points;
  Orbits now, next, at, rate;
  for (int i = 0; i < q->n; i++) {
    memcpy(q->p[i].x, q->x[0][i], sizeof q->p[i].x);
    memcpy(now.x[i], q->x[0][i], sizeof now.x[i]), memcpy(now.v[i], q->v[0][i], sizeof now.v[i]);
  }
  const long steps = 1 + (long)(dt / shortest(sim));
  const double part = dt / (double)steps;
  for (long step = 0; step < steps; step++) {
    at = next = now;
    for (int k = 0; k < 4; k++) {
      rates(sim, &at, ((double)step + node[k]) / (double)steps, from, to, &rate);
      move(q->n, &next, weight[k] * part, &rate, &next);
      move(q->n, &now, node[k + 1] * part, &rate, &at);
    }
    now = next;
  }
  for (int i = 0; i < q->n; i++)
    memcpy(q->p[i].x, now.x[i], sizeof now.x[i]), memcpy(q->p[i].v, now.v[i], sizeof now.v[i]);
}

void points_sums(const Sim *sim, Sums *s)
{
  const PointMasses *q = &sim->points;
  double moment[3];
  if (!q->n) return;
  for (int d = 0; d < 3; d++) moment[d] = s->mass * s->centre[d];
  for (int i = 0; i < q->n; i++) {
    const PointMass *p = &q->p[i];
    const double *x = p->x, *v = p->v, v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    const double l[3] = {x[1] * v[2] - x[2] * v[1], x[2] * v[0] - x[0] * v[2],
                         x[0] * v[1] - x[1] * v[0]};
    s->mass += p->m, s->kinetic += 0.5 * p->m * v2;
    for (int d = 0; d < 3; d++)
      s->momentum[d] += p->m * v[d], s->angular[d] += p->m * l[d] + p->spin[d],
          moment[d] += p->m * x[d];
    s->scale_momentum += p->m * sqrt(v2);
    s->scale_angular += p->m * sqrt(l[0] * l[0] + l[1] * l[1] + l[2] * l[2]);
  }
  s->potential += q->energy;
  for (int d = 0; d < 3; d++) s->centre[d] = moment[d] / s->mass;
}
