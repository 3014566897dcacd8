/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What was reached, as lines for a person and as a table. */
#ifndef REPORT_H
#define REPORT_H

#include "body.h"
#include "measure.h"

typedef struct {
  char text[4096]; /* the table: a header, one row a run */
} Report;

/* report_run: a line on stderr and a row: `name` of the row, `what` of the line, after a run of
 * `time` [s]. */
void report_run(Report *r, const char *name, const char *what, const Body *b, const Measure *m,
                double time);

#endif
