/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A track goes on where object and progenitor are each other's main ones. One that ended, as two
 * bodies that touch are one for a while, goes on when an object appears that holds most of it and
 * is mostly made of it. */
#include <stdlib.h>
#include <string.h>
#include "follow.h"

static int more_tracks(Follow *f, long n, Err *err)
{
  void *more = realloc(f->track, (size_t)(f->tracks + n + 1) * sizeof *f->track);
  if (!more) return err_set(err, "out of memory for %ld tracks", f->tracks + n);
  f->track = more;
  return 0;
}

static void put(Follow *f, long track, long object, double time)
{
  FollowTrack *t = &f->track[track];
  FollowObject *o = &f->object[object];
  o->track = track, t->object = object, t->last = time, t->mass_last = o->mass, t->dumps++;
  if (o->mass > t->mass_max) t->mass_max = o->mass;
}

static void begin(Follow *f, long object, long parent, double time)
{
  f->track[++f->tracks] =
      (FollowTrack){.parent = parent, .first = time, .mass_first = f->object[object].mass};
  put(f, f->tracks, object, time);
}

static void fill(Follow *f)
{
  for (long k = 0; k < f->now.n; k++)
    if (f->now.object[k]) f->object[f->now.object[k]].mass += f->now.m[k];
}

/* Tracks that ended and whose particles an object without one is made of: more than half of either
 * is the other's. */
static int revive(Follow *f, double time, Err *err)
{
  const Descent *d = &f->now;
  Descent homes = *d;
  long n, *up = malloc((size_t)(d->objects + 1) * sizeof *up),
          *down = malloc((size_t)(f->tracks + 1) * sizeof *down);
  homes.object = f->home, homes.objects = f->tracks;
  DescentShare *share = up && down ? descent_shares(&homes, d, &n, err) : NULL;
  if (share) descent_main(share, n, f->tracks, d->objects, up, down);
  for (long o = 1; o <= d->objects && share; o++) {
    if (f->object[o].track || up[o] < 0) continue;
    const DescentShare *s = &share[up[o]];
    FollowTrack *t = &f->track[s->from];
    if (t->object || 2 * s->mass <= f->object[o].mass || 2 * s->mass <= t->mass_last) continue;
    t->into = 0, put(f, s->from, o, time);
  }
  if (!up || !down) err_set(err, "out of memory for %ld objects", d->objects);
  free(up), free(down), free(share);
  return share ? 0 : -1;
}

/* Where the particles' last ended tracks are, in the order of the present dump; then those that end
 * now. `was`: the dump before, old: its objects, place: of each particle there. */
static void settle_homes(Follow *f, const Descent *was, const FollowObject *old,
                         const int32_t *before, const long *place)
{
  for (long k = 0; k < f->now.n; k++) {
    if (place[k] < 0) continue;
    const long o = was->object[place[k]];
    f->home[k] = before[place[k]];
    if (o && !f->track[old[o].track].object) f->home[k] = (int32_t)old[o].track;
  }
}

/* Progenitors and descendants of old and new objects, and the tracks that go on. */
static void descend(Follow *f, const DescentShare *share, const long *up, const long *down,
                    FollowObject *old, long olds, double time)
{
  for (long a = 1; a <= olds; a++) {
    f->track[old[a].track].object = 0;
    if (down[a] < 0) continue;
    old[a].descendant = share[down[a]].to, old[a].passed = share[down[a]].mass / old[a].mass;
  }
  for (long b = 1; b <= f->now.objects; b++) {
    if (up[b] < 0) continue;
    FollowObject *o = &f->object[b];
    o->progenitor = share[up[b]].from, o->inherited = share[up[b]].mass / o->mass;
    if (old[o->progenitor].descendant == b) put(f, old[o->progenitor].track, b, time);
  }
}

/* What is new, and what has ended, at the end. */
static void births(Follow *f, const FollowObject *old, long olds, double time)
{
  for (long b = 1; b <= f->now.objects; b++)
    if (!f->object[b].track) {
      const long from = f->object[b].progenitor;
      begin(f, b, from ? old[from].track : 0, time);
    }
  for (long a = 1; a <= olds; a++) {
    FollowTrack *t = &f->track[old[a].track];
    if (!t->object) t->into = old[a].descendant ? f->object[old[a].descendant].track : 0;
  }
}

static int step(Follow *f, const Descent *was, FollowObject *old, const int32_t *before,
                double time, Err *err)
{
  const long olds = was->objects, news = f->now.objects;
  long n, *up = malloc((size_t)(olds + news + 2) * sizeof *up), *down = up + news + 1,
          *place = malloc((size_t)(f->now.n + 1) * sizeof *place);
  DescentShare *share = up && place ? descent_shares(was, &f->now, &n, err) : NULL;
  int failed = share ? 0 : err_set(err, "out of memory for %ld particles", f->now.n);
  if (!failed) {
    descent_main(share, n, olds, news, up, down);
    descend(f, share, up, down, old, olds, time);
    descent_match(was, &f->now, place);
    settle_homes(f, was, old, before, place);
    failed = revive(f, time, err);
  }
  if (!failed) births(f, old, olds, time);
  free(up), free(place), free(share);
  return failed;
}

int follow_step(Follow *f, const Parts *p, const int32_t *object, long objects,
                FollowObject **before, Err *err)
{
  Descent was = f->now;
  int32_t *home = f->home;
  FollowObject *old = f->object;
  int failed = descent_open(&f->now, p, object, objects, err);
  f->object = calloc((size_t)objects + 1, sizeof *f->object);
  f->home = calloc((size_t)p->n + 1, sizeof *f->home);
  if (!failed && (!f->object || !f->home || more_tracks(f, objects, err)))
    failed = err_set(err, "out of memory for %ld particles", p->n);
  if (!failed) fill(f);
  if (!failed && old) failed = step(f, &was, old, home, p->time, err);
  if (!failed && !old)
    for (long b = 1; b <= objects; b++) begin(f, b, 0, p->time);
  descent_close(&was), free(home);
  if (before && !failed)
    *before = old;
  else
    free(old);
  return failed;
}

void follow_close(Follow *f)
{
  descent_close(&f->now);
  free(f->object), free(f->home), free(f->track);
  *f = (Follow){0};
}
