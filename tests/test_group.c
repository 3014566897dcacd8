/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Properties of sets of particles against closed forms: rigid rotation, uniform sphere, Kepler
 * orbits; invariances. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "lib/group.h"
#include "lib/rng.h"
#include "lib/unit.h"

#define PI             3.14159265358979323846
#define CLOSE(A, B, E) assert_true(fabs((A) - (B)) <= (E))

enum { N = 4000 };

/* N random particles of unequal mass in a box of 2 x 3 x 5 (times 1e5 m), two materials, three
 * bodies. */
static Parts *cloud(void)
{
  Parts *p = part_new(N);
  assert_int_equal(part_add(p, "id x v m rho u h mat body damage pmax T", NULL), 0);
  assert_int_equal(part_add_material(p, "basalt", "x", NULL), 0);
  assert_int_equal(part_add_material(p, "porous_ice", "y", NULL), 1);
  for (long i = 0; i < N; i++) {
    uint64_t k = (uint64_t)i;
    p->id[i] = i + 1, p->m[i] = 1e15 * (1 + rng_uniform(1, k, 3)),
    p->rho[i] = 1000 + 2000 * rng_uniform(1, k, 4);
    p->u[i] = 1e3 * rng_uniform(1, k, 5), p->h[i] = 1e4, p->mat[i] = i % 3 == 0,
    p->body[i] = (int32_t)(i % 2 * 2);
    p->damage[i] = i % 4 == 0 ? 1 : 0.5, p->T[i] = (double)(i % 100);
    p->x[3 * i] = 2e5 * rng_uniform(1, k, 0), p->x[3 * i + 1] = 3e5 * rng_uniform(1, k, 1);
    p->x[3 * i + 2] = 5e5 * rng_uniform(1, k, 2);
    for (int a = 0; a < 3; a++) p->v[3 * i + a] = rng_normal(2, k, (uint32_t)a);
  }
  return p;
}

/* v = V + omega x (x - X): omega, L = I omega and E_kin = E_rot come out, whatever V, X and the
 * shape. */
static void rigid_rotation(void **state)
{
  (void)state;
  const double w[3] = {1e-4, -2e-4, 3e-4}, *i6;
  Parts *p = cloud();
  Group g;
  for (long i = 0; i < N; i++) {
    double *x = p->x + 3 * i, *v = p->v + 3 * i;
    v[0] = 1e4 + w[1] * x[2] - w[2] * x[1], v[1] = w[2] * x[0] - w[0] * x[2],
    v[2] = w[0] * x[1] - w[1] * x[0];
  }
  assert_int_equal(group_system(&g, p, -1, NULL), 0);
  for (int a = 0; a < 3; a++) CLOSE(g.omega[a], w[a], 1e-12);
  CLOSE(g.e_rot / g.e_kin, 1, 1e-9);
  CLOSE(g.period, 2 * PI / sqrt(14e-8), 1e-6);
  i6 = g.inertia;
  CLOSE((i6[0] * w[0] + i6[1] * w[1] + i6[2] * w[2]) / g.l[0], 1, 1e-9);
  CLOSE((g.moment[0] + g.moment[1] + g.moment[2]) / (i6[0] + i6[3] + i6[5]), 1, 1e-12);
  for (int k = 0; k < 3; k++) { /* I e = lambda e */
    double *e = g.axis[k];
    CLOSE(i6[0] * e[0] + i6[1] * e[1] + i6[2] * e[2], g.moment[k] * e[0], 1e-9 * g.moment[2]);
    CLOSE(i6[2] * e[0] + i6[4] * e[1] + i6[5] * e[2], g.moment[k] * e[2], 1e-9 * g.moment[2]);
  }
  assert_true(g.moment[0] < g.moment[1] && g.moment[1] < g.moment[2] && isnan(g.e_pot));
  group_free(&g), part_free(p);
}

static void composition(void **state)
{
  (void)state;
  Parts *p = cloud();
  Group g;
  double sum = 0, ice = 0, full = 0, mass = 0, from_1 = 0;
  assert_int_equal(group_system(&g, p, -1, NULL), 0);
  assert_int_equal(g.bodies, 3);
  for (int k = 0; k < 6; k++) sum += g.part[k];
  for (int c = 0; c < 2; c++) from_1 += g.part[c * 3 + 1];
  for (long i = 0; i < N; i++) {
    mass += p->m[i];
    if (p->mat[i] == 1) ice += p->m[i];
    if (p->damage[i] == 1) full += p->m[i];
  }
  CLOSE(sum / mass, 1, 1e-12), CLOSE(g.mass / mass, 1, 1e-12), CLOSE(g.water, ice / mass, 1e-12);
  CLOSE(g.damaged, full / mass, 1e-12), CLOSE(g.damage, 0.5 + 0.5 * full / mass, 1e-12);
  assert_true(from_1 == 0);
  const char *const wet[] = {"ice", "Ice", "water", "porous_ice", "ice-ih", "H2O.liquid"};
  const char *const dry[] = {"rice", "iceland_basalt", "basalt", "nice", "h2", "waterless"};
  for (int k = 0; k < 6; k++) assert_true(group_is_water(wet[k]) && !group_is_water(dry[k]));
  p->body[7] = -1;
  group_free(&g);
  Err err;
  assert_int_equal(group_system(&g, p, -1, &err), -1);
  assert_non_null(strstr(err.text, "particle 8: BodyID -1"));
  part_free(p);
}

/* The same bits for any order in the file; L, omega and energies do not see a boost. */
static void invariances(void **state)
{
  (void)state;
  Parts *p = cloud();
  Group g, h;
  long order[N];
  assert_int_equal(group_system(&g, p, 0.5, NULL), 0);
  for (long i = 0; i < N; i++) order[i] = (i * 1511) % N;
  assert_int_equal(part_permute(p, order, NULL), 0);
  assert_int_equal(group_system(&h, p, 0.5, NULL), 0);
  assert_memory_equal(g.part, h.part, 6 * sizeof *g.part);
  free(h.part), h.part = g.part;
  assert_memory_equal(&g, &h, sizeof g);
  for (long i = 0; i < N; i++) p->v[3 * i] += 1e3, p->v[3 * i + 2] -= 2e3;
  assert_int_equal(group_system(&h, p, -1, NULL), 0);
  CLOSE(h.v[0] - g.v[0], 1e3, 1e-9);
  CLOSE(h.e_kin / g.e_kin, 1, 1e-9);
  for (int a = 0; a < 3; a++) CLOSE(h.l[a], g.l[a], 1e-9 * g.mass * 1e5);
  group_free(&g), group_free(&h), part_free(p);
}

/* I = 2/5 M R^2, E_pot = -3/5 G M^2/R, r50 = R/2^(1/3): a lattice of 17,000 particles is uniform to
 * 1 %. Direct sums and the tree. */
static void uniform_sphere(void **state)
{
  (void)state;
  const int m = 16;
  const double R = 4e5, d = R / m;
  Parts *p = part_new(33 * 33 * 33);
  Group g;
  assert_int_equal(part_add(p, GROUP_FIELDS, NULL), 0);
  assert_int_equal(part_add_material(p, "basalt", "x", NULL), 0);
  p->n = 0;
  for (int k = 0; k < 33 * 33 * 33; k++) {
    double x = k % 33 - m, y = k / 33 % 33 - m, z = k / 33 / 33 - m;
    long i = p->n;
    if (x * x + y * y + z * z > m * m) continue;
    p->x[3 * i] = d * x, p->x[3 * i + 1] = d * y, p->x[3 * i + 2] = d * z;
    p->id[i] = i, p->m[i] = 2700 * d * d * d, p->rho[i] = 2700, p->h[i] = 2 * d, p->n++;
  }
  assert_int_equal(group_system(&g, p, 0.5, NULL), 0);
  CLOSE(g.inertia[0] / (0.4 * g.mass * R * R), 1, 0.01);
  CLOSE(g.moment[0] / g.moment[2], 1, 1e-9);
  CLOSE(g.e_pot / (-0.6 * UNIT_G * g.mass * g.mass / R), 1, 0.02);
  CLOSE(g.radius / R, 1, 0.01), CLOSE(g.r50 / (R * cbrt(0.5)), 1, 0.02), CLOSE(g.rho, 2700, 1e-6);
  assert_true(g.r50 < g.r90 && g.r90 < g.r99 && g.r99 <= R);
  assert_true(isinf(g.period));
  group_free(&g), p->n = 33 * 33 * 33, part_free(p);
}

static void one_particle(void **state)
{
  (void)state;
  Parts *p = cloud();
  Group g;
  long i = 12;
  assert_int_equal(group_measure(&g, p, &i, 1, 3, 0.5, NULL, NULL), 0);
  assert_true(g.n == 1 && g.mass == p->m[i] && g.e_pot == 0 && g.e_rot == 0 && isinf(g.period));
  assert_true(g.r99 == 0 && g.omega[0] == 0 && g.l[1] == 0);
  CLOSE(g.radius, cbrt(3 * p->m[i] / p->rho[i] / (4 * PI)), 1e-6);
  group_free(&g), part_free(p);
}

static void ranks_and_lists(void **state)
{
  (void)state;
  Parts *p = part_new(8);
  assert_int_equal(part_add(p, "id m", NULL), 0);
  const int64_t pid[] = {70, 60, 50, 40, 30, 20, 10, 80};
  const double m[] = {1, 1, 5, 1, 1, 2, 1, 2};
  int32_t id[] = {4, 4, 2, 3, 3, 0, 5, 1}; /* masses 2 2 5 2 2 . 1 2 */
  for (int i = 0; i < 8; i++) p->id[i] = pid[i], p->m[i] = m[i];
  assert_int_equal(group_rank(p, id, 5, 1, NULL), 5);
  const int32_t all[] = {3, 3, 1, 2, 2, 0, 5, 4};
  assert_memory_equal(id, all, sizeof all);
  long *start, *list;
  assert_int_equal(group_lists(p, id, 5, &start, &list, NULL), 0);
  assert_true(start[1] == 0 && start[2] == 1 && start[3] == 3 && start[6] == 7);
  assert_true(list[0] == 2 && list[1] == 4 && list[2] == 3 && list[3] == 1 && list[4] == 0);
  int32_t heavy[8];
  memcpy(heavy, id, sizeof id);
  assert_int_equal(group_heavy(p, heavy, 5, 2, NULL), 4); /* masses 5 2 2 2 1 */
  assert_true(heavy[2] == 1 && heavy[0] == 3 && heavy[7] == 4 && heavy[6] == 0 && heavy[5] == 0);
  assert_int_equal(group_heavy(p, heavy, 4, 6, NULL), 0);
  assert_int_equal(group_rank(p, id, 5, 2, NULL), 2); /* single particles go */
  assert_true(id[3] == 1 && id[0] == 2 && id[2] == 0 && id[7] == 0);
  free(start), free(list), part_free(p);
}

/* Circular: v = v_esc/sqrt 2, e = 0; at escape speed beta = 0; the test vector r_p of a disk
 * particle, RK4-checked in the reference. */
static void two_bodies(void **state)
{
  (void)state;
  const double M = 5.9722e24, zero[3] = {0}, x[3] = {2e7, 0, 1e6}, v[3] = {-1000, 4500, 200};
  GroupPair o = group_pair(zero, zero, M, x, v, 0);
  CLOSE(o.orbit.e, 0.22480693, 1e-8), CLOSE(o.orbit.rp / 1.668387e7, 1, 1e-6);
  CLOSE(o.v_r, (-1000 * 2e7 + 200 * 1e6) / o.r, 1e-9);
  const double y[3] = {0, 3e7, 0}, c[3] = {sqrt(UNIT_G * 2 * M / 3e7), 0, 0};
  o = group_pair(zero, zero, M, y, c, M);
  CLOSE(o.orbit.e, 0, 1e-7), CLOSE(o.v * sqrt(2) / o.v_esc, 1, 1e-12);
  assert_true(o.orbit.beta > 0);
  const double d[3] = {29801e3 + 31113e3, 0, 0}; /* 001 sect. 5.2, table 3: F1 and F2, 64 m/s */
  o = group_pair(zero, zero, 9.55e20, d, v, 9.17e20);
  CLOSE(o.v_esc, 64, 0.5);
}

/* A circle of radius r whose pole leans by 60 degrees to z, at an odd place; the rest of the system
 * is the other body; alone there is nothing to go about. */
static void orbits(void **state)
{
  (void)state;
  const double M = 6e24, m = 7e22, r = 4e8, v = sqrt(UNIT_G * (M + m) / r);
  Group a = {.mass = M, .x = {1e9, 0, 0}, .v = {500, 0, 0}, .l = {0, 0, 2}, .rho = 5500};
  Group b = {.mass = m, .x = {1e9 + r, 0, 0}, .v = {500, v * 0.5, v * sqrt(0.75)}, .rho = 3344};
  Group all = {.mass = M + m, .l = {0, 0, 1}};
  for (int k = 0; k < 3; k++) {
    all.x[k] = (M * a.x[k] + m * b.x[k]) / (M + m), all.v[k] = (M * a.v[k] + m * b.v[k]) / (M + m);
  }
  const GroupCentre c[3] = {group_centre(&a), group_rest(&all, &b), group_rest(&all, &all)};
  for (int k = 0; k < 3; k++) {
    char *text = NULL;
    size_t size;
    double e, s, q, big, incl, inf, roche;
    FILE *f = open_memstream(&text, &size);
    group_orbit_row(f, &b, &c[k]), fclose(f);
    assert_int_equal(
        sscanf(text, "%lf %lf %lf %lf %lf %lf %lf", &e, &s, &q, &big, &incl, &inf, &roche), 7);
    free(text);
    assert_true(isnan(inf) && isnan(e) == (k == 2) && isnan(roche) == (k == 2));
    if (k == 2) continue;
    CLOSE(e, 0, 1e-7), CLOSE(s / r, 1, 1e-7), CLOSE(q / r, 1, 1e-7), CLOSE(big / r, 1, 1e-7);
    CLOSE(incl, 60, 1e-6), CLOSE(roche / 1.85e7, 1, 0.01);
  }
}

/* As many cells in a row as names in the header, all of one line. */
/* Masses by phase, where a field outside the schema says them; temperatures. */
static void heat(void **state)
{
  (void)state;
  Parts *p = cloud();
  double *phase = part_add_extra(p, "PhaseID", "1", "", NULL), mass[3] = {0}, sum = 0;
  for (long i = 0; i < N; i++) {
    phase[i] = (double)(i % 5 == 0 ? 2 : i % 7 == 0);
    mass[(int)phase[i]] += p->m[i], sum += p->m[i] * (double)(i % 100);
  }
  Group g;
  char *text = NULL;
  size_t size;
  FILE *f = open_memstream(&text, &size);
  assert_int_equal(group_system(&g, p, -1, NULL), 0);
  for (int k = 0; k < 3; k++) CLOSE(g.phase[k] / mass[k], 1, 1e-12);
  CLOSE(g.T_mean, sum / g.mass, 1e-10), CLOSE(g.T_max, 99, 0);
  group_header(f, p, 3), fputc('\n', f), group_row(f, &g, &g, p), fclose(f);
  int tabs[2] = {0}, line = 0;
  for (char *s = text; *s; s++) tabs[line] += *s == '\t', line += *s == '\n';
  assert_int_equal(tabs[0], tabs[1]);
  assert_non_null(strstr(text, "\tphase_2 [kg]"));
  free(text), group_free(&g), part_free(p);
}

static void columns(void **state)
{
  (void)state;
  Parts *p = cloud();
  Group g;
  char *text = NULL;
  size_t size;
  FILE *f = open_memstream(&text, &size);
  assert_int_equal(group_system(&g, p, 0.7, NULL), 0);
  group_header(f, p, 3), fputc('\n', f), group_row(f, &g, &g, p), fclose(f);
  int tabs[2] = {0}, line = 0;
  for (char *s = text; *s; s++) tabs[line] += *s == '\t', line += *s == '\n';
  assert_int_equal(tabs[0], tabs[1]);
  assert_int_equal(line, 1);
  assert_non_null(strstr(text, "\tporous_ice_from_2 [kg]"));
  assert_null(strstr(text, "nan"));
  assert_null(strstr(text, "phase_"));
  free(text), group_free(&g), part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rigid_rotation), cmocka_unit_test(composition),
      cmocka_unit_test(invariances),    cmocka_unit_test(uniform_sphere),
      cmocka_unit_test(one_particle),   cmocka_unit_test(ranks_and_lists),
      cmocka_unit_test(two_bodies),     cmocka_unit_test(orbits),
      cmocka_unit_test(heat),           cmocka_unit_test(columns)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
