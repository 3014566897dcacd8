/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A walk for a group finds the leaves that any of its particles may reach; their particles are
 * packed, in single precision relative to the group's centre, and tested against each target by
 * vector loops. Pairs within rounding of the limit are decided in double precision, so that lists
 * are exact and symmetric. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <omp.h>
#include "ngb.h"

enum { PAD = 64 };

#define INLINE static inline __attribute__((always_inline))

typedef struct {
  float lo[3], hi[3]; /* as in TreeWalk */
} Box;

typedef struct {
  int32_t first, end;
} Range;

typedef struct NgbShare {
  uint32_t *list; /* of all groups of this thread */
  int64_t n, room;
  float *pack;  /* 7 rows of [width]: x y z h, and x y z of the second set */
  uint8_t *hit; /* [width] 0 no, 1 perhaps, 2 yes */
  uint32_t *j;  /* [width] the particles packed */
  Range *
      range; /* [ranges] particles of the leaves within reach, ascending; adjacent leaves are one */
  int64_t ranges, range_room;
  long width;
} Share;

typedef struct {
  const Tree *t;
  const double *x, *y, *h; /* y may be NULL */
  double half;             /* factor/2 */
  float reach;             /* the same, rounded up */
  const Box *box;          /* of the nodes at y */
} Search;

typedef struct {
  int32_t share; /* whose list */
  int64_t at;    /* where in it */
} Place;

static inline double sq(double x) { return x * x; }
static inline double larger(double a, double b) { return a > b ? a : b; } /* fmax is a call */

static void box_add(Box *b, const float lo[3], const float hi[3])
{
  for (int d = 0; d < 3; d++) {
    b->lo[d] = b->lo[d] < lo[d] ? b->lo[d] : lo[d];
    b->hi[d] = b->hi[d] > hi[d] ? b->hi[d] : hi[d];
  }
}

static Box box_of(const Tree *t, const double *x, long first, long count)
{
  const double *p = x + 3 * first;
  double lo[3] = {p[0], p[1], p[2]}, hi[3] = {p[0], p[1], p[2]};
  for (long i = 1; i < count; i++)
    for (int d = 0; d < 3; d++) {
      lo[d] = p[3 * i + d] < lo[d] ? p[3 * i + d] : lo[d];
      hi[d] = p[3 * i + d] > hi[d] ? p[3 * i + d] : hi[d];
    }
  Box b;
  tree_outward(t, lo, hi, b.lo, b.hi);
  return b;
}

static int near_pair(const Search *s, long i, long j)
{
  const double *a = s->x + 3 * i, *b = s->x + 3 * j;
  double r2 = sq(s->half * (s->h[i] + s->h[j]));
  if (sq(a[0] - b[0]) + sq(a[1] - b[1]) + sq(a[2] - b[2]) < r2) return 1;
  if (!s->y) return 0;
  a = s->y + 3 * i, b = s->y + 3 * j;
  return sq(a[0] - b[0]) + sq(a[1] - b[1]) + sq(a[2] - b[2]) < r2;
}

/* Grows an array of `size` bytes an element to hold n; the contents are kept. */
static int grow(void *array, int64_t *room, int64_t n, size_t size)
{
  void **a = array;
  if (n <= *room) return 0;
  void *more = realloc(*a, (size_t)(n + n / 4) * size);
  if (!more) return -1;
  *a = more, *room = n + n / 4;
  return 0;
}

/* The leaves that the group's particles may reach at x or at y, as ranges, and a box around each
 * set of their positions; returns the number of their particles, or -1. */
static long find_ranges(Share *w, const Search *s, const TreeGroup *g, Box at[2])
{
  const Tree *t = s->t;
  const Box own[2] = {at[0], at[1]};
  const float h = (float)(g->hmax / t->edge);
  long particles = 0;
  w->ranges = 0;
  for (int32_t k = 0; k < t->nodes;) {
    const TreeWalk *p = t->walk + k;
    const float r2 = s->reach * (h + p->hmax) * s->reach * (h + p->hmax);
    int far = tree_gap2(own[0].lo, own[0].hi, p->lo, p->hi) > r2 &&
              !(s->y && tree_gap2(own[1].lo, own[1].hi, s->box[k].lo, s->box[k].hi) <= r2);
    if (!far && p->skip == k + 1) {
      if (grow(&w->range, &w->range_room, w->ranges + 1, sizeof *w->range)) return -1;
      if (!w->ranges || w->range[w->ranges - 1].end != p->first)
        w->range[w->ranges++].first = p->first;
      w->range[w->ranges - 1].end = p->first + p->count;
      particles += p->count;
      box_add(&at[0], p->lo, p->hi);
      if (s->y) box_add(&at[1], s->box[k].lo, s->box[k].hi);
    }
    k = far ? p->skip : k + 1;
  }
  return particles;
}

static int make_room(Share *w, long n)
{
  if (n + PAD <= w->width) return 0;
  free(w->pack), free(w->hit), free(w->j);
  w->width = (n + n / 4 + 2 * PAD) & ~(PAD - 1L);
  w->pack = aligned_alloc(64, (size_t)w->width * 7 * sizeof *w->pack);
  w->hit = aligned_alloc(64, (size_t)w->width);
  w->j = malloc((size_t)w->width * sizeof *w->j);
  if (w->pack && w->hit && w->j) return 0;
  free(w->pack), free(w->hit), free(w->j);
  w->pack = NULL, w->hit = NULL, w->j = NULL;
  return w->width = 0, -1;
}

/* Coordinates of particles b .. e-1 relative to a centre, from x[0], y[0], z[0] on. */
static void pack_set(float *restrict x, float *restrict y, float *restrict z,
                     const double *restrict p, long n, const double centre[3], double scale)
{
  const double cx = centre[0], cy = centre[1], cz = centre[2];
  for (long i = 0; i < n; i++) {
    x[i] = (float)((p[3 * i] - cx) * scale);
    y[i] = (float)((p[3 * i + 1] - cy) * scale);
    z[i] = (float)((p[3 * i + 2] - cz) * scale);
  }
}

/* Packs the ranges, in root edges. self: where the group's first particle stands. */
static void pack_ranges(Share *w, const Search *s, const TreeGroup *g, long *self)
{
  const double scale = 1 / s->t->edge, hscale = s->half * scale;
  const double *cx = s->x + 3 * (g->first + g->count / 2);
  const double *cy = s->y ? s->y + 3 * (g->first + g->count / 2) : NULL;
  const long width = w->width;
  long n = 0;
  for (const Range *r = w->range; r < w->range + w->ranges; r++) {
    const long b = r->first, m = r->end - b;
    float *x = w->pack + n, *h = x + 3 * width, *u = h + width;
    if (b <= g->first && g->first < r->end) *self = n + g->first - b;
    pack_set(x, x + width, x + 2 * width, s->x + 3 * b, m, cx, scale);
    if (s->y) pack_set(u, u + width, u + 2 * width, s->y + 3 * b, m, cy, scale);
    for (long i = 0; i < m; i++) h[i] = (float)(s->h[b + i] * hscale);
    for (long i = 0; i < m; i++) w->j[n + i] = (uint32_t)(b + i);
    n += m;
  }
  for (; n & (PAD - 1); n++) /* never within reach */
    for (int d = 0; d < 7; d++) w->pack[d * width + n] = d == 3 ? 0 : INFINITY;
}

/* An upper limit for the rounding error of a distance between packed particles: coordinates are at
 * most the longest edge c of the boxes; their error and that of r up to 1.8 c is in all below
 * 2^-24 (2.2 sqrt(3) c + 4 r) < 2^-18 c. */
static float rounding(const Box at[2])
{
  float c = 0;
  for (int k = 0; k < 2; k++)
    for (int d = 0; d < 3; d++) c = fmaxf(c, at[k].hi[d] - at[k].lo[d]);
  return 0x1p-18f * c;
}

/* hit[j] of target k: 0, 1 (within tau of the limit) or 2. */
INLINE void test(const Share *w, long n, long k, float tau, int two)
{
  const long width = w->width;
  const float *restrict x = w->pack, *restrict y = x + width, *restrict z = y + width,
                        *restrict h = z + width;
  const float *restrict u = h + width, *restrict v = u + width, *restrict q = v + width;
  const float xi = x[k], yi = y[k], zi = z[k], hi = h[k], ui = u[k], vi = v[k], qi = q[k];
  uint8_t *restrict hit = w->hit;
  n = (n + PAD - 1) & ~(PAD - 1L);
#pragma omp simd
  for (long j = 0; j < n; j++) {
    float r = hi + h[j], up = r + tau, lo = r > tau ? r - tau : 0;
    float r2 = (xi - x[j]) * (xi - x[j]) + (yi - y[j]) * (yi - y[j]) + (zi - z[j]) * (zi - z[j]);
    if (two) {
      float s2 = (ui - u[j]) * (ui - u[j]) + (vi - v[j]) * (vi - v[j]) + (qi - q[j]) * (qi - q[j]);
      r2 = s2 < r2 ? s2 : r2;
    }
    hit[j] = (uint8_t)((r2 < up * up) + (r2 < lo * lo));
  }
}

/* Appends the neighbours of i among n candidates to out; returns how many. */
static long take(const Share *w, const Search *s, long i, long n, uint32_t *out)
{
  long found = 0;
  for (long b = 0; b < n; b += 8) {
    uint64_t any;
    memcpy(&any, w->hit + b, 8);
    if (!any) continue;
    for (long k = b; k < b + 8 && any & 0x0101010101010101; k++)
      if (w->hit[k] == 1) w->hit[k] = near_pair(s, i, w->j[k]) ? 2 : 0;
    for (long k = b; k < b + 8; k++) out[found] = w->j[k], found += w->hit[k] >> 1;
  }
  return found;
}

/* Appends the neighbours of a group's particles to the list; count [g->count]: how many of each. */
static int search_group(Share *w, const Search *s, const TreeGroup *g, int64_t *count)
{
  Box at[2] = {box_of(s->t, s->x, g->first, g->count)};
  if (s->y) at[1] = box_of(s->t, s->y, g->first, g->count);
  long self = 0, n = find_ranges(w, s, g, at);
  if (n < 0 || make_room(w, n)) return -1;
  pack_ranges(w, s, g, &self);
  const float tau = rounding(at);
  for (long k = 0; k < g->count; k++) {
    const long i = g->first + k;
    if (grow(&w->list, &w->room, w->n + n + 8, sizeof *w->list)) return -1;
    if (s->y)
      test(w, n, self + k, tau, 1);
    else
      test(w, n, self + k, tau, 0);
    w->hit[self + k] = 0;
    w->n += count[k] = take(w, s, i, n, w->list + w->n);
  }
  return 0;
}

/* Boxes of the nodes at y. */
static Box *boxes_at(const Tree *t, const double *y)
{
  Box *box = malloc((size_t)t->nodes * sizeof *box);
  if (!box) return NULL;
#pragma omp parallel for schedule(static, 64)
  for (int32_t k = 0; k < t->nodes; k++)
    if (t->node[k].leaf) box[k] = box_of(t, y, t->node[k].first, t->node[k].count);
  for (int32_t k = t->nodes; k-- > 0;) {
    if (t->node[k].leaf) continue;
    box[k] = box[k + 1];
    for (int32_t c = k + 1; c < t->node[k].skip; c = t->node[c].skip)
      box_add(&box[k], box[c].lo, box[c].hi);
  }
  return box;
}

/* x and h must be those of the tree, or the walk would miss neighbours. Returns the number of a bad
 * particle or -1. */
static long check(const Search *s, long n)
{
  long bad = n;
#pragma omp parallel for reduction(min : bad)
  for (int32_t k = 0; k < s->t->groups; k++) {
    const TreeGroup *g = s->t->group + k;
    for (long i = g->first; i < g->first + (long)g->count; i++) {
      int good = s->h[i] >= 0 && s->h[i] <= g->hmax;
      for (int d = 0; d < 3; d++)
        good &= s->x[3 * i + d] >= g->lo[d] && s->x[3 * i + d] <= g->hi[d] &&
                (!s->y || isfinite(s->y[3 * i + d]));
      if (!good && i < bad) bad = i;
    }
  }
  return bad < n ? bad : -1;
}

/* The lists of all threads in the order of the particles. */
static int gather(Ngb *g, const Tree *t, const Place *place)
{
  g->start[0] = 0;
  for (long i = 0; i < t->n; i++) g->start[i + 1] += g->start[i];
  if (grow(&g->list, &g->room, g->start[t->n] + 1, sizeof *g->list)) return -1;
#pragma omp parallel for schedule(static)
  for (int32_t k = 0; k < t->groups; k++) {
    const int64_t b = g->start[t->group[k].first],
                  e = g->start[t->group[k].first + t->group[k].count];
    memcpy(g->list + b, g->share[place[k].share].list + place[k].at,
           (size_t)(e - b) * sizeof *g->list);
  }
  return 0;
}

static int search(Ngb *g, const Search *s)
{
  const Tree *t = s->t;
  Place *place = malloc((size_t)t->groups * sizeof *place);
  int failed = !place;
#pragma omp parallel num_threads(g->shares) reduction(| : failed)
  {
    const int me = omp_get_thread_num();
    Share *w = g->share + me;
    w->n = 0;
#pragma omp for schedule(dynamic, 4)
    for (int32_t k = 0; k < t->groups; k++) {
      if (failed) continue;
      place[k] = (Place){me, w->n};
      if (t->split && t->group[k].first >= t->split) {
        memset(g->start + t->group[k].first + 1, 0, (size_t)t->group[k].count * sizeof *g->start);
        continue;
      }
      failed = search_group(w, s, t->group + k, g->start + t->group[k].first + 1) != 0;
    }
  }
  failed = failed || gather(g, t, place);
  free(place);
  return failed ? -1 : 0;
}

static void share_free(Share *w)
{
  free(w->list), free(w->pack), free(w->hit), free(w->j), free(w->range);
}

/* Room for the counts and one share a thread. */
static int prepare(Ngb *g, long n)
{
  const int threads = omp_get_max_threads();
  int64_t *start =
      g->n == n && g->start ? g->start : realloc(g->start, (size_t)(n + 1) * sizeof *start);
  if (!start) return -1;
  g->start = start, g->n = n;
  if (threads <= g->shares) return 0;
  Share *share = realloc(g->share, (size_t)threads * sizeof *share);
  if (!share) return -1;
  memset(share + g->shares, 0, (size_t)(threads - g->shares) * sizeof *share);
  g->share = share, g->shares = threads;
  return 0;
}

static int bad_particle(long bad, Err *err)
{
  return err_set(
      err, "cannot search neighbours: particle number %ld is not as in the tree (or not finite)",
      bad);
}

int ngb_search(Ngb *g, const Tree *t, const double *x, const double *y, const double *h,
               double factor, Err *err)
{
  Search s = {t, x, y, h, 0.5 * factor, (float)(0.50001 * factor), NULL};
  const long bad = check(&s, t->n);
  if (bad >= 0) return bad_particle(bad, err);
  Box *box = y ? boxes_at(t, y) : NULL;
  s.box = box;
  int failed = (y && !box) || prepare(g, t->n) || search(g, &s);
  free(box);
  return failed ? err_set(err, "cannot list the neighbours of %ld particles: no memory", t->n) : 0;
}

int ngb_each(const Tree *t, const double *x, const double *h, double factor,
             void (*visit)(long i, const uint32_t *j, long n, void *data), void *data, Err *err)
{
  const Search s = {t, x, NULL, h, 0.5 * factor, (float)(0.50001 * factor), NULL};
  const long bad = check(&s, t->n);
  int failed = 0;
  if (bad >= 0) return bad_particle(bad, err);
#pragma omp parallel reduction(| : failed)
  {
    Share w = {0};
#pragma omp for schedule(dynamic, 4)
    for (int32_t k = 0; k < t->groups; k++) {
      int64_t count[TREE_GROUP], at = 0;
      const TreeGroup *g = t->group + k;
      w.n = 0;
      if (failed || (failed = search_group(&w, &s, g, count) != 0)) continue;
      for (long i = 0; i < g->count; at += count[i++])
        visit(g->first + i, w.list + at, (long)count[i], data);
    }
    share_free(&w);
  }
  return failed ? err_set(err, "cannot search the neighbours of %ld particles: no memory", t->n)
                : 0;
}

void ngb_point(const Tree *t, const double *x, const double *h, const double x0[3], double radius,
               void (*visit)(long j, double r2, void *data), void *data)
{
  const float least = (float)(1.00001 * radius / t->edge);
  float lo[3], hi[3];
  tree_outward(t, x0, x0, lo, hi);
  for (int32_t k = 0; k < t->nodes;) {
    const TreeWalk *p = t->walk + k;
    const float reach = h && p->hmax > least ? 1.00001f * p->hmax : least;
    if (tree_gap2(lo, hi, p->lo, p->hi) > reach * reach) {
      k = p->skip;
      continue;
    }
    for (long j = p->first; p->skip == k + 1 && j < p->first + (long)p->count; j++) {
      const double *b = x + 3 * j;
      double r2 = sq(x0[0] - b[0]) + sq(x0[1] - b[1]) + sq(x0[2] - b[2]);
      if (r2 < sq(h ? larger(radius, h[j]) : radius)) visit(j, r2, data);
    }
    k++;
  }
}

typedef struct {
  double *r; /* distances found */
  int64_t n, room;
  int failed;
} Distances;

static void note(long j, double r2, void *data)
{
  Distances *d = data;
  (void)j;
  d->failed |= grow(&d->r, &d->room, d->n + 1, sizeof *d->r);
  if (!d->failed) d->r[d->n++] = sqrt(r2);
}

/* sum of w = (1-q)^4 (1+4q) over the distances, and *slope = d/d ln h of it, -q w' = 20 q^2
 * (1-q)^3. */
static double kernel_sum(const Distances *d, double h, double *slope)
{
  double sum = 0;
  *slope = 0;
  for (int64_t k = 0; k < d->n; k++) {
    double q = d->r[k] / h, e = 1 - q;
    if (e <= 0) continue;
    sum += sq(sq(e)) * (1 + 4 * q);
    *slope += 20 * q * q * e * sq(e);
  }
  return sum;
}

/* h with kernel_sum = want, between 0 and high, where the sum is at least want: Newton steps in ln
 * h, halved intervals when they leave the bracket. 0 when even the smallest h holds more. */
static double solve(const Distances *d, double want, double high)
{
  double low = 0, h = high;
  for (int k = 0; k < 200; k++) {
    double slope, sum = kernel_sum(d, h, &slope), next;
    if (sum < want)
      low = h;
    else
      high = h;
    next = slope > 0 ? h * exp((want - sum) / slope) : 0;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (fabs(next - h) < 1e-7 * h) return next;
    h = next;
  }
  return 0;
}

/* h of particle i from a first guess: the support searched grows until it holds enough. 0: there is
 * none. */
static double find_h(Distances *d, const Tree *t, const double *x, long i, double want,
                     double guess)
{
  for (double h = guess; h < 1e6 * t->edge; h *= 1.26) {
    double slope;
    d->n = 0;
    ngb_point(t, x, NULL, x + 3 * i, h, note, d);
    if (d->failed) return 0;
    if (kernel_sum(d, h, &slope) >= want) return solve(d, want, h);
  }
  return 0;
}

int ngb_smoothing(const Tree *t, const double *x, int dimension, double want, double *h, Err *err)
{
  /* V(h) sigma/h^D: V n = want becomes sum w = want/this; sigma: 1/integral of w over the unit
   * ball. */
  const double norm = dimension == 3 ? 14 : dimension == 2 ? 7 : 3;
  const double target = want / norm;
  if (!(want > norm) || t->n <= target)
    return err_set(err, "no smoothing length holds %g of %ld particles", want, t->n);
  int failed = 0;
  long bad = t->n;
#pragma omp parallel reduction(| : failed) reduction(min : bad)
  {
    Distances d = {0};
#pragma omp for schedule(dynamic, 4)
    for (int32_t k = 0; k < t->groups; k++) {
      double guess = 1e-6 * t->edge;
      for (int c = 0; c < 3; c++)
        guess = fmax(guess, 0.5 * (t->group[k].hi[c] - t->group[k].lo[c]));
      for (long i = t->group[k].first; i < t->group[k].first + (long)t->group[k].count; i++) {
        h[i] = find_h(&d, t, x, i, target, guess);
        if (h[i] > 0)
          guess = 1.1 * h[i];
        else if (i < bad)
          bad = i;
      }
    }
    failed = d.failed;
    free(d.r);
  }
  if (failed) return err_set(err, "cannot find smoothing lengths: no memory");
  if (bad < t->n)
    return err_set(err, "particle number %ld has no smoothing length: too many at one place", bad);
  return 0;
}

void ngb_free(Ngb *g)
{
  for (int k = 0; k < g->shares; k++) share_free(g->share + k);
  free(g->start), free(g->list), free(g->share);
  *g = (Ngb){0};
}
