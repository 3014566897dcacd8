/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that appear whole or not at all, and pipes for formats that must seek.
 * Output: a temporary name beside the target, `.NAME.PID~`, then fsync and rename; what a killed
 * process left under such a name is removed by the next writer of the same file. For stdout and
 * whatever is no regular file (/dev/full, a named pipe) a temporary file in $TMPDIR, then a copy.
 * Input from a pipe: copied to a temporary file in $TMPDIR. */
#ifndef SPOOL_H
#define SPOOL_H

#include "err.h"

typedef struct {
  char path[4096];  /* the name to open and write; "" when it is gone */
  char final[4096]; /* the name it will get; "" for stdout */
  int fd;           /* of the temporary file */
  int stream;       /* final is copied to, not renamed to */
} Spool;

/* spool_in: a path that can be opened and seeked for `path` ("-", NULL: stdin). On return
 * *temporary says that the caller must unlink it right after opening. Empty input is an error, and
 * so is a terminal. */
int spool_in(const char *path, char *out, int size, int *temporary, Err *err);

/* spool_out: makes the temporary file for `path` ("-", NULL: stdout; a terminal is refused when
 * `binary`), so it is known that the folder can be written before any work is done. */
int spool_out(Spool *s, const char *path, int binary, Err *err);

/* spool_opened: says that the caller has opened s->path, so that the name of a stream's temporary
 * file can go at once. */
void spool_opened(Spool *s);

/* spool_commit: fsync + rename (or copy to the stream). On failure it has done what spool_abort
 * does. spool_abort: removes the temporary file; twice is harmless. */
int spool_commit(Spool *s, Err *err);
void spool_abort(Spool *s);

/* spool_text: writes a whole text file atomically. spool_slurp: a whole text file, malloc'ed; NULL
 * with a message, also when it is not text. */
int spool_text(const char *path, const char *text, Err *err);
char *spool_slurp(const char *path, Err *err);

#endif
