/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CAMPAIGN_H
#define CAMPAIGN_H

#include "lib/group.h"

/* campaign_write: a table of one row, what a series of collisions is compared by: the masses of
 * both bodies of origin (0 target, 1 impactor), of the largest and the second largest remnant g[0]
 * and g[1] of n <= 2, and of what is in none (all but `bound` kg); the accretion efficiency
 * xi = (M_LR - M_target)/M_impactor, in all and per material; stripped_B: the part of body B that
 * is not in the remnant that holds most of it; the orbit of both remnants: e, v_inf, and the
 * deflection 2 asin(1/e) of a whole passage. nan where there is no such thing. Atomic. */
int campaign_write(const char *path, const char *file, const Parts *p, const Group *g, long n,
                   double bound, const Group *system, Err *err);

#endif
