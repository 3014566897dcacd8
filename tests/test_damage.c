/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Grady-Kipp damage: crack speed, growth of one and of many flaws, the limiter, and the strength of
 * a volume under constant strain rate against the closed form of Grady & Kipp (1980). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_errno.h>
#include "physics/material.h"

#define PI 3.14159265358979323846

static const double K = 26.7e9, MU = 22.7e9, RHO = 2700; /* basalt, Benz & Asphaug (1999) */
static const struct damage_grady_kipp BASALT = {.k = 5e34, .m = 8.5, .crack = 0.4, .shear = 1};

/* 0.4 times the longitudinal wave speed, 4593 m/s; 001 eq. 24 would give 36 in other units. */
static void crack_speed(void **state)
{
  double cl = sqrt((K + 4. / 3 * MU) / RHO);
  (void)state;
  assert_true(fabs(damage_crack_speed(&BASALT, K, MU, 0, RHO) - 1837) < 0.5);
  assert_true(fabs(damage_crack_speed(&BASALT, K, MU, 0, RHO) - 0.4 * cl) < 1e-12 * cl);
  assert_true(fabs(damage_crack_speed(&BASALT, K, MU, 1, RHO) - 0.4 * sqrt(K / RHO)) < 1e-12 * cl);
}

/* One flaw in a basalt particle of R_s = 2.5 mm at constant crack speed: D = (c_g t/R_s)^3, all
 * broken after 1.361 us, in any number of steps. The sum over flaws is the rate of 001 eq. 46. */
static void single_flaw(void **state)
{
  double cg = damage_crack_speed(&BASALT, K, MU, 0, RHO), rs = 2.5e-3, end = rs / cg;
  (void)state;
  assert_true(fabs(end - 1.361e-6) < 5e-10);
  for (int steps = 1; steps < 2000; steps *= 7) {
    double d = 0;
    for (int k = 0; k < steps; k++) d = damage_grow(d, 1, 1, 1, cg, rs, 0.5 * end / steps);
    assert_true(fabs(d - 0.125) < 1e-12);
    for (int k = 0; k < steps; k++) d = damage_grow(d, 1, 1, 1, cg, rs, 0.51 * end / steps);
    assert_true(d == 1);
  }
  assert_true(fabs(damage_grow(0, 3, 9, 9, cg, rs, end / 6) - 0.125) < 1e-12);
}

static int rate(double t, const double d13[], double f[], void *rs)
{
  double d = fmin(d13[0] * d13[0] * d13[0], 1);
  (void)t;
  f[0] = damage_crack_speed(&BASALT, K, MU, d, RHO) / *(double *)rs;
  return GSL_SUCCESS;
}

/* The crack slows down as mu (1 - D) falls: steps against GSL's integrator. */
static void single_flaw_slows(void **state)
{
  double rs = 2.5e-3, y[1] = {0}, t = 0, end = 1.3e-6, d = 0;
  gsl_odeiv2_system ode = {rate, NULL, 1, &rs};
  gsl_odeiv2_driver *driver =
      gsl_odeiv2_driver_alloc_y_new(&ode, gsl_odeiv2_step_rk8pd, 1e-9, 0, 1e-10);
  const int steps = 20000;
  (void)state;
  gsl_odeiv2_driver_apply(driver, &t, end, y);
  gsl_odeiv2_driver_free(driver);
  for (int k = 0; k < steps; k++)
    d = damage_grow(d, 1, 1, 1, damage_crack_speed(&BASALT, K, MU, d, RHO), rs, end / steps);
  assert_true(fabs(d - pow(y[0], 3)) < 1e-4);
  assert_true(d < 0.95 * pow(end * damage_crack_speed(&BASALT, K, MU, 0, RHO) / rs, 3));
}

/* 001 eq. 47 limits D, not its cube root; flaws that have closed again stay counted; D never
 * shrinks. */
static void limiter(void **state)
{
  (void)state;
  assert_true(damage_grow(0, 2, 2, 8, 1e3, 1e-3, 1) == 0.25);
  assert_true(damage_grow(0.1, 1, 3, 4, 1e3, 1e-3, 1) == 0.75);
  assert_true(fabs(damage_grow(0.3, 0, 3, 4, 1e3, 1e-3, 1) - 0.3) < 1e-15);
  assert_true(damage_grow(0.3, 0, 1, 100, 1e3, 1e-3, 1) == 0.3);
  assert_true(damage_grow(0, 5, 5, 5, 1e3, 1e-3, 1) == 1);
  assert_true(damage_grow(0, 0, 0, 0, 1e3, 1e-3, 1) == 0);
}

static void active(void **state)
{
  static const double flaw[] = {1e-4, 2e-4, 2e-4, 5e-4};
  (void)state;
  assert_int_equal(damage_active(flaw, 4, 0), 0);
  assert_int_equal(damage_active(flaw, 4, 1e-4), 0); /* at the threshold: not yet */
  assert_int_equal(damage_active(flaw, 4, 1.5e-4), 1);
  assert_int_equal(damage_active(flaw, 4, 3e-4), 3);
  assert_int_equal(damage_active(flaw, 4, 1), 4);
  assert_int_equal(damage_active(NULL, 0, 1), 0);
}

/* A volume stretched at rate r, E r t (1 - D) its stress, D the volume that cracks have crossed:
 * flaw j of volume V fails at strain (j/(k V))^(1/m) and opens a sphere that grows at c_g. Largest
 * stress [Pa] of explicit flaws, each grown by damage_grow. */
enum { FLAWS = 500, STEPS = 400 };

static double strength(const struct damage_grady_kipp *g, double young, double r, double t_end)
{
  double start[FLAWS], d[FLAWS] = {0}, cg = damage_crack_speed(g, K, MU, 0, RHO), best = 0;
  double volume = FLAWS / (g->k * pow(r * t_end, g->m)), rs = cbrt(3 * volume / (4 * PI));
  for (int j = 0; j < FLAWS; j++) start[j] = pow((j + 0.5) / (g->k * volume), 1 / g->m) / r;
  for (int k = 0; k < STEPS; k++) {
    double t = (k + 1) * t_end / STEPS, dt = t_end / STEPS, sum = 0;
    for (int j = 0; j < FLAWS; j++) {
      if (start[j] < t) d[j] = damage_grow(d[j], 1, 1, 1, cg, rs, fmin(dt, t - start[j]));
      sum += d[j];
    }
    best = fmax(best, young * r * t * (1 - sum));
  }
  return best;
}

/* Grady & Kipp (1980): D = A r^m t^(m+3), A = 8 pi c_g^3 k/((m+1)(m+2)(m+3)); stress is largest
 * at t_M = (A r^m (m+4))^(-1/(m+3)), where it is E r t_M (m+3)/(m+4), rising with r^(3/(m+3)). The
 * values are in MPa, at 0.01, 1, 100 and 10^4 per second. */
static void grady_kipp(void **state)
{
  static const struct {
    struct damage_grady_kipp of;
    double sigma[4];
  } T[] = {{{.k = 5e34, .m = 8.5, .crack = 0.4, .shear = 1}, {2.223, 7.390, 24.57, 81.68}},
           {{.k = 4e35, .m = 9, .crack = 0.4, .shear = 1}, {2.869, 9.071, 28.69, 90.71}},
           {{.k = 5e34, .m = 8, .crack = 0.4, .shear = 1}, {1.392, 4.889, 17.17, 60.28}},
           {{.k = 1e61, .m = 16, .crack = 0.4, .shear = 1}, {5.209, 10.78, 22.30, 46.14}}};
  static const double R[] = {1e-2, 1, 1e2, 1e4};
  double young = 9 * K * MU / (3 * K + MU);
  (void)state;
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < 4; i++) {
      const struct damage_grady_kipp *g = &T[k].of;
      double m = g->m, cg = damage_crack_speed(g, K, MU, 0, RHO);
      double a = 8 * PI * pow(cg, 3) * g->k / ((m + 1) * (m + 2) * (m + 3));
      double tm = pow(a * pow(R[i], m) * (m + 4), -1 / (m + 3));
      double closed = young * R[i] * tm * (m + 3) / (m + 4);
      assert_true(fabs(closed - 1e6 * T[k].sigma[i]) < 1e-3 * closed);
      assert_true(fabs(strength(g, young, R[i], 1.1 * tm) - closed) < 0.005 * closed);
    }
}

/* Nothing is left at the limit, for all numbers of flaws; before it, what is missing. */
static void left(void **state)
{
  (void)state;
  for (int n = 1; n <= 300; n++)
    for (int ever = 1; ever <= n; ever++) {
      double d = damage_grow(0, ever, ever, n, 1, 1, 2);
      assert_true(damage_left(cbrt(d), ever, n) == 0);
      assert_true(damage_left(0.5 * cbrt(d), ever, n) > 0);
      assert_true(fabs(damage_left(0.5 * cbrt(d), ever, n) - 0.5 * cbrt(d)) < 1e-14);
    }
}

/* 001 eq. 49 for basalt: 53.06 GPa. */
static void young(void **state)
{
  Material m;
  (void)state;
  memset(&m, 0, sizeof m);
  m.eos.form = EOS_MURNAGHAN;
  m.eos.murnaghan.rho0 = RHO, m.eos.murnaghan.K = K, m.eos.murnaghan.n = 4;
  assert_true(material_young(&m) == 0); /* a fluid */
  m.mu = MU;
  assert_true(fabs(material_young(&m) - 53.06e9) < 5e6);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(crack_speed),
      cmocka_unit_test(single_flaw),
      cmocka_unit_test(single_flaw_slows),
      cmocka_unit_test(limiter),
      cmocka_unit_test(left),
      cmocka_unit_test(active),
      cmocka_unit_test(grady_kipp),
      cmocka_unit_test(young),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
