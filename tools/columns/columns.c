/* SPDX-License-Identifier: GPL-3.0-or-later */
/* columns: expressions of the particles' fields as a table, for awk, gnuplot and spreadsheets. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/expr.h"
#include "lib/opt.h"
#include "lib/snap.h"

enum { MOST = 64 };

static struct {
  OptList of;
  const char *where;
  long digits, every;
} o;

/* clang-format off */
static const Opt OPTS[] = {
  {"of",     'f', OPT_LIST, NULL, "EXPR", "a column (may be repeated)", &o.of},
  {"where",  'w', OPT_TEXT, NULL, "EXPR", "rows only of particles for which this is not 0", &o.where},
  {"every",  'e', OPT_INT,  "1",  "N",    "every N-th of these", &o.every},
  {"digits", 'd', OPT_INT,  "9",  "N",    "significant digits, 1 to 17", &o.digits},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "columns", "print fields of the particles", "[options] [snapshot.h5] > table.tsv",
  "One row a particle, in the order of the file; SI. Expressions are of datasets (Density, Velocities.x), numbers with units, + - * "
  "/ ^, comparisons, functions (sqrt, if(condition, a, b) ...).",
  "columns -f Coordinates.x -f 'Pressure/1GPa' -w \"MaterialID == 'ice'\" run/snap_0100.h5", OPTS, 0, 1};
/* clang-format on */

/* What the expressions need of the file: all of it when one is of a field that the schema does not
 * know. */
static Parts *load(const char *file, Expr *const *e, int n, const Expr *where, Err *err)
{
  char members[1024] = "id";
  int all = 0;
  for (int k = 0; k < n + !!where; k++)
    all |= expr_members(k < n ? e[k] : where, members, sizeof members);
  return all ? snap_read(file, err) : snap_read_some(file, members, err);
}

static void print(const Parts *p, double *const *value, int n, const unsigned char *rows)
{
  long seen = 0;
  for (long i = 0; i < p->n; i++) {
    if ((rows && !rows[i]) || seen++ % o.every) continue;
    for (int k = 0; k < n; k++)
      printf("%.*g%c", (int)o.digits, value[k][i], k + 1 < n ? '\t' : '\n');
  }
}

int main(int argc, char **argv)
{
  int n;
  char **input = opt_parse(&PROGRAM, argc, argv, &n);
  const char *file = n ? input[0] : "-";
  Expr *e[MOST], *where = NULL;
  double *value[MOST];
  unsigned char *rows = NULL;
  Err err;
  if (!o.of.n) err_usage("which columns? give --of EXPR");
  if (o.of.n > MOST) err_usage("more than %d columns", MOST);
  if (o.digits < 1 || o.digits > 17) err_usage("--digits %ld is not in 1..17", o.digits);
  if (o.every < 1) err_usage("--every %ld is not positive", o.every);
  for (int k = 0; k < o.of.n; k++)
    if (!(e[k] = expr_parse(o.of.text[k], &err))) err_usage("%s", err.text);
  if (o.where && !(where = expr_parse(o.where, &err))) err_usage("%s", err.text);
  Parts *p = load(file, e, o.of.n, where, &err);
  if (!p) err_die("%s", err.text);
  if (where && !(rows = expr_select(o.where, p, file, &err))) err_die("%s", err.text);
  for (int k = 0; k < o.of.n; k++) {
    if (expr_bind(e[k], p, file, &err)) err_die("%s", err.text);
    if (!(value[k] = malloc((size_t)(p->n ? p->n : 1) * sizeof *value[k])))
      err_die("no memory for %ld numbers", p->n);
    expr_eval(e[k], value[k]);
    printf("%s%s [%s]%s", k ? "" : "# ", o.of.text[k], expr_unit(e[k]),
           k + 1 < o.of.n ? "\t" : "\n");
  }
  print(p, value, o.of.n, rows);
  err_close_stdout();
  for (int k = 0; k < o.of.n; k++) expr_free(e[k]), free(value[k]);
  expr_free(where), free(rows), part_free(p), free(o.of.text);
  return 0;
}
