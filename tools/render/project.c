/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every particle adds its mass, spread by its kernel along the line of sight, to the columns that
 * it lies in. In perspective a column is what the ray through a pixel passes. */
#include <math.h>
#include <stdlib.h>
#include "lib/deposit.h"
#include "sample.h"

#define FAINT 1e-4f /* of the largest column: not shown */
#define EXACT 6     /* px: of smaller kernels the masses are kept to rounding */

static void show(Window *win, const Deposit *d, const Field *f, float share)
{
  float most = 0;
  for (long k = 0; k < (long)win->w * win->h; k++) most = fmaxf(most, d->sum[k]);
  for (int j = 0; j < win->h; j++)
    for (int i = 0; i < win->w; i++) {
      long k = (long)j * win->w + i, at = (long)j * win->stride + i;
      float value = !f->value  ? d->sum[k] * share
                    : f->kinds ? d->kind[k]
                               : d->mean[0][k] / d->sum[k];
      win->value[at] = d->sum[k] > FAINT * most ? value : NAN, win->shade[at] = 1;
    }
}

/* Amounts are shares of the mass. */
static void spots(DepositSpot *s, const Parts *p, const Camera *c, double total)
{
#pragma omp parallel for schedule(static)
  for (long i = 0; i < p->n; i++) {
    double u, v, depth, zoom = camera_see(c, p->x + 3 * i, &u, &v, &depth);
    s[i] = (DepositSpot){{(float)u, (float)v, 0},
                         (float)fmax(1.5, p->h[i] * c->scale * zoom),
                         (float)(p->m[i] / total * zoom * zoom),
                         0};
    if (zoom == 0) s[i].x[0] = s[i].x[1] = -1e9f; /* behind the eye */
  }
}

int project_sample(Window *win, const Parts *p, const Field *f, const Camera *c, Err *err)
{
  static const float pixel[3] = {1, 1, 1};
  const int size[3] = {win->w, win->h, 1};
  const float *values[1] = {f->value};
  double total = 0;
  Deposit d = {0};
  DepositSpot *s = malloc((size_t)(p->n + 1) * sizeof *s);
  for (long i = 0; i < p->n; i++) total += p->m[i];
  int failed = s ? deposit_new(&d, size, pixel, p->dimension == 3 ? DEPOSIT_COLUMN : DEPOSIT_2D,
                               !!f->value, f->kinds, err)
                 : err_set(err, "out of memory for %ld particles", p->n);
  d.exact = EXACT;
  if (!failed) {
    spots(s, p, c, total);
    failed = deposit_add(&d, s, values, p->n, err);
  }
  if (!failed) show(win, &d, f, (float)(total * c->scale * c->scale));
  deposit_free(&d), free(s);
  return failed;
}
