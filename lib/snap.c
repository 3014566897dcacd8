/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a snapshot, written and read side by side: /Header, /Units, /Materials, /History,
 * /Parameters, /Collision, /Body, /PointMasses, /PartType0, and the view Step#0. Inner functions
 * say what is
 * wrong; snap_read and snap_write put the file's name before it. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "hdf.h"
#include "pointmass.h"
#include "snap.h"
#include "spool.h"
#include "view.h"

enum { FORMAT_VERSION = 1, PARTICLE_TYPES = 6 };

static hid_t native(char kind)
{
  return kind == 'd' ? H5T_NATIVE_DOUBLE : kind == 'l' ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32;
}

/* ---- writing ---- */

typedef struct {
  hid_t file, particles, step;
  Err *err;
} Writer;

static int put_header(const Writer *w, const Parts *p)
{
  const int64_t count[PARTICLE_TYPES] = {p->n};
  const double masses[PARTICLE_TYPES] = {0}, box = 0; /* 0: readers take the bounds from the data */
  const int version = FORMAT_VERSION, files = 1;
  hid_t g = hdf_group(w->file, "Header", w->err);
  if (g < 0) return -1;
  int rc = hdf_put(g, "FormatVersion", H5T_NATIVE_INT, 0, &version, w->err) ||
           hdf_put(g, "Dimension", H5T_NATIVE_INT, 0, &p->dimension, w->err) ||
           hdf_put(g, "Time", H5T_NATIVE_DOUBLE, 0, &p->time, w->err) ||
           hdf_put(g, "NumPart_ThisFile", H5T_NATIVE_INT64, PARTICLE_TYPES, count, w->err) ||
           hdf_put(g, "NumPart_Total", H5T_NATIVE_INT64, PARTICLE_TYPES, count, w->err) ||
           hdf_put(g, "NumFilesPerSnapshot", H5T_NATIVE_INT, 0, &files, w->err) ||
           hdf_put(g, "MassTable", H5T_NATIVE_DOUBLE, PARTICLE_TYPES, masses, w->err) ||
           hdf_put(g, "BoxSize", H5T_NATIVE_DOUBLE, 0, &box, w->err);
  H5Gclose(g);
  return rc ? -1 : 0;
}

/* What pynbody reads: the units of the file, SI, in cgs. */
static int put_units(const Writer *w)
{
  static const PartNumber unit[] = {{"UnitLength_in_cm", 100},
                                    {"UnitMass_in_g", 1000},
                                    {"UnitVelocity_in_cm_per_s", 100},
                                    {"UnitTime_in_s", 1}};
  hid_t g = hdf_group(w->file, "Units", w->err);
  if (g < 0) return -1;
  int rc = 0;
  for (size_t i = 0; i < sizeof unit / sizeof *unit && !rc; i++)
    rc = hdf_put(g, unit[i].name, H5T_NATIVE_DOUBLE, 0, &unit[i].value, w->err);
  H5Gclose(g);
  return rc;
}

/* /Materials/Name and /Materials/Text: MaterialID is the index into both. */
int snap_put_materials(int64_t file, const Parts *p, Err *err)
{
  char **name = calloc((size_t)p->materials + 1, sizeof *name);
  char **text = calloc((size_t)p->materials + 1, sizeof *text);
  hid_t g = hdf_group(file, "Materials", err);
  int rc = name && text ? 0 : err_set(err, "out of memory");
  for (int i = 0; i < p->materials && !rc; i++)
    name[i] = p->material[i].name, text[i] = p->material[i].text;
  rc = rc || g < 0 || hdf_put_strings(g, "Name", name, p->materials, err) ||
       hdf_put_strings(g, "Text", text, p->materials, err);
  if (g >= 0) H5Gclose(g);
  free(name);
  free(text);
  return rc ? -1 : 0;
}

static int put_numbers(const Writer *w, const char *group, const PartNumber *x, int n)
{
  if (!n) return 0;
  hid_t g = hdf_group(w->file, group, w->err);
  if (g < 0) return -1;
  int rc = 0;
  for (int i = 0; i < n && !rc; i++)
    rc = hdf_put(g, x[i].name, H5T_NATIVE_DOUBLE, 0, &x[i].value, w->err);
  H5Gclose(g);
  return rc;
}

/* What is written with a dataset. */
typedef struct {
  const char *name, *unit, *meaning;
  double unit_si;
} Label;

static int put_rows(const Writer *w, const Label *l, hid_t type, int rank, const hsize_t *dims,
                    const void *data)
{
  hid_t set = hdf_put_rows(w->particles, l->name, type, rank, dims, data, w->err);
  if (set < 0) return -1;
  int rc = hdf_put_text(set, "unit", l->unit, w->err) ||
           hdf_put(set, "unitSI", H5T_NATIVE_DOUBLE, 0, &l->unit_si, w->err) ||
           hdf_put_text(set, "meaning", l->meaning, w->err);
  H5Dclose(set);
  return rc ? -1 : 0;
}

static int put_field(const Writer *w, const Parts *p, const PartField *f)
{
  const Label label = {f->name, f->unit, f->meaning, 1};
  const hsize_t dims[2] = {(hsize_t)p->n, (hsize_t)f->width};
  return put_rows(w, &label, native(f->kind), f->width > 1 ? 2 : 1, dims, part_array(p, f)) ||
         view_add(w->step, w->particles, f->name, w->err);
}

static int put_flaws(const Writer *w, const Parts *p)
{
  static const Label count = {"FlawCount", "1", "flaws of the particle", 1};
  static const Label threshold = {"FlawThresholds", "1",
                                  "strains at which flaws open, ascending, all of the first "
                                  "particle, then of the second, ...",
                                  1};
  const hsize_t n = (hsize_t)p->n, flaws = (hsize_t)p->flaws;
  return put_rows(w, &count, H5T_NATIVE_INT32, 1, &n, p->nflaw) ||
         view_add(w->step, w->particles, count.name, w->err) ||
         put_rows(w, &threshold, H5T_NATIVE_DOUBLE, 1, &flaws, p->flaw);
}

static int put_extra(const Writer *w, const Parts *p, const PartExtra *x)
{
  const Label label = {x->name, x->unit, x->meaning, x->unit_si};
  hsize_t dims[4] = {(hsize_t)p->n};
  for (int k = 1; k < x->rank; k++) dims[k] = (hsize_t)x->dim[k - 1];
  return put_rows(w, &label, (hid_t)x->type, x->rank, dims, x->data) ||
         view_add(w->step, w->particles, x->name, w->err);
}

static int put_particles(Writer *w, const Parts *p, int checkpoint)
{
  w->particles = hdf_group(w->file, "PartType0", w->err);
  if (w->particles < 0) return -1;
  w->step = view_open(w->file, p->time, w->err);
  int rc = w->step < 0;
  for (const PartField *f = part_fields; f < part_fields + part_field_count && !rc; f++)
    if (part_array(p, f) && (checkpoint || !f->checkpoint)) rc = put_field(w, p, f);
  if (p->nflaw && !rc) rc = put_flaws(w, p);
  for (int k = 0; k < p->extras && !rc; k++) rc = put_extra(w, p, p->extra + k);
  if (w->step >= 0) H5Gclose(w->step);
  H5Gclose(w->particles);
  return rc ? -1 : 0;
}

static int put_all(Writer *w, const Parts *p, int checkpoint)
{
  return put_header(w, p) || put_units(w) || snap_put_materials(w->file, p, w->err) ||
                 hdf_put_strings(w->file, "History", p->history, p->histories, w->err) ||
                 hdf_put_strings(w->file, "Parameters", p->parameter, p->parameters, w->err) ||
                 put_numbers(w, "Collision", p->collision, p->collisions) ||
                 put_numbers(w, "Body", p->body_info, p->body_infos) ||
                 put_numbers(w, "Run", p->run, p->runs) || pointmass_put(w->file, p, w->err) ||
                 put_particles(w, p, checkpoint)
             ? -1
             : 0;
}

static const char *shown(const char *path, const char *stream)
{
  return path && strcmp(path, "-") ? path : stream;
}

int snap_write(const Parts *p, const char *path, int checkpoint, Err *err)
{
  Spool s;
  Err inner;
  const char *name = shown(path, "stdout");
  if (p->n < 1) return err_set(err, "cannot write '%s': no particles", name);
  if (part_need(p, "id x", name, err) || spool_out(&s, path, 1, err)) return -1;
  Writer w = {.file = hdf_create(s.path, &inner), .err = &inner};
  spool_opened(&s);
  int rc = w.file < 0 ? -1 : put_all(&w, p, checkpoint);
  if (w.file >= 0 && hdf_close(w.file, rc ? NULL : &inner)) rc = -1;
  if (!rc) return spool_commit(&s, err);
  spool_abort(&s);
  return err_set(err, "cannot write '%s': %s", name, inner.text);
}

/* ---- reading ---- */

static int get_header(hid_t file, Parts *p, Err *err)
{
  int version = 0;
  int64_t count[64] = {0};
  if (!hdf_has(file, "Header")) return err_set(err, "no snapshot: lacks group 'Header'");
  hid_t g = H5Gopen2(file, "Header", H5P_DEFAULT);
  if (g < 0) return hdf_fail(err, "'Header'");
  int types = -1, rc = hdf_get(g, "FormatVersion", H5T_NATIVE_INT, 1, &version, err) < 0;
  if (!rc && version > FORMAT_VERSION)
    rc = err_set(err, "format version %d, this program knows up to %d", version, FORMAT_VERSION);
  if (!rc && version < 1) rc = err_set(err, "format version %d does not exist", version);
  rc = rc || hdf_get(g, "Dimension", H5T_NATIVE_INT, 1, &p->dimension, err) < 0 ||
       hdf_get(g, "Time", H5T_NATIVE_DOUBLE, 1, &p->time, err) < 0 ||
       (types = hdf_get(g, "NumPart_ThisFile", H5T_NATIVE_INT64, 64, count, err)) < 0;
  H5Gclose(g);
  if (rc) return -1;
  p->n = (long)count[0];
  if (p->n < 1) return err_set(err, "holds no particles of type 0");
  for (int k = 1; k < types; k++)
    if (count[k]) return err_set(err, "holds particles of type %d, only 0 is known", k);
  return 0;
}

/* Shape as n and row say, in words for the message when not. */
static int check_shape(hid_t set, long n, int rank, const hsize_t *row, Err *err)
{
  hsize_t dims[H5S_MAX_RANK];
  int r = hdf_shape(set, H5S_MAX_RANK, dims), k = 1;
  while (r == rank && k < rank && dims[k] == row[k - 1]) k++;
  if (r != rank || k < rank) {
    if (rank == 1) return err_set(err, "has %d dimensions, must be a list", r);
    return err_set(err, "has not %d columns", (int)row[0]);
  }
  if (dims[0] == (hsize_t)n) return 0;
  return err_set(err, "has %llu rows for %ld particles", (unsigned long long)dims[0], n);
}

/* Whole numbers for whole numbers, real for real; in SI. */
static int check_kind(hid_t set, char kind, Err *err)
{
  double si = 1;
  hid_t type = H5Dget_type(set);
  H5T_class_t class = H5Tget_class(type);
  H5Tclose(type);
  if (class != (kind == 'd' ? H5T_FLOAT : H5T_INTEGER))
    return err_set(err, "does not hold %s numbers", kind == 'd' ? "real" : "whole");
  if (H5Aexists(set, "unitSI") > 0 && hdf_get(set, "unitSI", H5T_NATIVE_DOUBLE, 1, &si, err) < 0)
    return -1;
  return si == 1 ? 0 : err_set(err, "is not in SI units (unitSI is %g)", si);
}

/* Reads a dataset of known kind, n rows of width numbers, into a new array; NULL on error. */
static void *read_array(hid_t particles, const char *name, char kind, long n, int width, Err *err)
{
  Err why;
  const hsize_t row = (hsize_t)width;
  size_t size = (size_t)width * (kind == 'i' ? 4 : 8);
  hid_t set = H5Dopen2(particles, name, H5P_DEFAULT);
  if (set < 0) return hdf_fail(err, "'%s'", name), NULL;
  void *array = NULL;
  int rc = check_shape(set, n, width > 1 ? 2 : 1, &row, &why) || check_kind(set, kind, &why);
  if (!rc && !(array = calloc(n ? (size_t)n : 1, size))) rc = err_set(&why, "out of memory");
  if (!rc) rc = hdf_get_rows(set, native(kind), array, &why);
  H5Dclose(set);
  if (!rc) return array;
  free(array);
  return err_null(err, "field '%s': %s", name, why.text);
}

/* Whether `word` is among the words of a list; NULL holds all. */
static int listed(const char *list, const char *word)
{
  const size_t length = strlen(word);
  for (const char *s = list; s && *s; s += strcspn(s, " ")) {
    s += strspn(s, " ");
    if (strcspn(s, " ") == length && !strncmp(s, word, length)) return 1;
  }
  return !list;
}

static int get_fields(hid_t particles, Parts *p, const char *members, Err *err)
{
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++) {
    if (!listed(members, f->member) || !hdf_has(particles, f->name)) continue;
    void *array = read_array(particles, f->name, f->kind, p->n, f->width, err);
    if (!array) return -1;
    part_set_array(p, f, array);
  }
  return 0;
}

static int get_flaws(hid_t particles, Parts *p, Err *err)
{
  int count = hdf_has(particles, "FlawCount");
  if (count != hdf_has(particles, "FlawThresholds"))
    return err_set(err, "has only one of 'FlawCount' and 'FlawThresholds'");
  if (!count) return 0;
  p->nflaw = read_array(particles, "FlawCount", 'i', p->n, 1, err);
  for (long i = 0; p->nflaw && i < p->n; i++) {
    if (p->nflaw[i] < 0) return err_set(err, "field 'FlawCount': %d in row %ld", p->nflaw[i], i);
    p->flaws += p->nflaw[i];
  }
  if (p->nflaw) p->flaw = read_array(particles, "FlawThresholds", 'd', (long)p->flaws, 1, err);
  return p->flaw ? 0 : -1;
}

/* Fills in what an unknown dataset is. What holds pointers cannot be moved as bytes and is refused.
 */
static int describe(hid_t set, long n, PartExtra *x, Err *err)
{
  hsize_t dims[4];
  x->rank = hdf_shape(set, 4, dims);
  if (x->rank < 1) return err_set(err, "has not 1 to 4 dimensions");
  if (dims[0] != (hsize_t)n)
    return err_set(err, "has %llu rows for %ld particles", (unsigned long long)dims[0], n);
  hid_t type = H5Dget_type(set);
  int pointers = H5Tis_variable_str(type) > 0 || H5Tdetect_class(type, H5T_VLEN) > 0 ||
                 H5Tdetect_class(type, H5T_REFERENCE) > 0;
  x->type = pointers ? -1 : H5Tget_native_type(type, H5T_DIR_DEFAULT);
  H5Tclose(type);
  if (pointers) return err_set(err, "is of variable length or a reference, cannot be carried");
  if (x->type < 0) return hdf_fail(err, "%s", "");
  hsize_t width = 1, most = 1 << 20; /* bytes a row */
  for (int k = 1; k < x->rank; k++) {
    if (!dims[k] || dims[k] > most) return err_set(err, "has empty or too wide rows");
    x->dim[k - 1] = (int)dims[k], width *= dims[k];
  }
  if (width * H5Tget_size((hid_t)x->type) > most) return err_set(err, "has too wide rows");
  x->width = (int)width, x->size = (int)(width * H5Tget_size((hid_t)x->type));
  x->unit_si = 1;
  if (H5Aexists(set, "unitSI") > 0 &&
      hdf_get(set, "unitSI", H5T_NATIVE_DOUBLE, 1, &x->unit_si, err) < 0)
    return -1;
  return hdf_get_text(set, "unit", x->unit, sizeof x->unit, err) ||
         hdf_get_text(set, "meaning", x->meaning, sizeof x->meaning, err);
}

static int get_extra(hid_t set, long n, PartExtra *x, Err *err)
{
  if (describe(set, n, x, err)) return -1;
  x->data = calloc((size_t)n, (size_t)x->size);
  if (!x->data) return err_set(err, "out of memory");
  return hdf_get_rows(set, (hid_t)x->type, x->data, err);
}

typedef struct {
  Parts *p;
  const char *members;
  Err *err;
} Extras;

/* For each link in /PartType0: appends to the unknown fields what the schema does not know and is
 * wanted. */
static herr_t visit(hid_t particles, const char *name, const H5L_info_t *info, void *context)
{
  (void)info;
  Extras *e = context;
  Parts *p = e->p;
  Err why;
  if ((part_field(name) && !strcmp(part_field(name)->name, name)) || !strcmp(name, "FlawCount") ||
      !strcmp(name, "FlawThresholds") || !listed(e->members, name) ||
      (e->members && part_field(name))) /* the word of a list means the schema's */
    return 0;
  PartExtra *grown = realloc(p->extra, ((size_t)p->extras + 1) * sizeof *grown);
  if (!grown) return err_set(e->err, "out of memory");
  p->extra = grown;
  PartExtra *x = memset(grown + p->extras++, 0, sizeof *x);
  x->type = -1;
  if (strlen(name) >= sizeof x->name) return err_set(e->err, "field '%s': name too long", name);
  strcpy(x->name, name);
  hid_t set = H5Dopen2(particles, name, H5P_DEFAULT);
  int rc = set < 0 ? hdf_fail(&why, "%s", "") : get_extra(set, p->n, x, &why);
  if (set >= 0) H5Dclose(set);
  return rc ? err_set(e->err, "field '%s': %s", name, why.text) : 0;
}

static int get_particles(hid_t file, Parts *p, const char *members, Err *err)
{
  if (!hdf_has(file, "PartType0")) return err_set(err, "no snapshot: lacks group 'PartType0'");
  hid_t g = H5Gopen2(file, "PartType0", H5P_DEFAULT);
  if (g < 0) return hdf_fail(err, "'PartType0'");
  Extras e = {p, members, err};
  err_set(err, "cannot list 'PartType0'");
  int rc = get_fields(g, p, members, err);
  if (!rc && !members) rc = get_flaws(g, p, err);
  if (!rc) rc = H5Literate(g, H5_INDEX_NAME, H5_ITER_INC, NULL, visit, &e) < 0;
  H5Gclose(g);
  return rc ? -1 : 0;
}

static void free_strings(char **line, int n)
{
  for (int i = 0; i < n; i++) free(line[i]);
  free(line);
}

/* Appended one by one and not merged: the order is what MaterialID means. */
static int fill_materials(Parts *p, char *const *name, char **text, int n, Err *err)
{
  p->material = calloc((size_t)n + 1, sizeof *p->material);
  if (!p->material) return err_set(err, "out of memory");
  for (int i = 0; i < n; i++) {
    PartMaterial *m = p->material + i;
    if (!*name[i] || strlen(name[i]) >= sizeof m->name)
      return err_set(err, "name of a material is empty or too long: '%s'", name[i]);
    strcpy(m->name, name[i]);
    m->text = text[i], text[i] = NULL;
    p->materials++;
  }
  return 0;
}

int snap_get_materials(int64_t file, Parts *p, Err *err)
{
  char **name = NULL, **text = NULL;
  int names = 0, texts = 0;
  if (!hdf_has(file, "Materials")) return 0;
  hid_t g = H5Gopen2(file, "Materials", H5P_DEFAULT);
  if (g < 0) return hdf_fail(err, "'Materials'");
  int rc = hdf_get_strings(g, "Name", &name, &names, err) ||
           hdf_get_strings(g, "Text", &text, &texts, err);
  if (!rc && names != texts)
    rc = err_set(err, "'Materials' has %d names and %d texts", names, texts);
  rc = rc || fill_materials(p, name, text, names, err);
  H5Gclose(g);
  free_strings(name, names);
  free_strings(text, texts);
  return rc ? -1 : 0;
}

typedef struct {
  Parts *p;
  const char *group;
  Err *err;
} Numbers;

static herr_t visit_number(hid_t obj, const char *name, const H5A_info_t *info, void *context)
{
  (void)info;
  Numbers *x = context;
  double value;
  if (hdf_get(obj, name, H5T_NATIVE_DOUBLE, 1, &value, x->err) < 0) return -1;
  return part_set_number(x->p, x->group, name, value, x->err);
}

/* In the order of writing where the file keeps it, else by name. */
static int get_numbers(hid_t file, const char *group, Parts *p, const char *list, Err *err)
{
  if (!hdf_has(file, group)) return 0;
  hid_t g = H5Gopen2(file, group, H5P_DEFAULT);
  if (g < 0) return hdf_fail(err, "'%s'", group);
  unsigned order = 0;
  hid_t gcpl = H5Gget_create_plist(g);
  H5Pget_attr_creation_order(gcpl, &order);
  H5Pclose(gcpl);
  Numbers x = {p, list, err};
  H5_index_t index = order & H5P_CRT_ORDER_TRACKED ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
  err_set(err, "cannot list '%s'", group);
  int rc = H5Aiterate2(g, index, H5_ITER_INC, NULL, visit_number, &x) < 0 ? -1 : 0;
  H5Gclose(g);
  return rc;
}

static int get_all(hid_t file, Parts *p, const char *members, Err *err)
{
  return get_header(file, p, err) || snap_get_materials(file, p, err) ||
         hdf_get_strings(file, "History", &p->history, &p->histories, err) ||
         hdf_get_strings(file, "Parameters", &p->parameter, &p->parameters, err) ||
         get_numbers(file, "Collision", p, "collision", err) ||
         get_numbers(file, "Body", p, "body", err) || get_numbers(file, "Run", p, "run", err) ||
         pointmass_get(file, p, err) || get_particles(file, p, members, err);
}

Parts *snap_read(const char *path, Err *err) { return snap_read_some(path, NULL, err); }

Parts *snap_read_some(const char *path, const char *members, Err *err)
{
  Err inner = {""};
  char real[4096];
  int temporary;
  if (spool_in(path, real, sizeof real, &temporary, err)) return NULL;
  hid_t file = hdf_open(real, &inner);
  if (temporary) unlink(real);
  Parts *p = file < 0 ? NULL : part_new(0);
  if (file >= 0 && !p) err_set(&inner, "out of memory");
  if (p && get_all(file, p, members, &inner)) part_free(p), p = NULL;
  if (file >= 0) H5Fclose(file);
  return p ? p : err_null(err, "cannot read '%s': %s", shown(path, "stdin"), inner.text);
}

/* ---- series ---- */

static int put_series(hid_t file, const char *dir, const char *const *files, const double *times,
                      int n, Err *err)
{
  char name[32], path[4096];
  for (int k = 0; k < n; k++) {
    snprintf(name, sizeof name, "Step#%d", k);
    if (snprintf(path, sizeof path, "%s/%s", dir, files[k]) >= (int)sizeof path ||
        access(path, R_OK))
      return err_set(err, "'%s': %s", files[k], strerror(errno));
    if (H5Lcreate_external(files[k], "/Step#0", file, name, H5P_DEFAULT, H5P_DEFAULT) < 0)
      return hdf_fail(err, "'%s'", name);
  }
  const hsize_t dims = (hsize_t)n;
  hid_t set = hdf_put_rows(file, "TimeValues", H5T_NATIVE_DOUBLE, 1, &dims, times, err);
  if (set < 0) return -1;
  int rc = hdf_put_text(set, "unit", "s", err);
  H5Dclose(set);
  return rc;
}

/* The TimeValue of a step is that of the group the link leads to; the list of all is for readers
 * that do not follow the links. */
int snap_series(const char *dir, const char *const *files, const double *times, int n, Err *err)
{
  char path[4096];
  Spool s;
  Err inner;
  if (snprintf(path, sizeof path, "%s/run.h5part", dir) >= (int)sizeof path)
    return err_set(err, "path too long: '%s'", dir);
  if (spool_out(&s, path, 1, err)) return -1;
  hid_t file = hdf_create(s.path, &inner);
  spool_opened(&s);
  int rc = file < 0 ? -1 : put_series(file, dir, files, times, n, &inner);
  if (file >= 0 && hdf_close(file, rc ? NULL : &inner)) rc = -1;
  if (!rc) return spool_commit(&s, err);
  spool_abort(&s);
  return err_set(err, "cannot write '%s': %s", path, inner.text);
}
