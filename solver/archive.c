/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pieces are joined like the digits of a binary counter, so that each particle is copied a few
 * times only, however often some leave. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "../lib/snap.h"
#include "archive.h"

static const char *const files[ARCHIVES] = {"escaped.h5", "accreted.h5"};

static void path_of(const char *dir, int which, char path[4096])
{
  snprintf(path, 4096, "%s/%s", dir, files[which]);
}

/* The last two pieces into one. */
static int join_last(ArchiveList *l, Err *err)
{
  Parts *a = l->piece[l->pieces - 2], *b = l->piece[l->pieces - 1];
  Parts *both = part_join(a, b, err);
  if (!both) return -1;
  part_free(a), part_free(b);
  l->piece[--l->pieces - 1] = both;
  return 0;
}

/* Without what is the run's and not theirs. */
static void strip(Parts *p)
{
  for (int k = 0; k < p->histories; k++) free(p->history[k]);
  for (int k = 0; k < p->parameters; k++) free(p->parameter[k]);
  p->histories = p->parameters = p->points = 0;
}

int archive_add(Archive *a, int which, Parts *p, Err *err)
{
  ArchiveList *l = &a->list[which];
  if (!p) return 0;
  strip(p);
  l->piece[l->pieces++] = p, l->changed = 1; /* there is room: the pieces double */
  while (l->pieces > 1 && l->piece[l->pieces - 2]->n <= l->piece[l->pieces - 1]->n)
    if (join_last(l, err)) return -1;
  return 0;
}

/* The values of a field of its own; NULL without. */
static const double *extra(const Parts *p, const char *name)
{
  for (int k = 0; k < p->extras; k++)
    if (strcmp(p->extra[k].name, name) == 0 && p->extra[k].size == (int)sizeof(double))
      return (const double *)(const void *)p->extra[k].data;
  return NULL;
}

static int write_list(ArchiveList *l, const char *path, const Parts *like, Err *err)
{
  Parts whole;
  const double *time;
  while (l->pieces > 1)
    if (join_last(l, err)) return -1;
  if (l->pieces == 0) return unlink(path), l->changed = 0;
  whole = *l->piece[0];
  whole.history = like->history, whole.histories = like->histories;
  whole.parameter = like->parameter, whole.parameters = like->parameters;
  if ((time = extra(&whole, "RemovalTime"))) whole.time = time[whole.n - 1];
  if (snap_write(&whole, path, 0, err)) return -1;
  l->changed = 0;
  return 0;
}

int archive_write(Archive *a, const char *dir, const Parts *like, Err *err)
{
  char path[4096];
  for (int k = 0; k < ARCHIVES; k++) {
    path_of(dir, k, path);
    if (a->list[k].changed && write_list(&a->list[k], path, like, err)) return -1;
  }
  return 0;
}

/* Of a file, what had left by `step`. */
static int resume_list(ArchiveList *l, const char *path, long step, Err *err)
{
  Parts *p = snap_read(path, err), *q = NULL;
  const double *when = p ? extra(p, "RemovalStep") : NULL;
  unsigned char *keep = p ? calloc((size_t)p->n + 1, 1) : NULL;
  long n = 0;
  int bad = !p || (when && keep ? 0 : err_set(err, "'%s' lacks field 'RemovalStep'", path));
  for (long i = 0; i < (bad ? 0 : p->n); i++) n += keep[i] = when[i] <= (double)step;
  if (!bad && n > 0 && !(q = part_select(p, keep, err))) bad = 1;
  if (q) strip(q), l->piece[l->pieces++] = q;
  l->changed = !bad && n < p->n;
  free(keep);
  part_free(p);
  return bad ? -1 : 0;
}

int archive_resume(Archive *a, const char *dir, long step, Err *err)
{
  char path[4096];
  for (int k = 0; k < ARCHIVES; k++) {
    path_of(dir, k, path);
    if (access(path, F_OK) == 0 && resume_list(&a->list[k], path, step, err)) return -1;
  }
  return 0;
}

void archive_free(Archive *a)
{
  for (int k = 0; k < ARCHIVES; k++) {
    for (int i = 0; i < a->list[k].pieces; i++) part_free(a->list[k].piece[i]);
    a->list[k].pieces = 0;
  }
}
