/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friends of friends: two particles are friends when r_ij < link (h_i + h_j)/2, and a fragment is
 * what friendship connects (symmetric, one multiplier for every shell;
 * corrects 004 sect. 2.4.6). h is the full support, so link = 1 joins particles that interact,
 * which is also 001's choice (sect. 5.2). Neither the order of particles nor the number of threads
 * changes the result. */
#ifndef FOF_H
#define FOF_H

#include "part.h"

/* fof_find: fragments among the particles with keep[i] != 0 (NULL: all; others link nothing). Those
 * with at least `least` particles get id [p->n] 1, 2, ... by descending mass, equal masses by their
 * lowest particle id; all other particles 0. Needs id x m h. Returns the number of fragments, or
 * -1. */
long fof_find(const Parts *p, double link, const unsigned char *keep, long least, int32_t *id,
              Err *err);

#endif
