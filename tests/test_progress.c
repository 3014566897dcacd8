/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Progress where stderr is no terminal: plain lines, not too often, and a time to go that a resumed
 * run does not spoil. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "lib/err.h"
#include "lib/progress.h"

static int saved, reader;

static int catch_stderr(void **state)
{
  int ends[2];
  (void)state;
  if (pipe(ends)) return -1;
  saved = dup(STDERR_FILENO);
  reader = ends[0];
  dup2(ends[1], STDERR_FILENO);
  close(ends[1]);
  err_program("run");
  return 0;
}

/* What was printed since catch_stderr. */
static const char *printed(void)
{
  static char text[1024];
  ssize_t n;
  dup2(saved, STDERR_FILENO);
  close(saved);
  n = read(reader, text, sizeof text - 1);
  text[n > 0 ? n : 0] = 0;
  close(reader);
  return text;
}

/* 10 s for the last 10 % of the work leave 40 % for 40 s. */
static void time_to_go(void **state)
{
  Progress p;
  (void)state;
  progress_start(&p, "impact", 0);
  p.first = 0.5; /* resumed at half of the work, 10 s ago */
  p.started -= 10;
  progress_show(&p, 0.6, "t = 3 h");
  progress_end(&p);
  assert_string_equal(printed(), "run: impact 60.0 %, t = 3 h, 40 s to go\n");
}

static void not_too_often(void **state)
{
  Progress p;
  (void)state;
  progress_start(&p, "impact", 30);
  for (int k = 0; k < 1000; k++) progress_show(&p, 1e-3 * k, "");
  p.shown -= 31;
  progress_show(&p, 0.25, "");
  progress_show(&p, 0.26, "");
  const char *line = strstr(printed(), "run: impact 25.0 %");
  assert_non_null(line);
  assert_string_equal(strchr(line, '\n'), "\n");
}

static void nothing_known_yet(void **state)
{
  Progress p;
  (void)state;
  progress_start(&p, "impact", 0);
  progress_show(&p, 0, "");
  assert_string_equal(printed(), "run: impact 0.0 %\n");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup(time_to_go, catch_stderr),
      cmocka_unit_test_setup(not_too_often, catch_stderr),
      cmocka_unit_test_setup(nothing_known_yet, catch_stderr),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
