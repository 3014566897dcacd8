/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run: a directory that fills with snapshots, conserved.tsv, run.h5part, run.log and checkpoints;
 * stopped by a signal or a wall clock it leaves a checkpoint, and continues from there bit for bit.
 */
#ifndef RUN_H
#define RUN_H

#include "sim.h"

typedef struct {
  const char *dir;
  const char *device;
  const char *command; /* for /History */
  double end, every;   /* s; every: simulated time between snapshots */
  double max_wall;     /* s, or INFINITY */
  int restart;         /* continue from DIR/checkpoint.h5 when it is there */
  int profile;         /* print the table of passes at the end */
} RunOptions;

/* run_system: parts from their own time to the end. Returns 0 when done, 3 when stopped and
 * resumable, -1 on error. */
int run_system(const RunOptions *o, const Param *par, Parts *parts, Err *err);

#endif
