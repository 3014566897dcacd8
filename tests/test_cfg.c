/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Configuration files: what is read, and that each mistake is named with file and line. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "lib/cfg.h"

#define N(A) (int)(sizeof(A) / sizeof *(A))

typedef struct {
  double rho0, k;
  int steps, gravity, kernel;
  char name[64];
  double pull[3];
} Run;

static const CfgRow ROWS[] = {
    {"rho0", CFG_REAL, offsetof(Run, rho0), "kg/m^3", NULL, 1, 1e5, "reference density"},
    {"k", CFG_REAL, offsetof(Run, k), "1/m^3", "5e34", 1, 0, "Weibull k"},
    {"steps", CFG_INT, offsetof(Run, steps), NULL, "20k", 1, 1e9, "most steps"},
    {"gravity", CFG_BOOL, offsetof(Run, gravity), NULL, "true", 1, 0, "self-gravity"},
    {"kernel", CFG_CHOICE, offsetof(Run, kernel), "cubic|quintic|wendland", "quintic", 1, 0,
     "kernel"},
    {"name", CFG_TEXT, offsetof(Run, name), NULL, "run", 1, 0, "label"},
    {"pull", CFG_VECTOR, offsetof(Run, pull), "m/s", "1,2km/s,-3", -1e4, 1e4, "a vector"},
};
static const char *const ALSO[] = {"eos"};

static int read_text(const char *text, Run *run, Err *err)
{
  config_t cfg;
  int failed;
  memset(run, 0, sizeof *run);
  if (cfg_open_text(&cfg, text, "a.cfg", err)) return -1;
  failed = cfg_read(config_root_setting(&cfg), ROWS, N(ROWS), run, ALSO, 1, "a.cfg", err);
  config_destroy(&cfg);
  return failed;
}

static Run read_good(const char *text)
{
  Run run;
  Err err;
  if (read_text(text, &run, &err)) fail_msg("%s: %s", text, err.text);
  return run;
}

static void defaults(void **state)
{
  Run run = read_good("rho0 = 2700.0;");
  (void)state;
  assert_true(run.rho0 == 2700 && run.k == 5e34);
  assert_int_equal(run.steps, 20000);
  assert_int_equal(run.gravity, 1);
  assert_int_equal(run.kernel, 1);
  assert_string_equal(run.name, "run");
}

/* Integers (also wide ones) for a float, whole floats for an integer, strings with a unit. */
static void values(void **state)
{
  (void)state;
  assert_true(read_good("rho0 = 2700").rho0 == 2700);
  assert_true(read_good("rho0 = \"2.7 g/cc\"").rho0 == 2700);
  assert_true(read_good("rho0 = 1; k = 90000000000L").k == 9e10);
  assert_true(read_good("rho0 = 1; k = 9e45").k == 9e45);
  assert_true(read_good("rho0 = 1; k = \"2/cm^3\"").k == 2e6);
  assert_int_equal(read_good("rho0 = 1; steps = 1e6").steps, 1000000);
  assert_int_equal(read_good("rho0 = 1; gravity = false").gravity, 0);
  assert_int_equal(read_good("rho0 = 1; kernel = \"wendland\"").kernel, 2);
  assert_string_equal(read_good("rho0 = 1; name = \"Ceres, wet\"; eos = { form = 1; }").name,
                      "Ceres, wet");
}

/* A vector is a list or a text of three quantities; what is printed reads back. */
static void vectors(void **state)
{
  static const double want[3] = {1, 2000, -3};
  Run run = read_good("rho0 = 1");
  char text[128];
  Err err;
  (void)state;
  assert_memory_equal(run.pull, want, sizeof want);
  run = read_good("rho0 = 1; pull = (1, \"2 km/s\", -3.0)");
  assert_memory_equal(run.pull, want, sizeof want);
  run = read_good("rho0 = 1; pull = [1, 2000, -3]");
  assert_memory_equal(run.pull, want, sizeof want);
  assert_string_equal(cfg_text(&ROWS[6], &run, text, sizeof text), "1,2000,-3");
  run.pull[0] = 1. / 3;
  cfg_text(&ROWS[6], &run, text, sizeof text);
  run.pull[0] = 0;
  assert_int_equal(cfg_set(ROWS, N(ROWS), &run, "pull", text, &err), 0);
  assert_true(run.pull[0] == 1. / 3 && run.pull[2] == -3);
}

/* Each mistake, where it is, and what would have been right. */
static void refused(void **state)
{
  static const struct {
    const char *text, *message;
  } T[] = {
      {"\n\nrh0 = 2700.0;", "a.cfg:3: unknown key 'rh0' (did you mean 'rho0'?)"},
      {"rho0 = 1;\nzzz = 1;", "a.cfg:2: unknown key 'zzz'"},
      {"k = 1.0;", "a.cfg: missing key 'rho0' (reference density)"},
      {"rho0 = true;", "a.cfg:1: 'rho0' is not a switch"},
      {"rho0 = [1, 2];", "a.cfg:1: 'rho0' must be a single value"},
      {"rho0 = { a = 1; };", "a.cfg:1: 'rho0' must be a single value"},
      {"rho0 = -1.0;", "a.cfg:1: 'rho0' = -1 is outside 1 .. 100000 kg/m^3"},
      {"rho0 = \"200 t/cc\";", "is outside 1 .. 100000 kg/m^3"},
      {"rho0 = 1e999;", "a.cfg:1: 'rho0' must be finite"},
      {"rho0 = \"5 GPa\";", "a.cfg:1: 'rho0': '5 GPa': wanted a unit like 'kg/m^3', not 'GPa'"},
      {"rho0 = 1.0;\nsteps = 2.5;", "a.cfg:2: 'steps' = 2.5 is not a whole number"},
      {"rho0 = 1.0;\nsteps = 3000000000;",
       "a.cfg:2: 3000000000 is too wide for a whole number (write 3000000000.0)"},
      {"rho0 = 1.0;\ngravity = 1;", "a.cfg:2: 'gravity' must be true or false"},
      {"rho0 = 1.0;\ngravity = \"yes\";", "a.cfg:2: 'gravity' must be true or false, not 'yes'"},
      {"rho0 = 1.0;\nkernel = \"quintik\";",
       "a.cfg:2: 'kernel': unknown word 'quintik' (did you mean 'quintic'?)"},
      {"rho0 = 1.0;\nkernel = 1;", "a.cfg:2: 'kernel' must be a text in quotes"},
      {"rho0 = 1.0;\nname = 5;", "a.cfg:2: 'name' must be a text in quotes"},
      {"rho0 = 1.0;\nname = \"0123456789012345678901234567890123456789012345678901234567890123\";",
       "a.cfg:2: 'name': text longer than 63 characters"},
      {"/* \n3000000000 */ # 3000000000\nname = \"x\\\"\n 3000000000\";\n// 9\nrho0 = 0x80000000;",
       "a.cfg:6: 0x80000000 is too wide"},
      {"rho0 = 1;\nk = 10000000000000000000L;", "a.cfg:2: 10000000000000000000 is too wide"},
      {"rho0 = 1;\npull = [1, 2];", "a.cfg:2: 'pull' must be a list of three numbers"},
      {"rho0 = 1;\npull = (1, 2, true);", "a.cfg:2: 'pull' must be a list of three numbers"},
      {"rho0 = 1;\npull = 3;", "a.cfg:2: 'pull' must be a list of three numbers"},
      {"rho0 = 1;\npull = \"1,2\";", "a.cfg:2: 'pull': '1,2': 3 numbers between commas"},
      {"rho0 = 1;\npull = (1, 2, \"3 kg\");", "a.cfg:2: 'pull': '3 kg': wanted a unit like 'm/s'"},
      {"rho0 = 1;\npull = [1.0, 2.0, 1e5];", "'pull' = 100000 is outside -10000 .. 10000 m/s"},
      {"@include \"other.cfg\"", "a.cfg:1: @include is not supported"},
      {"rho0 = 1.0;\nrho0 = 2.0;", "a.cfg:2: duplicate setting name"},
      {"rho0 = 1.0;\nk = = 2;", "a.cfg:2: syntax error"},
  };
  (void)state;
  for (int k = 0; k < N(T); k++) {
    Run run;
    Err err;
    if (!read_text(T[k].text, &run, &err)) fail_msg("accepted: %s", T[k].text);
    if (!strstr(err.text, T[k].message)) fail_msg("%s: %s", T[k].text, err.text);
    assert_null(strchr(err.text, '\n'));
  }
}

/* A missing key in a sub-group is reported at the group's line. */
static void groups(void **state)
{
  config_t cfg;
  Run run;
  Err err;
  config_setting_t *eos;
  (void)state;
  assert_int_equal(cfg_open_text(&cfg, "a = 1;\neos = {\n k = 2; };", "b.cfg", &err), 0);
  eos = config_lookup(&cfg, "eos");
  assert_int_equal(cfg_read(eos, ROWS, N(ROWS), &run, NULL, 0, "b.cfg", &err), -1);
  assert_string_equal(err.text, "b.cfg:2: missing key 'rho0' (reference density)");
  eos = config_lookup(&cfg, "a");
  assert_int_equal(cfg_read(eos, ROWS, N(ROWS), &run, NULL, 0, "b.cfg", &err), -1);
  assert_string_equal(err.text, "b.cfg:1: 'a' must be a group { ... }");
  config_destroy(&cfg);
}

/* Files: read, not there, a folder, not a text. */
static void files(void **state)
{
  char path[] = "/tmp/test_cfg_XXXXXX", want[256]; /* lint: made by mkstemp */
  config_t cfg;
  Run run;
  Err err;
  int fd = mkstemp(path);
  (void)state;
  assert_true(fd >= 0 && write(fd, "\nrh0 = 1;\n", 10) == 10);
  close(fd);
  assert_int_equal(cfg_open(&cfg, path, &err), 0);
  assert_int_equal(cfg_read(config_root_setting(&cfg), ROWS, N(ROWS), &run, NULL, 0, path, &err),
                   -1);
  snprintf(want, sizeof want, "%s:2: unknown key 'rh0' (did you mean 'rho0'?)", path);
  assert_string_equal(err.text, want);
  config_destroy(&cfg);
  unlink(path);
  assert_int_equal(cfg_open(&cfg, path, &err), -1);
  assert_non_null(strstr(err.text, "No such file or directory"));
  assert_int_equal(cfg_open(&cfg, "/dev/null", &err), 0); /* empty, and right */
  config_destroy(&cfg);
  assert_int_equal(cfg_open(&cfg, "/dev/zero", &err), -1);
  assert_non_null(strstr(err.text, "not a text file"));
  assert_int_equal(cfg_open(&cfg, "/", &err), -1);
  assert_non_null(strstr(err.text, "Is a directory"));
}

/* --set goes through the same checks as the file, and what cfg_text prints reads back to the same
 * bits. */
static void set_and_text(void **state)
{
  Run run = read_good("rho0 = 1");
  Err err;
  char text[64];
  (void)state;
  assert_int_equal(cfg_set(ROWS, N(ROWS), &run, "rho0", "2.7g/cc", &err), 0);
  assert_string_equal(cfg_text(&ROWS[0], &run, text, sizeof text), "2700");
  assert_int_equal(cfg_set(ROWS, N(ROWS), &run, "kernel", "wendland", &err), 0);
  assert_string_equal(cfg_text(&ROWS[4], &run, text, sizeof text), "wendland");
  assert_int_equal(cfg_set(ROWS, N(ROWS), &run, "gravity", "false", &err), 0);
  assert_string_equal(cfg_text(&ROWS[3], &run, text, sizeof text), "false");
  assert_int_equal(cfg_set(ROWS, N(ROWS), &run, "steps", "1e3", &err), 0);
  assert_string_equal(cfg_text(&ROWS[2], &run, text, sizeof text), "1000");
  assert_string_equal(cfg_text(&ROWS[5], &run, text, sizeof text), "run");
  assert_int_equal(cfg_set(ROWS, N(ROWS), &run, "rho", "1", &err), -1);
  assert_string_equal(err.text, "unknown key 'rho' (did you mean 'rho0'?)");
  assert_int_equal(cfg_set(ROWS, N(ROWS), &run, "rho0", "0", &err), -1);
  assert_int_equal(cfg_set(ROWS, N(ROWS), &run, "k", "0.1", &err), 0);
  assert_string_equal(cfg_text(&ROWS[1], &run, text, sizeof text), "0.1");
  for (int k = 1; k < 1000; k++) {
    double x = exp(0.1 * k) / 3;
    run.k = x;
    cfg_text(&ROWS[1], &run, text, sizeof text);
    assert_int_equal(cfg_set(ROWS, N(ROWS), &run, "k", text, &err), 0);
    assert_true(run.k == x);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(defaults),     cmocka_unit_test(values), cmocka_unit_test(vectors),
      cmocka_unit_test(refused),      cmocka_unit_test(groups), cmocka_unit_test(files),
      cmocka_unit_test(set_and_text),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
