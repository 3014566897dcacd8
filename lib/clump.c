/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Both methods are fixed-point iterations on a set of members in which every candidate is judged in
 * the state before (Jacobi), so that no order matters; when two sets alternate their union is kept.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_sort.h>
#include "clump.h"
#include "fof.h"
#include "group.h"
#include "unit.h"

enum { ROUNDS = 100 };
/* Mass fraction of a fragment that starts a body, and of a body that carries its frame. */
#define CORE 0.1

/* Candidates, by ascending particle id, and who of them is a member. */
typedef struct {
  const Parts *p;
  const ClumpOptions *o;
  long n, *list;
  unsigned char *in, *next, *before;
  double *phi, *key; /* J/kg; scratch */
  size_t *order;
} Work;

static void work_free(Work *w)
{
  free(w->list), free(w->in), free(w->next), free(w->before), free(w->phi), free(w->key),
      free(w->order);
}

static int work_room(Work *w, const Parts *p, const ClumpOptions *o, Err *err)
{
  size_t room = (size_t)p->n + 1;
  *w = (Work){.p = p,
              .o = o,
              .list = malloc(room * sizeof *w->list),
              .in = malloc(room),
              .next = malloc(room)};
  w->before = malloc(room), w->phi = malloc(room * sizeof *w->phi),
  w->key = malloc(room * sizeof *w->key);
  w->order = malloc(room * sizeof *w->order);
  if (w->list && w->in && w->next && w->before && w->phi && w->key && w->order) return 0;
  return err_set(err, "out of memory for %ld particles", p->n);
}

/* What counts against the potential, without v^2/2 [J/kg]. */
static double heat(const Parts *p, long i, ClumpLevel level)
{
  double e = level >= CLUMP_THERMAL ? p->u[i] : 0;
  return level >= CLUMP_ENTHALPY ? e + fmax(0, p->p[i]) / p->rho[i] : e;
}

static double speed2(const Parts *p, long i, const double v[3])
{
  double x = p->v[3 * i] - v[0], y = p->v[3 * i + 1] - v[1], z = p->v[3 * i + 2] - v[2];
  return x * x + y * y + z * z;
}

/* Velocity of the members with the lowest potential, a tenth of the mass. Equal potentials: the
 * lower id first. */
static void frame(Work *w, const unsigned char *in, double v[3])
{
  double mass = 0, sum = 0;
  long members = 0;
  for (long k = 0; k < w->n; k++) {
    w->key[k] = in[k] ? w->phi[k] : INFINITY;
    if (in[k]) mass += w->p->m[w->list[k]], members++;
  }
  gsl_sort_index(w->order, w->key, 1, (size_t)w->n);
  v[0] = v[1] = v[2] = 0;
  for (long k = 0; k < members && sum < CORE * mass; k++) {
    long i = w->list[w->order[k]];
    for (int a = 0; a < 3; a++) v[a] += w->p->m[i] * w->p->v[3 * i + a];
    sum += w->p->m[i];
  }
  for (int a = 0; a < 3 && sum > 0; a++) v[a] /= sum;
}

/* Who is bound in the potential of the members. */
static int judge(Work *w, Err *err)
{
  double v[3];
  if (group_potential(w->p, w->list, w->in, w->n, w->o->theta, w->phi, err)) return -1;
  frame(w, w->in, v);
  for (long k = 0; k < w->n; k++) {
    long i = w->list[k];
    w->next[k] = 0.5 * speed2(w->p, i, v) + heat(w->p, i, w->o->level) + w->phi[k] < 0;
  }
  return 0;
}

/* The same for the point mass of the members: M, R, V. A candidate adds its own mass (two-body
 * problem). */
static int judge_point(Work *w, Err *err)
{
  const Parts *p = w->p;
  double mass = 0, r[3] = {0}, v[3] = {0};
  (void)err;
  for (long k = 0; k < w->n; k++) {
    long i = w->list[k];
    for (int a = 0; a < 3 && w->in[k]; a++)
      r[a] += p->m[i] * p->x[3 * i + a], v[a] += p->m[i] * p->v[3 * i + a];
    if (w->in[k]) mass += p->m[i];
  }
  for (int a = 0; a < 3; a++) r[a] /= mass, v[a] /= mass;
#pragma omp parallel for
  for (long k = 0; k < w->n; k++) {
    long i = w->list[k];
    double d = group_apart(p->x + 3 * i, r), mu = UNIT_G * (mass + (w->in[k] ? 0 : p->m[i]));
    w->next[k] = d * (0.5 * speed2(p, i, v) + heat(p, i, w->o->level)) < mu;
  }
  return 0;
}

static long members(const Work *w)
{
  long n = 0;
  for (long k = 0; k < w->n; k++) n += w->in[k];
  return n;
}

/* From the members given to a set that is bound to itself; returns its size (below w->o->least:
 * nothing is bound), or -1. */
static long settle(Work *w, int (*rule)(Work *, Err *), Err *err)
{
  size_t n = (size_t)w->n;
  memset(w->before, 2, n);
  for (int round = 0; round < ROUNDS && members(w) > 1; round++) {
    if (rule(w, err)) return -1;
    if (!memcmp(w->next, w->in, n)) break;
    if (!memcmp(w->next, w->before, n)) {
      for (size_t k = 0; k < n; k++) w->in[k] |= w->next[k];
      break;
    }
    unsigned char *old = w->before;
    w->before = w->in, w->in = w->next, w->next = old;
  }
  return members(w);
}

static long deepest(const Work *w)
{
  long low = 0;
  for (long k = 1; k < w->n; k++)
    if (w->phi[k] < w->phi[low]) low = k;
  return low;
}

/* The members are the particles nearest to the deepest one: a tenth of the mass, but `least` of
 * them. */
static int core(Work *w, Err *err)
{
  const Parts *p = w->p;
  double mass = 0, sum = 0;
  if (group_potential(p, w->list, NULL, w->n, w->o->theta, w->phi, err)) return -1;
  const double *c = p->x + 3 * w->list[deepest(w)];
  for (long k = 0; k < w->n; k++) {
    w->key[k] = group_apart(p->x + 3 * w->list[k], c);
    mass += p->m[w->list[k]], w->in[k] = 0;
  }
  gsl_sort_index(w->order, w->key, 1, (size_t)w->n);
  for (long k = 0; k < w->n && (sum < CORE * mass || k < w->o->least); k++)
    w->in[w->order[k]] = 1, sum += p->m[w->list[w->order[k]]];
  return 0;
}

/* One body out of the fragment in w; its particles, or those of a core that came to nothing, are
 * not searched again. */
static long body_of_fragment(Work *w, unsigned char *keep, int32_t *id, long found, Err *err)
{
  if (core(w, err)) return -1;
  for (long k = 0; k < w->n; k++)
    if (w->in[k]) keep[w->list[k]] = 0;
  long n = settle(w, judge, err);
  if (n < w->o->least) return n < 0 ? -1 : found;
  found++;
  for (long k = 0; k < w->n; k++)
    if (w->in[k]) keep[w->list[k]] = 0, id[w->list[k]] = (int32_t)found;
  return found;
}

/* All bodies of the fragments that are there now; *more: some fragment was found. */
static long bodies_of_fragments(Work *w, unsigned char *keep, int32_t *frag, int32_t *id,
                                long found, int *more, Err *err)
{
  long *start, *list, fragments = fof_find(w->p, w->o->link, keep, w->o->least, frag, err);
  *more = fragments > 0;
  if (fragments < 0 || group_lists(w->p, frag, fragments, &start, &list, err)) return -1;
  for (long f = 1; f <= fragments && found >= 0; f++) {
    w->n = start[f + 1] - start[f];
    memcpy(w->list, list + start[f], (size_t)w->n * sizeof *list);
    found = body_of_fragment(w, keep, id, found, err);
  }
  free(start), free(list);
  return found;
}

/* The members of body c, their frame V, and behind them the loose particles that could be bound: at
 * a distance d from the centre the potential is no deeper than -G M/(d - rim). Returns the number
 * of members. */
static long candidates(Work *w, const int32_t *id, const long *order, int32_t c, double v[3],
                       Err *err)
{
  const Parts *p = w->p;
  double mass = 0, x[3] = {0}, rim = 0;
  w->n = 0;
  for (long o = 0; o < p->n; o++)
    if (id[order[o]] == c) w->in[w->n] = 1, w->list[w->n++] = order[o];
  if (group_potential(p, w->list, NULL, w->n, w->o->theta, w->phi, err)) return -1;
  frame(w, w->in, v);
  long n = w->n;
  for (long k = 0; k < n; k++) {
    long i = w->list[k];
    for (int a = 0; a < 3; a++) x[a] += p->m[i] * p->x[3 * i + a];
    mass += p->m[i];
  }
  for (int a = 0; a < 3; a++) x[a] /= mass;
  for (long k = 0; k < n; k++) rim = fmax(rim, group_apart(p->x + 3 * w->list[k], x));
  for (long o = 0; o < p->n; o++) {
    long i = order[o];
    double d = group_apart(p->x + 3 * i, x) - rim,
           e = 0.5 * speed2(p, i, v) + heat(p, i, w->o->level);
    if (id[i] == 0 && (d <= 0 || d * e < UNIT_G * mass)) w->in[w->n] = 0, w->list[w->n++] = i;
  }
  return n;
}

/* Loose particles that body c binds more than any body so far: best [p->n] energies J/kg, to [p->n]
 * bodies. */
static int bind(Work *w, const int32_t *id, const long *order, int32_t c, double *best, int32_t *to,
                Err *err)
{
  double v[3];
  long n = candidates(w, id, order, c, v, err);
  if (n < 0 || (w->n > n && group_potential(w->p, w->list, w->in, w->n, w->o->theta, w->phi, err)))
    return -1;
  for (long k = n; k < w->n; k++) {
    long i = w->list[k];
    double e = 0.5 * speed2(w->p, i, v) + heat(w->p, i, w->o->level) + w->phi[k];
    if (e < best[i]) best[i] = e, to[i] = c;
  }
  return 0;
}

/* Loose particles join the body that binds them most, until none is added; only bodies that grew
 * are tried again. */
static int adopt(Work *w, int32_t *id, long found, const long *order, Err *err)
{
  const Parts *p = w->p;
  double *best = calloc((size_t)p->n + 1, sizeof *best);
  int32_t *to = calloc((size_t)p->n + 1, sizeof *to);
  unsigned char *grown = malloc((size_t)found + 1);
  int failed = !best || !to || !grown ? err_set(err, "out of memory for %ld particles", p->n) : 0,
      more = 1;
  if (grown) memset(grown, 1, (size_t)found + 1);
  for (int round = 0; round < ROUNDS && more && !failed; round++) {
    for (long c = 1; c <= found && !failed; c++)
      if (grown[c]) failed = bind(w, id, order, (int32_t)c, best, to, err);
    memset(grown, 0, (size_t)found + 1), more = 0;
    for (long i = 0; i < p->n && !failed; i++)
      if (id[i] == 0 && to[i]) id[i] = to[i], grown[to[i]] = 1, more = 1;
  }
  free(best), free(to), free(grown);
  return failed;
}

static long by_potential(Work *w, int32_t *id, const long *order, Err *err)
{
  unsigned char *keep = malloc((size_t)w->p->n + 1);
  int32_t *frag = malloc(((size_t)w->p->n + 1) * sizeof *frag);
  long found = keep && frag ? 0 : err_set(err, "out of memory for %ld particles", w->p->n);
  int more = 1;
  if (keep) memset(keep, 1, (size_t)w->p->n + 1);
  while (found >= 0 && more) found = bodies_of_fragments(w, keep, frag, id, found, &more, err);
  if (found > 0 && adopt(w, id, found, order, err)) found = -1;
  free(keep), free(frag);
  return found;
}

/* Seeds in the order of the potential of the whole system: the deepest free particle and the free
 * ones in its support. */
static long by_growth(Work *w, int32_t *id, const long *order, Err *err)
{
  const Parts *p = w->p;
  long found = 0;
  w->n = p->n;
  memcpy(w->list, order, (size_t)p->n * sizeof *order);
  if (group_potential(p, w->list, NULL, w->n, w->o->theta, w->phi, err)) return -1;
  while (w->n >= w->o->least) {
    long seed = w->list[deepest(w)], kept = 0;
    for (long k = 0; k < w->n; k++)
      w->in[k] = group_apart(p->x + 3 * w->list[k], p->x + 3 * seed) < p->h[seed];
    long n = settle(w, judge_point, err);
    if (n >= w->o->least) found++;
    for (long k = 0; k < w->n; k++) {
      long i = w->list[k];
      if (n >= w->o->least && w->in[k]) id[i] = (int32_t)found;
      if (!w->in[k] && i != seed) w->phi[kept] = w->phi[k], w->list[kept++] = i;
    }
    w->n = kept;
  }
  return found;
}

long clump_find(const Parts *p, const ClumpOptions *o, int32_t *id, Err *err)
{
  Work w;
  long found = -1, *order = malloc(((size_t)p->n + 1) * sizeof *order);
  memset(id, 0, (size_t)p->n * sizeof *id);
  if (!work_room(&w, p, o, err) && order && !group_order(p, order, err))
    found = o->grow ? by_growth(&w, id, order, err) : by_potential(&w, id, order, err);
  if (!order) err_set(err, "out of memory for %ld particles", p->n);
  work_free(&w), free(order);
  return found < 0 ? -1 : group_rank(p, id, found, o->least, err);
}

int clump_levels(const Parts *p, const long *list, long n, double theta, double mass[CLUMP_LEVELS],
                 Err *err)
{
  Work w;
  ClumpOptions o = {.theta = theta};
  double v[3];
  int failed = work_room(&w, p, &o, err);
  if (!failed) {
    w.n = n;
    memcpy(w.list, list, (size_t)n * sizeof *list), memset(w.in, 1, (size_t)n);
    failed = group_potential(p, w.list, NULL, n, theta, w.phi, err);
  }
  if (!failed) frame(&w, w.in, v);
  for (int l = 0; l < CLUMP_LEVELS && !failed; l++) {
    int there = (l < CLUMP_THERMAL || p->u) && (l < CLUMP_ENTHALPY || (p->p && p->rho));
    mass[l] = there ? 0 : NAN;
    for (long k = 0; k < n && there; k++)
      if (0.5 * speed2(p, list[k], v) + heat(p, list[k], l) + w.phi[k] < 0)
        mass[l] += p->m[list[k]];
  }
  work_free(&w);
  return failed;
}
