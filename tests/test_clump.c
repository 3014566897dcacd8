/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bound bodies: spheres whose fate is known in closed form, and the invariances (Galilei, order,
 * threads). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include "lib/clump.h"
#include "lib/gravity.h"
#include "lib/group.h"
#include "lib/potential.h"
#include "lib/rng.h"
#include "lib/unit.h"

enum { ROOM = 8000 };
static double phi[ROOM];
static const double R = 1e5, RHO = 2000; /* m, kg/m^3 */
static const ClumpOptions POTENTIAL = {0, CLUMP_KINETIC, 1, 0.5, 20},
                          GROW = {1, CLUMP_KINETIC, 1, 0.5, 20};

static Parts *empty(void)
{
  Parts *p = part_new(ROOM);
  assert_int_equal(part_add(p, GROUP_FIELDS " p", NULL), 0);
  assert_int_equal(part_add_material(p, "basalt", "x", NULL), 0);
  p->n = 0;
  return p;
}

static void done(Parts *p)
{
  p->n = ROOM;
  part_free(p);
}

static void particle(Parts *p, double x, double y, double z, const double v[3], double d)
{
  long i = p->n++;
  assert_true(i < ROOM);
  p->id[i] = i, p->m[i] = RHO * d * d * d, p->rho[i] = RHO, p->h[i] = 2.2 * d;
  p->x[3 * i] = x, p->x[3 * i + 1] = y, p->x[3 * i + 2] = z;
  for (int a = 0; a < 3; a++) p->v[3 * i + a] = v[a];
}

/* A uniform sphere of radius r around (x, 0, 0), moving with v; returns its mass. */
static double sphere(Parts *p, double x, double r, const double v[3], int across)
{
  double d = r / across, mass = 0;
  for (int i = -across; i <= across; i++)
    for (int j = -across; j <= across; j++)
      for (int k = -across; k <= across; k++)
        if (i * i + j * j + k * k <= across * across)
          particle(p, x + i * d, j * d, k * d, v, d), mass += RHO * d * d * d;
  return mass;
}

static double mass_of(const Parts *p, const int32_t *id, int32_t k)
{
  double mass = 0;
  for (long i = 0; i < p->n; i++) mass += id[i] == k ? p->m[i] : 0;
  return mass;
}

static void cold_sphere_is_bound(void **state)
{
  (void)state;
  const double v[3] = {3e3, -1e3, 2e3}; /* far above its escape speed: only the frame */
  static int32_t id[ROOM];
  Parts *p = empty();
  double mass = sphere(p, 0, R, v, 8), level[CLUMP_LEVELS];
  assert_int_equal(clump_find(p, &POTENTIAL, id, phi, NULL), 1);
  assert_true(fabs(mass_of(p, id, 1) / mass - 1) < 1e-12);
  assert_int_equal(clump_find(p, &GROW, id, phi, NULL), 1);
  assert_true(fabs(mass_of(p, id, 1) / mass - 1) < 1e-12);
  long *start, *list;
  assert_int_equal(group_lists(p, id, 1, &start, &list, NULL), 0);
  assert_int_equal(clump_levels(p, list, p->n, phi, level, NULL), 0);
  for (int l = 0; l < CLUMP_LEVELS; l++) assert_true(fabs(level[l] / mass - 1) < 1e-12);
  free(start), free(list), done(p);
}

/* The deepest potential of a uniform sphere is 3/2 G M/R: u above it unbinds all at level 2, and
 * nothing at level 1; p/rho likewise at level 3. At u = 5/4 G M/R what lies within R/sqrt 2 is
 * bound: phi = G M (r^2 - 3 R^2)/(2 R^3). */
static void hot_sphere(void **state)
{
  (void)state;
  const double v[3] = {0};
  static int32_t id[ROOM];
  Parts *p = empty();
  double mass = sphere(p, 0, R, v, 8), depth = UNIT_G * mass / R, level[CLUMP_LEVELS];
  long list[ROOM];
  ClumpOptions thermal = POTENTIAL, enthalpy = POTENTIAL, grow = GROW;
  thermal.level = grow.level = CLUMP_THERMAL, enthalpy.level = CLUMP_ENTHALPY;
  for (long i = 0; i < p->n; i++) p->u[i] = 1.6 * depth, list[i] = i;
  assert_int_equal(clump_find(p, &POTENTIAL, id, phi, NULL), 1);
  assert_true(fabs(mass_of(p, id, 1) / mass - 1) < 1e-12);
  assert_int_equal(clump_find(p, &thermal, id, phi, NULL), 0);
  assert_int_equal(potential_own(p, list, p->n, 0.5, phi, NULL), 0);
  assert_int_equal(clump_levels(p, list, p->n, phi, level, NULL), 0);
  assert_true(fabs(level[0] / mass - 1) < 1e-12 && level[1] == 0 && level[2] == 0);
  for (long i = 0; i < p->n; i++) p->u[i] = 1.25 * depth;
  assert_int_equal(clump_levels(p, list, p->n, phi, level, NULL), 0);
  assert_true(fabs(level[1] / mass - pow(2, -1.5)) < 0.05);
  for (long i = 0; i < p->n; i++) p->u[i] = 0, p->p[i] = 1.6 * depth * RHO;
  assert_int_equal(clump_find(p, &thermal, id, phi, NULL), 1);
  assert_int_equal(clump_find(p, &enthalpy, id, phi, NULL), 0);
  for (long i = 0; i < p->n; i++) /* tension holds nothing together */
    p->p[i] = -1.6 * depth * RHO, p->u[i] = 1.6 * depth;
  assert_int_equal(clump_find(p, &enthalpy, id, phi, NULL), 0);
  free(p->p), p->p = NULL;
  assert_int_equal(potential_own(p, list, p->n, 0.5, phi, NULL), 0);
  assert_int_equal(clump_levels(p, list, p->n, phi, level, NULL), 0);
  assert_true(isnan(level[2]) && !isnan(level[1]));
  done(p);
}

/* Two spheres at a fraction f of their mutual escape speed. */
static Parts *pair(double f, double apart, double boost)
{
  Parts *p = empty();
  double zero[3] = {boost, 0, 0}, v[3] = {boost, 0, 0};
  double mass = sphere(p, 0, R, zero, 6);
  v[0] += f * sqrt(2 * UNIT_G * 2 * mass / apart);
  sphere(p, apart, R, v, 6);
  return p;
}

/* They are two bodies at 0.99 and 1.01, bound to each other at 0.99 only. */
static void two_spheres(void **state)
{
  (void)state;
  static int32_t id[ROOM];
  for (int fast = 0; fast < 2; fast++) {
    Parts *p = pair(fast ? 1.01 : 0.99, 5 * R, 0);
    long *start, *list;
    Group g[2];
    assert_int_equal(clump_find(p, &POTENTIAL, id, phi, NULL), 2);
    assert_true(fabs(mass_of(p, id, 1) / mass_of(p, id, 2) - 1) < 1e-12);
    assert_true(mass_of(p, id, 0) == 0);
    assert_int_equal(group_lists(p, id, 2, &start, &list, NULL), 0);
    for (int k = 0; k < 2; k++)
      group_measure(&g[k], p, list + start[k + 1], start[k + 2] - start[k + 1], 1, -1, NULL, NULL);
    GroupPair o = group_pair(g[0].x, g[0].v, g[0].mass, g[1].x, g[1].v, g[1].mass);
    assert_int_equal(o.orbit.beta > 0, !fast);
    assert_int_equal(clump_find(p, &GROW, id, phi, NULL), 2);
    group_free(&g[0]), group_free(&g[1]), free(start), free(list), done(p);
  }
}

/* A debris bridge makes them one fragment; they still are two bodies when they escape from each
 * other. */
static void bridge(void **state)
{
  (void)state;
  static int32_t id[ROOM];
  const double apart = 4 * R, d = R / 6;
  Parts *p = pair(1.3, apart, 0);
  long n = p->n;
  double speed = p->v[3 * (n - 1)];
  for (double x = R; x < apart - R; x += d) {
    const double v[3] = {speed * x / apart, 0, 0};
    particle(p, x, 0, 0, v, d);
  }
  assert_int_equal(clump_find(p, &POTENTIAL, id, phi, NULL), 2);
  for (long i = 0; i < n; i++) assert_int_equal(id[i], id[i < n / 2 ? 0 : n - 1]);
  assert_int_not_equal(id[0], id[n - 1]);
  done(p);
}

/* A moon on a circular orbit is a body of its own by potential, and part of the planet by growth
 * (004). */
static void moon(void **state)
{
  (void)state;
  static int32_t id[ROOM];
  Parts *p = empty();
  const double zero[3] = {0};
  double mass = sphere(p, 0, R, zero, 7), v[3] = {0, sqrt(UNIT_G * mass / (4 * R)), 0};
  double small = sphere(p, 4 * R, 0.3 * R, v, 2);
  assert_int_equal(clump_find(p, &POTENTIAL, id, phi, NULL), 2);
  assert_true(fabs(mass_of(p, id, 2) / small - 1) < 1e-12);
  assert_int_equal(clump_find(p, &GROW, id, phi, NULL), 1);
  assert_true(fabs(mass_of(p, id, 1) / (mass + small) - 1) < 1e-12);
  done(p);
}

/* Debris on its own belongs to the body below its escape speed sqrt(2 G M/r), for both methods. */
static void loose_particles(void **state)
{
  (void)state;
  static int32_t id[ROOM];
  const double boost[3] = {500, 0, 0};
  Parts *p = empty();
  double mass = sphere(p, 0, R, boost, 8);
  long n = p->n;
  for (int k = 0; k < 20; k++) {
    double r = (2 + k) * R, v[3] = {500, 0, (k % 2 ? 1.01 : 0.99) * sqrt(2 * UNIT_G * mass / r)};
    particle(p, 0, r, 0, v, R / 1000);
  }
  for (int m = 0; m < 2; m++) {
    assert_int_equal(clump_find(p, m ? &GROW : &POTENTIAL, id, phi, NULL), 1);
    for (long i = 0; i < p->n; i++) assert_int_equal(id[i], i < n || (i - n) % 2 == 0);
  }
  done(p);
}

static double plain_potential(const Parts *p, const unsigned char *in, long i)
{
  double sum = 0;
  for (long j = 0; j < p->n; j++) {
    const double r = group_apart(p->x + 3 * i, p->x + 3 * j), h = 0.5 * (p->h[i] + p->h[j]);
    if (j == i || !in[j]) continue;
    const double s = fmax(r, h);
    sum -= UNIT_G * p->m[j] / s * softening_potential(fmin(r / h, 1));
  }
  return sum;
}

/* Velocity of the lowest tenth (in mass) of the members, by repeated search for the next. */
static void plain_frame(const Parts *p, const unsigned char *in, const double *f, double v[3])
{
  static unsigned char used[ROOM];
  double mass = 0, sum = 0;
  memset(used, 0, sizeof used), v[0] = v[1] = v[2] = 0;
  for (long i = 0; i < p->n; i++) mass += in[i] ? p->m[i] : 0;
  while (sum < 0.1 * mass) {
    long low = -1;
    for (long i = 0; i < p->n; i++)
      if (in[i] && !used[i] && (low < 0 || f[i] < f[low])) low = i;
    for (int a = 0; a < 3; a++) v[a] += p->m[low] * p->v[3 * low + a];
    used[low] = 1, sum += p->m[low];
  }
  for (int a = 0; a < 3; a++) v[a] /= sum;
}

/* A hot sphere of which a part is bound, from all its particles inwards and outwards by plain sums
 * until nothing changes: the same body, by direct sums exactly, by the tree but for its error. */
static void energy_iteration(void **state)
{
  (void)state;
  static int32_t id[ROOM];
  static unsigned char in[ROOM], next[ROOM];
  static double f[ROOM];
  const double zero[3] = {0};
  for (int across = 4; across <= 7; across += 3) {
    Parts *p = empty();
    const double mass = sphere(p, 0, R, zero, across), v0 = sqrt(UNIT_G * mass / R);
    for (long i = 0; i < 3 * p->n; i++) p->v[i] = 0.58 * v0 * rng_normal(9, (uint64_t)i, 0);
    assert_int_equal(clump_find(p, &POTENTIAL, id, phi, NULL), 1);
    memset(in, 1, sizeof in);
    for (int round = 0, same = 0; !same; round++) {
      double v[3];
      assert_true(round < 100);
      for (long i = 0; i < p->n; i++) f[i] = plain_potential(p, in, i);
      plain_frame(p, in, f, v);
      for (long i = 0; i < p->n; i++) {
        double e = f[i];
        for (int a = 0; a < 3; a++) e += 0.5 * pow(p->v[3 * i + a] - v[a], 2);
        next[i] = e < 0;
      }
      same = !memcmp(in, next, (size_t)p->n);
      memcpy(in, next, sizeof in);
    }
    double bound = 0;
    for (long i = 0; i < p->n; i++) bound += in[i] ? p->m[i] : 0;
    assert_true(bound > 0.3 * mass && bound < 0.95 * mass);
    assert_true(fabs(mass_of(p, id, 1) - bound) <= (p->n <= 512 ? 1e-9 : 3e-3) * mass);
    done(p);
  }
}

static void nothing_bound(void **state)
{
  (void)state;
  static int32_t id[ROOM];
  Parts *p = empty();
  const double zero[3] = {0};
  double mass = sphere(p, 0, R, zero, 6), v = 10 * sqrt(2 * UNIT_G * mass / R);
  for (long i = 0; i < 3 * p->n; i++) p->v[i] = v * rng_normal(3, (uint64_t)i, 0);
  assert_int_equal(clump_find(p, &POTENTIAL, id, phi, NULL), 0);
  assert_int_equal(clump_find(p, &GROW, id, phi, NULL), 0);
  assert_true(mass_of(p, id, 0) > 0.999999 * mass);
  p->n = 1;
  assert_int_equal(clump_find(p, &POTENTIAL, id, phi, NULL), 0);
  assert_int_equal(clump_find(p, &GROW, id, phi, NULL), 0);
  done(p);
}

/* A messy state: two spheres, one spinning fast with shreds around it. Ids do not see boost, order
 * or threads. */
static void invariances(void **state)
{
  (void)state;
  static int32_t id[ROOM], again[ROOM];
  static long order[ROOM];
  Parts *p = pair(1.1, 4 * R, 0);
  double v0 = sqrt(2 * UNIT_G * RHO * R * R * 4.19);
  for (long i = 0; i < p->n; i++) p->v[3 * i + 1] += 0.58 * v0 * rng_normal(4, (uint64_t)i, 0);
  for (long i = 0; i < 500; i++) {
    double x[3], v[3];
    for (int a = 0; a < 3; a++) x[a] = 3 * R * rng_normal(5, (uint64_t)i, (uint32_t)a);
    for (int a = 0; a < 3; a++) v[a] = 0.58 * v0 * rng_normal(6, (uint64_t)i, (uint32_t)a);
    particle(p, x[0], x[1], x[2], v, R / 8);
  }
  for (int m = 0; m < 2; m++) {
    const ClumpOptions *o = m ? &GROW : &POTENTIAL;
    long n = clump_find(p, o, id, phi, NULL);
    assert_true(n >= 1 && mass_of(p, id, 0) > 0);
    omp_set_num_threads(1);
    assert_int_equal(clump_find(p, o, again, phi, NULL), n);
    assert_memory_equal(id, again, (size_t)p->n * sizeof *id);
    omp_set_num_threads(3);
    for (long i = 0; i < p->n; i++)
      order[i] = (i * 3163) % p->n, p->v[3 * i] += 700, p->v[3 * i + 2] -= 300;
    assert_int_equal(part_permute(p, order, NULL), 0);
    assert_int_equal(clump_find(p, o, again, phi, NULL), n);
    for (long i = 0; i < p->n; i++) assert_int_equal(again[i], id[order[i]]);
  }
  omp_set_num_threads(2);
  done(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(cold_sphere_is_bound),
                                     cmocka_unit_test(hot_sphere),
                                     cmocka_unit_test(two_spheres),
                                     cmocka_unit_test(bridge),
                                     cmocka_unit_test(moon),
                                     cmocka_unit_test(loose_particles),
                                     cmocka_unit_test(energy_iteration),
                                     cmocka_unit_test(nothing_bound),
                                     cmocka_unit_test(invariances)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
