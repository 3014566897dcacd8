/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table comes from a law, from a file as it is, or from a file on another grid. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../../lib/material.h"
#include "../../lib/opt.h"
#include "../../lib/tabfile.h"
#include "../../lib/tabulate.h"
#include "../../lib/unit.h"
#include "make.h"
#include "values.h"

static struct {
  const char *material, *from, *rho, *u, *temperature, *format, *output;
} o;

/* clang-format off */
static const Opt OPTS[] = {
  {"material",    'm', OPT_TEXT,   NULL,   "NAME",   "material by name or path of a .cfg", &o.material},
  {"from",        0,   OPT_TEXT,   NULL,   "FILE",   "a table instead, in any of the formats", &o.from},
  {"rho",         'r', OPT_TEXT,   NULL,   "VALUES", "densities of the nodes", &o.rho},
  {"u",           'u', OPT_TEXT,   NULL,   "VALUES", "specific energies of the nodes", &o.u},
  {"temperature", 't', OPT_TEXT,   NULL,   "VALUES", "temperatures of the nodes instead", &o.temperature},
  {"format",      'f', OPT_CHOICE, "hdf5", TABFILE_FORMATS, "of the output", &o.format},
  {"output",      'o', OPT_TEXT,   NULL,   "FILE",   "the table; - for stdout", &o.output},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};
/* clang-format on */

static const OptProgram PROGRAM = {
    "eos table",
    "make, look at and convert tables of equations of state",
    "--material NAME --rho VALUES --u VALUES -o FILE | --from FILE [-f FORMAT -o FILE]",
    "VALUES as in eos. sesame (WoMa, SWIFT) wants temperatures, miluph (miluphANEOS) energies; a "
    "table of "
    "the other kind is converted on the nodes that --temperature or --u give. Nodes of a law are "
    "doubled where its slopes jump. What was made, and how well it follows its law in the middle "
    "of "
    "its cells, goes to stderr.",
    "eos table -m basalt -r log:500:20000:300 -u 0:1e8:400 -o basalt.h5\n"
    "eos table --from ANEOS_forsterite.txt -o forsterite.h5\n"
    "eos table --from forsterite.h5 -f miluph -u log:1e4:1e9:300 -o forsterite.aneos",
    OPTS,
    0,
    0};

static void check_options(void)
{
  if (!o.material == !o.from) err_usage("--material or --from is wanted, one of them");
  if (o.u && o.temperature) err_usage("--u or --temperature, not both");
  if (o.material && !(o.rho && (o.u || o.temperature)))
    err_usage("a law needs --rho and --u or --temperature");
  if (o.material && !o.output) err_usage("--output is missing");
  if (o.from && o.rho && !(o.u || o.temperature)) err_usage("--rho needs --u or --temperature");
  if (o.from && !o.output && (o.rho || o.u || o.temperature || opt_given(&PROGRAM, "format")))
    err_usage("--output is missing");
}

/* The nodes that the options give; densities of `from` when there are none. */
static TabulateGrid grid(const Eos *law, const Table *from, Values *rho, Values *y)
{
  double at[2];
  TabulateGrid g;
  if (o.rho)
    *rho = values_read(o.rho, "kg/m^3", "--rho");
  else {
    rho->x = malloc((size_t)from->nrho * sizeof *rho->x), rho->n = from->nrho;
    if (!rho->x) err_die("no memory for %ld values", rho->n);
    memcpy(rho->x, from->rho, (size_t)rho->n * sizeof *rho->x);
  }
  *y = o.u ? values_read(o.u, "J/kg", "--u") : values_read(o.temperature, "K", "--temperature");
  if (rho->n > 100000 || y->n > 100000 || rho->n * y->n > 100000000)
    err_die("%ld x %ld nodes are too many", rho->n, y->n);
  for (int k = 0; law && k < tabulate_breaks(law, 0, at); k++) values_break(rho, at[k]);
  for (int k = 0; law && o.u && k < tabulate_breaks(law, 1, at); k++) values_break(y, at[k]);
  g = (TabulateGrid){rho->x, y->x, (int)rho->n, (int)y->n, !o.u};
  return g;
}

/* From a law; or, when the material is a table, from that. */
static void from_law(Table *t, Material *m)
{
  MaterialName name;
  Values rho = {NULL, 0, 0}, y = rho;
  TabulateGrid g;
  Err err;
  char *text = material_find(o.material, name, &err);
  int is_table;
  if (!text || material_parse(m, text, o.material, &err)) err_die("%s", err.text);
  is_table = m->eos.form == EOS_TABLE;
  g = grid(is_table ? NULL : &m->eos, NULL, &rho, &y);
  if (is_table ? tabulate_table(t, &m->eos.table, &g, &err) : tabulate_law(t, m, &g, &err))
    err_die("%s: %s", o.material, err.text);
  snprintf(t->about, sizeof t->about, "%s, %s law of breccia", name, o.u ? "rho-u" : "rho-T");
  free(text), free(rho.x), free(y.x);
}

static void from_file(Table *t)
{
  Values rho = {NULL, 0, 0}, y = rho;
  struct eos_table law = {.rho0 = 0};
  TabulateGrid g;
  Table old;
  Err err;
  if (tabfile_read(t, o.from, &err)) err_die("%s", err.text);
  if (t->repaired)
    err_warn("'%s': %d values that fell by less than 1e-3 along %s were raised", o.from,
             t->repaired, t->heat ? "T" : "u");
  if (!o.u && !o.temperature) return;
  old = *t;
  g = grid(NULL, &old, &rho, &y);
  if (table_law(&law, &old, &err) || tabulate_table(t, &law, &g, &err))
    err_die("%s: %s", o.from, err.text);
  snprintf(t->about, sizeof t->about, "%s", old.about);
  table_free(&old), table_law_free(&law), free(rho.x), free(y.x);
}

static void describe(const Table *t, const Material *m)
{
  struct eos_table e = {.rho0 = 0};
  const char *second = t->heat ? "T" : "u", *unit = t->heat ? "K" : "J/kg";
  double p, c, share;
  Err err;
  if (table_law(&e, t, &err)) err_die("%s", err.text);
  fprintf(stderr, "eos table: %s\n", *t->about ? t->about : "(no source)");
  fprintf(stderr, "eos table: %d x %d nodes, rho %g to %g kg/m^3, %s %g to %g %s\n", t->nrho, t->ny,
          t->rho[0], t->rho[t->nrho - 1], second, t->y[0], t->y[t->ny - 1], unit);
  if (e.rho0 > 0)
    fprintf(stderr, "eos table: at rest %.6g kg/m^3, %.6g m/s\n", e.rho0, sqrt(e.bulk / e.rho0));
  else
    fprintf(stderr, "eos table: a gas\n");
  if (m->eos.form != EOS_TABLE && o.material) {
    share = tabulate_error(&e, &m->eos, &p, &c);
    fprintf(
        stderr,
        "eos table: p and c are within 1e-4 of the law in the middle of %.2f %% of the cells; at "
        "most %.2g off in p, %.2g in c\n",
        100 * share, p, c);
  }
  table_law_free(&e);
}

int make_main(int argc, char **argv)
{
  static const Material none;
  Material m = none;
  Table t;
  Err err;
  int n;
  opt_parse(&PROGRAM, argc, argv, &n);
  check_options();
  if (o.from)
    from_file(&t);
  else
    from_law(&t, &m);
  if (o.output && tabfile_write(&t, o.output, unit_choice(o.format, TABFILE_FORMATS, &err), &err))
    err_die("%s", err.text);
  describe(&t, &m);
  table_free(&t), material_clear(&m);
  return 0;
}
