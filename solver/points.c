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
  q->n = p->points ? p->points : par->points;
  if (q->n > POINTS)
    return err_set(err, "the input has %d point masses, a run takes %d", q->n, POINTS);
  memcpy(q->p, from, (size_t)q->n * sizeof *from);
  if (par->escape_distance > 0 && par->escape_from == PARAM_POINT && !q->n)
    return err_set(err, "escape.from = point: there is no point mass");
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
    break;
  case PASS_COMBINE: p->x[d] = combined(k, q->x, i, d), p->v[d] = combined(k, q->v, i, d); break;
  case PASS_REMEMBER: p->old_x[d] = q->x[k->slot][i][d], p->old_v[d] = q->v[k->slot][i][d]; break;
  case PASS_RECALL: q->x[k->slot][i][d] = p->old_x[d], q->v[k->slot][i][d] = p->old_v[d]; break;
  default: break; /* the others move nothing */
  }
}

void points_pass(Sim *sim, int pass, const Step *k)
{
  PointMasses *q = &sim->points;
  for (int i = 0; i < q->n; i++)
    for (int d = 0; d < 3 && !q->p[i].fixed; d++) pass_one(q, pass, k, i, d);
}

/* From j to i. */
static double between(const PointMass *i, const PointMass *j, double d[3])
{
  for (int k = 0; k < 3; k++) d[k] = j->x[k] - i->x[k];
  return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/* The pull of each pair: equal and opposite forces; the larger softening of both. */
static void pull_each_other(PointMasses *q, double G)
{
  for (int i = 0; i < q->n; i++)
    for (int j = 0; j < i; j++) {
      const PointMass *a = &q->p[i], *b = &q->p[j];
      double d[3], f[3] = {0, 0, 0};
      between(a, b, d);
      q->energy += a->m * softening_pull(G * b->m, fmax(a->h, b->h), d, f);
      for (int k = 0; k < 3; k++) q->acc[i][k] += f[k], q->acc[j][k] -= f[k] * (a->m / b->m);
    }
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
  if (!q->n) return 0;
  points_field(sim, &field);
  if (sim->b->points(sim, &field, r, err)) return -1;
  q->energy = 0;
  for (int i = 0; i < q->n; i++) {
    q->energy += r[i].energy;
    for (int d = 0; d < 3; d++) q->acc[i][d] = q->p[i].deaf ? 0 : -r[i].f[d] / q->p[i].m;
  }
  pull_each_other(q, sim->par.G);
  return 0;
}

/* The distance to the next other mass, and the speed of an orbit there; 0 when there is none. */
static double nearest(const Sim *sim, int i, double *speed)
{
  const PointMasses *q = &sim->points;
  double least = INFINITY, d[3];
  for (int j = 0; j < q->n; j++) {
    const double r = j == i ? INFINITY : fmax(between(&q->p[i], &q->p[j], d), q->p[i].h);
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

double points_limit(const Sim *sim)
{
  const PointMasses *q = &sim->points;
  double least = INFINITY, speed;
  for (int i = 0; i < q->n && q->n > 1; i++) {
    const double r = nearest(sim, i, &speed);
    if (!q->p[i].fixed && r > 0) least = fmin(least, r / speed);
  }
  return sim->par.step_points * least;
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
