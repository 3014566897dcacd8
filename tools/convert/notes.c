/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include "lib/err.h"
#include "notes.h"

static const char *about = "";
static int quiet;

void notes_about(const char *file)
{
  const char *slash = file ? strrchr(file, '/') : NULL;
  about = slash ? slash + 1 : file && strcmp(file, "-") ? file : "stdin";
}

void notes_quiet(void) { quiet = 1; }

void notes_say(const char *format, ...)
{
  va_list args;
  if (quiet) return;
  fprintf(stderr, "%s: %s: ", err_name(), about);
  va_start(args, format);
  vfprintf(stderr, format, args);
  va_end(args);
  fputc('\n', stderr);
}

void notes_add(NotesList *list, const char *name)
{
  size_t used = strlen(list->text), left = sizeof list->text - used;
  int length = snprintf(list->text + used, left, "%s%s", list->n ? ", " : "", name);
  if (length >= (int)left) list->text[used] = 0;
  if (length >= (int)left && left > 5) strcpy(list->text + used, " ...");
  list->n++;
}

void notes_end(const NotesList *list, const char *what)
{
  if (list->n) notes_say("%s: %s", what, list->text);
}
