/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Both methods are fixed-point iterations on a set of members in which every candidate is judged in
 * the state before (Jacobi), so that no order matters; when two sets alternate their union is kept.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "bound.h"
#include "fof.h"
#include "group.h"
#include "ngb.h"
#include "pointmass.h"
#include "potential.h"
#include "sort.h"
#include "unit.h"

/* LARGE: sets that are worth all threads; smaller ones are worked on side by side. */
enum { ROUNDS = 100, LARGE = 20000 };
/* Mass fraction of a fragment that starts a body. */
#define CORE BOUND_CORE

/* Candidates, who of them is a member, and copies of what is asked of them again and again. */
typedef struct {
  const Parts *p;
  const ClumpOptions *o;
  long n, *list, *order;
  double *x, *v, *m, *heat; /* [n][3] m, m/s; kg; J/kg against the potential, without v^2/2 */
  double *phi, *key;        /* J/kg; scratch */
  unsigned char *in, *next, *before;
  double frame[3]; /* m/s, of the last judgement */
  int fresh;       /* phi is that of the members */
  int heavy;       /* a single member may hold others: it is a point mass */
  Potential pot;
} Work;

static int no_memory(long n, Err *err)
{
  return err_set(err, "out of memory for %ld particles", n);
}

static void work_close(Work *w)
{
  free(w->list), free(w->x), free(w->in), free(w->next), free(w->before);
  potential_close(&w->pot);
}

static int work_open(Work *w, const Parts *p, const ClumpOptions *o, const long *list, long n,
                     Err *err)
{
  const size_t room = (size_t)n + 1;
  *w = (Work){.p = p, .o = o, .n = n, .list = malloc(2 * room * sizeof *w->list)};
  w->x = malloc(10 * room * sizeof *w->x);
  w->in = calloc(room, 1), w->next = calloc(room, 1), w->before = calloc(room, 1);
  if (!w->list || !w->x || !w->in || !w->next || !w->before)
    return work_close(w), no_memory(n, err);
  w->order = w->list + room;
  w->v = w->x + 3 * n, w->m = w->v + 3 * n, w->heat = w->m + n, w->phi = w->heat + n;
  w->key = w->phi + n;
#pragma omp parallel for if (n >= LARGE)
  for (long k = 0; k < n; k++) {
    const long i = w->list[k] = list[k];
    memcpy(w->x + 3 * k, p->x + 3 * i, 3 * sizeof *w->x);
    memcpy(w->v + 3 * k, p->v + 3 * i, 3 * sizeof *w->v);
    w->m[k] = p->m[i], w->heat[k] = bound_heat(p, i, o->level);
  }
  return 0;
}

/* Who is bound in the potential of the members. */
static int judge(Work *w, Err *err)
{
  if (potential_sum(&w->pot, w->in, NULL, w->o->theta, w->phi, err)) return -1;
  for (long k = 0; k < w->n; k++) w->key[k] = w->in[k] ? w->phi[k] : INFINITY;
  if (bound_frame(w->n, w->key, w->m, w->v, w->order, w->frame, err)) return -1;
#pragma omp parallel for if (w->n >= LARGE)
  for (long k = 0; k < w->n; k++)
    w->next[k] = 0.5 * bound_speed2(w->v + 3 * k, w->frame) + w->heat[k] + w->phi[k] < 0;
  return 0;
}

typedef struct {
  double mass, x[3], v[3]; /* kg, m, m/s */
} Point;

static void point_add(Point *c, const Work *w, long k)
{
  for (int a = 0; a < 3; a++)
    c->x[a] += w->m[k] * w->x[3 * k + a], c->v[a] += w->m[k] * w->v[3 * k + a];
  c->mass += w->m[k];
}

static void point_end(Point *c)
{
  for (int a = 0; a < 3; a++) c->x[a] /= c->mass, c->v[a] /= c->mass;
}

/* A candidate adds its own mass (two-body problem). Who has left, m = 0, is not bound. */
static int point_binds(const Point *c, const Work *w, long k)
{
  const double d = group_apart(w->x + 3 * k, c->x),
               mu = UNIT_G * (c->mass + (w->in[k] ? 0 : w->m[k]));
  return w->m[k] > 0 && d * (0.5 * bound_speed2(w->v + 3 * k, c->v) + w->heat[k]) < mu;
}

/* The same as judge for the point mass of the members. */
static int judge_point(Work *w, Err *err)
{
  Point c = {0};
  (void)err;
  for (long k = 0; k < w->n; k++)
    if (w->in[k]) point_add(&c, w, k);
  point_end(&c);
#pragma omp parallel for if (w->n >= LARGE)
  for (long k = 0; k < w->n; k++) w->next[k] = (unsigned char)point_binds(&c, w, k);
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
  memset(w->before, 2, n), w->fresh = 0;
  for (int round = 0; round < ROUNDS && members(w) > !w->heavy && !w->fresh; round++) {
    if (rule(w, err)) return -1;
    w->fresh = !memcmp(w->next, w->in, n);
    if (w->fresh) continue;
    if (!memcmp(w->next, w->before, n)) {
      for (size_t k = 0; k < n; k++) w->in[k] |= w->next[k];
      break;
    }
    unsigned char *old = w->before;
    w->before = w->in, w->in = w->next, w->next = old;
  }
  return members(w);
}

/* The members are the candidates nearest to the deepest one, a part of the mass, but `least` of
 * them; open [n]: who is a candidate still. Returns how many are; if too few, none is a member. */
static long core(Work *w, const unsigned char *open, const double *depth, double part, Err *err)
{
  double mass = 0, sum = 0;
  long low = -1, left = 0;
  for (long k = 0; k < w->n; k++)
    if (open[k] && left++ >= 0 && (low < 0 || depth[k] < depth[low])) low = k;
  memset(w->in, 0, (size_t)w->n);
  if (left < w->o->least) return left;
  for (long k = 0; k < w->n; k++) {
    w->key[k] = open[k] ? group_apart(w->x + 3 * k, w->x + 3 * low) : INFINITY;
    mass += open[k] ? w->m[k] : 0;
  }
  if (sort_reals(w->n, w->key, w->order)) return no_memory(w->n, err);
  for (long k = 0; k < left && (sum < part * mass || k < w->o->least); k++)
    w->in[w->order[k]] = 1, sum += w->m[w->order[k]];
  return left;
}

/* How many of the members would be bound to them alone; 0 when it is less than a tenth: some of any
 * crowd go the same way. */
static long holds(const Work *w, Err *err)
{
  const size_t room = (size_t)members(w) + 1;
  long *list = malloc(room * sizeof *list), n = 0, bound = -1;
  double *own = malloc(room * sizeof *own), mass;
  for (long k = 0; k < w->n && list && own; k++)
    if (w->in[k]) list[n++] = w->list[k];
  if (!list || !own) no_memory(n, err);
  if (list && own && !potential_own(w->p, list, n, w->o->theta, own, err))
    bound = bound_count(w->p, list, n, own, w->o->level, &mass, err);
  free(list), free(own);
  return bound >= 0 && (double)bound < CORE * (double)n ? 0 : bound;
}

/* The first body that the candidates hold, as members: from a core around the deepest, or, as what
 * is hot holds only as a whole, from more and more around it; then from cores around the deepest
 * left, each given up when it does not hold: taken [n]. Returns its size, 0: there is none. */
static long first_body(Work *w, unsigned char *taken, Err *err)
{
  const size_t n = (size_t)w->n;
  unsigned char *open = malloc(n + 1);
  double *depth = malloc((n + 1) * sizeof *depth), part = CORE;
  long bound = open && depth ? 0 : no_memory(w->n, err), left = w->n;
  if (!bound && potential_sum(&w->pot, NULL, NULL, w->o->theta, depth, err)) bound = -1;
  if (open) memset(open, 1, n);
  while (bound == 0 && (left = core(w, open, depth, part, err)) >= w->o->least) {
    bound = holds(w, err);
    if (bound >= w->o->least) bound = settle(w, judge, err);
    if (bound < 0 || bound >= w->o->least) break;
    bound = 0;
    if (left == w->n && part < 1) {
      part = fmin(1, 2 * part);
      continue;
    }
    if (part > CORE) core(w, open, depth, part = CORE, err);
    for (long k = 0; k < w->n; k++)
      if (w->in[k]) taken[k] = 1, open[k] = 0;
  }
  if (bound == 0 && left < w->o->least) memset(taken, 1, n);
  free(open), free(depth);
  return left < 0 ? -1 : bound;
}

/* What is found: the body of each particle and the potential of that body; the frame of each body,
 * and whether its potentials are out of date. */
typedef struct {
  const Parts *p;
  const ClumpOptions *o;
  int32_t *id;
  double *phi; /* J/kg */
  long found;
  double (*frame)[3];   /* [found + 1] m/s */
  unsigned char *stale; /* [found + 1] */
} Found;

static int found_more(Found *f, long n, Err *err)
{
  const size_t room = (size_t)(f->found + n + 1);
  void *frames = realloc(f->frame, room * sizeof *f->frame);
  if (frames) f->frame = frames;
  void *stale = realloc(f->stale, room);
  if (stale) f->stale = stale;
  return frames && stale ? 0 : err_set(err, "out of memory for %ld bodies", f->found + n);
}

/* One body, `name`, out of the fragment list [n]; its particles, and those of cores that came to
 * nothing, are not searched again. */
static int search_fragment(Found *f, const long *list, long n, long name, unsigned char *keep,
                           Err *err)
{
  Work w;
  if (work_open(&w, f->p, f->o, list, n, err)) return -1;
  unsigned char *taken = calloc((size_t)n + 1, 1);
  long bound = taken ? potential_open(&w.pot, f->p, w.list, n, err) : no_memory(n, err);
  if (!bound) bound = first_body(&w, taken, err);
  for (long k = 0; k < n && bound >= 0; k++)
    if (taken[k]) keep[list[k]] = 0;
  for (long k = 0; k < n && bound > 0; k++)
    if (w.in[k]) keep[list[k]] = 0, f->id[list[k]] = (int32_t)name, f->phi[list[k]] = w.phi[k];
  memcpy(f->frame[name], w.frame, sizeof w.frame), f->stale[name] = !w.fresh;
  work_close(&w), free(taken);
  return bound < 0 ? -1 : 0;
}

/* A body at most out of each of the fragments that are there now; *more: some fragment was found.
 */
static int search_fragments(Found *f, unsigned char *keep, int32_t *frag, int *more, Err *err)
{
  int failed = 0;
  long *start, *list, n = fof_find(f->p, f->o->link, keep, f->o->least, frag, err);
  *more = n > 0;
  if (n < 0 || found_more(f, n, err) || group_lists(f->p, frag, n, &start, &list, err)) return -1;
  for (int small = 0; small < 2; small++) {
#pragma omp parallel for schedule(dynamic) reduction(| : failed) if (small)
    for (long k = 1; k <= n; k++) {
      Err why;
      const long size = start[k + 1] - start[k];
      if ((size < LARGE) != small || failed) continue;
      if (!search_fragment(f, list + start[k], size, f->found + k, keep, &why)) continue;
      failed = 1;
#pragma omp critical
      if (err) *err = why;
    }
  }
  f->found += n;
  free(start), free(list);
  return failed ? -1 : 0;
}

/* Loose particles, and the body that binds each of them most so far. */
typedef struct {
  long n, *list;
  double *energy; /* J/kg, < 0 where one binds it; with point masses over the body's mass */
  int32_t *to;
  unsigned char *near; /* scratch */
} Loose;

static void loose_free(Loose *l) { free(l->list), free(l->energy), free(l->to), free(l->near); }

static int loose_find(Loose *l, const Parts *p, const int32_t *id, Err *err)
{
  *l = (Loose){.list = malloc(((size_t)p->n + 1) * sizeof *l->list)};
  if (!l->list || group_order(p, l->list, err)) return loose_free(l), no_memory(p->n, err);
  for (long k = 0; k < p->n; k++)
    if (id[l->list[k]] == 0) l->list[l->n++] = l->list[k];
  l->energy = calloc((size_t)l->n + 1, sizeof *l->energy);
  l->to = calloc((size_t)l->n + 1, sizeof *l->to), l->near = malloc((size_t)l->n + 1);
  if (l->energy && l->to && l->near) return 0;
  return loose_free(l), no_memory(p->n, err);
}

/* Marks the loose particles that body list [n] could bind: at a distance d from the centre the
 * potential is no deeper than -G M/(d - rim). Returns how many. */
static long candidates(const Found *f, Loose *l, const long *list, long n, const double v[3])
{
  const Parts *p = f->p;
  double mass = 0, x[3] = {0}, rim = 0;
  long near = 0;
  for (long k = 0; k < n; k++) {
    for (int a = 0; a < 3; a++) x[a] += p->m[list[k]] * p->x[3 * list[k] + a];
    mass += p->m[list[k]];
  }
  for (int a = 0; a < 3; a++) x[a] /= mass;
  for (long k = 0; k < n; k++) rim = fmax(rim, group_apart(p->x + 3 * list[k], x));
#pragma omp parallel for reduction(+ : near) if (l->n >= LARGE)
  for (long k = 0; k < l->n; k++) {
    const long i = l->list[k];
    double d = group_apart(p->x + 3 * i, x) - rim,
           e = 0.5 * bound_speed2(p->v + 3 * i, v) + bound_heat(p, i, f->o->level);
    l->near[k] = d <= 0 || d * e < UNIT_G * mass;
    near += l->near[k];
  }
  return near;
}

/* Loose particles that body c, list [n], binds more than any body so far. */
static int bind(const Found *f, Loose *l, const long *list, long n, long c, Err *err)
{
  const Parts *p = f->p;
  const double *v = f->frame[c];
  long near = candidates(f, l, list, n, v), at = n;
  if (!near) return 0;
  const size_t room = (size_t)(n + near);
  long *all = malloc(room * sizeof *all), *who = malloc(room * sizeof *who);
  unsigned char *in = calloc(room, 1), *out = calloc(room, 1);
  double *phi = malloc(room * sizeof *phi);
  Potential pot = {0};
  double mass = 0;
  for (long k = 0; k < n; k++) mass += p->m[list[k]];
  int failed = all && who && in && out && phi ? 0 : no_memory(n + near, err);
  if (!failed) memcpy(all, list, (size_t)n * sizeof *all), memset(in, 1, (size_t)n);
  for (long k = 0; k < l->n && !failed; k++)
    if (l->near[k]) who[at] = k, out[at] = 1, all[at++] = l->list[k];
  failed = failed || potential_open(&pot, p, all, n + near, err) ||
           potential_sum(&pot, in, out, f->o->theta, phi, err);
  for (long k = n; k < n + near && !failed; k++) {
    double e =
        0.5 * bound_speed2(p->v + 3 * all[k], v) + bound_heat(p, all[k], f->o->level) + phi[k];
    if (p->point_rows) e /= mass; /* -G/(2 a): a star does not take what orbits its planets */
    if (e < l->energy[who[k]]) l->energy[who[k]] = e, l->to[who[k]] = (int32_t)c;
  }
  potential_close(&pot), free(all), free(who), free(in), free(out), free(phi);
  return failed ? -1 : 0;
}

/* One round: who is bound joins; grown [found + 1]: the bodies to be tried, then those that grew.
 * Returns how many joined, or -1. */
static long adopt_round(Found *f, Loose *l, unsigned char *grown, Err *err)
{
  long *start, *list, kept = 0, joined;
  int failed = 0;
  if (group_lists(f->p, f->id, f->found, &start, &list, err)) return -1;
  for (long c = 1; c <= f->found && !failed; c++)
    if (grown[c] && start[c + 1] > start[c])
      failed = bind(f, l, list + start[c], start[c + 1] - start[c], c, err);
  free(start), free(list);
  if (failed) return -1;
  memset(grown, 0, (size_t)f->found + 1);
  for (long k = 0; k < l->n; k++) {
    const int32_t c = l->to[k];
    if (c)
      f->id[l->list[k]] = c, grown[c] = f->stale[c] = 1;
    else
      l->list[kept] = l->list[k], l->energy[kept] = l->energy[k], l->to[kept++] = 0;
  }
  joined = l->n - kept, l->n = kept;
  return joined;
}

/* Loose particles join the body that binds them most, until none is added; only bodies that grew
 * are tried again. A body keeps its frame. */
static int adopt(Found *f, Err *err)
{
  Loose l;
  unsigned char *grown = malloc((size_t)f->found + 1);
  if (!grown) return err_set(err, "out of memory for %ld bodies", f->found);
  if (loose_find(&l, f->p, f->id, err)) return free(grown), -1;
  memset(grown, 1, (size_t)f->found + 1);
  long joined = 1;
  for (int round = 0; round < ROUNDS && joined > 0 && l.n > 0; round++)
    joined = adopt_round(f, &l, grown, err);
  free(grown), loose_free(&l);
  return joined < 0 ? -1 : 0;
}

/* A point mass that is in no body is one of its own. */
static int lone_points(Found *f, Err *err)
{
  const Parts *p = f->p;
  if (p->point_rows && found_more(f, p->point_rows, err)) return -1;
  for (long i = p->n - p->point_rows; i < p->n; i++) {
    if (f->id[i]) continue;
    f->id[i] = (int32_t)++f->found, f->stale[f->found] = 1;
    memcpy(f->frame[f->found], p->v + 3 * i, sizeof f->frame[0]);
  }
  return 0;
}

static int by_potential(Found *f, Err *err)
{
  unsigned char *keep = malloc((size_t)f->p->n + 1);
  int32_t *frag = malloc(((size_t)f->p->n + 1) * sizeof *frag);
  int more = 1, failed = keep && frag ? 0 : no_memory(f->p->n, err);
  if (keep) memset(keep, 1, (size_t)f->p->n + 1);
  while (more && !failed) failed = search_fragments(f, keep, frag, &more, err);
  free(keep), free(frag);
  return failed || lone_points(f, err) ? -1 : adopt(f, err);
}

/* Where the particles are, and where each is among the candidates. */
typedef struct {
  Work *w;
  Tree tree;
  long *order, *at; /* particle of the tree's k-th; its place in w, -1: it has left */
  double *x;        /* [n][3] m, in the tree's order */
  long *near, n;    /* places in w of what was found */
} Places;

static void places_close(Places *s) { tree_free(&s->tree), free(s->order), free(s->x); }

static int places_open(Places *s, Work *w, Err *err)
{
  const Parts *p = w->p;
  const size_t room = (size_t)p->n + 1;
  *s = (Places){.w = w, .order = malloc(3 * room * sizeof *s->order)};
  s->x = malloc(3 * room * sizeof *s->x);
  if (!s->order || !s->x) return places_close(s), no_memory(p->n, err);
  s->at = s->order + room, s->near = s->at + room;
  if (tree_order(p->n, p->x, p->id, 0, s->order, err)) return places_close(s), -1;
  for (long k = 0; k < p->n; k++) memcpy(s->x + 3 * k, p->x + 3 * s->order[k], 3 * sizeof *s->x);
  for (long k = 0; k < w->n; k++) s->at[w->list[k]] = k;
  return tree_build(&s->tree, p->n, s->x, NULL, NULL, err) ? places_close(s), -1 : 0;
}

static void found_near(long j, double r2, void *data)
{
  Places *s = data;
  const long k = s->at[s->order[j]];
  (void)r2;
  if (k >= 0) s->near[s->n++] = k;
}

/* Makes members of the free particles in the seed's support; 0 when they do not hold at all, fewer
 * than two of them bound to their point mass: then there are no members. */
static int sow(Places *s, long seed)
{
  Work *w = s->w;
  Point c = {0};
  long bound = 0;
  s->n = 0;
  if (w->heavy) return w->in[seed] = 1;
  ngb_point(&s->tree, s->x, NULL, w->x + 3 * seed, w->p->h[w->list[seed]], found_near, s);
  for (long k = 0; k < s->n; k++) w->in[s->near[k]] = 1, point_add(&c, w, s->near[k]);
  point_end(&c);
  for (long k = 0; k < s->n; k++) bound += point_binds(&c, w, s->near[k]);
  for (long k = 0; k < s->n && bound < 2; k++) w->in[s->near[k]] = 0;
  return bound >= 2;
}

static void leave(Places *s, long k) { s->w->m[k] = 0, s->w->in[k] = 0, s->at[s->w->list[k]] = -1; }

/* The free particles move up; who has left (m = 0) goes. */
static void close_ranks(Places *s)
{
  Work *w = s->w;
  long kept = 0;
  for (long k = 0; k < w->n; k++) {
    if (w->m[k] <= 0) continue;
    memmove(w->x + 3 * kept, w->x + 3 * k, 3 * sizeof *w->x);
    memmove(w->v + 3 * kept, w->v + 3 * k, 3 * sizeof *w->v);
    w->m[kept] = w->m[k], w->heat[kept] = w->heat[k], w->list[kept] = w->list[k];
    s->at[w->list[kept]] = kept, kept++;
  }
  w->n = kept;
  memset(w->in, 0, (size_t)kept);
}

/* Bodies from seeds, the candidates of w in their order: a seed and the free particles in its
 * support. What does not hold leaves as a body does. */
static int grow_bodies(Found *f, Places *s, Err *err)
{
  Work *w = s->w;
  long left = w->n, points = w->p->point_rows;
  for (long seed = 0; (left >= f->o->least || seed < points) && seed < w->n; seed++) {
    if (w->m[seed] <= 0) continue;
    w->heavy = pointmass_row(w->p, w->list[seed]);
    const int holds_some = sow(s, seed);
    const long n = holds_some ? settle(w, judge_point, err) : 0;
    const int is = n >= f->o->least || w->heavy;
    if (n < 0 || (is && found_more(f, 1, err))) return -1;
    if (is) f->stale[++f->found] = 1;
    for (long k = 0; k < w->n && holds_some; k++) {
      if (!w->in[k] || k == seed) continue;
      if (is) f->id[w->list[k]] = (int32_t)f->found;
      leave(s, k), left--;
    }
    if (is && w->in[seed]) f->id[w->list[seed]] = (int32_t)f->found;
    leave(s, seed), left--;
    if (left < w->n / 2) close_ranks(s), seed = -1, points = w->p->point_rows;
  }
  return 0;
}

/* Point masses first, by descending mass. */
static int heavy_first(const Parts *p, long *deep, Err *err)
{
  const long n = p->n - p->point_rows;
  double *light = malloc(((size_t)p->point_rows + 1) * sizeof *light);
  long *order = malloc(((size_t)p->point_rows + 1) * sizeof *order), last = p->n;
  for (long k = 0; k < p->point_rows && light; k++) light[k] = -p->m[n + k];
  int failed = !light || !order || sort_reals(p->point_rows, light, order);
  for (long k = p->n - 1; k >= 0 && !failed; k--)
    if (!pointmass_row(p, deep[k])) deep[--last] = deep[k];
  for (long k = 0; k < p->point_rows && !failed; k++) deep[k] = n + order[k];
  free(light), free(order);
  return failed ? no_memory(p->point_rows, err) : 0;
}

/* Seeds in the order of the potential of the whole system, equal ones by id. */
static int by_growth(Found *f, Err *err)
{
  const long n = f->p->n;
  long *order = malloc(2 * ((size_t)n + 1) * sizeof *order), *deep = order + n + 1;
  int failed = order ? group_order(f->p, order, err) : no_memory(n, err);
  if (!failed) failed = potential_own(f->p, order, n, f->o->theta, f->phi, err);
  if (!failed && sort_reals(n, f->phi, deep)) failed = no_memory(n, err);
  for (long k = 0; k < n && !failed; k++) deep[k] = order[deep[k]];
  if (f->p->point_rows && !failed) failed = heavy_first(f->p, deep, err);
  Work w;
  Places s;
  if (!failed && !(failed = work_open(&w, f->p, f->o, deep, n, err))) {
    if (!(failed = places_open(&s, &w, err))) failed = grow_bodies(f, &s, err), places_close(&s);
    work_close(&w);
  }
  free(order);
  return failed;
}

/* The potentials of bodies that have changed since theirs were found; NAN outside. */
static int refresh(Found *f, Err *err)
{
  long *start, *list;
  int failed = group_lists(f->p, f->id, f->found, &start, &list, err);
  if (failed) return -1;
  for (long i = 0; i < f->p->n; i++)
    if (!f->id[i]) f->phi[i] = NAN;
  for (long c = 1; c <= f->found && !failed; c++) {
    const long *own = list + start[c], n = start[c + 1] - start[c];
    if (!f->stale[c] || !n) continue;
    double *phi = malloc((size_t)n * sizeof *phi);
    failed = phi ? potential_own(f->p, own, n, f->o->theta, phi, err) : no_memory(n, err);
    for (long k = 0; k < n && !failed; k++) f->phi[own[k]] = phi[k];
    free(phi);
  }
  free(start), free(list);
  return failed;
}

long clump_find(const Parts *p, const ClumpOptions *o, int32_t *id, double *phi, Err *err)
{
  Found f = {.p = p, .o = o, .id = id, .phi = phi};
  memset(id, 0, (size_t)p->n * sizeof *id);
  int failed = found_more(&f, 0, err) || (o->grow ? by_growth(&f, err) : by_potential(&f, err)) ||
               refresh(&f, err);
  free(f.frame), free(f.stale);
  return failed ? -1 : group_rank(p, id, f.found, o->least, err);
}

int clump_levels(const Parts *p, const long *list, long n, const double *phi,
                 double mass[CLUMP_LEVELS], Err *err)
{
  double *own = malloc(((size_t)n + 1) * sizeof *own);
  long bound = own ? 0 : no_memory(n, err);
  for (long k = 0; k < n && own; k++) own[k] = phi[list[k]];
  for (int l = 0; l < CLUMP_LEVELS && bound >= 0; l++) {
    mass[l] = NAN;
    if ((l < CLUMP_THERMAL || p->u) && (l < CLUMP_ENTHALPY || (p->p && p->rho)))
      bound = bound_count(p, list, n, own, l, &mass[l], err);
  }
  free(own);
  return bound < 0 ? -1 : 0;
}
