/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every particle that the plane meets adds to the pixels of its disc; bands of rows are worked on
 * in parallel. */
#include <math.h>
#include <stdlib.h>
#include "physics/kernel.h"
#include "sample.h"

enum { BAND = 32 };

/* A particle near the plane, px. */
typedef struct {
  float u, v, z, h, size, weight; /* size: half its spacing; weight: m/rho sigma/h^D */
  float value;
} Spot;

typedef struct {
  float sum, mean, best,
      kind;   /* sums of weight and of weight x value; heaviest weight and its value; */
  int inside; /* the spacing of a particle */
} Cell;

static long spots(Spot *s, const Parts *p, const Field *f, const Camera *c)
{
  int d = p->dimension;
  const double sigma = kernel_sigma(KERNEL_WENDLAND_C2, d);
  long n = 0;
  for (long i = 0; i < p->n; i++) {
    double u, v, z, h = p->h[i] * c->scale, volume = p->m[i] / p->rho[i];
    camera_see(c, p->x + 3 * i, &u, &v, &z);
    if (fabs(z) >= h || u + h < 0 || v + h < 0 || u - h > c->w || v - h > c->h) continue;
    double size = 0.55 * pow(volume, 1. / d) * c->scale;
    s[n++] = (Spot){(float)u,
                    (float)v,
                    (float)z,
                    (float)fmax(h, 1),
                    (float)fmax(size, 0.7),
                    (float)(volume * sigma / pow(p->h[i], d)),
                    f->value[i]};
  }
  return n;
}

static void add(Cell *cell, const Spot *s, float d2, int dimension)
{
  float h2 = s->h * s->h;
  if (d2 >= h2) return;
  float w = s->weight * (float)kernel_wendland_c2(dimension, sqrtf(d2 / h2));
  cell->sum += w, cell->mean += w * s->value;
  cell->inside |= d2 < s->size * s->size;
  if (w > cell->best) cell->best = w, cell->kind = s->value;
}

static void band(Window *win, const Spot *s, long n, int y0, int y1, int dimension, int kinds,
                 Cell *cell)
{
  for (long k = 0; k < (long)(y1 - y0) * win->w; k++) cell[k] = (Cell){0};
  for (long k = 0; k < n; k++) {
    float room = sqrtf(fmaxf(0, s[k].h * s[k].h - s[k].z * s[k].z));
    int i0 = (int)fmaxf(0, s[k].u - room), i1 = (int)fminf((float)win->w - 1, s[k].u + room);
    int j0 = (int)fmaxf((float)y0, s[k].v - room), j1 = (int)fminf((float)y1 - 1, s[k].v + room);
    for (int j = j0; j <= j1; j++)
      for (int i = i0; i <= i1; i++) {
        float du = (float)i + 0.5f - s[k].u, dv = (float)j + 0.5f - s[k].v;
        add(&cell[(long)(j - y0) * win->w + i], &s[k], du * du + dv * dv + s[k].z * s[k].z,
            dimension);
      }
  }
  for (int j = y0; j < y1; j++)
    for (int i = 0; i < win->w; i++) {
      const Cell *q = &cell[(long)(j - y0) * win->w + i];
      int lone = q->inside && q->best > 0.6f * q->sum, seen = q->sum >= 0.5f || lone;
      win->value[(long)j * win->stride + i] = seen ? (kinds ? q->kind : q->mean / q->sum) : NAN;
      win->shade[(long)j * win->stride + i] = 1;
    }
}

int slice_sample(Window *win, const Parts *p, const Field *f, const Camera *c, Err *err)
{
  Spot *s = malloc((size_t)(p->n + 1) * sizeof *s);
  long n = s ? spots(s, p, f, c) : 0;
  int failed = !s;
#pragma omp parallel reduction(|| : failed)
  {
    Cell *cell = malloc((size_t)BAND * (size_t)win->w * sizeof *cell);
#pragma omp for schedule(dynamic)
    for (int y = 0; y < win->h; y += BAND) {
      int end = y + BAND < win->h ? y + BAND : win->h;
      if (cell && s) band(win, s, n, y, end, p->dimension, f->kinds, cell);
    }
    failed = failed || !cell;
    free(cell);
  }
  free(s);
  return failed ? err_set(err, "out of memory for %ld particles", p->n) : 0;
}
