/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A thread a job; signals stay with the run. */
#include <signal.h>
#include <string.h>
#include "writer.h"

static void *work(void *data)
{
  Writer *w = data;
  w->failed = w->job(w->data, &w->err) != 0;
  atomic_store(&w->ended, 1);
  return NULL;
}

int writer_start(Writer *w, int (*job)(void *data, Err *err), void *data, Err *err)
{
  sigset_t all, before;
  int bad;
  w->job = job, w->data = data, w->failed = 0;
  atomic_store(&w->ended, 0);
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  bad = pthread_create(&w->thread, NULL, work, w);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  if (bad) return err_set(err, "cannot start a thread: %s", strerror(bad));
  w->busy = 1;
  return 0;
}

int writer_wait(Writer *w, Err *err)
{
  if (!w->busy) return 0;
  pthread_join(w->thread, NULL);
  w->busy = 0;
  return w->failed ? err_set(err, "%s", w->err.text) : 0;
}

int writer_look(Writer *w, Err *err)
{
  return w->busy && atomic_load(&w->ended) ? writer_wait(w, err) : 0;
}
