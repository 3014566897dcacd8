/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "foreign.h"
#include "lib/hdf.h"
#include "notes.h"

long foreign_rows(hid_t loc, const char *name, int *width, Err *err)
{
  hsize_t dims[2] = {0, 1};
  Err why;
  hid_t set = H5Dopen2(loc, name, H5P_DEFAULT);
  if (set < 0) return hdf_fail(&why, "%s", ""), err_set(err, "'%s': %s", name, why.text);
  int rank = hdf_shape(set, 2, dims);
  H5Dclose(set);
  if (rank < 1) return err_set(err, "'%s' is neither a list nor a table", name);
  if (dims[1] < 1 || dims[1] > 1 << 20) return err_set(err, "'%s' has no columns", name);
  *width = rank == 2 ? (int)dims[1] : 1;
  return (long)dims[0];
}

/* n rows of `width` numbers of a native type of `size` bytes. */
static void *read_rows(hid_t loc, const char *name, hid_t type, size_t size, long n, int *width,
                       Err *err)
{
  Err why;
  long rows = foreign_rows(loc, name, width, err);
  if (rows < 0) return NULL;
  if (rows != n) return err_null(err, "'%s' has %ld rows for %ld particles", name, rows, n);
  void *data = calloc((size_t)n * (size_t)*width + 1, size);
  if (!data) return err_null(err, "out of memory");
  hid_t set = H5Dopen2(loc, name, H5P_DEFAULT);
  int rc = hdf_get_rows(set, type, data, &why);
  H5Dclose(set);
  if (!rc) return data;
  free(data);
  return err_null(err, "'%s': %s", name, why.text);
}

double *foreign_numbers(hid_t loc, const char *name, long n, int *width, Err *err)
{
  *err->text = 0;
  if (hdf_has(loc, name) <= 0) return NULL;
  return read_rows(loc, name, H5T_NATIVE_DOUBLE, sizeof(double), n, width, err);
}

void foreign_tensor(const double *full, int dimension, double s[6])
{
  const int d = dimension;
  memset(s, 0, 6 * sizeof *s);
  s[0] = full[0];
  if (d > 1) s[1] = full[1], s[3] = full[d + 1];
  if (d > 2) s[2] = full[2], s[4] = full[d + 2];
  s[5] = d > 2 ? full[2 * d + 2] : -(s[0] + s[3]);
}

void foreign_full(const double s[6], int dimension, double *full)
{
  static const int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  for (int a = 0; a < dimension; a++)
    for (int b = 0; b < dimension; b++) full[a * dimension + b] = s[at[a][b]];
}

/* One row of `width` numbers of the file into one of the schema's; 0 when they do not fit. */
static int place(double *to, int wanted, const double *from, int width)
{
  if (width == wanted || (wanted == 3 && width < 3)) {
    memcpy(to, from, (size_t)width * sizeof *to);
    return 1;
  }
  if (wanted != 6) return 0;
  if (width == 5) { /* xx xy xz yy yz */
    memcpy(to, from, 5 * sizeof *to);
    to[5] = -(from[0] + from[3]);
    return 1;
  }
  if (width != 1 && width != 4 && width != 9) return 0;
  foreign_tensor(from, width == 1 ? 1 : width == 4 ? 2 : 3, to);
  return 1;
}

static double factor(const ForeignRow *r, const ForeignUnits *u)
{
  return pow(u->length, r->length) * pow(u->mass, r->mass) * pow(u->time, r->time) *
         pow(u->temperature, r->temperature);
}

static int read_real(hid_t loc, const ForeignRow *r, double unit, double *to, int wanted, long n,
                     Err *err)
{
  int width, ok = 1;
  double *from = foreign_numbers(loc, r->theirs, n, &width, err);
  if (!from) return -1;
  for (long i = 0; ok && i < n; i++) {
    ok = place(to + i * wanted, wanted, from + i * width, width);
    for (int k = 0; k < wanted; k++) to[i * wanted + k] *= unit;
  }
  free(from);
  return ok ? 0 : err_set(err, "'%s' has %d columns, not %d", r->theirs, width, wanted);
}

static int read_whole(hid_t loc, const ForeignRow *r, const PartField *f, Parts *p, Err *err)
{
  int width;
  hid_t type = f->kind == 'l' ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32;
  void *data = read_rows(loc, r->theirs, type, (size_t)f->size, p->n, &width, err);
  if (!data) return -1;
  if (width != 1) {
    free(data);
    return err_set(err, "'%s' has %d columns, not 1", r->theirs, width);
  }
  part_set_array(p, f, data);
  return 0;
}

static int read_row(hid_t loc, const ForeignRow *r, double unit, Parts *p, Err *err)
{
  if (*r->ours == '+') {
    double *to = part_add_extra(p, r->ours + 1, r->why, r->theirs, err);
    return to ? read_real(loc, r, unit, to, 1, p->n, err) : -1;
  }
  const PartField *f = part_field(r->ours);
  if (part_array(p, f)) return 0;
  if (f->kind != 'd') return read_whole(loc, r, f, p, err);
  if (part_add(p, f->member, err)) return -1;
  return read_real(loc, r, unit, part_array(p, f), f->width, p->n, err);
}

int foreign_one(hid_t loc, const ForeignRow *r, const ForeignUnits *units, Parts *p, Err *err)
{
  int there = hdf_has(loc, r->theirs);
  if (there < 0) return hdf_fail(err, "'%s'", r->theirs);
  if (there && !r->ours && r->why) notes_say("not carried over: %s (%s)", r->theirs, r->why);
  return there && r->ours ? read_row(loc, r, factor(r, units), p, err) : 0;
}

typedef struct {
  const ForeignRow *table;
  int rows;
  NotesList unknown;
} Seen;

static herr_t visit(hid_t loc, const char *name, const H5L_info_t *info, void *context)
{
  (void)info;
  Seen *seen = context;
  H5O_info_t object;
  for (int k = 0; k < seen->rows; k++)
    if (!strcmp(seen->table[k].theirs, name)) return 0;
  if (H5Oget_info_by_name(loc, name, &object, H5P_DEFAULT) >= 0 && object.type == H5O_TYPE_DATASET)
    notes_add(&seen->unknown, name);
  return 0;
}

int foreign_read(hid_t loc, const ForeignRow *table, int rows, const ForeignUnits *units, Parts *p,
                 Err *err)
{
  Seen seen = {table, rows, {"", 0}};
  for (const ForeignRow *r = table; r < table + rows; r++)
    if (foreign_one(loc, r, units, p, err)) return -1;
  if (H5Literate(loc, H5_INDEX_NAME, H5_ITER_INC, NULL, visit, &seen) < 0)
    return err_set(err, "cannot list the datasets");
  notes_end(&seen.unknown, "not carried over, unknown here");
  return 0;
}
