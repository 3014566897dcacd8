/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Source file "." means the file itself, whatever its name will be. */
#include <stdio.h>
#include <string.h>

#include "hdf.h"
#include "view.h"

hid_t view_open(hid_t file, double time, Err *err)
{
  hid_t step = hdf_group(file, "Step#0", err);
  if (step < 0 || !hdf_put(step, "TimeValue", H5T_NATIVE_DOUBLE, 0, &time, err)) return step;
  H5Gclose(step);
  return -1;
}

/* Column k of an [n][width] dataset as a virtual dataset of n elements, of the same type. */
static int add_column(hid_t step, const char *column, const char *source, hid_t type,
                      const hsize_t dims[2], hsize_t k, Err *err)
{
  const hsize_t start[2] = {0, k}, count[2] = {dims[0], 1};
  hid_t from = H5Screate_simple(2, dims, NULL), to = H5Screate_simple(1, dims, NULL);
  hid_t dcpl = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(dcpl, 0);
  H5Sselect_hyperslab(from, H5S_SELECT_SET, start, NULL, count, NULL);
  hid_t set = -1;
  if (H5Pset_virtual(dcpl, to, ".", source, from) >= 0)
    set = H5Dcreate2(step, column, type, to, H5P_DEFAULT, dcpl, H5P_DEFAULT);
  if (set < 0)
    hdf_fail(err, "'Step#0/%s'", column);
  else
    H5Dclose(set);
  H5Pclose(dcpl);
  H5Sclose(to);
  H5Sclose(from);
  return set < 0 ? -1 : 0;
}

static int add_columns(hid_t step, const char *name, hid_t type, const hsize_t dims[2], Err *err)
{
  char source[192], column[160];
  int place = !strcmp(name, "Coordinates");
  snprintf(source, sizeof source, "/PartType0/%s", name);
  for (hsize_t k = 0; k < dims[1]; k++) {
    if (place)
      snprintf(column, sizeof column, "%c", "xyz"[k]);
    else
      snprintf(column, sizeof column, "%s_%d", name, (int)k);
    int there = hdf_has(step, column);
    if (there < 0) return hdf_fail(err, "'Step#0'");
    if (!there && add_column(step, column, source, type, dims, k, err)) return -1;
  }
  return 0;
}

static int add_link(hid_t step, hid_t particles, const char *name, Err *err)
{
  int there = hdf_has(step, name);
  if (there > 0) return 0;
  if (!there && H5Lcreate_hard(particles, name, step, name, H5P_DEFAULT, H5P_DEFAULT) >= 0)
    return 0;
  return hdf_fail(err, "'Step#0/%s'", name);
}

int view_add(hid_t step, hid_t particles, const char *name, Err *err)
{
  enum { WIDEST = 9 }; /* a tensor */
  hsize_t dims[2];
  hid_t set = H5Dopen2(particles, name, H5P_DEFAULT);
  if (set < 0) return hdf_fail(err, "'%s'", name);
  hid_t type = H5Dget_type(set);
  int rank = hdf_shape(set, 2, dims), rc = 0;
  H5T_class_t class = H5Tget_class(type);
  if (class == H5T_INTEGER || class == H5T_FLOAT) {
    if (rank == 1) rc = add_link(step, particles, name, err);
    if (rank == 2 && dims[1] <= WIDEST) rc = add_columns(step, name, type, dims, err);
  }
  H5Tclose(type);
  H5Dclose(set);
  return rc;
}
