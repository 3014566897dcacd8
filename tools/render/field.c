/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Known fields come from the table in fields.h, unknown ones are converted by HDF5. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <hdf5.h>
#include "field.h"
#include "lib/unit.h"

/* One row of the schema as it is in memory. */
typedef struct {
  const char *member, *name, *unit;
  const void *data;
  int width, size, whole; /* bytes a number; integers */
} Row;

static double number(const Row *r, long k)
{
  if (!r->whole) return ((const double *)r->data)[k];
  return r->size == 8 ? (double)((const int64_t *)r->data)[k] : ((const int32_t *)r->data)[k];
}

/* The row of a known dataset; returns 0 when the name is unknown. */
static int known(const Parts *p, const char *name, Row *row)
{
#define ROW(TYPE, MEMBER, WIDTH, DATASET, UNIT, ...)                                               \
  if (!strcmp(name, DATASET)) {                                                                    \
    *row = (Row){#MEMBER, DATASET, UNIT, p->MEMBER, WIDTH, sizeof(TYPE), (TYPE)0.5 == 0};          \
    return 1;                                                                                      \
  }
  ALL_FIELDS(ROW)
#undef ROW
  return 0;
}

static int unknown_field(const Parts *p, const char *name, const char *file, Err *err)
{
  const char *names[512];
  int n = 0;
#define NAME(TYPE, MEMBER, WIDTH, DATASET, ...) names[n++] = DATASET;
  ALL_FIELDS(NAME)
#undef NAME
  for (int k = 0; k < p->extras && n < 511; k++) names[n++] = p->extra[k].name;
  names[n++] = FIELD_COLUMN;
  const char *near = unit_nearest(name, names, n);
  return err_set(err, "'%s' has no field '%s'%s%s%s", file, name, near ? " (did you mean '" : "",
                 near ? near : "", near ? "'?)" : "");
}

/* A field that only this file knows, as doubles; *own is to be freed. */
static int extra(const Parts *p, const char *name, Row *row, double **own, const char *file,
                 Err *err)
{
  for (int k = 0; k < p->extras; k++) {
    const PartExtra *e = &p->extra[k];
    if (strcmp(e->name, name)) continue;
    size_t size = H5Tget_size(e->type), room = size > sizeof(double) ? size : sizeof(double);
    size_t numbers = (size_t)p->n * (size_t)e->width;
    int whole = H5Tget_class(e->type) == H5T_INTEGER;
    if (!whole && H5Tget_class(e->type) != H5T_FLOAT)
      return err_set(err, "'%s': field '%s' is not made of numbers", file, name);
    *own = malloc(numbers * room + 1);
    if (!*own) return err_set(err, "out of memory for %ld particles", p->n);
    memcpy(*own, e->data, numbers * size);
    if (H5Tconvert(e->type, H5T_NATIVE_DOUBLE, numbers, *own, NULL, H5P_DEFAULT) < 0)
      return err_set(err, "'%s': cannot convert field '%s'", file, name);
    *row = (Row){NULL, e->name, e->unit, *own, e->width, sizeof(double), 0};
    return 0;
  }
  return unknown_field(p, name, file, err);
}

/* `NAME.xy`, `|NAME|`: the name alone, and the component or NULL. */
static const char *split(const char *what, char name[160])
{
  size_t n = strlen(what);
  char *dot;
  snprintf(name, 160, "%s", what);
  if (n > 2 && what[0] == '|' && what[n - 1] == '|' && n < 160) {
    memmove(name, name + 1, n - 2), name[n - 2] = 0;
    return NULL;
  }
  dot = strrchr(name, '.');
  if (dot) *dot = 0;
  return dot ? what + (dot - name) + 1 : NULL;
}

/* Index of a component, -1: none of that name. */
static int component(const char *c, int width)
{
  static const char *const vector[] = {"x", "y", "z"}, *const tensor[] = {"xx", "xy", "xz",
                                                                          "yy", "yz", "zz"};
  const char *const *names = width == 6 ? tensor : vector;
  for (int k = 0; k < width && (width == 6 || width <= 3); k++)
    if (width > 1 && !strcmp(c, names[k])) return k;
  return -1;
}

/* Length of a vector; of a symmetric tensor sqrt(S:S), where the off-diagonal elements count twice.
 */
static double length(const Row *r, long i)
{
  double sum = 0;
  for (int k = 0; k < r->width; k++) {
    double s = number(r, i * r->width + k), twice = r->width == 6 && (k == 1 || k == 2 || k == 4);
    sum += (1 + twice) * s * s;
  }
  return sqrt(sum);
}

static int ends(const char *name, const char *end)
{
  size_t n = strlen(name), m = strlen(end);
  return n >= m && !strcmp(name + n - m, end);
}

int field_get(Field *f, const Parts *p, const char *what, const char *file, Err *err)
{
  char name[160];
  const char *part = split(what, name);
  double *own = NULL;
  Row row = {0};
  *f = (Field){0};
  snprintf(f->name, sizeof f->name, "%s", what), snprintf(f->unit, sizeof f->unit, "kg/m^2");
  if (!strcmp(what, FIELD_COLUMN)) return 0;
  if (known(p, name, &row) ? part_need(p, row.member, file, err)
                           : extra(p, name, &row, &own, file, err))
    goto failed;
  int k = part ? component(part, row.width) : -1;
  if (part && k < 0) {
    err_set(err, "field '%s' has no component '%s'", name, part);
    goto failed;
  }
  f->value = malloc((size_t)(p->n + 1) * sizeof *f->value);
  if (!f->value) {
    err_set(err, "out of memory for %ld particles", p->n);
    goto failed;
  }
  int bare = row.width == 1 && what[0] != '|';
  for (long i = 0; i < p->n; i++)
    f->value[i] = (float)(k >= 0 ? number(&row, i * row.width + k)
                          : bare ? number(&row, i)
                                 : length(&row, i));
  f->kinds = bare && row.whole && (ends(name, "ID") || ends(name, "Class"));
  snprintf(f->unit, sizeof f->unit, "%s", row.unit);
  free(own);
  return 0;
failed:
  free(own);
  return -1;
}

void field_free(Field *f)
{
  free(f->value);
  f->value = NULL;
}
