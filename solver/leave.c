/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Looks for particles that leave, and what is to be done when some do. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "../lib/sort.h"
#include "sim.h"

static const char *const names[LEAVE_GONE] = {
    "EscapedNumber", "AccretedNumber", "EscapedMass",  "GoneEnergy",   "GoneMomentumX",
    "GoneMomentumY", "GoneMomentumZ",  "GoneAngularX", "GoneAngularY", "GoneAngularZ"};

int leave_store(const Sim *sim, Parts *p, Err *err)
{
  double value[LEAVE_GONE];
  memcpy(value, &sim->gone, sizeof value);
  for (int k = 0; k < LEAVE_GONE && leave_possible(sim); k++)
    if (part_set_number(p, "run", names[k], value[k], err)) return -1;
  return 0;
}

int leave_load(Sim *sim, const Parts *p, Err *err)
{
  double value[LEAVE_GONE];
  if (!leave_possible(sim)) return 0;
  for (int k = 0; k < LEAVE_GONE; k++)
    if (isnan(value[k] = part_number(p, "run", names[k])))
      return err_set(err, "the checkpoint lacks attribute '%s' of /Run", names[k]);
  memcpy(&sim->gone, value, sizeof value);
  return 0;
}

int leave_possible(const Sim *sim) { return sim->par.escape_distance > 0 || points_sinks(sim); }

/* The particle that lies deepest: its place and velocity. */
static int deepest(Sim *sim, Leave *l, Err *err)
{
  const State *s = &sim->s;
  const size_t n = (size_t)s->n;
  double *phi = malloc(n * sizeof *phi);
  long least = 0;
  int bad = phi ? sim->b->copy(sim, phi, s->phi, n * sizeof *phi, err)
                : err_set(err, "not enough memory");
  for (long i = 1; i < s->n && !bad; i++)
    if (phi[i] < phi[least]) least = i;
  free(phi);
  return bad || sim->b->copy(sim, l->centre, s->x + 3 * least, sizeof l->centre, err) ||
                 sim->b->copy(sim, l->velocity, s->v + 3 * least, sizeof l->velocity, err)
             ? -1
             : 0;
}

/* What particles escape from. */
static int set_escape(Sim *sim, Leave *l, const Sums *sums, Err *err)
{
  const Param *p = &sim->par;
  l->far2 = p->escape_distance * p->escape_distance, l->unbound = p->escape_unbound;
  if (p->escape_from == PARAM_DEEPEST) return deepest(sim, l, err);
  for (int d = 0; d < 3; d++) {
    const PointMass *point = &sim->points.p[0];
    if (p->escape_from == PARAM_CENTRE)
      l->centre[d] = sums->centre[d], l->velocity[d] = sums->momentum[d] / sums->mass;
    if (p->escape_from == PARAM_POINT) l->centre[d] = point->x[d], l->velocity[d] = point->v[d];
  }
  return 0;
}

static void set_sinks(const Sim *sim, Leave *l)
{
  l->bound = sim->par.sink_bound;
  for (int k = 0; k < sim->points.n; k++) {
    const PointMass *p = &sim->points.p[k];
    memcpy(l->v[k], p->v, sizeof l->v[k]);
    l->r2[k] = p->radius * p->radius;
  }
}

/* The test on the host, for each particle; how many leave. */
static long mark(Sim *sim, const Leave *l, signed char *where, Err *err)
{
  const size_t n = (size_t)sim->s.n;
  State s = sim->s;
  double *all = malloc(n * 7 * sizeof *all);
  long leaving = 0;
  if (!all) return err_set(err, "not enough memory for %ld particles", sim->s.n);
  s.x = all, s.v = all + 3 * n, s.phi = sim->s.phi ? all + 6 * n : NULL;
  int bad = sim->b->copy(sim, s.x, sim->s.x, 3 * n * sizeof *all, err) ||
            sim->b->copy(sim, s.v, sim->s.v, 3 * n * sizeof *all, err) ||
            (s.phi && sim->b->copy(sim, s.phi, sim->s.phi, n * sizeof *all, err));
  for (long i = 0; i < s.n && !bad; i++)
    leaving += (where[i] = (signed char)leave_where(l, &s, i)) != LEAVE_STAYS;
  free(all);
  return bad ? -1 : leaving;
}

static double energy_of(const Sums *s) { return s->kinetic + s->internal + s->potential; }

int leave_find(Sim *sim, LeaveFound *found, Err *err)
{
  const Param *p = &sim->par;
  const int sink = points_sinks(sim) && sim->step % p->sink_every == 0,
            escape = p->escape_distance > 0 && sim->step % p->escape_every == 0;
  Leave l;
  Sums sums;
  long leaving;
  memset(found, 0, sizeof *found), memset(&l, 0, sizeof l);
  if (sim->outer > 0 || !(sink || escape)) return 0;
  points_field(sim, &l.field);
  if (escape && (sim_sums(sim, &sums, err) || set_escape(sim, &l, &sums, err))) return -1;
  if (sink) set_sinks(sim, &l);
  if (sim->b->leaving(sim, &l, &leaving, err)) return -1;
  if (leaving == 0) return 0;
  if (!escape && sim_sums(sim, &sums, err)) return -1;
  if (!(found->where = malloc((size_t)sim->s.n + 1))) return err_set(err, "not enough memory");
  found->energy = energy_of(&sums);
  found->leaving = mark(sim, &l, found->where, err);
  if (found->leaving > 0 && found->leaving < sim->s.n) return 0;
  leaving = found->leaving;
  free(found->where), found->where = NULL;
  if (leaving > 0) return err_set(err, "all %ld particles leave the run", leaving);
  return leaving < 0 ? -1 : 0;
}

/* The rows of parts that go where `escape` says, as they are; NULL: none (or an error: *bad). */
static Parts *piece(const Sim *sim, const Parts *p, const signed char *to, int escape, int *bad,
                    Err *err)
{
  unsigned char *keep = calloc((size_t)p->n + 1, 1);
  double *field[3] = {NULL, NULL, NULL};
  Parts *q = NULL;
  long n = 0, k = 0;
  for (long i = 0; i < p->n && keep; i++)
    n += keep[i] = to[i] != LEAVE_STAYS && (to[i] == LEAVE_ESCAPES) == escape;
  if (n == 0 && keep) return free(keep), NULL;
  if (!keep || !(q = part_select(p, keep, err)) ||
      !(field[0] = part_add_extra(q, "RemovalTime", "s", "when it left the run", err)) ||
      !(field[1] = part_add_extra(q, "RemovalStep", "1", "step after which it left", err)) ||
      (!escape && !(field[2] = part_add_extra(q, "SinkNumber", "1",
                                              "point mass that took it: 1, 2, ...", err))))
    return free(keep), part_free(q), *bad = -1, NULL;
  for (long i = 0; i < p->n; i++) {
    if (!keep[i]) continue;
    field[0][k] = sim->time, field[1][k] = (double)sim->step;
    if (!escape) field[2][k] = to[i] + 1;
    k++;
  }
  free(keep);
  q->points = 0;
  return q;
}

static void moments(double m, const double *x, const double *v, double *momentum, double *angular)
{
  for (int d = 0; d < 3; d++) {
    const int a = (d + 1) % 3, b = (d + 2) % 3;
    momentum[d] += m * v[d], angular[d] += m * (x[a] * v[b] - x[b] * v[a]);
  }
}

/* Escapees into the books. */
static void book(Gone *g, const Parts *q)
{
  g->escaped += (double)q->n;
  for (long i = 0; i < q->n; i++) {
    g->mass += q->m[i];
    moments(q->m[i], &q->x[3 * i], &q->v[3 * i], g->momentum, g->angular);
  }
}

/* What sinks take, in the order of the ids. */
static int accrete(Sim *sim, const Parts *q, Err *err)
{
  const double *sink = (const double *)(const void *)q->extra[q->extras - 1].data;
  long *order = malloc(((size_t)q->n + 1) * sizeof *order);
  if (!order || sort_ids(q->n, q->id, order)) return free(order), err_set(err, "not enough memory");
  for (long k = 0; k < q->n; k++) {
    const long i = order[k];
    PointMass *p = &sim->points.p[(int)sink[i] - 1];
    if (p->fixed) moments(q->m[i], p->x, &q->v[3 * i], sim->gone.momentum, sim->gone.angular);
    points_take(p, q->m[i], &q->x[3 * i], &q->v[3 * i]);
  }
  sim->gone.accreted += (double)q->n;
  free(order);
  return 0;
}

/* Parts without the rows that leave; all else stays. */
static int close_parts(Parts *p, const signed char *to, Err *err)
{
  unsigned char *keep = calloc((size_t)p->n + 1, 1);
  Parts *q = NULL, old = *p;
  for (long i = 0; i < p->n && keep; i++) keep[i] = to[i] == LEAVE_STAYS;
  if (!keep || !(q = part_select(p, keep, err))) return free(keep), -1;
  q->run = p->run, q->runs = p->runs;
  old.run = NULL, old.runs = 0;
  *p = *q, *q = old;
  part_free(q);
  free(keep);
  return 0;
}

/* The state without those that leave, rows 0, 1, ... again; to: where each row goes. */
static int close_state(Sim *sim, const signed char *where, const int64_t *row, signed char *to,
                       Err *err)
{
  const long n = sim->s.n;
  uint32_t *kept = malloc((size_t)n * sizeof *kept);
  int64_t *rank = malloc((size_t)n * sizeof *rank), *rows = malloc((size_t)n * sizeof *rows);
  int bad = kept && rank && rows ? 0 : err_set(err, "not enough memory for %ld particles", n);
  long left = 0, next = 0;
  for (long r = 0; r < n && !bad; r++) rank[r] = next, next += to[r] == LEAVE_STAYS;
  for (long i = 0; i < n && !bad; i++)
    if (where[i] == LEAVE_STAYS) rows[left] = rank[row[i]], kept[left++] = (uint32_t)i;
  bad = bad || sim->b->keep(sim, kept, left, err) ||
        sim->b->copy(sim, sim->s.row, rows, (size_t)left * sizeof *rows, err);
  free(kept), free(rank), free(rows);
  return bad ? -1 : 0;
}

/* Rates of what is left; the step that error control allows stays. */
static int evaluate(Sim *sim, double energy, Err *err)
{
  const double dt = sim->dt;
  Sums sums;
  sim->pull_due = 1;
  if (integrator_of(sim->par.integrator)->start(sim, err)) return -1;
  sim->dt = dt;
  if (sim_sums(sim, &sums, err)) return -1;
  sim->gone.energy += energy - energy_of(&sums);
  return 0;
}

int leave_take(Sim *sim, LeaveFound *found, Parts *parts, Parts **escaped, Parts **accreted,
               Err *err)
{
  const size_t n = (size_t)sim->s.n;
  int64_t *row = malloc(n * sizeof *row);
  signed char *to = malloc(n + 1);
  int bad = row && to ? sim_store(sim, parts, err) : err_set(err, "not enough memory");
  *escaped = *accreted = NULL;
  bad = bad || sim->b->copy(sim, row, sim->s.row, n * sizeof *row, err);
  for (size_t i = 0; i < n && !bad; i++) to[row[i]] = found->where[i];
  if (!bad) *escaped = piece(sim, parts, to, 1, &bad, err);
  if (!bad) *accreted = piece(sim, parts, to, 0, &bad, err);
  if (!bad && *escaped) book(&sim->gone, *escaped);
  bad = bad || (*accreted && accrete(sim, *accreted, err)) ||
        close_state(sim, found->where, row, to, err) || close_parts(parts, to, err) ||
        evaluate(sim, found->energy, err);
  free(row), free(to), free(found->where);
  found->where = NULL;
  return bad ? -1 : 0;
}
