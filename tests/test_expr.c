/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expressions of fields beside the same written in C, their units, and what is refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include "lib/expr.h"
#include "lib/rng.h"

enum { COUNT = 1000 }; /* some blocks, and a part of one */

static Parts *cloud(void)
{
  Parts *p = part_new(COUNT);
  assert_int_equal(part_add(p, "id x v m rho u p cs mat body s damage", NULL), 0);
  assert_int_equal(part_add_material(p, "basalt", "name = \"basalt\";", NULL), 0);
  assert_int_equal(part_add_material(p, "ice", "name = \"ice\";", NULL), 1);
  for (long i = 0; i < COUNT; i++) {
    for (int a = 0; a < 3; a++) p->x[3 * i + a] = rng_uniform(1, (uint64_t)i, (uint32_t)a) - 0.5;
    for (int a = 0; a < 3; a++) p->v[3 * i + a] = rng_uniform(2, (uint64_t)i, (uint32_t)a) - 0.5;
    for (int a = 0; a < 6; a++) p->s[6 * i + a] = rng_uniform(3, (uint64_t)i, (uint32_t)a) - 0.5;
    p->id[i] = i, p->m[i] = 2, p->rho[i] = 1 + rng_uniform(4, (uint64_t)i, 0), p->body[i] = i % 3;
    p->cs[i] = 3 + rng_uniform(4, (uint64_t)i, 1), p->u[i] = 1e3 * rng_uniform(4, (uint64_t)i, 2);
    p->p[i] = 1e9 * (rng_uniform(4, (uint64_t)i, 3) - 0.5), p->mat[i] = i % 2;
  }
  double *extra = part_add_extra(p, "Odd name", "J/K/kg", "", NULL);
  for (long i = 0; i < COUNT; i++) extra[i] = 7. * (double)i;
  return p;
}

static void values(const Parts *p, const char *text, double out[COUNT])
{
  Err err = {""};
  Expr *e = expr_parse(text, &err);
  if (!e || expr_bind(e, p, "a.h5", &err)) fail_msg("%s: %s", text, err.text);
  expr_eval(e, out);
  expr_free(e);
}

/* X(expression as typed, value in C): of particle i at x, with velocity v, stress s. */
/* clang-format off */
#define CASES(X) \
  X("1 + 2*3 - 4/8", 6.5)                      X("2^3^2", 512) \
  X("-2^2", -4)                                X("2^-1 + 4^(1/2)", 2.5) \
  X("8 - 3 - 2", 3)                            X("16/4/2", 2) \
  X("Density", p->rho[i])                      X("Coordinates.y", x[1]) \
  X("Velocities", sqrt(v[0]*v[0] + v[1]*v[1] + v[2]*v[2])) \
  X("|Velocities|", sqrt(v[0]*v[0] + v[1]*v[1] + v[2]*v[2])) \
  X("|Velocities.x|", fabs(v[0])) \
  X("|-|Velocities.x| - 1m/s|", fabs(v[0]) + 1) \
  X("sqrt(Velocities.x^2+Velocities.y^2)/SoundSpeed", sqrt(v[0]*v[0] + v[1]*v[1])/p->cs[i]) \
  X("Masses*Velocities.z^3", 2*pow(v[2], 3)) \
  X("DeviatoricStress.yz + DeviatoricStress.xx", s[4] + s[0]) \
  X("DeviatoricStress", sqrt(s[0]*s[0] + s[3]*s[3] + s[5]*s[5] + 2*(s[1]*s[1] + s[2]*s[2] + s[4]*s[4]))) \
  X("Density > 1.5", p->rho[i] > 1.5)          X("Density > 0.0015g/cc", p->rho[i] > 1.5) \
  X("Pressure/1GPa", p->p[i]/1e9)              X("Coordinates.x < 10cm", x[0] < 0.1) \
  X("Velocities.x*2min + 1km", v[0]*120 + 1000) \
  X("Coordinates.x > 0 && Coordinates.y > 0 || BodyID == 2", (x[0] > 0 && x[1] > 0) || i % 3 == 2) \
  X("!(BodyID != 1) + (BodyID <= 0)", (i % 3 == 1) + (i % 3 == 0)) \
  X("MaterialID == 'ice'", i % 2)              X("ParticleIDs >= 998", i >= 998) \
  X("if(BodyID == 0, Density, -Density)", i % 3 ? -p->rho[i] : p->rho[i]) \
  X("min(Density, 1.2) + max(Density, 1.4)", fmin(p->rho[i], 1.2) + fmax(p->rho[i], 1.4)) \
  X("hypot(Velocities.x, Velocities.y)", hypot(v[0], v[1])) \
  X("atan2(Coordinates.y, Coordinates.x)", atan2(x[1], x[0])) \
  X("sin(90deg) + cos(pi) + tan(0)", 0)        X("asin(1) + acos(1) + atan(1)", 0.75*acos(-1)) \
  X("log10(Density) + log(Density)*exp(-1)", log10(p->rho[i]) + log(p->rho[i])/exp(1)) \
  X("cbrt(Density/1kg*1m^3) + abs(Coordinates.x)/1m + floor(2.7) + sign(-3) + mod(7, 4)", cbrt(p->rho[i]) + fabs(x[0]) + 2 - 1 + 3) \
  X("`Odd name`/7", (double)i)                 X(" ( Density ) ", p->rho[i]) \
  X("1e3*3.5e-1 + .5", 350.5)                  X("50%", 0.5) \
  X("InternalEnergy + Velocities^2/2", p->u[i] + (v[0]*v[0] + v[1]*v[1] + v[2]*v[2])/2)
/* clang-format on */
#define TEXT(T, ...)  T,
#define VALUE(T, ...) __VA_ARGS__,

static void as_in_c(void **state)
{
  static const char *const text[] = {CASES(TEXT)};
  enum { CASES_N = sizeof text / sizeof *text };
  static double got[CASES_N][COUNT];
  Parts *p = cloud();
  (void)state;
  for (int k = 0; k < CASES_N; k++) values(p, text[k], got[k]);
  for (long i = 0; i < COUNT; i++) {
    const double *x = p->x + 3 * i, *v = p->v + 3 * i, *s = p->s + 6 * i;
    const double want[] = {CASES(VALUE)};
    for (int k = 0; k < CASES_N; k++)
      if (!(fabs(got[k][i] - want[k]) <= 1e-13 * (1 + fabs(want[k]))))
        fail_msg("%s: %.17g, not %.17g", text[k], got[k][i], want[k]);
  }
  part_free(p);
}

static void units(void **state)
{
  static const struct {
    const char *text, *unit;
    int kinds;
  } table[] = {{"Density", "kg/m^3", 0},
               {"MaterialID", "1", 1},
               {"MaterialID + 0", "1", 0},
               {"ParticleIDs", "1", 0},
               {"ActiveFlaws", "1", 0},
               {"|Velocities|/SoundSpeed", "1", 0},
               {"Velocities.x^2", "J/kg", 0},
               {"sqrt(Pressure/Density)", "m/s", 0},
               {"Density*InternalEnergy", "Pa", 0},
               {"Masses/Density", "m^3", 0},
               {"cbrt(Masses/Density)", "m", 0},
               {"Masses*Velocities.x", "kg*m/s", 0},
               {"Density^0.5", "kg^0.5/m^1.5", 0},
               {"1/Density", "m^3/kg", 0},
               {"2*pi", "1", 0},
               {"Coordinates.x > 3", "1", 0},
               {"if(Damage > 0, Pressure, 0)", "Pa", 0},
               {"max(Density, 5)", "kg/m^3", 0},
               {"log10(Density)", "1", 0},
               {"`Odd name`", "J/K/kg", 0},
               {"`Odd name`*1K", "J/kg", 0}};
  Parts *p = cloud();
  Err err;
  (void)state;
  assert_int_equal(part_add(p, "nact", NULL), 0);
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    Expr *e = expr_parse(table[k].text, &err);
    assert_non_null(e);
    assert_int_equal(expr_bind(e, p, "a.h5", &err), 0);
    assert_string_equal(expr_unit(e), table[k].unit);
    assert_int_equal(expr_kinds(e), table[k].kinds);
    expr_free(e);
  }
  part_free(p);
}

static void refused(void **state)
{
  static const struct {
    const char *text, *why;
  } table[] = {{"", "a value is missing at the end"},
               {"1 +", "a value is missing at the end"},
               {"(1 + 2", "a ')' is missing at the end"},
               {"1 2", "an operator is missing at '2'"},
               {"Density)", "an operator is missing at ')'"},
               {"|Density", "a '|' is missing"},
               {"2 < 3 < 4", "do not chain"},
               {"Densty*2", "'a.h5' has no field 'Densty' (did you mean 'Density'?)"},
               {"Temperature", "'a.h5' lacks field 'Temperature' (made by solver)"},
               {"Velocities.w", "field 'Velocities' has no component 'w'"},
               {"Density.x", "field 'Density' has no component 'x'"},
               {"Velocities.", "a component is missing"},
               {"sqr(Density)", "no function 'sqr' (did you mean 'sqrt'?)"},
               {"min(1)", "'min' takes 2 arguments"},
               {"sin(1, 2)", "a ')' is missing at ', 2)'"},
               {"Density + Pressure", "'kg/m^3' and 'Pa' do not go together"},
               {"Density > 3km", "'kg/m^3' and 'm' do not go together"},
               {"exp(Density)", "'exp' wants a number without a unit"},
               {"Density^Damage", "takes a number as exponent"},
               {"Damage^Density", "an exponent has no unit"},
               {"3kn", "an unknown unit at 'kn'"},
               {"0x10", "not a number"},
               {"1e999", "not a number"},
               {"MaterialID == 'icy'", "no material 'icy' in this file (did you mean 'ice'?)"},
               {"'ice", "a quote does not end"},
               {"Density # 2", "an operator is missing at '# 2'"}};
  Parts *p = cloud();
  char deep[400];
  (void)state;
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    Err err = {""};
    Expr *e = expr_parse(table[k].text, &err);
    assert_true(!e || expr_bind(e, p, "a.h5", &err));
    if (!strstr(err.text, table[k].why)) fail_msg("%s: %s", table[k].text, err.text);
    expr_free(e);
  }
  for (const char *c = "(-|!"; *c; c++) { /* deep, but no deeper than the stack */
    memset(deep, *c, sizeof deep), deep[sizeof deep - 1] = 0;
    assert_null(expr_parse(deep, NULL));
  }
  part_free(p);
}

static void members(void **state)
{
  char list[64] = "id x";
  Err err;
  Expr *e = expr_parse("Velocities.x*Density + Coordinates.x + Density", &err),
       *other = expr_parse("Mine + Masses", &err);
  (void)state;
  assert_int_equal(expr_members(e, list, sizeof list), 0);
  assert_string_equal(list, "id x v rho");
  assert_int_equal(expr_members(other, list, sizeof list), 1);
  assert_int_equal(expr_members(other, list, 10), 1); /* there already */
  assert_int_equal(expr_members(e, strcpy(list, "x"), 3), -1);
  expr_free(e), expr_free(other);
}

static void selections(void **state)
{
  Parts *p = cloud();
  Err err;
  (void)state;
  unsigned char *keep = expr_select("BodyID == 1 || sqrt(Coordinates.x) > 0", p, "a.h5", &err);
  assert_non_null(keep);
  for (long i = 0; i < COUNT; i++) assert_int_equal(keep[i], i % 3 == 1 || p->x[3 * i] > 0);
  free(keep);
  assert_null(expr_select("BodyID == 7", p, "a.h5", &err));
  assert_string_equal(err.text, "'a.h5': 'BodyID == 7' holds for no particle");
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(as_in_c), cmocka_unit_test(units),
                                     cmocka_unit_test(refused), cmocka_unit_test(members),
                                     cmocka_unit_test(selections)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
