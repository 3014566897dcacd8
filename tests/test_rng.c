/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random numbers: Philox against its published vectors, distributions against theory, and no trace
 * of one coordinate of the key (seed, id, draw) in another. Bounds are five standard deviations of
 * the estimate. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>
#include "lib/rng.h"

enum { MANY = 200000 };

/* Random123 1.14, tests/kat_vectors, "philox4x32 10". */
static void published_vectors(void **state)
{
  static const struct {
    uint32_t counter[4], key[2], out[4];
  } T[] = {
      {{0}, {0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
      {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
       {0xffffffff, 0xffffffff},
       {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
      {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
       {0xa4093822, 0x299f31d0},
       {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
  };
  (void)state;
  for (int k = 0; k < 3; k++) {
    uint32_t out[4];
    rng_philox(T[k].counter, T[k].key, out);
    assert_memory_equal(out, T[k].out, sizeof out);
  }
}

/* One coordinate of the key runs (by a step that may be large), the others stand. */
typedef struct {
  uint64_t seed, id;
  uint32_t draw;
} Key;

static Key key_of(int axis, uint64_t k)
{
  Key walks[] = {{7, k, 3}, {7, k << 32, 3}, {7, 5, (uint32_t)k}, {k, 5, 3}, {k << 32, 5, 3}};
  return walks[axis];
}
enum { AXES = 5 };

static double uniform_at(Key k) { return rng_uniform(k.seed, k.id, k.draw); }

/* Mean 1/2, variance 1/12, serial correlation 0, and chi^2 in 256 bins, whatever part of the key
 * counts. */
static void uniform_along_every_axis(void **state)
{
  (void)state;
  for (int axis = 0; axis < AXES; axis++) {
    static double bins[256];
    double mean = 0, square = 0, serial = 0, chi2 = 0, last = 0;
    for (int b = 0; b < 256; b++) bins[b] = 0;
    for (int k = 0; k < MANY; k++) {
      double u = uniform_at(key_of(axis, (uint64_t)k)), x = u - 0.5;
      assert_true(u > 0 && u < 1);
      mean += x / MANY, square += x * x / MANY, serial += x * last / MANY, last = x;
      bins[(int)(256 * u)]++;
    }
    for (int b = 0; b < 256; b++) chi2 += pow(bins[b] - MANY / 256., 2) / (MANY / 256.);
    assert_true(fabs(mean) < 5 * sqrt(1. / 12 / MANY));
    assert_true(fabs(square - 1. / 12) < 5 * sqrt(1. / 180 / MANY));
    assert_true(fabs(serial) < 5 * sqrt(1. / 144 / MANY));
    assert_true(fabs(chi2 - 255) < 5 * sqrt(2 * 255.));
  }
}

/* Streams of neighbouring seeds, ids and draws, compared number by number, are uncorrelated. */
static void neighbouring_streams_are_independent(void **state)
{
  (void)state;
  for (int other = 0; other < 3; other++) {
    double sum = 0;
    for (int k = 0; k < MANY; k++) {
      uint64_t id = (uint64_t)k;
      double a = rng_uniform(1, id, 0),
             b = rng_uniform(1 + (other == 0), id + (other == 1), other == 2);
      sum += (a - 0.5) * (b - 0.5);
    }
    assert_true(fabs(sum / MANY) < 5 * sqrt(1. / 144 / MANY));
  }
}

/* The high halves of seed and id count: a 32-bit truncation would repeat numbers. */
static void all_bits_of_the_key_count(void **state)
{
  (void)state;
  for (int b = 0; b < 64; b++) {
    assert_true(rng_uniform(0, 0, 0) != rng_uniform((uint64_t)1 << b, 0, 0));
    assert_true(rng_uniform(0, 0, 0) != rng_uniform(0, (uint64_t)1 << b, 0));
    if (b < 32) assert_true(rng_uniform(0, 0, 0) != rng_uniform(0, 0, (uint32_t)1 << b));
  }
}

static int ascending(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Kolmogorov-Smirnov distance to the normal distribution; 1.95/sqrt(n) is passed in 999 of 1000
 * cases. */
static void normal(void **state)
{
  static double x[MANY];
  double distance = 0;
  (void)state;
  for (int k = 0; k < MANY; k++) x[k] = rng_normal(11, (uint64_t)k, 0);
  qsort(x, MANY, sizeof *x, ascending);
  for (int k = 0; k < MANY; k++) {
    double cdf = 0.5 * erfc(-x[k] / sqrt(2.));
    distance =
        fmax(distance, fmax(fabs(cdf - (double)k / MANY), fabs(cdf - (double)(k + 1) / MANY)));
  }
  assert_true(distance < 1.95 / sqrt(MANY));
}

/* Proper rotations, and an isotropic one: each axis is carried to a mean of 0 and <x_i x_j> =
 * delta_ij/3. */
static void rotation(void **state)
{
  enum { TURNS = 20000 };
  double mean[9] = {0}, square[9] = {0};
  (void)state;
  for (int k = 0; k < TURNS; k++) {
    double m[3][3];
    rng_rotation((uint64_t)k, m);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        double dot = m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2];
        assert_true(fabs(dot - (i == j)) < 1e-14);
        mean[3 * i + j] += m[i][j] / TURNS;
        square[3 * i + j] += m[i][j] * m[i][j] / TURNS;
      }
    double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                 m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                 m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    assert_true(fabs(det - 1) < 1e-14);
  }
  for (int k = 0; k < 9; k++) {
    assert_true(fabs(mean[k]) < 5 * sqrt(1. / 3 / TURNS));
    assert_true(fabs(square[k] - 1. / 3) < 5 * sqrt(4. / 45 / TURNS)); /* <x^4> = 1/5 */
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(published_vectors),
      cmocka_unit_test(uniform_along_every_axis),
      cmocka_unit_test(neighbouring_streams_are_independent),
      cmocka_unit_test(all_bits_of_the_key_count),
      cmocka_unit_test(normal),
      cmocka_unit_test(rotation),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
