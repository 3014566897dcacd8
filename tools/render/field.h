/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The quantity that is shown: one number a particle, from an expression of the snapshot's fields.
 */
#ifndef FIELD_H
#define FIELD_H

#include "lib/expr.h"

/* FIELD_COLUMN: not a field: mass per area along the line of sight, for projections. */
#define FIELD_COLUMN "ColumnDensity"

typedef struct {
  float *value;   /* [n], NULL for FIELD_COLUMN */
  int kinds;      /* the numbers name kinds (MaterialID, FragmentID ...) */
  char name[160]; /* as asked for */
  char unit[96];
} Field;

/* field_get: what is an expression (see lib/expr.h), or FIELD_COLUMN. */
int field_get(Field *f, const Parts *p, const char *what, const char *file, Err *err);
void field_free(Field *f);

#endif
