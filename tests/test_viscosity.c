/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Artificial viscosity: sign, units, Galilean symmetry, and the limits of its two terms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "physics/viscosity.h"

/* Pi of a pair on the x axis, r apart, i at the left; v = v_i - v_j. */
static double pair(double v, double r, double h, double c, double rho, double alpha, double beta)
{
  return viscosity_pi(viscosity_nu(-r * v, r * r, h), c, rho, alpha, beta);
}

/* Approaching pairs are pushed apart (Pi > 0 acts as pressure), receding ones are left alone. */
static void sign(void **state)
{
  (void)state;
  assert_true(pair(1, 0.5, 1, 3, 2, 1, 2) > 0);
  assert_true(pair(-1, 0.5, 1, 3, 2, 1, 2) == 0);
  assert_true(pair(0, 0.5, 1, 3, 2, 1, 2) == 0);
  assert_true(viscosity_nu(-1, 0.25, 1) < 0 && viscosity_nu(1, 0.25, 1) == 0);
}

/* -Pi 1 in T_ij decelerates: dv_i/dt = m_j (-Pi) grad_i W, grad_i W along -r_ij; v heats at
 * m_j/2 Pi v_ij . grad_i W > 0. The + of 001 eq. 34 and the heating missing in eq. 31 fail. */
static void decelerates_and_heats(void **state)
{
  double v = 1, x_ij = -0.5, slope = -1; /* grad_i W = slope x_ij: towards j */
  double pi = pair(v, 0.5, 1, 3, 2, 1, 2), accelerate = -pi * slope * x_ij;
  (void)state;
  assert_true(accelerate < 0); /* against v_i */
  assert_true(0.5 * pi * v * slope * x_ij > 0);
}

/* Monaghan & Gingold (1983), by hand: nu = h v.r/(r^2 + 0.01 h^2), Pi = (-alpha c nu + beta
 * nu^2)/rho. */
static void by_hand(void **state)
{
  double nu = 2e3 * (-300. * 700) / (700. * 700 + 0.01 * 4e6);
  double pi = (-1.5 * 5e3 * nu + 2.5 * nu * nu) / 2700;
  (void)state;
  assert_true(fabs(pair(300, 700, 2e3, 5e3, 2700, 1.5, 2.5) / pi - 1) < 1e-14);
}

/* Pi is velocity^2 over density: the same pair in other units of length, time, mass; even where the
 * 0.01 h^2 counts, which without its h^2 would not scale. */
static void units(void **state)
{
  const double L = 1e3, T = 7, M = 3e5;
  (void)state;
  for (double r = 1e-3; r < 1; r *= 3) {
    double one = pair(0.3, r, 1, 2, 5, 1, 2);
    double other = pair(0.3 * L / T, r * L, L, 2 * L / T, 5 * M / (L * L * L), 1, 2);
    assert_true(fabs(other / (one * pow(L, 5) / (T * T * M)) - 1) < 1e-13);
  }
}

/* The linear term goes with c v, the quadratic with v^2; without c only the quadratic is left. */
static void limits(void **state)
{
  double linear = pair(1e-6, 0.5, 1, 3, 2, 1, 2), both = pair(2e-6, 0.5, 1, 3, 2, 1, 2);
  (void)state;
  assert_true(fabs(both / linear - 2) < 1e-5);
  assert_true(fabs(pair(2, 0.5, 1, 0, 2, 1, 2) / pair(1, 0.5, 1, 0, 2, 1, 2) - 4) < 1e-14);
  assert_true(pair(1, 0.5, 1, 3, 2, 0, 0) == 0);
  assert_true(isfinite(pair(1, 0, 1, 3, 2, 1, 2)));
}

/* 004 has h half of ours: its alpha = 1, beta = 2 are 0.5 and 0.5 here, but for the 0.01 h^2. */
static void half_support(void **state)
{
  double nu4 = 0.5 * (-0.5 * 2) / (0.25 + 0.01 * 0.25), pi4 = (-1 * 3 * nu4 + 2 * nu4 * nu4) / 2;
  (void)state;
  assert_true(fabs(pair(2, 0.5, 1, 3, 2, 0.5, 0.5) / pi4 - 1) < 0.06);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sign),    cmocka_unit_test(decelerates_and_heats),
      cmocka_unit_test(by_hand), cmocka_unit_test(units),
      cmocka_unit_test(limits),  cmocka_unit_test(half_support),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
