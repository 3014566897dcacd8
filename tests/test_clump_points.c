/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Point masses among bound bodies: who is bound to one is known in closed form, in any frame; a
 * core holds gas that would not stay by itself; a star leaves to its planets what orbits them. And
 * the classes of a disk about one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "lib/clump.h"
#include "lib/disk.h"
#include "lib/group.h"
#include "lib/pointmass.h"
#include "lib/potential.h"
#include "lib/rng.h"
#include "lib/unit.h"

static const ClumpOptions POTENTIAL = {0, CLUMP_KINETIC, 1, 0.5, 20},
                          GROW = {1, CLUMP_KINETIC, 1, 0.5, 20};
static const double V[3] = {7e3, -2e3, 1e3}; /* of all: nothing may depend on it */

static Parts *some(long n, int points)
{
  Parts *p = part_new(n);
  assert_int_equal(part_add(p, GROUP_FIELDS " p", NULL), 0);
  assert_int_equal(part_add_material(p, "basalt", "x", NULL), 0);
  for (long i = 0; i < n; i++) {
    p->id[i] = i, p->m[i] = 1e8, p->rho[i] = 3000, p->h[i] = 100;
    memcpy(p->v + 3 * i, V, sizeof V);
  }
  p->point = calloc((size_t)points, sizeof *p->point), p->points = points;
  for (int k = 0; k < points; k++) memcpy(p->point[k].v, V, sizeof V);
  return p;
}

static void with_rows(Parts *p)
{
  const long n = p->n;
  assert_int_equal(pointmass_rows(p, NULL), 0);
  assert_true(p->n == n + p->points && p->id[n] == n && !pointmass_row(p, n - 1));
}

/* Shreds about a planet with energies of both signs. */
static void planet_holds_shreds(void **state)
{
  enum { N = 700 };
  static int32_t id[N + 1];
  static double phi[N + 1];
  const double M = 1e22;
  (void)state;
  for (int soft = 0; soft < 2; soft++)
    for (int grow = 0; grow < 2; grow++) {
      Parts *p = some(N, 1);
      long bound = 0;
      p->point[0].m = M, p->point[0].h = soft ? 5e5 : 0, p->point[0].x[0] = 3e9;
      for (long i = 0; i < N; i++) {
        for (int a = 0; a < 3; a++)
          p->x[3 * i + a] = 4e6 * rng_normal(1, (uint64_t)i, (uint32_t)a) + 3e9 * (a == 0),
                       p->v[3 * i + a] += 400 * rng_normal(2, (uint64_t)i, (uint32_t)a);
        p->x[3 * i + 2] += p->x[3 * i + 2] > 0 ? 6e5 : -6e5; /* outside of the softening */
      }
      with_rows(p);
      assert_int_equal(clump_find(p, grow ? &GROW : &POTENTIAL, id, phi, NULL), 1);
      assert_int_equal(id[N], 1);
      for (long i = 0; i < N; i++) {
        const double r = group_apart(p->x + 3 * i, p->point[0].x), v = group_apart(p->v + 3 * i, V);
        assert_int_equal(id[i], 0.5 * v * v < UNIT_G * M / r);
        if (id[i]) assert_true(fabs(phi[i] / (-UNIT_G * M / r) - 1) < 1e-9);
        bound += id[i];
      }
      assert_true(bound > N / 5 && bound < 4 * N / 5);
      p->point_rows = 0, p->n = N; /* without: nothing */
      assert_int_equal(clump_find(p, grow ? &GROW : &POTENTIAL, id, phi, NULL), 0);
      part_free(p);
    }
}

/* A uniform sphere of radius R about x with mass m a particle, from row `from` on; how many. */
static long sphere(Parts *p, long from, double x, double R, double m)
{
  const int across = 5;
  long n = from;
  for (int i = -across; i <= across; i++)
    for (int j = -across; j <= across; j++)
      for (int k = -across; k <= across; k++) {
        if (i * i + j * j + k * k > across * across) continue;
        const double d = R / across, at[3] = {x + i * d, j * d, k * d};
        if (p) memcpy(p->x + 3 * n, at, sizeof at), p->m[n] = m, p->h[n] = 2.2 * d;
        n++;
      }
  return n - from;
}

/* Hot gas, u = 1.6 G M/R: above the 1.5 that it could hold itself, far below what a core of five
 * times its mass adds at its edge. */
static void core_holds_gas(void **state)
{
  static int32_t id[1000];
  static double phi[1000];
  ClumpOptions o = POTENTIAL;
  const double R = 1e6, M = 1e20;
  const long n = sphere(NULL, 0, 0, R, 0);
  double level[CLUMP_LEVELS];
  long *start, *list;
  (void)state;
  o.level = CLUMP_THERMAL;
  for (o.grow = 0; o.grow < 2; o.grow++) {
    Parts *p = some(n, 1);
    sphere(p, 0, 0, R, M / (double)n);
    for (long i = 0; i < n; i++) p->u[i] = 1.6 * UNIT_G * M / R;
    assert_int_equal(clump_find(p, &o, id, phi, NULL), 0);
    p->point[0].m = 5 * M, p->point[0].h = .3 * R;
    with_rows(p);
    assert_int_equal(clump_find(p, &o, id, phi, NULL), 1);
    for (long i = 0; i <= n; i++) assert_int_equal(id[i], 1);
    assert_int_equal(group_lists(p, id, 1, &start, &list, NULL), 0);
    assert_int_equal(clump_levels(p, list, p->n, phi, level, NULL), 0);
    assert_true(fabs(level[CLUMP_THERMAL] / (6 * M) - 1) < 1e-12);
    free(start), free(list), part_free(p);
  }
}

/* A star, its planet, shreds about each, a fragment that holds itself close to the planet. */
static void star_and_planet(void **state)
{
  static int32_t id[1000];
  static double phi[1000];
  const double star = 2e30, planet = 1e25, a = 1.5e11, v = sqrt(UNIT_G * star / a);
  const long n = 60 + sphere(NULL, 0, 0, 1e6, 0);
  Parts *p = some(n, 2);
  (void)state;
  p->point[0].m = star, p->point[1].m = planet, p->point[1].x[0] = a, p->point[1].v[1] += v;
  sphere(p, 60, a + 3e8, 1e6, 1e20);
  for (long i = 0; i < n; i++) {
    const double phase = (double)i, r = i < 30 ? 1e7 * (1 + phase) : 1.2 * a;
    const double speed = sqrt(UNIT_G * (i < 30 ? planet : star) / r);
    p->v[3 * i + 1] += i < 30 || i >= 60 ? v : 0;
    if (i >= 60) continue;
    p->x[3 * i] = r * cos(phase) + (i < 30 ? a : 0), p->x[3 * i + 1] = r * sin(phase);
    p->v[3 * i] -= speed * sin(phase), p->v[3 * i + 1] += speed * cos(phase);
  }
  with_rows(p);
  assert_int_equal(clump_find(p, &POTENTIAL, id, phi, NULL), 3);
  assert_int_equal(id[n], 1), assert_int_equal(id[n + 1], 2);
  for (long i = 0; i < n; i++) assert_int_equal(id[i], i < 30 ? 2 : i < 60 ? 1 : 3);
  assert_int_equal(clump_find(p, &GROW, id, phi, NULL), 1);
  for (long i = 0; i < p->n; i++) assert_int_equal(id[i], 1);
  part_free(p);
}

/* Sums of a group, and the potential of each pair, with rows. */
static void sums(void **state)
{
  Parts *p = some(1, 2);
  Group g;
  double phi[3], want = 0;
  const double m[3] = {1e8, 4e8, 5e8};
  const long list[3] = {0, 1, 2};
  (void)state;
  p->point[0].m = m[1], p->point[0].x[1] = 300, p->point[1].m = m[2], p->point[1].x[2] = -400;
  with_rows(p);
  assert_int_equal(potential_own(p, list, 3, .5, phi, NULL), 0);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < i; j++)
      want -= UNIT_G * m[i] * m[j] / group_apart(p->x + 3 * i, p->x + 3 * j);
  assert_int_equal(group_system(&g, p, .5, NULL), 0);
  assert_true(fabs(g.e_pot / want - 1) < 1e-14 && fabs(g.mass / 1e9 - 1) < 1e-15);
  assert_true(fabs(phi[0] / (-UNIT_G * (4e8 / 300 + 5e8 / 400)) - 1) < 1e-14);
  assert_true(g.points == 2 && g.pointed == 9e8 && g.rho_max == 3000 && g.part[0] == 1e8);
  assert_true(fabs(g.x[1] - 120) < 1e-12 && fabs(g.x[2] + 200) < 1e-12);
  group_free(&g), part_free(p);
}

/* A planet as a sink of its size with five particles: orbit, fall, fly by, leave, below. */
static void disk_about_one(void **state)
{
  static const DiskClass want[6] = {DISK_DISK,   DISK_REIMPACT, DISK_FLYBY,
                                    DISK_ESCAPE, DISK_BODY,     DISK_BODY};
  const double M = 6e24, R = 6.4e6, v = sqrt(UNIT_G * M / (2 * R));
  const double speed[5][2] = {{0, v}, {0, .75 * v}, {-1.2 * v, 1.2 * v}, {2 * v, 0}, {0, 0}};
  const DiskOptions o = {.canup = 1};
  int32_t class[6];
  long list[6] = {0, 1, 2, 3, 4, 5};
  DiskBody b;
  Parts *p = some(5, 1), whole;
  (void)state;
  p->point[0].m = M, p->point[0].radius = R;
  for (int i = 0; i < 5; i++)
    p->x[3 * i] = i < 4 ? 2 * R : .5 * R, p->v[3 * i] += speed[i][0],
             p->v[3 * i + 1] += speed[i][1];
  with_rows(p);
  assert_int_equal(disk_find(p, list, 6, &o, class, &b, NULL), 0);
  for (int i = 0; i < 6; i++) assert_int_equal(class[i], want[i]);
  assert_true(fabs(b.radius / R - 1) < 1e-9 && fabs(b.mass / M - 1) < 1e-9);
  assert_int_equal(part_add(p, "clump disk", NULL), 0);
  p->clump[5] = 3, p->disk[5] = DISK_BODY;
  whole = pointmass_without(p);
  assert_true(whole.n == 5 && p->point[0].clump == 3 && p->point[0].disk == DISK_BODY);
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(planet_holds_shreds), cmocka_unit_test(core_holds_gas),
      cmocka_unit_test(star_and_planet), cmocka_unit_test(sums), cmocka_unit_test(disk_about_one)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
