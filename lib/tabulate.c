/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Isentropes are labelled by l = ln of their energy on the line of reference and lie STEP apart in
 * it; each is followed through all densities once. On a line of constant density u is then a smooth
 * function of l, and so is s. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_spline.h>
#include "tabulate.h"

static const double STEP = 0.1;  /* of l */
enum { SPARE = 4, MOST = 4000 }; /* isentropes beyond the range; at most in all */

/* All isentropes at all densities, and the cold one, which begins with u = 0. */
typedef struct {
  const Eos *eos;
  const TabulateGrid *grid;
  double cv, reference;
  double *cold;  /* [nrho] */
  int n;         /* isentropes */
  double *label; /* [n] ascending */
  double *u;     /* [n][nrho] */
} Fan;

/* The isentrope of energy u on the line of reference into out [nrho]; -1 where the law is not
 * defined. */
static int isentrope(const Fan *f, double u, double *out)
{
  const double *rho = f->grid->rho;
  double start = u, at = f->reference;
  int n = f->grid->nrho, middle = 0;
  while (middle < n && rho[middle] < f->reference) middle++;
  for (int i = middle; i < n; at = rho[i++]) out[i] = u = thermal_isentrope(f->eos, at, u, rho[i]);
  u = start, at = f->reference;
  for (int i = middle - 1; i >= 0; i--) {
    if (rho[i] > 0) u = thermal_isentrope(f->eos, at, u, rho[i]), at = rho[i];
    out[i] = u;
  }
  return isnan(out[0]) || isnan(out[n - 1]) ? -1 : 0;
}

/* Whether an isentrope lies above all nodes of the grid. */
static int above(const Fan *f, const double *u)
{
  const TabulateGrid *g = f->grid;
  double top = g->y[g->ny - 1];
  for (int i = 0; i < g->nrho; i++)
    if (u[i] < (g->heat ? f->cold[i] + f->cv * top : top)) return 0;
  return 1;
}

/* From 1 K on the line of reference until SPARE are above the grid. */
static int fan_fill(Fan *f, Err *err)
{
  size_t row = (size_t)f->grid->nrho;
  if (!(f->cold = malloc(row * sizeof *f->cold)) || !(f->label = malloc(MOST * sizeof *f->label)))
    return err_set(err, "no memory for %zu densities", row);
  for (size_t i = 0; i < row; i++)
    f->cold[i] = f->grid->rho[i] > 0 ? thermal_cold(f->eos, f->grid->rho[i]) : 0;
  for (int spare = 0; spare < SPARE; f->n++) {
    double *more = f->n < MOST ? realloc(f->u, (size_t)(f->n + 1) * row * sizeof *more) : NULL;
    if (!more) return err_set(err, "no isentropes reach the end of the grid at all densities");
    f->u = more, more += (size_t)f->n * row;
    f->label[f->n] = log(f->cv) + f->n * STEP;
    if (isentrope(f, exp(f->label[f->n]), more))
      return err_set(err, "the isentrope from %g K at %g kg/m^3 leaves the law",
                     exp(f->label[f->n]) / f->cv, f->reference);
    spare += above(f, more);
  }
  return 0;
}

/* Where the rising curve of u over the label takes a value; its ends when it is beyond them. */
static double label_of(const gsl_spline *curve, gsl_interp_accel *at, const Fan *f, double u)
{
  double low = f->label[0], high = f->label[f->n - 1];
  if (gsl_spline_eval(curve, low, at) >= u) return low;
  if (gsl_spline_eval(curve, high, at) <= u) return high;
  for (int k = 0; k < 60; k++) {
    double middle = 0.5 * (low + high);
    if (gsl_spline_eval(curve, middle, at) < u)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* u or T, and s, at the nodes of line i; curve and value [n] are room. */
static void line_of(Table *t, const Fan *f, gsl_spline *curve, gsl_interp_accel *at, double *value,
                    int i)
{
  for (int k = 0; k < f->n; k++) value[k] = f->u[(size_t)k * (size_t)t->nrho + (size_t)i];
  gsl_spline_init(curve, f->label, value, (size_t)f->n);
  for (int j = 0; j < t->ny; j++) {
    size_t n = (size_t)i * (size_t)t->ny + (size_t)j;
    double u = t->heat ? f->cold[i] + f->cv * t->y[j] : t->y[j];
    t->field[TABLE_S][n] = f->cv * (label_of(curve, at, f, u) - log(f->cv)); /* as thermal.h */
    if (t->heat)
      t->field[TABLE_U][n] = u;
    else
      t->field[TABLE_T][n] = fmax(0, (u - f->cold[i]) / f->cv);
  }
}

static int heat_of(Table *t, const Material *m, const TabulateGrid *g, Err *err)
{
  const double rho0 = eos_rho0(&m->eos);
  Fan f = {&m->eos, g, m->heat, rho0 > 0 ? rho0 : 1, NULL, 0, NULL, NULL};
  gsl_spline *curve = NULL;
  gsl_interp_accel *at = NULL;
  double *value = NULL;
  int bad = fan_fill(&f, err);
  if (!bad) {
    curve = gsl_spline_alloc(gsl_interp_cspline, (size_t)f.n), at = gsl_interp_accel_alloc();
    value = malloc((size_t)f.n * sizeof *value);
    bad = !curve || !at || !value ? err_set(err, "no memory for %d isentropes", f.n) : 0;
  }
  for (int i = 0; i < g->nrho && !bad; i++) line_of(t, &f, curve, at, value, i);
  gsl_spline_free(curve), gsl_interp_accel_free(at);
  free(value), free(f.cold), free(f.label), free(f.u);
  return bad ? -1 : 0;
}

/* Of a pair of equal nodes the first lies a trifle below, the second above. */
static double beside(const double *x, int n, int k)
{
  if (k + 1 < n && x[k] == x[k + 1]) return x[k] * (1 - 1e-13);
  if (k > 0 && x[k] == x[k - 1]) return x[k] * (1 + 1e-13);
  return x[k];
}

static int lay_grid(Table *t, const TabulateGrid *g, Err *err)
{
  if (table_new(t, g->nrho, g->ny, g->heat, err)) return -1;
  memcpy(t->rho, g->rho, (size_t)g->nrho * sizeof *t->rho);
  memcpy(t->y, g->y, (size_t)g->ny * sizeof *t->y);
  return 0;
}

int tabulate_law(Table *t, const Material *m, const TabulateGrid *g, Err *err)
{
  const Eos *eos = &m->eos;
  if (eos->form == EOS_LOCAL_ISOTHERMAL)
    return err_set(err, "p of this material is no function of density and energy");
  if (!(m->heat > 0)) return err_set(err, "the material has no 'heat_capacity'");
  if (lay_grid(t, g, err)) return -1;
  if (heat_of(t, m, g, err)) return table_free(t), -1;
  for (int i = 0; i < t->nrho; i++)
    for (int j = 0; j < t->ny; j++) {
      size_t at = (size_t)i * (size_t)t->ny + (size_t)j;
      double rho = beside(t->rho, t->nrho, i),
             u = t->heat ? t->field[TABLE_U][at] : beside(t->y, t->ny, j);
      EosPoint point = rho > 0 ? eos_eval(eos, rho, u, 0) : (EosPoint){0, 0};
      t->field[TABLE_P][at] = point.p, t->field[TABLE_C][at] = point.cs;
    }
  return table_check(t, "table", err) ? (table_free(t), -1) : 0;
}

int tabulate_table(Table *t, const struct eos_table *from, const TabulateGrid *g, Err *err)
{
  if (lay_grid(t, g, err)) return -1;
  for (int i = 0; i < t->nrho; i++)
    for (int j = 0; j < t->ny; j++) {
      size_t at = (size_t)i * (size_t)t->ny + (size_t)j;
      double rho = beside(t->rho, t->nrho, i), y = beside(t->y, t->ny, j);
      EosTableState s = eos_table_state(from, rho, t->heat ? EOS_TABLE_T : EOS_TABLE_U, y);
      EosPoint point = eos_table(from, rho, s.u, 0);
      if (isnan(s.u)) {
        table_free(t);
        return err_set(err, "the table does not have %g K at %g kg/m^3", y, rho);
      }
      t->field[TABLE_P][at] = point.p, t->field[TABLE_C][at] = point.cs;
      t->field[t->heat ? TABLE_U : TABLE_T][at] = t->heat ? s.u : s.T;
      t->field[TABLE_S][at] = s.s, t->field[TABLE_PHASE][at] = s.phase;
    }
  return table_check(t, "table", err) ? (table_free(t), -1) : 0;
}

int tabulate_breaks(const Eos *eos, int energies, double at[2])
{
  if (eos->form != EOS_TILLOTSON) return 0;
  at[0] = energies ? eos->tillotson.Eiv : eos->tillotson.rho0;
  at[1] = eos->tillotson.Ecv;
  return energies ? 2 : 1;
}

double tabulate_error(const struct eos_table *e, const Eos *eos, double *p, double *c)
{
  const double *rho = e->data, *y = eos_table_part(e, EOS_TABLE_Y), bulk = eos_bulk(eos);
  const double floor = bulk > 0 ? 0.1 * sqrt(bulk / eos_rho0(eos)) : 0;
  double cells = 0, good = 0;
  *p = *c = 0;
  for (int i = 0; i + 1 < e->nrho; i++)
    for (int j = 0; j + 1 < e->ny; j++) {
      double r = 0.5 * (rho[i] + rho[i + 1]), u = 0.5 * (y[j] + y[j + 1]), off[2];
      EosPoint a, b;
      if (e->heat) u = eos_table_state(e, r, EOS_TABLE_T, u).u;
      a = eos_table(e, r, u, 0), b = eos_eval(eos, r, u, 0);
      if (rho[i] == rho[i + 1] || y[j] == y[j + 1] || !(b.cs > floor)) continue;
      off[0] = fabs(a.p - b.p) / (fabs(b.p) + 1e-4 * fmax(bulk, r * b.cs * b.cs));
      off[1] = fabs(a.cs / b.cs - 1);
      *p = fmax(*p, off[0]), *c = fmax(*c, off[1]);
      cells++, good += off[0] < 1e-4 && off[1] < 1e-4;
    }
  return cells > 0 ? good / cells : 1;
}
