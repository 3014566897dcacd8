/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One number a particle out of any field of a snapshot, known to the schema or not: a scalar, a
 * component, or the length of a vector or tensor. */
#ifndef COLUMN_H
#define COLUMN_H

#include "part.h"

typedef struct {
  const char *name, *unit; /* of the dataset */
  const void *data;        /* [n][width] */
  double *own;             /* data that were converted; released by column_free */
  char kind;               /* 'd' double, 'l' int64_t, 'i' int32_t */
  int width;
  int part;  /* component; -1: the length, of a scalar itself */
  int kinds; /* the numbers name kinds (MaterialID, FragmentID ...) */
} Column;

/* column_get: name of a dataset; component "x" "y" "z" of a vector, "xx" "xy" "xz" "yy" "yz" "zz"
 * of a tensor, or NULL. Errors: no such field (with the nearest, or the nearest of `more`,
 * NULL-terminated, which may be NULL), a known field that `file` lacks (with the program that makes
 * it), no such component, not numbers. */
int column_get(Column *c, const Parts *p, const char *name, const char *component,
               const char *const *more, const char *file, Err *err);
void column_free(Column *c);

/* column_read: the values of particles from .. from+n-1. The length of a symmetric tensor is
 * sqrt(S:S), where the elements off the diagonal count twice. */
void column_read(const Column *c, long from, int n, double *out);

#endif
