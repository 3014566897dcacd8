/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../../lib/err.h"
#include "../../lib/unit.h"
#include "values.h"

static void add(Values *v, double x)
{
  if (v->n == v->room) {
    v->room = v->room ? 2 * v->room : 64;
    v->x = realloc(v->x, (size_t)v->room * sizeof *v->x);
    if (!v->x) err_die("no memory for %ld values", v->room);
  }
  v->x[v->n++] = x;
}

/* where: the option, or the line of stdin. */
static double quantity(const char *text, const char *kind, const char *where)
{
  Err err;
  double x;
  if (!unit_parse(text, kind, &x, &err)) return x;
  if (*where == '-') err_usage("%s: %s", where, err.text);
  err_die("%s: %s", where, err.text);
}

/* LOW:HIGH:N or log:LOW:HIGH:N, cut at the colons in place. */
static void grid(Values *v, char *text, const char *kind, const char *where)
{
  int by_log = !strncmp(text, "log:", 4);
  char *low = text + (by_log ? 4 : 0), *high = strchr(low, ':'), *count, *end;
  double a, b;
  long n;
  if (!high || !(count = strchr(high + 1, ':')))
    err_usage("%s: '%s' is not LOW:HIGH:N", where, text);
  n = strtol(count + 1, &end, 10);
  if (count[1] < '0' || count[1] > '9' || *end || n < 2 || n > 10000000)
    err_usage("%s: a grid needs 2 to 10000000 points, not '%s'", where, count + 1);
  *high = *count = '\0';
  a = quantity(low, kind, where), b = quantity(high + 1, kind, where);
  if (by_log && !(a > 0 && b > 0)) err_usage("%s: a logarithmic grid needs values above 0", where);
  for (long k = 0; k < n; k++) {
    double x = (double)k / (double)(n - 1);
    add(v, k == n - 1 ? b : by_log ? a * pow(b / a, x) : a + (b - a) * x);
  }
}

Values values_read(const char *list, const char *kind, const char *where)
{
  Values v = {NULL, 0, 0};
  char *copy = malloc(strlen(list) + 1), *item = copy, *comma;
  if (!copy) err_die("no memory");
  strcpy(copy, list);
  do {
    if ((comma = strchr(item, ','))) *comma = '\0';
    if (strchr(item, ':'))
      grid(&v, item, kind, where);
    else
      add(&v, quantity(item, kind, where));
    item = comma + 1;
  } while (comma);
  free(copy);
  return v;
}

void values_break(Values *v, double x)
{
  long k = 0;
  int copies = 2;
  if (!(x > v->x[0] && x < v->x[v->n - 1])) return;
  while (v->x[k] < x) k++;
  for (long i = k; i < v->n && v->x[i] == x; i++) copies--;
  for (; copies > 0; copies--) {
    add(v, 0);
    memmove(v->x + k + 1, v->x + k, (size_t)(v->n - 1 - k) * sizeof *v->x);
    v->x[k] = x;
  }
}

void values_pairs(Values *rho, Values *u)
{
  char *line = NULL, rho_text[256], u_text[256], rest[2], where[32];
  size_t room = 0;
  for (long number = 1; getline(&line, &room, stdin) >= 0; number++) {
    int found = sscanf(line, "%255s %255s %1s", rho_text, u_text, rest);
    if (found <= 0 || rho_text[0] == '#') continue;
    snprintf(where, sizeof where, "stdin:%ld", number);
    if (found != 2) err_die("%s: a density and an energy are wanted", where);
    add(rho, quantity(rho_text, "kg/m^3", where));
    add(u, quantity(u_text, "J/kg", where));
  }
  free(line);
  if (ferror(stdin)) err_die("cannot read stdin: %s", strerror(errno));
  if (!rho->n) err_die("stdin: no pairs of density and energy");
}
