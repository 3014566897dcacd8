/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK file formats (The VTK User's Guide, Kitware): cells of a grid of n + 1 points; legacy numbers
 * are big-endian, those of the XML file follow its header as they are, each array behind its
 * length. */
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/hdf.h"
#include "lib/spool.h"
#include "raster.h"

static long cells(const Raster *r) { return (long)r->n[0] * r->n[1] * r->n[2]; }

/* ---- HDF5 ---- */

static int put_values(hid_t file, const char *name, const char *unit, hid_t type, int rank,
                      const hsize_t *dims, const void *data, Err *err)
{
  hid_t set = hdf_put_rows(file, name, type, rank, dims, data, err);
  if (set < 0) return -1;
  int bad = hdf_put_text(set, "unit", unit, err);
  H5Dclose(set);
  return bad;
}

static int put_axis(hid_t file, const Raster *r, int a, Err *err)
{
  const char name[2] = {(char)('x' + a), 0};
  const hsize_t n = (hsize_t)r->n[a];
  double *centre = malloc((size_t)n * sizeof *centre);
  if (!centre) return err_set(err, "out of memory");
  for (int i = 0; i < r->n[a]; i++) centre[i] = r->lo[a] + (i + 0.5) * r->cell[a];
  int bad = put_values(file, name, "m", H5T_NATIVE_DOUBLE, 1, &n, centre, err);
  free(centre);
  return bad;
}

static int put_all(hid_t file, const Raster *r, Err *err)
{
  const hsize_t dims[3] = {(hsize_t)r->n[2], (hsize_t)r->n[1], (hsize_t)r->n[0]};
  if (hdf_put(file, "Time", H5T_NATIVE_DOUBLE, 0, &r->time, err) ||
      hdf_put(file, "Origin", H5T_NATIVE_DOUBLE, 3, r->lo, err) ||
      hdf_put(file, "Spacing", H5T_NATIVE_DOUBLE, 3, r->cell, err) ||
      hdf_put_text(file, "About", r->about, err))
    return -1;
  for (int a = 0; a < 3; a++)
    if (put_axis(file, r, a, err)) return -1;
  for (int f = 0; f < r->fields; f++)
    if (put_values(file, r->field[f].name, r->field[f].unit, H5T_NATIVE_FLOAT, 3, dims,
                   r->field[f].value, err))
      return -1;
  return 0;
}

static int write_hdf5(const Raster *r, Spool *s, Err *err)
{
  hid_t file = hdf_create(s->path, err);
  spool_opened(s);
  int bad = file < 0 || put_all(file, r, err);
  if (file >= 0 && hdf_close(file, bad ? NULL : err)) bad = 1;
  return bad;
}

/* ---- VTK ---- */

static void big_endian(FILE *f, const void *data, size_t size, long n)
{
  const unsigned char *byte = data;
  unsigned char turned[8];
  const uint16_t one = 1;
  int little = *(const unsigned char *)&one;
  for (long k = 0; k < n; k++, byte += size) {
    for (size_t b = 0; b < size; b++) turned[b] = byte[little ? size - 1 - b : b];
    fwrite(turned, 1, size, f);
  }
}

static void write_vtk(const Raster *r, FILE *f)
{
  fprintf(f, "# vtk DataFile Version 3.0\n%.250s\nBINARY\nDATASET STRUCTURED_POINTS\n", r->about);
  fprintf(f, "DIMENSIONS %d %d %d\n", r->n[0] + 1, r->n[1] + 1, r->n[2] + 1);
  fprintf(f, "ORIGIN %.17g %.17g %.17g\n", r->lo[0], r->lo[1], r->lo[2]);
  fprintf(f, "SPACING %.17g %.17g %.17g\n", r->cell[0], r->cell[1], r->cell[2]);
  fprintf(f, "FIELD FieldData 1\nTIME 1 1 double\n");
  big_endian(f, &r->time, sizeof r->time, 1);
  fprintf(f, "\nCELL_DATA %ld\n", cells(r));
  for (int k = 0; k < r->fields; k++) {
    fprintf(f, "SCALARS %s float 1\nLOOKUP_TABLE default\n", r->field[k].name);
    big_endian(f, r->field[k].value, sizeof(float), cells(r));
    fputc('\n', f);
  }
}

static void write_vti(const Raster *r, FILE *f)
{
  const uint16_t one = 1;
  char extent[80];
  uint64_t bytes = (uint64_t)cells(r) * sizeof(float), offset = sizeof bytes + sizeof r->time;
  snprintf(extent, sizeof extent, "0 %d 0 %d 0 %d", r->n[0], r->n[1], r->n[2]);
  fprintf(f,
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
          "byte_order=\"%s\" header_type=\"UInt64\">\n",
          *(const unsigned char *)&one ? "LittleEndian" : "BigEndian");
  fprintf(f,
          "<ImageData WholeExtent=\"%s\" Origin=\"%.17g %.17g %.17g\" Spacing=\"%.17g %.17g "
          "%.17g\">\n",
          extent, r->lo[0], r->lo[1], r->lo[2], r->cell[0], r->cell[1], r->cell[2]);
  fprintf(f,
          "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
          "format=\"appended\" offset=\"0\"/></FieldData>\n<Piece Extent=\"%s\"><CellData>\n",
          extent);
  for (int k = 0; k < r->fields; k++, offset += sizeof bytes + bytes)
    fprintf(f, "<DataArray type=\"Float32\" Name=\"%s\" format=\"appended\" offset=\"%llu\"/>\n",
            r->field[k].name, (unsigned long long)offset);
  fprintf(f, "</CellData></Piece></ImageData>\n<AppendedData encoding=\"raw\">\n_");
  fwrite(&(uint64_t){sizeof r->time}, sizeof bytes, 1, f);
  fwrite(&r->time, sizeof r->time, 1, f);
  for (int k = 0; k < r->fields; k++) {
    fwrite(&bytes, sizeof bytes, 1, f);
    fwrite(r->field[k].value, sizeof(float), (size_t)cells(r), f);
  }
  fprintf(f, "\n</AppendedData></VTKFile>\n");
}

static int write_stream(const Raster *r, Spool *s, void (*put)(const Raster *, FILE *), Err *err)
{
  errno = 0;
  FILE *f = fopen(s->path, "wb");
  spool_opened(s);
  if (f) put(r, f);
  int bad = !f || ferror(f);
  if (f && fclose(f)) bad = 1;
  return bad ? err_set(err, "%s", strerror(errno)) : 0;
}

int raster_write(const Raster *r, const char *path, const char *format, Err *err)
{
  Spool s;
  Err why = {""};
  if (spool_out(&s, path, 1, err)) return -1;
  int bad = !strcmp(format, "hdf5")
                ? write_hdf5(r, &s, &why)
                : write_stream(r, &s, strcmp(format, "vtk") ? write_vti : write_vtk, &why);
  if (!bad) return spool_commit(&s, err);
  spool_abort(&s);
  return err_set(err, "cannot write '%s': %s", !path || !strcmp(path, "-") ? "stdout" : path,
                 why.text);
}
