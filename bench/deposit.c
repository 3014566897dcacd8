/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles onto grids, as render and grid do: checks that the mass is there, then prints the time:
 * bench/deposit [N]. A cube of N particles on a jittered lattice, 57 neighbours each. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "lib/deposit.h"
#include "lib/progress.h"
#include "lib/rng.h"

static Err err;

static void need(int failed)
{
  if (failed) err_die("%s", err.text);
}

/* In units of cells of a grid that the cube fills to 0.9. */
static DepositSpot *cube(long side, const int n[3])
{
  DepositSpot *s = malloc((size_t)(side * side * side) * sizeof *s);
  float edge = 0.9f * (float)(n[0] < n[1] ? n[0] : n[1]), step = edge / (float)side;
  if (!s) err_die("no memory");
  for (long i = 0; i < side * side * side; i++) {
    const long at[3] = {i % side, i / side % side, i / side / side};
    for (int a = 0; a < 3; a++)
      s[i].x[a] = (float)n[a] / 2 + step * ((float)at[a] - (float)side / 2 +
                                            (float)rng_uniform(1, (uint64_t)i, (uint32_t)a));
    s[i].h = 2.39f * step, s[i].amount = 1, s[i].size = 0; /* 4/3 pi 2.39^3 = 57 */
  }
  return s;
}

static void one(const char *name, long side, const int n[3], DepositShape shape)
{
  static const float cell[3] = {1, 1, 1};
  const long count = side * side * side;
  DepositSpot *s = cube(side, n);
  float *value = calloc((size_t)count, sizeof *value);
  const float *values[1] = {value};
  double best = INFINITY, sum = 0;
  if (!value) err_die("no memory");
  for (int repeat = 0; repeat < 3; repeat++) {
    Deposit d;
    need(deposit_new(&d, n, cell, shape, 1, 0, &err));
    d.exact = 6;
    double began = progress_clock();
    need(deposit_add(&d, s, values, count, &err));
    best = fmin(best, progress_clock() - began), sum = 0;
    for (long k = 0; k < (long)n[0] * n[1] * n[2]; k++) sum += d.sum[k];
    deposit_free(&d);
  }
  if (!(fabs(sum / (double)count - 1) < 1e-3))
    err_die("%s: %g of %ld are on the grid", name, sum, count);
  printf("%s\t%dx%dx%d\t%ld\t%.3f s\t%.0f ns a particle\n", name, n[0], n[1], n[2], count, best,
         1e9 * best / (double)count);
  free(s), free(value);
}

int main(int argc, char **argv)
{
  err_program("bench/deposit");
  long side = lround(cbrt(argc > 1 ? atof(argv[1]) : 1e6));
  printf("# what\tcells\tparticles\ttime\n");
  one("column", side, (const int[3]){1920, 1080, 1}, DEPOSIT_COLUMN);
  one("volume", side, (const int[3]){128, 128, 128}, DEPOSIT_3D);
  return 0;
}
