/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The quantity that is shown: one number a particle, from any field of the snapshot, known or not.
 */
#ifndef FIELD_H
#define FIELD_H

#include "lib/part.h"

/* field_column: not a field: mass per area along the line of sight, for projections. */
#define FIELD_COLUMN "ColumnDensity"

typedef struct {
  float *value;   /* [n], NULL for FIELD_COLUMN */
  int kinds;      /* the numbers name kinds (MaterialID, FragmentID ...) */
  char name[160]; /* as asked for */
  char unit[64];
} Field;

/* field_get: NAME (of a vector: its length), NAME.x .y .z, NAME.xx .xy ... of a tensor, |NAME|.
 * Errors: no such field (with the nearest), a known field that this file lacks (with the program
 * that makes it), no such component. */
int field_get(Field *f, const Parts *p, const char *what, const char *file, Err *err);
void field_free(Field *f);

#endif
