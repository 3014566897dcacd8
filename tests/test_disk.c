/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Classes by orbit against orbits whose closest approach was integrated; bodies of known edge with
 * known particles around; a rotating spheroid; invariances. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include "lib/disk.h"
#include "lib/group.h"
#include "lib/rng.h"
#include "lib/unit.h"

#define CLOSE(A, B, E) assert_true(fabs((A) - (B)) <= (E)*fabs(B))

enum { ROOM = 20000 };
static const double R = 1e6, RHO = 3000; /* m, kg/m^3 */
static const double FLOOR[] = {2000};
static const DiskOptions REUFER = {0, 0, FLOOR, 0.5}, CANUP = {1, 0, FLOOR, 0.5};

/* Five states about 5.9722e24 kg with R = 6.5e6 m; e, pericentre and class; the minimum distance of
 * a Runge-Kutta integration is r_p, except for the outbound one. */
static void integrated_orbits(void **state)
{
  (void)state;
  static const struct {
    double r[3], v[3], e, rp;
    DiskClass class;
  } known[] = {{{2e7, 0, 1e6}, {-1000, 4500, 200}, 0.22480693, 1.668387e7, DISK_DISK},
               {{1.5e7, 2e6, 0}, {2000, 2500, 100}, 0.83651451, 1.536174e6, DISK_REIMPACT},
               {{1.2e7, 0, 0}, {8000, 5000, 0}, 1.22935221, 4.051201e6, DISK_ESCAPE},
               {{3e7, 0, 0}, {-7000, 1000, 0}, 1.06428363, 1.093788e6, DISK_REIMPACT},
               {{3e7, 0, 0}, {-5000, 4000, 0}, 1.51904729, 1.434122e7, DISK_FLYBY}};
  const double mu = 6.67430e-11 * 5.9722e24;
  for (int k = 0; k < 5; k++)
    for (int canup = 0; canup < 2; canup++) {
      Orbit o;
      const DiskClass kept = canup && k == 1 ? DISK_BODY : known[k].class; /* h^2/mu = 2.8e6 m */
      assert_int_equal(disk_classify(canup, 6.5e6, mu, known[k].r, known[k].v, &o), kept);
      CLOSE(o.e, known[k].e, 1e-7), CLOSE(o.rp, known[k].rp, 1e-6);
    }
  /* bound, r_p < R < h^2/mu: circularised it stays outside; with less spin it does not */
  Orbit o;
  const double r[3] = {1.5e7, 0, 0}, v[3] = {0, 3600, 0}, w[3] = {0, 3300, 0};
  assert_int_equal(disk_classify(1, 6.5e6, mu, r, v, &o), DISK_REIMPACT);
  assert_true(o.rp < 6.5e6 && o.p > 6.5e6);
  assert_int_equal(disk_classify(1, 6.5e6, mu, r, w, &o), DISK_BODY);
  assert_int_equal(disk_classify(0, 6.5e6, mu, r, w, &o), DISK_REIMPACT);
  assert_true(o.p < 6.5e6);
}

static Parts *empty(void)
{
  Parts *p = part_new(ROOM);
  assert_int_equal(part_add(p, GROUP_FIELDS, NULL), 0);
  assert_int_equal(part_add_material(p, "rock", "x", NULL), 0);
  p->n = 0;
  return p;
}

static void done(Parts *p)
{
  p->n = ROOM;
  part_free(p);
}

static void particle(Parts *p, const double x[3], const double v[3], double m, double rho)
{
  const long i = p->n++;
  assert_true(i < ROOM);
  p->id[i] = 7 * i + 5, p->m[i] = m, p->rho[i] = rho, p->h[i] = 0.15 * R;
  memcpy(p->x + 3 * i, x, 3 * sizeof *x), memcpy(p->v + 3 * i, v, 3 * sizeof *v);
}

/* A uniform spheroid of equator a, pole c, that spins about z; particles in the outermost layer,
 * about half a spacing deep, are light. Returns its mass. */
static double spheroid(Parts *p, double a, double c, double omega, int across)
{
  const double d = a / across;
  double mass = 0;
  for (int i = -across; i <= across; i++)
    for (int j = -across; j <= across; j++)
      for (int k = -across; k <= across; k++) {
        const double x[3] = {(i + 0.5) * d, (j + 0.5) * d, (k + 0.5) * d};
        const double v[3] = {-omega * x[1], omega * x[0], 0};
        const double q = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] * a * a / (c * c));
        if (q > a) continue;
        particle(p, x, v, RHO * d * d * d, q > a - d ? 0.5 * RHO : RHO);
        mass += RHO * d * d * d;
      }
  return mass;
}

static long *all(const Parts *p)
{
  long *list = malloc((size_t)p->n * sizeof *list);
  assert_int_equal(group_order(p, list, NULL), 0);
  return list;
}

/* A planet at an odd place and speed, and what goes around it: circular at 3 R; to 0.5 R, where
 * h^2/mu < R; thrown up; thrown out; passing by; on a hyperbola that hits. */
static Parts *planet(double *mass, int32_t *is)
{
  Parts *p = empty();
  *mass = spheroid(p, R, R, 0, 12);
  const long n = p->n;
  for (long i = 0; i < n; i++) is[i] = DISK_BODY;
  for (int k = 0; k < 200; k++) {
    const double t = 0.1 * k, mu = UNIT_G * *mass, r = (3 + 0.01 * k) * R, c = cos(t), s = sin(t);
    const double x[3] = {r * c, r * s, 0}, circle = sqrt(mu / r), out = sqrt(2) * circle;
    const double down = sqrt(mu * R / (r * (r + 0.5 * R))); /* from r to 0.5 R */
    const double along[5] = {circle, down, 0.1 * circle, 0.9 * out, 0.1 * out},
                 up[5] = {0, 0, 1.3 * out, -0.9 * out, -1.3 * out};
    static const DiskClass want[5] = {DISK_DISK, DISK_REIMPACT, DISK_ESCAPE, DISK_FLYBY,
                                      DISK_REIMPACT};
    const double v[3] = {up[k % 5] * c - along[k % 5] * s, up[k % 5] * s + along[k % 5] * c, 0};
    is[p->n] = want[k % 5];
    particle(p, x, v, 1e-9 * *mass, 1);
  }
  for (long i = 0; i < p->n; i++)
    for (int a = 0; a < 3; a++) p->x[3 * i + a] += 1e7 * (a + 1), p->v[3 * i + a] += 3e3 * (a - 2);
  return p;
}

/* The sphere of reufer lies in the light layer, and leaves some of it outside, at rest, to fall
 * back; that of canup has the volume of its particles. */
static void known_classes(void **state)
{
  (void)state;
  static int32_t is[ROOM], class[ROOM];
  double mass;
  Parts *p = planet(&mass, is);
  long *list = all(p);
  for (int canup = 0; canup < 2; canup++) {
    DiskBody b;
    long layer = 0, body = 0;
    while (is[body] == DISK_BODY) body++;
    assert_int_equal(disk_find(p, list, p->n, canup ? &CANUP : &REUFER, class, &b, NULL), 0);
    for (long i = 0; i < p->n; i++) {
      const int surface = is[i] == DISK_BODY && p->rho[i] < RHO;
      const int circle = canup && i >= body && (i - body) % 5 == 1; /* would be inside */
      if (!canup && surface && class[i] == DISK_REIMPACT)
        layer++;
      else
        assert_int_equal(class[i], circle ? DISK_BODY : is[i]);
    }
    for (int a = 0; a < 3; a++)
      CLOSE(b.x[a], 1e7 * (a + 1), 1e-4), assert_true(fabs(b.v[a] - 3e3 * (a - 2)) < 0.1);
    double volume = 0;
    for (long i = 0; i < p->n; i++) volume += is[i] == DISK_BODY ? p->m[i] / p->rho[i] : 0;
    if (canup) {
      CLOSE(4.0 / 3 * acos(-1) * pow(b.radius, 3), volume, 1e-4);
      CLOSE(b.mass, mass, 1e-6), CLOSE(b.rho, mass / volume, 1e-4);
    } else {
      assert_true(b.radius > R * 11 / 12 && b.radius < R * 23 / 24); /* the deeper of the layer */
      assert_true(b.mass > 0.7 * mass && layer > 0);
    }
  }
  free(list), done(p);
}

/* Radau and Darwin's Earth is flattened by 1/294 (with K = 0.335; seen: 1/298). */
static void earth(void **state)
{
  (void)state;
  CLOSE(disk_flattening(7.2921e-5, 5.9722e24, 6.378137e6), 1 / 298.25, 0.02);
  CLOSE(group_roche(5.9722e24, 3344) / 1e7, 1.85, 0.01); /* of a fluid Moon: 18,500 km */
}

/* A spheroid of the shape that its spin asks for: the equator is the one it was made with. */
static void rotating(void **state)
{
  (void)state;
  static int32_t class[ROOM];
  const double omega = 4e-4, volume = 4.0 / 3 * acos(-1) * R * R * R;
  double a = R, f = 0;
  for (int k = 0; k < 100; k++) f = disk_flattening(omega, RHO * volume, a), a = R / cbrt(1 - f);
  assert_true(f > 0.1);
  Parts *p = empty();
  const double mass = spheroid(p, a, a * (1 - f), omega, 14);
  for (long i = 0; i < p->n; i++) p->rho[i] = RHO;
  long *list = all(p);
  DiskBody b;
  assert_int_equal(disk_find(p, list, p->n, &CANUP, class, &b, NULL), 0);
  CLOSE(b.equator, a, 0.01), CLOSE(b.flattening, f, 0.03), CLOSE(b.omega[2], omega, 1e-9);
  CLOSE(b.mass, mass, 1e-12);
  Err err; /* nothing is light: a sphere has no edge to find */
  assert_int_equal(disk_find(p, list, p->n, &REUFER, class, &b, &err), -1);
  assert_non_null(strstr(err.text, "the surface is not found"));
  for (long i = 0; i < 3 * p->n; i++) p->v[i] *= 10;
  assert_int_equal(disk_find(p, list, p->n, &CANUP, class, &b, &err), -1);
  assert_non_null(strstr(err.text, "faster than it can hold together"));
  free(list), done(p);
}

/* Half of the mass in a ring far out: with the enclosed mass a particle behind it is bound, with
 * the body's alone it is not. */
static void enclosed(void **state)
{
  (void)state;
  static int32_t class[ROOM];
  Parts *p = empty();
  const double mass = spheroid(p, R, R, 0, 8), mu = UNIT_G * mass;
  const long n = p->n;
  for (int k = 0; k < 100; k++) {
    const double t = 2 * acos(-1) * k / 100, x[3] = {5 * R * cos(t), 5 * R * sin(t), 0};
    const double v = sqrt(mu / (5 * R)), w[3] = {-v * sin(t), v * cos(t), 0};
    particle(p, x, w, 0.01 * mass, 1);
  }
  const double x[3] = {10 * R, 0, 0}, v[3] = {0, 1.2 * sqrt(2 * mu / (10 * R)), 0};
  particle(p, x, v, 1e-9 * mass, 1);
  long *list = all(p);
  DiskOptions whole = CANUP;
  DiskBody b;
  whole.enclosed = 1;
  assert_int_equal(disk_find(p, list, n, &CANUP, class, &b, NULL), 0);
  assert_int_equal(class[p->n - 1], DISK_ESCAPE);
  assert_int_equal(disk_find(p, list, n, &whole, class, &b, NULL), 0);
  assert_int_equal(class[p->n - 1], DISK_DISK);
  double *within = disk_enclosed(p, b.x, NULL);
  CLOSE(within[p->n - 1], 2 * mass, 1e-9);
  free(within), free(list), done(p);
}

static void invariances(void **state)
{
  (void)state;
  static int32_t is[ROOM], class[ROOM], again[ROOM];
  static long order[ROOM];
  double mass;
  Parts *p = planet(&mass, is);
  for (int canup = 0; canup < 2; canup++) {
    const DiskOptions *o = canup ? &CANUP : &REUFER;
    DiskBody b, c;
    long *list = all(p);
    assert_int_equal(disk_find(p, list, p->n, o, class, &b, NULL), 0);
    omp_set_num_threads(3);
    assert_int_equal(disk_find(p, list, p->n, o, again, &c, NULL), 0);
    omp_set_num_threads(2);
    assert_memory_equal(class, again, (size_t)p->n * sizeof *class);
    assert_memory_equal(&b, &c, sizeof b);
    free(list);
    for (long i = 0; i < p->n; i++) {
      order[i] = (i * 3163) % p->n;
      p->v[3 * i] += 700, p->v[3 * i + 2] -= 1300;
    }
    assert_int_equal(part_permute(p, order, NULL), 0);
    list = all(p);
    assert_int_equal(disk_find(p, list, p->n, o, again, &c, NULL), 0);
    for (long i = 0; i < p->n; i++) assert_int_equal(again[i], class[order[i]]);
    CLOSE(c.radius, b.radius, 1e-9);
    free(list);
  }
  done(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(integrated_orbits),
                                     cmocka_unit_test(known_classes),
                                     cmocka_unit_test(earth),
                                     cmocka_unit_test(rotating),
                                     cmocka_unit_test(enclosed),
                                     cmocka_unit_test(invariances)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
