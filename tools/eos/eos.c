/* SPDX-License-Identifier: GPL-3.0-or-later */
/* eos: pressure and sound speed of a material at densities, or pressures, and energies,
 * temperatures or entropies, from lists, grids or pairs on stdin; isentropes and Hugoniot curves.
 * `eos table` is in make.c, `eos fill` in fill.c. All values are read and all states found before
 * the first line is printed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../../lib/material.h"
#include "../../lib/opt.h"
#include "../../lib/thermal.h"
#include "../../lib/unit.h"
#include "curve.h"
#include "fill.h"
#include "make.h"
#include "values.h"

static struct {
  const char *material, *rho, *pressure, *u, *temperature, *entropy, *isentrope, *hugoniot;
  double radius;
  int thermal, list;
} o = {.radius = NAN};

/* clang-format off */
static const Opt OPTS[] = {
  {"material",    'm', OPT_TEXT, NULL, "NAME",   "material by name or path of a .cfg", &o.material},
  {"rho",         'r', OPT_TEXT, NULL, "VALUES", "densities, kg/m^3 without a unit", &o.rho},
  {"pressure",    'p', OPT_TEXT, NULL, "VALUES", "pressures instead of densities", &o.pressure},
  {"u",           'u', OPT_TEXT, NULL, "VALUES", "specific energies, J/kg without a unit", &o.u},
  {"temperature", 't', OPT_TEXT, NULL, "VALUES", "temperatures instead of energies", &o.temperature},
  {"entropy",     's', OPT_TEXT, NULL, "VALUES", "entropies instead of energies", &o.entropy},
  {"isentrope",   'i', OPT_TEXT, NULL, "RHO,U",  "the isentrope through this state, at --rho", &o.isentrope},
  {"hugoniot",    'H', OPT_TEXT, NULL, "SPEEDS", "behind shocks that move matter so, into --rho, --u (at rest)", &o.hugoniot},
  {"thermal",     'T', OPT_FLAG, NULL, NULL,     "temperature, entropy and phase too", &o.thermal},
  {"radius",      0,   OPT_REAL, NULL, "m",      "from the star, for local_isothermal", &o.radius},
  {"list",        'l', OPT_FLAG, NULL, NULL,     "print the names of the known materials", &o.list},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};
/* clang-format on */

static const OptProgram PROGRAM = {
    "eos",
    "print pressure and sound speed of a material",
    "--material NAME --rho VALUES --u VALUES | --material NAME - < pairs | table | fill ...",
    "VALUES are numbers with or without unit separated by commas; LOW:HIGH:N stands for N evenly "
    "spaced ones, log:LOW:HIGH:N for logarithmically spaced ones. Every density is combined with "
    "every energy. With - as input, pairs of density and energy are read from stdin, one a line; "
    "empty lines and lines that begin with # are skipped. eos table makes and converts tables; "
    "eos fill adds temperature, entropy and phase to a snapshot.",
    "eos --material basalt --rho 2.7g/cc,3000 --u 0:10MJ/kg:5\n"
    "eos --material ice --rho log:1:2000:40 --u 1e6 > isochores.tsv\n"
    "eos --material basalt --hugoniot 1km/s:10km/s:10",
    OPTS,
    0,
    1};

static void list_materials(void)
{
  int n = 0;
  MaterialName *names = material_names(&n);
  if (!n) err_die("no materials in $BRECCIA_MATERIALS, 'materials' or beside the program");
  for (int k = 0; k < n; k++) puts(names[k]);
  free(names);
}

static Material load(void)
{
  MaterialName name;
  Material m;
  Err err;
  char *text = material_find(o.material, name, &err);
  if (!text || material_parse(&m, text, o.material, &err)) err_die("%s", err.text);
  free(text);
  if ((m.eos.form == EOS_LOCAL_ISOTHERMAL) != !isnan(o.radius))
    err_usage(isnan(o.radius) ? "material '%s' needs --radius"
                              : "--radius means nothing for material '%s'",
              name);
  return m;
}

static int given(const char *text) { return text != NULL; }

/* Which options go together. */
static void check_options(int inputs)
{
  int energies = given(o.u) + given(o.temperature) + given(o.entropy);
  int states = given(o.rho) + given(o.pressure);
  if (!o.material) err_usage("--material is missing");
  if (o.isentrope && o.hugoniot) err_usage("--isentrope or --hugoniot, not both");
  if (inputs && (states || energies || o.isentrope || o.hugoniot))
    err_usage("--rho and --u, or pairs from stdin, not both");
  if (inputs) return;
  if (states > 1) err_usage("--rho or --pressure, not both");
  if (energies > 1) err_usage("one of --u, --temperature and --entropy");
  if (o.isentrope && (!o.rho || energies))
    err_usage("--isentrope needs --rho, and no other energy");
  if (o.hugoniot && (o.pressure || o.temperature || o.entropy))
    err_usage("--hugoniot starts from --rho and --u");
  if (!o.isentrope && !o.hugoniot && !(states && energies))
    err_usage("--rho and --u are needed, or - for pairs from stdin");
}

/* The states to print; of shocks also the speeds of the matter and of the shock. */
typedef struct {
  double rho, u, up, us;
} Row;

typedef struct {
  Row *row;
  long n;
} Rows;

static Rows rows_new(long n)
{
  Rows r = {malloc((size_t)(n ? n : 1) * sizeof *r.row), 0};
  if (!r.row) err_die("no memory for %ld states", n);
  return r;
}

static void print(const Material *m, Rows *rows)
{
  printf("# rho [kg/m^3]\tu [J/kg]\tp [Pa]\tc [m/s]%s%s\n",
         o.hugoniot ? "\tup [m/s]\tUs [m/s]" : "", o.thermal ? "\tT [K]\ts [J/K/kg]\tphase" : "");
  for (long i = 0; i < rows->n; i++) {
    const Row *r = &rows->row[i];
    EosPoint at = eos_eval(&m->eos, r->rho, r->u, o.radius);
    int phase = m->eos.form == EOS_TABLE
                    ? eos_table_state(&m->eos.table, r->rho, EOS_TABLE_U, r->u).phase
                    : 0;
    printf("%.12g\t%.12g\t%.12g\t%.12g", r->rho, r->u, at.p, at.cs);
    if (o.hugoniot) printf("\t%.12g\t%.12g", r->up, r->us);
    if (o.thermal)
      printf("\t%.12g\t%.12g\t%d", thermal_temperature(m, r->rho, r->u),
             thermal_entropy(m, r->rho, r->u), phase);
    putchar('\n');
  }
  free(rows->row);
}

static void positive(const Values *v, const char *what)
{
  for (long i = 0; i < v->n; i++)
    if (!(v->x[i] > 0)) err_die("%s must be above 0: %g", what, v->x[i]);
}

static Rows pairs(void)
{
  Values rho = {NULL, 0, 0}, u = rho;
  Rows r;
  values_pairs(&rho, &u);
  positive(&rho, "the density");
  for (r = rows_new(rho.n); r.n < rho.n; r.n++) r.row[r.n] = (Row){rho.x[r.n], u.x[r.n], 0, 0};
  free(rho.x), free(u.x);
  return r;
}

/* Every density or pressure with every energy, temperature or entropy. */
static Rows states(const Material *m)
{
  static const char *const of[] = {"J/kg", "K", "J/K/kg"};
  Values rho =
      o.rho ? values_read(o.rho, "kg/m^3", "--rho") : values_read(o.pressure, "Pa", "--pressure");
  Values u = o.u             ? values_read(o.u, "J/kg", "--u")
             : o.temperature ? values_read(o.temperature, "K", "--temperature")
                             : values_read(o.entropy, "J/K/kg", "--entropy");
  CurveKind kind = o.u ? CURVE_ENERGY : o.temperature ? CURVE_TEMPERATURE : CURVE_ENTROPY;
  Rows r = rows_new(rho.n * u.n);
  if (o.rho) positive(&rho, "the density");
  for (long i = 0; i < rho.n; i++)
    for (long j = 0; j < u.n; j++) {
      double at = o.rho ? rho.x[i] : curve_density(m, kind, u.x[j], rho.x[i]);
      double energy = curve_energy(m, kind, u.x[j], at);
      if (isnan(at) || isnan(energy))
        err_die("the material has no state at %g %s and %g %s", rho.x[i], o.rho ? "kg/m^3" : "Pa",
                u.x[j], of[kind]);
      r.row[r.n++] = (Row){at, energy, 0, 0};
    }
  free(rho.x), free(u.x);
  return r;
}

static Rows isentrope(const Material *m)
{
  Values rho = values_read(o.rho, "kg/m^3", "--rho");
  const char *comma = strchr(o.isentrope, ',');
  char text[256];
  double rho1, u1;
  Rows r = rows_new(rho.n);
  Err err;
  if (!comma || comma - o.isentrope >= (long)sizeof text)
    err_usage("--isentrope: '%s' is not RHO,U", o.isentrope);
  snprintf(text, sizeof text, "%.*s", (int)(comma - o.isentrope), o.isentrope);
  if (unit_parse(text, "kg/m^3", &rho1, &err) || unit_parse(comma + 1, "J/kg", &u1, &err))
    err_usage("--isentrope: %s", err.text);
  positive(&rho, "the density");
  if (!(rho1 > 0)) err_die("the density must be above 0: %g", rho1);
  for (; r.n < rho.n; r.n++) {
    double u = thermal_isentrope(&m->eos, rho1, u1, rho.x[r.n]);
    if (isnan(u)) err_die("the isentrope does not reach %g kg/m^3", rho.x[r.n]);
    r.row[r.n] = (Row){rho.x[r.n], u, 0, 0};
  }
  free(rho.x);
  return r;
}

static Rows hugoniot(const Material *m)
{
  Values up = values_read(o.hugoniot, "m/s", "--hugoniot"), rho = {NULL, 0, 0}, u = rho;
  double rho1 = eos_rho0(&m->eos), u1 = 0;
  Rows r = rows_new(up.n);
  if (o.rho) rho = values_read(o.rho, "kg/m^3", "--rho"), rho1 = rho.x[0];
  if (o.u) u = values_read(o.u, "J/kg", "--u"), u1 = u.x[0];
  if (rho.n > 1 || u.n > 1) err_usage("--hugoniot starts from one density and one energy");
  if (!(rho1 > 0)) err_usage("--hugoniot of a gas needs --rho and --u");
  positive(&up, "the speed");
  for (; r.n < up.n; r.n++) {
    Row *row = &r.row[r.n];
    row->up = up.x[r.n];
    if (curve_shock(m, rho1, u1, row->up, &row->us, &row->rho, &row->u))
      err_die("no shock moves this matter at %g m/s", row->up);
  }
  free(up.x), free(rho.x), free(u.x);
  return r;
}

int main(int argc, char **argv)
{
  int inputs;
  char **input;
  Material m;
  Rows rows;
  if (argc > 1 && !strcmp(argv[1], "table")) return make_main(argc - 1, argv + 1);
  if (argc > 1 && !strcmp(argv[1], "fill")) return fill_main(argc, argv);
  input = opt_parse(&PROGRAM, argc, argv, &inputs);
  if (o.list && (o.material || o.rho || o.u || inputs)) err_usage("--list goes alone");
  if (o.list) {
    list_materials();
    err_close_stdout();
    return 0;
  }
  if (inputs && strcmp(input[0], "-")) err_usage("the only input is -, not '%s'", input[0]);
  check_options(inputs);
  m = load();
  rows = inputs ? pairs() : o.isentrope ? isentrope(&m) : o.hugoniot ? hugoniot(&m) : states(&m);
  print(&m, &rows);
  material_clear(&m);
  err_close_stdout();
  return 0;
}
