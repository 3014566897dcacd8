/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One walk of the tree for a group makes two lists: nodes to be taken as multipoles, and leaves.
 * Both are packed into vectors relative to the group's centre; each target then sums over them
 * (gravity_pair.h). */
#include <math.h>
#include <stdlib.h>
#include "gravity.h"

enum { PAD = 16, ALIGN = 64, PULL = 1, POTENTIAL = 2, PLUMMER = 4 };
#define INLINE static inline __attribute__((always_inline))

typedef struct {
  const double *x, *m, *h; /* h may be NULL */
  double *a, *phi;         /* one may be NULL */
  const unsigned char *only;
  const double *trace; /* [nodes] sum m r^2 about com; PLUMMER only */
} Bodies;

typedef struct {
  double origin[3], length, mass; /* units of the lists: m, kg */
  double G, near;                 /* near: in units of length */
  double support;                 /* m; of all, when there is no h */
  double eps2;                    /* of PLUMMER, in units of length^2; 0: splines */
} Scale;

typedef struct {
  int32_t first, end;
} Range;

typedef struct {
  int32_t *node; /* accepted */
  Range *range;  /* particles of opened leaves, ascending; adjacent leaves are one range */
  long nodes, ranges, particles, room;
} Walk;

#undef REAL /* of hd.h */
static inline float root_f(float x) { return sqrtf(x); }
static inline double root_d(double x) { return sqrt(x); }

#define REAL    float
#define NAME(x) x##_f
#include "gravity_pair.h"
#undef REAL
#undef NAME
#define REAL    double
#define NAME(x) x##_d
#include "gravity_pair.h"

/* Room for one more entry in each list. */
static int more_room(Walk *w)
{
  if (w->nodes < w->room && w->ranges < w->room) return 0;
  const long room = 2 * w->room + 1024;
  int32_t *node = realloc(w->node, (size_t)room * sizeof *node);
  if (node) w->node = node;
  Range *range = realloc(w->range, (size_t)room * sizeof *range);
  if (range) w->range = range;
  if (!node || !range) return -1;
  w->room = room;
  return 0;
}

static int walk_tree(Walk *w, const Tree *t, const TreeGroup *g, const GravityOptions *o)
{
  const double epsilon = o->epsilon / t->edge;
  const int plummer = o->softening == SOFTENING_PLUMMER, one = epsilon > 0;
  const float itheta = o->theta > 0 ? (float)(1 / o->theta) : INFINITY,
              h = (float)(g->hmax / t->edge), eps2 = plummer ? (float)(epsilon * epsilon) : 0,
              support = plummer ? 0 : (float)(SOFTENING_SUPPORT * epsilon);
  float lo[3], hi[3];
  tree_outward(t, g->lo, g->hi, lo, hi);
  w->nodes = w->ranges = w->particles = 0;
  for (int32_t k = 0; k < t->nodes;) {
    const TreeWalk *p = t->walk + k;
    const float far = p->open * itheta, soft = one ? support : 0.5f * (h + p->hmax);
    if (more_room(w)) return -1;
    if (p->count > 1 && tree_gap2(lo, hi, p->com, p->com) + eps2 > far * far &&
        tree_gap2(lo, hi, p->lo, p->hi) > soft * soft * 1.00001f) {
      w->node[w->nodes++] = k, k = p->skip;
    } else if (p->skip == k + 1) {
      const int adjacent = w->ranges && w->range[w->ranges - 1].end == p->first;
      if (!adjacent) w->range[w->ranges++].first = p->first;
      w->range[w->ranges - 1].end = p->first + p->count;
      w->particles += p->count, k = p->skip;
    } else {
      k++;
    }
  }
  return 0;
}

static double distance2(const double a[3], const double b[3])
{
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

/* The next above x, so that scaling rounds nothing; 1 for 0. */
static double power_of_2(double x)
{
  int e = 0;
  if (x > 0) frexp(x, &e);
  return ldexp(1, e);
}

static int wanted(const Bodies *p, const TreeGroup *g)
{
  for (long i = g->first; i < g->first + (long)g->count && p->only; i++)
    if (p->only[i]) return 1;
  return !p->only;
}

/* Sums over lists in units of about the size of all and their mass. */
static Scale scale_of(const GravityOptions *o, double length, double mass, int single)
{
  const double epsilon = o->epsilon / length, near = single ? 1e-10 : 1e-80,
               least = fmax(epsilon, near);
  return (Scale){.length = length,
                 .mass = mass,
                 .G = o->G,
                 .near = near,
                 .support = SOFTENING_SUPPORT * o->epsilon,
                 .eps2 = o->softening == SOFTENING_PLUMMER ? least * least : 0};
}

/* sum m r^2 of each node's particles about its centre of mass, from the leaves up. */
static double *traces(const Tree *t, const double *x, const double *m)
{
  double *trace = calloc((size_t)t->nodes, sizeof *trace);
  for (int32_t k = t->nodes; trace && k-- > 0;) {
    const TreeNode *p = t->node + k, *c;
    for (long i = p->first; p->leaf && i < p->first + (long)p->count; i++)
      trace[k] += m[i] * distance2(x + 3 * i, p->com);
    for (int32_t j = k + 1; !p->leaf && j < p->skip; j = c->skip)
      c = t->node + j, trace[k] += trace[j] + c->mass * distance2(c->com, p->com);
  }
  return trace;
}

static int by_groups(const Tree *t, const Bodies *p, const GravityOptions *o, Err *err)
{
  const double far =
      fmax(t->edge, o->epsilon > 0 ? SOFTENING_SUPPORT * o->epsilon : t->node[0].hmax);
  const Scale s = scale_of(o, power_of_2(far), power_of_2(t->node[0].mass), o->single);
  int failed = 0;
#pragma omp parallel reduction(| : failed)
  {
    Walk w = {0};
    List_f nodes_f = {0}, parts_f = {0};
    List_d nodes_d = {0}, parts_d = {0};
#pragma omp for schedule(dynamic, 4)
    for (int32_t k = 0; k < t->groups; k++) {
      const TreeGroup *g = t->group + k;
      if (!wanted(p, g)) continue;
      if (failed || walk_tree(&w, t, g, o) ||
          (o->single ? group_f(&s, p, t, g, &w, &nodes_f, &parts_f)
                     : group_d(&s, p, t, g, &w, &nodes_d, &parts_d)))
        failed = 1;
    }
    free(w.node), free(w.range);
    free(nodes_f.all), free(parts_f.all), free(nodes_d.all), free(parts_d.all);
  }
  return failed ? err_set(err, "cannot sum the gravity of %ld particles: no memory", t->n) : 0;
}

/* As the options soften. */
static int softened(const Tree *t, Bodies p, const GravityOptions *o, Err *err)
{
  double *trace = NULL;
  if (o->softening == SOFTENING_PLUMMER && !(p.trace = trace = traces(t, p.x, p.m)))
    return err_set(err, "cannot sum the gravity of %ld particles: no memory", t->n);
  if (o->epsilon > 0) p.h = NULL;
  int failed = by_groups(t, &p, o, err);
  free(trace);
  return failed;
}

int gravity_tree(const Tree *t, const double *x, const double *m, const double *h,
                 const GravityOptions *o, double *a, double *phi, Err *err)
{
  return softened(t, (Bodies){x, m, h, a, phi, NULL, NULL}, o, err);
}

int gravity_potential(const Tree *t, const double *x, const double *m, const double *h,
                      const GravityOptions *o, const unsigned char *only, double *phi, Err *err)
{
  return softened(t, (Bodies){x, m, h, NULL, phi, only, NULL}, o, err);
}

int gravity_direct(long n, const double *x, const double *m, const double *h,
                   const GravityOptions *o, double *a, double *phi, Err *err)
{
  enum { SHARE = 64, SERIAL = 1024 }; /* SERIAL: fewer are not worth a second thread */
  const Bodies p = {x, m, o->epsilon > 0 ? NULL : h, a, phi, NULL, NULL};
  const Scale s = scale_of(o, 1, 1, 0);
  int failed = 0;
#pragma omp parallel reduction(| : failed) if (n > SERIAL)
  {
    List_d none = {0}, all = {0};
    failed = reserve_d(&none, 0) || reserve_d(&all, n);
    if (!failed) pack_particles_d(&all, &s, &p, 0, n), pad_d(&all);
#pragma omp for schedule(dynamic)
    for (long b = 0; b < n; b += SHARE)
      if (!failed) evaluate_d(&s, &p, b, b + SHARE < n ? b + SHARE : n, &none, &all, b);
    free(none.all), free(all.all);
  }
  return failed ? err_set(err, "cannot sum the gravity of %ld particles: no memory", n) : 0;
}
