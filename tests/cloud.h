/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Clouds of particles for the tests of tree, search and gravity: many shapes, in Hilbert order, SI
 * units. */
#ifndef CLOUD_H
#define CLOUD_H

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <omp.h>
#include "lib/rng.h"
#include "lib/tree.h"

typedef enum {
  SPHERE,
  CLUSTERS,
  TWO_BODIES,
  LINE,
  PLANE,
  COINCIDENT,
  OUTLIER,
  PAIRS,
  SHAPES
} CloudShape;

typedef struct {
  long n;
  double *x, *y, *v, *m, *h; /* y: x moved a little and all together; v: room for a field */
  int64_t *id;
} Cloud;

static inline double cloud_random(int seed, long i, int k)
{
  return rng_uniform((uint64_t)seed, (uint64_t)i, (uint32_t)k);
}

/* Uniform in a ball around c. */
static inline void cloud_ball(int seed, long i, double radius, const double c[3], double p[3])
{
  for (int k = 0; k < 99; k += 3) {
    double r2 = 0;
    for (int d = 0; d < 3; d++) p[d] = 2 * cloud_random(seed, i, 10 + k + d) - 1, r2 += p[d] * p[d];
    if (r2 < 1) break;
  }
  for (int d = 0; d < 3; d++) p[d] = c[d] + radius * p[d];
}

static inline void cloud_place(CloudShape shape, int seed, long n, long i, double p[3])
{
  const double here[3] = {1e6, -2e6, 3e5}, there[3] = {2.8e6, -2e6, 5e5};
  double c[3] = {0};
  switch (shape) {
  case TWO_BODIES: cloud_ball(seed, i, i % 3 ? 1e6 : 6e5, i % 3 ? here : there, p); break;
  case CLUSTERS: /* a few, each ten times denser than the one before */
    for (int d = 0; d < 3; d++) c[d] = 1e6 * cloud_random(seed, i % 5, d + 200);
    cloud_ball(seed, i, 1e6 * pow(10, -(double)(i % 5) / 3), c, p);
    break;
  case LINE:
  case PLANE:
    cloud_ball(seed, i, 1e6, here, p);
    p[2] = 0, p[1] = shape == LINE ? 0 : p[1];
    break;
  case COINCIDENT: memcpy(p, i % 2 ? here : there, 3 * sizeof *p); break;
  case OUTLIER:
    cloud_ball(seed, i, 1e6, here, p);
    if (i == n / 2) p[1] = 1e10;
    break;
  case PAIRS: /* all at distances close to 1e5 (1 +- 1e-13), next to the limit of the search */
    for (int d = 0; d < 3; d++) p[d] = 1e6 * cloud_random(seed, i / 2, d);
    if (i % 2) p[i / 2 % 3] += 1e5 * (1 + 2e-13 * (cloud_random(seed, i, 3) - 0.5));
    break;
  default: cloud_ball(seed, i, 1e6, here, p);
  }
}

/* cloud_room: zeros. */
static inline Cloud cloud_room(long n)
{
  const size_t z = (size_t)n;
  Cloud c;
  c.n = n;
  c.x = (double *)calloc(z, 24), c.y = (double *)calloc(z, 24), c.v = (double *)calloc(z, 24);
  c.m = (double *)calloc(z, 8), c.h = (double *)calloc(z, 8), c.id = (int64_t *)calloc(z, 8);
  return c;
}

/* spread: the largest h over the smallest. Masses differ by a factor 3. */
static inline Cloud cloud_new(CloudShape shape, long n, int seed, double spread)
{
  const double h0 = shape == PAIRS ? 1e5 : 1e6 * cbrt(40 / (double)n);
  const size_t z = (size_t)n;
  double *raw = (double *)calloc(z, 24);
  long *order = (long *)calloc(z, sizeof *order);
  int64_t *id = (int64_t *)calloc(z, sizeof *id);
  Cloud c = cloud_room(n);
  Err err;
  for (long i = 0; i < n; i++) cloud_place(shape, seed, n, i, raw + 3 * i), id[i] = 7 * i + 3;
  if (tree_order(n, raw, id, 0, order, &err)) abort();
  for (long k = 0; k < n; k++) {
    const long i = order[k];
    c.id[k] = id[i];
    c.m[k] = 1e20 * (1 + 2 * cloud_random(seed, i, 4)) / (double)n;
    c.h[k] = h0 * pow(spread, cloud_random(seed, i, 5) - 0.5);
    for (int d = 0; d < 3; d++) {
      c.x[3 * k + d] = raw[3 * i + d];
      c.y[3 * k + d] = raw[3 * i + d] + 4e6 + 0.3 * h0 * (cloud_random(seed, i, 6 + d) - 0.5);
    }
  }
  free(raw), free(order), free(id);
  return c;
}

static inline void cloud_free(Cloud *c)
{
  free(c->x), free(c->y), free(c->v), free(c->m), free(c->h), free(c->id);
}

#endif
