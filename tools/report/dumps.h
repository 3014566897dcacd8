/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a run directory holds. */
#ifndef DUMPS_H
#define DUMPS_H

#include "lib/err.h"

typedef struct {
  char dir[3072]; /* "": a snapshot alone */
  char **file;    /* [n] snapshots by name, with their folder */
  int n;
  char *log;             /* run.log, "" when it is not there */
  double steps, seconds; /* all parts of the run; NAN: the log does not say */
} Dumps;

/* dumps_find: a run directory, or one snapshot. Errors: neither. */
int dumps_find(Dumps *d, const char *path, Err *err);
void dumps_free(Dumps *d);

/* dumps_has: whether the run directory has a file; its path. */
int dumps_has(const Dumps *d, const char *name, char *path, int size);

#endif
