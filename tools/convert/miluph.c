/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names, shapes and what miluphcuda needs to read: its src/io.cu. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "foreign.h"
#include "lib/hdf.h"
#include "lib/snap.h"
#include "lib/spool.h"
#include "miluph.h"
#include "notes.h"

static const char ANEW[] = "computed anew";

/* clang-format off */
static const ForeignRow TABLE[] = {
  {"x", "x", NULL, 0, 0, 0, 0}, {"v", "v", NULL, 0, 0, 0, 0}, {"m", "m", NULL, 0, 0, 0, 0},
  {"rho", "rho", NULL, 0, 0, 0, 0}, {"e", "u", NULL, 0, 0, 0, 0}, {"sml", "h", NULL, 0, 0, 0, 0},
  {"material_type", "mat", NULL, 0, 0, 0, 0}, {"p", "p", NULL, 0, 0, 0, 0},
  {"soundspeed", "cs", NULL, 0, 0, 0, 0}, {"deviatoric_stress", "s", NULL, 0, 0, 0, 0},
  {"number_of_interactions", "nngb", NULL, 0, 0, 0, 0},
  {"alpha_jutzi", "alpha", NULL, 0, 0, 0, 0}, {"alpha_epspor", "alpha", NULL, 0, 0, 0, 0},
  {"damage_total_porjutzi", "damage", NULL, 0, 0, 0, 0}, {"damage_total", "damage", NULL, 0, 0, 0, 0},
  {"number_of_activated_flaws", "nact", NULL, 0, 0, 0, 0},
  {"total_plastic_strain", "strain", NULL, 0, 0, 0, 0}, {"ep", "strain", NULL, 0, 0, 0, 0},
  {"T", "T", NULL, 0, 0, 0, 0}, {"aneos_T", "T", NULL, 0, 0, 0, 0}, {"p_max", "pmax", NULL, 0, 0, 0, 0},
  {"aneos_entropy", "+Entropy", "J/K/kg", 0, 0, 0, 0}, {"aneos_phase_flag", "+PhaseFlag", "1", 0, 0, 0, 0},
  {"time", NULL, NULL, 0, 0, 0, 0}, {"activation_thresholds", NULL, NULL, 0, 0, 0, 0},
  {"maximum_number_of_flaws", NULL, NULL, 0, 0, 0, 0},
  {"DIM_root_of_damage_tensile", NULL, NULL, 0, 0, 0, 0},
  {"DIM_root_of_damage_porjutzi", NULL, NULL, 0, 0, 0, 0},
  {"a", NULL, ANEW, 0, 0, 0, 0}, {"a_grav", NULL, ANEW, 0, 0, 0, 0}, {"drhodt", NULL, ANEW, 0, 0, 0, 0},
  {"dedt", NULL, ANEW, 0, 0, 0, 0}, {"dalphadt", NULL, ANEW, 0, 0, 0, 0}, {"dddt", NULL, ANEW, 0, 0, 0, 0},
  {"ddamage_porjutzidt", NULL, ANEW, 0, 0, 0, 0}, {"deviatoric_stress_dt", NULL, ANEW, 0, 0, 0, 0},
  {"ddeviatoric_stress_dt", NULL, ANEW, 0, 0, 0, 0}, {"local_strain", NULL, ANEW, 0, 0, 0, 0},
  {"aneos_cs", NULL, ANEW, 0, 0, 0, 0}, {"viscous_shear_stress", NULL, ANEW, 0, 0, 0, 0},
  {"tree_depth", NULL, "of its tree", 0, 0, 0, 0},
  {"sml_initial", NULL, "h has no reference here", 0, 0, 0, 0},
  {"v_accreted", NULL, "of its sinks", 0, 0, 0, 0},
  {"epsilon_v", NULL, "follows from the density here", 0, 0, 0, 0}};
/* clang-format on */

enum { ROWS = sizeof TABLE / sizeof *TABLE };

double miluph_root(double damage, int dimension) { return pow(damage, 1.0 / dimension); }
double miluph_damage(double root, int dimension) { return pow(root, dimension); }

int miluph_is(hid_t file)
{
  return hdf_has(file, "x") > 0 && hdf_has(file, "v") > 0 && hdf_has(file, "m") > 0 &&
         hdf_has(file, "material_type") > 0;
}

/* ---- reading ---- */

int miluph_flaws(Parts *p, const double *threshold, int most, Err *err)
{
  p->nflaw = calloc((size_t)p->n + 1, sizeof *p->nflaw);
  p->flaw = calloc((size_t)p->n * (size_t)most + 1, sizeof *p->flaw);
  if (!p->nflaw || !p->flaw) return err_set(err, "out of memory");
  for (long i = 0; i < p->n; i++) {
    double *mine = p->flaw + p->flaws;
    int count = 0;
    for (const double *t = threshold + i * most; t < threshold + (i + 1) * most; t++) {
      if (!(*t > 0)) continue;
      int k = count++; /* ascending */
      for (; k > 0 && mine[k - 1] > *t; k--) mine[k] = mine[k - 1];
      mine[k] = *t;
    }
    p->nflaw[i] = count, p->flaws += count;
  }
  return 0;
}

static int read_flaws(hid_t file, Parts *p, Err *err)
{
  int most;
  double *threshold = foreign_numbers(file, "activation_thresholds", p->n, &most, err);
  int rc = threshold ? miluph_flaws(p, threshold, most, err) : *err->text ? -1 : 0;
  free(threshold);
  return rc;
}

/* Without a total, D = min(1, D_t + D_p). */
static int read_damage(hid_t file, Parts *p, Err *err)
{
  static const char *const PART[] = {"DIM_root_of_damage_tensile", "DIM_root_of_damage_porjutzi"};
  if (p->damage) return 0;
  for (int k = 0; k < 2; k++) {
    int width;
    double *root = foreign_numbers(file, PART[k], p->n, &width, err);
    if (!root && *err->text) return -1;
    if (!root) continue;
    if (part_add(p, "damage", err)) {
      free(root);
      return -1;
    }
    for (long i = 0; i < p->n; i++)
      p->damage[i] = fmin(1, p->damage[i] + miluph_damage(root[i * width], p->dimension));
    free(root);
  }
  return 0;
}

/* Its names, and behind them the schema's: what miluph_write puts beside them. */
static int read_fields(hid_t file, Parts *p, Err *err)
{
  static const ForeignUnits SI = {1, 1, 1, 1};
  ForeignRow *table = malloc(sizeof TABLE + (size_t)part_field_count * sizeof *table);
  if (!table) return err_set(err, "out of memory");
  memcpy(table, TABLE, sizeof TABLE);
  for (int k = 0; k < part_field_count; k++)
    table[ROWS + k] = (ForeignRow){part_fields[k].name, part_fields[k].member, NULL, 0, 0, 0, 0};
  int rc = foreign_read(file, table, ROWS + part_field_count, &SI, p, err);
  free(table);
  return rc;
}

Parts *miluph_read(hid_t file, Err *err)
{
  int dimension, width;
  long n = foreign_rows(file, "x", &dimension, err);
  if (n < 1) return n < 0 ? NULL : err_null(err, "holds no particles");
  if (dimension > 3) return err_null(err, "'x' has %d columns", dimension);
  Parts *p = part_new(n);
  if (!p) return err_null(err, "out of memory");
  p->dimension = dimension;
  double *time = foreign_numbers(file, "time", 1, &width, err);
  if (time) p->time = *time;
  int rc = (!time && *err->text) || read_fields(file, p, err) || snap_get_materials(file, p, err) ||
           read_flaws(file, p, err) || read_damage(file, p, err);
  free(time);
  if (!rc) return p;
  part_free(p);
  return NULL;
}

/* ---- writing ---- */

typedef struct {
  const Parts *p;
  hid_t file;
  Err *err;
} Out;

static int put(const Out *o, const char *name, hid_t type, long rows, int width, const void *data)
{
  const hsize_t dims[2] = {(hsize_t)rows, (hsize_t)width};
  hid_t set = hdf_put_rows(o->file, name, type, width > 1 ? 2 : 1, dims, data, o->err);
  if (set < 0) return -1;
  H5Dclose(set);
  return 0;
}

/* A list of doubles, of zeros without a source. */
static int put_list(const Out *o, const char *name, const double *from)
{
  double *none = from ? NULL : calloc((size_t)o->p->n + 1, sizeof *none);
  if (!from && !none) return err_set(o->err, "out of memory");
  int rc = put(o, name, H5T_NATIVE_DOUBLE, o->p->n, 1, from ? from : none);
  free(none);
  return rc;
}

static int put_vector(const Out *o, const char *name, const double *from)
{
  const int d = o->p->dimension;
  double *to = malloc((size_t)o->p->n * (size_t)d * sizeof *to + 1);
  if (!to) return err_set(o->err, "out of memory");
  for (long i = 0; i < o->p->n; i++) memcpy(to + i * d, from + i * 3, (size_t)d * sizeof *to);
  int rc = put(o, name, H5T_NATIVE_DOUBLE, o->p->n, d, to);
  free(to);
  return rc;
}

static int put_stress(const Out *o)
{
  const Parts *p = o->p;
  const int d = p->dimension;
  double *to = calloc((size_t)p->n * (size_t)(d * d) + 1, sizeof *to);
  if (!to) return err_set(o->err, "out of memory");
  for (long i = 0; p->s && i < p->n; i++) foreign_full(p->s + i * 6, d, to + i * d * d);
  int rc = put(o, "deviatoric_stress", H5T_NATIVE_DOUBLE, p->n, d * d, to);
  free(to);
  return rc;
}

static int put_flaws(const Out *o)
{
  const Parts *p = o->p;
  int most = 0;
  for (long i = 0; p->nflaw && i < p->n; i++) most = p->nflaw[i] > most ? p->nflaw[i] : most;
  if (put(o, "maximum_number_of_flaws", H5T_NATIVE_INT32, 1, 1, &most)) return -1;
  if (!most) return 0;
  double *row = malloc((size_t)p->n * (size_t)most * sizeof *row);
  if (!row) return err_set(o->err, "out of memory");
  const double *flaw = p->flaw;
  for (long i = 0; i < p->n; i++)
    for (int k = 0; k < most; k++) row[i * most + k] = k < p->nflaw[i] ? *flaw++ : -1;
  int rc = put(o, "activation_thresholds", H5T_NATIVE_DOUBLE, p->n, most, row);
  free(row);
  return rc;
}

static int put_damage(const Out *o)
{
  const Parts *p = o->p;
  double *root = calloc((size_t)p->n + 1, sizeof *root);
  if (!root) return err_set(o->err, "out of memory");
  for (long i = 0; p->damage && i < p->n; i++) root[i] = miluph_root(p->damage[i], p->dimension);
  int rc = put_list(o, "DIM_root_of_damage_tensile", root) ||
           put_list(o, "DIM_root_of_damage_porjutzi", NULL) ||
           put_list(o, "damage_total", p->damage);
  free(root);
  return rc ? -1 : 0;
}

static int put_whole(const Out *o, const char *name, const int32_t *from)
{
  int32_t *none = from ? NULL : calloc((size_t)o->p->n + 1, sizeof *none);
  if (!from && !none) return err_set(o->err, "out of memory");
  int rc = put(o, name, H5T_NATIVE_INT32, o->p->n, 1, from ? from : none);
  free(none);
  return rc;
}

/* What it reads in every build, then what it reads with FRAGMENTATION, porosity and
 * JC_PLASTICITY. */
static int put_theirs(const Out *o)
{
  const Parts *p = o->p;
  return put(o, "time", H5T_NATIVE_DOUBLE, 1, 1, &p->time) || put_vector(o, "x", p->x) ||
         put_vector(o, "v", p->v) || put_list(o, "m", p->m) || put_list(o, "rho", p->rho) ||
         put_list(o, "e", p->u) || put_list(o, "sml", p->h) || put_list(o, "sml_initial", p->h) ||
         put_whole(o, "material_type", p->mat) || put_list(o, "p", p->p) || put_stress(o) ||
         (p->strain && put_list(o, "total_plastic_strain", p->strain)) ||
         ((p->damage || p->nflaw) &&
          (put_damage(o) || put_flaws(o) || put_whole(o, "number_of_activated_flaws", p->nact))) ||
         (p->alpha && put_list(o, "alpha_jutzi", p->alpha)) ||
         (p->T && (put_list(o, "ep", p->strain) || put_list(o, "T", p->T)));
}

static int put_ours(const Out *o)
{
  static const char WRITTEN[] = " x v m rho u h mat p s damage alpha nact strain T ";
  NotesList kept = {"", 0};
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++) {
    char word[80];
    snprintf(word, sizeof word, " %s ", f->member);
    if (f->checkpoint || !part_array(o->p, f) || strstr(WRITTEN, word)) continue;
    hid_t type = f->kind == 'd'   ? H5T_NATIVE_DOUBLE
                 : f->kind == 'l' ? H5T_NATIVE_INT64
                                  : H5T_NATIVE_INT32;
    if (put(o, f->name, type, o->p->n, f->width, part_array(o->p, f))) return -1;
    notes_add(&kept, f->name);
  }
  notes_end(&kept, "kept, but not read by miluphcuda");
  return snap_put_materials(o->file, o->p, o->err);
}

static void say(const Parts *p)
{
  NotesList lost = {"", 0};
  for (int k = 0; k < p->materials; k++)
    notes_say("material_type %d is %s: material.cfg must have it with this ID", k,
              p->material[k].name);
  for (int k = 0; k < p->extras; k++) notes_add(&lost, p->extra[k].name);
  if (p->histories) notes_add(&lost, "History");
  if (p->parameters) notes_add(&lost, "Parameters");
  if (p->collisions) notes_add(&lost, "Collision");
  if (p->body_infos) notes_add(&lost, "Body");
  notes_end(&lost, "not carried over");
  if (p->alpha && p->damage)
    notes_say("all damage is written as tensile, none as that of pores (they are not kept apart)");
}

int miluph_write(const Parts *p, const char *path, Err *err)
{
  Spool s;
  Err why;
  if (part_need(p, "x v m rho u h mat", "input", err) || spool_out(&s, path, 1, err)) return -1;
  Out o = {p, hdf_create(s.path, &why), &why};
  spool_opened(&s);
  int rc = o.file < 0 || put_theirs(&o) || put_ours(&o);
  if (o.file >= 0 && hdf_close(o.file, rc ? NULL : &why)) rc = -1;
  say(p);
  if (!rc) return spool_commit(&s, err);
  spool_abort(&s);
  return err_set(err, "cannot write '%s': %s", path, why.text);
}
