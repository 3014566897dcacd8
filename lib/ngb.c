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

enum { PAD = 32 };
#define INLINE static inline __attribute__((always_inline))

typedef struct {
  double lo[3], hi[3];
} Box;

typedef struct NgbShare {
  uint32_t *list; /* of all groups of this thread */
  int64_t n, room;
  float *pack;   /* 7 rows of [width]: x y z h, and x y z of the second set */
  uint8_t *hit;  /* [width] 0 no, 1 perhaps, 2 yes */
  uint32_t *j;   /* [width] the particles packed */
  int32_t *leaf; /* [leaves] found by the walk */
  int64_t leaf_room;
  long width;
} Share;

typedef struct {
  const Tree *t;
  const double *x, *y, *h; /* y may be NULL */
  double half;             /* factor/2 */
  const Box *box;          /* of the nodes at y */
} Search;

typedef struct {
  int32_t share; /* whose list */
  int64_t at;    /* where in it */
} Place;

static inline double sq(double x) { return x * x; }

static void box_add(Box *b, const double lo[3], const double hi[3])
{
  for (int d = 0; d < 3; d++) {
    b->lo[d] = b->lo[d] < lo[d] ? b->lo[d] : lo[d];
    b->hi[d] = b->hi[d] > hi[d] ? b->hi[d] : hi[d];
  }
}

static Box box_of(const double *x, long first, long count)
{
  const double *p = x + 3 * first;
  Box b = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
  for (long i = 1; i < count; i++) box_add(&b, p + 3 * i, p + 3 * i);
  return b;
}

static double gap(const double alo[3], const double ahi[3], const double blo[3],
                  const double bhi[3])
{
  double d2 = 0;
  for (int d = 0; d < 3; d++) d2 += sq(fmax(0, fmax(alo[d] - bhi[d], blo[d] - ahi[d])));
  return d2;
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

/* The leaves that the group's particles may reach at x or at y, and the number of their particles,
 * or -1. */
static long find_leaves(Share *w, const Search *s, const TreeGroup *g, const Box *at_y,
                        long *leaves)
{
  long particles = 0;
  *leaves = 0;
  for (int32_t k = 0; k < s->t->nodes;) {
    const TreeNode *p = s->t->node + k;
    const double r2 = sq(s->half * (g->hmax + p->hmax)) * (1 + 1e-12);
    int far = gap(g->lo, g->hi, p->lo, p->hi) > r2 &&
              !(s->y && gap(at_y->lo, at_y->hi, s->box[k].lo, s->box[k].hi) <= r2);
    if (!far && p->leaf) {
      if (grow(&w->leaf, &w->leaf_room, *leaves + 1, sizeof *w->leaf)) return -1;
      w->leaf[(*leaves)++] = k, particles += p->count;
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

/* Appends the coordinates of particles b .. e-1 relative to a centre; returns the largest of them.
 */
static float pack_set(float *const to[3], const double *x, long b, long e, const double centre[3],
                      double scale)
{
  float far = 0;
  for (int d = 0; d < 3; d++)
    for (long i = b; i < e; i++) {
      float c = (float)((x[3 * i + d] - centre[d]) * scale);
      to[d][i - b] = c;
      far = fmaxf(far, fabsf(c));
    }
  return far;
}

/* Packs the leaves; returns the largest coordinate. self: where the group's first particle stands.
 */
static float pack_leaves(Share *w, const Search *s, const TreeGroup *g, const Box *at_y,
                         long leaves, long *self)
{
  const double scale = 1 / s->t->edge;
  double cx[3], cy[3];
  float far = 0;
  long n = 0;
  for (int d = 0; d < 3; d++)
    cx[d] = 0.5 * (g->lo[d] + g->hi[d]), cy[d] = 0.5 * (at_y->lo[d] + at_y->hi[d]);
  for (long k = 0; k < leaves; k++) {
    const TreeNode *p = s->t->node + w->leaf[k];
    const long b = p->first, e = b + p->count;
    float *to[7];
    for (int d = 0; d < 7; d++) to[d] = w->pack + d * w->width + n;
    if (b <= g->first && g->first < e) *self = n + g->first - b;
    far = fmaxf(far, pack_set(to, s->x, b, e, cx, scale));
    if (s->y) far = fmaxf(far, pack_set(to + 4, s->y, b, e, cy, scale));
    for (long i = b; i < e; i++, n++) {
      w->j[n] = (uint32_t)i;
      to[3][i - b] = (float)(s->half * s->h[i] * scale);
    }
  }
  for (; n & (PAD - 1); n++) /* never within reach */
    for (int d = 0; d < 7; d++) w->pack[d * w->width + n] = d == 3 ? 0 : INFINITY;
  return far;
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
    const int doubt = (any & 0x0101010101010101) != 0;
    for (long k = b; k < b + 8; k++) {
      out[found] = w->j[k];
      found += w->hit[k] >> 1 || (doubt && w->hit[k] && near_pair(s, i, w->j[k]));
    }
  }
  return found;
}

static int search_group(Share *w, const Search *s, const TreeGroup *g, int64_t *start)
{
  const Box at_y = s->y ? box_of(s->y, g->first, g->count) : (Box){0};
  long leaves, self = 0, n = find_leaves(w, s, g, &at_y, &leaves);
  if (n < 0 || make_room(w, n)) return -1;
  const float tau = pack_leaves(w, s, g, &at_y, leaves, &self) * 0x1p-18f;
  for (long k = 0; k < g->count; k++) {
    const long i = g->first + k;
    if (grow(&w->list, &w->room, w->n + n + 8, sizeof *w->list)) return -1;
    if (s->y)
      test(w, n, self + k, tau, 1);
    else
      test(w, n, self + k, tau, 0);
    w->hit[self + k] = 0;
    w->n += start[i + 1] = take(w, s, i, n, w->list + w->n);
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
    if (t->node[k].leaf) box[k] = box_of(y, t->node[k].first, t->node[k].count);
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
      failed = search_group(w, s, t->group + k, g->start) != 0;
    }
  }
  failed = failed || gather(g, t, place);
  free(place);
  return failed ? -1 : 0;
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

int ngb_search(Ngb *g, const Tree *t, const double *x, const double *y, const double *h,
               double factor, Err *err)
{
  Search s = {t, x, y, h, 0.5 * factor, NULL};
  const long bad = check(&s, t->n);
  if (bad >= 0)
    return err_set(
        err, "cannot search neighbours: particle number %ld is not as in the tree (or not finite)",
        bad);
  Box *box = y ? boxes_at(t, y) : NULL;
  s.box = box;
  int failed = (y && !box) || prepare(g, t->n) || search(g, &s);
  free(box);
  return failed ? err_set(err, "cannot list the neighbours of %ld particles: no memory", t->n) : 0;
}

void ngb_point(const Tree *t, const double *x, const double *h, const double x0[3], double radius,
               void (*visit)(long j, double r2, void *data), void *data)
{
  for (int32_t k = 0; k < t->nodes;) {
    const TreeNode *p = t->node + k;
    const double reach = h ? fmax(radius, p->hmax) : radius;
    if (gap(x0, x0, p->lo, p->hi) > sq(reach) * (1 + 1e-12)) {
      k = p->skip;
      continue;
    }
    for (long j = p->first; p->leaf && j < p->first + (long)p->count; j++) {
      const double *b = x + 3 * j;
      double r2 = sq(x0[0] - b[0]) + sq(x0[1] - b[1]) + sq(x0[2] - b[2]);
      if (r2 < sq(h ? fmax(radius, h[j]) : radius)) visit(j, r2, data);
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
  for (int k = 0; k < g->shares; k++) {
    Share *w = g->share + k;
    free(w->list), free(w->pack), free(w->hit), free(w->j), free(w->leaf);
  }
  free(g->start), free(g->list), free(g->share);
  *g = (Ngb){0};
}
