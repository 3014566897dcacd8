/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every value, from a default, a file or --set, ends in one of two functions: a number
 * (store_number) or a text (store_text). */
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "cfg.h"
#include "unit.h"

enum { TEXT_SIZE = 64, MAX_NAMES = 256 };

int cfg_where(Err *err, const config_setting_t *setting, const char *label, const char *format, ...)
{
  unsigned line = config_setting_source_line(setting);
  Err what;
  va_list args;
  va_start(args, format);
  vsnprintf(what.text, sizeof what.text, format, args);
  va_end(args);
  if (line == 0) return err_set(err, "%s: %s", label, what.text);
  return err_set(err, "%s:%u: %s", label, line, what.text);
}

static int too_wide(const char *number, int length, int line, const char *label, Err *err)
{
  return err_set(err, "%s:%d: %.*s is too wide for a whole number (write %.*s.0)", label, line,
                 length, number, length, number);
}

/* libconfig 1.5 wraps integers beyond 32 bits (with an L: 64) without a word, and keeps no text to
 * look at afterwards. Returns the end of the number at p, or NULL. */
static const char *check_number(const char *p, int line, const char *label, Err *err)
{
  char *end;
  double x = strtod(p, &end);
  int length = (int)(end - p), hex = p[0] == '0' && (p[1] == 'x' || p[1] == 'X');
  int whole = hex || (int)strspn(p, "0123456789") == length, wide = *end == 'L';
  if (whole && x > (wide ? 9.2e18 : INT_MAX)) {
    too_wide(p, length, line, label, err);
    return NULL;
  }
  return end + (wide ? strspn(end, "L") : 0);
}

/* The end of the comment, string or word at p, or p itself where there is none. */
static const char *skip(const char *p)
{
  const char *end;
  if (*p == '#' || !strncmp(p, "//", 2)) return p + strcspn(p, "\n");
  if (!strncmp(p, "/*", 2)) return (end = strstr(p + 2, "*/")) ? end + 2 : p + strlen(p);
  if (*p == '"') {
    for (p++; *p && *p != '"'; p++)
      if (*p == '\\' && p[1]) p++;
    return p + (*p == '"');
  }
  while (isalpha((unsigned char)*p) || *p == '_') p += 1 + strspn(p + 1, "0123456789-*");
  return p;
}

static int check_text(const char *text, const char *label, Err *err)
{
  int line = 1;
  for (const char *p = text, *next; *p; p = next) {
    next = skip(p);
    if (next == p) {
      if (!strncmp(p, "@include", 8))
        return err_set(err, "%s:%d: @include is not supported", label, line);
      next = isdigit((unsigned char)*p) || *p == '.' ? check_number(p, line, label, err) : p + 1;
      if (!next) return -1;
      if (next == p) next++;
    }
    for (; p < next; p++) line += *p == '\n';
  }
  return 0;
}

int cfg_open_text(config_t *cfg, const char *text, const char *label, Err *err)
{
  if (check_text(text, label, err)) return -1;
  config_init(cfg);
  if (config_read_string(cfg, text) == CONFIG_TRUE) return 0;
  err_set(err, "%s:%d: %s", label, config_error_line(cfg), config_error_text(cfg));
  config_destroy(cfg);
  return -1;
}

int cfg_open(config_t *cfg, const char *path, Err *err)
{
  FILE *f = fopen(path, "r");
  char *text = NULL;
  size_t room = 0;
  ssize_t length;
  int failed;
  if (!f) return err_set(err, "cannot open '%s': %s", path, strerror(errno));
  length = getdelim(&text, &room, 0, f);
  if (length < 0 && ferror(f))
    failed = err_set(err, "cannot read '%s': %s", path, strerror(errno));
  else if (!feof(f))
    failed = err_set(err, "cannot read '%s': not a text file", path);
  else
    failed = cfg_open_text(cfg, length < 0 ? "" : text, path, err);
  free(text);
  fclose(f);
  return failed;
}

static void *target(const CfgRow *row, void *into) { return (char *)into + row->offset; }

static int in_range(const CfgRow *row, double x, Err *err)
{
  if (!isfinite(x)) return err_set(err, "'%s' must be finite", row->name);
  if (row->min > row->max || (x >= row->min && x <= row->max)) return 0;
  return err_set(err, "'%s' = %g is outside %g .. %g%s%s", row->name, x, row->min, row->max,
                 row->type != CFG_INT && strcmp(row->unit, "1") ? " " : "",
                 row->type != CFG_INT && strcmp(row->unit, "1") ? row->unit : "");
}

static int store_number(const CfgRow *row, double x, void *into, Err *err)
{
  if (row->type != CFG_REAL && row->type != CFG_INT)
    return err_set(err, "'%s' must be %s", row->name,
                   row->type == CFG_BOOL     ? "true or false"
                   : row->type == CFG_VECTOR ? "a list of three numbers"
                                             : "a text in quotes");
  if (in_range(row, x, err)) return -1;
  if (row->type == CFG_REAL) {
    *(double *)target(row, into) = x;
    return 0;
  }
  if (x != floor(x) || fabs(x) > INT_MAX)
    return err_set(err, "'%s' = %.15g is not a whole number", row->name, x);
  *(int *)target(row, into) = (int)x;
  return 0;
}

static int store_bool(const CfgRow *row, int x, void *into, Err *err)
{
  if (row->type != CFG_BOOL) return err_set(err, "'%s' is not a switch (true or false)", row->name);
  *(int *)target(row, into) = x;
  return 0;
}

static int store_vector(const CfgRow *row, const double x[3], void *into, Err *err)
{
  for (int d = 0; d < 3; d++)
    if (in_range(row, x[d], err)) return -1;
  memcpy(target(row, into), x, 3 * sizeof *x);
  return 0;
}

static int store_text(const CfgRow *row, const char *text, void *into, Err *err)
{
  Err why;
  double x, v[3];
  long count;
  int k;
  switch (row->type) {
  case CFG_REAL:
    if (unit_parse(text, row->unit, &x, &why)) return err_set(err, "'%s': %s", row->name, why.text);
    return store_number(row, x, into, err);
  case CFG_INT:
    if (unit_count(text, &count, &why)) return err_set(err, "'%s': %s", row->name, why.text);
    return store_number(row, (double)count, into, err);
  case CFG_BOOL:
    k = !strcmp(text, "true");
    if (!k && strcmp(text, "false"))
      return err_set(err, "'%s' must be true or false, not '%s'", row->name, text);
    return store_bool(row, k, into, err);
  case CFG_TEXT:
    if (strlen(text) >= TEXT_SIZE)
      return err_set(err, "'%s': text longer than %d characters", row->name, TEXT_SIZE - 1);
    strcpy(target(row, into), text);
    return 0;
  case CFG_CHOICE:
    k = unit_choice(text, row->unit, &why);
    if (k < 0) return err_set(err, "'%s': %s", row->name, why.text);
    *(int *)target(row, into) = k;
    return 0;
  case CFG_VECTOR:
    if (unit_list(text, row->unit, 3, v, &why))
      return err_set(err, "'%s': %s", row->name, why.text);
    return store_vector(row, v, into, err);
  }
  return err_set(err, "'%s' has no type", row->name);
}

/* A list of three numbers or texts. */
static int store_list(const CfgRow *row, const config_setting_t *s, void *into, Err *err)
{
  Err why;
  double x[3];
  if (row->type != CFG_VECTOR) return err_set(err, "'%s' must be a single value", row->name);
  if (config_setting_length(s) != 3)
    return err_set(err, "'%s' must be a list of three numbers", row->name);
  for (unsigned d = 0; d < 3; d++) {
    const config_setting_t *e = config_setting_get_elem(s, d);
    const char *text = config_setting_get_string(e);
    if (text) {
      if (unit_parse(text, row->unit, &x[d], &why))
        return err_set(err, "'%s': %s", row->name, why.text);
    } else if (config_setting_is_number(e)) {
      x[d] = config_setting_type(e) == CONFIG_TYPE_FLOAT ? config_setting_get_float(e)
                                                         : (double)config_setting_get_int64(e);
    } else {
      return err_set(err, "'%s' must be a list of three numbers", row->name);
    }
  }
  return store_vector(row, x, into, err);
}

static int store_setting(const CfgRow *row, const config_setting_t *s, void *into, Err *err)
{
  switch (config_setting_type(s)) {
  case CONFIG_TYPE_INT: return store_number(row, config_setting_get_int(s), into, err);
  case CONFIG_TYPE_INT64: return store_number(row, (double)config_setting_get_int64(s), into, err);
  case CONFIG_TYPE_FLOAT: return store_number(row, config_setting_get_float(s), into, err);
  case CONFIG_TYPE_BOOL: return store_bool(row, config_setting_get_bool(s), into, err);
  case CONFIG_TYPE_STRING: return store_text(row, config_setting_get_string(s), into, err);
  case CONFIG_TYPE_ARRAY:
  case CONFIG_TYPE_LIST: return store_list(row, s, into, err);
  default: return err_set(err, "'%s' must be a single value", row->name);
  }
}

static int unknown_key(const char *key, const CfgRow *rows, int n, const char *const *also,
                       int nalso, Err *err)
{
  const char *names[MAX_NAMES], *near;
  int count = 0;
  for (int k = 0; k < n && count < MAX_NAMES; k++) names[count++] = rows[k].name;
  for (int k = 0; k < nalso && count < MAX_NAMES; k++) names[count++] = also[k];
  near = unit_nearest(key, names, count);
  if (!near) return err_set(err, "unknown key '%s'", key);
  return err_set(err, "unknown key '%s' (did you mean '%s'?)", key, near);
}

static int is_known(const char *key, const CfgRow *rows, int n, const char *const *also, int nalso)
{
  for (int k = 0; k < n; k++)
    if (!strcmp(rows[k].name, key)) return 1;
  for (int k = 0; k < nalso; k++)
    if (!strcmp(also[k], key)) return 1;
  return 0;
}

int cfg_read(const config_setting_t *group, const CfgRow *rows, int n, void *into,
             const char *const *also, int nalso, const char *label, Err *err)
{
  Err why;
  if (!config_setting_is_group(group))
    return cfg_where(err, group, label, "'%s' must be a group { ... }", config_setting_name(group));
  for (int k = 0; k < config_setting_length(group); k++) {
    const config_setting_t *s = config_setting_get_elem(group, (unsigned)k);
    if (is_known(config_setting_name(s), rows, n, also, nalso)) continue;
    unknown_key(config_setting_name(s), rows, n, also, nalso, &why);
    return cfg_where(err, s, label, "%s", why.text);
  }
  for (int k = 0; k < n; k++) {
    const config_setting_t *s = config_setting_get_member(group, rows[k].name);
    if (!s && !rows[k].value)
      return cfg_where(err, group, label, "missing key '%s' (%s)", rows[k].name, rows[k].meaning);
    if (s ? store_setting(&rows[k], s, into, &why)
          : store_text(&rows[k], rows[k].value, into, &why))
      return cfg_where(err, s ? s : group, label, "%s%s", s ? "" : "default of ", why.text);
  }
  return 0;
}

int cfg_set(const CfgRow *rows, int n, void *into, const char *key, const char *value, Err *err)
{
  for (int k = 0; k < n; k++)
    if (!strcmp(rows[k].name, key)) return store_text(&rows[k], value, into, err);
  return unknown_key(key, rows, n, NULL, 0, err);
}

/* A number as short as it can be read back. */
static int number_text(double x, char *buf, int size)
{
  int digits = 15, length;
  do length = snprintf(buf, (size_t)size, "%.*g", digits, x);
  while (digits++ < 17 && strtod(buf, NULL) != x);
  return length;
}

const char *cfg_text(const CfgRow *row, const void *from, char *buf, int size)
{
  const void *at = (const char *)from + row->offset;
  const char *word = row->unit;
  int skip, length = 0;
  switch (row->type) {
  case CFG_REAL: number_text(*(const double *)at, buf, size); break;
  case CFG_VECTOR:
    for (int d = 0; d < 3 && length < size - 1; d++) {
      length += number_text(((const double *)at)[d], buf + length, size - length);
      if (d < 2 && length < size - 1) buf[length++] = ',', buf[length] = 0;
    }
    break;
  case CFG_INT: snprintf(buf, (size_t)size, "%d", *(const int *)at); break;
  case CFG_BOOL: snprintf(buf, (size_t)size, "%s", *(const int *)at ? "true" : "false"); break;
  case CFG_TEXT: snprintf(buf, (size_t)size, "%s", (const char *)at); break;
  case CFG_CHOICE:
    for (skip = *(const int *)at; skip > 0; skip--) word = strchr(word, '|') + 1;
    snprintf(buf, (size_t)size, "%.*s", (int)strcspn(word, "|"), word);
    break;
  }
  return buf;
}
