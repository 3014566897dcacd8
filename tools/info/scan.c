/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <hdf5.h>
#include <libconfig.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scan.h"

/* ---- fields ---- */

static void measure_reals(ScanField *f, const double *x, long n)
{
  double least = INFINITY, greatest = -INFINITY, sum = 0;
  long bad = 0;
  for (long i = 0; i < n; i++) {
    if (!isfinite(x[i])) {
      bad++;
      continue;
    }
    least = fmin(least, x[i]), greatest = fmax(greatest, x[i]), sum += x[i];
  }
  f->bad = bad;
  f->least = bad < n ? least : NAN, f->greatest = bad < n ? greatest : NAN;
  f->mean = bad < n ? sum / (double)(n - bad) : NAN;
}

/* Rows of any HDF5 numbers, through doubles; -1 without memory. */
static int measure(ScanField *f, const void *data, hid_t type, long n)
{
  size_t size = H5Tget_size(type), room = size > sizeof(double) ? size : sizeof(double);
  H5T_class_t class = H5Tget_class(type);
  f->least = f->mean = f->greatest = NAN;
  if (class != H5T_INTEGER && class != H5T_FLOAT) {
    snprintf(f->type, sizeof f->type, "%s", class == H5T_STRING ? "string" : "other");
    return 0;
  }
  int sign = class == H5T_FLOAT || H5Tget_sign(type) == H5T_SGN_2;
  snprintf(f->type, sizeof f->type, "%s%s%d", sign ? "" : "u", class == H5T_FLOAT ? "float" : "int",
           (int)size * 8);
  if (H5Tequal(type, H5T_NATIVE_DOUBLE) > 0) return measure_reals(f, data, n), 0;
  double *x = malloc((size_t)n * room + 1);
  if (!x) return -1;
  memcpy(x, data, (size_t)n * size);
  int rc = H5Tconvert(type, H5T_NATIVE_DOUBLE, (size_t)n, x, NULL, H5P_DEFAULT) < 0 ? -1 : 0;
  if (!rc) measure_reals(f, x, n);
  free(x);
  return rc;
}

static void name_shape(ScanField *f, long n, int width)
{
  if (width > 1)
    snprintf(f->shape, sizeof f->shape, "%ld x %d", n, width);
  else
    snprintf(f->shape, sizeof f->shape, "%ld", n);
}

static int add(ScanField *f, const char *name, const char *unit, const char *meaning,
               const void *data, hid_t type, long n, int width)
{
  f->name = name, f->unit = unit, f->meaning = meaning;
  name_shape(f, n, width);
  return measure(f, data, type, n * width);
}

ScanField *scan_fields(const Parts *p, int *n)
{
  ScanField *list = calloc((size_t)part_field_count + (size_t)p->extras + 2, sizeof *list);
  int rc = list ? 0 : -1;
  *n = 0;
  for (const PartField *f = part_fields; f < part_fields + part_field_count && !rc; f++) {
    hid_t type = f->kind == 'd'   ? H5T_NATIVE_DOUBLE
                 : f->kind == 'l' ? H5T_NATIVE_INT64
                                  : H5T_NATIVE_INT32;
    if (part_array(p, f))
      rc = add(list + (*n)++, f->name, f->unit, f->meaning, part_array(p, f), type, p->n, f->width);
  }
  if (p->nflaw && !rc)
    rc = add(list + (*n)++, "FlawCount", "1", "flaws of the particle", p->nflaw, H5T_NATIVE_INT32,
             p->n, 1) ||
         add(list + (*n)++, "FlawThresholds", "1", "strains at which flaws open", p->flaw,
             H5T_NATIVE_DOUBLE, (long)p->flaws, 1);
  for (const PartExtra *x = p->extra; x < p->extra + p->extras && !rc; x++)
    rc = add(list + (*n)++, x->name, x->unit, x->meaning, x->data, (hid_t)x->type, p->n, x->width);
  if (!rc) return list;
  free(list);
  return NULL;
}

/* ---- groups ---- */

static ScanGroup *find(ScanGroup **list, int *n, int32_t id)
{
  int k = 0;
  while (k < *n && (*list)[k].id < id) k++;
  if (k < *n && (*list)[k].id == id) return *list + k;
  ScanGroup *grown = realloc(*list, ((size_t)*n + 1) * sizeof *grown);
  if (!grown) return NULL;
  *list = grown;
  memmove(grown + k + 1, grown + k, (size_t)((*n)++ - k) * sizeof *grown);
  grown[k] = (ScanGroup){.id = id};
  return grown + k;
}

static double distance(const double a[3], const double b[3])
{
  return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

ScanGroup *scan_groups(const Parts *p, const int32_t *key, int *n)
{
  ScanGroup *list = NULL, *g = NULL;
  *n = 0;
  for (long i = 0; i < p->n; i++) {
    int32_t id = key ? key[i] : 0;
    double m = p->m ? p->m[i] : 1;
    if ((!g || g->id != id) && !(g = find(&list, n, id))) return free(list), NULL;
    g->n++, g->mass += m;
    for (int k = 0; k < 3; k++) {
      g->x[k] += m * p->x[3 * i + k];
      if (p->v) g->v[k] += m * p->v[3 * i + k];
    }
  }
  for (g = list; g < list + *n; g++)
    for (int k = 0; k < 3; k++) g->x[k] /= g->mass, g->v[k] /= g->mass;
  g = list;
  for (long i = 0; i < p->n; i++) {
    if (key && g->id != key[i]) g = find(&list, n, key[i]);
    g->reach = fmax(g->reach, distance(p->x + 3 * i, g->x));
  }
  return list;
}

void scan_form(const char *text, const char *group, char *form, int size)
{
  char path[64];
  const char *word = NULL;
  config_t cfg;
  snprintf(path, sizeof path, "%s.form", group);
  config_init(&cfg);
  int found = config_read_string(&cfg, text) && config_lookup_string(&cfg, path, &word);
  snprintf(form, (size_t)size, "%s", found ? word : "-");
  config_destroy(&cfg);
}
