/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every particle adds its mass, spread over its disc by 4/(pi h^2) (1 - r^2/h^2)^3, which holds
 * exactly that mass (summed over the pixels when they are coarse), to the columns that it lies in.
 */
#include <math.h>
#include <stdlib.h>
#include "sample.h"

#define FAINT 1e-4f /* of the largest column: not shown */
#define PI    3.14159265358979323846f

typedef struct {
  float u, v, h, mass, value; /* px; share of the total mass */
} Spot;

/* [h][w] mass share/px; kind and best only when kinds are shown */
typedef struct {
  int w, h;
  float *sum, *mean, *kind, *best;
} Columns;

static float falloff(float r2, float h2)
{
  float q = 1 - r2 / h2;
  q = q > 0 ? q : 0;
  return q * q * q;
}

/* Mass over the sum of the weights on the pixels; the integral where there are many. */
static float norm(const Spot *s)
{
  float sum = 0;
  if (s->h >= 6) return s->mass * 4 / (PI * s->h * s->h);
  for (int j = (int)floorf(s->v - s->h); j <= (int)floorf(s->v + s->h); j++)
    for (int i = (int)floorf(s->u - s->h); i <= (int)floorf(s->u + s->h); i++) {
      float du = (float)i + 0.5f - s->u, dv = (float)j + 0.5f - s->v;
      sum += falloff(du * du + dv * dv, s->h * s->h);
    }
  return s->mass / sum;
}

static void heaviest(Columns *c, long at, float m, float value)
{
  if (m > c->best[at]) c->best[at] = m, c->kind[at] = value;
}

static void spread(Columns *c, int y0, int y1, const Spot *s)
{
  int i0 = (int)fmaxf(0, floorf(s->u - s->h)),
      i1 = (int)fminf((float)c->w - 1, floorf(s->u + s->h));
  int j0 = (int)fmaxf((float)y0, floorf(s->v - s->h)),
      j1 = (int)fminf((float)y1 - 1, floorf(s->v + s->h));
  float mass = norm(s), h2 = s->h * s->h;
  for (int j = j0; j <= j1; j++) {
    float dv = (float)j + 0.5f - s->v, *sum = c->sum + (long)j * c->w,
          *mean = c->mean + (long)j * c->w;
    for (int i = i0; i <= i1; i++) {
      float du = (float)i + 0.5f - s->u, m = mass * falloff(du * du + dv * dv, h2);
      sum[i] += m, mean[i] += m * s->value;
    }
    for (int i = i0; i <= i1 && c->best; i++) {
      float du = (float)i + 0.5f - s->u;
      heaviest(c, (long)j * c->w + i, mass * falloff(du * du + dv * dv, h2), s->value);
    }
  }
}

static void show(Window *win, const Columns *q, const Field *f, float share)
{
  float most = 0;
  for (long k = 0; k < (long)q->w * q->h; k++) most = fmaxf(most, q->sum[k]);
  for (int j = 0; j < q->h; j++)
    for (int i = 0; i < q->w; i++) {
      long k = (long)j * q->w + i, at = (long)j * win->stride + i;
      float value = !f->value ? q->sum[k] * share : f->kinds ? q->kind[k] : q->mean[k] / q->sum[k];
      win->value[at] = q->sum[k] > FAINT * most ? value : NAN, win->shade[at] = 1;
    }
}

static int columns_new(Columns *c, int w, int h, int kinds)
{
  size_t n = (size_t)w * (size_t)h;
  *c = (Columns){w, h, calloc(n * 4, sizeof *c->sum), NULL, NULL, NULL};
  if (!c->sum) return -1;
  c->mean = c->sum + n;
  if (kinds) c->kind = c->mean + n, c->best = c->kind + n;
  return 0;
}

int project_sample(Window *win, const Parts *p, const Field *f, const Camera *c, Err *err)
{
  enum { BAND = 64 };
  Columns cols;
  Spot *s = malloc((size_t)(p->n + 1) * sizeof *s);
  double total = 0;
  for (long i = 0; i < p->n; i++) total += p->m[i];
  int failed = columns_new(&cols, win->w, win->h, f->kinds) || !s;
  for (long i = 0; i < p->n && !failed; i++) {
    double u, v, depth;
    camera_see(c, p->x + 3 * i, &u, &v, &depth);
    s[i] = (Spot){(float)u, (float)v, (float)fmax(1.5, p->h[i] * c->scale),
                  (float)(p->m[i] / total), f->value ? f->value[i] : 0};
  }
#pragma omp parallel for schedule(dynamic)
  for (int y = 0; y < win->h; y += BAND) {
    float low = (float)y, end = (float)(y + BAND < win->h ? y + BAND : win->h),
          right = (float)win->w;
    for (long i = 0; i < p->n && !failed; i++) {
      if (s[i].v + s[i].h < low || s[i].v - s[i].h >= end) continue;
      if (s[i].u + s[i].h >= 0 && s[i].u - s[i].h < right) spread(&cols, y, (int)end, &s[i]);
    }
  }
  if (!failed) show(win, &cols, f, (float)(total * c->scale * c->scale));
  free(cols.sum), free(s);
  return failed ? err_set(err, "out of memory for %ld particles", p->n) : 0;
}
