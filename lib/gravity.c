/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One walk of the tree for a group makes two lists: nodes to be taken as multipoles, and leaves.
 * Both are packed into vectors relative to the group's centre; each target then sums over them
 * (gravity_pair.h). */
#include <math.h>
#include <stdlib.h>
#include "gravity.h"

enum { PAD = 16, ALIGN = 64, PULL = 1, POTENTIAL = 2 };
#define INLINE static inline __attribute__((always_inline))
/* With M(q) = 14q^3 - 84q^5 + 140q^6 - 90q^7 + 21q^8, the mass of a Wendland C2 kernel within q. */
#define SOFT_FORCE(q) (14 + (q) * (q) * (-84 + (q) * (140 + (q) * (-90 + (q)*21))))
#define SOFT_POTENTIAL(q)                                                                          \
  (3 + (q) * (q) * (-7 + (q) * (q) * (21 + (q) * (-28 + (q) * (15 - (q)*3)))))

typedef struct {
  const double *x, *m, *h; /* h may be NULL */
  double *a, *phi;         /* one may be NULL */
  const unsigned char *only;
} Bodies;

typedef struct {
  double origin[3], length, mass; /* units of the lists: m, kg */
  double G, near;                 /* near: in units of length */
} Scale;

typedef struct {
  int32_t first, end;
} Range;

typedef struct {
  int32_t *node; /* accepted */
  Range *range;  /* particles of opened leaves, ascending; adjacent leaves are one range */
  long nodes, ranges, particles, room;
} Walk;

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

static int walk_tree(Walk *w, const Tree *t, const TreeGroup *g, double theta)
{
  const float itheta = theta > 0 ? (float)(1 / theta) : INFINITY, h = (float)(g->hmax / t->edge);
  float lo[3], hi[3];
  tree_outward(t, g->lo, g->hi, lo, hi);
  w->nodes = w->ranges = w->particles = 0;
  for (int32_t k = 0; k < t->nodes;) {
    const TreeWalk *p = t->walk + k;
    const float far = p->open * itheta, soft = 0.5f * (h + p->hmax);
    if (more_room(w)) return -1;
    if (p->count > 1 && tree_gap2(lo, hi, p->com, p->com) > far * far &&
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

static int by_groups(const Tree *t, const Bodies *p, const GravityOptions *o, Err *err)
{
  const Scale s = {.length = power_of_2(fmax(t->edge, t->node[0].hmax)),
                   .mass = power_of_2(t->node[0].mass),
                   .G = o->G,
                   .near = o->single ? 1e-10 : 1e-80};
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
      if (failed || walk_tree(&w, t, g, o->theta) ||
          (o->single ? group_f(&s, p, t, g, &w, &nodes_f, &parts_f)
                     : group_d(&s, p, t, g, &w, &nodes_d, &parts_d)))
        failed = 1;
    }
    free(w.node), free(w.range);
    free(nodes_f.all), free(parts_f.all), free(nodes_d.all), free(parts_d.all);
  }
  return failed ? err_set(err, "cannot sum the gravity of %ld particles: no memory", t->n) : 0;
}

int gravity_tree(const Tree *t, const double *x, const double *m, const double *h,
                 const GravityOptions *o, double *a, double *phi, Err *err)
{
  const Bodies p = {x, m, h, a, phi, NULL};
  return by_groups(t, &p, o, err);
}

int gravity_potential(const Tree *t, const double *x, const double *m, const double *h,
                      const GravityOptions *o, const unsigned char *only, double *phi, Err *err)
{
  const Bodies p = {x, m, h, NULL, phi, only};
  return by_groups(t, &p, o, err);
}

int gravity_direct(long n, const double *x, const double *m, const double *h, double G, double *a,
                   double *phi, Err *err)
{
  enum { SHARE = 64, SERIAL = 1024 }; /* SERIAL: fewer are not worth a second thread */
  const Bodies p = {x, m, h, a, phi, NULL};
  const Scale s = {.length = 1, .mass = 1, .G = G, .near = 1e-80};
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

double gravity_soft_force(double q) { return SOFT_FORCE(q); }
double gravity_soft_potential(double q) { return SOFT_POTENTIAL(q); }
