/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Materials: every law of the lists can be read, every mistake is named with its line, and the
 * files of materials/ say what their sources say. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>
#include "lib/cfg.h"
#include "lib/material.h"
#include "lib/tabfile.h"
#include "folder.h"

#define N(A) (int)(sizeof(A) / sizeof *(A))

static Material parse(const char *text)
{
  Material m;
  Err err;
  if (material_parse(&m, text, "x.cfg", &err)) fail_msg("%s\n%s", err.text, text);
  return m;
}

/* A value of its own for each row that its range allows, rising where it can. */
static double trial(int k, double max) { return max < 2 ? max - 0.01 * k : 1.5 + 0.01 * k; }

/* A text with all parameters of a law, and what must be read: X of the lists expands to both. */
#define TEXT_ROW(MEMBER, UNIT, VALUE, MIN, MAX, MEANING)                                           \
  at += sprintf(at, "%s = %.17g;\n", #MEMBER, trial(row++, MAX));
#define CHECK_ROW(MEMBER, UNIT, VALUE, MIN, MAX, MEANING)                                          \
  assert_true(law->MEMBER == trial(row++, MAX));

#define EOS_TEST(CAPITAL, NAME)                                                                    \
  static void eos_law_##NAME(void)                                                                 \
  {                                                                                                \
    char text[4096],                                                                               \
        *at = text + sprintf(text, "name = \"x\"; eos = { form = \"%s\"; %s\n", #NAME,             \
                             EOS_##CAPITAL == EOS_TABLE ? "file = \"any.h5\";" : "");              \
    Material m;                                                                                    \
    const struct eos_##NAME *law = &m.eos.NAME;                                                    \
    int row = 0;                                                                                   \
    EOS_##CAPITAL##_ROWS(TEXT_ROW) strcpy(at, "};");                                               \
    m = parse(text);                                                                               \
    assert_int_equal(m.eos.form, EOS_##CAPITAL);                                                   \
    row = 0;                                                                                       \
    EOS_##CAPITAL##_ROWS(CHECK_ROW) material_clear(&m);                                            \
  }
#define YIELD_TEST(CAPITAL, NAME)                                                                  \
  static void yield_law_##NAME(void)                                                               \
  {                                                                                                \
    char text[4096], *at = text + sprintf(text,                                                    \
                                          "name = \"x\"; eos = { form = \"liquid\"; rho0 = 1;"     \
                                          "c = 1; heat_capacity = 1; };"                           \
                                          "strength = { shear_modulus = 7;"                        \
                                          "melt_energy = 3; form = \"%s\";\n",                     \
                                          #NAME);                                                  \
    Material m;                                                                                    \
    const struct yield_##NAME *law = &m.yield.NAME;                                                \
    int row = 0;                                                                                   \
    YIELD_##CAPITAL##_ROWS(TEXT_ROW)                                                               \
        strcpy(at, YIELD_##CAPITAL == YIELD_POROUS                                                 \
                       ? "}; porosity = { form = \"sirono\"; alpha_0 = 5; K_0 = 1; p_m = 1; };"    \
                       : "};");                                                                    \
    m = parse(text);                                                                               \
    assert_true(m.yield.form == YIELD_##CAPITAL && m.mu == 7 && m.melt == 3);                      \
    row = 0;                                                                                       \
    YIELD_##CAPITAL##_ROWS(CHECK_ROW)                                                              \
  }
EOS_LAWS(EOS_TEST)
YIELD_LAWS(YIELD_TEST)

/* Any table, where tests run. */
static void any_table(void)
{
  const double rho[] = {1, 2, 3, 4};
  Table t;
  Err err;
  assert_int_equal(table_new(&t, 4, 4, 0, &err), 0);
  memcpy(t.rho, rho, sizeof rho), memcpy(t.y, rho, sizeof rho);
  if (tabfile_write(&t, "any.h5", TABFILE_HDF5, &err)) fail_msg("%s", err.text);
  table_free(&t);
}

static void every_law(void **state)
{
#define CALL_EOS(CAPITAL, NAME)   eos_law_##NAME();
#define CALL_YIELD(CAPITAL, NAME) yield_law_##NAME();
  (void)state;
  any_table();
  EOS_LAWS(CALL_EOS)
  YIELD_LAWS(CALL_YIELD)
}

#define EOS    "eos = { form = \"liquid\"; rho0 = \"1 g/cc\"; c = \"1.5 km/s\"; };\n"
#define SOLID  "strength = { form = \"none\"; shear_modulus = \"1 GPa\"; };\n"
#define DAMAGE "damage = { form = \"grady_kipp\"; k = 1e61; m = 16; };\n"

static void units_and_defaults(void **state)
{
  Material m = parse("name = \"x\";\n" EOS SOLID DAMAGE);
  (void)state;
  assert_true(m.eos.liquid.rho0 == 1000 && m.eos.liquid.c == 1500 && m.eos.liquid.rho_min == 0.9);
  assert_true(m.mu == 1e9 && m.yield.form == YIELD_NONE && m.melt == 0);
  assert_true(material_brittle(&m) && m.damage.grady_kipp.k == 1e61);
  assert_true(m.damage.grady_kipp.crack == 0.4);
  m = parse("name = \"x\";\n" EOS);
  assert_true(m.mu == 0 && m.yield.form == YIELD_NONE && !material_brittle(&m));
}

static void pores(void **state)
{
  Material m =
      parse("name = \"x\";\n" EOS "porosity = { form = \"p_alpha_two_power\"; alpha_0 = 1.7;"
            "c_elastic = \"1 km/s\"; p_e = \"1 MPa\"; p_t = \"68 MPa\"; p_s = \"213 MPa\";"
            "alpha_e = 4.64; alpha_t = 1.9; n1 = 12; n2 = 3; };");
  const struct porosity_p_alpha_two_power *q = &m.porosity.p_alpha_two_power;
  (void)state;
  assert_true(material_porous(&m) && m.porosity.form == POROSITY_P_ALPHA_TWO_POWER);
  assert_true(m.porosity.alpha0 == 1.7 && m.porosity.c == 1e3 && q->p_e == 1e6 && q->p_s == 213e6);
  assert_true(q->p_t == 68e6 && q->alpha_e == 4.64 && q->alpha_t == 1.9 && q->n1 == 12 &&
              q->n2 == 3);
  m = parse("name = \"x\";\n" EOS
            "porosity = { form = \"epsilon_alpha\"; alpha_0 = 1.7; kappa = 0.98;"
            "epsilon_x = -0.2; };");
  assert_true(m.porosity.epsilon_alpha.epsilon_e == 0 && m.porosity.epsilon_alpha.gamma == 0);
  m = parse("name = \"x\";\n" EOS
            "porosity = { form = \"sirono\"; alpha_0 = 5; K_0 = 4e3; p_m = 1e3; };");
  assert_true(m.porosity.sirono.phi_max == 0.58 && m.porosity.sirono.b == 1.48);
  m = parse("name = \"x\";\n" EOS);
  assert_true(!material_porous(&m) && material_distention(&m) == 1);
}

static void mistakes(void **state) /* lint: a table */
{
  static const char *const T[][2] = {
      {EOS, "missing key 'name'"},
      {"name = \"\";" EOS, "x.cfg:1: 'name' must not be empty"},
      {"name = \"a/b\";" EOS, "x.cfg:1: 'name' must not"},
      {"name = \"x\";", "x.cfg: missing group 'eos'"},
      {"name = \"x\";\neos = 5;", "x.cfg:2: 'eos' must be a group"},
      {"name = \"x\";\neos = { rho0 = 1; };", "x.cfg:2: missing key 'form'"},
      {"name = \"x\";\neos = {\n form = \"tilotson\"; };", "x.cfg:3: 'form'"},
      {"name = \"x\";\neos = {\n form = \"tilotson\"; };", "did you mean 'tillotson'?"},
      {"name = \"x\";\neos = { form = \"liquid\"; rho0 = 1;\n C = 5; };",
       "x.cfg:3: unknown key 'C' (did you mean"},
      {"name = \"x\";\neos = { form = \"liquid\"; rho0 = 1; };", "x.cfg:2: missing key 'c'"},
      {"name = \"x\";\neos = { form = \"liquid\"; rho0 = -1; c = 1; };", "x.cfg:2: 'rho0' = -1"},
      {"name = \"x\";\neos = { form = \"liquid\";\n rho0 = \"3 km\"; c = 1; };", "x.cfg:3: 'rho0'"},
      {"name = \"x\";\n" EOS "strenght = {};", "x.cfg:3: unknown key 'strenght' (did you mean"},
      {"name = \"x\";\n" EOS "strength = { form = \"none\"; shear_modulus = 1; Y = 2; };",
       "x.cfg:3: unknown key 'Y'"},
      {"name = \"x\";\n" EOS "strength = { form = \"von_mises\"; shear_modulus = 0; Y = 2; };",
       "x.cfg:3: a yield stress needs a 'shear_modulus'"},
      {"name = \"x\";\n" EOS "strength = { form = \"johnson_cook\"; shear_modulus = 1; A = 1; };",
       "x.cfg:3: johnson_cook needs a 'heat_capacity'"},
      {"name = \"x\";\n" EOS "strength = { form = \"collins\"; shear_modulus = 1; cohesion = 2;"
       "friction = 1;\nlimit = 1; friction_damaged = 1; };",
       "x.cfg:4: 'limit' must not be below 'cohesion'"},
      {"name = \"x\";\n" EOS "strength = { form = \"collins\"; shear_modulus = 1; cohesion = 2;"
       "friction = 1; limit = 3; friction_damaged = 1; };\n" DAMAGE,
       "x.cfg:4: collins has a strength for damaged rock of its own: 'shear' must be 0"},
      {"name = \"x\";\n" EOS "porosity = { form = \"p_alpha\"; alpha_0 = 2; p_e = 2; p_s = 1; };",
       "x.cfg:3: 'p_s' must be above 'p_e'"},
      {"name = \"x\";\n" EOS "porosity = { form = \"p_alpha\"; alpha_0 = 0.5; p_e = 1; p_s = 2; };",
       "x.cfg:3: 'alpha_0' = 0.5"},
      {"name = \"x\";\n" EOS "porosity = { form = \"p_alpha\"; alpha_0 = 2; c_elastic = \"2 km/s\";"
       "p_e = 1; p_s = 2; };",
       "x.cfg:3: 'c_elastic' must not be above the sound speed of the solid"},
      {"name = \"x\";\n" EOS "strength = { form = \"porous\"; shear_modulus = 1; };",
       "x.cfg:3: the strength 'porous' needs the porosity 'sirono'"},
      {"name = \"x\";\neos = { form = \"ideal\"; gamma = 1.4; };\n"
       "porosity = { form = \"p_alpha\"; alpha_0 = 2; p_e = 1; p_s = 2; };",
       "x.cfg:3: a gas has no pores"},
      {"name = \"x\";\n" EOS "strength = { form = \"regolith\"; shear_modulus = 1; cohesion = 1;"
       "friction = 1; };\nporosity = { form = \"p_alpha\"; alpha_0 = 2; p_e = 1; p_s = 2; };",
       "x.cfg:4: the strength 'regolith' opens pores of its own"},
      {"name = \"x\";\n" EOS "strength = { form = \"regolith\"; shear_modulus = 1; cohesion = 1;"
       "friction = 1; };\n" DAMAGE,
       "x.cfg:4: soil does not break"},
      {"name = \"x\";\n" EOS DAMAGE, "x.cfg:3: 'damage' needs a 'shear_modulus'"},
      {"name = \"x\";\neos = { form = \"ideal\"; gamma = 1.4; };\n" SOLID, "x.cfg:3: a gas has no"},
      {"name = \"x\";\n" EOS SOLID "damage = { form = \"grady_kipp\"; k = 1; m = 16; crack = 3; };",
       "x.cfg:4: 'crack' = 3"},
      {"name = \"x\";\neos = { form = \"isothermal\"; c = 1; source = 5; };", "x.cfg:2: 'source'"},
      {"name = \"x\";\neos = { form = \"tillotson\"; rho0 = 1; A = 1; B = 1; E0 = 1; a = 1; b = 1;"
       "\n alpha = 1; beta = 1; Eiv = 5;\n Ecv = 4; };",
       "x.cfg:4: 'Ecv' must be above 'Eiv'"},
      {"name = \"x\"\n eos {", "x.cfg:2: syntax error"},
  };
  Material m;
  (void)state;
  for (int k = 0; k < N(T); k++) {
    Err err = {""};
    assert_int_equal(material_parse(&m, T[k][0], "x.cfg", &err), -1);
    if (!strstr(err.text, T[k][1])) fail_msg("'%s' lacks '%s' for\n%s", err.text, T[k][1], T[k][0]);
  }
}

/* A number with a dimension is a text with its unit; every group names its source. */
static void check_style(const char *name, const char *text)
{
  static const char *const bare[] = {
      "form",       "source",     "a",         "b",          "alpha",    "beta",
      "rho_min",    "m",          "crack",     "shear",      "friction", "friction_damaged",
      "weak_limit", "weak_alpha", "weak_beta", "weak_gamma", "alpha_0",  "alpha_e",
      "alpha_t",    "n1",         "n2",        "gamma",      "K",        "n",
      "G"};
  config_t cfg;
  Err err;
  assert_int_equal(cfg_open_text(&cfg, text, name, &err), 0);
  for (int g = 1; g < config_setting_length(config_root_setting(&cfg)); g++) {
    config_setting_t *group = config_setting_get_elem(config_root_setting(&cfg), (unsigned)g);
    const char *value;
    assert_true(config_setting_lookup_string(group, "source", &value) && strlen(value) > 10);
    for (int k = 0; k < config_setting_length(group); k++) {
      config_setting_t *s = config_setting_get_elem(group, (unsigned)k);
      int is_bare = 0;
      for (int b = 0; b < N(bare); b++) is_bare |= !strcmp(bare[b], config_setting_name(s));
      if (!is_bare && !(config_setting_type(s) == CONFIG_TYPE_STRING &&
                        strchr(config_setting_get_string(s), ' ')))
        fail_msg("%s: '%s' has no unit", name, config_setting_name(s));
    }
  }
  config_destroy(&cfg);
}

static Material load(const char *name)
{
  MaterialName own;
  Material m;
  Err err;
  char *text = material_find(name, own, &err);
  if (!text) fail_msg("%s", err.text);
  m = parse(text);
  assert_string_equal(own, name);
  check_style(name, text);
  free(text);
  return m;
}

/* Bulk sound speed sqrt(A/rho0) [m/s] and the slope of the shock speed at low pressure that a
 * Tillotson law implies, (1 + B/A + (a+b)/2)/2; both were computed apart from here. */
static void files(void **state)
{
  static const struct {
    const char *name;
    double c0, slope;
  } T[] = {
      {"basalt", 3145, 1.50},         {"ice", 3214, 1.10},           {"ice_lange", 3214, 1.10},
      {"granite", 2592, 1.45},        {"iron", 4051, 1.41},          {"aluminium", 5277, 1.465},
      {"olivine", 6118, 1.16},        {"dunite", 6233, 1.50},        {"lucite", 2926, 1.32},
      {"water", 1478, 3.75},          {"polycarbonate", 2776, 1.25}, {"jsc1a", 3145, 1.50},
      {"granite_collins", 2592, 1.45}};
  MaterialName *names;
  int n;
  (void)state;
  for (int k = 0; k < N(T); k++) {
    Material m = load(T[k].name);
    const struct eos_tillotson *e = &m.eos.tillotson;
    assert_int_equal(m.eos.form, EOS_TILLOTSON);
    assert_true(fabs(sqrt(e->A / e->rho0) - T[k].c0) < 0.51);
    assert_true(fabs((1 + e->B / e->A + (e->a + e->b) / 2) / 2 - T[k].slope) <= 0.00501);
  }
  names = material_names(&n);
  int tillotsons = 0;
  for (int k = 0; k < n; k++) tillotsons += load(names[k]).eos.form == EOS_TILLOTSON;
  assert_int_equal(tillotsons, N(T));
  free(names);
}

/* 001 tables 1 and 2; E = 53.06 GPa (eq. 49). Ice breaks as Benz & Asphaug (1999) have it. */
static void table_1(void **state)
{
  Material b = load("basalt"), i = load("ice"), lange = load("ice_lange");
  const struct eos_tillotson basalt = {2700, 26.7e9, 26.7e9, 487e6, 4.72e6, 18.2e6,
                                       0.5,  1.5,    5,      5,     0,      0};
  const struct eos_tillotson ice = {917, 9.47e9, 9.47e9, 10e6, 0.773e6, 3.04e6,
                                    0.3, 0.1,    10,     5,    0,       0};
  const double *read = &b.eos.tillotson.rho0, *print = &basalt.rho0;
  (void)state;
  for (int k = 0; k < 12; k++) assert_true(fabs(read[k] - print[k]) <= 1e-15 * print[k]);
  read = &i.eos.tillotson.rho0, print = &ice.rho0;
  for (int k = 0; k < 12; k++) assert_true(fabs(read[k] - print[k]) <= 1e-15 * print[k]);
  assert_true(b.mu == 22.7e9 && b.yield.von_mises.Y == 3.5e9 && b.melt == 3.4e6);
  assert_true(i.mu == 2.8e9 && i.yield.von_mises.Y == 1e9 && i.melt == 0.7e6);
  assert_true(b.damage.grady_kipp.k == 1e61 && b.damage.grady_kipp.m == 16);
  assert_true(i.damage.grady_kipp.k == 1.4e38 && i.damage.grady_kipp.m == 9.6);
  assert_true(lange.damage.grady_kipp.k == 1e46 && lange.damage.grady_kipp.m == 9.1);
  assert_true(fabs(material_young(&b) - 53.06e9) < 5e6);
}

static void finding(void **state)
{
  char dir[] = "/tmp/test_material_XXXXXX", path[128]; /* lint: made by mkdtemp */
  MaterialName name;
  char *text;
  Err err;
  FILE *f;
  (void)state;
  assert_non_null(mkdtemp(dir));
  snprintf(path, sizeof path, "%s/own.cfg", dir);
  f = fopen(path, "w");
  fputs("name = \"mine\";\n" EOS, f);
  fclose(f);
  text = material_find(path, name, &err);
  assert_non_null(text);
  assert_string_equal(name, "mine");
  assert_string_equal(text, "name = \"mine\";\n" EOS);
  free(text);
  assert_null(material_find("own", name, &err));
  setenv("BRECCIA_MATERIALS", dir, 1);
  text = material_find("own", name, &err);
  assert_non_null(text);
  free(text);
  assert_null(material_find("/nowhere/x.cfg", name, &err));
  assert_string_equal(err.text, "cannot open '/nowhere/x.cfg': No such file or directory");
  assert_null(material_find(dir, name, &err));
  assert_non_null(strstr(err.text, "Is a directory"));
  assert_null(material_find("", name, &err));
  unlink(path);
  rmdir(dir);
}

/* 42 % pores; 001 has neither of these. */
static void loose_and_collins(void **state)
{
  Material j = load("jsc1a"), g = load("granite_collins"), plain = load("granite");
  PorousPoint at = porosity_eval(&j.porosity, &j.eos, 2700 / 1.72, 0, 0, 1.72);
  (void)state;
  assert_true(fabs(at.e.p) < 1e-3 && fabs(at.e.cs - 950) < 1e-6 && j.weak.limit == 0.85);
  assert_true(porosity_curve(&j.porosity, 1.5e9) == 1 && j.damage.form == DAMAGE_NONE);
  assert_true(g.yield.form == YIELD_COLLINS && g.damage.grady_kipp.shear == 0);
  assert_memory_equal(&g.eos, &plain.eos, sizeof g.eos);
}

static void unknown(void **state)
{
  MaterialName name;
  Err err;
  (void)state;
  assert_null(material_find("bassalt", name, &err));
  assert_string_equal(err.text, "unknown material 'bassalt' (did you mean 'basalt'?)");
  assert_null(material_find("xyzzy", name, &err));
  assert_non_null(strstr(err.text, "known: air, aluminium"));
}

static void of_a_snapshot(void **state)
{
  static char good[] = "name = \"a\";\n" EOS, bad[] = "name = \"b\";\neos = {};";
  PartMaterial list[2] = {{"a", good}, {"a", good}};
  Parts p;
  Material *m;
  Err err;
  (void)state;
  memset(&p, 0, sizeof p);
  p.material = list, p.materials = 2;
  m = material_load(&p, &err);
  assert_true(m && m[1].eos.liquid.c == 1500);
  free(m);
  strcpy(list[1].name, "b");
  list[1].text = bad;
  assert_null(material_load(&p, &err));
  assert_non_null(strstr(err.text, "/Materials/b:2: missing key 'form'"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(units_and_defaults),
      cmocka_unit_test(pores),
      cmocka_unit_test(mistakes),
      cmocka_unit_test(files),
      cmocka_unit_test(table_1),
      cmocka_unit_test(loose_and_collins),
      cmocka_unit_test(unknown),
      cmocka_unit_test(finding),
      cmocka_unit_test(of_a_snapshot),
      cmocka_unit_test_setup_teardown(every_law, folder_setup, folder_teardown),
  };
  setenv("BRECCIA_MATERIALS", "materials", 0);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
