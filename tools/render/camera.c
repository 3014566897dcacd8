/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_sort.h>
#include "camera.h"

#define MARGIN  1.2
#define NEAREST 0.02 /* of the eye's distance: nothing nearer is drawn */

static const double right_angle = 1.57079632679489661923;

/* Exact at right angles. */
static double tidy(double x) { return fabs(x) < 1e-15 ? 0 : x; }

void camera_turn(Camera *c, double azimuth, double elevation, double roll)
{
  double ca = tidy(cos(azimuth)), sa = tidy(sin(azimuth)), ce = tidy(cos(elevation)),
         se = tidy(sin(elevation)), cr = tidy(cos(roll)), sr = tidy(sin(roll));
  const double right[3] = {-sa, ca, 0}, up[3] = {-se * ca, -se * sa, ce},
               out[3] = {ce * ca, ce * sa, se};
  c->distance = INFINITY;
  for (int a = 0; a < 3; a++) {
    c->axis[0][a] = cr * right[a] + sr * up[a], c->axis[1][a] = cr * up[a] - sr * right[a];
    c->axis[2][a] = out[a];
  }
}

void camera_plane(Camera *c, const char *plane)
{
  camera_turn(c, strcmp(plane, "yz") ? -right_angle : 0, strcmp(plane, "xy") ? 0 : right_angle, 0);
}

/* Along an axis, from the centre. */
static double along(const Camera *c, int k, const double x[3])
{
  double sum = 0;
  for (int a = 0; a < 3; a++) sum += c->axis[k][a] * (x[a] - c->centre[a]);
  return sum;
}

double camera_extent(const Camera *c, const Parts *p, double slope)
{
  double *need = malloc((size_t)(p->n + 1) * sizeof *need), mass = 0, sum = 0, width = 0;
  size_t *order = malloc((size_t)(p->n + 1) * sizeof *order);
  if (!need || !order) err_die("out of memory");
  for (long i = 0; i < p->n; i++) {
    double across = fabs(along(c, 0, p->x + 3 * i)), tall = fabs(along(c, 1, p->x + 3 * i));
    need[i] = 2 * (fmax(across, tall * c->w / c->h) + 0.5 * p->h[i]) +
              2 * slope * along(c, 2, p->x + 3 * i);
    mass += p->m[i];
  }
  gsl_sort_index(order, need, 1, (size_t)p->n);
  for (long k = 0; k < p->n && sum < 0.99 * mass; k++)
    width = need[order[k]], sum += p->m[order[k]];
  free(need), free(order);
  return MARGIN * width;
}

double camera_see(const Camera *c, const double x[3], double *u, double *v, double *depth)
{
  double out = along(c, 2, x), near = 1 - out / c->distance, zoom = near > NEAREST ? 1 / near : 0;
  *u = c->w / 2. + zoom * c->scale * along(c, 0, x);
  *v = c->h / 2. - zoom * c->scale * along(c, 1, x);
  *depth = c->scale * (out - c->offset);
  return zoom;
}
