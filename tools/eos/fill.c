/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A material without a heat capacity has NAN, one without phases 0. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "../../lib/material.h"
#include "../../lib/opt.h"
#include "../../lib/snap.h"
#include "../../lib/thermal.h"
#include "fill.h"

static const char *output;

/* clang-format off */
static const Opt OPTS[] = {
  {"output", 'o', OPT_TEXT, "-", "FILE", "the snapshot with its new fields", &output},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};
/* clang-format on */

static const OptProgram PROGRAM = {
    "eos fill",
    "add temperature, entropy and phase to a snapshot",
    "[options] snap.h5 > filled.h5",
    "Writes Temperature (unless the strength of the material has one of its own), Entropy and "
    "PhaseID "
    "from density and energy: of a table its own, else as its law and its heat_capacity have them.",
    "eos fill run/snap_0100.h5 -o hot.h5 && render hot.h5 --color Temperature -o hot.png",
    OPTS,
    0,
    1};

/* The values of a field that the schema does not have, new or there. */
static double *field(Parts *p, const char *name, const char *unit, const char *meaning)
{
  double *x;
  Err err;
  for (int k = 0; k < p->extras; k++)
    if (!strcmp(p->extra[k].name, name)) {
      if (p->extra[k].size != sizeof *x || p->extra[k].width != 1)
        err_die("the field '%s' is there, but not of one double a particle", name);
      return (double *)(void *)p->extra[k].data;
    }
  if (!(x = part_add_extra(p, name, unit, meaning, &err))) err_die("%s", err.text);
  return x;
}

static void fill(Parts *p, const Material *material)
{
  double *s = field(p, "Entropy", "J/K/kg", "specific entropy (eos fill)");
  double *phase = field(p, "PhaseID", "1", "phase in the table of the material, 0: unknown");
#pragma omp parallel for schedule(dynamic, 256)
  for (long i = 0; i < p->n; i++) {
    const Material *m = &material[p->mat[i]];
    if (!material_heats(m)) p->T[i] = thermal_temperature(m, p->rho[i], p->u[i]);
    s[i] = thermal_entropy(m, p->rho[i], p->u[i]);
    phase[i] = m->eos.form == EOS_TABLE
                   ? eos_table_state(&m->eos.table, p->rho[i], EOS_TABLE_U, p->u[i]).phase
                   : 0;
  }
}

int fill_main(int argc, char **argv)
{
  char *line = opt_command_line(argc, argv);
  int n;
  char **input = opt_parse(&PROGRAM, argc - 1, argv + 1, &n);
  const char *file = n ? input[0] : "-";
  Material *material;
  Parts *p;
  Err err;
  if (!(p = snap_read(file, &err)) || part_need(p, "rho u mat", file, &err) ||
      part_check(p, file, &err) || part_add(p, "T", &err) || !(material = material_load(p, &err)))
    err_die("%s", err.text);
  fill(p, material);
  if (part_history(p, line, &err) || snap_write(p, output, 0, &err)) err_die("%s", err.text);
  material_free(material, p->materials), part_free(p), free(line);
  return 0;
}
