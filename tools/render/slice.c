/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A grid of one layer of pixels in the cutting plane. */
#include <math.h>
#include <stdlib.h>
#include "lib/deposit.h"
#include "sample.h"

/* Particles that meet the plane; lengths in px. A line of particles (1D) is as wide as they are
 * long. */
static long spots(DepositSpot *s, float *value, const Parts *p, const Field *f, const Camera *c)
{
  int d = p->dimension;
  long n = 0;
  for (long i = 0; i < p->n; i++) {
    double u, v, z, h = p->h[i] * c->scale, length = pow(p->m[i] / p->rho[i], 1. / d) * c->scale;
    camera_see(c, p->x + 3 * i, &u, &v, &z);
    if (fabs(z) >= h || u + h < 0 || v + h < 0 || u - h > c->w || v - h > c->h) continue;
    s[n] = (DepositSpot){{(float)u, (float)v, (float)z + 0.5f},
                         (float)fmax(h, 1),
                         (float)pow(length * fmax(1, 1 / h), d == 3 ? 3 : 2),
                         (float)fmax(0.55 * length, 0.7)};
    value[n++] = f->value[i];
  }
  return n;
}

int slice_sample(Window *win, const Parts *p, const Field *f, const Camera *c, Err *err)
{
  static const float pixel[3] = {1, 1, 1};
  const int size[3] = {win->w, win->h, 1};
  Deposit d = {0};
  DepositSpot *s = malloc((size_t)(p->n + 1) * sizeof *s);
  float *value = malloc((size_t)(p->n + 1) * sizeof *value);
  const float *values[1] = {value};
  int failed = !s || !value ? err_set(err, "out of memory for %ld particles", p->n) : 0;
  if (!failed)
    failed = deposit_new(&d, size, pixel, p->dimension == 3 ? DEPOSIT_3D : DEPOSIT_2D, 1, 1, err) ||
             deposit_add(&d, s, values, spots(s, value, p, f, c), err);
#pragma omp parallel for schedule(static) if (!failed)
  for (int j = 0; j < (failed ? 0 : win->h); j++)
    for (int i = 0; i < win->w; i++) {
      size_t k = (size_t)j * (size_t)win->w + (size_t)i,
             at = (size_t)j * (size_t)win->stride + (size_t)i;
      int lone = d.inside[k] && d.best[k] > 0.6f * d.sum[k], seen = d.sum[k] >= 0.5f || lone;
      win->value[at] = !seen ? NAN : f->kinds ? d.kind[k] : d.mean[0][k] / d.sum[k];
      win->shade[at] = 1;
    }
  deposit_free(&d), free(s), free(value);
  return failed ? -1 : 0;
}
