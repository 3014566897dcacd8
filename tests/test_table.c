/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables: made from laws they give p and c back to 1e-4 between the nodes, through every format;
 * they are continuous, also at their edges, and c is the derivative of p everywhere; T and s are
 * those of lib/thermal; bad files are refused with their line. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>
#include <gsl/gsl_deriv.h>
#include "../lib/material.h"
#include "../lib/rng.h"
#include "../lib/spool.h"
#include "folder.h"
#include "tabulated.h"

#define N(A) (int)(sizeof(A) / sizeof *(A))

/* clang-format off */
static const Material BASALT = {.heat = 1000, .eos = {.form = EOS_TILLOTSON,
  .tillotson = {2700, 26.7e9, 26.7e9, 487e6, 4.72e6, 18.2e6, 0.5, 1.5, 5, 5, 0, 0}}};
static const Material IRON = {.heat = 449, .eos = {.form = EOS_TILLOTSON,
  .tillotson = {7800, 128e9, 105e9, 9.5e6, 2.4e6, 8.67e6, 0.5, 1.5, 5, 5, 0, 0}}};
static const Material MERCURY = {.heat = 140, .eos = {.form = EOS_STIFFENED, .stiffened = {13534, 1450, 1, 88.0e9, 153.2e9, 2.73, 0}}};
static const Material ROCK = {.heat = 900, .eos = {.form = EOS_MURNAGHAN, .murnaghan = {2860, 19.3e9, 5.5, 0}}};
static const Material AIR = {.heat = 717, .eos = {.form = EOS_IDEAL, .ideal = {1.4, 0}}};
/* clang-format on */

/* Laws, and where tables of them lie: of energies, and of temperatures. */
static const struct {
  const Material *m;
  double rho[2], u[2], T[2];
  int nrho, nu, nT;
} LAW[] = {{&BASALT, {1000, 10000}, {0, 6e7}, {0, 2e4}, 200, 200, 60},
           {&IRON, {4000, 30000}, {0, 4e7}, {0, 1e4}, 240, 200, 60},
           {&MERCURY, {10000, 20000}, {0, 1e6}, {0, 5000}, 60, 40, 40},
           {&ROCK, {2000, 6000}, {0, 1e8}, {0, 1e4}, 120, 120, 20},
           {&AIR, {1e-2, 100}, {1e3, 1e8}, {1, 1e5}, 60, 40, 40}};

static Table table_of(int k, int heat)
{
  return tabulated_law(LAW[k].m, LAW[k].rho, LAW[k].nrho, heat ? LAW[k].T : LAW[k].u,
                       heat ? LAW[k].nT : LAW[k].nu, heat);
}

/* The i-th of random states in the table of law k, by logarithm in rho. */
static void draw(int k, int heat, uint64_t i, double *rho, double *u)
{
  double f = rng_uniform(5, i, 0), g = rng_uniform(5, i, 1);
  *rho = LAW[k].rho[0] * pow(LAW[k].rho[1] / LAW[k].rho[0], f);
  if (heat)
    *u = thermal_energy(LAW[k].m, *rho, LAW[k].T[0] + g * (LAW[k].T[1] - LAW[k].T[0]));
  else
    *u = LAW[k].u[0] + g * (LAW[k].u[1] - LAW[k].u[0]);
}

/* Where the law has its floor of c, or a corner that a table does not have: text cannot have a node
 * twice, and a table of temperatures none at an energy. */
static int corner(const Material *m, const Table *t, double rho, double u)
{
  const struct eos_tillotson *e = &m->eos.tillotson;
  int near;
  if (eos_eval(&m->eos, rho, u, 0).cs < 0.2 * sqrt(eos_bulk(&m->eos) / fmax(eos_rho0(&m->eos), 1)))
    return 1;
  if (m->eos.form != EOS_TILLOTSON) return 0;
  if (u < 0.75 * e->Eiv || rho > 1.05 * e->rho0) return 0;
  near = fabs(u / e->Eiv - 1) < 0.25 || fabs(u / e->Ecv - 1) < 0.25;
  return (near && (t->heat || t->row)) || (t->row && rho > 0.95 * e->rho0);
}

/* p, c, T and s of random states against the law. */
static void agree(int k, const Table *t, const char *what)
{
  const Material *m = LAW[k].m;
  Eos e = tabulated_eos(t);
  double worst[2] = {0, 0};
  for (uint64_t i = 0; i < 5000; i++) {
    double rho, u;
    EosPoint a, b;
    draw(k, t->heat, i, &rho, &u);
    if (corner(m, t, rho, u)) continue;
    a = eos_eval(&e, rho, u, 0), b = eos_eval(&m->eos, rho, u, 0);
    worst[0] = fmax(worst[0], fabs(a.p - b.p) / (fabs(b.p) + 1e-4 * rho * b.cs * b.cs));
    worst[1] = fmax(worst[1], fabs(a.cs / b.cs - 1));
    if (worst[0] > 1e-4 || worst[1] > 1e-4)
      fail_msg("law %d, %s: at %g kg/m^3, %g J/kg p %.9g and c %.9g, not %.9g, %.9g", k, what, rho,
               u, a.p, a.cs, b.p, b.cs);
  }
  print_message("law %d, %s: p %.1e, c %.1e\n", k, what, worst[0], worst[1]);
  table_law_free(&e.table);
}

static void through(int k, int heat, int format)
{
  Table t = table_of(k, heat), back;
  Err err;
  if (tabfile_write(&t, "table", format, &err)) fail_msg("%s", err.text);
  if (tabfile_read(&back, "table", &err)) fail_msg("%s", err.text);
  agree(k, &back,
        format == TABFILE_HDF5 ? heat ? "hdf5, T" : "hdf5, u"
        : heat                 ? "sesame"
                               : "miluph");
  table_free(&t), table_free(&back);
}

static void laws(void **state)
{
  (void)state;
  for (int k = 0; k < N(LAW); k++) {
    through(k, 0, TABFILE_HDF5), through(k, 1, TABFILE_HDF5);
    through(k, 0, TABFILE_MILUPH), through(k, 1, TABFILE_SESAME);
  }
}

/* T and s against lib/thermal; u at a T, and at an s. */
static void heat(void **state)
{
  (void)state;
  for (int k = 0; k < N(LAW); k++)
    for (int kind = 0; kind < 2; kind++) {
      const Material *m = LAW[k].m;
      Table t = table_of(k, kind);
      Eos e = tabulated_eos(&t);
      Material tabular = {.eos = e, .heat = 1};
      for (uint64_t i = 0; i < 200; i++) {
        double rho, u, T, s;
        draw(k, kind, i, &rho, &u);
        if (corner(m, &t, rho, u)) continue;
        T = thermal_temperature(m, rho, u), s = thermal_entropy(m, rho, u);
        if (!(T > 0.3 * LAW[k].T[1])) continue;
        if (fabs(thermal_temperature(&tabular, rho, u) / T - 1) > 2e-4 ||
            fabs(thermal_energy(&tabular, rho, T) - u) > 2e-4 * m->heat * T)
          fail_msg("law %d: T at %g, %g is %.9g, not %.9g", k, rho, u,
                   thermal_temperature(&tabular, rho, u), T);
        if (!isnan(s) && fabs(thermal_entropy(&tabular, rho, u) - s) > 5e-3 * m->heat)
          fail_msg("law %d: s at %g, %g is %.9g, not %.9g", k, rho, u,
                   thermal_entropy(&tabular, rho, u), s);
      }
      table_law_free(&e.table), table_free(&t);
    }
}

/* Along an isentrope of the table's own p its own s stays, and u at that s is the one there. */
static void isentropes(void **state)
{
  Table t = table_of(0, 1);
  Eos e = tabulated_eos(&t);
  double s = eos_table_state(&e.table, 3000, EOS_TABLE_U, 6e6).s;
  (void)state;
  for (double rho = 2800; rho < 5600; rho += 300) {
    double u = thermal_isentrope(&e, 3000, 6e6, rho);
    assert_true(fabs(eos_table_state(&e.table, rho, EOS_TABLE_U, u).s - s) < 0.5);
    assert_true(fabs(eos_table_state(&e.table, rho, EOS_TABLE_S, s).u / u - 1) < 1e-4);
  }
  assert_true(isnan(eos_table_state(&e.table, 3000, EOS_TABLE_S, 1e9).u));
  assert_true(isnan(eos_table_state(&e.table, 3000, EOS_TABLE_T, 1e9).u));
  table_law_free(&e.table), table_free(&t);
}

/* ---- continuity, derivatives, outside ---- */

typedef struct {
  const Eos *e;
  double rho, u;
} State;

static double p_rho(double rho, void *v)
{
  return eos_eval(((State *)v)->e, rho, ((State *)v)->u, 0).p;
}
static double p_u(double u, void *v)
{
  return eos_eval(((State *)v)->e, ((State *)v)->rho, u, 0).p;
}

/* c^2 = p_rho + p p_u/rho^2 of the table's own p, inside and on all sides outside. */
static void speed(void **state)
{
  (void)state;
  for (int k = 0; k < N(LAW); k++)
    for (int kind = 0; kind < 2; kind++) {
      Table t = table_of(k, kind);
      Eos e = tabulated_eos(&t);
      double bulk = eos_bulk(&e);
      for (uint64_t i = 0; i < 500; i++) {
        State s = {&e, 0, 0};
        gsl_function f = {p_rho, &s}, g = {p_u, &s};
        double by_rho, by_u, error, c2;
        EosPoint at;
        draw(k, kind, i, &s.rho, &s.u);
        if (i % 5 == 1) s.rho *= 10;
        if (i % 5 == 2) s.rho *= 0.01;
        if (i % 5 == 3) s.u += LAW[k].u[1];
        if (i % 5 == 4 && bulk > 0) s.u = -1e7;
        if (corner(LAW[k].m, &t, s.rho, s.u)) continue;
        gsl_deriv_central(&f, s.rho, 1e-6 * s.rho, &by_rho, &error);
        gsl_deriv_central(&g, s.u, 1e-6 * (fabs(s.u) + 1e3), &by_u, &error);
        at = eos_eval(&e, s.rho, s.u, 0);
        c2 = by_rho + at.p / (s.rho * s.rho) * by_u;
        if (c2 < 0.01 * bulk / s.rho) continue; /* a floor, or the bound by the table's own c */
        if (fabs(at.cs * at.cs / c2 - 1) > 1e-5)
          fail_msg("law %d, kind %d: c^2 at %g, %g is %.9g, not %.9g", k, kind, s.rho, s.u,
                   at.cs * at.cs, c2);
      }
      table_law_free(&e.table), table_free(&t);
    }
}

/* p does not jump at any node or edge; c does not at nodes that stand once. */
static void continuity(void **state)
{
  const double d = 1e-11;
  (void)state;
  for (int k = 0; k < N(LAW); k++)
    for (int kind = 0; kind < 2; kind++) {
      Table t = table_of(k, kind);
      Eos e = tabulated_eos(&t);
      const double *axis = e.table.data, *y = eos_table_part(&e.table, EOS_TABLE_Y);
      for (uint64_t i = 0; i < 2000; i++) {
        int n = (int)(rng_uniform(6, i, 0) * e.table.nrho),
            m = (int)(rng_uniform(6, i, 1) * e.table.ny);
        double rho, u;
        EosPoint a, b;
        draw(k, kind, i, &rho, &u);
        a = eos_eval(&e, axis[n] * (1 - d), u, 0), b = eos_eval(&e, axis[n] * (1 + d), u, 0);
        assert_true(fabs(a.p - b.p) <= 1e-8 * (fabs(a.p) + rho * a.cs * a.cs));
        if (n > 0 && n < e.table.nrho - 1 && LAW[k].m->eos.form != EOS_TILLOTSON)
          assert_true(fabs(a.cs / b.cs - 1) < 1e-7);
        u = kind ? eos_table_state(&e.table, rho, EOS_TABLE_T, y[m]).u : y[m];
        a = eos_eval(&e, rho, u - d * fabs(u), 0), b = eos_eval(&e, rho, u + d * fabs(u), 0);
        assert_true(fabs(a.p - b.p) <= 1e-8 * (fabs(a.p) + rho * a.cs * a.cs));
        if (m > 0 && m < e.table.ny - 1 && LAW[k].m->eos.form != EOS_TILLOTSON)
          assert_true(fabs(a.cs / b.cs - 1) < 1e-7);
      }
      table_law_free(&e.table), table_free(&t);
    }
}

/* Outside a table of an ideal gas the rules of eos/table.h are its law, or what they say. */
static void outside(void **state)
{
  Table t = table_of(4, 0);
  Eos e = tabulated_eos(&t);
  EosPoint at;
  (void)state;
  assert_int_equal(eos_table_outside(&e.table, 1, 1e5), 0);
  at = eos_eval(&e, 1, 1e9, 0); /* hotter: the gas goes on */
  assert_int_equal(eos_table_outside(&e.table, 1, 1e9), 2);
  assert_true(fabs(at.p / 0.4e9 - 1) < 1e-12 && fabs(at.cs / sqrt(0.56e9) - 1) < 1e-12);
  assert_true(fabs(eos_table_state(&e.table, 1, EOS_TABLE_U, 1e9).T * 717 / 1e9 - 1) < 1e-9);
  at = eos_eval(&e, 1, 10, 0); /* colder: p of the lowest energy */
  assert_int_equal(eos_table_outside(&e.table, 1, 10), 4);
  assert_true(fabs(at.p / 0.4e3 - 1) < 1e-12);
  at = eos_eval(&e, 1e-5, 1e5, 0); /* thinner */
  assert_int_equal(eos_table_outside(&e.table, 1e-5, 1e5), 1);
  assert_true(fabs(at.p / 0.4 - 1) < 1e-12 && fabs(at.cs / sqrt(0.56e5) - 1) < 1e-12);
  at = eos_eval(&e, 1e4, 1e5, 0); /* denser */
  assert_true(fabs(at.p / 0.4e9 - 1) < 1e-12 && fabs(at.cs / sqrt(0.56e5) - 1) < 1e-12);
  assert_int_equal(eos_table_outside(&e.table, 1e4, 1e9), 3);
  table_law_free(&e.table), table_free(&t);
}

/* The phase is that of the nearest node; vapour is where it has a number of its own. */
static void phase(void **state)
{
  Table t = table_of(2, 1);
  Eos e;
  (void)state;
  for (int i = 0; i < t.nrho * t.ny; i++) t.field[TABLE_PHASE][i] = i;
  e = tabulated_eos(&t);
  for (int i = 1; i < t.nrho - 1; i++)
    for (int j = 1; j < t.ny - 1; j++)
      for (int side = -1; side < 2; side++) {
        double rho = t.rho[i] + side * 0.4 * (t.rho[i] - t.rho[i - 1]);
        double T = t.y[j] - side * 0.4 * (t.y[j] - t.y[j - 1]);
        EosTableState at = eos_table_state(&e.table, rho, EOS_TABLE_T, T);
        assert_int_equal(at.phase, i * t.ny + j);
        e.table.vapour = at.phase;
        assert_true(eos_vapour(&e, rho, at.u));
        e.table.vapour = at.phase + 1;
        assert_true(!eos_vapour(&e, rho, at.u));
        e.table.vapour = 0;
        assert_true(!eos_vapour(&e, rho, at.u));
      }
  table_law_free(&e.table), table_free(&t);
}

/* rho0 of tables with and without tension; a gas has none. */
static void at_rest(void **state)
{
  static const double rho0[] = {2700, 7800, 13534, 2860, 0};
  (void)state;
  for (int k = 0; k < N(LAW); k++) {
    Table t = table_of(k, 1);
    Eos e = tabulated_eos(&t);
    if (!(fabs(eos_rho0(&e) - rho0[k]) <= 1e-6 * rho0[k]))
      fail_msg("law %d: rho0 is %.9g", k, eos_rho0(&e));
    assert_true(fabs(table_heat(&e.table) - LAW[k].m->heat) < 1e-6 * LAW[k].m->heat);
    table_law_free(&e.table);
    for (int i = 0; i < t.nrho * t.ny; i++) t.field[TABLE_P][i] = fmax(t.field[TABLE_P][i], 1);
    e = tabulated_eos(&t);
    if (!(fabs(eos_rho0(&e) - rho0[k]) <= 1e-2 * rho0[k]))
      fail_msg("law %d without tension: rho0 is %.9g", k, eos_rho0(&e));
    table_law_free(&e.table), table_free(&t);
  }
}

/* ---- files ---- */

static void same(const Table *a, const Table *b)
{
  const size_t n = (size_t)a->nrho * (size_t)a->ny * sizeof(double);
  assert_true(a->nrho == b->nrho && a->ny == b->ny && a->heat == b->heat);
  assert_memory_equal(a->rho, b->rho, (size_t)a->nrho * sizeof(double));
  assert_memory_equal(a->y, b->y, (size_t)a->ny * sizeof(double));
  for (int k = 0; k < TABLE_FIELD_COUNT; k++) {
    if (!a->field[k] || !b->field[k]) continue;
    assert_memory_equal(a->field[k], b->field[k], n);
  }
}

/* Every number survives every format that can hold the table; the bytes are the same each time. */
static void round_trips(void **state)
{
  static const int format[][2] = {
      {0, TABFILE_HDF5}, {1, TABFILE_HDF5}, {1, TABFILE_SESAME}, {0, TABFILE_MILUPH}};
  (void)state;
  for (int k = 0; k < N(format); k++) {
    Table t = table_of(2, format[k][0]), back;
    char a[9], b[9];
    Err err;
    for (int i = 0; i < t.nrho * t.ny; i++) t.field[TABLE_PHASE][i] = i % 7;
    snprintf(t.about, sizeof t.about, "mercury, to try");
    assert_int_equal(tabfile_write(&t, "a", format[k][1], &err), 0);
    if (tabfile_read(&back, "a", &err)) fail_msg("%s", err.text);
    same(&t, &back);
    assert_string_equal(t.about, back.about);
    assert_true((back.field[TABLE_PHASE] != NULL) == (format[k][1] != TABFILE_SESAME));
    assert_int_equal(tabfile_write(&back, "b", format[k][1], &err), 0);
    assert_int_equal(tabfile_checksum("a", a, &err) | tabfile_checksum("b", b, &err), 0);
    assert_string_equal(a, b);
    table_free(&t), table_free(&back);
  }
}

/* A pair of equal densities is written once where text formats cannot hold it. */
static void pairs(void **state)
{
  Table t = table_of(0, 0), back;
  Err err;
  (void)state;
  assert_int_equal(tabfile_write(&t, "t", TABFILE_MILUPH, &err), 0);
  assert_int_equal(tabfile_read(&back, "t", &err), 0);
  assert_true(back.nrho == t.nrho - 1 && back.ny == t.ny - 2);
  assert_int_equal(tabfile_write(&t, "t", TABFILE_SESAME, &err), -1);
  assert_non_null(strstr(err.text, "needs an axis of temperatures"));
  table_free(&t), table_free(&back);
}

/* Energies that fall a little are raised and counted. */
static void noise(void **state)
{
  Table t = table_of(2, 1), back;
  Err err;
  (void)state;
  t.field[TABLE_U][1] = t.field[TABLE_U][0] * (1 - 1e-5);
  assert_int_equal(tabfile_write(&t, "t", TABFILE_SESAME, &err), 0);
  assert_int_equal(tabfile_read(&back, "t", &err), 0);
  assert_true(back.repaired == 1 && back.field[TABLE_U][1] == back.field[TABLE_U][0]);
  table_free(&t), table_free(&back);
}

#define HEAD "# x\n20200101\n4 4\n1 2 3 4\n10 20 30 40\n"
#define ROWS "1 1 1 1\n1 1 1 1\n1 1 1 1\n1 1 1 1\n"

static void mistakes(void **state)
{
  static const char *const T[][2] = {
      {"", "bad:1: no rows"},
      {"# x\n20200101\n", "bad:3: the file ends where the number of densities"},
      {"# x\n20200101\n4 2.5\n", "bad:3: the number of temperatures is 2.5"},
      {"# x\n20200101\n4 4\n1 2 3 x\n", "bad:4: 'x' where a density"},
      {HEAD ROWS ROWS ROWS, "bad:18: the file ends where u, P, c or s"},
      {HEAD ROWS ROWS "1 1 nan 1\n", "bad:15: the file ends"},
      {HEAD ROWS ROWS ROWS "1 1 1 1\n1 1 1 1\n1 1 inf 1\n1 1 1 1\n", "bad:20: SoundSpeed is inf"},
      {HEAD ROWS ROWS ROWS "1 1 1 1\n1 1 1 1\n1 1 -1 1\n1 1 1 1\n", "bad:20: SoundSpeed is -1"},
      {HEAD ROWS ROWS ROWS "1 1 1 1\n.5 1 1 1\n1 1 1 1\n1 1 1 1\n",
       "bad:19: InternalEnergy falls from 1 to 0.5"},
      {HEAD ROWS ROWS ROWS ROWS "7\n", "bad:22: more than the table: '7'"},
      {"# x\n20200101\n4 4\n1 2 3 3\n10 20 30 40\n" ROWS ROWS ROWS ROWS,
       "bad: densities: 3 stands twice at the end"},
      {"# x\n20200101\n4 4\n1 2 3 2\n10 20 30 40\n" ROWS ROWS ROWS ROWS,
       "bad: densities must ascend: number 4 is 2"},
      {"a\nb\nc\n1 2 3 4 5 6\n", "bad:5: the file ends where one of rho, e, p"},
      {"a\nb\nc\n1 1 1 1 1 1 1\n1 2 1 1 1 1 1\n1 3 1 1 1 1 1\n1 4 1 1 1 1 1\n2 1 1 1 1 1 1\n",
       "bad: 5 rows are not whole lines of 4"},
      {"a\nb\nc\n1 1 1 1 1 1 1\n1 2 1 1 1 1 1\n1 3 1 1 1 1 1\n1 4 1 1 1 1 1\n2 1 1 1 1 1 1\n2 2 1 "
       "1 1 1 1\n2 3.1 1 1 1 1 1\n2 4 1 1 1 1 1\n",
       "bad:10: energy 3.1"},
  };
  (void)state;
  for (int k = 0; k < N(T); k++) {
    Err err = {""};
    Table t;
    if (spool_text("bad", T[k][0], &err)) fail_msg("%s", err.text);
    assert_int_equal(tabfile_read(&t, "bad", &err), -1);
    if (!strstr(err.text, T[k][1])) fail_msg("'%s' lacks '%s'", err.text, T[k][1]);
  }
}

/* ---- materials ---- */

/* A material finds its table beside its .cfg, keeps the checksum, and takes no other. */
static void material(void **state)
{
  Table t = table_of(2, 0);
  MaterialName name;
  Material m;
  char *text, *old;
  Err err;
  (void)state;
  assert_int_equal(tabfile_write(&t, "hg.h5", TABFILE_HDF5, &err), 0);
  assert_int_equal(
      spool_text("hg.cfg", "name = \"hg\"; eos = { form = \"table\"; file = \"hg.h5\"; };", &err),
      0);
  if (!(text = material_find("./hg.cfg", name, &err))) fail_msg("%s", err.text);
  assert_non_null(strstr(text, "path = \"./hg.h5\"; checksum = \""));
  if (material_parse(&m, text, "hg", &err)) fail_msg("%s", err.text);
  assert_true(fabs(eos_rho0(&m.eos) - 13534) < 1e-3 && fabs(m.heat - 140) < 1e-3);
  material_clear(&m);
  assert_int_equal(spool_text("again.cfg", text, &err), 0);
  old = material_find("./again.cfg", name, &err);
  assert_string_equal(text, old);
  free(old);
  t.field[TABLE_P][5] *= 1.001;
  assert_int_equal(tabfile_write(&t, "hg.h5", TABFILE_HDF5, &err), 0);
  assert_int_equal(material_parse(&m, text, "hg", &err), -1);
  assert_non_null(strstr(err.text, "the table is another than the material was made with"));
  unlink("hg.h5");
  assert_int_equal(material_parse(&m, text, "hg", &err), -1);
  assert_non_null(strstr(err.text, "hg:1: no table 'hg.h5'"));
  free(text), table_free(&t);
}

static void material_mistakes(void **state)
{
  static const char *const T[][2] = {
      {"name = \"x\"; eos = { form = \"table\"; };", "x:1: missing key 'file'"},
      {"name = \"x\"; eos = { form = \"liquid\"; rho0 = 1; c = 1;\nfile = \"y\"; };",
       "x:2: unknown key 'file'"},
      {"name = \"x\"; eos = { form = \"table\";\nheat_capacity = 7; file = \"bad\"; };",
       "x:2: a table has its own"},
      {"name = \"x\"; eos = { form = \"liquid\"; rho0 = 1; c = 1; };\ntable = { checksum = \"a\"; "
       "};",
       "x:2: 'table' goes with"},
      {"name = \"x\"; eos = { form = \"table\"; file = \"y\"; };\ntable = { sum = \"a\"; };",
       "x:2: unknown key 'sum'"},
      {"name = \"x\"; eos = { form = \"table\"; file = \"bad\"; };", "bad:4: 'no' where one of"},
  };
  Material m;
  Err err;
  (void)state;
  assert_int_equal(spool_text("bad", "a\n2\n3\nno table", &err), 0);
  for (int k = 0; k < N(T); k++) {
    assert_int_equal(material_parse(&m, T[k][0], "x", &err), -1);
    if (!strstr(err.text, T[k][1])) fail_msg("'%s' lacks '%s'", err.text, T[k][1]);
  }
}

int main(void)
{
#define IN_FOLDER(TEST) cmocka_unit_test_setup_teardown(TEST, folder_setup, folder_teardown)
  const struct CMUnitTest tests[] = {
      IN_FOLDER(laws),
      cmocka_unit_test(heat),
      cmocka_unit_test(isentropes),
      cmocka_unit_test(speed),
      cmocka_unit_test(continuity),
      cmocka_unit_test(outside),
      cmocka_unit_test(phase),
      cmocka_unit_test(at_rest),
      IN_FOLDER(round_trips),
      IN_FOLDER(pairs),
      IN_FOLDER(noise),
      IN_FOLDER(mistakes),
      IN_FOLDER(material),
      IN_FOLDER(material_mistakes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
