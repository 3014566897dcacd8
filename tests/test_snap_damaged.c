/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Snapshots that were damaged on purpose: one line that names the file, the field and what is
 * wrong. And files as h5py writes them, which are as good as our own. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

#include <hdf5.h>

#include "snaps.h"

static void assert_text(const char *a, const char *b) { assert_string_equal(a, b); }

static void assert_unreadable(const char *path, const char *reason)
{
  Err err = {""};
  char text[1024];
  Parts *p = snap_read(path, &err);
  if (p) fail_msg("read, but should not: %s", reason);
  snprintf(text, sizeof text, "cannot read '%s': %s", path, reason);
  assert_text(err.text, text);
}

static void no_snapshots(void **state)
{
  (void)state;
  Err err;
  struct stat st;
  Parts *p = snaps_bare(2000);
  assert_null(snap_read("none", &err));
  assert_text(err.text, "cannot open 'none': No such file or directory");
  assert_unreadable(".", "Is a directory");
  fclose(fopen("a", "w"));
  assert_unreadable("a", "empty file");
  FILE *f = fopen("a", "w");
  for (int i = 0; i < 1000; i++) fputs("no HDF5\n", f);
  fclose(f);
  assert_unreadable("a", "not an HDF5 file");
  assert_int_equal(snap_write(p, "a", 0, &err), 0);
  stat("a", &st);
  for (off_t size = st.st_size - 1; size > 1000; size /= 2) {
    assert_int_equal(truncate("a", size), 0);
    assert_unreadable("a", "truncated file");
  }
  H5Fclose(H5Fcreate("a", H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  assert_unreadable("a", "no snapshot: lacks group 'Header'");
  part_free(p);
}

/* Replaces or adds (rows > 0), or only removes, a dataset of /PartType0. */
static void replace(hid_t f, const char *name, hid_t type, hsize_t rows, hsize_t width)
{
  char path[128];
  hsize_t dims[2] = {rows, width};
  snprintf(path, sizeof path, "PartType0/%s", name);
  if (H5Lexists(f, path, H5P_DEFAULT) > 0) H5Ldelete(f, path, H5P_DEFAULT);
  if (!rows) return;
  hid_t space = H5Screate_simple(width ? 2 : 1, dims, NULL);
  hid_t d = H5Dcreate2(f, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(d >= 0);
  H5Dclose(d);
  H5Sclose(space);
}

static void set_attribute(hid_t f, const char *object, const char *name, hsize_t n, double value)
{
  double x[8] = {value};
  if (H5Aexists_by_name(f, object, name, H5P_DEFAULT) > 0)
    H5Adelete_by_name(f, object, name, H5P_DEFAULT);
  if (!n) return;
  hid_t space = H5Screate_simple(1, &n, NULL);
  hid_t a = H5Acreate_by_name(f, object, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT,
                              H5P_DEFAULT);
  H5Awrite(a, H5T_NATIVE_DOUBLE, x);
  H5Aclose(a);
  H5Sclose(space);
}

#define DAMAGED(CHANGE, REASON)                                                                    \
  do {                                                                                             \
    Err err;                                                                                       \
    assert_int_equal(snap_write(p, "a.h5", 0, &err), 0);                                           \
    hid_t f = H5Fopen("a.h5", H5F_ACC_RDWR, H5P_DEFAULT);                                          \
    CHANGE;                                                                                        \
    H5Fclose(f);                                                                                   \
    assert_unreadable("a.h5", REASON);                                                             \
  } while (0)

static void damaged_header(void **state)
{
  (void)state;
  Parts *p = snaps_bare(10);
  DAMAGED(H5Ldelete(f, "PartType0", H5P_DEFAULT), "no snapshot: lacks group 'PartType0'");
  DAMAGED(set_attribute(f, "Header", "FormatVersion", 0, 0), "lacks attribute 'FormatVersion'");
  DAMAGED(set_attribute(f, "Header", "FormatVersion", 1, 2),
          "format version 2, this program knows up to 1");
  DAMAGED(set_attribute(f, "Header", "FormatVersion", 1, 0), "format version 0 does not exist");
  DAMAGED(set_attribute(f, "Header", "Time", 0, 0), "lacks attribute 'Time'");
  DAMAGED(set_attribute(f, "Header", "Time", 2, 0), "attribute 'Time' has 2 elements, not 1");
  DAMAGED(set_attribute(f, "Header", "NumPart_ThisFile", 1, 9),
          "field 'ParticleIDs': has 10 rows for 9 particles");
  DAMAGED(set_attribute(f, "Header", "NumPart_ThisFile", 6, 0), "holds no particles of type 0");
  part_free(p);
}

static void damaged_fields(void **state)
{
  (void)state;
  const hid_t real = H5T_NATIVE_DOUBLE, whole = H5T_NATIVE_INT;
  Parts *p = snaps_bare(10);
  DAMAGED(replace(f, "Masses", real, 9, 0), "field 'Masses': has 9 rows for 10 particles");
  DAMAGED(replace(f, "Coordinates", real, 10, 2), "field 'Coordinates': has not 3 columns");
  DAMAGED(replace(f, "Coordinates", real, 10, 0), "field 'Coordinates': has not 3 columns");
  DAMAGED(replace(f, "Masses", real, 10, 1), "field 'Masses': has 2 dimensions, must be a list");
  DAMAGED(replace(f, "Masses", whole, 10, 0), "field 'Masses': does not hold real numbers");
  DAMAGED(replace(f, "BodyID", real, 10, 0), "field 'BodyID': does not hold whole numbers");
  DAMAGED(replace(f, "Masses", H5T_C_S1, 10, 0), "field 'Masses': does not hold real numbers");
  DAMAGED(set_attribute(f, "PartType0/Masses", "unitSI", 1, 1e3),
          "field 'Masses': is not in SI units (unitSI is 1000)");
  DAMAGED(replace(f, "Colour", real, 11, 0), "field 'Colour': has 11 rows for 10 particles");
  DAMAGED(replace(f, "FlawCount", whole, 10, 0),
          "has only one of 'FlawCount' and 'FlawThresholds'");
  DAMAGED(replace(f, "FlawCount", whole, 10, 0);
          replace(f, "FlawThresholds", real, 3, 0),
          "field 'FlawThresholds': has 3 rows for 0 particles");
  part_free(p);
}

static void whole_numbers_must_fit(void **state)
{
  (void)state;
  Parts *p = snaps_bare(1);
  const int64_t big = (int64_t)1 << 40;
  DAMAGED(
      {
        replace(f, "BodyID", H5T_NATIVE_INT64, 1, 0);
        hid_t d = H5Dopen2(f, "PartType0/BodyID", H5P_DEFAULT);
        H5Dwrite(d, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &big);
        H5Dclose(d);
      },
      "field 'BodyID': number out of range");
  part_free(p);
}

static void what_holds_pointers_is_refused(void **state)
{
  (void)state;
  Parts *p = snaps_bare(2);
  hid_t text = H5Tcopy(H5T_C_S1), list = H5Tvlen_create(H5T_NATIVE_INT);
  H5Tset_size(text, H5T_VARIABLE);
  const char *reason = "field 'Odd': is of variable length or a reference, cannot be carried";
  DAMAGED(replace(f, "Odd", text, 2, 0), reason);
  DAMAGED(replace(f, "Odd", list, 2, 0), reason);
  DAMAGED(replace(f, "Odd", H5T_STD_REF_OBJ, 2, 0), reason);
  H5Tclose(text);
  H5Tclose(list);
  part_free(p);
}

/* A bit that flips inside the compressed numbers is noticed by gzip's checksum. */
static void damaged_data(void **state)
{
  (void)state;
  Err err;
  Parts *p = snaps_bare(20000);
  uint64_t seed = 9;
  snaps_fill(p->x, (size_t)p->n * 24, &seed);
  assert_int_equal(snap_write(p, "a.h5", 0, &err), 0);
  hid_t f = H5Fopen("a.h5", H5F_ACC_RDONLY, H5P_DEFAULT);
  hid_t d = H5Dopen2(f, "PartType0/Coordinates", H5P_DEFAULT);
  const hsize_t start[2] = {0, 0};
  haddr_t address;
  hsize_t size;
  unsigned mask;
  assert_true(H5Dget_chunk_info_by_coord(d, start, &mask, &address, &size) >= 0);
  H5Dclose(d);
  H5Fclose(f);
  FILE *file = fopen("a.h5", "r+b");
  fseek(file, (long)(address + size / 2), SEEK_SET);
  int c = getc(file);
  fseek(file, -1, SEEK_CUR);
  putc(c ^ 4, file);
  fclose(file);
  assert_null(snap_read("a.h5", &err));
  assert_non_null(strstr(err.text, "cannot read 'a.h5': field 'Coordinates': inflate() failed"));
  part_free(p);
}

/* A group whose index is destroyed is not taken for one that lacks a field: every structure of the
 * file that begins with a signature loses it in turn, and no field ever vanishes in silence. */
static void damaged_groups_lose_no_field(void **state)
{
  (void)state;
  Err err;
  static const char *const mark[] = {"TREE", "SNOD", "HEAP", "OHDR"};
  static char data[1 << 18];
  int marks = 0, refused = 0;
  Parts *p = snaps_bare(10);
  assert_int_equal(snap_write(p, "a.h5", 0, &err), 0);
  FILE *file = fopen("a.h5", "rb");
  size_t size = fread(data, 1, sizeof data, file);
  fclose(file);
  assert_true(size < sizeof data);
  for (size_t at = 0; at + 4 < size; at++)
    for (int k = 0; k < 4; k++) {
      if (memcmp(data + at, mark[k], 4)) continue;
      file = fopen("a.h5", "wb");
      data[at] ^= 1;
      fwrite(data, 1, size, file);
      data[at] ^= 1;
      fclose(file);
      Parts *q = snap_read("a.h5", &err);
      assert_true(!q || (q->id && q->x && q->v && q->m && q->rho && q->u));
      if (!q) assert_null(strstr(err.text, "lacks"));
      marks++, refused += !q;
      part_free(q);
    }
  assert_true(marks > 10 && refused > marks / 4);
  part_free(p);
}

/* As h5py writes them: strings of variable length, no order of attributes, extra header entries. */
static void put_variable(hid_t loc, const char *name, const char **text, hsize_t n, int attribute)
{
  hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate_simple(1, &n, NULL);
  H5Tset_size(type, H5T_VARIABLE), H5Tset_cset(type, H5T_CSET_UTF8);
  if (attribute) {
    hid_t one = H5Screate(H5S_SCALAR),
          a = H5Acreate2(loc, name, type, one, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(a, type, text);
    H5Aclose(a), H5Sclose(one);
  } else {
    hid_t d = H5Dcreate2(loc, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(d, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text);
    H5Dclose(d);
  }
  H5Sclose(space), H5Tclose(type);
}

static void what_h5py_writes_is_read(void **state)
{
  (void)state;
  Err err = {""};
  Parts *p = snaps_bare(4);
  assert_int_equal(snap_write(p, "a.h5", 0, &err), 0);
  hid_t f = H5Fopen("a.h5", H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(f, "Materials", H5P_DEFAULT);
  H5Gclose(H5Gcreate2(f, "Materials", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Gclose(H5Gcreate2(f, "Body", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  put_variable(f, "Materials/Name", (const char *[]){"ice", "iron"}, 2, 0);
  put_variable(f, "Materials/Text", (const char *[]){"a", ""}, 2, 0);
  set_attribute(f, "Body", "b", 1, 1), set_attribute(f, "Body", "a", 1, 2);
  replace(f, "Colour", H5T_IEEE_F32BE, 4, 0);
  hid_t d = H5Dopen2(f, "PartType0/Colour", H5P_DEFAULT);
  put_variable(d, "unit", (const char *[]){"nm"}, 1, 1);
  H5Dwrite(d, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, (double[]){1, 2, 3, 4});
  H5Dclose(d);
  H5Fclose(f);
  Parts *q = snap_read("a.h5", &err);
  assert_text(err.text, "");
  assert_int_equal(q->materials, 2);
  assert_text(q->material[1].name, "iron"), assert_text(q->material[0].text, "a");
  assert_text(q->body_info[0].name, "a");
  assert_text(q->extra[0].unit, "nm");
  assert_memory_equal(q->extra[0].data, ((float[]){1, 2, 3, 4}), 16);
  part_free(p);
  part_free(q);
}

int main(void)
{
  H5dont_atexit(); /* as lib/hdf.c does, before anything else initialises HDF5 */
#define T(NAME) cmocka_unit_test_setup_teardown(NAME, folder_setup, folder_teardown)
  const struct CMUnitTest tests[] = {
      T(no_snapshots),
      T(damaged_header),
      T(damaged_fields),
      T(whole_numbers_must_fit),
      T(what_holds_pointers_is_refused),
      T(damaged_data),
      T(damaged_groups_lose_no_field),
      T(what_h5py_writes_is_read),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
