/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "body.h"
#include "lib/snap.h"
#include "lib/unit.h"

static const double PI = 3.14159265358979323846;

/* Half the distance of neighbours in a close packing of the body's mean particle volume. */
static double half_spacing(const Parts *p)
{
  double volume = 0;
  for (long i = 0; i < p->n; i++) volume += p->m[i] / p->rho[i] / (double)p->n;
  return p->dimension == 3 ? cbrt(sqrt(2) * volume) / 2 : sqrt(2 / sqrt(3) * volume) / 2;
}

static double volume_radius(const Body *b)
{
  return b->p->dimension == 3 ? b->g.radius : sqrt(b->g.volume / PI);
}

/* What /Body says; NAN when it says nothing, or of other bodies than this one. */
static double known_radius(const Body *b)
{
  char name[32];
  for (long i = 1; i < b->p->n; i++)
    if (b->p->body[i] != b->p->body[0]) return NAN;
  snprintf(name, sizeof name, "Radius%d", b->p->body[0]);
  return part_number(b->p, "body", name);
}

static int find_radius(Body *b, const char *text, Err *err)
{
  const char *known = "body", *reach = "reach", *volume = "volume", *word = text;
  double body = known_radius(b);
  if (!text) word = b->selected ? volume : isnan(body) ? reach : known;
  if (!strcmp(word, known)) {
    b->radius = body, b->source = "/Body";
    return isnan(body) ? err_set(err, "'%s' has no radius of a single body in /Body", b->file) : 0;
  }
  if (!strcmp(word, volume)) return b->radius = volume_radius(b), b->source = "volume", 0;
  if (!strcmp(word, reach)) {
    b->radius = b->reach + half_spacing(b->p), b->source = "outermost particle";
    if (!text)
      err_warn("'%s' does not tell its radius: %g m is taken, from the outermost particle", b->file,
               b->radius);
    return 0;
  }
  b->source = "given";
  Err why;
  if (unit_parse(text, "m", &b->radius, &why))
    return err_set(err, "radius: %s (or body, reach, volume)", why.text);
  return b->radius > 0 ? 0 : err_set(err, "radius %g m is not positive", b->radius);
}

static int choose(Body *b, const char *select, Err *err)
{
  const int32_t *id;
  int32_t which;
  unsigned char *keep;
  Parts *part;
  if (group_named(b->p, select, b->file, &id, &which, err)) return -1;
  if (!(keep = malloc((size_t)b->p->n))) return err_set(err, "out of memory");
  for (long i = 0; i < b->p->n; i++) keep[i] = id[i] == which;
  part = part_select(b->p, keep, err);
  free(keep);
  if (!part) return -1;
  part_free(b->p);
  b->p = part, b->selected = 1;
  return 0;
}

int body_measure(Body *b, Err *err)
{
  Err why;
  group_free(&b->g);
  if (group_system(&b->g, b->p, -1, &why)) return err_set(err, "'%s': %s", b->file, why.text);
  b->reach = 0;
  for (long i = 0; i < b->p->n; i++)
    b->reach = fmax(b->reach, group_apart(b->p->x + 3 * i, b->g.x));
  return 0;
}

int body_read(Body *b, const char *file, const char *select, const char *radius, Err *err)
{
  *b = (Body){.file = file, .p = snap_read(file, err)};
  if (!b->p || part_need(b->p, GROUP_FIELDS, file, err) || part_check(b->p, file, err)) return -1;
  if (b->p->points)
    return err_set(err, "'%s' has point masses: only particles are put on an orbit", file);
  if (b->p->n == 0) return err_set(err, "'%s' has no particles", file);
  if (b->p->dimension == 1) return err_set(err, "'%s' is 1D: an approach needs a plane", file);
  if (select && choose(b, select, err)) return -1;
  return body_measure(b, err) || find_radius(b, radius, err);
}

void body_move(Body *b, const double x[3], const double v[3])
{
  for (long i = 0; i < b->p->n; i++)
    for (int k = 0; k < 3; k++) {
      b->p->x[3 * i + k] += x[k] - b->g.x[k];
      b->p->v[3 * i + k] += v[k] - b->g.v[k];
    }
}

void body_extent(const Body *b, const double axis[3], double extent[2])
{
  extent[0] = extent[1] = 0;
  for (long i = 0; i < b->p->n; i++) {
    double along = 0;
    for (int k = 0; k < 3; k++) along += axis[k] * (b->p->x[3 * i + k] - b->g.x[k]);
    extent[0] = fmax(extent[0], -along), extent[1] = fmax(extent[1], along);
  }
}

/* The entries of /Body whose trailing number is the BodyID of a body here, under its new number;
 * those of other bodies are dropped. */
static void rename_numbers(Parts *p, const int *number, int bodies)
{
  int kept = 0;
  for (int k = 0; k < p->body_infos; k++) {
    PartNumber x = p->body_info[k];
    size_t base = strlen(x.name);
    while (base && isdigit((unsigned char)x.name[base - 1])) base--;
    if (x.name[base]) {
      long old = strtol(x.name + base, NULL, 10);
      if (old >= bodies || number[old] < 0) continue;
      snprintf(x.name + base, sizeof x.name - base, "%d", number[old]);
    }
    p->body_info[kept++] = x;
  }
  p->body_infos = kept;
}

int body_rename(Body *b, Err *err)
{
  int number[GROUP_BODIES], bodies = group_bodies(b->p, err);
  if (bodies < 0) return -1;
  b->bodies = 0;
  memset(number, -1, sizeof number);
  for (long i = 0; i < b->p->n; i++) number[b->p->body[i]] = 0;
  for (int k = 0; k < bodies; k++)
    if (number[k] == 0) number[k] = b->first + b->bodies++;
  if (b->first + b->bodies > GROUP_BODIES)
    return err_set(err, "more than %d bodies in all", GROUP_BODIES);
  for (long i = 0; i < b->p->n; i++) b->p->body[i] = number[b->p->body[i]];
  rename_numbers(b->p, number, bodies);
  b->p->collisions = 0;
  return 0;
}

static int by_value(const void *a, const void *b)
{
  int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
  return (x > y) - (x < y);
}

static int64_t *sorted_ids(const Parts *p)
{
  int64_t *id = malloc((size_t)p->n * sizeof *id);
  if (id) memcpy(id, p->id, (size_t)p->n * sizeof *id);
  if (id) qsort(id, (size_t)p->n, sizeof *id, by_value);
  return id;
}

int64_t body_free_ids(const Body *a, const Body *b, Err *err)
{
  int64_t *p = sorted_ids(a->p), *q = sorted_ids(b->p), shift = 0;
  if (!p || !q) return free(p), free(q), err_set(err, "out of memory");
  for (long i = 0, j = 0; i < a->p->n && j < b->p->n && !shift;) {
    if (p[i] == q[j]) shift = p[a->p->n - 1] - (q[0] < 0 ? q[0] : 0) + 1;
    if (p[i] < q[j])
      i++;
    else
      j++;
  }
  if (shift && (p[a->p->n - 1] > INT64_MAX / 4 || q[b->p->n - 1] > INT64_MAX / 4 ||
                p[0] < -INT64_MAX / 4 || q[0] < -INT64_MAX / 4))
    shift = err_set(err, "particle ids are too large to shift");
  free(p), free(q);
  return shift;
}

void body_free(Body *b)
{
  group_free(&b->g);
  part_free(b->p);
}
