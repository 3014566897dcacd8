/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lib/figure: the potential of a spheroid against a sum over its mass, Maclaurin spheroids, and for
 * slow spin Clairaut's equation on the layered structure. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>
#include "../lib/figure.h"
#include "../lib/unit.h"

static const double PI = 3.14159265358979323846;

/* clang-format off */
static const Material STIFF = {.eos = {.form = EOS_MURNAGHAN, .murnaghan = {.rho0 = 2000, .K = 1e16, .n = 4}}};
static const Material METAL = {.eos = {.form = EOS_MURNAGHAN, .murnaghan = {.rho0 = 7800, .K = 1.28e11, .n = 4}}};
static const Material ROCK = {.eos = {.form = EOS_MURNAGHAN, .murnaghan = {.rho0 = 2700, .K = 5e10, .n = 4}}};
/* clang-format on */
static const StructureBody EARTH = {.layer = {{&METAL, 2e24}, {&ROCK, 4e24, .mat = 1}},
                                    .layers = 2};

static void near(double got, double want, double tolerance)
{
  if (!(fabs(got - want) <= tolerance * fabs(want)))
    fail_msg("%.12g, want %.12g: off by %.3g", got, want, got / want - 1);
}

/* Rings of mass, each by the mean of 1/distance over its circle. */
static double by_sum(double a, double c, double w, double z)
{
  enum { N = 160, TURNS = 48 };
  double sum = 0;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) { /* scaled radius and cosine: w = a r sin, z = c r cos */
      double r = (i + 0.5) / N, t = -1 + 2 * (j + 0.5) / N;
      double ring = a * r * sqrt(1 - t * t), high = c * r * t, mean = 0;
      for (int k = 0; k < TURNS; k++) {
        double phi = 2 * PI * (k + 0.5) / TURNS;
        mean += 1 / sqrt(w * w + ring * ring - 2 * w * ring * cos(phi) + pow(z - high, 2)) / TURNS;
      }
      sum -= mean * 2 * PI * a * a * c * r * r / N * 2 / N;
    }
  return sum;
}

static void test_potential(void **state)
{
  const double at[][4] = {
      {1, 0.6, 1.5, 0.7}, {1, 0.6, 0, 1.2}, {1, 0.97, 1.3, 0.2}, {2, 0.8, 2.6, 0}};
  (void)state;
  for (int k = 0; k < 4; k++)
    near(figure_potential(at[k][0], at[k][1], at[k][2], at[k][3]),
         by_sum(at[k][0], at[k][1], at[k][2], at[k][3]), 3e-4);
  near(figure_potential(1, 1, 0.5, 0), -2 * PI / 3 * (3 - 0.25), 1e-13);
  near(figure_potential(1, 1, 0, 3), -4 * PI / 9, 1e-13);
  for (double c = 0.3; c < 1;
       c += 0.13) { /* continuous at the surface, smooth between the series */
    near(figure_potential(1, c, 1 + 1e-9, 0), figure_potential(1, c, 1 - 1e-9, 0), 1e-8);
    near(figure_potential(1, c, 0, c + 1e-9), figure_potential(1, c, 0, c - 1e-9), 1e-8);
  }
  near(figure_potential(1, sqrt(0.9 + 1e-12), 0.3, 0.2),
       figure_potential(1, sqrt(0.9 - 1e-12), 0.3, 0.2), 1e-11);
}

/* omega^2/(pi G rho) = 2 sqrt(1-e^2) (3 - 2 e^2) asin(e)/e^3 - 6 (1-e^2)/e^2. */
static void test_maclaurin(void **state)
{
  (void)state;
  for (double e = 0.1; e < 0.85; e += 0.24) {
    StructureBody body = {.layer = {{&STIFF, 1e21}}, .layers = 1};
    double x = e * e, spin = 2 * sqrt(1 - x) * (3 - 2 * x) * asin(e) / (e * x) - 6 * (1 - x) / x;
    Structure s;
    Err err;
    assert_int_equal(structure_solve(&s, &body, 200, &err), 0);
    if (figure_spin(&s, &body, sqrt(spin * PI * UNIT_G * 2000), &err)) fail_msg("%s", err.text);
    near(1 - s.node[s.n - 1].f, sqrt(1 - x), 1e-5);
    near(1 - s.node[50].f, sqrt(1 - x), 1e-5);
    near(s.node[s.n - 1].r, cbrt(1e21 / 2000 / (4 * PI / 3)), 1e-5);
    structure_free(&s);
  }
}

/* Radau's form of Clairaut's equation, eta = dln f/dln r: r eta' + eta^2 - eta - 6 + 6 rho/rho_mean
 * (eta + 1) = 0; f(R) = 5/2 omega^2 R^3/(G M)/(eta(R) + 2). */
static void test_clairaut(void **state)
{
  Structure s;
  Err err;
  double eta = 0, r, f, omega, m;
  (void)state;
  assert_int_equal(structure_solve(&s, &EARTH, 4000, &err), 0);
  r = s.node[s.n - 1].r, m = s.node[s.n - 1].m;
  for (int k = 1; k < 40000; k++) {
    double x = (k + 0.5) / 40000 * r;
    StructureNode n = structure_at_radius(&s, x);
    double mean = n.m / (4 * PI / 3 * x * x * x);
    eta += (6 + eta - eta * eta - 6 * n.rho / mean * (eta + 1)) / x * r / 40000;
  }
  omega = 0.02 * sqrt(UNIT_G * m / (r * r * r));
  f = 2.5 * 0.02 * 0.02 / (eta + 2);
  if (figure_spin(&s, &EARTH, omega, &err)) fail_msg("%s", err.text);
  near(s.node[s.n - 1].f, f, 3e-3);
  structure_free(&s);
}

/* Fast spin: larger, with less pressure inside; the level surface of a point; too fast is refused.
 * */
static void test_fast(void **state)
{
  Structure s, rest;
  Err err;
  const StructureNode *top;
  (void)state;
  assert_int_equal(structure_solve(&s, &EARTH, 500, &err), 0);
  assert_int_equal(structure_solve(&rest, &EARTH, 500, &err), 0);
  if (figure_spin(&s, &EARTH, 2 * PI / 9000, &err)) fail_msg("%s", err.text);
  top = &s.node[s.n - 1];
  assert_true(top->f > 0.1 && top->f < 0.4);
  assert_true(top->r > 1.005 * rest.node[rest.n - 1].r && s.node[0].p < 0.97 * rest.node[0].p);
  for (long k = 1; k < s.n; k++) assert_true(s.node[k].f >= s.node[k - 1].f - 1e-9);
  for (long k = 20; k < s.n; k += 37) {
    double x[3] = {0.6 * s.node[k].r, 0, 0.8 * s.node[k].r};
    figure_flatten(&s.node[k], x);
    near(figure_level(&s, x[0], x[2]), s.node[k].r, 1e-5);
  }
  structure_free(&s);
  assert_int_equal(structure_solve(&s, &EARTH, 500, &err), 0);
  assert_int_equal(figure_spin(&s, &EARTH, 2 * PI / 3000, &err), -1);
  assert_non_null(strstr(err.text, "too fast"));
  structure_free(&s), structure_free(&rest);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_potential),
      cmocka_unit_test(test_maclaurin),
      cmocka_unit_test(test_clairaut),
      cmocka_unit_test(test_fast),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
