/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What particles of another code lack here: ids, bodies, names of their materials. */
#ifndef ADOPT_H
#define ADOPT_H

#include "lib/opt.h"
#include "lib/part.h"

typedef struct {
  const OptList *material; /* NUMBER:NAME */
  long second_body;        /* ids from this one on are body 1; negative: all are body 0 */
  double support;          /* h is this times the file's smoothing length */
  int swift;               /* its numbers of materials are known */
} AdoptOptions;

/* adopt_rows: scales h, gives ids by the order of rows where there are none, and leaves out what
 * the code had taken out of the calculation (no material, no size). Returns p or another; NULL on
 * error, p freed. */
Parts *adopt_rows(Parts *p, const AdoptOptions *o, Err *err);

/* adopt_snapshot: bodies and materials too, so that p is a valid snapshot. `file` for messages. */
int adopt_snapshot(Parts *p, const AdoptOptions *o, const char *file, Err *err);

#endif
