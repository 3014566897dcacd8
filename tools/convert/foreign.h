/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particle files of other codes: a table says what each of their datasets is here. */
#ifndef FOREIGN_H
#define FOREIGN_H

#include <hdf5.h>
#include "lib/part.h"

/* Factors from the file's units to SI. */
typedef struct {
  double length, mass, time, temperature;
} ForeignUnits;

typedef struct {
  const char *theirs;
  const char *ours; /* a member of Parts, "+Name" for a field outside the schema, or NULL: not
                       carried over, because of `why` (NULL: read elsewhere) */
  const char *why;  /* for "+Name": its SI unit */
  int length, mass, time, temperature; /* powers of the units */
} ForeignRow;

/* foreign_read: the datasets of `loc` (rows by particle) that the table [rows] names into p, whose
 * n is set; of several for one member the first counts. Vectors of one or two components get
 * zeros; full tensors and xx xy xz yy yz become the schema's six components. Says which datasets
 * were not carried over. */
int foreign_read(hid_t loc, const ForeignRow *table, int rows, const ForeignUnits *units, Parts *p,
                 Err *err);

/* foreign_one: one row of such a table. */
int foreign_one(hid_t loc, const ForeignRow *row, const ForeignUnits *units, Parts *p, Err *err);

/* foreign_numbers: one dataset as doubles [n][*width], malloc'ed; NULL with err empty when it is
 * not there. */
double *foreign_numbers(hid_t loc, const char *name, long n, int *width, Err *err);

/* foreign_rows: rows of a dataset, and its columns (1 for a list); -1 on error. */
long foreign_rows(hid_t loc, const char *name, int *width, Err *err);

/* foreign_tensor: a full tensor [dimension^2] into the six components of a symmetric traceless one,
 * and back. In less than three dimensions zz = -(xx + yy). */
void foreign_tensor(const double *full, int dimension, double s[6]);
void foreign_full(const double s[6], int dimension, double *full);

#endif
