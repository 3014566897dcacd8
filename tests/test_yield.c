/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Yield laws: where the stress ends up, softening, and what the printed formula does instead. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "physics/tensor.h"
#include "physics/yield.h"

static const double Y = 3.5e9; /* Pa, basalt */

static Yield law(int form)
{
  Yield y;
  memset(&y, 0, sizeof y);
  y.form = form;
  if (form == YIELD_VON_MISES) y.von_mises.Y = Y;
  if (form == YIELD_BENZ_ASPHAUG) y.benz_asphaug.Y = Y;
  return y;
}

/* A deviatoric stress with all components, and a given sqrt(3 J2). */
static Sym stress(double equivalent)
{
  Sym s = {2, -0.7, 0.4, -0.5, 1.1, -1.5};
  return tensor_scale(s, equivalent / sqrt(3 * tensor_j2(s)));
}

static double after(const Yield *y, double equivalent, double u, double melt)
{
  Sym s = stress(equivalent);
  double f = yield_factor(y, tensor_j2(s), 1e9, 0, u, melt);
  assert_true(f >= 0 && f <= 1);
  return sqrt(3 * tensor_j2(tensor_scale(s, f)));
}

/* In uniaxial tension s sqrt(3 J2) = s. */
static void equivalent_of_uniaxial(void **state)
{
  Sym s = {2. / 3, 0, 0, -1. / 3, 0, -1. / 3};
  (void)state;
  assert_true(fabs(sqrt(3 * tensor_j2(s)) - 1) < 1e-15);
}

/* 2 Y comes back to Y, not to Y/2 (001 eq. 17); below Y nothing happens. */
static void radial_return(void **state)
{
  Yield y = law(YIELD_VON_MISES);
  (void)state;
  for (double x = 1.001; x < 1e6; x *= 1.7)
    assert_true(fabs(after(&y, x * Y, 0, 0) - Y) < 1e-12 * Y);
  for (double x = 1e-9; x < 1; x *= 1.7)
    assert_true(fabs(after(&y, x * Y, 0, 0) - x * Y) < 1e-12 * x * Y);
  assert_true(yield_factor(&y, 0, 0, 0, 0, 0) == 1);
}

/* As printed: x Y goes to Y/x; the two agree in the limit of small excess. */
static void benz_asphaug(void **state)
{
  Yield y = law(YIELD_BENZ_ASPHAUG);
  (void)state;
  for (double x = 1.001; x < 1e3; x *= 1.7)
    assert_true(fabs(after(&y, x * Y, 0, 0) - Y / x) < 1e-12 * Y);
  assert_true(fabs(after(&y, 0.999 * Y, 0, 0) - 0.999 * Y) < 1e-12 * Y);
  assert_true(fabs(after(&y, (1 + 1e-6) * Y, 0, 0) - Y) < 1.1e-6 * Y);
}

/* Y (1 - u/melt) below the melt energy, no stress at all above, no hardening for u < 0. */
static void melting(void **state)
{
  const double melt = 3.4e6; /* J/kg */
  (void)state;
  for (int form = YIELD_NONE + 1; form < YIELD_COUNT; form++) {
    Yield y = law(form);
    for (double x = 0; x < 1; x += 0.1) {
      double soft = Y * (1 - x), got = after(&y, 1.5 * soft, x * melt, melt);
      assert_true(fabs(got - (form == YIELD_VON_MISES ? soft : soft / 1.5)) < 1e-12 * Y);
    }
    assert_true(after(&y, 1e-3 * Y, melt, melt) == 0 && after(&y, Y, 2 * melt, melt) == 0);
    assert_true(after(&y, 2 * Y, -melt, melt) == after(&y, 2 * Y, 0, melt));
    assert_true(after(&y, 2 * Y, 1e9, 0) == after(&y, 2 * Y, 0, 0)); /* no melt energy known */
  }
}

static void elastic(void **state)
{
  Yield y = law(YIELD_NONE);
  (void)state;
  assert_true(yield_factor(&y, 1e40, 0, 0.5, 1e9, 1e6) == 1);
}

/* In plane strain the third normal stress counts: diag(1, -0.5, -0.5), not diag(1, -0.5). */
static void plane_strain(void **state)
{
  Yield y = law(YIELD_VON_MISES);
  Sym s = {Y, 0, 0, -0.5 * Y, 0, -0.5 * Y};
  (void)state;
  assert_true(fabs(yield_factor(&y, tensor_j2(s), 0, 0, 0, 0) - 1 / 1.5) < 1e-14);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(equivalent_of_uniaxial),
      cmocka_unit_test(radial_return),
      cmocka_unit_test(benz_asphaug),
      cmocka_unit_test(melting),
      cmocka_unit_test(elastic),
      cmocka_unit_test(plane_strain),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
