/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The particle fields of a snapshot as columns of numbers, the same for all formats that only show
 * them: schema first, then what the schema does not know. */
#ifndef SHEET_H
#define SHEET_H

#include <hdf5.h>
#include "lib/opt.h"
#include "lib/part.h"

typedef struct {
  const char *name, *unit, *meaning;
  const void *data; /* [n][width] */
  hid_t type;       /* native; not to be closed */
  int width, size;  /* numbers a row, bytes a number */
  char kind;        /* 'f' real, 'i' signed, 'u' unsigned */
} SheetColumn;

typedef struct {
  SheetColumn *column;
  int columns;
} Sheet;

/* sheet_new: the columns of p that `fields` names, all without one (NULL or of length 0); those of
 * /PartType0 with names and types as in the file, FlawCount too. Errors: no such field. Says which
 * fields are no plain numbers and are left out. sheet_free: the columns; their data are p's. */
Sheet *sheet_new(const Parts *p, const OptList *fields, Err *err);
void sheet_free(Sheet *s);

/* sheet_part: what component k of a column is called: NAME, NAME_x, NAME_xy ..., NAME_0. */
const char *sheet_part(const SheetColumn *c, int k, char *buf, int size);

/* sheet_find: the column of that name, or NULL. */
const SheetColumn *sheet_find(const Sheet *s, const char *name);

#endif
