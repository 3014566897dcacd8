/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tensors: eigenvalues against GSL, inverses, contractions, and the corrected velocity gradient. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_rng.h>
#include "physics/kernel.h"
#include "physics/tensor.h"

static gsl_rng *rng;

static double uniform(double a, double b) { return a + (b - a) * gsl_rng_uniform(rng); }

static double norm(Sym s) { return sqrt(tensor_dot(s, s)); }

/* A random rotation, as the rows of a matrix: Gram-Schmidt. */
static void rotation(double q[3][3])
{
  for (int a = 0; a < 3; a++) {
    double length = 0;
    for (int c = 0; c < 3; c++) q[a][c] = uniform(-1, 1);
    for (int b = 0; b < a; b++) {
      double dot = q[a][0] * q[b][0] + q[a][1] * q[b][1] + q[a][2] * q[b][2];
      for (int c = 0; c < 3; c++) q[a][c] -= dot * q[b][c];
    }
    for (int c = 0; c < 3; c++) length += q[a][c] * q[a][c];
    for (int c = 0; c < 3; c++) q[a][c] /= sqrt(length);
  }
}

static Sym with_eigenvalues(double a, double b, double c)
{
  double q[3][3], e[3] = {a, b, c}, m[3][3] = {{0}};
  Sym s;
  rotation(q);
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) m[i][j] += e[k] * q[k][i] * q[k][j];
  s.xx = m[0][0], s.xy = m[0][1], s.xz = m[0][2], s.yy = m[1][1], s.yz = m[1][2], s.zz = m[2][2];
  return s;
}

static double largest_by_gsl(Sym s)
{
  double m[9] = {s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz}, e[3];
  gsl_matrix_view matrix = gsl_matrix_view_array(m, 3, 3);
  gsl_vector_view values = gsl_vector_view_array(e, 3);
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(3);
  gsl_eigen_symm(&matrix.matrix, &values.vector, work);
  gsl_eigen_symm_free(work);
  return fmax(e[0], fmax(e[1], e[2]));
}

static void check(Sym s, double tolerance)
{
  double expected = largest_by_gsl(s), got = tensor_largest(s);
  if (!(fabs(got - expected) <= tolerance * norm(s)))
    fail_msg("(%g %g %g %g %g %g): %.17g, not %.17g", s.xx, s.xy, s.xz, s.yy, s.yz, s.zz, got,
             expected);
}

static void random_tensors(void **state)
{
  (void)state;
  for (int k = 0; k < 20000; k++) {
    double scale = pow(10, uniform(-12, 12));
    Sym s = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1),
             uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    check(tensor_scale(s, scale), 1e-7);
  }
}

/* Equal eigenvalues, exactly or nearly; diagonal; a large pressure over a small shear; zero. */
static void degenerate(void **state)
{
  (void)state;
  for (int k = 0; k < 2000; k++) {
    double split = pow(10, uniform(-17, -1)), a = uniform(-3, 3);
    check(with_eigenvalues(1, 1 - split, a), 1e-7);
    check(with_eigenvalues(1, -2, -2 + split), 1e-7);
    check(with_eigenvalues(1, 1 + split, 1 - split), 1e-7);
    check(with_eigenvalues(1, 0, 0), 1e-7);
  }
  for (int k = 0; k < 64; k++) {
    Sym s = {k % 4, 0, 0, k / 4 % 4, 0, k / 16};
    check(s, 1e-7);
  }
}

/* The stress of a uniaxial pull of 1 in any direction has 1 as its largest: frame invariance. */
static void uniaxial(void **state)
{
  (void)state;
  for (int k = 0; k < 1000; k++)
    assert_true(fabs(tensor_largest(with_eigenvalues(1, 0, 0)) - 1) < 1e-14);
}

static void inverse(void **state)
{
  (void)state;
  for (int k = 0; k < 5000; k++) {
    double m[9], c[9], det, worst = 0;
    for (int i = 0; i < 9; i++) m[i] = uniform(-1, 1);
    det = tensor_invert(m, c);
    if (fabs(det) < 0.05) continue;
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        double sum = -(a == b);
        for (int i = 0; i < 3; i++) sum += m[3 * a + i] * c[3 * i + b];
        worst = fmax(worst, fabs(sum));
      }
    assert_true(worst < 1e-13);
  }
}

static void singular(void **state)
{
  double m[9] = {1, 2, 3, 2, 4, 6, 0, 0, 1}, c[9] = {7, 7, 7, 7, 7, 7, 7, 7, 7};
  double diagonal[9] = {2, 0, 0, 0, 4, 0, 0, 0, 8};
  (void)state;
  assert_true(tensor_invert(m, c) == 0);
  for (int k = 0; k < 9; k++) assert_true(c[k] == 7);
  assert_true(tensor_invert(diagonal, c) == 64 && c[0] == 0.5 && c[4] == 0.25 && c[8] == 0.125);
}

static void contractions(void **state)
{
  Sym s = {1, 2, 3, 4, 5, 6}, t = {7, 8, 9, 10, 11, 12}, sum = tensor_axpy(s, 2, t);
  (void)state;
  assert_true(tensor_dot(s, t) == 1 * 7 + 4 * 10 + 6 * 12 + 2 * (2 * 8 + 3 * 9 + 5 * 11));
  assert_true(tensor_j2(s) == 0.5 * tensor_dot(s, s));
  assert_true(sum.xx == 15 && sum.xy == 18 && sum.xz == 21 && sum.yy == 24 && sum.yz == 27 &&
              sum.zz == 30);
}

/* 001 eq. 42-44 with M_ab = sum m/rho (x_j - x_i)_a dW_b: C = 1/M makes the gradient of a linear
 * field exact on any set of neighbours. Eq. 43 as printed (x_i - x_j) gives its negative. */
static void linear_field(void **state)
{
  (void)state;
  for (int trial = 0; trial < 50; trial++) {
    double field[9], m[9] = {0}, raw[9] = {0}, c[9];
    for (int k = 0; k < 9; k++) field[k] = uniform(-1, 1);
    for (int j = 0; j < 40; j++) {
      double x[3] = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; /* x_j - x_i, h = 1 */
      double q = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]), volume = uniform(0.5, 1.5);
      double slope =
          -volume * kernel_dwq(KERNEL_WENDLAND_C2, 3, q); /* grad_i W = -dwq (x_j - x_i) */
      for (int a = 0; a < 3; a++) {
        double v = field[3 * a] * x[0] + field[3 * a + 1] * x[1] + field[3 * a + 2] * x[2];
        for (int b = 0; b < 3; b++)
          m[3 * a + b] += slope * x[a] * x[b], raw[3 * a + b] += slope * v * x[b];
      }
    }
    assert_true(tensor_invert(m, c) > 0);
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        double g = 0;
        for (int k = 0; k < 3; k++) g += raw[3 * a + k] * c[3 * k + b];
        assert_true(fabs(g - field[3 * a + b]) < 1e-12);
      }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_tensors), cmocka_unit_test(degenerate),
      cmocka_unit_test(uniaxial),       cmocka_unit_test(inverse),
      cmocka_unit_test(singular),       cmocka_unit_test(contractions),
      cmocka_unit_test(linear_field),
  };
  int failed;
  rng = gsl_rng_alloc(gsl_rng_mt19937);
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  gsl_rng_free(rng);
  return failed;
}
