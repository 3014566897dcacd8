/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "field.h"

int field_get(Field *f, const Parts *p, const char *what, const char *file, Err *err)
{
  *f = (Field){0};
  snprintf(f->name, sizeof f->name, "%s", what), snprintf(f->unit, sizeof f->unit, "kg/m^2");
  if (!strcmp(what, FIELD_COLUMN)) return 0;
  Expr *e = expr_parse(what, err);
  if (!e || expr_bind(e, p, file, err)) return expr_free(e), -1;
  f->value = malloc((size_t)(p->n + 1) * sizeof *f->value);
  if (f->value)
    expr_eval_float(e, f->value);
  else
    err_set(err, "out of memory for %ld particles", p->n);
  f->kinds = expr_kinds(e);
  snprintf(f->unit, sizeof f->unit, "%s", expr_unit(e));
  expr_free(e);
  return f->value ? 0 : -1;
}

void field_free(Field *f)
{
  free(f->value);
  f->value = NULL;
}
