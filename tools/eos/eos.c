/* SPDX-License-Identifier: GPL-3.0-or-later */
/* eos: pressure and sound speed of a material at densities and energies from lists, grids or
 * pairs on stdin. All values are read and checked before the first line is printed. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/material.h"
#include "lib/opt.h"
#include "lib/unit.h"

static struct {
  const char *material, *rho, *u;
  double radius;
  int list;
} o = {.radius = NAN};

/* clang-format off */
static const Opt OPTS[] = {
  {"material", 'm', OPT_TEXT, NULL, "NAME",   "material by name or path of a .cfg", &o.material},
  {"rho",      'r', OPT_TEXT, NULL, "VALUES", "densities, kg/m^3 without a unit", &o.rho},
  {"u",        'u', OPT_TEXT, NULL, "VALUES", "specific energies, J/kg without a unit", &o.u},
  {"radius",   0,   OPT_REAL, NULL, "m",      "from the star, for local_isothermal", &o.radius},
  {"list",     'l', OPT_FLAG, NULL, NULL,     "print the names of the known materials", &o.list},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};
/* clang-format on */

static const OptProgram PROGRAM = {
    "eos",
    "print pressure and sound speed of a material",
    "--material NAME --rho VALUES --u VALUES | --material NAME - < pairs",
    "VALUES are numbers with or without unit separated by commas; LOW:HIGH:N stands for N evenly "
    "spaced ones, log:LOW:HIGH:N for logarithmically spaced ones. Every density is combined with "
    "every energy. With - as input, pairs of density and energy are read from stdin, one a line; "
    "empty lines and lines that begin with # are skipped.",
    "eos --material basalt --rho 2.7g/cc,3000 --u 0:10MJ/kg:5\n"
    "eos --material ice --rho log:1:2000:40 --u 1e6 > isochores.tsv",
    OPTS,
    0,
    1};

/* Numbers that grow as they are read. */
typedef struct {
  double *x;
  long n, room;
} Values;

static void add(Values *v, double x)
{
  if (v->n == v->room) {
    v->room = v->room ? 2 * v->room : 64;
    v->x = realloc(v->x, (size_t)v->room * sizeof *v->x);
    if (!v->x) err_die("no memory for %ld values", v->room);
  }
  v->x[v->n++] = x;
}

/* where: the option, or the line of stdin. */
static double quantity(const char *text, const char *kind, const char *where)
{
  Err err;
  double x;
  if (!unit_parse(text, kind, &x, &err)) return x;
  if (*where == '-') err_usage("%s: %s", where, err.text);
  err_die("%s: %s", where, err.text);
}

/* LOW:HIGH:N or log:LOW:HIGH:N, cut at the colons in place. */
static void grid(Values *v, char *text, const char *kind, const char *where)
{
  int by_log = !strncmp(text, "log:", 4);
  char *low = text + (by_log ? 4 : 0), *high = strchr(low, ':'), *count, *end;
  double a, b;
  long n;
  if (!high || !(count = strchr(high + 1, ':')))
    err_usage("%s: '%s' is not LOW:HIGH:N", where, text);
  n = strtol(count + 1, &end, 10);
  if (count[1] < '0' || count[1] > '9' || *end || n < 2 || n > 10000000)
    err_usage("%s: a grid needs 2 to 10000000 points, not '%s'", where, count + 1);
  *high = *count = '\0';
  a = quantity(low, kind, where), b = quantity(high + 1, kind, where);
  if (by_log && !(a > 0 && b > 0)) err_usage("%s: a logarithmic grid needs values above 0", where);
  for (long k = 0; k < n; k++) {
    double x = (double)k / (double)(n - 1);
    add(v, k == n - 1 ? b : by_log ? a * pow(b / a, x) : a + (b - a) * x);
  }
}

static Values values(const char *list, const char *kind, const char *where)
{
  Values v = {NULL, 0, 0};
  char *copy = malloc(strlen(list) + 1), *item = copy, *comma;
  if (!copy) err_die("no memory");
  strcpy(copy, list);
  do {
    if ((comma = strchr(item, ','))) *comma = '\0';
    if (strchr(item, ':'))
      grid(&v, item, kind, where);
    else
      add(&v, quantity(item, kind, where));
    item = comma + 1;
  } while (comma);
  free(copy);
  return v;
}

/* Density and energy of each line of stdin. */
static void pairs(Values *rho, Values *u)
{
  char *line = NULL, rho_text[256], u_text[256], rest[2], where[32];
  size_t room = 0;
  for (long number = 1; getline(&line, &room, stdin) >= 0; number++) {
    int found = sscanf(line, "%255s %255s %1s", rho_text, u_text, rest);
    if (found <= 0 || rho_text[0] == '#') continue;
    snprintf(where, sizeof where, "stdin:%ld", number);
    if (found != 2) err_die("%s: a density and an energy are wanted", where);
    add(rho, quantity(rho_text, "kg/m^3", where));
    add(u, quantity(u_text, "J/kg", where));
  }
  free(line);
  if (ferror(stdin)) err_die("cannot read stdin: %s", strerror(errno));
  if (!rho->n) err_die("stdin: no pairs of density and energy");
}

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

static void print(const Material *m, double rho, double u)
{
  EosPoint at = eos_eval(&m->eos, rho, u, o.radius);
  printf("%.12g\t%.12g\t%.12g\t%.12g\n", rho, u, at.p, at.cs);
}

int main(int argc, char **argv)
{
  int inputs;
  char **input = opt_parse(&PROGRAM, argc, argv, &inputs);
  Values rho = {NULL, 0, 0}, u = {NULL, 0, 0};
  Material m;
  if (o.list && (o.material || o.rho || o.u || inputs)) err_usage("--list goes alone");
  if (o.list) {
    list_materials();
    err_close_stdout();
    return 0;
  }
  if (!o.material) err_usage("--material is missing");
  if (inputs && strcmp(input[0], "-")) err_usage("the only input is -, not '%s'", input[0]);
  if (inputs && (o.rho || o.u)) err_usage("--rho and --u, or pairs from stdin, not both");
  if (!inputs && !(o.rho && o.u)) err_usage("--rho and --u are needed, or - for pairs from stdin");
  m = load();
  if (inputs)
    pairs(&rho, &u);
  else
    rho = values(o.rho, "kg/m^3", "--rho"), u = values(o.u, "J/kg", "--u");
  for (long i = 0; i < rho.n; i++)
    if (!(rho.x[i] > 0)) err_die("the density must be above 0: %g kg/m^3", rho.x[i]);
  printf("# rho [kg/m^3]\tu [J/kg]\tp [Pa]\tc [m/s]\n");
  for (long i = 0; i < rho.n; i++)
    for (long j = inputs ? i : 0; j < (inputs ? i + 1 : u.n); j++) print(&m, rho.x[i], u.x[j]);
  free(rho.x);
  free(u.x);
  err_close_stdout();
  return 0;
}
