/* SPDX-License-Identifier: GPL-3.0-or-later */
/* render --view slice: normalised interpolation keeps constants exactly and lines closely, and ends
 * where the matter ends. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <string.h>
#include "tools/render/camera.c"
#include "tools/render/slice.c"

enum { W = 128, M = 20 };
static float value[W * W], shade[W * W], quantity[M * M * M];

/* A cube of edge 1 with its corner in the origin, M^dimension particles. */
static Parts *cube(int dimension)
{
  long n = dimension == 2 ? M * M : M * M * M;
  Parts *p = part_new(n);
  assert_int_equal(part_add(p, "id x m rho h", NULL), 0);
  p->dimension = dimension;
  for (long i = 0; i < n; i++) {
    p->id[i] = i, p->rho[i] = 3, p->m[i] = 3 / pow(M, dimension), p->h[i] = 2.3 / M;
    p->x[3 * i] = (i % M + 0.5) / M, p->x[3 * i + 1] = (i / M % M + 0.5) / M;
    p->x[3 * i + 2] = dimension == 2 ? 0 : (i / M / M + 0.5) / M;
  }
  return p;
}

static void see(const Parts *p, int kinds, double z)
{
  Field f = {.value = quantity, .kinds = kinds};
  Camera c = {.w = W, .h = W, .scale = W / 1.25, .centre = {0.5, 0.5, 0}, .offset = z};
  Window win = {W, W, W, value, shade};
  camera_plane(&c, "xy");
  assert_int_equal(slice_sample(&win, p, &f, &c, NULL), 0);
}

/* Position of a pixel's centre. */
static double at(int i) { return 0.5 + (i + 0.5 - W / 2.) / (W / 1.25); }

static void constants_and_lines(void **state)
{
  (void)state;
  for (int d = 2; d <= 3; d++) {
    Parts *p = cube(d);
    for (int line = 0; line < 2; line++) {
      for (long i = 0; i < p->n; i++)
        quantity[i] = (float)(line ? 7 + 2 * p->x[3 * i] - p->x[3 * i + 1] : 4);
      see(p, 0, d == 2 ? 0 : 0.52);
      for (int j = 0; j < W; j++)
        for (int i = 0; i < W; i++) {
          double x = at(i), y = 1 - at(j), edge = fmin(fmin(x, 1 - x), fmin(y, 1 - y));
          float v = value[j * W + i];
          if (edge > 0.01)
            assert_false(isnan(v)); /* matter ends where half of the kernel is empty */
          if (edge < -0.01) assert_true(isnan(v));
          if (edge > 0.12) assert_true(fabs(v - (line ? 7 + 2 * x - y : 4)) < (line ? 0.01 : 1e-5));
        }
    }
    part_free(p);
  }
}

static void kinds_are_not_mixed(void **state)
{
  (void)state;
  Parts *p = cube(3);
  for (long i = 0; i < p->n; i++) quantity[i] = p->x[3 * i] < 0.5 ? 1 : 5;
  see(p, 1, 0.5);
  for (int k = 0; k < W * W; k++)
    assert_true(isnan(value[k]) || value[k] == (at(k % W) < 0.5 ? 1 : 5));
  part_free(p);
}

/* Beside the cube nothing; a lone particle shows as a disc of about its own size. */
static void emptiness(void **state)
{
  (void)state;
  Parts *p = cube(3);
  long n = 0;
  see(p, 0, 1.2);
  for (int k = 0; k < W * W; k++) assert_true(isnan(value[k]));
  p->n = 1, p->x[0] = p->x[1] = 0.5, p->x[2] = 0;
  see(p, 0, 0);
  for (int k = 0; k < W * W; k++) n += !isnan(value[k]);
  assert_true(fabs((double)n - 3.14159 * pow(0.55 / M * W / 1.25, 2)) < 4);
  p->n = M * M * M;
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(constants_and_lines),
                                     cmocka_unit_test(kinds_are_not_mixed),
                                     cmocka_unit_test(emptiness)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
