/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that appear whole or not at all, and pipes for formats that must seek.
 * Output: a temporary name beside the target, then fsync and rename; for stdout an unlinked temporary file, then a copy.
 * Input from a pipe: copied to an unlinked temporary file in $TMPDIR. */
#ifndef SPOOL_H
#define SPOOL_H

#include <stdio.h>
#include "err.h"

typedef struct {
  char path[4096];  /* the name to open and write */
  char final[4096]; /* the name it will get; "" for stdout */
} Spool;

/* spool_in: a path that can be opened and seeked for `path` ("-", NULL: stdin). On return *temporary says that the caller must
 * unlink it right after opening. Empty stdin is an error. */
int spool_in(const char *path, char *out, int size, int *temporary, Err *err);

/* spool_out: chooses the temporary name for `path` ("-", NULL: stdout; a terminal is refused when `binary`). Checks that the folder
 * can be written before any work is done. */
int spool_out(Spool *s, const char *path, int binary, Err *err);

/* spool_commit: fsync + rename (or copy to stdout). spool_abort: removes the temporary file. */
int spool_commit(Spool *s, Err *err);
void spool_abort(Spool *s);

/* spool_text: writes a whole text file atomically. */
int spool_text(const char *path, const char *text, Err *err);

#endif
