/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "lib/group.h"
#include "lib/spool.h"
#include "bins.h"

#define PI 3.14159265358979323846

typedef struct {
  long bins, kinds; /* kinds: materials times bodies */
  double r0, dr;    /* m */
  long *n;          /* [bins] */
  double *mass, *l; /* [bins][kinds + 1] kg, kg m^2/s; the first is of all */
} Bins;

static double distance(const Parts *p, long i, const DiskBody *b)
{
  return group_apart(p->x + 3 * i, b->x);
}

static void put(Bins *s, const Parts *p, const DiskBody *b, const double axis[3], int bodies,
                const long *order)
{
  const double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  for (long k = 0; k < p->n; k++) {
    const long i = order[k], width = s->kinds + 1, kind = 1 + p->mat[i] * bodies + p->body[i];
    double r[3], v[3], l = 0;
    if (p->disk[i] != DISK_DISK) continue;
    long j = (long)floor((distance(p, i, b) - s->r0) / s->dr);
    if (j >= s->bins) j = s->bins - 1; /* the outermost one */
    for (int a = 0; a < 3; a++) r[a] = p->x[3 * i + a] - b->x[a], v[a] = p->v[3 * i + a] - b->v[a];
    for (int a = 0; a < 3; a++) {
      const int c = (a + 1) % 3, d = (a + 2) % 3;
      l += p->m[i] * (r[c] * v[d] - r[d] * v[c]) * axis[a] / length;
    }
    s->n[j]++;
    s->mass[j * width] += p->m[i], s->mass[j * width + kind] += p->m[i];
    s->l[j * width] += l, s->l[j * width + kind] += l;
  }
}

static void print(FILE *f, const Bins *s, const Parts *p, int bodies)
{
  fprintf(f, "# r [m]\tn\tmass [kg]\tsurface_density [kg/m^2]\tL [kg m^2/s]");
  for (int c = 0; c < p->materials; c++)
    for (int b = 0; b < bodies; b++) fprintf(f, "\t%s_from_%d [kg]", p->material[c].name, b);
  for (int c = 0; c < p->materials; c++)
    for (int b = 0; b < bodies; b++)
      fprintf(f, "\tL_%s_from_%d [kg m^2/s]", p->material[c].name, b);
  for (long j = 0; j < s->bins; j++) {
    const double *mass = s->mass + j * (s->kinds + 1), *l = s->l + j * (s->kinds + 1);
    const double in = s->r0 + (double)j * s->dr, out = in + s->dr;
    fprintf(f, "\n%.9g\t%ld\t%.9g\t%.9g\t%.9g", in + 0.5 * s->dr, s->n[j], mass[0],
            mass[0] / (PI * (out * out - in * in)), l[0]);
    for (long k = 1; k <= s->kinds; k++) fprintf(f, "\t%.9g", mass[k]);
    for (long k = 1; k <= s->kinds; k++) fprintf(f, "\t%.9g", l[k]);
  }
  fprintf(f, "\n");
}

static int fill(Bins *s, const Parts *p, const DiskBody *b, const double axis[3], int bodies,
                Err *err)
{
  const size_t cells = (size_t)(s->bins * (s->kinds + 1));
  long *order = malloc((size_t)p->n * sizeof *order);
  double far = b->radius;
  for (long i = 0; i < p->n; i++)
    if (p->disk[i] == DISK_DISK) far = fmax(far, distance(p, i, b));
  s->r0 = b->radius, s->dr = far > s->r0 ? (far - s->r0) / (double)s->bins : 1;
  s->n = calloc((size_t)s->bins, sizeof *s->n);
  s->mass = calloc(cells, sizeof *s->mass), s->l = calloc(cells, sizeof *s->l);
  int failed = !order || !s->n || !s->mass || !s->l ? err_set(err, "out of memory") : 0;
  if (!failed && !(failed = group_order(p, order, err))) put(s, p, b, axis, bodies, order);
  free(order);
  return failed;
}

static int write_text(const char *path, const Bins *s, const Parts *p, int bodies, Err *err)
{
  char *text = NULL;
  size_t size;
  FILE *f = open_memstream(&text, &size);
  if (f) print(f, s, p, bodies);
  int failed = !f || ferror(f);
  if (f && fclose(f)) failed = 1;
  failed =
      failed ? err_set(err, "cannot write '%s': out of memory", path) : spool_text(path, text, err);
  free(text);
  return failed;
}

int bins_write(const char *path, const Parts *p, const DiskBody *b, const double axis[3], long bins,
               Err *err)
{
  const int bodies = group_bodies(p, err);
  if (bodies < 0) return -1;
  Bins s = {.bins = bins, .kinds = (long)p->materials * bodies};
  int failed = fill(&s, p, b, axis, bodies, err) || write_text(path, &s, p, bodies, err);
  free(s.n), free(s.mass), free(s.l);
  return failed ? -1 : 0;
}
