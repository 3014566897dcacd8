/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which object of a dump became which of the next: by the particles that they share. An object's
 * progenitor is the one before that most of its mass was in, its descendant the one after that most
 * of its mass is in; where two are each other's, the object goes on. Particles are known by their
 * ids; those that only one of the dumps has count for nothing. */
#ifndef DESCENT_H
#define DESCENT_H

#include "part.h"

/* The particles of a dump, by ascending id, and the object of each (1 .. objects; 0: none). */
typedef struct {
  long n, objects;
  int64_t *id;
  double *m; /* kg */
  int32_t *object;
  long *row; /* in Parts */
} Descent;

/* Mass [kg, as in the later dump] that objects of two dumps share; 0: what is in none. */
typedef struct {
  int32_t from, to;
  long n;
  double mass;
} DescentShare;

/* descent_open: object [p->n]. */
int descent_open(Descent *d, const Parts *p, const int32_t *object, long objects, Err *err);
void descent_close(Descent *d);

/* descent_shares: all pairs that share a particle, by from, then to; malloc'ed, *n of them. */
DescentShare *descent_shares(const Descent *before, const Descent *after, long *n, Err *err);

/* descent_main: progenitor [after + 1] and descendant [before + 1]: the index of the share with the
 * largest mass between two objects, equal ones the lower number; -1 where there is none. */
void descent_main(const DescentShare *share, long n, long before, long after, long *progenitor,
                  long *descendant);

/* descent_match: the place in d of each particle of e, -1 where d lacks it; [e->n]. */
void descent_match(const Descent *d, const Descent *e, long *place);

#endif
