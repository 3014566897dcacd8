/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a run writes into its directory. Everything except run.log is a function of the input and
 * the settings alone. */
#ifndef OUTPUT_H
#define OUTPUT_H

#include <stdio.h>
#include "archive.h"
#include "sim.h"
#include "writer.h"

typedef struct {
  char dir[3072];
  double start, every, end; /* s */
  long next;                /* index of the next snapshot */
  FILE *conserved, *log;
  double outside[3], most_outside; /* particles outside their tables: at the last look; ever */
  double most_held[2];             /* particles with the smallest, the largest h, ever */
  Writer writer;
  Archive archive; /* of what has left */
  /* What the writer is at: a snapshot or a checkpoint, of this state. */
  Sim *sim;
  Parts *parts;
  long index, step;
  double time; /* s */
} Output;

/* output_claim: makes the directory if need be and opens run.log there, locked: one solver a
 * directory. The kernel lets go of the lock when the process ends, however it does. */
int output_claim(Output *o, const char *dir, Err *err);

/* output_open: a fresh run in the directory claimed. output_resume: one that is continued: lines of
 * conserved.tsv behind the checkpoint are dropped. */
int output_open(Output *o, double start, double every, double end, Err *err);
int output_resume(Output *o, double start, double every, double end, const Sim *sim, Err *err);
void output_close(Output *o);

/* output_table: opens a table of the run directory to read and to append to: a new one with this
 * header line (step < 0), or what is there of a run that is continued, its lines behind `step` (the
 * first column) dropped. */
int output_table(const Output *o, const char *name, const char *header, long step, FILE **table,
                 Err *err);

/* output_due: the time of the next snapshot [s]. */
double output_due(const Output *o);

/* output_conserved: a line of sums, which it hands back; done is the step just made, or NULL at the
 * start. Particles outside their tables are counted, and said in the log when there are others than
 * before; so are the first with the smallest or largest h. */
int output_conserved(Output *o, Sim *sim, const SimStep *done, Sums *sums, Err *err);

/* output_snapshot: snap_NNNN.h5, and run.h5part anew. output_checkpoint: checkpoint.h5; when it is
 * whole, the one before becomes checkpoint_prev.h5. Both are begun only: the present state is
 * written while the run goes on, one file at a time and in order. Until then parts are the
 * writer's. output_look: whether what was begun has failed by now; output_wait: until it is done.
 */
int output_snapshot(Output *o, Sim *sim, Parts *parts, Err *err);
int output_checkpoint(Output *o, Sim *sim, Parts *parts, Err *err);
int output_look(Output *o, Err *err);
int output_wait(Output *o, Err *err);

/* output_find_checkpoint: reads checkpoint.h5, or checkpoint_prev.h5 when that is missing or
 * broken; *found is NULL when there is none at all. */
int output_find_checkpoint(const char *dir, Parts **found, Err *err);
int output_has_checkpoint(const char *dir);
int output_in_use(const char *dir);

/* output_log: a line of run.log. */
void output_log(Output *o, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
