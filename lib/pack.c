/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "pack.h"
#include "rng.h"
#include "shells.h"

enum {
  TRIES = 3000,
  PROBES = 42
}; /* places a sphere; points of its surface that must lie inside */

static const double PI = 3.14159265358979323846;

static int falling(const void *a, const void *b)
{
  const double *p = a, *q = b;
  return (*p < *q) - (*p > *q);
}

/* Radii by inverting the cumulative number, until the volume is there. */
static long draw(const PackOptions *o, double volume, double *r)
{
  double sum = 0, a = pow(o->low, -o->slope), b = pow(o->high, -o->slope);
  long n = 0;
  while (n < o->most && sum < o->fill * volume) {
    double u = rng_uniform(o->seed, (uint64_t)n, 7);
    r[n] = o->slope != 0 ? pow(a + u * (b - a), -1 / o->slope) : o->low * pow(o->high / o->low, u);
    sum += 4 * PI / 3 * pow(r[n], 3), n++;
  }
  qsort(r, (size_t)n, sizeof *r, falling);
  return n;
}

static int fits(const Shape *s, const double *x, const double *r, long n, const double at[3],
                double radius, const double *probe)
{
  if (shape_part(s, at) < 0) return 0;
  for (long i = 0; i < n; i++) {
    double d2 = 0, gap = r[i] + radius;
    for (int a = 0; a < 3; a++) d2 += pow(at[a] - x[3 * i + a], 2);
    if (d2 < gap * gap) return 0;
  }
  for (int k = 0; k < PROBES; k++) {
    double p[3];
    for (int a = 0; a < 3; a++) p[a] = at[a] + radius * probe[3 * k + a];
    if (shape_part(s, p) < 0) return 0;
  }
  return 1;
}

long pack_spheres(const Shape *s, const PackOptions *o, double **x_out, double **r_out, Err *err)
{
  double *x = malloc((size_t)o->most * 3 * sizeof *x), *r = malloc((size_t)o->most * sizeof *r);
  double volume = 0, centre[3], reach = shape_ball(s, centre), probe[3 * PROBES];
  long wanted, n = 0;
  if (!x || !r) {
    free(x), free(r);
    return err_set(err, "no memory for %ld spheres", o->most);
  }
  for (int k = 0; k < (s->kind == SHAPE_TANK ? 2 : s->parts); k++) volume += shape_volume(s, k);
  shells_points(PROBES, 0, probe);
  wanted = draw(o, volume, r);
  for (long k = 0; k < wanted; k++) {
    double radius = r[k];
    for (uint32_t t = 0; t < TRIES; t++) {
      double at[3];
      for (uint32_t a = 0; a < 3; a++)
        at[a] = centre[a] + reach * (2 * rng_uniform(o->seed, (uint64_t)k, 100 + 3 * t + a) - 1);
      if (!fits(s, x, r, n, at, radius, probe)) continue;
      memcpy(x + 3 * n, at, sizeof at), r[n++] = radius;
      break;
    }
  }
  if (!n) {
    free(x), free(r);
    return err_set(err, "no sphere of %g m fits into the shape", o->low);
  }
  *x_out = x, *r_out = r;
  return n;
}
