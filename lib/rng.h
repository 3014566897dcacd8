/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counter-based random numbers: a pure function of (seed, id, draw), so results do not depend on
 * the order of particles, on the number of threads or on the machine. Philox 4x32-10: Salmon et al.
 * (2011), SC'11, doi:10.1145/2063384.2063405. */
#ifndef RNG_H
#define RNG_H

#include <stdint.h>

/* rng_philox: four 32-bit words for a 64-bit key and a 128-bit counter. */
void rng_philox(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4]);

/* rng_uniform: uniform in (0, 1), never 0 or 1 (odd multiples of 2^-53), for draw number `draw` of
 * particle `id` under `seed`. */
double rng_uniform(uint64_t seed, uint64_t id, uint32_t draw);

/* rng_normal: standard normal deviate (Box-Muller), the same key. */
double rng_normal(uint64_t seed, uint64_t id, uint32_t draw);

/* rng_rotation: a uniformly distributed rotation matrix (Shoemake 1992 quaternion) for a seed.
 * m[3][3] row-major. */
void rng_rotation(uint64_t seed, double m[3][3]);

#endif
