/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libconfig files read by rows of parameters. Every mistake is `file:line: ...`: syntax, unknown
 * key (with the nearest known), wrong type, missing key, value out of range, wrong unit. Integers
 * are accepted where a float is meant; a value may be a string with a unit ("2.7 g/cc"). A
 * vector is a list of three such values or a text "X,Y,Z". */
#ifndef CFG_H
#define CFG_H

#include <stddef.h>
#include <libconfig.h>
#include "err.h"

typedef enum { CFG_REAL, CFG_INT, CFG_BOOL, CFG_TEXT, CFG_CHOICE, CFG_VECTOR } CfgType;

typedef struct {
  const char *name;
  CfgType type;     /* targets: double, int, int, char[64], int (index into the words of unit),
                        double[3] */
  size_t offset;    /* offsetof in the struct that is filled */
  const char *unit; /* CFG_REAL, CFG_VECTOR: SI unit (see unit.h), "1" for none; CFG_CHOICE: "a|b|c"
                      */
  const char *value; /* default as a user would type it; NULL: the key must be there */
  double min, max;   /* allowed range of numbers, inclusive; min > max: any */
  const char *meaning;
} CfgRow;

/* cfg_open: parses a file; cfg_open_text: a text, which label names in messages. Whole numbers too
 * wide for libconfig, which would wrap them silently, and @include (snapshots keep the text, not
 * the files beside it) are errors. Returns 0 or -1; on success the caller owns *cfg
 * (config_destroy). */
int cfg_open(config_t *cfg, const char *path, Err *err);
int cfg_open_text(config_t *cfg, const char *text, const char *label, Err *err);

/* cfg_read: fills `into` from a group by rows[n]; defaults first. label names the file in messages.
 * Keys not in rows are errors unless they are listed in also[nalso] (sub-groups read separately).
 */
int cfg_read(const config_setting_t *group, const CfgRow *rows, int n, void *into,
             const char *const *also, int nalso, const char *label, Err *err);

/* cfg_set: one `key=value` as given by --set; the same checks. */
int cfg_set(const CfgRow *rows, int n, void *into, const char *key, const char *value, Err *err);

/* cfg_text: the value of a row as text in SI ("0.4", "true", "wendland_c2"), for /Parameters and
 * logs; returns buf. */
const char *cfg_text(const CfgRow *row, const void *from, char *buf, int size);

/* cfg_where: err_set with `file:line: ` of the setting in front. Returns -1. */
int cfg_where(Err *err, const config_setting_t *setting, const char *label, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

#endif
