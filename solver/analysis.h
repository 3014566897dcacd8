/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bound bodies while the run goes on: bound.tsv, a line at the first step at or after each multiple
 * of analysis.every, by the library that clumps uses, and whether their masses have come to rest.
 * The run itself is not touched: its steps are those of a run without. What is decided is decided
 * from the numbers as written, so a run that is continued decides the same. */
#ifndef ANALYSIS_H
#define ANALYSIS_H

#include "output.h"

enum { ANALYSIS_TOP = 3 }; /* bodies that have columns of their own */

typedef struct {
  double time, virial, total, bound, mass[ANALYSIS_TOP]; /* s, 1, kg; masses nan: not searched */
  long step, bodies, n[ANALYSIS_TOP];
} AnalysisRow;

typedef struct {
  FILE *table;
  double start; /* s, of the run */
  long next;    /* multiple of analysis.every that is due next */
  AnalysisRow *last;
  long lines; /* counted for `converged`; line k is last[k % window] */
} Analysis;

/* analysis_open: bound.tsv of a fresh run; analysis_resume: of one that is continued, lines behind
 * the checkpoint dropped. Nothing is opened when analysis.every is 0. */
int analysis_open(Analysis *a, const Output *o, const Sim *sim, Err *err);
int analysis_resume(Analysis *a, const Output *o, const Sim *sim, Err *err);
void analysis_close(Analysis *a);

/* analysis_due: whether a line is. analysis_line: writes it; parts hold the present state. */
int analysis_due(const Analysis *a, const Sim *sim);
int analysis_line(Analysis *a, const Sim *sim, const Parts *parts, Err *err);

/* analysis_converged: whether the last analysis.window lines agree. */
int analysis_converged(const Analysis *a, const Param *par);

/* analysis_measure: one row from particles. */
int analysis_measure(AnalysisRow *row, const Param *par, const Parts *parts, Err *err);

#endif
