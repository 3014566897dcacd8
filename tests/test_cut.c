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
  const Cut nothing = {.planes = 0};
  Camera c = {.w = W, .h = W, .scale = W / 10.};
  Window win = {W, W, W, value, shade};
  long n = 0;
  camera_plane(&c, "xy");
  assert_int_equal(cut_sample(&win, p, &f, &c, whole ? &nothing : NULL, NULL), 0);
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
  const double z[] = {-5, -0.5, 0, 0.5, 0.9, 1.3};
  for (int k = 0; k < 6; k++) {
    const double x[1][3] = {{0, 0, z[k]}};
    Parts *p = spheres(1, x);
    double face = fmax(0, FACE * FACE - z[k] * z[k]), seen = fmax(face, z[k] <= 0);
    ABOUT(see(p, 0, 0), AREA(seen));
    long flat = 0;
    for (int i = 0; i < W * W; i++) flat += value[i] == 0 && shade[i] == 1;
    ABOUT(flat, AREA(face));      /* cut, they are somewhat larger */
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

/* Area in px of a quarter of a disc of radius FACE in the plane x = 0 as a pinhole at `eye` (1, 1,
 * 1)/sqrt(3) sees it: dA f^2 n.(eye - x)/Z^3. */
static double quarter(double eye, double scale)
{
  double sum = 0, e = eye / sqrt(3.), step = FACE / 200;
  for (int i = 0; i < 200; i++)
    for (int j = 0; j < 200; j++) {
      double y = (i + 0.5) * step, z = (j + 0.5) * step, depth = eye - (y + z) / sqrt(3.);
      if (y * y + z * z < FACE * FACE) sum += step * step * e / pow(depth, 3);
    }
  return sum * pow(scale * eye, 2);
}

/* An octant taken out of one big sphere, seen along the diagonal. */
static void wedges(void **state)
{
  (void)state;
  const double x[1][3] = {{0, 0, 0}}, eye[2] = {1e6, 30};
  const Cut octant = {.normal = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .planes = 3};
  Parts *p = spheres(1, x);
  float numbers[] = {0};
  Field f = {.value = numbers};
  for (int k = 0; k < 2; k++) {
    Camera c = {.w = W, .h = W, .scale = W / 3.};
    Window win = {W, W, W, value, shade};
    long faces = 0, all = 0;
    float bright[3] = {0};
    camera_turn(&c, atan(1), atan(sqrt(0.5)), 0);
    if (k) c.distance = eye[k];
    assert_int_equal(cut_sample(&win, p, &f, &c, &octant, NULL), 0);
    for (int a = 0; a < 9; a++) bright[a % 3] += (float)c.axis[a / 3][a % 3] * lamp[a / 3];
    for (int i = 0; i < W * W; i++) {
      all += value[i] == 0;
      for (int a = 0; a < 3; a++)
        faces += value[i] == 0 && fabsf(shade[i] - 0.8f - 0.2f * bright[a]) < 1e-5f;
    }
    assert_true(fabs((double)all / (3.14159 * c.scale * c.scale) - 1) < 0.02);
    assert_true(fabs((double)faces / (3 * quarter(eye[k], c.scale)) - 1) < 0.01);
  }
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_sphere), cmocka_unit_test(two_spheres),
                                     cmocka_unit_test(order_does_not_matter),
                                     cmocka_unit_test(wedges)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
