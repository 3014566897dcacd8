/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A table in memory: room, checks, and the law made from it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "slope.h"
#include "table.h"

const char *const table_names[] = {
#define TABLE_NAME(CAPITAL, NAME, ...) #NAME,
    TABLE_FIELDS(TABLE_NAME)
#undef TABLE_NAME
};

int table_new(Table *t, int nrho, int ny, int heat, Err *err)
{
  size_t n = (size_t)nrho * (size_t)ny;
  int bad;
  memset(t, 0, sizeof *t);
  t->nrho = nrho, t->ny = ny, t->heat = heat;
  t->rho = calloc((size_t)nrho, sizeof *t->rho);
  t->y = calloc((size_t)ny, sizeof *t->y);
  bad = !t->rho || !t->y;
  for (int k = 0; k < TABLE_FIELD_COUNT; k++) {
    if (k == (heat ? TABLE_T : TABLE_U)) continue;
    bad |= !(t->field[k] = calloc(n, sizeof *t->field[k]));
  }
  if (!bad) return 0;
  table_free(t);
  return err_set(err, "no memory for a table of %d x %d nodes", nrho, ny);
}

void table_free(Table *t)
{
  free(t->rho), free(t->y), free(t->row);
  for (int k = 0; k < TABLE_FIELD_COUNT; k++) free(t->field[k]);
  memset(t, 0, sizeof *t);
}

/* ---- checks ---- */

/* Where node (i, j) stands: "file:line", or "file: node (i, j)". */
static const char *where(const Table *t, const char *label, int i, int j, char *buf, size_t size)
{
  if (t->row)
    snprintf(buf, size, "%s:%ld", label, t->row[(size_t)i * (size_t)t->ny + (size_t)j]);
  else
    snprintf(buf, size, "%s: node (%d, %d)", label, i, j);
  return buf;
}

static int check_axis(const double *x, int n, const char *name, const char *label, Err *err)
{
  if (n < 4) return err_set(err, "%s: %d %s, at least 4 are wanted", label, n, name);
  for (int k = 0; k < n; k++) {
    int twice = k > 0 && x[k] == x[k - 1];
    if (!isfinite(x[k])) return err_set(err, "%s: %s %d is not finite", label, name, k + 1);
    if (k > 0 && x[k] < x[k - 1])
      return err_set(err, "%s: %s must ascend: number %d is %g after %g", label, name, k + 1, x[k],
                     x[k - 1]);
    if (twice && (k == 1 || k == n - 1 || x[k - 2] == x[k]))
      return err_set(err, "%s: %s: %g stands %s", label, name, x[k],
                     k == 1 || k == n - 1 ? "twice at the end" : "three times");
  }
  return 0;
}

/* The other of u and T must rise with y; noise is raised and counted. */
static int check_rise(Table *t, int k, const char *label, Err *err)
{
  char at[4200];
  for (int i = 0; i < t->nrho && t->field[k]; i++) {
    double *f = t->field[k] + (size_t)i * (size_t)t->ny;
    for (int j = 1; j < t->ny; j++) {
      if (f[j] >= f[j - 1]) continue;
      if (f[j - 1] - f[j] > 1e-3 * fabs(f[j - 1]))
        return err_set(err, "%s: %s falls from %g to %g where %s rises from %g to %g",
                       where(t, label, i, j, at, sizeof at), table_names[k], f[j - 1], f[j],
                       t->heat ? "T" : "u", t->y[j - 1], t->y[j]);
      f[j] = f[j - 1], t->repaired++;
    }
  }
  return 0;
}

int table_check(Table *t, const char *label, Err *err)
{
  char at[4200];
  if (check_axis(t->rho, t->nrho, "densities", label, err) ||
      check_axis(t->y, t->ny, t->heat ? "temperatures" : "energies", label, err))
    return -1;
  if (t->rho[0] < 0) return err_set(err, "%s: density %g is below 0", label, t->rho[0]);
  if (t->heat && t->y[0] < 0) return err_set(err, "%s: temperature %g is below 0", label, t->y[0]);
  for (int i = 0; i < t->nrho; i++)
    for (int j = 0; j < t->ny; j++)
      for (int k = 0; k < TABLE_FIELD_COUNT; k++) {
        double f = t->field[k] ? t->field[k][(size_t)i * (size_t)t->ny + (size_t)j] : 0;
        if (isfinite(f) && (f >= 0 || (k != TABLE_C && k != TABLE_T))) continue;
        return err_set(err, "%s: %s is %g", where(t, label, i, j, at, sizeof at), table_names[k],
                       f);
      }
  return check_rise(t, t->heat ? TABLE_U : TABLE_T, label, err);
}

/* ---- the law ---- */

/* Value and slopes of a field at the nodes; NAN when it is absent. */
static int fill(double *out, const Table *t, int k, const Slope *x, const Slope *y, Err *err)
{
  size_t n = (size_t)t->nrho * (size_t)t->ny;
  double *plane = malloc(n * 4 * sizeof *plane); /* value, rho, y, mixed: one after another */
  if (!plane) return err_set(err, "no memory for a table of %d x %d nodes", t->nrho, t->ny);
  for (size_t i = 0; i < n; i++) plane[i] = t->field[k] ? t->field[k][i] : NAN;
  for (int j = 0; j < t->ny; j++) slope_line(x, plane + j, plane + n + j, t->ny);
  for (int i = 0; i < t->nrho; i++)
    slope_line(y, plane + (size_t)(i * t->ny), plane + 2 * n + (size_t)(i * t->ny), 1);
  for (int j = 0; j < t->ny; j++) slope_line(x, plane + 2 * n + j, plane + 3 * n + j, t->ny);
  for (size_t i = 0; i < n; i++)
    for (size_t d = 0; d < 4; d++) out[4 * i + d] = plane[d * n + i];
  free(plane);
  return 0;
}

static int fill_all(const struct eos_table *e, double *data, const Table *t, Err *err)
{
  static const int part[][2] = {{EOS_TABLE_P, TABLE_P},
                                {EOS_TABLE_U, TABLE_U},
                                {EOS_TABLE_S, TABLE_S},
                                {EOS_TABLE_T, TABLE_T}};
  size_t n = (size_t)t->nrho * (size_t)t->ny;
  Slope *x = slope_new(t->rho, t->nrho, err), *y = slope_new(t->y, t->ny, err);
  double *c = data + eos_table_start(e, EOS_TABLE_C),
         *phase = data + eos_table_start(e, EOS_TABLE_PHASE);
  int bad = !x || !y;
  memcpy(data, t->rho, (size_t)t->nrho * sizeof *data);
  memcpy(data + t->nrho, t->y, (size_t)t->ny * sizeof *data);
  for (int k = 0; k < 4 && !bad; k++)
    if (part[k][1] != (t->heat ? TABLE_T : TABLE_U))
      bad = fill(data + eos_table_start(e, part[k][0]), t, part[k][1], x, y, err);
  for (size_t i = 0; i < n; i++) {
    c[i] = t->field[TABLE_C] ? t->field[TABLE_C][i] : 0;
    phase[i] = t->field[TABLE_PHASE] ? t->field[TABLE_PHASE][i] : 0;
  }
  slope_free(x), slope_free(y);
  return bad ? -1 : 0;
}

/* The density of a condensed material at rest: where p at u = 0 (or the lowest u) falls to 0, or,
 * in tables without tension, to 1 bar; 0 for a gas, which is as stiff as its pressure. */
static double rest(const struct eos_table *e)
{
  const double bar = 1e5, *rho = e->data;
  double low, high, level = bar, c;
  int last = e->nrho - 1, i = last, k;
  while (i > 0 && eos_table(e, rho[i], 0, 0).p > bar) i--;
  if (i == 0 || i == last) return 0;
  for (k = i; k > 0 && rho[k] > 0.5 * rho[i] && eos_table(e, rho[k], 0, 0).p > 0;) k--;
  if (eos_table(e, rho[k], 0, 0).p <= 0) level = 0, i = k;
  low = rho[i], high = rho[i + 1];
  for (k = 0; k < 200; k++) {
    double middle = 0.5 * (low + high);
    if (eos_table(e, middle, 0, 0).p > level)
      high = middle;
    else
      low = middle;
  }
  c = eos_table(e, high, 0, 0).cs;
  return level > 0 && high * c * c < 1e3 * bar ? 0 : high;
}

int table_law(struct eos_table *e, const Table *t, Err *err)
{
  double *data;
  e->nrho = t->nrho, e->ny = t->ny, e->heat = t->heat, e->data = NULL;
  if (!(data = malloc(eos_table_start(e, EOS_TABLE_PARTS) * sizeof *data)))
    return err_set(err, "no memory for a table of %d x %d nodes", t->nrho, t->ny);
  if (fill_all(e, data, t, err)) return free(data), -1;
  e->data = data;
  if (!(e->rho0 > 0)) e->rho0 = rest(e);
  e->bulk = e->rho0 > 0 ? e->rho0 * pow(eos_table(e, e->rho0, 0, 0).cs, 2) : 0;
  if (!(e->c_min > 0) && e->rho0 > 0) e->c_min = EOS_FLOOR * sqrt(e->bulk / e->rho0);
  return 0;
}

void table_law_free(struct eos_table *e)
{
  free((void *)e->data);
  e->data = NULL;
}

double table_heat(const struct eos_table *e)
{
  double rho = e->rho0 > 0 ? e->rho0 : e->data[e->nrho / 2], t[2], u[2], heat;
  const double *y = eos_table_part(e, EOS_TABLE_Y);
  for (int k = 0; k < 2; k++) {
    double end = y[k ? e->ny - 1 : 0];
    t[k] = e->heat ? end : eos_table_state(e, rho, EOS_TABLE_U, end).T;
  }
  t[0] = fmax(t[0], fmin(300, 0.9 * t[1])), t[1] = fmin(1.01 * t[0], t[1]);
  for (int k = 0; k < 2; k++) u[k] = eos_table_state(e, rho, EOS_TABLE_T, t[k]).u;
  heat = (u[1] - u[0]) / (t[1] - t[0]);
  return heat > 0 && isfinite(heat) ? heat : 0;
}
