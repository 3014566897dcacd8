/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of conflict.h, one call each. */
#include <stdio.h>
#include <string.h>
#include "conflict.h"

enum { VALUE = 128 };

/* `key = value`; a reason in words as it is. */
static const char *say(const Param *p, const char *key, char *text)
{
  char value[VALUE];
  if (!param_text(p, key, value, sizeof value)) return key;
  snprintf(text, 2 * VALUE, "%s = %s", key, value);
  return text;
}

static int refuse(const Param *p, int holds, const char *key, const char *other, const char *why,
                  Err *err)
{
  char a[2 * VALUE], b[2 * VALUE];
  if (!holds) return 0;
  return err_set(err, "%s cannot go with %s: %s", say(p, key, a), say(p, other, b), why);
}

int conflict_check(const Param *p, const Sim *s, Err *err)
{
  (void)s;
#define CONFLICT_ROW(KEY, OTHER, HOLDS, WHY)                                                       \
  if (refuse(p, HOLDS, KEY, OTHER, WHY, err)) return -1;
  CONFLICTS(CONFLICT_ROW)
#undef CONFLICT_ROW
  return 0;
}

static int unused(const Param *p, const Param *standard, int holds, const char *key,
                  const char *because, Err *err)
{
  char value[VALUE], other[VALUE], a[2 * VALUE], b[2 * VALUE];
  if (!holds) return 0;
  param_text(p, key, value, sizeof value), param_text(standard, key, other, sizeof other);
  if (strcmp(value, other) == 0) return 0;
  return err_set(err, "%s has no effect: %s", say(p, key, a), say(p, because, b));
}

int conflict_unused(const Param *p, const Sim *s, Err *err)
{
  Param standard;
  (void)s;
  param_defaults(&standard);
#define CONFLICT_ROW(KEY, HOLDS, BECAUSE)                                                          \
  if (unused(p, &standard, HOLDS, KEY, BECAUSE, err)) return -1;
  UNUSED_SETTINGS(CONFLICT_ROW)
#undef CONFLICT_ROW
  return 0;
}
