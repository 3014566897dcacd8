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
    Sym m = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1),
             uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    double det = tensor_det(m), unit[9], worst = 0;
    if (fabs(det) < 0.05) continue;
    tensor_product(m, tensor_invert(m, det), unit);
    for (int i = 0; i < 9; i++) worst = fmax(worst, fabs(unit[i] - (i % 4 == 0)));
    assert_true(worst < 1e-13);
  }
}

/* The determinant is the product of the eigenvalues; a product of two tensors against indices. */
static void products(void **state)
{
  Sym a = {1, 2, 3, 4, 5, 6}, b = {7, -8, 9, 10, -11, 12}, flat = {1, 2, 0, 4, 0, 1};
  const double f[9] = {1, 2, 3, 2, 4, 5, 3, 5, 6}, g[9] = {7, -8, 9, -8, 10, -11, 9, -11, 12};
  double t[9];
  (void)state;
  tensor_product(a, b, t);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      assert_true(t[3 * i + j] ==
                  f[3 * i] * g[j] + f[3 * i + 1] * g[3 + j] + f[3 * i + 2] * g[6 + j]);
  assert_true(tensor_det(flat) == 0);
  assert_true(fabs(tensor_det(with_eigenvalues(2, -4, 8)) + 64) < 1e-12);
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
    double field[9], raw[9] = {0}, det;
    Sym m = {0, 0, 0, 0, 0, 0}, c;
    for (int k = 0; k < 9; k++) field[k] = uniform(-1, 1);
    for (int j = 0; j < 40; j++) {
      double x[3] = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; /* x_j - x_i, h = 1 */
      double q = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]), volume = uniform(0.5, 1.5);
      double slope =
          -volume * kernel_dwq(KERNEL_WENDLAND_C2, 3, q); /* grad_i W = -dwq (x_j - x_i) */
      Sym square = {x[0] * x[0], x[0] * x[1], x[0] * x[2], x[1] * x[1], x[1] * x[2], x[2] * x[2]};
      m = tensor_axpy(m, slope, square);
      for (int a = 0; a < 3; a++) {
        double v = field[3 * a] * x[0] + field[3 * a + 1] * x[1] + field[3 * a + 2] * x[2];
        for (int b = 0; b < 3; b++) raw[3 * a + b] += slope * v * x[b];
      }
    }
    det = tensor_det(m);
    assert_true(det > 0);
    c = tensor_invert(m, det);
    for (int a = 0; a < 9; a += 3) {
      assert_true(fabs(raw[a] * c.xx + raw[a + 1] * c.xy + raw[a + 2] * c.xz - field[a]) < 1e-12);
      assert_true(fabs(raw[a] * c.xy + raw[a + 1] * c.yy + raw[a + 2] * c.yz - field[a + 1]) <
                  1e-12);
      assert_true(fabs(raw[a] * c.xz + raw[a + 1] * c.yz + raw[a + 2] * c.zz - field[a + 2]) <
                  1e-12);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_tensors), cmocka_unit_test(degenerate),
      cmocka_unit_test(uniaxial),       cmocka_unit_test(inverse),
      cmocka_unit_test(products),       cmocka_unit_test(contractions),
      cmocka_unit_test(linear_field),
  };
  int failed;
  rng = gsl_rng_alloc(gsl_rng_mt19937);
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  gsl_rng_free(rng);
  return failed;
}
