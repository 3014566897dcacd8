/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text is cut in place: every cell is a piece of it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "spool.h"
#include "tsv.h"
#include "unit.h"

static long count(const char *s, char c)
{
  long n = 0;
  for (; *s; s++) n += *s == c;
  return n;
}

/* Cuts a line at its tabs; at most `room` pieces are kept. Returns how many there are. */
static int cut(char *line, char **piece, int room)
{
  int n = 0;
  for (char *next = line; next; n++) {
    char *here = next;
    next = strchr(here, '\t');
    if (next) *next++ = 0;
    if (n < room) piece[n] = here;
  }
  return n;
}

/* `name [unit]` into its two parts. */
static void split(char *name, char **unit)
{
  const size_t n = strlen(name);
  char *open = strchr(name, '[');
  *unit = name + n;
  if (!open || open == name || name[n - 1] != ']') return;
  name[n - 1] = 0, *unit = open + 1;
  *open = 0;
  if (open[-1] == ' ') open[-1] = 0;
}

static int header(Tsv *t, char *line, Err *err)
{
  line += 1 + (line[1] == ' ');
  const size_t room = (size_t)count(line, '\t') + 1;
  t->name = malloc(room * sizeof *t->name), t->unit = malloc(room * sizeof *t->unit);
  if (!t->name || !t->unit) return err_set(err, "'%s': out of memory", t->label);
  t->columns = cut(line, t->name, (int)room);
  for (int c = 0; c < t->columns; c++) split(t->name[c], &t->unit[c]);
  return 0;
}

/* Lines become strings; the last comment before the rows is the header. */
static int parse(Tsv *t, Err *err)
{
  char *names = NULL;
  long line = 0;
  for (char *next = t->text; next && *next;) {
    char *here = next;
    next = strchr(here, '\n');
    if (next) *next++ = 0;
    line++;
    if (*here == '#') {
      if (!t->rows) names = here;
      continue;
    }
    if (!*here) continue;
    if (!t->rows && (!names || header(t, names, err)))
      return names ? -1
                   : err_set(err, "%s:%ld: no line '# name...' before the rows", t->label, line);
    const int n = cut(here, t->cell + t->rows * t->columns, t->columns);
    if (n != t->columns)
      return err_set(err, "%s:%ld: %d columns, not %d", t->label, line, n, t->columns);
    t->line[t->rows++] = line;
  }
  if (!t->rows && !names) return err_set(err, "'%s' is no table: no line '# name...'", t->label);
  return t->rows ? 0 : header(t, names, err);
}

int tsv_read(Tsv *t, const char *path, Err *err)
{
  const int in = !path || !strcmp(path, "-");
  *t = (Tsv){.text = spool_slurp(in ? "/dev/stdin" : path, err)};
  snprintf(t->label, sizeof t->label, "%s", in ? "stdin" : path);
  if (!t->text) return -1;
  const size_t rows = (size_t)count(t->text, '\n') + 1, cells = (size_t)count(t->text, '\t') + rows;
  t->cell = malloc((cells + rows) * sizeof *t->cell), t->line = malloc(rows * sizeof *t->line);
  int failed = !t->cell || !t->line ? err_set(err, "'%s': out of memory", t->label) : parse(t, err);
  if (failed) tsv_free(t);
  return failed;
}

void tsv_free(Tsv *t)
{
  free(t->text), free(t->name), free(t->unit), free(t->cell), free(t->line);
  *t = (Tsv){0};
}

int tsv_column(const Tsv *t, const char *name, Err *err)
{
  for (int c = 0; c < t->columns; c++)
    if (!strcmp(t->name[c], name)) return c;
  const char *near = unit_nearest(name, (const char *const *)t->name, t->columns);
  return err_set(err, "'%s' has no column '%s'%s%s%s", t->label, name,
                 near ? " (did you mean '" : "", near ? near : "", near ? "'?)" : "");
}

double *tsv_numbers(const Tsv *t, const char *name, Err *err)
{
  const int c = tsv_column(t, name, err);
  double *value = c < 0 ? NULL : malloc(((size_t)t->rows + 1) * sizeof *value);
  if (c < 0) return NULL;
  if (!value) return err_null(err, "'%s': out of memory", t->label);
  for (long r = 0; r < t->rows; r++) {
    const char *text = t->cell[r * t->columns + c];
    char *end;
    value[r] = strtod(text, &end);
    if (end != text && !*end) continue;
    free(value);
    return err_null(err, "%s:%ld: %s '%s' is not a number", t->label, t->line[r], name, text);
  }
  return value;
}
