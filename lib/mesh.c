/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "mesh.h"

typedef struct {
  double x[3];
  long number; /* 3 triangle + corner, or of the vertex */
} Point;

static int by_place(const void *a, const void *b)
{
  const Point *p = a, *q = b;
  for (int d = 0; d < 3; d++)
    if (p->x[d] != q->x[d]) return p->x[d] < q->x[d] ? -1 : 1;
  return (p->number > q->number) - (p->number < q->number);
}

typedef struct {
  int a, b, up; /* vertices, the lower one first; whether it runs that way */
} Edge;

static int by_ends(const void *a, const void *b)
{
  const Edge *p = a, *q = b;
  if (p->a != q->a) return p->a < q->a ? -1 : 1;
  if (p->b != q->b) return p->b < q->b ? -1 : 1;
  return p->up - q->up;
}

/* Room for one more, in doubling steps. */
static void *grown(void *list, long n, size_t size)
{
  if (n & (n - 1)) return list;
  return realloc(list, (size_t)(n ? 2 * n : 1) * size);
}

static int add_vertex(Mesh *m, const double x[3], Err *err)
{
  double *more = grown(m->x, m->vertices, 3 * sizeof *m->x);
  if (!more) return err_set(err, "out of memory");
  m->x = more;
  memcpy(m->x + 3 * m->vertices++, x, 3 * sizeof *x);
  return 0;
}

static int add_triangle(Mesh *m, long a, long b, long c, Err *err)
{
  int(*more)[3] = grown(m->corner, m->triangles, sizeof *m->corner);
  if (!more) return err_set(err, "out of memory");
  m->corner = more;
  m->corner[m->triangles][0] = (int)a, m->corner[m->triangles][1] = (int)b;
  m->corner[m->triangles++][2] = (int)c;
  return 0;
}

static int stl_binary(Mesh *m, const unsigned char *data, size_t size, Err *err)
{
  uint32_t n;
  memcpy(&n, data + 80, 4);
  if (size < 84 + 50 * (size_t)n) return err_set(err, "it is cut off");
  for (size_t k = 0; k < n; k++)
    for (int c = 0; c < 3; c++) {
      float f[3];
      double x[3];
      memcpy(f, data + 84 + 50 * k + 12 + 12 * (size_t)c, 12);
      for (int d = 0; d < 3; d++) x[d] = f[d];
      if (add_vertex(m, x, err)) return -1;
    }
  return 0;
}

/* A line of an OBJ file: faces of any number of corners, "a/b/c" means a, negative counts back. */
static int obj_line(Mesh *m, char *line, Err *err)
{
  long corner[3] = {0}, n = 0;
  double x[3];
  if (line[0] == 'v' && isspace((unsigned char)line[1])) {
    if (sscanf(line + 1, "%lf %lf %lf", &x[0], &x[1], &x[2]) != 3)
      return err_set(err, "a vertex without three numbers");
    return add_vertex(m, x, err);
  }
  if (line[0] != 'f' || !isspace((unsigned char)line[1])) return 0;
  for (char *at = line + 1, *end;; n++) {
    long i = strtol(at, &end, 10);
    if (end == at) break;
    i = i < 0 ? m->vertices + i : i - 1;
    if (i < 0 || i >= m->vertices) return err_set(err, "a face of a vertex that is not there");
    corner[n < 2 ? n : 2] = i;
    if (n >= 2 && add_triangle(m, corner[0], corner[1], corner[2], err)) return -1;
    if (n >= 2) corner[1] = corner[2];
    for (at = end; *at && !isspace((unsigned char)*at);) at++;
  }
  return n >= 3 ? 0 : err_set(err, "a face of fewer than three vertices");
}

static int stl_line(Mesh *m, char *line, Err *err)
{
  double x[3];
  char *at = line + strspn(line, " \t");
  if (strncmp(at, "vertex", 6)) return 0;
  if (sscanf(at + 6, "%lf %lf %lf", &x[0], &x[1], &x[2]) != 3)
    return err_set(err, "a vertex without three numbers");
  return add_vertex(m, x, err);
}

static int text(Mesh *m, char *data, int line(Mesh *, char *, Err *), Err *err)
{
  long number = 1;
  for (char *at = data, *next; at; at = next, number++) {
    Err why;
    next = strchr(at, '\n');
    if (next) *next++ = 0;
    if (line(m, at, &why)) return err_set(err, "line %ld: %s", number, why.text);
  }
  return 0;
}

/* Corners of STL at the same place become one vertex. */
static int weld(Mesh *m, Err *err)
{
  long n = m->vertices, kept = 0;
  Point *p = malloc((size_t)(n + 1) * sizeof *p);
  if (!p) return err_set(err, "out of memory");
  m->corner = malloc((size_t)(n / 3 + 1) * sizeof *m->corner), m->triangles = n / 3;
  for (long i = 0; i < n; i++) memcpy(p[i].x, m->x + 3 * i, sizeof p[i].x), p[i].number = i;
  qsort(p, (size_t)n, sizeof *p, by_place);
  for (long i = 0; m->corner && i < n; i++) {
    if (!i || memcmp(p[i].x, p[i - 1].x, sizeof p[i].x))
      memcpy(m->x + 3 * kept++, p[i].x, sizeof p[i].x);
    m->corner[p[i].number / 3][p[i].number % 3] = (int)(kept - 1);
  }
  free(p);
  m->vertices = kept;
  return m->corner ? 0 : err_set(err, "out of memory");
}

static int closed(const Mesh *m, Err *err)
{
  long n = 3 * m->triangles, open = 0;
  Edge *e = malloc((size_t)(n + 1) * sizeof *e);
  if (!e) return err_set(err, "out of memory");
  for (long k = 0; k < n; k++) {
    int a = m->corner[k / 3][k % 3], b = m->corner[k / 3][(k + 1) % 3];
    e[k] = a < b ? (Edge){a, b, 1} : (Edge){b, a, 0};
  }
  qsort(e, (size_t)n, sizeof *e, by_ends);
  for (long k = 0; k < n;) {
    int pair = k + 1 < n && e[k].a == e[k + 1].a && e[k].b == e[k + 1].b && e[k].up != e[k + 1].up;
    open += !pair, k += pair ? 2 : 1;
  }
  free(e);
  if (m->triangles < 4) return err_set(err, "it has %ld triangles", m->triangles);
  return open ? err_set(err, "its surface is not closed: %ld edges without a partner", open) : 0;
}

static void measure(Mesh *m)
{
  for (int d = 0; d < 3; d++) m->low[d] = INFINITY, m->high[d] = -INFINITY;
  for (long i = 0; i < m->vertices; i++)
    for (int d = 0; d < 3; d++) {
      m->low[d] = fmin(m->low[d], m->x[3 * i + d]);
      m->high[d] = fmax(m->high[d], m->x[3 * i + d]);
    }
  for (long k = 0; k < m->triangles; k++) {
    const double *a = m->x + 3 * m->corner[k][0], *b = m->x + 3 * m->corner[k][1],
                 *c = m->x + 3 * m->corner[k][2];
    double x[3][3];
    for (int d = 0; d < 3; d++) { /* from a vertex, for small rounding */
      x[0][d] = a[d] - m->x[d], x[1][d] = b[d] - m->x[d], x[2][d] = c[d] - m->x[d];
    }
    m->volume += (x[0][0] * (x[1][1] * x[2][2] - x[1][2] * x[2][1]) +
                  x[0][1] * (x[1][2] * x[2][0] - x[1][0] * x[2][2]) +
                  x[0][2] * (x[1][0] * x[2][1] - x[1][1] * x[2][0])) /
                 6;
  }
  m->volume = fabs(m->volume);
}

static long column(const Mesh *m, int d, double x)
{
  long k = (long)((x - m->low[d]) / (m->high[d] - m->low[d]) * (double)m->bins);
  return k < 0 ? 0 : k >= m->bins ? m->bins - 1 : k;
}

/* Two rounds: how many triangles stand over each column, then which. */
static int bin(Mesh *m, Err *err)
{
  long n, *fill;
  m->bins = (long)fmin(1000, fmax(1, sqrt((double)m->triangles))), n = m->bins * m->bins;
  m->start = calloc((size_t)n + 2, sizeof *m->start);
  if (!m->start) return err_set(err, "out of memory");
  for (int round = 0; round < 2; round++) {
    fill = m->start + 1 - round;
    for (long k = 0; k < m->triangles; k++) {
      const double *a = m->x + 3 * m->corner[k][0], *b = m->x + 3 * m->corner[k][1],
                   *c = m->x + 3 * m->corner[k][2];
      long low[2], high[2];
      for (int d = 0; d < 2; d++) {
        low[d] = column(m, d, fmin(a[d], fmin(b[d], c[d])));
        high[d] = column(m, d, fmax(a[d], fmax(b[d], c[d])));
      }
      for (long i = low[0]; i <= high[0]; i++)
        for (long j = low[1]; j <= high[1]; j++)
          if (round)
            m->in[m->start[i * m->bins + j + 1]++] = k;
          else
            fill[i * m->bins + j + 1]++;
    }
    if (round) break;
    for (long k = 1; k <= n + 1; k++) m->start[k] += m->start[k - 1];
    m->in = malloc((size_t)(m->start[n + 1] + 1) * sizeof *m->in);
    if (!m->in) return err_set(err, "out of memory");
  }
  return 0;
}

static char *slurp(const char *path, size_t *size, Err *err)
{
  FILE *f = fopen(path, "rb");
  char *data = NULL;
  long length;
  if (!f) return err_null(err, "cannot open '%s': %s", path, strerror(errno));
  if (!fseek(f, 0, SEEK_END) && (length = ftell(f)) >= 0 && !fseek(f, 0, SEEK_SET) &&
      (data = malloc((size_t)length + 1))) {
    *size = fread(data, 1, (size_t)length, f);
    data[*size] = 0;
  }
  if (!data || ferror(f)) free(data), data = NULL, err_set(err, "cannot read '%s'", path);
  fclose(f);
  return data;
}

int mesh_read(Mesh *m, const char *path, double scale, Err *err)
{
  const char *dot = strrchr(path, '.');
  size_t size = 0;
  uint32_t n = 0;
  char *data = slurp(path, &size, err);
  Err why;
  int obj = dot && (!strcmp(dot, ".obj") || !strcmp(dot, ".OBJ")), rc;
  *m = (Mesh){0};
  if (!data) return -1;
  if (size >= 84) memcpy(&n, data + 80, 4);
  if (obj)
    rc = text(m, data, obj_line, &why);
  else if (size >= 84 && size == 84 + 50 * (size_t)n)
    rc = stl_binary(m, (unsigned char *)data, size, &why);
  else
    rc = text(m, data, stl_line, &why);
  free(data);
  for (long k = 0; !rc && k < 3 * m->vertices; k++)
    if (!isfinite(m->x[k] *= scale)) rc = err_set(&why, "a coordinate is not finite");
  if (!rc && !obj) rc = weld(m, &why);
  if (!rc) rc = closed(m, &why);
  if (!rc) measure(m);
  if (!rc && !(m->volume > 0)) rc = err_set(&why, "it has no volume");
  if (!rc) rc = bin(m, &why);
  if (!rc) return 0;
  mesh_free(m);
  return err_set(err, "'%s': %s", path, why.text);
}

void mesh_free(Mesh *m)
{
  free(m->x), free(m->corner), free(m->start), free(m->in);
  *m = (Mesh){0};
}

/* On which side of the line from vertex a to b the point lies, seen along z; *area: twice that of
 * the triangle with it. The lower vertex is taken first whoever asks. */
static int side(const Mesh *m, int a, int b, const double p[3], long double *area)
{
  const double *x = m->x + 3 * (a < b ? a : b), *y = m->x + 3 * (a < b ? b : a);
  long double dx = (long double)y[0] - x[0], dy = (long double)y[1] - x[1];
  long double twice = dx * ((long double)p[1] - x[1]) - dy * ((long double)p[0] - x[0]);
  int up = twice > 0 || (twice == 0 && (dy < 0 || (dy == 0 && dx > 0)));
  *area = a < b ? twice : -twice;
  return a < b ? up : !up;
}

int mesh_inside(const Mesh *m, const double p[3])
{
  int above = 0;
  long cell;
  for (int d = 0; d < 3; d++)
    if (p[d] < m->low[d] || p[d] > m->high[d]) return 0;
  cell = column(m, 0, p[0]) * m->bins + column(m, 1, p[1]);
  for (long k = m->start[cell]; k < m->start[cell + 1]; k++) {
    const int *c = m->corner[m->in[k]];
    long double w[3], sum, z = 0;
    int s = side(m, c[1], c[2], p, &w[0]);
    if (side(m, c[2], c[0], p, &w[1]) != s || side(m, c[0], c[1], p, &w[2]) != s) continue;
    sum = w[0] + w[1] + w[2];
    for (int d = 0; d < 3; d++) z += (sum != 0 ? w[d] / sum : 1.0L / 3) * m->x[3 * c[d] + 2];
    above += z > p[2];
  }
  return above & 1;
}
