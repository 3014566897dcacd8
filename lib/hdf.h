/* SPDX-License-Identifier: GPL-3.0-or-later */
/* HDF5 in the few forms that snapshots need: attributes, lists of strings, datasets by rows.
 * Nothing is printed by HDF5; a failure becomes one line that ends in HDF5's innermost reason. No
 * object keeps a date. */
#ifndef HDF_H
#define HDF_H

#include <hdf5.h>
#include "err.h"

/* hdf_fail: the message, a colon and the reason of the HDF5 call that failed last. Call it before
 * any other HDF5 function. */
int hdf_fail(Err *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* hdf_create, hdf_open (read only): a file, or -1. hdf_close: flushes first, so that a full disk is
 * noticed. */
hid_t hdf_create(const char *path, Err *err);
hid_t hdf_open(const char *path, Err *err);
int hdf_close(hid_t file, Err *err);

/* hdf_group: a new group that keeps the order of its attributes. hdf_has: 1 when a link of that
 * name is there, 0 when not, -1 when the file is too damaged to say; opening it then says why, so
 * do not take -1 for absent. */
hid_t hdf_group(hid_t loc, const char *name, Err *err);
int hdf_has(hid_t loc, const char *name);

/* hdf_put: an attribute of n elements of a native type; n = 0 makes a scalar. hdf_put_text: a
 * string attribute. */
int hdf_put(hid_t obj, const char *name, hid_t type, int n, const void *data, Err *err);
int hdf_put_text(hid_t obj, const char *name, const char *text, Err *err);

/* hdf_get: reads an attribute of 1 to `most` elements, converted to type; returns how many, or -1.
 * hdf_get_text: a string attribute, "" when there is none; one that does not fit is an error. */
int hdf_get(hid_t obj, const char *name, hid_t type, int most, void *data, Err *err);
int hdf_get_text(hid_t obj, const char *name, char *out, int size, Err *err);

/* hdf_put_strings: a dataset of n strings (none when n is 0). hdf_get_strings: the same, fixed or
 * variable length; an absent one is empty. The strings and the list are the caller's to free. */
int hdf_put_strings(hid_t loc, const char *name, char *const *line, int n, Err *err);
int hdf_get_strings(hid_t loc, const char *name, char ***line, int *n, Err *err);

/* hdf_put_rows: a dataset of dims[0] rows, chunked, shuffled and gzipped; the dataset (to be
 * closed), or -1. */
hid_t hdf_put_rows(hid_t loc, const char *name, hid_t type, int rank, const hsize_t *dims,
                   const void *data, Err *err);

/* hdf_get_rows: reads all of a dataset, converted to type; numbers that do not fit are an error. */
int hdf_get_rows(hid_t dataset, hid_t type, void *data, Err *err);

/* hdf_shape: rank (at most `most`) and dims of a dataset; -1 when it has more dimensions. */
int hdf_shape(hid_t dataset, int most, hsize_t *dims);

#endif
