/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Point masses: from the table in fields.h to datasets and back. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "hdf.h"
#include "pointmass.h"

#define PI 3.14159265358979323846

enum { MOST = 1 << 20 }; /* point masses in a file */

typedef struct {
  const char *name, *unit, *meaning;
  size_t at;
  int width, size; /* elements a row, bytes an element */
  char kind;       /* as PartField.kind */
} Row;

#define KIND(TYPE) _Generic((TYPE)0, double : 'd', int64_t : 'l', int32_t : 'i')
#define ROW(TYPE, MEMBER, DIM, WIDTH, NAME, UNIT, MEANING)                                         \
  {NAME, UNIT, MEANING, offsetof(PointMass, MEMBER), WIDTH, (int)sizeof(TYPE), KIND(TYPE)},
static const Row rows[] = {POINTMASS_FIELDS(ROW)};
enum { ROWS = sizeof rows / sizeof *rows };

static hid_t native(char kind)
{
  return kind == 'd' ? H5T_NATIVE_DOUBLE : kind == 'l' ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32;
}

int pointmass_append(PointMass **list, int *n, const PointMass *more, int count, Err *err)
{
  PointMass *grown;
  if (count == 0) return 0;
  if (!(grown = realloc(*list, (size_t)(*n + count) * sizeof *grown)))
    return err_set(err, "out of memory");
  memcpy(grown + *n, more, (size_t)count * sizeof *more);
  *list = grown, *n += count;
  return 0;
}

/* Between the list and the column of a row: which way `into` says. */
static void move_column(const Row *r, PointMass *p, int n, char *column, int into)
{
  const size_t size = (size_t)r->width * (size_t)r->size;
  for (int k = 0; k < n; k++) {
    char *at = (char *)&p[k] + r->at, *to = column + (size_t)k * size;
    memcpy(into ? to : at, into ? at : to, size);
  }
}

static int put_row(hid_t group, const Row *r, const Parts *p, char *column, Err *err)
{
  const hsize_t dims[2] = {(hsize_t)p->points, (hsize_t)r->width};
  const double si = 1;
  hid_t set;
  move_column(r, p->point, p->points, column, 1);
  set = hdf_put_rows(group, r->name, native(r->kind), r->width > 1 ? 2 : 1, dims, column, err);
  if (set < 0) return -1;
  int rc = hdf_put_text(set, "unit", r->unit, err) ||
           hdf_put(set, "unitSI", H5T_NATIVE_DOUBLE, 0, &si, err) ||
           hdf_put_text(set, "meaning", r->meaning, err);
  H5Dclose(set);
  return rc ? -1 : 0;
}

int pointmass_put(hid_t file, const Parts *p, Err *err)
{
  char *column;
  hid_t group;
  int rc = 0;
  if (!p->points) return 0;
  if ((group = hdf_group(file, "PointMasses", err)) < 0) return -1;
  if (!(column = malloc((size_t)p->points * 3 * 8))) rc = err_set(err, "out of memory");
  for (int k = 0; k < ROWS && !rc; k++) rc = put_row(group, &rows[k], p, column, err);
  free(column);
  H5Gclose(group);
  return rc;
}

/* The number of rows, from the masses; -1 with a message. */
static int count_rows(hid_t group, Err *err)
{
  hsize_t dims[1];
  hid_t set = H5Dopen2(group, "Masses", H5P_DEFAULT);
  int rank;
  if (set < 0) return hdf_fail(err, "'PointMasses/Masses'");
  rank = hdf_shape(set, 1, dims);
  H5Dclose(set);
  if (rank != 1 || dims[0] < 1 || dims[0] > MOST)
    return err_set(err, "'PointMasses/Masses' is no list");
  return (int)dims[0];
}

static int get_row(hid_t group, const Row *r, Parts *p, char *column, Err *err)
{
  Err why;
  hsize_t dims[2] = {0, 1};
  hid_t set;
  int rc;
  if (!hdf_has(group, r->name) && r->at > offsetof(PointMass, v)) return 0;
  if ((set = H5Dopen2(group, r->name, H5P_DEFAULT)) < 0)
    return hdf_fail(err, "'PointMasses/%s'", r->name);
  rc = hdf_shape(set, 2, dims) == (r->width > 1 ? 2 : 1) && dims[0] == (hsize_t)p->points &&
               dims[1] == (hsize_t)r->width
           ? hdf_get_rows(set, native(r->kind), column, &why)
           : err_set(&why, "has another shape");
  H5Dclose(set);
  if (rc) return err_set(err, "'PointMasses/%s': %s", r->name, why.text);
  move_column(r, p->point, p->points, column, 0);
  return 0;
}

int pointmass_get(hid_t file, Parts *p, Err *err)
{
  char *column = NULL;
  hid_t group;
  int n, rc = 0;
  if (!hdf_has(file, "PointMasses")) return 0;
  if ((group = H5Gopen2(file, "PointMasses", H5P_DEFAULT)) < 0)
    return hdf_fail(err, "'PointMasses'");
  if ((n = count_rows(group, err)) < 0) return H5Gclose(group), -1;
  p->point = calloc((size_t)n, sizeof *p->point);
  column = malloc((size_t)n * 3 * 8);
  if (!p->point || !column)
    rc = err_set(err, "out of memory");
  else
    p->points = n;
  for (int k = 0; k < ROWS && !rc; k++) rc = get_row(group, &rows[k], p, column, err);
  free(column);
  H5Gclose(group);
  return rc;
}

static int check_finite(const PointMass *p, int k, Err *err)
{
  for (int r = 0; r < ROWS; r++)
    for (int d = 0; d < rows[r].width && rows[r].kind == 'd'; d++) {
      double x;
      memcpy(&x, (const char *)p + rows[r].at + (size_t)d * sizeof x, sizeof x);
      if (!isfinite(x)) return err_set(err, "point mass %d: %s is not finite", k, rows[r].name);
    }
  return 0;
}

int pointmass_check(const PointMass *p, int n, int dimension, Err *err)
{
  for (int k = 0; k < n; k++) {
    const PointMass *q = p + k;
    if (check_finite(q, k + 1, err)) return -1;
    if (!(q->m > 0))
      return err_set(err, "point mass %d: mass is %g, must be positive", k + 1, q->m);
    if (q->h < 0 || q->radius < 0)
      return err_set(err, "point mass %d: softening and radius must not be negative", k + 1);
    if (q->fixed && (q->v[0] != 0 || q->v[1] != 0 || q->v[2] != 0))
      return err_set(err, "point mass %d is fixed, so its velocity must be 0", k + 1);
    for (int d = dimension; d < 3; d++)
      if (q->x[d] != 0 || q->v[d] != 0)
        return err_set(err, "point mass %d must lie and move in the %d dimension(s) of the run",
                       k + 1, dimension);
  }
  return 0;
}

/* All arrays longer by `more` zeroed rows. */
static int longer(Parts *p, size_t more, Err *err)
{
  const size_t n = (size_t)p->n;
  for (int k = 0; k < part_field_count; k++) {
    const PartField *f = &part_fields[k];
    const size_t size = (size_t)f->size;
    char *now = part_array(p, f), *grown = now ? realloc(now, (n + more) * size) : NULL;
    if (!now) continue;
    if (!grown) return err_set(err, "out of memory for %ld particles", p->n);
    memset(grown + n * size, 0, more * size);
    part_set_array(p, f, grown);
  }
  return 0;
}

int pointmass_rows(Parts *p, Err *err)
{
  int64_t id = 0;
  if (longer(p, (size_t)p->points, err)) return -1;
  for (long i = 0; i < p->n; i++) id = p->id[i] >= id ? p->id[i] + 1 : id;
  for (int k = 0; k < p->points; k++) {
    const PointMass *q = &p->point[k];
    const long i = p->n + k;
    memcpy(p->x + 3 * i, q->x, sizeof q->x), memcpy(p->v + 3 * i, q->v, sizeof q->v);
    p->id[i] = id + k, p->m[i] = q->m, p->h[i] = q->h;
    if (p->rho)
      p->rho[i] = q->radius > 0 ? q->m / (4. / 3 * PI * pow(q->radius, 3)) : (double)INFINITY;
    if (p->clump) p->clump[i] = q->clump;
    if (p->disk) p->disk[i] = q->disk;
  }
  p->n += p->points, p->point_rows = p->points;
  return 0;
}

Parts pointmass_without(const Parts *p)
{
  Parts q = *p;
  q.n -= p->point_rows, q.point_rows = 0;
  for (long k = 0; k < p->point_rows; k++) {
    if (p->clump) q.point[k].clump = p->clump[q.n + k];
    if (p->disk) q.point[k].disk = p->disk[q.n + k];
  }
  return q;
}
