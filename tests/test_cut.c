/* SPDX-License-Identifier: GPL-3.0-or-later */
/* render --view cut: what a plane through spheres shows, in closed form. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <string.h>
#include "tools/render/camera.c"
#include "tools/render/cut.c"

enum { W = 200 };
static float value[W * W], shade[W * W];

/* n spheres of radius 1 at positions x, values 0, 1, ... */
static Parts *spheres(int n, const double x[][3])
{
  Parts *p = part_new(n);
  assert_int_equal(part_add(p, "id x m rho h", NULL), 0);
  for (int i = 0; i < n; i++) {
    p->id[i] = i, p->rho[i] = 1, p->m[i] = pow(1 / 0.68, 3), p->h[i] = 10;
    for (int a = 0; a < 3; a++) p->x[3 * i + a] = x[i][a];
  }
  return p;
}

static long see(const Parts *p, int whole, float wanted)
{
  float numbers[] = {0, 1, 2, 3};
  Field f = {.value = numbers};
  Camera c = {.w = W, .h = W, .scale = W / 10.};
  Window win = {W, W, W, value, shade};
  long n = 0;
  camera_plane(&c, "xy");
  assert_int_equal(cut_sample(&win, p, &f, &c, whole, NULL), 0);
  for (int k = 0; k < W * W; k++) n += value[k] == wanted;
  return n;
}

#define AREA(R2)           (3.14159265 * (R2) * (W / 10) * (W / 10))
#define ABOUT(N, EXPECTED) assert_true(fabs((double)(N) - (EXPECTED)) < 0.01 * (EXPECTED) + 8)

/* A disc of radius 1 from behind or through the centre; a cap of radius sqrt(1 - z^2) where most of
 * it is cut away; nothing. */
static void one_sphere(void **state)
{
  (void)state;
  const double z[] = {-5, -0.5, 0, 0.5, 0.9, 1.1};
  for (int k = 0; k < 6; k++) {
    const double x[1][3] = {{0, 0, z[k]}};
    Parts *p = spheres(1, x);
    double seen = z[k] <= 0 ? 1 : z[k] < 1 ? 1 - z[k] * z[k] : 0, face = fmax(0, 1 - z[k] * z[k]);
    ABOUT(see(p, 0, 0), AREA(seen));
    long flat = 0;
    for (int i = 0; i < W * W; i++) flat += value[i] == 0 && shade[i] == 1;
    ABOUT(flat, AREA(face));
    ABOUT(see(p, 1, 0), AREA(1)); /* uncut */
    part_free(p);
  }
}

/* The nearer of two spheres hides the other; cut open, the border of two equal cells lies half way.
 */
static void two_spheres(void **state)
{
  (void)state;
  const double behind[2][3] = {{0, 0, -3}, {0, 0, -6}}, front[2][3] = {{0, 0, 4}, {0, 0, -1}},
               beside[2][3] = {{-0.5, 0, 0}, {0.5, 0, 0}};
  Parts *p = spheres(2, behind);
  ABOUT(see(p, 0, 0), AREA(1)), assert_int_equal(see(p, 0, 1), 0);
  part_free(p), p = spheres(2, front);
  ABOUT(see(p, 0, 1), AREA(1)), assert_int_equal(see(p, 0, 0), 0);
  ABOUT(see(p, 1, 0), AREA(1)), assert_int_equal(see(p, 1, 1), 0);
  part_free(p), p = spheres(2, beside);
  see(p, 0, 0);
  for (int j = 0; j < W; j++)
    for (int i = 0; i < W; i++)
      if (!isnan(value[j * W + i])) assert_true(value[j * W + i] == (i >= W / 2));
  part_free(p);
}

/* Equally near spheres: the one with the lower id, in any order of particles. */
static void order_does_not_matter(void **state)
{
  (void)state;
  const double x[2][3] = {{0, 0, -2}, {0, 0, -2}};
  for (int swap = 0; swap < 2; swap++) {
    Parts *p = spheres(2, x);
    p->id[0] = swap, p->id[1] = 1 - swap;
    ABOUT(see(p, 0, (float)swap), AREA(1));
    part_free(p);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_sphere), cmocka_unit_test(two_spheres),
                                     cmocka_unit_test(order_does_not_matter)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
