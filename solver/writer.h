/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One job at a time in a thread of its own: writing a file while the run goes on. HDF5 is not made
 * for threads: while a job is under way nobody else may call it. Zero a Writer before its first
 * use. */
#ifndef WRITER_H
#define WRITER_H

#include <pthread.h>
#include <stdatomic.h>
#include "../lib/err.h"

typedef struct {
  pthread_t thread;
  int busy;         /* a thread is to be joined */
  atomic_int ended; /* and has nothing left to do */
  int (*job)(void *data, Err *err);
  void *data;
  Err err;
  int failed;
} Writer;

/* writer_start: job(data) in its thread; the one before must have been waited for. A job returns 0,
 * or -1 with a message. */
int writer_start(Writer *w, int (*job)(void *data, Err *err), void *data, Err *err);

/* writer_wait: until the job, if there is one, has ended; its result. writer_look: the same for a
 * job that has ended already, else 0. */
int writer_wait(Writer *w, Err *err);
int writer_look(Writer *w, Err *err);

#endif
