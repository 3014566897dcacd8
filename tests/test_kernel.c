/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every kernel in 1D, 2D, 3D: norm, slope, support, sign, and the values of the literature. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>
#include <gsl/gsl_deriv.h>
#include <gsl/gsl_integration.h>
#include "physics/kernel.h"

#define PI KERNEL_PI

static const char *const NAMES[] = {
#define NAME(CAPITAL, WORD, ...) #WORD,
    KERNELS(NAME)
#undef NAME
};

typedef struct {
  int kern, dimension;
} Shape;

#define FOR_ALL(SHAPE)                                                                             \
  for (Shape SHAPE = {0, 1}; SHAPE.kern < KERNEL_COUNT; SHAPE.kern++)                              \
    for (SHAPE.dimension = 1; SHAPE.dimension <= 3; SHAPE.dimension++)

static double w_at(double q, void *p)
{
  const Shape *s = p;
  return kernel_w(s->kern, s->dimension, q);
}

/* w sigma times the surface of the sphere: 2, 2 pi q, 4 pi q^2 */
static double shell(double q, void *p)
{
  const Shape *s = p;
  double surface = s->dimension == 1 ? 2 : s->dimension == 2 ? 2 * PI * q : 4 * PI * q * q;
  return kernel_sigma(s->kern, s->dimension) * w_at(q, p) * surface;
}

static double moment(double q, void *p)
{
  const Shape *s = p;
  return q / s->dimension * kernel_dw(s->kern, s->dimension, q) / w_at(q, p) * shell(q, p);
}

static double integral(double (*f)(double, void *), Shape *s)
{
  static const double knot[] = {0, 0.2, 1. / 3, 0.5, 0.6, 2. / 3, 1}; /* of all splines */
  gsl_function g = {f, s};
  double sum = 0, part, error;
  size_t calls;
  for (int k = 0; k + 1 < (int)(sizeof knot / sizeof *knot); k++) {
    gsl_integration_qng(&g, knot[k], knot[k + 1], 0, 1e-12, &part, &error, &calls);
    sum += part;
  }
  return sum;
}

static void norm_is_one(void **state)
{
  (void)state;
  FOR_ALL(s)
  if (fabs(integral(shell, &s) - 1) > 1e-10)
    fail_msg("%s in %dD integrates to %.15g", NAMES[s.kern], s.dimension, integral(shell, &s));
}

/* Integration by parts: the sum that makes the velocity gradient, int r dW/dr = -D int W. */
static void first_moment_of_slope(void **state)
{
  (void)state;
  FOR_ALL(s)
  if (fabs(integral(moment, &s) + 1) > 1e-10)
    fail_msg("%s in %dD: %.15g", NAMES[s.kern], s.dimension, integral(moment, &s));
}

static void slope_is_derivative(void **state)
{
  (void)state;
  FOR_ALL(s) for (double q = 0.0131; q < 1; q += 0.0131)
  {
    gsl_function f = {w_at, &s};
    double numeric, error, dw = kernel_dw(s.kern, s.dimension, q);
    gsl_deriv_central(&f, q, 1e-3, &numeric, &error);
    if (fabs(numeric - dw) > 1e-8 + 2 * error)
      fail_msg("%s %dD q=%g: %.12g, not %.12g", NAMES[s.kern], s.dimension, q, dw, numeric);
  }
}

static void shape(void **state)
{
  (void)state;
  FOR_ALL(s)
  {
    double last = kernel_w(s.kern, s.dimension, 0);
    for (double q = 0; q < 1; q += 1e-3) {
      double w = kernel_w(s.kern, s.dimension, q), dwq = kernel_dwq(s.kern, s.dimension, q);
      assert_true(w > 0 && w <= last && dwq < 0 && isfinite(dwq));
      assert_true(kernel_dw(s.kern, s.dimension, q) == dwq * q);
      last = w;
    }
    for (double q = 1; q < 3; q += 0.125) {
      assert_true(kernel_w(s.kern, s.dimension, q) == 0);
      assert_true(kernel_dwq(s.kern, s.dimension, q) == 0);
    }
  }
}

/* (dw/dq)/q at q = 0 is w''(0): finite for all but the spiky kernel, and approached smoothly. */
static void centre(void **state)
{
  (void)state;
  FOR_ALL(s)
  {
    double at0 = kernel_dwq(s.kern, s.dimension, 0), near = kernel_dwq(s.kern, s.dimension, 1e-9);
    double w0 = kernel_w(s.kern, s.dimension, 0), w1 = kernel_w(s.kern, s.dimension, 1e-4);
    if (s.kern == KERNEL_SPIKY) continue;
    assert_true(fabs(near - at0) < 1e-7 * fabs(at0));
    assert_true(fabs(2 * (w1 - w0) / 1e-8 - at0) < 3e-3 * fabs(at0));
  }
}

/* dwq is smooth across the knots of the splines, where the formula changes. */
static void knots(void **state)
{
  static const struct {
    int kern;
    double q;
  } T[] = {{KERNEL_CUBIC_SPLINE, 0.5},
           {KERNEL_QUARTIC_SPLINE, 0.2},
           {KERNEL_QUARTIC_SPLINE, 0.6},
           {KERNEL_QUINTIC_SPLINE, 1. / 3},
           {KERNEL_QUINTIC_SPLINE, 2. / 3}};
  (void)state;
  for (int k = 0; k < (int)(sizeof T / sizeof *T); k++) {
    double left = kernel_dwq(T[k].kern, 3, T[k].q * (1 - 1e-14));
    assert_true(fabs(left - kernel_dwq(T[k].kern, 3, T[k].q)) < 1e-12);
  }
}

/* 001 eq. 25 and 27, as printed there (support h). */
static void cubic_as_printed(void **state)
{
  (void)state;
  for (double q = 0; q < 1; q += 0.01) {
    double w = q < 0.5 ? 6 * q * q * q - 6 * q * q + 1 : 2 * pow(1 - q, 3);
    double dw = 6 * (q < 0.5 ? 3 * q * q - 2 * q : -(1 - q) * (1 - q));
    assert_true(fabs(kernel_w(KERNEL_CUBIC_SPLINE, 3, q) - w) < 1e-15);
    assert_true(fabs(kernel_dw(KERNEL_CUBIC_SPLINE, 3, q) - dw) < 1e-14);
  }
}

/* Wendland (1995) C4: 35/3 q^2, not the 22 q^2 of 000's scan, which integrates to 1.28 with this
 * sigma; in 1D 8 q^2. */
static void wendland_as_published(void **state)
{
  (void)state;
  for (double q = 0; q < 1; q += 0.01) {
    double c4 = pow(1 - q, 6) * (1 + 6 * q + 35 * q * q / 3);
    double line = pow(1 - q, 5) * (1 + 5 * q + 8 * q * q);
    assert_true(fabs(kernel_w(KERNEL_WENDLAND_C4, 3, q) - c4) < 1e-15);
    assert_true(fabs(kernel_w(KERNEL_WENDLAND_C4, 2, q) - c4) < 1e-15);
    assert_true(fabs(kernel_w(KERNEL_WENDLAND_C4, 1, q) - line) < 1e-15);
  }
}

/* The pi of 2D and 3D is in sigma (004 eq. 2.13 prints another one). */
static void sigma_values(void **state)
{
  static const struct {
    int kern;
    double sigma[3];
  } T[] = {{KERNEL_CUBIC_SPLINE, {4. / 3, 1.818914, 2.546479}},
           {KERNEL_QUARTIC_SPLINE, {4.069010, 6.222175, 9.714047}}};
  (void)state;
  for (int k = 0; k < 2; k++)
    for (int d = 0; d < 3; d++)
      assert_true(fabs(kernel_sigma(T[k].kern, d + 1) - T[k].sigma[d]) < 1e-6);
}

static void words(void **state)
{
  (void)state;
  assert_string_equal(KERNEL_WORDS, "cubic_spline|quartic_spline|quintic_spline|wendland_c2|"
                                    "wendland_c4|wendland_c6|spiky");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(norm_is_one),
      cmocka_unit_test(first_moment_of_slope),
      cmocka_unit_test(slope_is_derivative),
      cmocka_unit_test(shape),
      cmocka_unit_test(centre),
      cmocka_unit_test(knots),
      cmocka_unit_test(cubic_as_printed),
      cmocka_unit_test(wendland_as_published),
      cmocka_unit_test(sigma_values),
      cmocka_unit_test(words),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
