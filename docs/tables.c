/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the tables of docs/ that live in headers: `tables schema` the particle fields, `tables laws` the parameters of the
 * material laws, `tables tables` the fields of tables of equations of state. Compiled and run by docs/generate. */
#include <stdio.h>
#include <string.h>
#include "../lib/fields.h"
#include "../lib/table.h"
#include "../physics/material.h"

#define FIELD(TYPE, MEMBER, WIDTH, DATASET, UNIT, MADE_BY, MEANING)                                \
  field(DATASET, WIDTH, #TYPE, UNIT, MADE_BY, MEANING);
#define POINT(TYPE, MEMBER, DIM, WIDTH, DATASET, UNIT, MEANING)                                    \
  printf("| `%s` | %s | %s | %s | %s |\n", DATASET, (WIDTH) > 1 ? "(K, 3)" : "(K)",               \
         !strcmp(#TYPE, "double") ? "float64" : !strcmp(#TYPE, "int64_t") ? "int64" : "int32",     \
         UNIT, MEANING);
#define ROW(MEMBER, UNIT, VALUE, MIN, MAX, MEANING) row(#MEMBER, UNIT, VALUE, MIN, MAX, MEANING);
#define OWN_ROW(KEY, MEMBER, UNIT, VALUE, MIN, MAX, MEANING)                                       \
  row(#KEY, UNIT, VALUE, MIN, MAX, MEANING);
#define EOS_ROW_TABLE(CAPITAL, NAME)      law("eos", #NAME), EOS_##CAPITAL##_ROWS(ROW);
#define YIELD_ROW_TABLE(CAPITAL, NAME)    law("strength", #NAME), YIELD_##CAPITAL##_ROWS(ROW);
#define DAMAGE_ROW_TABLE(CAPITAL, NAME)   law("damage", #NAME), DAMAGE_##CAPITAL##_ROWS(ROW);
#define POROSITY_ROW_TABLE(CAPITAL, NAME) law("porosity", #NAME), POROSITY_##CAPITAL##_ROWS(ROW);

static void field(const char *dataset, int width, const char *type, const char *unit,
                  const char *made_by, const char *meaning)
{
  char shape[16] = "(N)";
  if (width > 1) snprintf(shape, sizeof shape, "(N, %d)", width);
  type = strcmp(type, "double") ? type : "float64";
  printf("| `%s` | %s | %.*s | %s | %s | %s |\n", dataset, shape, (int)strcspn(type, "_"), type,
         unit, made_by, meaning);
}

static void row(const char *name, const char *unit, const char *value, double min, double max,
                const char *meaning)
{
  printf("| `%s` | %s | %s | ", name, unit, value ? value : "");
  if (min <= max) printf("%g .. %g", min, max);
  printf(" | %s |\n", meaning);
}

static void table(void)
{
  printf("\n| key | unit | default | range | meaning |\n|---|---|---|---|---|\n");
}

static void law(const char *group, const char *form)
{
  printf("\n### %s: `form = \"%s\"`\n", group, form);
  table();
}

static void schema(void)
{
  static const char HEAD[] = "| dataset | shape | type | unit | made by | meaning |\n"
                             "|---|---|---|---|---|---|";
  printf("## Particle fields, `/PartType0`\n\n%s\n", HEAD);
  FIELDS(FIELD)
  printf("\n## Only in checkpoints\n\n%s\n", HEAD);
  CHECKPOINT_FIELDS(FIELD)
  printf("\n## Point masses, `/PointMasses`\n\nOne row each; stars, planets and sinks of a run.\n\n"
         "| dataset | shape | type | unit | meaning |\n|---|---|---|---|---|\n");
  POINTMASS_FIELDS(POINT)
}

#define TABLE_ROW(CAPITAL, NAME, UNIT, MEANING)                                                    \
  printf("| `%s` | %s | %s |\n", #NAME, UNIT, MEANING);
static void tables(void)
{
  printf("| dataset | unit | meaning |\n|---|---|---|\n");
  TABLE_FIELDS(TABLE_ROW)
}

static void laws(void)
{
  EOS_LAWS(EOS_ROW_TABLE)
  printf("\n### eos: with every law\n");
  table();
  MATERIAL_EOS_ROWS(OWN_ROW)
  printf("\n### strength: with every law\n");
  table();
  MATERIAL_STRENGTH_ROWS(OWN_ROW)
  YIELD_LAWS(YIELD_ROW_TABLE)
  DAMAGE_LAWS(DAMAGE_ROW_TABLE)
  printf("\n### porosity: with every law\n");
  table();
  MATERIAL_POROSITY_ROWS(OWN_ROW)
  POROSITY_LAWS(POROSITY_ROW_TABLE)
}

int main(int argc, char **argv)
{
  if (argc == 2 && !strcmp(argv[1], "schema"))
    schema();
  else if (argc == 2 && !strcmp(argv[1], "tables"))
    tables();
  else if (argc == 2 && !strcmp(argv[1], "laws"))
    laws();
  else
    return 2;
  return fflush(stdout) ? 1 : 0;
}
