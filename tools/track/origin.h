/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the particles of objects come from: their places in the bodies at the start. */
#ifndef ORIGIN_H
#define ORIGIN_H

#include "lib/descent.h"

/* The start: each particle's distance from the centre of its body, and its body's radius, that of
 * the outermost particle. */
typedef struct {
  Descent start;
  double *r;      /* [start.n] m, by ascending id */
  int32_t *body;  /* [start.n] */
  double *radius; /* [bodies] m */
  int bodies;
} Origin;

/* origin_open: from the particles at the start (id, x, m, body). */
int origin_open(Origin *o, const Parts *start, Err *err);
void origin_close(Origin *o);

/* origin_map: writes the snapshot `from` to path with the objects of `last` in the field member
 * ("clump" or "frag"): what each place becomes part of. origin_mark: writes the snapshot `from` of
 * the last dump with that field, InitialRadius [m] and InitialDepth [m] (nan: not there at the
 * start). */
int origin_map(const char *path, const char *from, const Descent *last, const char *member,
               const char *command, Err *err);
int origin_mark(const char *path, const char *from, const Origin *o, const Descent *last,
                const char *member, const char *command, Err *err);

/* origin_shells: a table of the mass of each object (and of what is in none: 0) from each of `bins`
 * shells of equal thickness of each body. */
int origin_shells(const char *path, const Origin *o, const Descent *last, long bins, Err *err);

#endif
