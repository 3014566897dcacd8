/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "choose.h"
#include "material.h"
#include "unit.h"

int choose_material(const Parts *p, const char *name, Err *err)
{
  const char **names = calloc((size_t)p->materials + 1, sizeof *names);
  if (!names) return err_set(err, "out of memory");
  int found = -1;
  for (int c = 0; c < p->materials; c++) {
    names[c] = p->material[c].name;
    if (found < 0 && !strcmp(names[c], name)) found = c;
  }
  const char *near = found < 0 ? unit_nearest(name, names, p->materials) : NULL;
  if (found < 0)
    err_set(err, "no material '%s' in this file%s%s%s", name, near ? " (did you mean '" : "",
            near ? near : "", near ? "'?)" : "");
  free(names);
  return found;
}

/* kg/m^3, or relative to rho0. */
static int density(const char *text, double *number, int *relative, Err *err)
{
  const char *suffix;
  if (unit_suffix(text, number, &suffix, err)) return -1;
  *relative = !strcmp(suffix, "rho0");
  return *relative ? 0 : unit_parse(text, "kg/m^3", number, err);
}

static int one_word(const Parts *p, const char *word, double *limit, Err *err)
{
  const char *colon = strchr(word, ':');
  char name[64] = "";
  double number;
  int relative, only = -1;
  if (colon && colon - word < (long)sizeof name) memcpy(name, word, (size_t)(colon - word));
  if (colon && (only = choose_material(p, name, err)) < 0) return -1;
  if (density(colon ? colon + 1 : word, &number, &relative, err)) return -1;
  Material *material = relative ? material_load(p, err) : NULL;
  if (relative && !material) return -1;
  for (int c = 0; c < p->materials; c++)
    if (only < 0 || only == c) limit[c] = number * (relative ? eos_rho0(&material[c].eos) : 1);
  material_free(material, p->materials);
  return 0;
}

double *choose_densities(const Parts *p, const OptList *words, Err *err)
{
  double *limit = calloc((size_t)p->materials + 1, sizeof *limit);
  if (!limit) return err_null(err, "out of memory");
  for (int k = 0; k < words->n; k++)
    if (one_word(p, words->text[k], limit, err)) return free(limit), NULL;
  return limit;
}
