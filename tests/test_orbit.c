/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lib/orbit: worked examples (docs/theory.md 7), closed forms of the special conics,
 * and a numerical two-body integration as an independent check. */
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <setjmp.h>
#include <cmocka.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include "../lib/orbit.h"
#include "../lib/rng.h"

static const double G = 6.67430e-11, DEG = 0.017453292519943295;

static void near(double got, double want, double scale, double tolerance)
{
  if (fabs(got - want) > tolerance * fabs(scale))
    fail_msg("%.15g, want %.15g (to %g)", got, want, tolerance);
}

/* Two bodies, angle [deg], contact speed in escape speeds, and what is printed in 2.6. */
typedef struct {
  double mt, mi, rt, ri, angle, speed, r0;
  double mu, rc, vesc, vc, beta, e, rp, anomaly_c, anomaly, v0, vr0, vt0, x[2], v[2], t0;
} Example;

/* clang-format off */
static const Example example[] = {
  {5.374980e24, 5.972200e23, 6.179870e6, 3.440340e6, 45, 1, 4.810105e7,
   3.986025446e14, 9.620210e6, 9103.172136, 9103.172136, 0, 1, 4.810105000e6, -90, -143.130102354,
   4071.062341, -3862.148848, 1287.382949, {3.848084000e7, 2.886063000e7}, {-3862.148848, -1287.382949}, -7970.866274},
  {9.43e20, 9.43e20, 5.09e5, 4.37e5, 48, 1.7, 1.1369e7,
   1.258772980e11, 9.46e5, 515.873401, 876.984782, -709.208673 * 709.208673, 3.614704668, 6.543678879e5, -52.667749342,
   -101.722246859, 724.652257, -722.620282, 54.229348, {8.587383794e6, 7.450570487e6}, {-581.357840, -432.601382},
   -14361.323894},
  {3.583320e24, 2.388880e24, 5.606480e6, 4.969380e6, 30, 0.95, 3.172758e7,
   3.986025446e14, 1.057586e7, 8682.147999, 8248.040599, 7.349520152e6, 0.954990183, 2.441115493e6, -125.072551410,
   -152.826187493, 4216.283253, -3985.889791, 1374.673433, {1.477460382e7, 2.807757850e7}, {-3072.640389, -2887.200289},
   -4138.406641}};
/* clang-format on */

static OrbitApproach approach(const Example *b, double angle, double speed, double r0)
{
  double mu = G * (b->mt + b->mi), rc = b->rt + b->ri;
  OrbitApproach a;
  Err err;
  if (orbit_approach(&a, mu, rc, speed * sqrt(2 * mu / rc), angle * DEG, r0, &err))
    fail_msg("%s", err.text);
  return a;
}

/* All printed columns: ten digits, so nine are asserted (relative to the largest component for
 * vectors). */
static void test_examples(void **state)
{
  (void)state;
  for (unsigned k = 0; k < 3; k++) {
    const Example *b = &example[k];
    OrbitApproach a = approach(b, b->angle, b->speed, b->r0);
    near(a.orbit.mu, b->mu, b->mu, 1e-9);
    near(a.rc, b->rc, b->rc, 1e-9);
    near(a.vesc, b->vesc, b->vesc, 1e-9);
    near(a.vc, b->vc, b->vc, 1e-9);
    near(a.orbit.beta, b->beta, b->vc * b->vc, 1e-9);
    near(a.orbit.e, b->e, b->e, 1e-9);
    near(a.orbit.rp, b->rp, b->rp, 1e-9);
    near(a.anomaly_c / DEG, b->anomaly_c, 180, 1e-11);
    near(a.anomaly / DEG, b->anomaly, 180, 1e-11);
    near(a.v0, b->v0, b->v0, 1e-9);
    near(a.vr0, b->vr0, b->v0, 1e-9);
    near(a.vt0, b->vt0, b->v0, 1e-9);
    for (int d = 0; d < 2; d++)
      near(a.x[d], b->x[d], b->r0, 1e-9), near(a.v[d], b->v[d], b->v0, 1e-9);
    near(a.t0, b->t0, b->t0, 1e-9);
  }
}

/* 2.6: head-on, the bodies of example 1 from 5 r_c. */
static void test_head_on(void **state)
{
  const Example *b = example;
  double rc = b->rt + b->ri, mu = G * (b->mt + b->mi);
  OrbitApproach a;
  (void)state;
  near(approach(b, 0, 1.5, 5 * rc).t0, -3304.214366, 3304, 1e-9);
  near(approach(b, 0, 0.95, 5 * rc).t0, -8752.045943, 8752, 1e-9);
  a = approach(b, 0, 1, 5 * rc);
  near(a.t0, -7172.372160, 7172, 1e-9);
  near(a.t0, -sqrt(2 / mu) / 3 * (pow(5 * rc, 1.5) - pow(rc, 1.5)), a.t0,
       1e-13); /* parabola, closed form */
  near(a.x[0], 0, rc, 1e-14);
  near(a.x[1], 5 * rc, rc, 1e-14);
  near(a.v[0], 0, a.vc, 1e-14);
  assert_true(a.v[1] < 0);
}

/* 2.6: regression cases, nearly parabolic and grazing. */
static void test_regression(void **state)
{
  const Example *b = example;
  double rc = b->rt + b->ri;
  OrbitApproach a = approach(b, 60, 1.0001, 5 * rc), g = approach(b, 89.9, 2, 10 * rc);
  (void)state;
  near(a.orbit.e, 1.000300030, 1, 1e-9);
  near(a.t0, -8556.921495, a.t0, 1e-9);
  near(a.x[0], 4.633257698e7, 5 * rc, 1e-9);
  near(a.x[1], 1.292297649e7, 5 * rc, 1e-9);
  near(a.v[0], -4041.049781, a.v0, 1e-9);
  near(a.v[1], 509.940811, a.v0, 1e-9);
  near(g.orbit.e, 6.999989556, 7, 1e-9);
  near(g.t0, -5870.775691, g.t0, 1e-9);
  near(g.x[0], 9.616811611e7, 10 * rc, 1e-9);
  near(g.x[1], -2.556851e6, 10 * rc, 1e-8); /* seven digits are printed */
}

/* The impact of 001 sect. 5.1 backwards: b0 819 km and 744 m/s at 11369 km give contact after 233
 * min at 893 m/s, 46.2 deg. */
static void test_state(void **state)
{
  double mu = G * 2 * 9.43e20, r0 = 1.1369e7, rc = 9.46e5, b0 = 8.19e5;
  double r[3] = {sqrt(r0 * r0 - b0 * b0), 0, b0}, v[3] = {-744, 0, 0};
  Orbit o = orbit_of_state(mu, r, v);
  double vc = sqrt(-o.beta + 2 * mu / rc);
  (void)state;
  near(vc, 893, vc, 1e-3);
  near(asin(o.h / rc / vc) / DEG, 46.2, 46.2, 2e-3);
  near((orbit_time(&o, r0) - orbit_time(&o, rc)) / 60, 232.94, 233, 3e-5);
  near(o.vinf, 729, 729, 1e-3);
  near(orbit_speed_at_contact(mu, rc, o.vinf), vc, vc, 1e-14);
}

static int newton(double t, const double y[], double f[], void *mu)
{
  double r = hypot(y[0], y[1]), k = -*(double *)mu / (r * r * r);
  (void)t;
  f[0] = y[2], f[1] = y[3], f[2] = k * y[0], f[3] = k * y[1];
  return GSL_SUCCESS;
}

/* Integrating Newton's law from the start over |t0| ends at contact: distance, +y axis, speed,
 * angle; and L_z > 0. */
static void check_by_integration(const Example *b, double angle, double speed, double times)
{
  double rc = b->rt + b->ri, mu = G * (b->mt + b->mi), t, y[4], scale;
  OrbitApproach a = approach(b, angle, speed, times * rc);
  gsl_odeiv2_system system = {newton, NULL, 4, &mu};
  gsl_odeiv2_driver *driver =
      gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1, 1e-6, 1e-14);
  y[0] = a.x[0], y[1] = a.x[1], y[2] = a.v[0], y[3] = a.v[1], t = a.t0;
  scale = a.vesc * a.rc;
  assert_true(a.t0 < 0 && y[0] * y[3] - y[1] * y[2] >= -1e-12 * scale);
  assert_int_equal(gsl_odeiv2_driver_apply(driver, &t, 0, y), GSL_SUCCESS);
  gsl_odeiv2_driver_free(driver);
  near(y[0], 0, rc, 2e-11);
  near(y[1], rc, rc, 2e-11);
  near(y[2], -a.vc * sin(angle * DEG), a.vc, 2e-11);
  near(y[3], -a.vc * cos(angle * DEG), a.vc, 2e-11);
}

static void test_integration(void **state)
{
  const double angle[] = {0, 1e-3, 15, 45, 75, 89.9};
  const double speed[] = {0.93, 1 - 1e-7, 1, 1 + 1e-13, 1 + 1e-7, 1.2, 4};
  (void)state;
  for (int i = 0; i < 6; i++)
    for (int k = 0; k < 7; k++) check_by_integration(example, angle[i], speed[k], 5);
  check_by_integration(example + 1, 48, 1.7, 12);
  check_by_integration(example + 2, 30, 0.75, 1.5);
}

/* A random approach: parabolic, hyperbolic up to 4 v_esc, bound (some from the apoapsis); head-on,
 * grazing and between; small and large bodies; by distance and by time. */
static OrbitApproach random_case(uint64_t seed)
{
  double u[6], mu, rc, speed, angle, share, longest;
  OrbitApproach a;
  Err err;
  for (uint32_t k = 0; k < 6; k++) u[k] = rng_uniform(1, seed, k);
  mu = G * pow(10, 10 + 15 * u[0]), rc = pow(10, 1 + 6 * u[1]);
  angle = seed % 20 == 0 ? 0 : seed % 20 == 1 ? 89.9 * DEG : 89.9 * DEG * u[2];
  speed = seed % 3 == 0 ? 1 : seed % 3 == 1 ? 1 + 3 * u[3] : 0.3 + 0.7 * u[3];
  speed *= sqrt(2 * mu / rc);
  share = u[5] < 0.2 ? 1 : u[4]; /* of the way back to the apoapsis, or to somewhere far */
  assert_int_equal(orbit_approach(&a, mu, rc, speed, angle, rc, &err), 0);
  longest = fmin(a.orbit.period / 2 - orbit_time(&a.orbit, rc), 300 * rc / speed);
  if (seed % 2 ? orbit_approach_time(&a, mu, rc, speed, angle, share * longest, &err)
               : orbit_approach(&a, mu, rc, speed, angle,
                                rc + share * (fmin(a.orbit.ra, 50 * rc) - rc), &err))
    fail_msg("case %d: %s", (int)seed, err.text);
  if (seed % 2) near(-a.t0, share * longest, longest, 1e-12);
  return a;
}

/* 200 of them, integrated by Newton's law in units of r_c and v_c over |t0|: contact at the right
 * time, place, angle and speed to 1e-9. */
static void test_random(void **state)
{
  double worst = 0;
  (void)state;
  for (uint64_t seed = 0; seed < 200; seed++) {
    OrbitApproach a = random_case(seed);
    double mu = a.orbit.mu / (a.rc * a.vc * a.vc), t = a.t0 * a.vc / a.rc;
    double y[4] = {a.x[0] / a.rc, a.x[1] / a.rc, a.v[0] / a.vc, a.v[1] / a.vc}, r, v, vr, off[4];
    gsl_odeiv2_system system = {newton, NULL, 4, &mu};
    gsl_odeiv2_driver *driver =
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, -t / 1e3, 1e-14, 1e-14);
    if (t < 0) assert_int_equal(gsl_odeiv2_driver_apply(driver, &t, 0, y), GSL_SUCCESS);
    gsl_odeiv2_driver_free(driver);
    r = hypot(y[0], y[1]), v = hypot(y[2], y[3]), vr = (y[0] * y[2] + y[1] * y[3]) / r;
    off[0] = (r - 1) / vr; /* how late r passes r_c [r_c/v_c] */
    off[1] = atan2(y[0] * y[3] - y[1] * y[2], -r * vr) - a.angle;
    off[2] = v - 1;
    off[3] = y[0] / r;
    for (int k = 0; k < 4; k++) {
      if (!(fabs(off[k]) < 1e-9)) fail_msg("case %d: %d off by %g", (int)seed, k, off[k]);
      worst = fmax(worst, fabs(off[k]));
    }
  }
  print_message("200 cases: contact to %.1e\n", worst);
}

/* The same orbits from their state somewhere in space: contact, direction and time come back. An
 * outbound start on a bound orbit goes round by the apoapsis. */
static void test_from_state(void **state)
{
  (void)state;
  for (uint64_t seed = 0; seed < 200; seed++) {
    OrbitApproach a = random_case(seed), b;
    double m[3][3], r[3], v[3], to[3], pole[3];
    Err err = {""};
    if (a.r0 < a.rc * (1 + 1e-9)) continue;
    rng_rotation(seed, m);
    for (int back = 0; back <= (a.orbit.beta > 0 && a.angle > 0); back++) {
      /* backwards in time from the mirrored start: the velocity's radial part changes its sign */
      double e = a.r0, vr = back ? -a.vr0 : a.vr0;
      for (int k = 0; k < 3; k++) {
        double er = (m[k][0] * a.x[0] + m[k][1] * a.x[1]) / e,
               et = (m[k][1] * a.x[0] - m[k][0] * a.x[1]) / e;
        r[k] = a.r0 * er, v[k] = vr * er + a.vt0 * et;
      }
      if (orbit_approach_state(&b, a.orbit.mu, a.rc, r, v, to, pole, &err))
        fail_msg("case %d: %s", (int)seed, err.text);
      near(b.vc, a.vc, a.vc, 1e-9);
      near(b.angle, a.angle, 1, 1e-7); /* asin near 90 deg, from r far away */
      near(b.r0, a.r0, a.r0, 1e-9);
      if (back) continue;
      near(b.t0, a.t0, fabs(a.t0) + a.rc / a.vc, 1e-6);
      for (int k = 0; k < 3; k++) near(to[k], m[k][1], 1, 1e-6);
      for (int k = 0; k < 3 && a.angle > 0; k++) near(pole[k], m[k][2], 1, 1e-9);
    }
  }
}

/* Kepler's equation of the ellipse, and its half period from periapsis to apoapsis. */
static void test_ellipse_time(void **state)
{
  double mu = 3.986e14, a = 1e7, e = 0.3, r[3] = {a * (1 - e), 0, 0},
         v[3] = {0, sqrt(mu / a * (1 + e) / (1 - e)), 0};
  Orbit o = orbit_of_state(mu, r, v);
  double n = sqrt(mu / (a * a * a)), half = acos(-1.);
  (void)state;
  near(o.e, e, 1, 1e-14);
  near(o.ra, a * (1 + e), a, 1e-13);
  for (double ecc = 0.01; ecc < 3; ecc += 0.3)
    near(orbit_time(&o, a * (1 - e * cos(ecc))), (ecc - e * sin(ecc)) / n, half / n, 1e-12);
  near(orbit_time(&o, o.ra), half / n, half / n, 1e-7); /* dr/dt = 0 there */
}

/* Without gravity: a straight line at constant speed that passes +y at contact (004 eq. 2.86
 * corrected); the same by the time, and from a state. */
static void test_straight(void **state)
{
  OrbitApproach a;
  Err err;
  (void)state;
  assert_int_equal(orbit_approach(&a, 0, 2, 3, 30 * DEG, 10, &err), 0);
  near(hypot(a.x[0], a.x[1]), 10, 10, 1e-14);
  near(a.x[0] - a.v[0] * a.t0, 0, 2, 1e-14);
  near(a.x[1] - a.v[1] * a.t0, 2, 2, 1e-14);
  near(a.v[0], -3 * sin(30 * DEG), 3, 1e-14);
  near(a.v[1], -3 * cos(30 * DEG), 3, 1e-14);
  near(a.t0, -(sqrt(100 - 1) - 2 * cos(30 * DEG)) / 3, 1, 1e-14);
  assert_int_equal(orbit_approach_time(&a, 0, 2, 3, 30 * DEG, 7, &err), 0);
  near(a.t0, -7, 7, 1e-15);
  near(a.x[0], 3 * sin(30 * DEG) * 7, 20, 1e-14);
  near(a.x[1], 2 + 3 * cos(30 * DEG) * 7, 20, 1e-14);
  double r[3] = {0, 10, 1}, v[3] = {0, -5, 0}, to[3], pole[3];
  assert_int_equal(orbit_approach_state(&a, 0, 2, r, v, to, pole, &err), 0);
  near(a.angle / DEG, 30, 30, 1e-14);
  near(a.t0, -(10 - sqrt(3)) / 5, 1, 1e-14);
  near(to[1], sqrt(3) / 2, 1, 1e-14);
  near(to[2], 0.5, 1, 1e-14);
  near(pole[0], 1, 1, 1e-14); /* (0, 10, 1) x (0, -5, 0) = (5, 0, 0) */
}

static void refused(double angle, double speed, double r0, const char *word)
{
  OrbitApproach a;
  Err err = {""};
  assert_int_equal(orbit_approach(&a, 1, 1, speed, angle * DEG, r0, &err), -1);
  if (!strstr(err.text, word)) fail_msg("'%s' does not say '%s'", err.text, word);
}

static void test_errors(void **state)
{
  (void)state;
  refused(45, 1, 0.999, "overlap");
  refused(45, 0.9 * sqrt(2), 10, "apoapsis"); /* a = 1/(2 - 1.62) = 2.63 */
  refused(90, 1, 1, "circular");
  refused(-1, 1, 2, "angle");
  refused(91, 1, 2, "angle");
  refused(45, 0, 2, "speed");
  refused(45, NAN, 2, "speed");
  refused(45, 1, INFINITY, "distance");
}

static void refused_state(double x, double y, double vx, double vy, const char *word)
{
  OrbitApproach a;
  double r[3] = {x, y, 0}, v[3] = {vx, vy, 0}, to[3], pole[3];
  Err err = {""};
  assert_int_equal(orbit_approach_state(&a, 1, 1, r, v, to, pole, &err), -1);
  if (!strstr(err.text, word)) fail_msg("'%s' does not say '%s'", err.text, word);
}

static void test_other_errors(void **state)
{
  OrbitApproach a;
  Err err = {""};
  (void)state;
  /* v^2 = 1.8: a = 5, period 2 pi 5^1.5 = 70.2 */
  assert_int_equal(orbit_approach_time(&a, 1, 1, sqrt(1.8), 0.1, 36, &err), -1);
  assert_non_null(strstr(err.text, "apoapsis"));
  assert_int_equal(orbit_approach_time(&a, 1, 1, 2, 0.1, -1, &err), -1);
  assert_non_null(strstr(err.text, "negative"));
  refused_state(0.5, 0, -1, 0, "overlap");
  refused_state(3, 0, 2, 0, "move apart");
  refused_state(3, 2, -3, 0, "pass each other");
  refused_state(3, 0, 0, 0.577, "pass each other"); /* nearly a circle */
  refused_state(3, NAN, 0, 1, "no orbit");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_examples),     cmocka_unit_test(test_head_on),
      cmocka_unit_test(test_regression),   cmocka_unit_test(test_state),
      cmocka_unit_test(test_integration),  cmocka_unit_test(test_ellipse_time),
      cmocka_unit_test(test_straight),     cmocka_unit_test(test_errors),
      cmocka_unit_test(test_random),       cmocka_unit_test(test_from_state),
      cmocka_unit_test(test_other_errors),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
