/* SPDX-License-Identifier: GPL-3.0-or-later */
/* HDF5 clears its error stack on every call, so each failure is turned into text before anything is
 * closed. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hdf.h"

/* Keeps HDF5 from printing, and from trying again at exit to write a file that could not be closed.
 */
static void quiet(void)
{
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

/* The innermost entry of the error stack; of a failed system call only its own message. */
static herr_t first_reason(unsigned level, const H5E_error2_t *e, void *out)
{
  if (level || !e->desc) return 0;
  static const char mark[] = "error message = '";
  const char *message = strstr(e->desc, mark);
  const char *s = message ? message + sizeof mark - 1 : e->desc;
  snprintf(out, 256, "%.*s", (int)strcspn(s, message ? "'" : "\n"), s);
  if (!strncmp(s, "truncated file", 14)) strcpy(out, "truncated file");
  return 0;
}

int hdf_fail(Err *err, const char *format, ...)
{
  char reason[256] = "unknown error in HDF5", what[512];
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first_reason, reason);
  va_list args;
  va_start(args, format);
  vsnprintf(what, sizeof what, format, args);
  va_end(args);
  return err_set(err, "%s%s%s", what, *what ? ": " : "", reason);
}

/* A property list whose objects keep no times. */
static hid_t no_times(hid_t class)
{
  hid_t p = H5Pcreate(class);
  if (p >= 0) H5Pset_obj_track_times(p, 0);
  return p;
}

hid_t hdf_create(const char *path, Err *err)
{
  quiet();
  hid_t fcpl = no_times(H5P_FILE_CREATE), fapl = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(fapl, H5F_LIBVER_EARLIEST, H5F_LIBVER_V110); /* 1.10: virtual datasets */
  hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, fcpl, fapl);
  if (file < 0) hdf_fail(err, "%s", "");
  H5Pclose(fapl);
  H5Pclose(fcpl);
  return file;
}

hid_t hdf_open(const char *path, Err *err)
{
  quiet();
  if (H5Fis_hdf5(path) == 0) return err_set(err, "not an HDF5 file");
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) hdf_fail(err, "%s", "");
  return file;
}

int hdf_close(hid_t file, Err *err)
{
  int rc = H5Fflush(file, H5F_SCOPE_LOCAL) < 0 ? hdf_fail(err, "%s", "") : 0;
  if (H5Fclose(file) < 0 && !rc) rc = hdf_fail(err, "%s", "");
  return rc;
}

hid_t hdf_group(hid_t loc, const char *name, Err *err)
{
  hid_t gcpl = no_times(H5P_GROUP_CREATE);
  H5Pset_attr_creation_order(gcpl, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  hid_t group = H5Gcreate2(loc, name, H5P_DEFAULT, gcpl, H5P_DEFAULT);
  if (group < 0) hdf_fail(err, "'%s'", name);
  H5Pclose(gcpl);
  return group;
}

int hdf_has(hid_t loc, const char *name) { return (int)H5Lexists(loc, name, H5P_DEFAULT); }

/* ---- attributes ---- */

int hdf_put(hid_t obj, const char *name, hid_t type, int n, const void *data, Err *err)
{
  hsize_t dims = (hsize_t)n;
  hid_t space = n ? H5Screate_simple(1, &dims, NULL) : H5Screate(H5S_SCALAR);
  hid_t attr = H5Acreate2(obj, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  int rc = attr < 0 || H5Awrite(attr, type, data) < 0 ? hdf_fail(err, "attribute '%s'", name) : 0;
  if (attr >= 0) H5Aclose(attr);
  H5Sclose(space);
  return rc;
}

/* A string type of fixed length, or with size H5T_VARIABLE. */
static hid_t string_type(size_t size)
{
  hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, size);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

int hdf_put_text(hid_t obj, const char *name, const char *text, Err *err)
{
  hid_t type = string_type(strlen(text) + 1);
  int rc = hdf_put(obj, name, type, 0, text, err);
  H5Tclose(type);
  return rc;
}

int hdf_get(hid_t obj, const char *name, hid_t type, int most, void *data, Err *err)
{
  if (H5Aexists(obj, name) <= 0) return err_set(err, "lacks attribute '%s'", name);
  hid_t attr = H5Aopen(obj, name, H5P_DEFAULT);
  if (attr < 0) return hdf_fail(err, "attribute '%s'", name);
  hid_t space = H5Aget_space(attr);
  hssize_t n = H5Sget_simple_extent_npoints(space);
  int rc = (int)n;
  if (n < 1 || n > most)
    rc = err_set(err, "attribute '%s' has %lld elements, not %s%d", name, (long long)n,
                 most > 1 ? "1 to " : "", most);
  else if (H5Aread(attr, type, data) < 0)
    rc = hdf_fail(err, "attribute '%s'", name);
  H5Sclose(space);
  H5Aclose(attr);
  return rc;
}

/* A single string of an attribute, allocated; NULL on failure, with the reason in err. */
static char *read_text(hid_t attr, const char *name, Err *err)
{
  hid_t type = H5Aget_type(attr), space = H5Aget_space(attr);
  int variable = H5Tis_variable_str(type) > 0;
  int right = H5Tget_class(type) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1;
  size_t size = H5Tget_size(type) + 1;
  hid_t memory = string_type(variable ? H5T_VARIABLE : size);
  H5Tset_cset(memory, H5Tget_cset(type));
  char *text = right && !variable ? calloc(1, size) : NULL, *held = NULL;
  int ok =
      right && (variable || text) && H5Aread(attr, memory, variable ? (void *)&held : text) >= 0;
  if (!right)
    err_set(err, "attribute '%s' is not a string", name);
  else if (!ok)
    hdf_fail(err, "attribute '%s'", name);
  if (ok && variable) text = calloc(1, (held ? strlen(held) : 0) + 1);
  if (ok && variable && text && held) strcpy(text, held);
  H5free_memory(held);
  H5Tclose(memory);
  H5Sclose(space);
  H5Tclose(type);
  if (ok) return text;
  free(text);
  return NULL;
}

int hdf_get_text(hid_t obj, const char *name, char *out, int size, Err *err)
{
  *out = 0;
  if (H5Aexists(obj, name) <= 0) return 0;
  hid_t attr = H5Aopen(obj, name, H5P_DEFAULT);
  if (attr < 0) return hdf_fail(err, "attribute '%s'", name);
  char *text = read_text(attr, name, err);
  int rc = text ? 0 : -1;
  if (text && snprintf(out, (size_t)size, "%s", text) >= size)
    rc = err_set(err, "attribute '%s' is longer than %d bytes", name, size - 1);
  free(text);
  H5Aclose(attr);
  return rc;
}

/* ---- lists of strings ---- */

int hdf_put_strings(hid_t loc, const char *name, char *const *line, int n, Err *err)
{
  if (n < 1) return 0;
  size_t size = 1;
  for (int i = 0; i < n; i++)
    if (strlen(line[i]) >= size) size = strlen(line[i]) + 1;
  char *all = calloc((size_t)n, size);
  if (!all) return err_set(err, "out of memory");
  for (int i = 0; i < n; i++) strcpy(all + (size_t)i * size, line[i]);
  hid_t type = string_type(size);
  hsize_t dims = (hsize_t)n;
  hid_t set = hdf_put_rows(loc, name, type, 1, &dims, all, err);
  H5Tclose(type);
  free(all);
  if (set < 0) return -1;
  H5Dclose(set);
  return 0;
}

/* n strings of a fixed length into newly allocated ones. */
static int read_fixed(hid_t set, size_t size, char **line, int n, const char *name, Err *err)
{
  hid_t type = H5Dget_type(set), memory = string_type(size + 1);
  H5Tset_cset(memory, H5Tget_cset(type));
  char *all = calloc((size_t)n, size + 1);
  int rc = all ? 0 : err_set(err, "out of memory");
  if (!rc && H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, all) < 0)
    rc = hdf_fail(err, "'%s'", name);
  for (int i = 0; i < n && !rc; i++) {
    const char *s = all + (size_t)i * (size + 1);
    line[i] = calloc(1, strlen(s) + 1);
    if (!line[i])
      rc = err_set(err, "out of memory");
    else
      strcpy(line[i], s);
  }
  free(all);
  H5Tclose(memory);
  H5Tclose(type);
  return rc;
}

/* n strings of variable length: HDF5 allocates them, the copies are ours. */
static int read_variable(hid_t set, char **line, int n, const char *name, Err *err)
{
  hid_t type = H5Dget_type(set), space = H5Dget_space(set), memory = string_type(H5T_VARIABLE);
  H5Tset_cset(memory, H5Tget_cset(type));
  char **held = calloc((size_t)n, sizeof *held);
  int rc = held ? 0 : err_set(err, "out of memory");
  if (!rc && H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, held) < 0)
    rc = hdf_fail(err, "'%s'", name);
  for (int i = 0; i < n && !rc; i++) {
    line[i] = calloc(1, (held[i] ? strlen(held[i]) : 0) + 1);
    if (!line[i])
      rc = err_set(err, "out of memory");
    else if (held[i])
      strcpy(line[i], held[i]);
  }
  if (held) H5Dvlen_reclaim(memory, space, H5P_DEFAULT, held);
  free(held);
  H5Tclose(memory);
  H5Sclose(space);
  H5Tclose(type);
  return rc;
}

static int read_strings(hid_t set, const char *name, char ***line, int *n, Err *err)
{
  enum { MOST = 1 << 20 }; /* more entries than any history or list of parameters has */
  hsize_t dims;
  hid_t type = H5Dget_type(set);
  int rc = 0;
  if (H5Tget_class(type) != H5T_STRING)
    rc = err_set(err, "'%s' is not a list of strings", name);
  else if (hdf_shape(set, 1, &dims) != 1 || dims > MOST)
    rc = err_set(err, "'%s' is not a list of at most %d strings", name, MOST);
  else if (!(*line = calloc(dims + 1, sizeof **line)))
    rc = err_set(err, "out of memory");
  if (!rc) {
    *n = (int)dims;
    if (dims && H5Tis_variable_str(type) > 0)
      rc = read_variable(set, *line, *n, name, err);
    else if (dims)
      rc = read_fixed(set, H5Tget_size(type), *line, *n, name, err);
  }
  H5Tclose(type);
  return rc;
}

int hdf_get_strings(hid_t loc, const char *name, char ***line, int *n, Err *err)
{
  *line = NULL, *n = 0;
  if (!hdf_has(loc, name)) return 0;
  hid_t set = H5Dopen2(loc, name, H5P_DEFAULT);
  if (set < 0) return hdf_fail(err, "'%s'", name);
  int rc = read_strings(set, name, line, n, err);
  H5Dclose(set);
  if (!rc) return 0;
  for (int i = 0; i < *n; i++) free((*line)[i]);
  free(*line);
  *line = NULL, *n = 0;
  return -1;
}

/* ---- datasets ---- */

/* Chunks of 64 Ki rows, at most 64 MiB; shuffle and gzip 1. Edges of chunks are filled, so that
 * files do not differ in them. */
static hid_t row_chunks(hid_t type, int rank, const hsize_t *dims)
{
  hsize_t chunk[H5S_MAX_RANK], row = H5Tget_size(type);
  for (int k = 1; k < rank; k++) chunk[k] = dims[k], row *= dims[k];
  hsize_t rows = ((hsize_t)64 << 20) / row;
  if (rows > 65536) rows = 65536;
  if (rows > dims[0]) rows = dims[0];
  chunk[0] = rows ? rows : 1;
  hid_t dcpl = no_times(H5P_DATASET_CREATE);
  H5Pset_chunk(dcpl, rank, chunk);
  H5Pset_fill_time(dcpl, H5D_FILL_TIME_ALLOC);
  H5Pset_shuffle(dcpl);
  H5Pset_deflate(dcpl, 1);
  return dcpl;
}

hid_t hdf_put_rows(hid_t loc, const char *name, hid_t type, int rank, const hsize_t *dims,
                   const void *data, Err *err)
{
  hid_t space = H5Screate_simple(rank, dims, NULL), dcpl = row_chunks(type, rank, dims);
  hid_t set = H5Dcreate2(loc, name, type, space, H5P_DEFAULT, dcpl, H5P_DEFAULT);
  int bad = set < 0 || (dims[0] && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0);
  if (bad) hdf_fail(err, "'%s'", name);
  H5Pclose(dcpl);
  H5Sclose(space);
  if (bad && set >= 0) H5Dclose(set);
  return bad ? -1 : set;
}

static H5T_conv_ret_t refuse_overflow(H5T_conv_except_t e, hid_t from, hid_t to, void *x, void *y,
                                      void *seen)
{
  (void)from, (void)to, (void)x, (void)y;
  if (e != H5T_CONV_EXCEPT_RANGE_HI && e != H5T_CONV_EXCEPT_RANGE_LOW) return H5T_CONV_UNHANDLED;
  *(int *)seen = 1;
  return H5T_CONV_ABORT;
}

int hdf_get_rows(hid_t dataset, hid_t type, void *data, Err *err)
{
  int overflow = 0;
  hid_t dxpl = H5Pcreate(H5P_DATASET_XFER);
  H5Pset_type_conv_cb(dxpl, refuse_overflow, &overflow);
  int rc = 0;
  if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, dxpl, data) < 0)
    rc = overflow ? err_set(err, "number out of range") : hdf_fail(err, "%s", "");
  H5Pclose(dxpl);
  return rc;
}

int hdf_shape(hid_t dataset, int most, hsize_t *dims)
{
  hid_t space = H5Dget_space(dataset);
  int rank = H5Sget_simple_extent_ndims(space);
  if (rank > most || rank < 0)
    rank = -1;
  else
    H5Sget_simple_extent_dims(space, dims, NULL);
  H5Sclose(space);
  return rank;
}
