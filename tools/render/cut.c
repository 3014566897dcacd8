/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spheres into a depth buffer, band by band. On the cut face all spheres are equally near: there
 * the power distance to the centre decides, which divides the face into cells around the particles.
 */
#include <math.h>
#include <stdlib.h>
#include "sample.h"

enum { BAND = 32 };
#define FILL                                                                                       \
  0.68f /* radius of a sphere in units of (m/rho)^(1/3): without gaps in a close packing, whose    \
           holes lie 0.64 away */
#define FOG 0.45f /* what lies one picture height behind is darker by about this */

typedef struct {
  float u, v, z, r; /* px */
  long i;
} Ball;

typedef struct {
  float z, key; /* depth; power distance on the cut face */
  const Ball *ball;
} Cell;

static long balls(Ball *b, const Parts *p, const Camera *c, int whole)
{
  long n = 0;
  for (long i = 0; i < p->n; i++) {
    double u, v, z, r = FILL * cbrt(p->m[i] / p->rho[i]);
    camera_see(c, p->x + 3 * i, &u, &v, &z);
    r = fmax(0.8, fmin(r, 0.5 * p->h[i]) * c->scale);
    if (u + r < 0 || v + r < 0 || u - r > c->w || v - r > c->h || (!whole && z > r)) continue;
    b[n++] = (Ball){(float)u, (float)v, (float)z, (float)r, i};
  }
  return n;
}

/* One pixel of one sphere: d2 from its centre in the picture, q2 = r^2 - d2 > 0. */
static void cover(Cell *cell, const Ball *b, float d2, float q2, int whole, const int64_t *id)
{
  float half = sqrtf(q2), z = b->z + half, key = 0;
  if (!whole && z > 0) {
    if (b->z - half > 0) return;
    z = 0, key = d2 + b->z * b->z - b->r * b->r;
  }
  if (cell->ball) {
    if (z < cell->z || (z == cell->z && key > cell->key)) return;
    if (z == cell->z && key == cell->key && id[b->i] > id[cell->ball->i]) return;
  }
  *cell = (Cell){z, key, b};
}

/* Brightness: 1 on the cut face; else lit from the upper left, with some fog. Spheres of a pixel or
 * two are flat. */
static float light(const Cell *cell, float du, float dv, int whole, int h)
{
  const Ball *b = cell->ball;
  if (!whole && cell->z == 0) return 1;
  float nx = du / b->r, ny = -dv / b->r, nz = (cell->z - b->z) / b->r;
  float lit = fmaxf(0, -0.45f * nx + 0.50f * ny + 0.74f * nz),
        round = fminf(1, fmaxf(0, (b->r - 1) / 4));
  float shade = 0.28f + 0.60f * (round * lit + (1 - round) * 0.7f);
  return whole ? shade : shade * (1 - FOG + FOG * expf(2 * cell->z / (float)h));
}

static void band(Window *win, const Parts *p, const Field *f, const Ball *b, long n, int y0, int y1,
                 int whole, Cell *cell)
{
  for (long k = 0; k < (long)(y1 - y0) * win->w; k++) cell[k] = (Cell){0};
  for (long k = 0; k < n; k++) {
    if (b[k].v + b[k].r < (float)y0 || b[k].v - b[k].r > (float)y1) continue;
    int i0 = (int)fmaxf(0, b[k].u - b[k].r), i1 = (int)fminf((float)win->w - 1, b[k].u + b[k].r);
    int j0 = (int)fmaxf((float)y0, b[k].v - b[k].r),
        j1 = (int)fminf((float)y1 - 1, b[k].v + b[k].r);
    for (int j = j0; j <= j1; j++)
      for (int i = i0; i <= i1; i++) {
        float du = (float)i + 0.5f - b[k].u, dv = (float)j + 0.5f - b[k].v, d2 = du * du + dv * dv,
              q2 = b[k].r * b[k].r - d2;
        if (q2 > 0) cover(&cell[(long)(j - y0) * win->w + i], &b[k], d2, q2, whole, p->id);
      }
  }
  for (int j = y0; j < y1; j++)
    for (int i = 0; i < win->w; i++) {
      const Cell *q = &cell[(long)(j - y0) * win->w + i];
      long at = (long)j * win->stride + i;
      win->value[at] = q->ball ? f->value[q->ball->i] : NAN;
      if (q->ball)
        win->shade[at] =
            light(q, (float)i + 0.5f - q->ball->u, (float)j + 0.5f - q->ball->v, whole, win->h);
    }
}

int cut_sample(Window *win, const Parts *p, const Field *f, const Camera *c, int whole, Err *err)
{
  Ball *b = malloc((size_t)(p->n + 1) * sizeof *b);
  long n = b ? balls(b, p, c, whole) : 0;
  int failed = !b;
#pragma omp parallel reduction(|| : failed)
  {
    Cell *cell = malloc((size_t)BAND * (size_t)win->w * sizeof *cell);
#pragma omp for schedule(dynamic)
    for (int y = 0; y < win->h; y += BAND) {
      int end = y + BAND < win->h ? y + BAND : win->h;
      if (cell && b) band(win, p, f, b, n, y, end, whole, cell);
    }
    failed = failed || !cell;
    free(cell);
  }
  free(b);
  return failed ? err_set(err, "out of memory for %ld particles", p->n) : 0;
}
