/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lib/recipe: layers from texts, masses from whatever is given: every way to say the same body
 * finds it, the numbers that are not enough or too many are refused; the recipe in a file is the
 * same. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>
#include "../lib/recipe.h"

/* clang-format off */
static const Material IRON = {.eos = {.form = EOS_TILLOTSON, .tillotson = {.rho0 = 7800, .A = 128e9, .B = 105e9, .E0 = 9.5e6,
  .Eiv = 2.4e6, .Ecv = 8.67e6, .a = 0.5, .b = 1.5, .alpha = 5, .beta = 5}}, .heat = 449};
static const Material ROCK = {.eos = {.form = EOS_MURNAGHAN, .murnaghan = {.rho0 = 2700, .K = 5.0e10, .n = 4}}, .heat = 840};
static const Material ICE = {.eos = {.form = EOS_MURNAGHAN, .murnaghan = {.rho0 = 917, .K = 9e9, .n = 5}}};
/* clang-format on */

static void near(double got, double want, double tolerance)
{
  if (!(fabs(got - want) <= tolerance * fabs(want)))
    fail_msg("%.12g, want %.12g: off by %.3g", got, want, got / want - 1);
}

static const Material *material(const char *name)
{
  return !strcmp(name, "iron") ? &IRON : !strcmp(name, "rock") ? &ROCK : &ICE;
}

/* Layers, separated by blanks. */
static Recipe recipe(const char *texts, double mass, double radius, int weightless)
{
  static const StructureLayer cold = {0};
  Recipe r = {.mass = mass, .radius = radius, .body = {.weightless = weightless}};
  char copy[512], name[256], *rest;
  Err err;
  strcpy(copy, texts);
  for (char *t = strtok_r(copy, " ", &rest); t; t = strtok_r(NULL, " ", &rest)) {
    if (recipe_layer(&r, t, &cold, name, &err)) fail_msg("%s", err.text);
    r.body.layer[r.body.layers - 1].material = material(name);
  }
  return r;
}

static Recipe solved(const char *texts, double mass, double radius, int weightless)
{
  Recipe r = recipe(texts, mass, radius, weightless);
  Err err;
  if (recipe_solve(&r, 3, &err)) fail_msg("%s: %s", texts, err.text);
  return r;
}

/* One Earth-like body, said in many ways. */
static void test_many_ways(void **state)
{
  Recipe a = solved("iron:0.32 rock:0.68", 6e24, NAN, 0);
  Structure s;
  Err err;
  char text[256];
  double core;
  (void)state;
  near(a.body.layer[0].mass, 0.32 * 6e24, 1e-14);
  assert_int_equal(structure_solve(&s, &a.body, 100, &err), 0);
  core = s.node[s.first[1] - 1].r;
  near(a.radius, s.node[s.n - 1].r, 1e-10);
  structure_free(&s);
  const char *const ways[] = {"iron rock", "iron:0.32 rock:0.68", "iron:%.15gm rock",
                              "iron:%.15gm rock", "iron:0.32 rock:%.15gm"};
  const double mass[] = {6e24, NAN, 6e24, NAN, NAN};
  for (int k = 0; k < 5; k++) {
    Recipe b;
    int by_end = k == 4;
    snprintf(text, sizeof text, ways[k], by_end ? a.radius : core);
    b = solved(text, mass[k], k == 2 || by_end ? NAN : a.radius, 0);
    near(b.body.layer[0].mass, a.body.layer[0].mass, 1e-7);
    near(b.body.layer[1].mass, a.body.layer[1].mass, 1e-7);
    near(b.mass, 6e24, 1e-7), near(b.radius, a.radius, 1e-8);
  }
}

/* Three layers, and a body without gravity, where volumes say it all: M and R of iron and ice. */
static void test_others(void **state)
{
  double v = 4 * acos(-1) / 3 * 1e15, iron = (5e18 - 917 * v) / (1 - 917 / 7800.);
  Recipe a = solved("iron ice", 5e18, 1e5, 1), b, c;
  char text[256];
  (void)state;
  near(a.body.layer[0].mass, iron, 1e-9);
  b = solved("iron:1e22kg rock:0.5 ice", 1e23, NAN, 0);
  near(b.body.layer[0].mass, 1e22, 1e-13), near(b.body.layer[1].mass, 5e22, 1e-13);
  near(b.body.layer[2].mass, 4e22, 1e-13);
  snprintf(text, sizeof text, "iron:1e22kg rock ice:%.15gkg", 4e22);
  c = solved(text, NAN, b.radius, 0);
  near(c.body.layer[1].mass, 5e22, 1e-6);
  c = recipe("ice", NAN, 7, 1);
  assert_int_equal(recipe_solve(&c, 2, NULL), 0);
  near(c.mass, 917 * acos(-1) * 49, 1e-12);
}

static void test_words(void **state)
{
  static const StructureLayer usual = {.anchor = STRUCTURE_ENERGY, .at = 7};
  Recipe r = {.mass = 1, .radius = NAN};
  char name[256];
  const StructureLayer *l = r.body.layer;
  (void)state;
  assert_int_equal(recipe_layer(&r, "a/b.cfg:0.5:T=1500K,power=0.6", &usual, name, NULL), 0);
  assert_string_equal(name, "a/b.cfg");
  assert_true(l->anchor == STRUCTURE_TEMPERATURE && l->at == 1500 && l->power);
  near(l->exponent, 0.6, 1e-15);
  assert_int_equal(recipe_layer(&r, "x::isothermal,T=continuous", &usual, name, NULL), 0);
  assert_true(l[1].anchor == STRUCTURE_CONTINUOUS && l[1].power && l[1].exponent == 0);
  assert_int_equal(recipe_layer(&r, "y:2Mearth:u=3MJ/kg", &usual, name, NULL), 0);
  assert_true(l[2].anchor == STRUCTURE_ENERGY && l[2].at == 3e6 && !l[2].power);
  near(r.layer_mass[2], 2 * 5.9722e24, 1e-3);
  assert_int_equal(recipe_layer(&r, "z:3km", &usual, name, NULL), 0);
  assert_true(l[3].at == 7 && r.end[3] == 3000);
}

static void refuse(const char *texts, double mass, double radius, const char *why)
{
  Recipe r = recipe(texts, mass, radius, 0);
  Err err = {""};
  if (!recipe_solve(&r, 3, &err)) fail_msg("%s is taken", texts);
  if (!strstr(err.text, why)) fail_msg("%s: '%s' does not say '%s'", texts, err.text, why);
}

static void test_refuses(void **state)
{
  const char *const bad[][2] = {{"rock:0", "not positive"},
                                {"rock:-3km", "not positive"},
                                {"rock:3furlong", "not a mass fraction, a mass or a radius"},
                                {"rock:0.3:u=-1", "u=-1 is negative"},
                                {"rock:0.3:t=5", "'t=5' is not u="},
                                {"rock:0.3:T=5kg", "kg"},
                                {"rock:0.3:u=1:2", "is not MATERIAL[:SHARE][:STATE]"}};
  static const StructureLayer cold = {0};
  char name[256];
  (void)state;
  refuse("iron rock", 6e24, NAN, "1 of mass, radius and layers' shares given for 2 layers");
  refuse("iron:0.3 rock", 6e24, 6e6, "3 of mass, radius and layers' shares given for 2 layers");
  refuse("iron:0.3 rock:0.6", 6e24, NAN, "sum to 0.9, not to 1");
  refuse("iron:0.3 rock:0.8 ice", 6e24, NAN, "nothing is left");
  refuse("iron:7km rock:6km", NAN, NAN, "layer 2 is not above");
  refuse("iron rock", 6e24, 1e7, "no body of these layers");
  for (int k = 0; k < 7; k++) {
    Recipe r = {0};
    Err err = {""};
    assert_int_equal(recipe_layer(&r, bad[k][0], &cold, name, &err), -1);
    if (!strstr(err.text, bad[k][1])) fail_msg("'%s' does not say '%s'", err.text, bad[k][1]);
  }
}

/* What a file keeps is the same body. */
static void test_store(void **state)
{
  Recipe a = solved("iron:0.3:s=3000,power=0.5 rock:0.4:T=continuous rock:0.3:T=300K,isothermal",
                    5e24, NAN, 0);
  Material materials[2] = {IRON, ROCK};
  Parts *p = part_new(0);
  StructureBody b;
  Err err;
  (void)state;
  assert_int_equal(recipe_load(p, materials, &b, &err), 0);
  assert_int_equal(part_add_material(p, "iron", "", &err), 0);
  assert_int_equal(part_add_material(p, "rock", "", &err), 1);
  a.body.layer[1].mat = a.body.layer[2].mat = 1, a.body.outer = 5e5;
  assert_int_equal(recipe_store(p, &a.body, &err), 0);
  assert_int_equal(recipe_load(p, materials, &b, &err), 3);
  assert_true(b.outer == 5e5);
  for (int k = 0; k < 3; k++) {
    const StructureLayer *x = &a.body.layer[k], *y = &b.layer[k];
    assert_true(x->mass == y->mass && x->mat == y->mat && x->anchor == y->anchor);
    assert_true(x->at == y->at && x->power == y->power);
    assert_true(!x->power || x->exponent == y->exponent);
    assert_ptr_equal(y->material, &materials[y->mat]);
  }
  assert_int_equal(part_set_number(p, "body", "Layer2Mass0", -1, &err), 0);
  assert_int_equal(recipe_load(p, materials, &b, &err), -1);
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_many_ways), cmocka_unit_test(test_others), cmocka_unit_test(test_words),
      cmocka_unit_test(test_refuses),   cmocka_unit_test(test_store),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
