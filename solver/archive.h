/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of what has left a run: escaped.h5 and accreted.h5, one row a particle as it was when it
 * left, in the order of leaving. They grow in memory and are written, whole, before a snapshot or a
 * checkpoint that no longer has their particles. */
#ifndef ARCHIVE_H
#define ARCHIVE_H

#include "../lib/part.h"

enum { ARCHIVE_ESCAPED, ARCHIVE_ACCRETED, ARCHIVES, ARCHIVE_PIECES = 64 };

typedef struct {
  Parts *piece[ARCHIVE_PIECES]; /* older ones first, each larger than all after it */
  int pieces, changed;
} ArchiveList;

typedef struct {
  ArchiveList list[ARCHIVES];
} Archive;

/* archive_add: these particles, with the fields RemovalTime and RemovalStep, behind the others; the
 * archive frees them, also on an error. */
int archive_add(Archive *a, int which, Parts *p, Err *err);

/* archive_write: the files that have changed, with history and parameters of `like`.
 * archive_resume: what the files of a run that is continued hold up to `step`; others are written
 * anew. */
int archive_write(Archive *a, const char *dir, const Parts *like, Err *err);
int archive_resume(Archive *a, const char *dir, long step, Err *err);
void archive_free(Archive *a);

#endif
