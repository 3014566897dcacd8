/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Both dumps are walked along their ids; pairs of objects are keys, sorted, then summed in the
 * order of the ids. */
#include <stdlib.h>
#include "descent.h"
#include "group.h"
#include "sort.h"

int descent_open(Descent *d, const Parts *p, const int32_t *object, long objects, Err *err)
{
  const size_t room = (size_t)p->n + 1;
  *d = (Descent){.n = p->n, .objects = objects, .row = malloc(room * sizeof *d->row)};
  d->id = malloc(room * sizeof *d->id), d->m = malloc(room * sizeof *d->m);
  d->object = malloc(room * sizeof *d->object);
  if (!d->row || !d->id || !d->m || !d->object || group_order(p, d->row, err)) {
    descent_close(d);
    return err_set(err, "out of memory for %ld particles", p->n);
  }
  for (long k = 0; k < p->n; k++) {
    const long i = d->row[k];
    d->id[k] = p->id[i], d->m[k] = p->m[i], d->object[k] = object[i];
  }
  return 0;
}

void descent_close(Descent *d)
{
  free(d->row), free(d->id), free(d->m), free(d->object);
  *d = (Descent){0};
}

void descent_match(const Descent *d, const Descent *e, long *place)
{
  long at = 0;
  for (long k = 0; k < e->n; k++) {
    while (at < d->n && d->id[at] < e->id[k]) at++;
    place[k] = at < d->n && d->id[at] == e->id[k] ? at : -1;
  }
}

/* Sums of equal keys, key [n] along order [n]; where [n]: place in `after`. */
static DescentShare *sum_up(const uint64_t *key, const long *order, const long *where, long n,
                            const Descent *after, long *found)
{
  long pairs = 0;
  for (long k = 0; k < n; k++) pairs += !k || key[order[k]] != key[order[k - 1]];
  DescentShare *share = calloc((size_t)pairs + 1, sizeof *share);
  *found = 0;
  for (long k = 0; k < n && share; k++) {
    const uint64_t pair = key[order[k]];
    if (!k || pair != key[order[k - 1]]) {
      share[*found].from = (int32_t)(pair >> 32);
      share[(*found)++].to = (int32_t)(pair & 0xffffffffu);
    }
    share[*found - 1].mass += after->m[where[order[k]]], share[*found - 1].n++;
  }
  return share;
}

DescentShare *descent_shares(const Descent *before, const Descent *after, long *found, Err *err)
{
  const size_t room = (size_t)after->n + 1;
  uint64_t *key = calloc(room, sizeof *key);
  long *place = malloc(3 * room * sizeof *place), n = 0;
  DescentShare *share = NULL;
  if (key && place) {
    long *where = place + room, *order = where + room;
    descent_match(before, after, place);
    for (long k = 0; k < after->n; k++) {
      if (place[k] < 0) continue;
      key[n] = (uint64_t)(uint32_t)before->object[place[k]] << 32 | (uint32_t)after->object[k];
      where[n++] = k;
    }
    if (!sort_keys(n, key, order)) share = sum_up(key, order, where, n, after, found);
  }
  free(key), free(place);
  return share ? share : err_null(err, "out of memory for %ld particles", after->n);
}

void descent_main(const DescentShare *share, long n, long before, long after, long *progenitor,
                  long *descendant)
{
  for (long k = 0; k <= after; k++) progenitor[k] = -1;
  for (long k = 0; k <= before; k++) descendant[k] = -1;
  for (long s = 0; s < n; s++) { /* ascending: the lower number of equal ones comes first */
    const DescentShare *a = &share[s];
    if (!a->from || !a->to) continue;
    long *up = &progenitor[a->to], *down = &descendant[a->from];
    if (*up < 0 || a->mass > share[*up].mass) *up = s;
    if (*down < 0 || a->mass > share[*down].mass) *down = s;
  }
}
