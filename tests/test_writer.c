/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The writer: a job runs beside its starter, one at a time; its failure is told once, to whoever
 * looks after it has ended; signals do not reach it. */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <time.h>
#include <cmocka.h>
#include "../solver/writer.h"

typedef struct {
  atomic_int go, began, interrupted;
  int result;
} Job;

static void nap(void)
{
  const struct timespec t = {0, 1000000};
  nanosleep(&t, NULL);
}

/* Ends when it is told to. */
static int job(void *data, Err *err)
{
  Job *j = data;
  sigset_t mask;
  pthread_sigmask(SIG_SETMASK, NULL, &mask);
  j->interrupted = !sigismember(&mask, SIGTERM);
  j->began = 1;
  while (!j->go) nap();
  return j->result ? err_set(err, "the disk is full") : 0;
}

static void beside(void **state)
{
  Writer w = {0};
  Job j = {.result = 0};
  Err err;
  (void)state;
  assert_int_equal(writer_wait(&w, &err), 0); /* nothing to wait for */
  assert_int_equal(writer_start(&w, job, &j, &err), 0);
  while (!j.began) nap();
  assert_int_equal(writer_look(&w, &err), 0);
  assert_true(w.busy);
  j.go = 1;
  assert_int_equal(writer_wait(&w, &err), 0);
  assert_false(w.busy);
  assert_false(j.interrupted);
}

static void failure(void **state)
{
  Writer w = {0};
  Job j = {.result = -1};
  Err err = {""};
  (void)state;
  assert_int_equal(writer_start(&w, job, &j, &err), 0);
  assert_int_equal(writer_look(&w, &err), 0);
  j.go = 1;
  while (!w.ended) nap();
  assert_int_equal(writer_look(&w, &err), -1);
  assert_string_equal(err.text, "the disk is full");
  assert_int_equal(writer_look(&w, &err), 0);
  j.result = 0;
  assert_int_equal(writer_start(&w, job, &j, &err), 0);
  assert_int_equal(writer_wait(&w, &err), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(beside), cmocka_unit_test(failure)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
