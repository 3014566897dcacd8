/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_sort.h>
#include "camera.h"
#include "lib/group.h"
#include "lib/unit.h"

#define MARGIN 1.2

void camera_plane(Camera *c, const char *plane)
{
  c->right = plane[0] - 'x', c->up = plane[1] - 'x';
  c->out = 3 - c->right - c->up;
  c->sign = c->out == 1 ? -1 : 1; /* right x up */
}

static int centre_of(double x[3], const Parts *p, const int32_t *id, long wanted)
{
  double mass = 0, sum[3] = {0};
  for (long i = 0; i < p->n; i++) {
    if (id && id[i] != wanted) continue;
    for (int a = 0; a < 3; a++) sum[a] += p->m[i] * p->x[3 * i + a];
    mass += p->m[i];
  }
  for (int a = 0; a < 3 && mass > 0; a++) x[a] = sum[a] / mass;
  return mass > 0 ? 0 : -1;
}

int camera_centre(Camera *c, const Parts *p, const char *text, const char *file, Err *err)
{
  const int32_t *id;
  int32_t wanted;
  Err why;
  if (!strcmp(text, "com"))
    return centre_of(c->centre, p, NULL, 0) ? err_set(err, "'%s': no particles", file) : 0;
  if (!strchr(text, ':') ? unit_list(text, "m", 3, c->centre, &why)
                         : group_named(p, text, file, &id, &wanted, &why))
    return err_set(err, "--centre: %s", why.text);
  return strchr(text, ':') ? centre_of(c->centre, p, id, wanted) : 0;
}

double camera_extent(const Camera *c, const Parts *p)
{
  double *need = malloc((size_t)(p->n + 1) * sizeof *need), mass = 0, sum = 0, width = 0;
  size_t *order = malloc((size_t)(p->n + 1) * sizeof *order);
  if (!need || !order) err_die("out of memory");
  for (long i = 0; i < p->n; i++) {
    const double *x = p->x + 3 * i;
    double across = fabs(x[c->right] - c->centre[c->right]),
           tall = fabs(x[c->up] - c->centre[c->up]);
    need[i] = 2 * (fmax(across, tall * c->w / c->h) + 0.5 * p->h[i]), mass += p->m[i];
  }
  gsl_sort_index(order, need, 1, (size_t)p->n);
  for (long k = 0; k < p->n && sum < 0.99 * mass; k++)
    width = need[order[k]], sum += p->m[order[k]];
  free(need), free(order);
  return MARGIN * width;
}

void camera_see(const Camera *c, const double x[3], double *u, double *v, double *depth)
{
  *u = c->w / 2. + c->scale * (x[c->right] - c->centre[c->right]);
  *v = c->h / 2. - c->scale * (x[c->up] - c->centre[c->up]);
  *depth = c->scale * (c->sign * (x[c->out] - c->centre[c->out]) - c->offset);
}
