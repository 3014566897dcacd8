/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "expr.h"
#include "group.h"
#include "pick.h"
#include "snap.h"
#include "unit.h"

/* Adds what an expression needs; 1: fields that the schema does not know, so the whole file. */
static int need(char *members, int size, const char *text)
{
  Expr *e = text ? expr_parse(text, NULL) : NULL;
  int unknown = e && expr_members(e, members, size) != 0;
  expr_free(e);
  return unknown;
}

static Parts *select_from(Parts *p, const char *select, const char *file, Err *err)
{
  unsigned char *keep = expr_select(select, p, file, err);
  Parts *some = keep ? part_select(p, keep, err) : NULL;
  free(keep), part_free(p);
  return some;
}

Parts *pick_read(const char *file, const char *const *text, int n, const char *select,
                 const char *more, Err *err)
{
  char members[1024];
  int all = 0;
  snprintf(members, sizeof members, PICK_FIELDS " %s", more);
  for (int k = 0; k < n; k++) all |= need(members, sizeof members, text[k]);
  all |= need(members, sizeof members, select);
  Parts *p = all ? snap_read(file, err) : snap_read_some(file, members, err);
  if (!p) return NULL;
  if (part_need(p, PICK_FIELDS, file, err) || part_check(p, file, err)) return part_free(p), NULL;
  return select ? select_from(p, select, file, err) : p;
}

static int centre_of(double x[3], const Parts *p, const int32_t *id, long wanted)
{
  double mass = 0, sum[3] = {0};
  for (long i = 0; i < p->n; i++) {
    if (id && id[i] != wanted) continue;
    for (int a = 0; a < 3; a++) sum[a] += p->m[i] * p->x[3 * i + a];
    mass += p->m[i];
  }
  for (int a = 0; a < 3 && mass > 0; a++) x[a] = sum[a] / mass;
  return mass > 0 ? 0 : -1;
}

int pick_centre(double x[3], const Parts *p, const char *text, const char *file, Err *err)
{
  const int32_t *id;
  int32_t wanted;
  Err why;
  if (!strcmp(text, "com"))
    return centre_of(x, p, NULL, 0) ? err_set(err, "'%s': no particles", file) : 0;
  if (!strchr(text, ':') ? unit_list(text, "m", 3, x, &why)
                         : group_named(p, text, file, &id, &wanted, &why))
    return err_set(err, "--centre: %s", why.text);
  return strchr(text, ':') ? centre_of(x, p, id, wanted) : 0;
}
