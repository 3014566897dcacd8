/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/group.h"
#include "lib/snap.h"
#include "lib/spool.h"
#include "origin.h"

void origin_close(Origin *o)
{
  descent_close(&o->start), free(o->r), free(o->body), free(o->radius);
  *o = (Origin){0};
}

int origin_open(Origin *o, const Parts *p, Err *err)
{
  const int bodies = group_bodies(p, err);
  if (bodies < 0) return -1;
  double(*centre)[4] = calloc((size_t)bodies, sizeof *centre); /* x, mass */
  *o = (Origin){.bodies = bodies, .radius = calloc((size_t)bodies, sizeof *o->radius)};
  o->r = malloc(((size_t)p->n + 1) * sizeof *o->r);
  o->body = malloc(((size_t)p->n + 1) * sizeof *o->body);
  int failed = !centre || !o->radius || !o->r || !o->body
                   ? err_set(err, "out of memory for %ld particles", p->n)
                   : descent_open(&o->start, p, p->body, bodies, err);
  for (long k = 0; k < p->n && !failed; k++) {
    const long i = o->start.row[k];
    double *c = centre[p->body[i]];
    for (int a = 0; a < 3; a++) c[a] += p->m[i] * p->x[3 * i + a];
    c[3] += p->m[i];
  }
  for (int b = 0; b < bodies && !failed; b++)
    for (int a = 0; a < 3; a++) centre[b][a] /= centre[b][3];
  for (long k = 0; k < p->n && !failed; k++) {
    const long i = o->start.row[k], b = o->body[k] = p->body[i];
    o->r[k] = group_apart(p->x + 3 * i, centre[b]);
    o->radius[b] = fmax(o->radius[b], o->r[k]);
  }
  free(centre);
  if (failed) origin_close(o);
  return failed;
}

/* The objects of `last`, in the rows of p. */
static int objects(Parts *p, const Descent *last, const char *member, Err *err)
{
  Descent d;
  if (part_add(p, member, err)) return -1;
  int32_t *id = part_array(p, part_field(member));
  memset(id, 0, (size_t)p->n * sizeof *id);
  if (descent_open(&d, p, id, 0, err)) return -1;
  long *place = malloc(((size_t)p->n + 1) * sizeof *place);
  if (place) descent_match(last, &d, place);
  for (long k = 0; k < p->n && place; k++)
    if (place[k] >= 0) id[d.row[k]] = last->object[place[k]];
  descent_close(&d), free(place);
  return place ? 0 : err_set(err, "out of memory for %ld particles", p->n);
}

int origin_map(const char *path, const char *from, const Descent *last, const char *member,
               const char *command, Err *err)
{
  Parts *p = snap_read(from, err);
  if (!p) return -1;
  int failed =
      objects(p, last, member, err) || part_history(p, command, err) || snap_write(p, path, 0, err);
  part_free(p);
  return failed ? -1 : 0;
}

int origin_mark(const char *path, const char *from, const Origin *o, const Descent *last,
                const char *member, const char *command, Err *err)
{
  Parts *p = snap_read(from, err);
  if (!p) return -1;
  int failed = objects(p, last, member, err);
  double *r = failed ? NULL
                     : part_add_extra(p, "InitialRadius", "m",
                                      "distance from the centre of its body at the start", err);
  double *depth =
      r ? part_add_extra(p, "InitialDepth", "m",
                         "depth in its body at the start, below the outermost particle", err)
        : NULL;
  long *place = malloc(((size_t)p->n + 1) * sizeof *place);
  if (!place && depth) failed = err_set(err, "out of memory for %ld particles", p->n);
  failed = failed || !depth || !place;
  if (!failed) descent_match(&o->start, last, place);
  for (long k = 0; k < last->n && !failed; k++) {
    const long i = last->row[k], s = place[k];
    r[i] = s < 0 ? NAN : o->r[s];
    depth[i] = s < 0 ? NAN : o->radius[o->body[s]] - o->r[s];
  }
  free(place);
  failed = failed || part_history(p, command, err) || snap_write(p, path, 0, err);
  part_free(p);
  return failed ? -1 : 0;
}

static long shell(const Origin *o, long k, long bins)
{
  const double radius = o->radius[o->body[k]];
  const long b = radius > 0 ? (long)(o->r[k] / radius * (double)bins) : 0;
  return b < bins ? b : bins - 1;
}

static void print(FILE *f, const Origin *o, const double *mass, long found, long bins)
{
  const long cells = o->bodies * bins;
  fputs("# object\tbody\tfrom [m]\tto [m]\tmass [kg]\tof_object [1]\tof_shell [1]\n", f);
  for (long c = 0; c <= found; c++) {
    double whole = 0;
    for (long k = 0; k < cells; k++) whole += mass[c * cells + k];
    for (long k = 0; k < cells; k++) {
      const double width = o->radius[k / bins] / (double)bins, m = mass[c * cells + k];
      double all = mass[(found + 1) * cells + k];
      fprintf(f, "%ld\t%ld\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\n", c, k / bins,
              (double)(k % bins) * width, (double)(k % bins + 1) * width, m,
              whole > 0 ? m / whole : 0, all > 0 ? m / all : 0);
    }
  }
}

int origin_shells(const char *path, const Origin *o, const Descent *last, long bins, Err *err)
{
  const long cells = o->bodies * bins, found = last->objects;
  double *mass = calloc((size_t)((found + 2) * cells), sizeof *mass); /* the last: of all */
  long *place = malloc(((size_t)last->n + 1) * sizeof *place);
  char *text = NULL;
  size_t size;
  FILE *f = mass && place ? open_memstream(&text, &size) : NULL;
  if (!f) return free(mass), free(place), err_set(err, "cannot write '%s': out of memory", path);
  descent_match(&o->start, last, place);
  for (long k = 0; k < last->n; k++) {
    if (place[k] < 0) continue;
    const long cell = o->body[place[k]] * bins + shell(o, place[k], bins);
    mass[last->object[k] * cells + cell] += last->m[k];
    mass[(found + 1) * cells + cell] += last->m[k];
  }
  print(f, o, mass, found, bins);
  int failed = fclose(f) ? err_set(err, "cannot write '%s': out of memory", path)
                         : spool_text(path, text, err);
  free(text), free(mass), free(place);
  return failed;
}
