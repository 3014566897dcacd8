/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Philox 4x32-10 (Salmon et al. 2011, table 2 and sect. 3.3); the counter holds id and draw, the
 * key is the seed. */
#include <math.h>
#include "rng.h"

#define TWO_PI 6.28318530717958647692

/* The generator's published multipliers and Weyl constants (golden ratio, sqrt(3) - 1). */
static const uint32_t MUL0 = 0xD2511F53, MUL1 = 0xCD9E8D57, WEYL0 = 0x9E3779B9, WEYL1 = 0xBB67AE85;

void rng_philox(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4])
{
  uint32_t c0 = counter[0], c1 = counter[1], c2 = counter[2], c3 = counter[3];
  uint32_t k0 = key[0], k1 = key[1];
  for (int round = 0; round < 10; round++) {
    uint64_t a = (uint64_t)MUL0 * c0, b = (uint64_t)MUL1 * c2;
    c0 = (uint32_t)(b >> 32) ^ c1 ^ k0;
    c2 = (uint32_t)(a >> 32) ^ c3 ^ k1;
    c1 = (uint32_t)b;
    c3 = (uint32_t)a;
    k0 += WEYL0;
    k1 += WEYL1;
  }
  out[0] = c0, out[1] = c1, out[2] = c2, out[3] = c3;
}

static void draw_words(uint64_t seed, uint64_t id, uint32_t draw, uint32_t w[4])
{
  uint32_t counter[4] = {(uint32_t)id, (uint32_t)(id >> 32), draw, 0};
  uint32_t key[2] = {(uint32_t)seed, (uint32_t)(seed >> 32)};
  rng_philox(counter, key, w);
}

/* An odd multiple of 2^-53: exact, symmetric about 1/2, never 0 or 1. */
static double unit_interval(uint32_t low, uint32_t high)
{
  uint64_t bits = (uint64_t)high << 32 | low;
  return (double)(bits >> 11 | 1) * 0x1p-53;
}

double rng_uniform(uint64_t seed, uint64_t id, uint32_t draw)
{
  uint32_t w[4];
  draw_words(seed, id, draw, w);
  return unit_interval(w[0], w[1]);
}

double rng_normal(uint64_t seed, uint64_t id, uint32_t draw)
{
  uint32_t w[4];
  draw_words(seed, id, draw, w);
  return sqrt(-2 * log(unit_interval(w[0], w[1]))) * cos(TWO_PI * unit_interval(w[2], w[3]));
}

/* Shoemake (1992), Graphics Gems III, p. 124: a uniform unit quaternion from three uniform numbers.
 */
void rng_rotation(uint64_t seed, double m[3][3])
{
  const uint64_t nobody = UINT64_MAX; /* no particle has this id */
  double a = rng_uniform(seed, nobody, 0), b = TWO_PI * rng_uniform(seed, nobody, 1),
         c = TWO_PI * rng_uniform(seed, nobody, 2);
  double x = sqrt(1 - a) * sin(b), y = sqrt(1 - a) * cos(b), z = sqrt(a) * sin(c),
         w = sqrt(a) * cos(c);
  double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                    {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                    {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) m[i][j] = r[i][j];
}
