/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spheres into a depth buffer, band by band. On the faces of the cut all spheres are equally near:
 * there the power distance to the centre decides, which divides the face into cells around the
 * particles. Lengths in px at the centre; of a sphere on the picture, in px there. */
#include <math.h>
#include <stdlib.h>
#include "lib/bands.h"
#include "sample.h"

enum { BAND = 32 };
#define FILL                                                                                       \
  0.68f /* radius of a sphere in units of (m/rho)^(1/3): without gaps in a close packing, whose    \
           holes lie 0.64 away */
#define FACE 1.3f  /* radius on a face in units of that: it meets larger holes, up to 0.794 away */
#define FOG  0.45f /* what lies one picture height behind is darker by about this */

static const float lamp[3] = {-0.45f, 0.50f, 0.74f}; /* from the upper left */

typedef struct {
  float u, v, r, z; /* on the picture; depth */
  float zoom;
  long i;
} Ball;

typedef struct {
  float z, key; /* depth; power distance on the cut face */
  const Ball *ball;
  float face, shade; /* depth and brightness of the nearest face of the cut */
} Cell;

/* What all bands share. */
typedef struct {
  const Parts *p;
  const Field *f;
  const Camera *c;
  float normal[CUT_PLANES][3], level[CUT_PLANES]; /* normal . (right, up, out) = level */
  int planes, facing;                             /* facing: the plane looks at the viewer */
  float eye;                                      /* 1/distance */
} Scene;

static void scene_cut(Scene *s, const Cut *cut)
{
  s->planes = cut ? cut->planes : 1, s->facing = !cut;
  for (int k = 0; k < s->planes; k++)
    for (int a = 0; a < 3; a++) {
      double along = 0;
      for (int b = 0; b < 3 && cut; b++) along += cut->normal[k][b] * s->c->axis[a][b];
      s->normal[k][a] = cut ? (float)along : a == 2;
      s->level[k] = 0;
    }
}

/* Where the ray through a pixel meets the nearest face; depth counts from the cutting plane. */
static void face_at(const Scene *s, float u, float v, Cell *cell)
{
  float right = u - (float)s->c->w / 2, up = (float)s->c->h / 2 - v;
  cell->face = s->planes ? -INFINITY : INFINITY, cell->shade = 1;
  for (int k = 0; k < s->planes; k++) {
    const float *n = s->normal[k];
    float offset = (float)(s->c->offset * s->c->scale), level = s->facing ? offset : 0,
          across = n[0] * right + n[1] * up, towards = n[2] - across * s->eye,
          z = (level - across) / (towards > 1e-6f ? towards : 1e-6f) - offset;
    if (s->facing) z = 0;
    if (z <= cell->face) continue;
    cell->face = z;
    if (!s->facing) cell->shade = 0.8f + 0.2f * (n[0] * lamp[0] + n[1] * lamp[1] + n[2] * lamp[2]);
  }
}

static long balls(Ball *b, const Scene *s)
{
  const Parts *p = s->p;
  const Camera *c = s->c;
  long n = 0;
  for (long i = 0; i < p->n; i++) {
    double u, v, z, zoom = camera_see(c, p->x + 3 * i, &u, &v, &z),
                    r = FILL * pow(p->m[i] / p->rho[i], 1. / p->dimension);
    r = fmax(0.8, fmin(r, 0.5 * p->h[i]) * c->scale * zoom);
    double reach = FACE * r;
    if (zoom == 0 || u + reach < 0 || v + reach < 0 || u - reach > c->w || v - reach > c->h)
      continue;
    if (s->facing && z > reach / zoom) continue;
    b[n++] = (Ball){(float)u, (float)v, (float)r, (float)z, (float)zoom, i};
  }
  return n;
}

static void span(const void *things, long k, float *first, float *last)
{
  const Ball *b = (const Ball *)things + k;
  *first = b->v - FACE * b->r - 0.5f, *last = b->v + FACE * b->r + 0.5f;
}

/* Power distance of the point of the face in a pixel: negative inside of the sphere. */
static float power(const Scene *s, const Cell *cell, const Ball *b, float u, float v)
{
  float w = (float)s->c->w / 2, h = (float)s->c->h / 2,
        offset = (float)(s->c->offset * s->c->scale), near = 1 - (cell->face + offset) * s->eye,
        x = (u - w) * near - (b->u - w) / b->zoom, y = (v - h) * near - (b->v - h) / b->zoom,
        z = cell->face - b->z, r = FACE * b->r / b->zoom;
  return x * x + y * y + z * z - r * r;
}

/* One pixel of one sphere: q2 = r^2 - d^2, d from its centre in the picture. */
static void cover(const Scene *s, Cell *cell, const Ball *b, float u, float v, float q2)
{
  float r = b->r / b->zoom, z = cell->face, key = 0;
  if (cell->ball && b->z + FACE * r < cell->z) return;
  if (fabsf(b->z - cell->face) < FACE * r) key = power(s, cell, b, u, v);
  if (!(key < 0)) { /* the face does not meet it here: seen from outside, or removed */
    if (q2 <= 0 || (z = b->z + sqrtf(q2) / b->zoom) > cell->face) return;
    key = 0;
  }
  if (cell->ball) {
    if (z < cell->z || (z == cell->z && key > cell->key)) return;
    if (z == cell->z && key == cell->key && s->p->id[b->i] > s->p->id[cell->ball->i]) return;
  }
  cell->z = z, cell->key = key, cell->ball = b;
}

/* Brightness: that of the face where it is cut; else lit by the lamp, with some fog. Spheres of a
 * pixel or two are flat. */
static float light(const Scene *s, const Cell *cell, float du, float dv, int h)
{
  const Ball *b = cell->ball;
  if (cell->z == cell->face) return cell->shade;
  float nx = du / b->r, ny = -dv / b->r, nz = (cell->z - b->z) * b->zoom / b->r;
  float lit = fmaxf(0, lamp[0] * nx + lamp[1] * ny + lamp[2] * nz),
        round = fminf(1, fmaxf(0, (b->r - 1) / 4));
  float shade = 0.28f + 0.60f * (round * lit + (1 - round) * 0.7f);
  return s->planes ? shade * (1 - FOG + FOG * expf(2 * fminf(0, cell->z) / (float)h)) : shade;
}

static void draw(const Scene *s, const Window *win, const Ball *b, int y0, int y1, Cell *cell)
{
  float r = s->planes ? FACE * b->r : b->r;
  int i0 = (int)fmaxf(0, b->u - r), i1 = (int)fminf((float)win->w - 1, b->u + r);
  int j0 = (int)fmaxf((float)y0, b->v - r), j1 = (int)fminf((float)y1 - 1, b->v + r);
  for (int j = j0; j <= j1; j++)
    for (int i = i0; i <= i1; i++) {
      float u = (float)i + 0.5f, v = (float)j + 0.5f, du = u - b->u, dv = v - b->v,
            d2 = du * du + dv * dv;
      if (d2 < r * r) cover(s, &cell[(long)(j - y0) * win->w + i], b, u, v, b->r * b->r - d2);
    }
}

static void band(const Scene *s, Window *win, const Ball *b, const uint32_t *list, long n, int y0,
                 int y1, Cell *cell)
{
  for (int j = y0; j < y1; j++)
    for (int i = 0; i < win->w; i++) {
      Cell *q = &cell[(long)(j - y0) * win->w + i];
      *q = (Cell){0}, face_at(s, (float)i + 0.5f, (float)j + 0.5f, q);
    }
  for (long k = 0; k < n; k++) draw(s, win, &b[list[k]], y0, y1, cell);
  for (int j = y0; j < y1; j++)
    for (int i = 0; i < win->w; i++) {
      const Cell *q = &cell[(long)(j - y0) * win->w + i];
      long at = (long)j * win->stride + i;
      win->value[at] = q->ball ? s->f->value[q->ball->i] : NAN;
      if (q->ball)
        win->shade[at] =
            light(s, q, (float)i + 0.5f - q->ball->u, (float)j + 0.5f - q->ball->v, win->h);
    }
}

int cut_sample(Window *win, const Parts *p, const Field *f, const Camera *c, const Cut *cut,
               Err *err)
{
  Scene s = {.p = p, .f = f, .c = c, .eye = (float)(1 / (c->distance * c->scale))};
  Ball *b = malloc((size_t)(p->n + 1) * sizeof *b);
  Bands bands = {0};
  int failed = !b;
  scene_cut(&s, cut);
  if (b && bands_new(&bands, balls(b, &s), win->h, BAND, span, b, err)) failed = 1;
#pragma omp parallel reduction(|| : failed)
  {
    Cell *cell = malloc((size_t)BAND * (size_t)win->w * sizeof *cell);
    failed = failed || !cell;
#pragma omp for schedule(dynamic)
    for (int k = 0; k < bands.bands; k++) {
      int y = k * BAND, end = y + BAND < win->h ? y + BAND : win->h;
      if (!failed)
        band(&s, win, b, bands.list + bands.start[k], bands.start[k + 1] - bands.start[k], y, end,
             cell);
    }
    free(cell);
  }
  bands_free(&bands), free(b);
  return failed ? err_set(err, "out of memory for %ld particles", p->n) : 0;
}
