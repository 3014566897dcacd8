/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tracks: objects that go on from dump to dump (descent.h). */
#ifndef FOLLOW_H
#define FOLLOW_H

#include "descent.h"

typedef struct {
  long parent, into;  /* track that it came out of, that it went into; 0: none */
  double first, last; /* s: the dumps that it is in */
  double mass_first, mass_last, mass_max; /* kg */
  long dumps, object; /* how many; its object in the present dump, 0: it has ended */
} FollowTrack;

/* One object of a dump. */
typedef struct {
  long track, progenitor, descendant; /* objects of the dump before and after; 0: none */
  double inherited, passed;           /* part of its mass from the progenitor, in the descendant */
  double mass;                        /* kg */
} FollowObject;

typedef struct {
  FollowTrack *track; /* [1 .. tracks] */
  long tracks;
  Descent now;
  FollowObject *object; /* [1 .. now.objects] */
  int32_t *home;        /* [now.n] the last track that ended with this particle in it; 0: none */
} Follow;

/* follow_step: the next dump, its objects numbered 1 .. objects. *before gets the objects of the
 * dump before, their descendants now known (NULL at the first); the caller frees it. */
int follow_step(Follow *f, const Parts *p, const int32_t *object, long objects,
                FollowObject **before, Err *err);
void follow_close(Follow *f);

#endif
