/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "dumps.h"
#include "lib/spool.h"

static int by_name(const void *a, const void *b)
{
  return strcmp(*(char *const *)a, *(char *const *)b);
}

static int add(Dumps *d, const char *path)
{
  char **more = realloc(d->file, (size_t)(d->n + 1) * sizeof *more),
       *copy = malloc(strlen(path) + 1);
  if (more) d->file = more;
  if (!more || !copy) return free(copy), -1;
  d->file[d->n++] = strcpy(copy, path);
  return 0;
}

/* snap_NNNN.h5 */
static int is_dump(const char *name)
{
  size_t n = strlen(name);
  return n > 8 && !strncmp(name, "snap_", 5) && !strcmp(name + n - 3, ".h5");
}

static int list(Dumps *d, Err *err)
{
  char path[4096];
  DIR *dir = opendir(d->dir);
  if (!dir) return err_set(err, "cannot open '%s': %s", d->dir, strerror(errno));
  for (struct dirent *e; (e = readdir(dir));)
    if (is_dump(e->d_name)) {
      snprintf(path, sizeof path, "%s/%s", d->dir, e->d_name);
      if (add(d, path)) break;
    }
  closedir(dir);
  qsort(d->file, (size_t)d->n, sizeof *d->file, by_name);
  return d->n ? 0 : err_set(err, "'%s' holds no snapshots (snap_NNNN.h5)", d->dir);
}

/* Sums over the parts of a run: each has a line `S s of wall clock for N steps`. */
static void read_log(Dumps *d)
{
  char path[4096];
  d->steps = d->seconds = NAN;
  if (dumps_has(d, "run.log", path, sizeof path)) d->log = spool_slurp(path, NULL);
  for (const char *s = d->log; s && (s = strstr(s, " s of wall clock for ")); s++) {
    const char *number = s;
    double seconds, steps;
    while (number > d->log && number[-1] != ' ' && number[-1] != '\n') number--;
    if (sscanf(number, "%lf", &seconds) != 1 || sscanf(s, " s of wall clock for %lf", &steps) != 1)
      continue;
    d->seconds = isnan(d->seconds) ? seconds : d->seconds + seconds;
    d->steps = isnan(d->steps) ? steps : d->steps + steps;
  }
}

int dumps_find(Dumps *d, const char *path, Err *err)
{
  struct stat s;
  *d = (Dumps){.steps = NAN, .seconds = NAN};
  if (stat(path, &s)) return err_set(err, "cannot open '%s': %s", path, strerror(errno));
  if (!S_ISDIR(s.st_mode)) return add(d, path) ? err_set(err, "out of memory") : 0;
  size_t n = strlen(path);
  while (n > 1 && path[n - 1] == '/') n--;
  snprintf(d->dir, sizeof d->dir, "%.*s", (int)n, path);
  if (list(d, err)) return dumps_free(d), -1;
  read_log(d);
  return 0;
}

void dumps_free(Dumps *d)
{
  for (int k = 0; k < d->n; k++) free(d->file[k]);
  free(d->file), free(d->log);
  *d = (Dumps){0};
}

int dumps_has(const Dumps *d, const char *name, char *path, int size)
{
  if (!*d->dir) return 0;
  snprintf(path, (size_t)size, "%s/%s", d->dir, name);
  return !access(path, R_OK);
}
