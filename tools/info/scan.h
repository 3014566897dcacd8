/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a snapshot holds, counted: its fields, bodies and materials. */
#ifndef SCAN_H
#define SCAN_H

#include "lib/part.h"

typedef struct {
  const char *name, *unit, *meaning;
  char type[32], shape[64];
  double least, mean, greatest; /* over all finite numbers; NAN where there are none */
  long bad;                     /* numbers that are not finite */
} ScanField;

/* scan_fields: one for each dataset of particles, [*n], malloc'ed; NULL without memory. */
ScanField *scan_fields(const Parts *p, int *n);

typedef struct {
  int32_t id; /* of the body, or index of the material */
  long n;
  double mass, x[3], v[3]; /* kg, centre of mass m, its velocity m/s */
  double reach;            /* largest distance from that [m] */
} ScanGroup;

/* scan_groups: the particles by a field of whole numbers (body or mat, NULL: all in one),
 * ascending, [*n], malloc'ed; NULL without memory. Without masses each particle counts as 1. */
ScanGroup *scan_groups(const Parts *p, const int32_t *key, int *n);

/* scan_form: the word for `form` in a group of a material's text ("eos", "strength" ...), "-"
 * without one. */
void scan_form(const char *text, const char *group, char *form, int size);

#endif
