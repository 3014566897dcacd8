/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles on grids: kernels beside their integrals, kept amounts, sums beside a loop over all
 * pairs, any number of threads. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include "lib/deposit.h"
#include "lib/rng.h"
#include "physics/kernel.h"

#define PI 3.14159265358979323846

/* The volume kernels are the solver's; a column is the integral of that in 3D along the line. */
static void kernels(void **state)
{
  (void)state;
  for (double q = 0; q < 1; q += 0.05) {
    double line = 0, end = sqrt(1 - q * q), ds = end / 20000;
    for (int k = 0; k < 20000; k++)
      line += 2 * ds * kernel_sigma(KERNEL_WENDLAND_C2, 3) *
              kernel_wendland_c2(3, sqrt(q * q + pow((k + 0.5) * ds, 2)));
    for (int d = 2; d <= 3; d++)
      assert_true(fabs(deposit_kernel(d == 3 ? DEPOSIT_3D : DEPOSIT_2D, (float)q) -
                       kernel_sigma(KERNEL_WENDLAND_C2, d) * kernel_wendland_c2(d, q)) < 1e-5);
    assert_true(fabs(deposit_kernel(DEPOSIT_COLUMN, (float)q) - line) < 1e-3 * 2.2282);
  }
  double whole = 0;
  for (int k = 0; k < 20000; k++) {
    double q = (k + 0.5) / 20000;
    whole += 2 * PI * q * deposit_kernel(DEPOSIT_COLUMN, (float)q) / 20000;
  }
  assert_true(fabs(whole - 1) < 2e-5);
}

enum { COUNT = 300 };
static DepositSpot spot[COUNT];
static float value[COUNT];

static void cloud(float least, float most, float margin, const float size[3])
{
  for (int i = 0; i < COUNT; i++) {
    float r[6];
    for (int k = 0; k < 6; k++) r[k] = (float)rng_uniform(3, (uint64_t)i, (uint32_t)k);
    spot[i] = (DepositSpot){{0}, least * powf(most / least, r[3]), 1 + r[4], 0};
    for (int a = 0; a < 3; a++) spot[i].x[a] = margin + (size[a] - 2 * margin) * r[a];
    value[i] = r[5];
  }
}

/* All amounts are on the grid, for supports from less than two cells to many. */
static void amounts_are_kept(void **state)
{
  (void)state;
  const int n[2][3] = {{60, 40, 30}, {200, 150, 1}};
  const float cell[2][3] = {{1, 1.5f, 2}, {0.5f, 0.7f, 1}};
  for (int flat = 0; flat < 2; flat++) {
    const float size[3] = {cell[flat][0] * (float)n[flat][0], cell[flat][1] * (float)n[flat][1],
                           cell[flat][2] * (float)n[flat][2]};
    float most = flat ? 20 : 12;
    const float *values[1] = {value};
    double sum = 0, mean = 0, all = 0, product = 0;
    Deposit d;
    cloud(flat ? 1.1f : 3, most, most + 2, size);
    assert_int_equal(
        deposit_new(&d, n[flat], cell[flat], flat ? DEPOSIT_COLUMN : DEPOSIT_3D, 1, 0, NULL), 0);
    d.exact = INFINITY;
    assert_int_equal(deposit_add(&d, spot, values, COUNT, NULL), 0);
    for (long k = 0; k < (long)n[flat][0] * n[flat][1] * n[flat][2]; k++)
      sum += d.sum[k], mean += d.mean[0][k];
    for (int i = 0; i < COUNT; i++) all += spot[i].amount, product += spot[i].amount * value[i];
    double volume = cell[flat][0] * cell[flat][1] * (flat ? 1 : cell[flat][2]);
    assert_true(fabs(sum * volume / all - 1) < 1e-6);
    assert_true(fabs(mean * volume / product - 1) < 1e-6);
    deposit_free(&d);
  }
}

/* Each cell is the sum over all particles, also over the edges; best is the largest term. */
static void as_a_loop_over_pairs(void **state)
{
  (void)state;
  const int n[3] = {23, 17, 11};
  const float cell[3] = {1, 0.8f, 1.3f}, size[3] = {23, 13.6f, 14.3f};
  const float *values[1] = {value};
  Deposit d;
  cloud(0.3f, 6, -2, size);
  for (int i = 0; i < COUNT; i++) spot[i].size = 0.7f;
  assert_int_equal(deposit_new(&d, n, cell, DEPOSIT_3D, 1, 1, NULL), 0);
  assert_int_equal(deposit_add(&d, spot, values, COUNT, NULL), 0);
  for (int c = 0; c < n[0] * n[1] * n[2]; c++) {
    double x[3] = {c % n[0] + 0.5, c / n[0] % n[1] + 0.5, c / n[0] / n[1] + 0.5}, sum = 0, mean = 0,
           best = 0, kind = 0, near = INFINITY;
    for (int i = 0; i < COUNT; i++) {
      double r2 = 0, h = spot[i].h, w;
      for (int a = 0; a < 3; a++) r2 += pow(x[a] * cell[a] - spot[i].x[a], 2);
      if (r2 >= h * h) continue;
      near = fmin(near, sqrt(r2));
      w = spot[i].amount * kernel_sigma(KERNEL_WENDLAND_C2, 3) / pow(h, 3) *
          kernel_wendland_c2(3, sqrt(r2) / h);
      sum += w, mean += w * value[i];
      if (w > best) best = w, kind = value[i];
    }
    assert_true(fabs(d.sum[c] - sum) <= 5e-5 * (1 + sum));
    assert_true(fabs(d.mean[0][c] - mean) <= 5e-5 * (1 + mean));
    assert_true(fabs(d.best[c] - best) <= 5e-5 * (1 + best));
    if (best > 1e-3) assert_true(fabs(d.kind[c] - kind) < 1e-6);
    if (fabs(near - 0.7) > 1e-5) assert_int_equal(d.inside[c], near < 0.7);
  }
  deposit_free(&d);
}

static void threads_do_not_matter(void **state)
{
  (void)state;
  const int n[3] = {64, 300, 1};
  const float cell[3] = {1, 1, 1}, size[3] = {64, 300, 1};
  const float *values[1] = {value};
  Deposit d[2];
  cloud(1, 40, 0, size);
  for (int k = 0; k < 2; k++) {
    omp_set_num_threads(1 + 2 * k);
    assert_int_equal(deposit_new(&d[k], n, cell, DEPOSIT_COLUMN, 1, 0, NULL), 0);
    d[k].exact = 6;
    assert_int_equal(deposit_add(&d[k], spot, values, COUNT, NULL), 0);
  }
  assert_memory_equal(d[0].sum, d[1].sum, 64 * 300 * sizeof(float));
  assert_memory_equal(d[0].mean[0], d[1].mean[0], 64 * 300 * sizeof(float));
  deposit_free(&d[0]), deposit_free(&d[1]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(kernels), cmocka_unit_test(amounts_are_kept),
                                     cmocka_unit_test(as_a_loop_over_pairs),
                                     cmocka_unit_test(threads_do_not_matter)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
