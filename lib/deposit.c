/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bands of rows (of layers, in a volume) are worked on in parallel; within a band particles come in
 * their order. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "bands.h"
#include "deposit.h"

#define PI 3.14159265358979323846f
enum { ROWS = 32, LAYERS = 4, SEGMENT = 256 };

/* Wendland C2 and its integral along a line at distance q, 2 int W(sqrt(q^2+s^2)) ds: fit of
 * (1-q)^4.5 times a cubic, with integral 1. */
static inline float shape_of(DepositShape shape, float q)
{
  float p = 1 - q, p2, w;
  p = p > 0 ? p : 0, p2 = p * p;
  if (shape == DEPOSIT_COLUMN)
    return p2 * p2 * sqrtf(p) * (2.227188f + q * (10.128939f + q * (9.339055f - 2.962984f * q)));
  w = p2 * p2 * (1 + 4 * q);
  return (shape == DEPOSIT_3D ? 21 / (2 * PI) : 7 / PI) * w;
}

float deposit_kernel(DepositShape shape, float q) { return shape_of(shape, q); }

int deposit_new(Deposit *d, const int n[3], const float cell[3], DepositShape shape, int fields,
                int kinds, Err *err)
{
  size_t cells = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
  *d = (Deposit){.shape = shape, .fields = fields};
  memcpy(d->n, n, sizeof d->n), memcpy(d->cell, cell, sizeof d->cell);
  d->sum = calloc(cells, sizeof *d->sum);
  d->mean = calloc((size_t)fields + 1, sizeof *d->mean);
  int failed = !d->sum || !d->mean;
  for (int f = 0; f < fields && !failed; f++)
    failed = !(d->mean[f] = calloc(cells, sizeof **d->mean));
  if (kinds && !failed) {
    d->best = calloc(cells, sizeof *d->best), d->kind = calloc(cells, sizeof *d->kind);
    d->inside = calloc(cells, 1);
    failed = !d->best || !d->kind || !d->inside;
  }
  if (!failed) return 0;
  deposit_free(d);
  return err_set(err, "out of memory for %d x %d x %d cells", n[0], n[1], n[2]);
}

void deposit_free(Deposit *d)
{
  for (int f = 0; d->mean && f < d->fields; f++) free(d->mean[f]);
  free(d->mean), free(d->sum), free(d->best), free(d->kind), free(d->inside);
  *d = (Deposit){0};
}

/* First and last cell whose centre may lie within reach; not clipped. */
static void reach(float x, float h, float cell, float *first, float *last)
{
  *first = ceilf((x - h) / cell - 0.5f), *last = floorf((x + h) / cell - 0.5f);
}

typedef struct {
  const DepositSpot *spot;
  const Deposit *grid;
} Things;

static void span(const void *things, long k, float *first, float *last)
{
  const Things *t = things;
  const DepositSpot *s = &t->spot[k];
  int axis = t->grid->n[2] > 1 ? 2 : 1;
  reach(s->x[axis], s->h, t->grid->cell[axis], first, last);
}

/* h^-dimension, or what makes the weights on the lattice sum up to 1. */
static float norm(const Deposit *d, const DepositSpot *s)
{
  int flat = d->shape != DEPOSIT_3D;
  const float *cell = d->cell;
  float least = fminf(cell[0], flat ? cell[1] : fminf(cell[1], cell[2])), first[3], last[3],
        top = flat ? 1 : s->h;
  double sum = 0;
  if (s->h >= d->exact * least) return 1 / (s->h * s->h * top);
  for (int a = 0; a < 3; a++) reach(s->x[a], s->h, cell[a], &first[a], &last[a]);
  if (flat) first[2] = last[2] = 0;
  for (float k = first[2]; k <= last[2]; k++)
    for (float j = first[1]; j <= last[1]; j++)
      for (float i = first[0]; i <= last[0]; i++) {
        float x = (i + 0.5f) * cell[0] - s->x[0], y = (j + 0.5f) * cell[1] - s->x[1],
              z = flat ? 0 : (k + 0.5f) * cell[2] - s->x[2];
        sum += shape_of(d->shape, sqrtf(x * x + y * y + z * z) / s->h);
      }
  return sum > 0 ? (float)(1 / (sum * cell[0] * cell[1] * (flat ? 1 : cell[2]))) : 0;
}

/* Cells i0 .. i0+n-1 of the row that begins at `at`, r2 off the spot in the other directions. */
static inline void row(Deposit *d, DepositShape shape, const DepositSpot *s, float amount, float r2,
                       int i0, int n, size_t at, float w[SEGMENT])
{
  float x0 = ((float)i0 + 0.5f) * d->cell[0] - s->x[0], step = d->cell[0], per = 1 / s->h,
        *sum = d->sum + at + i0;
  for (int i = 0; i < n; i++) {
    float x = x0 + (float)i * step;
    w[i] = amount * shape_of(shape, sqrtf(x * x + r2) * per);
  }
  for (int i = 0; i < n; i++) sum[i] += w[i];
}

static void note(Deposit *d, const DepositSpot *s, float value, float r2, int i0, int n, size_t at,
                 const float w[SEGMENT])
{
  for (int i = 0; i < n; i++) {
    size_t c = at + (size_t)(i0 + i);
    float x = ((float)(i0 + i) + 0.5f) * d->cell[0] - s->x[0];
    if (x * x + r2 < s->size * s->size) d->inside[c] = 1;
    if (w[i] > d->best[c]) d->best[c] = w[i], d->kind[c] = value;
  }
}

static void rows(Deposit *d, const DepositSpot *s, const float *value, float amount, float r2,
                 size_t at)
{
  float w[SEGMENT], room = sqrtf(fmaxf(0, s->h * s->h - r2)), first, last;
  reach(s->x[0], room, d->cell[0], &first, &last);
  if (!(last >= 0 && first <= (float)(d->n[0] - 1))) return;
  int i0 = (int)fmaxf(0, first), end = (int)fminf((float)(d->n[0] - 1), last) + 1;
  for (; i0 < end; i0 += SEGMENT) {
    int n = end - i0 < SEGMENT ? end - i0 : SEGMENT;
    switch (d->shape) {
    case DEPOSIT_3D: row(d, DEPOSIT_3D, s, amount, r2, i0, n, at, w); break;
    case DEPOSIT_2D: row(d, DEPOSIT_2D, s, amount, r2, i0, n, at, w); break;
    case DEPOSIT_COLUMN: row(d, DEPOSIT_COLUMN, s, amount, r2, i0, n, at, w); break;
    }
    for (int f = 0; f < d->fields; f++) {
      float *mean = d->mean[f] + at + i0, v = value[f];
      for (int i = 0; i < n; i++) mean[i] += w[i] * v;
    }
    if (d->best) note(d, s, d->fields ? value[0] : 0, r2, i0, n, at, w);
  }
}

/* One particle into rows (layers) from .. to-1 of the slowest axis. */
static void spread(Deposit *d, const DepositSpot *s, const float *value, int from, int to)
{
  int flat = d->shape != DEPOSIT_3D, deep = d->n[2] > 1, lo[3] = {0}, hi[3] = {0};
  float amount = s->amount * norm(d, s), first, last;
  for (int a = 1; a < 3; a++) {
    int own = a == (deep ? 2 : 1);
    reach(s->x[a], s->h, d->cell[a], &first, &last);
    lo[a] = (int)fmaxf(first, own ? (float)from : 0);
    hi[a] = (int)fminf(last, own ? (float)(to - 1) : (float)(d->n[a] - 1));
    if (a == 2 && flat) lo[a] = hi[a] = 0;
  }
  for (int k = lo[2]; k <= hi[2]; k++)
    for (int j = lo[1]; j <= hi[1]; j++) {
      float y = ((float)j + 0.5f) * d->cell[1] - s->x[1],
            z = flat ? 0 : ((float)k + 0.5f) * d->cell[2] - s->x[2], r2 = y * y + z * z;
      if (r2 < s->h * s->h)
        rows(d, s, value, amount, r2, ((size_t)k * (size_t)d->n[1] + (size_t)j) * (size_t)d->n[0]);
    }
}

int deposit_add(Deposit *d, const DepositSpot *spot, const float *const *value, long n, Err *err)
{
  enum { MOST = 64 };
  int axis = d->n[2] > 1 ? 2 : 1;
  const Things things = {spot, d};
  Bands bands;
  if (d->fields > MOST) return err_set(err, "more than %d fields", MOST);
  if (bands_new(&bands, n, d->n[axis], axis == 2 ? LAYERS : ROWS, span, &things, err)) return -1;
#pragma omp parallel for schedule(dynamic)
  for (int b = 0; b < bands.bands; b++) {
    int from = b * bands.height,
        to = from + bands.height < d->n[axis] ? from + bands.height : d->n[axis];
    for (int64_t k = bands.start[b]; k < bands.start[b + 1]; k++) {
      float v[MOST];
      uint32_t i = bands.list[k];
      for (int f = 0; f < d->fields; f++) v[f] = value[f][i];
      spread(d, &spot[i], v, from, to);
    }
  }
  bands_free(&bands);
  return 0;
}
