/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a report says of a run directory, or of snapshots, beside what it is given. */
#ifndef PAGE_H
#define PAGE_H

#include "lib/opt.h"

typedef struct {
  const char *title, *input;    /* input: run directory or snapshot, NULL: only what is given */
  OptList picture, table, text; /* FILE or FILE:CAPTION */
  long frames, rows;
  int only; /* what is given, nothing drawn or searched */
} PageAsk;

/* page_write: the whole page, malloc'ed. Pictures and tables are made by render, conserved, fof,
 * clumps and histo, in a temporary folder that is gone afterwards. */
char *page_write(const PageAsk *ask, Err *err);

#endif
