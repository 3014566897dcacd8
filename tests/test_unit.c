/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quantities: every unit against its definition, what must be refused, spelling help, readable
 * times and lengths. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>
#include "lib/unit.h"

#define PI   3.14159265358979323846
#define N(A) (int)(sizeof(A) / sizeof *(A))

static double read_si(const char *text, const char *kind)
{
  Err err;
  double x = NAN;
  if (unit_parse(text, kind, &x, &err)) fail_msg("%s as %s: %s", text, kind, err.text);
  return x;
}

/* Exact definitions are met to the last bit, the others to the digits of the source. */
static void values(void **state)
{
  static const struct {
    const char *text, *kind;
    double si, tolerance;
  } T[] = {
      {"5", "m", 5, 0},
      {"-3e2", "m/s", -300, 0},
      {" 437 km ", "m", 437e3, 0},
      {".5mm", "m", 5e-4, 0},
      {"1au", "m", 149597870700., 0}, /* IAU 2012 B2 */
      {"1Rearth", "m", 6378100, 0},
      {"1Rsun", "m", 695700e3, 0},
      {"1Rmoon", "m", 1737.4e3, 0},
      {"0.9Mearth", "kg", 5.374980e24, 1e-15}, /* the worked example of collide */
      {"1Mmoon", "kg", 7.3458e22, 1e-4},
      {"1Msun", "kg", 1.3271244e20 / UNIT_G, 1e-4},
      {"2000min", "s", 120000, 0},
      {"1.5h", "s", 5400, 0},
      {"2d", "s", 172800, 0},
      {"1yr", "s", 31557600, 0},
      {"3ms", "s", 3e-3, 0},
      {"7us", "s", 7e-6, 0},
      {"3g", "kg", 3e-3, 0},
      {"2t", "kg", 2000, 0},
      {"180deg", "rad", PI, 0},
      {"60arcmin", "rad", PI / 180, 1e-15},
      {"3600arcsec", "rad", PI / 180, 1e-15},
      {"2.7g/cc", "kg/m^3", 2700, 0},
      {"2.7 g/cm^3", "kg/m^3", 2700, 0},
      {"1kg m^-3", "kg/m^3", 1, 0},
      {"1km/s", "m/s", 1000, 0},
      {"1cm/s", "m/s", 0.01, 0},
      {"36km/h", "m/s", 10, 1e-15},
      {"1kJ/kg", "J/kg", 1e3, 0},
      {"4.72MJ/kg", "J/kg", 4.72e6, 0},
      {"1erg/g", "J/kg", 1e-4, 1e-15},
      {"2m^2/s^2", "J/kg", 2, 0},
      {"26.7GPa", "Pa", 26.7e9, 0},
      {"1kPa", "Pa", 1e3, 0},
      {"1bar", "Pa", 1e5, 0},
      {"3.5MPa", "Pa", 3.5e6, 0},
      {"1N/m^2", "Pa", 1, 0},
      {"1J/m^3", "Pa", 1, 0},
      {"1eV", "K", 11604.51812, 1e-9}, /* CODATA 2018 */
      {"1kJ/kg/K", "J/K/kg", 1e3, 0},
      {"5/m^3", "1/m^3", 5, 0},
      {"5 1/cm^3", "1/m^3", 5e6, 0},
      {"2Hz", "1/s", 2, 0},
      {"1/h", "1/s", 1. / 3600, 1e-15},
      {"30%", "1", 0.3, 1e-15},
      {"1 deg/s", "rad/s", PI / 180, 1e-15},
      {"3W/kg", "m^2/s^3", 3, 0},
      {"10 g*cm/s^2", "N", 1e-4, 1e-15},
  };
  (void)state;
  for (int k = 0; k < N(T); k++) {
    double x = read_si(T[k].text, T[k].kind);
    if (fabs(x - T[k].si) > T[k].tolerance * fabs(T[k].si))
      fail_msg("%s: %.17g, not %.17g", T[k].text, x, T[k].si);
  }
}

/* Nothing is guessed: each mistake has its message, and the value is left alone. */
static void refused(void **state)
{
  static const struct {
    const char *text, *kind, *part;
  } T[] = {
      {"", "m", "not a number"},
      {"km", "m", "not a number"},
      {"nan", "m", "not a number"},
      {"inf", "m", "not a number"},
      {"-inf", "m", "not a number"},
      {"0x10", "m", "not a number"},
      {"1e999", "m", "too large"},
      {"1e308km", "m", "too large"},
      {"5s", "m", "wanted a unit like 'm', not 's'"},
      {"5km", "1", "plain number"},
      {"48deg", "1", "plain number"},
      {"5kg/m^2", "kg/m^3", "wanted a unit like"},
      {"5m2", "m", "not a unit"},
      {"5 1", "m", "not a unit"},
      {"5km x", "m", "unknown unit 'x'"},
      {"5m/", "m", "not a unit"},
      {"5m^", "m", "not a power"},
      {"5m^0.5", "m", "not a power"},
      {"5m^18446744073709551615", "1/m", "not a power"},
      {"5mins", "s", "did you mean 'min'"},
      {"1KM", "m", "did you mean 'km'"},
      {"0.9Merth", "kg", "did you mean 'Mearth'"},
      {"1.7vesc", "m/s", "unknown unit 'vesc'"},
      {"1M", "kg", "unknown unit 'M'"},
  };
  (void)state;
  for (int k = 0; k < N(T); k++) {
    Err err;
    double x = 42;
    if (!unit_parse(T[k].text, T[k].kind, &x, &err))
      fail_msg("'%s' was taken for a %s", T[k].text, T[k].kind);
    if (!strstr(err.text, T[k].part)) fail_msg("'%s': %s", T[k].text, err.text);
    assert_true(x == 42);
  }
}

/* h is the hour and m the metre: one letter never means two things. */
static void kinds_do_not_mix(void **state)
{
  double x;
  (void)state;
  assert_int_equal(unit_parse("1h", "m", &x, NULL), -1);
  assert_int_equal(unit_parse("1m", "s", &x, NULL), -1);
  assert_int_equal(unit_parse("1min", "m", &x, NULL), -1);
  assert_int_equal(unit_parse("1K", "1/s", &x, NULL), -1);
}

static void suffix(void **state)
{
  const char *rest;
  double x;
  (void)state;
  assert_int_equal(unit_suffix("1.7vesc", &x, &rest, NULL), 0);
  assert_true(x == 1.7);
  assert_string_equal(rest, "vesc");
  assert_int_equal(unit_suffix("12", &x, &rest, NULL), 0);
  assert_string_equal(rest, "");
  assert_int_equal(unit_suffix("vesc", &x, &rest, NULL), -1);
  assert_int_equal(unit_suffix("1e999vesc", &x, &rest, NULL), -1);
}

static void nearest(void **state)
{
  static const char *const WORDS[] = {"rho0", "hcp", "form", "bulk", "number", "damping"};
  (void)state;
  assert_string_equal(unit_nearest("rh0", WORDS, N(WORDS)), "rho0"); /* one left out */
  assert_string_equal(unit_nearest("hpc", WORDS, N(WORDS)), "hcp");  /* two swapped */
  assert_string_equal(unit_nearest("NUMBER", WORDS, N(WORDS)), "number");
  assert_string_equal(unit_nearest("dampening", WORDS, N(WORDS)), "damping");
  assert_null(unit_nearest("zzz", WORDS, N(WORDS)));
  assert_null(unit_nearest("x", WORDS, N(WORDS)));
  assert_null(unit_nearest("", WORDS, N(WORDS)));
  assert_null(unit_nearest("form", WORDS, 0));
}

static void choice(void **state)
{
  Err err;
  (void)state;
  assert_int_equal(unit_choice("hcp", "hcp|shells|cubic", &err), 0);
  assert_int_equal(unit_choice("cubic", "hcp|shells|cubic", &err), 2);
  assert_int_equal(unit_choice("cubik", "hcp|shells|cubic", &err), -1);
  assert_non_null(strstr(err.text, "did you mean 'cubic'"));
  assert_int_equal(unit_choice("", "hcp|shells|cubic", &err), -1);
  assert_int_equal(unit_choice("hcp|shells", "hcp|shells|cubic", &err), -1);
}

static void readable(void **state)
{
  static const struct {
    double x;
    const char *time, *length;
  } T[] = {{0, "0 s", "0 m"},          {5598, "93.3 min", "5.6 km"},  {437e3, "5.06 d", "437 km"},
           {119, "119 s", "119 m"},    {0.25, "250 ms", "25 cm"},     {3e11, "9506 yr", "2.01 au"},
           {-7200, "-2 h", "-7.2 km"}, {1e-9, "0.001 us", "1e-06 mm"}};
  char buf[32];
  (void)state;
  for (int k = 0; k < N(T); k++) {
    assert_string_equal(unit_time_text(T[k].x, buf, sizeof buf), T[k].time);
    assert_string_equal(unit_length_text(T[k].x, buf, sizeof buf), T[k].length);
  }
}

/* Vectors: as many numbers as wanted, each a quantity of the kind. */
static void lists(void **state)
{
  double x[3] = {0};
  Err err = {""};
  (void)state;
  assert_int_equal(unit_list("1km,-2,3e2cm", "m", 3, x, &err), 0);
  assert_true(x[0] == 1000 && x[1] == -2 && x[2] == 3);
  const char *const wrong[] = {"", "1,2", "1,2,3,4", "1,,3", "1,2,3s", "1,2,x", "1 2 3"};
  for (int k = 0; k < N(wrong); k++) assert_int_equal(unit_list(wrong[k], "m", 3, x, &err), -1);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values),   cmocka_unit_test(refused), cmocka_unit_test(kinds_do_not_mix),
      cmocka_unit_test(suffix),   cmocka_unit_test(nearest), cmocka_unit_test(choice),
      cmocka_unit_test(readable), cmocka_unit_test(lists),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
