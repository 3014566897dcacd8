/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "lib/hdf.h"
#include "lib/spool.h"
#include "show.h"

/* ---- text and binary files ---- */

static FILE *open_text(Spool *s, const char *path, int binary, Err *err)
{
  if (spool_out(s, path, binary, err)) return NULL;
  FILE *f = fopen(s->path, "wb");
  spool_opened(s);
  if (f) return f;
  err_set(err, "cannot write '%s': %s", path, strerror(errno));
  spool_abort(s);
  return NULL;
}

static int close_text(FILE *f, Spool *s, const char *path, Err *err)
{
  int bad = ferror(f);
  if (!fclose(f) && !bad) return spool_commit(s, err);
  err_set(err, "cannot write '%s': %s", path, strerror(errno));
  spool_abort(s);
  return -1;
}

static double real_at(const SheetColumn *c, long k)
{
  return c->size == 8 ? ((const double *)c->data)[k] : (double)((const float *)c->data)[k];
}

static long long whole_at(const SheetColumn *c, long k)
{
  const unsigned char *at = (const unsigned char *)c->data + (size_t)k * (size_t)c->size;
  int64_t x8;
  int32_t x4;
  int16_t x2;
  int sign = c->kind == 'i';
  switch (c->size) {
  case 8: memcpy(&x8, at, 8); return x8;
  case 4: memcpy(&x4, at, 4); return sign ? x4 : (long long)(uint32_t)x4;
  case 2: memcpy(&x2, at, 2); return sign ? x2 : (long long)(uint16_t)x2;
  default: return sign ? (signed char)*at : *at;
  }
}

/* ---- CSV ---- */

static void csv_number(FILE *f, const SheetColumn *c, long k)
{
  if (c->kind == 'f')
    fprintf(f, c->size == 8 ? "%.17g" : "%.9g", real_at(c, k));
  else if (c->kind == 'u' && c->size == 8)
    fprintf(f, "%llu", (unsigned long long)whole_at(c, k));
  else
    fprintf(f, "%lld", whole_at(c, k));
}

static void csv_head(FILE *f, const Sheet *s)
{
  char name[192];
  const char *comma = "";
  for (const SheetColumn *c = s->column; c < s->column + s->columns; c++)
    for (int k = 0; k < c->width; k++, comma = ",") {
      fprintf(f, "%s%s", comma, sheet_part(c, k, name, sizeof name));
      if (*c->unit && strcmp(c->unit, "1")) fprintf(f, " [%s]", c->unit);
    }
  fputs("\n", f);
}

int show_csv(const Parts *p, const Sheet *s, const char *path, Err *err)
{
  Spool spool;
  FILE *f = open_text(&spool, path, 0, err);
  if (!f) return -1;
  csv_head(f, s);
  for (long i = 0; i < p->n; i++) {
    const char *comma = "";
    for (const SheetColumn *c = s->column; c < s->column + s->columns; c++)
      for (int k = 0; k < c->width; k++, comma = ",") {
        fputs(comma, f);
        csv_number(f, c, i * c->width + k);
      }
    fputs("\n", f);
  }
  return close_text(f, &spool, path, err);
}

/* ---- VTK ---- */

/* Declares an array of the appended data; returns where the next one begins. */
static uint64_t vtu_array(FILE *f, const char *type, const char *name, int width, uint64_t bytes,
                          uint64_t offset)
{
  fprintf(f,
          "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" "
          "offset=\"%llu\"/>\n",
          type, name, width, (unsigned long long)offset);
  return offset + sizeof offset + bytes;
}

static uint64_t vtu_column(FILE *f, const SheetColumn *c, long n, uint64_t offset)
{
  char type[16], name[160];
  const char *kind = c->kind == 'f' ? "Float" : c->kind == 'i' ? "Int" : "UInt";
  snprintf(type, sizeof type, "%s%d", kind, 8 * c->size);
  int bare = !*c->unit || !strcmp(c->unit, "1") || !strcmp(c->name, "Coordinates");
  snprintf(name, sizeof name, bare ? "%s" : "%s [%s]", c->name, c->unit);
  return vtu_array(f, type, name, c->width, (uint64_t)n * (uint64_t)(c->width * c->size), offset);
}

static void vtu_block(FILE *f, const void *data, uint64_t bytes)
{
  fwrite(&bytes, sizeof bytes, 1, f);
  fwrite(data, 1, bytes, f);
}

/* A column; symmetric tensors in VTK's order, xx yy zz xy yz xz. */
static int vtu_data(FILE *f, const SheetColumn *c, long n, Err *err)
{
  static const int order[6] = {0, 3, 5, 1, 4, 2};
  const size_t size = (size_t)c->size, row = (size_t)c->width * size;
  const unsigned char *from = c->data;
  if (c->width != 6) return vtu_block(f, from, (uint64_t)n * row), 0;
  unsigned char *to = malloc((size_t)n * row + 1);
  if (!to) return err_set(err, "out of memory");
  for (size_t i = 0; i < (size_t)n; i++)
    for (size_t k = 0; k < 6; k++)
      memcpy(to + i * row + k * size, from + i * row + (size_t)order[k] * size, size);
  vtu_block(f, to, (uint64_t)n * row);
  free(to);
  return 0;
}

/* Points, then one vertex a particle: 0 1 2 ..., ends 1 2 3 ..., type 1; then the fields. */
static void vtu_head(FILE *f, const Parts *p, const SheetColumn *x, const Sheet *s)
{
  const unsigned one = 1;
  const char *order = *(const unsigned char *)&one ? "LittleEndian" : "BigEndian";
  const uint64_t n = (uint64_t)p->n;
  fprintf(f,
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
          "byte_order=\"%s\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<FieldData>\n"
          "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
          "%.17g</DataArray>\n</FieldData>\n"
          "<Piece NumberOfPoints=\"%ld\" NumberOfCells=\"%ld\">\n<Points>\n",
          order, p->time, p->n, p->n);
  uint64_t at = vtu_column(f, x, p->n, 0);
  fputs("</Points>\n<Cells>\n", f);
  at = vtu_array(f, "Int64", "connectivity", 1, 8 * n, at);
  at = vtu_array(f, "Int64", "offsets", 1, 8 * n, at);
  at = vtu_array(f, "UInt8", "types", 1, n, at);
  fputs("</Cells>\n<PointData>\n", f);
  for (const SheetColumn *c = s->column; c < s->column + s->columns; c++)
    if (strcmp(c->name, "Coordinates")) at = vtu_column(f, c, p->n, at);
  fputs("</PointData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_", f);
}

/* Coordinates, connectivity, offsets, types, fields: as declared. */
static int vtu_blocks(FILE *f, const Parts *p, const Sheet *s, Err *err)
{
  const uint64_t n = (uint64_t)p->n;
  int64_t *rank = malloc(((size_t)p->n + 1) * sizeof *rank);
  unsigned char *vertex = malloc((size_t)p->n + 1);
  int rc = rank && vertex ? 0 : err_set(err, "out of memory");
  if (!rc) {
    for (long i = 0; i <= p->n; i++) rank[i] = i;
    memset(vertex, 1, (size_t)p->n);
    vtu_block(f, p->x, 24 * n);
    vtu_block(f, rank, 8 * n);
    vtu_block(f, rank + 1, 8 * n);
    vtu_block(f, vertex, n);
  }
  free(rank);
  free(vertex);
  for (const SheetColumn *c = s->column; c < s->column + s->columns && !rc; c++)
    if (strcmp(c->name, "Coordinates")) rc = vtu_data(f, c, p->n, err);
  return rc;
}

int show_vtu(const Parts *p, const Sheet *s, const char *path, Err *err)
{
  const SheetColumn x = {"Coordinates", "m", "", p->x, H5T_NATIVE_DOUBLE, 3, 8, 'f'};
  Spool spool;
  FILE *f = open_text(&spool, path, 1, err);
  if (!f) return -1;
  vtu_head(f, p, &x, s);
  if (vtu_blocks(f, p, s, err)) {
    fclose(f);
    spool_abort(&spool);
    return -1;
  }
  fputs("\n</AppendedData>\n</VTKFile>\n", f);
  return close_text(f, &spool, path, err);
}

/* ---- series ---- */

struct ShowSeries {
  Spool spool;
  char path[4096];
  hid_t file; /* H5Part */
  FILE *text; /* XDMF */
  int steps;
};

static ShowSeries *new_series(const char *path, Err *err)
{
  ShowSeries *series = calloc(1, sizeof *series);
  if (!series) return err_null(err, "out of memory");
  snprintf(series->path, sizeof series->path, "%s", path);
  return series;
}

ShowSeries *show_h5part_open(const char *path, Err *err)
{
  Err why;
  ShowSeries *series = new_series(path, err);
  if (!series || spool_out(&series->spool, path, 1, err)) return free(series), NULL;
  series->file = hdf_create(series->spool.path, &why);
  spool_opened(&series->spool);
  if (series->file >= 0) return series;
  spool_abort(&series->spool);
  free(series);
  return err_null(err, "cannot write '%s': %s", path, why.text);
}

/* Component k of a column as a list of its own. */
static int put_component(hid_t step, const SheetColumn *c, int k, long n, Err *err)
{
  char name[192];
  const hsize_t dims = (hsize_t)n;
  const size_t size = (size_t)c->size;
  const unsigned char *from = (const unsigned char *)c->data + (size_t)k * size;
  unsigned char *list = malloc((size_t)n * size + 1);
  if (!list) return err_set(err, "out of memory");
  for (long i = 0; i < n; i++)
    memcpy(list + (size_t)i * size, from + (size_t)i * (size_t)c->width * size, size);
  if (!strcmp(c->name, "Coordinates"))
    snprintf(name, sizeof name, "%c", "xyz"[k]);
  else if (c->width > 1)
    snprintf(name, sizeof name, "%s_%d", c->name, k);
  else
    snprintf(name, sizeof name, "%s", c->name);
  hid_t set = hdf_put_rows(step, name, c->type, 1, &dims, list, err);
  int rc = set < 0 || hdf_put_text(set, "unit", c->unit, err) ? -1 : 0;
  if (set >= 0) H5Dclose(set);
  free(list);
  return rc;
}

int show_h5part_add(ShowSeries *series, const Parts *p, const Sheet *s, Err *err)
{
  char name[32];
  Err why;
  snprintf(name, sizeof name, "Step#%d", series->steps++);
  hid_t step = hdf_group(series->file, name, &why);
  int rc = step < 0 ? -1 : hdf_put(step, "TimeValue", H5T_NATIVE_DOUBLE, 1, &p->time, &why);
  for (const SheetColumn *c = s->column; c < s->column + s->columns; c++)
    for (int k = 0; k < c->width && !rc; k++) rc = put_component(step, c, k, p->n, &why);
  if (step >= 0) H5Gclose(step);
  return rc ? err_set(err, "cannot write '%s': %s", series->path, why.text) : 0;
}

int show_h5part_close(ShowSeries *series, int good, Err *err)
{
  Err why;
  int rc = hdf_close(series->file, &why);
  if (rc && good) err_set(err, "cannot write '%s': %s", series->path, why.text);
  if (good && !rc)
    rc = spool_commit(&series->spool, err);
  else
    spool_abort(&series->spool);
  free(series);
  return rc;
}

ShowSeries *show_xdmf_open(const char *path, Err *err)
{
  ShowSeries *series = new_series(path, err);
  if (series) series->text = open_text(&series->spool, path, 0, err);
  if (!series || !series->text) return free(series), NULL;
  fputs("<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
        "<Grid Name=\"particles\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
        series->text);
  return series;
}

/* Characters that mean something in XML. */
static void xml_text(FILE *f, const char *s)
{
  for (; *s; s++)
    if (*s == '&')
      fputs("&amp;", f);
    else if (*s == '<')
      fputs("&lt;", f);
    else if (*s == '"')
      fputs("&quot;", f);
    else
      fputc(*s, f);
}

static void xdmf_item(FILE *f, const SheetColumn *c, long n, const char *file)
{
  const char *type = c->kind == 'f'   ? "Float"
                     : c->size < 4    ? "Char"
                     : c->kind == 'i' ? "Int"
                                      : "UInt";
  fprintf(f, "<DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"%d\" Dimensions=\"%ld", type,
          c->size, n);
  if (c->width > 1) fprintf(f, " %d", c->width);
  fputs("\">", f);
  xml_text(f, file);
  fprintf(f, ":/PartType0/%s</DataItem>\n", c->name);
}

static void xdmf_attribute(FILE *f, const SheetColumn *c, long n, const char *file)
{
  static const char *const KIND[10] = {
      [1] = "Scalar", [3] = "Vector", [6] = "Tensor6", [9] = "Tensor"};
  const char *kind = c->width < 10 && KIND[c->width] ? KIND[c->width] : "Matrix";
  if (c->size == 2) return; /* XDMF has no such numbers */
  fputs("<Attribute Name=\"", f);
  xml_text(f, c->name);
  fprintf(f, "\" AttributeType=\"%s\" Center=\"Node\">\n", kind);
  xdmf_item(f, c, n, file);
  fputs("</Attribute>\n", f);
}

/* The snapshot's name as seen from the XDMF file: what follows that file's folder, else whole. */
static int seen_from(const char *xdmf, const char *snapshot, char *out, size_t size, Err *err)
{
  const char *slash = strrchr(xdmf, '/');
  size_t folder = slash ? (size_t)(slash - xdmf) + 1 : 0, used = 0;
  if (folder && !strncmp(snapshot, xdmf, folder))
    snapshot += folder;
  else if (folder && *snapshot != '/') {
    if (!getcwd(out, size - 1)) return err_set(err, "'%s': %s", snapshot, strerror(errno));
    used = strlen(out);
    out[used++] = '/';
  }
  int length = snprintf(out + used, size - used, "%s", snapshot);
  return length < (int)(size - used) ? 0 : err_set(err, "'%s': name too long", snapshot);
}

int show_xdmf_add(ShowSeries *series, const Parts *p, const Sheet *s, const char *snapshot,
                  Err *err)
{
  const SheetColumn x = {"Coordinates", "m", "", p->x, H5T_NATIVE_DOUBLE, 3, 8, 'f'};
  char file[4096];
  FILE *f = series->text;
  if (seen_from(series->path, snapshot, file, sizeof file, err)) return -1;
  fprintf(f,
          "<Grid Name=\"step %d\" GridType=\"Uniform\">\n<Time Value=\"%.17g\"/>\n"
          "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"%ld\"/>\n"
          "<Geometry GeometryType=\"XYZ\">\n",
          series->steps++, p->time, p->n);
  xdmf_item(f, &x, p->n, file);
  fputs("</Geometry>\n", f);
  for (const SheetColumn *c = s->column; c < s->column + s->columns; c++)
    if (strcmp(c->name, "Coordinates")) xdmf_attribute(f, c, p->n, file);
  fputs("</Grid>\n", f);
  return 0;
}

int show_xdmf_close(ShowSeries *series, int good, Err *err)
{
  int rc = -1;
  fputs("</Grid>\n</Domain>\n</Xdmf>\n", series->text);
  if (good)
    rc = close_text(series->text, &series->spool, series->path, err);
  else {
    fclose(series->text);
    spool_abort(&series->spool);
  }
  free(series);
  return rc;
}
