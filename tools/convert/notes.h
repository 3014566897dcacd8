/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a conversion could not carry over, and what it assumed: one line each on stderr, so that
 * nothing is lost in silence. */
#ifndef NOTES_H
#define NOTES_H

/* notes_say: prints `convert: FILE: text` unless --quiet. notes_about: the file that is meant from
 * now on (its last path element). */
void notes_about(const char *file);
void notes_say(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* notes_list: the same of many names: collects them, one call each, and prints them behind `what`
 * at notes_end. */
typedef struct {
  char text[900];
  int n;
} NotesList;
void notes_add(NotesList *list, const char *name);
void notes_end(const NotesList *list, const char *what);

/* notes_quiet: say nothing from now on. */
void notes_quiet(void);

#endif
