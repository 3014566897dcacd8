/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Known fields come from the table in fields.h, unknown ones are converted by HDF5. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <hdf5.h>
#include "column.h"
#include "unit.h"

static int unknown_field(const Parts *p, const char *name, const char *const *more,
                         const char *file, Err *err)
{
  const char *names[512];
  int n = 0;
  for (int k = 0; k < part_field_count; k++) names[n++] = part_fields[k].name;
  for (int k = 0; k < p->extras && n < 400; k++) names[n++] = p->extra[k].name;
  for (; more && *more && n < 512; more++) names[n++] = *more;
  const char *near = unit_nearest(name, names, n);
  return err_set(err, "'%s' has no field '%s'%s%s%s", file, name, near ? " (did you mean '" : "",
                 near ? near : "", near ? "'?)" : "");
}

static int convert(Column *c, const Parts *p, const PartExtra *e, const char *file, Err *err)
{
  size_t size = H5Tget_size(e->type), room = size > sizeof(double) ? size : sizeof(double);
  size_t numbers = (size_t)p->n * (size_t)e->width;
  int whole = H5Tget_class(e->type) == H5T_INTEGER;
  if (!whole && H5Tget_class(e->type) != H5T_FLOAT)
    return err_set(err, "'%s': field '%s' is not made of numbers", file, e->name);
  c->own = malloc(numbers * room + 1);
  if (!c->own) return err_set(err, "out of memory for %ld particles", p->n);
  memcpy(c->own, e->data, numbers * size);
  *c = (Column){e->name, e->unit, c->own, c->own, 'd', e->width, -1, whole && e->width == 1};
  if (H5Tconvert(e->type, H5T_NATIVE_DOUBLE, numbers, c->own, NULL, H5P_DEFAULT) >= 0) return 0;
  column_free(c);
  return err_set(err, "'%s': cannot convert field '%s'", file, e->name);
}

static int find(Column *c, const Parts *p, const char *name, const char *const *more,
                const char *file, Err *err)
{
  for (int k = 0; k < part_field_count; k++) {
    const PartField *f = &part_fields[k];
    if (strcmp(f->name, name)) continue;
    *c = (Column){f->name, f->unit, part_array(p, f), NULL, f->kind, f->width, -1, f->kind != 'd'};
    return part_need(p, f->member, file, err);
  }
  for (int k = 0; k < p->extras; k++)
    if (!strcmp(p->extra[k].name, name)) return convert(c, p, &p->extra[k], file, err);
  return unknown_field(p, name, more, file, err);
}

/* Index of a component, -1: none of that name. */
static int component_of(const char *name, int width)
{
  static const char *const vector[] = {"x", "y", "z"}, *const tensor[] = {"xx", "xy", "xz",
                                                                          "yy", "yz", "zz"};
  const char *const *names = width == 6 ? tensor : vector;
  for (int k = 0; k < width && (width == 6 || width <= 3); k++)
    if (width > 1 && !strcmp(name, names[k])) return k;
  return -1;
}

static int ends(const char *name, const char *end)
{
  size_t n = strlen(name), m = strlen(end);
  return n >= m && !strcmp(name + n - m, end);
}

int column_get(Column *c, const Parts *p, const char *name, const char *component,
               const char *const *more, const char *file, Err *err)
{
  *c = (Column){0};
  if (find(c, p, name, more, file, err)) return -1;
  c->kinds = c->kinds && (ends(name, "ID") || ends(name, "Class"));
  if (component && (c->part = component_of(component, c->width)) < 0) {
    column_free(c);
    return err_set(err, "field '%s' has no component '%s'", name, component);
  }
  return 0;
}

void column_free(Column *c)
{
  free(c->own);
  c->own = NULL, c->data = NULL;
}

static double number(const Column *c, long k)
{
  if (c->kind == 'd') return ((const double *)c->data)[k];
  return c->kind == 'l' ? (double)((const int64_t *)c->data)[k] : ((const int32_t *)c->data)[k];
}

static double length(const Column *c, long i)
{
  double sum = 0;
  for (int k = 0; k < c->width; k++) {
    double s = number(c, i * c->width + k), twice = c->width == 6 && (k == 1 || k == 2 || k == 4);
    sum += (1 + twice) * s * s;
  }
  return sqrt(sum);
}

void column_read(const Column *c, long from, int n, double *out)
{
  for (int k = 0; k < n; k++)
    out[k] = c->width == 1 ? number(c, from + k)
             : c->part < 0 ? length(c, from + k)
                           : number(c, (from + k) * c->width + c->part);
}
