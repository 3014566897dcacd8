/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program's name is the one thing kept; it is set once at start-up. */
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "err.h"

static char program_name[64] = "breccia";

static void format_into(Err *e, const char *format, va_list args)
{
  if (e) vsnprintf(e->text, sizeof e->text, format, args);
}

int err_set(Err *e, const char *format, ...)
{
  va_list args;
  va_start(args, format);
  format_into(e, format, args);
  va_end(args);
  return -1;
}

void *err_null(Err *e, const char *format, ...)
{
  va_list args;
  va_start(args, format);
  format_into(e, format, args);
  va_end(args);
  return NULL;
}

void err_program(const char *argv0)
{
  const char *slash = strrchr(argv0, '/');
  snprintf(program_name, sizeof program_name, "%s", slash ? slash + 1 : argv0);
}

const char *err_name(void) { return program_name; }

/* One line, in one write where the system allows: `program: kind message tail`. */
static void say(const char *kind, const char *format, va_list args, const char *tail)
{
  Err e;
  format_into(&e, format, args);
  fflush(stdout);
  fprintf(stderr, "%s: %s%s%s\n", program_name, kind, e.text, tail);
}

void err_die(const char *format, ...)
{
  va_list args;
  va_start(args, format);
  say("", format, args, "");
  va_end(args);
  exit(ERR_FAILED);
}

void err_usage(const char *format, ...)
{
  va_list args;
  va_start(args, format);
  say("", format, args, " (see --help)");
  va_end(args);
  exit(ERR_USAGE);
}

void err_warn(const char *format, ...)
{
  va_list args;
  va_start(args, format);
  say("warning: ", format, args, "");
  va_end(args);
}

/* A stdout that was closed from the start (EBADF) is no loss as long as nothing was written to it.
 */
void err_close_stdout(void)
{
  int lost = ferror(stdout);
  errno = lost ? EIO : 0;
  if (fflush(stdout) || lost) err_die("cannot write to stdout: %s", strerror(errno));
  if (fclose(stdout) && errno != EBADF) err_die("cannot write to stdout: %s", strerror(errno));
}
