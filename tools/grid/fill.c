/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One pass for all numbers; another for each field whose numbers name kinds. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "fill.h"
#include "lib/deposit.h"
#include "lib/expr.h"

#define LEAST 1.5 /* a kernel reaches so many cells at least */
#define EXACT 8 /* cells: of smaller kernels masses are kept to rounding, of larger ones to 1e-5 */

/* Expression k of each particle. */
typedef struct {
  float *value;
  int kinds;
} Values;

static int get_values(Values *v, RasterField *f, const Parts *p, const char *text, const char *file,
                      Err *err)
{
  Expr *e = expr_parse(text, err);
  if (!e || expr_bind(e, p, file, err)) return expr_free(e), -1;
  v->value = malloc((size_t)(p->n + 1) * sizeof *v->value), v->kinds = expr_kinds(e);
  if (v->value) expr_eval_float(e, v->value);
  snprintf(f->unit, sizeof f->unit, "%s", expr_unit(e));
  expr_free(e);
  return v->value ? 0 : err_set(err, "out of memory for %ld particles", p->n);
}

static DepositSpot *spots(const Raster *r, const Parts *p, const FillHow *how)
{
  int weigh = how->column || !strcmp(how->method, "mass"), d = p->dimension;
  double least = LEAST * fmax(r->cell[how->axis[0]],
                              fmax(r->cell[how->axis[1]], how->flat ? 0 : r->cell[how->axis[2]]));
  DepositSpot *s = malloc((size_t)(p->n + 1) * sizeof *s);
#pragma omp parallel for schedule(static) if (s)
  for (long i = 0; i < (s ? p->n : 0); i++) {
    double h = how->flat && !how->column ? p->h[i] : fmax(p->h[i], least),
           volume = p->m[i] / p->rho[i];
    for (int a = 0; a < 3; a++)
      s[i].x[a] = (float)(p->x[3 * i + how->axis[a]] - r->lo[how->axis[a]]);
    if (d < 3) s[i].x[2] = 0, h = fmax(h, least);
    s[i].h = (float)h, s[i].amount = (float)(weigh ? p->m[i] : volume);
    s[i].size = (float)fmax(0.55 * pow(volume, 1. / d), 0.5 * r->cell[how->axis[0]]);
  }
  return s;
}

/* Zeroed sums on the raster's cells, then all particles. */
static int deposit(Deposit *d, const Raster *r, const FillHow *how, const Parts *p,
                   const DepositSpot *s, const float *const *value, int fields, int inside,
                   Err *err)
{
  int n[3];
  float cell[3];
  for (int a = 0; a < 3; a++) n[a] = r->n[how->axis[a]], cell[a] = (float)r->cell[how->axis[a]];
  DepositShape shape = p->dimension < 3 ? DEPOSIT_2D : how->column ? DEPOSIT_COLUMN : DEPOSIT_3D;
  if (deposit_new(d, n, cell, shape, fields, inside, err)) return -1;
  d->exact = how->column || !strcmp(how->method, "mass") ? EXACT : 0;
  if (!deposit_add(d, s, value, p->n, err)) return 0;
  deposit_free(d);
  return -1;
}

/* What the cells of a field hold. */
static void finish(float *out, const Deposit *d, int f, const FillHow *how, int kinds, long cells)
{
  int plain = !strcmp(how->method, "sum") && !how->column,
      bare = !how->column && !strcmp(how->method, "interpolate");
  for (long k = 0; k < cells; k++) {
    int lone = bare && d->inside[k] && d->best[k] > 0.6f * d->sum[k],
        seen = bare ? d->sum[k] >= 0.5f || lone : d->sum[k] > 0;
    out[k] = plain ? d->mean[f][k] : !seen ? NAN : kinds ? d->kind[k] : d->mean[f][k] / d->sum[k];
  }
}

static int numbers(Raster *r, const Parts *p, const FillHow *how, const DepositSpot *s,
                   const Values *v, int n, Err *err)
{
  const float **value = calloc((size_t)n + 1, sizeof *value);
  int count = 0, mass = how->column || !strcmp(how->method, "mass");
  long cells = (long)r->n[0] * r->n[1] * r->n[2];
  Deposit d;
  for (int k = 0; k < n && value; k++)
    if (!v[k].kinds) value[count++] = v[k].value;
  int bad = !value ? err_set(err, "out of memory") : 0;
  if (!bad && (count || mass)) {
    bad = deposit(&d, r, how, p, s, value, count, !mass, err);
    for (int k = 0, at = 0; k < n && !bad; k++)
      if (!v[k].kinds) finish(r->field[k].value, &d, at++, how, 0, cells);
    if (!bad && mass) memcpy(r->field[n].value, d.sum, (size_t)cells * sizeof *d.sum);
    if (!bad) deposit_free(&d);
  }
  free(value);
  return bad;
}

static int fill(Raster *r, const Parts *p, const FillHow *how, Values *v, const char *const *text,
                const char *const *name, int n, const char *file, Err *err)
{
  long cells = (long)r->n[0] * r->n[1] * r->n[2];
  for (int k = 0; k < r->fields; k++) {
    RasterField *f = &r->field[k];
    snprintf(f->name, sizeof f->name, "%s",
             k < n         ? name[k]
             : how->column ? "ColumnDensity"
                           : "MassDensity");
    snprintf(f->unit, sizeof f->unit, how->column || p->dimension < 3 ? "kg/m^2" : "kg/m^3");
    if (k < n && get_values(&v[k], f, p, text[k], file, err)) return -1;
    if (!(f->value = malloc((size_t)cells * sizeof *f->value)))
      return err_set(err, "out of memory for %ld cells", cells);
  }
  DepositSpot *s = spots(r, p, how);
  int bad = s ? numbers(r, p, how, s, v, n, err) : err_set(err, "out of memory");
  for (int k = 0; k < n && !bad; k++) {
    Deposit d;
    const float *value[1] = {v[k].value};
    if (!v[k].kinds) continue;
    bad = deposit(&d, r, how, p, s, value, 1, 1, err);
    if (bad) break;
    finish(r->field[k].value, &d, 0, how, 1, cells);
    deposit_free(&d);
  }
  free(s);
  return bad;
}

int fill_raster(Raster *r, const Parts *p, const FillHow *how, const char *const *text,
                const char *const *name, int n, const char *file, Err *err)
{
  Values *v = calloc((size_t)n + 1, sizeof *v);
  r->fields = n + (how->column || !strcmp(how->method, "mass"));
  r->field = calloc((size_t)r->fields + 1, sizeof *r->field);
  int bad =
      v && r->field ? fill(r, p, how, v, text, name, n, file, err) : err_set(err, "out of memory");
  for (int k = 0; k < n && v; k++) free(v[k].value);
  free(v);
  return bad ? -1 : 0;
}
