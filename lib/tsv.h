/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables as the programs print them: tab-separated rows, comments that begin with #, the last of
 * them before the first row naming the columns, each as `name [unit]` or `name[unit]`. */
#ifndef TSV_H
#define TSV_H

#include "err.h"

typedef struct {
  char label[256]; /* the file, for messages */
  char *text;
  int columns;
  long rows;
  char **name, **unit; /* [columns]; unit "" where none is said */
  char **cell;         /* [rows][columns] */
  long *line;          /* [rows] in the file */
} Tsv;

/* tsv_read: path, or "-" for stdin. Errors: no line that names columns, a row with another number
 * of them; `file:line: ...`. A table without rows is none. */
int tsv_read(Tsv *t, const char *path, Err *err);
void tsv_free(Tsv *t);

/* tsv_column: the index of a column by its name, or -1 and the nearest. */
int tsv_column(const Tsv *t, const char *name, Err *err);

/* tsv_numbers: a column as numbers, [rows], malloc'ed; nan and inf are numbers. NULL on error. */
double *tsv_numbers(const Tsv *t, const char *name, Err *err);

#endif
