/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points spread evenly over a sphere: stretched equal areas (SEA; Kegerreis et al. 2019, MNRAS 487,
 * 5029): two caps and collars of equal regions, collars near the poles drawn away from them. */
#ifndef SHELLS_H
#define SHELLS_H

#include <stdint.h>

/* shells_points: n >= 1 unit vectors x [n][3]; a tetrahedron for 4, around the equator for fewer.
 * Collars and sphere are turned at random by the seed. */
void shells_points(long n, uint64_t seed, double *x);

#endif
