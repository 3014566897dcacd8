/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options and errors, as a user meets them: each case runs in a child whose output and exit code
 * are looked at. */
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmocka.h>
#include "lib/err.h"
#include "lib/opt.h"

#define N(A) (int)(sizeof(A) / sizeof *(A))

enum { WORDS = 16 };

static void demo(int argc, char **argv)
{
  long number = -1;
  double mass = NAN, angle = NAN, factor = NAN;
  const char *lattice = NULL, *output = NULL;
  OptList layer = {0};
  int spin = 0, n;
  const Opt opts[] = {
      {"number", 'n', OPT_INT, "20k", NULL, "particles wanted", &number},
      {"mass", 'm', OPT_REAL, NULL, "kg", "total mass", &mass},
      {"angle", 0, OPT_REAL, "90deg", "rad", "impact angle", &angle},
      {"factor", 0, OPT_REAL, NULL, "1", "a number", &factor},
      {"lattice", 0, OPT_CHOICE, "hcp", "hcp|shells|cubic", "where the particles start", &lattice},
      {"layer", 'l', OPT_LIST, "rock:1", "MATERIAL:FRACTION", "material, from the centre outwards",
       &layer},
      {"spin", 's', OPT_FLAG, NULL, NULL, "let it turn", &spin},
      {"output", 'o', OPT_TEXT, NULL, "FILE", "write to FILE", &output},
      {0},
  };
  const OptProgram program = {
      "demo", "build a thing", "[options] body.h5", "-a \\b 'c'\n.d", "demo -n 5 | less", opts, 1,
      2};
  char **input = opt_parse(&program, argc, argv, &n), *line = opt_command_line(argc, argv);
  if (spin) setvbuf(stdout, NULL, _IONBF, 0);
  printf("n=%ld m=%g angle=%.3f f=%g lattice=%s out=%s spin=%d given=%d%d", number, mass, angle,
         factor, lattice, output ? output : "-", spin, opt_given(&program, "number"),
         opt_given(&program, "angle"));
  for (int k = 0; k < layer.n; k++) printf(" layer=%s", layer.text[k]);
  for (int k = 0; k < n; k++) printf(" in=%s", input[k]);
  printf(" end=%d line=%s\n", input[n] == NULL, line);
  free(line);
  free(layer.text);
  err_close_stdout();
  exit(0);
}

typedef struct {
  char out[16384], err[4096];
  int code;
} Result;

static void slurp(int fd, char *text, size_t size)
{
  size_t n = 0;
  ssize_t got;
  while (n < size - 1 && (got = read(fd, text + n, size - 1 - n)) > 0) n += (size_t)got;
  text[n] = 0;
  close(fd);
}

/* Runs demo on a line of words; stdout goes to the file `to` when one is given. Little output: the
 * pipes never fill. */
static Result run(const char *words, const char *to)
{
  static Result r;
  char copy[512], *argv[WORDS] = {"/usr/bin/demo"}, *save = NULL;
  int argc = 1, out[2], err[2], status;
  snprintf(copy, sizeof copy, "%s", words);
  for (char *w = strtok_r(copy, " ", &save); w; w = strtok_r(NULL, " ", &save)) argv[argc++] = w;
  assert_true(argc < WORDS && !pipe(out) && !pipe(err));
  fflush(NULL);
  pid_t child = fork();
  if (child == 0) {
    dup2(to ? open(to, O_WRONLY) : out[1], STDOUT_FILENO);
    dup2(err[1], STDERR_FILENO);
    demo(argc, argv);
  }
  close(out[1]), close(err[1]);
  slurp(out[0], r.out, sizeof r.out);
  slurp(err[0], r.err, sizeof r.err);
  waitpid(child, &status, 0);
  r.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return r;
}

static void right(const char *words, const char *part)
{
  Result r = run(words, NULL);
  if (r.code || *r.err || !strstr(r.out, part))
    fail_msg("demo %s: %d %s%s", words, r.code, r.out, r.err);
}

static void accepted(void **state)
{
  (void)state;
  right("a.h5", "n=20000 m=nan angle=1.571 f=nan lattice=hcp out=- spin=0 given=00 layer=rock:1 "
                "in=a.h5 end=1");
  right("-n 2e4 a.h5", "n=20000 ");
  right("-n1M --mass 0.5t a.h5", "n=1000000 m=500 ");
  right("--number=7 -m5e20 --angle 60arcmin a.h5 --factor=-2", "n=7 m=5e+20 angle=0.017 f=-2 ");
  right("-n 3 -n 4 a.h5", "n=4 "); /* the last counts */
  right("--numb 5 a.h5", "n=5 ");  /* unique beginnings */
  right("--lattice cubic a.h5", "lattice=cubic ");
  right("-n 20k a.h5", "given=10"); /* given, though it is the default */
  right("-l ice:0.3 a.h5 --layer rock:0.7",
        "given=00 layer=ice:0.3 layer=rock:0.7 in="); /* instead of the default */
  right("-so out.h5 a.h5 -", "out=out.h5 spin=1 given=00 layer=rock:1 in=a.h5 in=- end=1");
  right(
      "-- -n -s",
      "n=20000 m=nan angle=1.571 f=nan lattice=hcp out=- spin=0 given=00 layer=rock:1 in=-n in=-s");
}

/* Exit 2 and one line that begins with the program's name and ends with where to read on. */
static void refused(void **state)
{
  static const struct {
    const char *words, *message;
  } T[] = {
      {"--numbr 5 a", "unknown option '--numbr' (did you mean '--number'?)"},
      {"--xyzzy=3 a", "unknown option '--xyzzy' (see"},
      {"-q a", "unknown option '-q'"},
      {"--l x a", "option '--l' is ambiguous: '--lattice' or '--layer'"},
      {"a --mass", "option '--mass' needs an argument: <kg>"},
      {"a -m", "option '--mass' needs an argument: <kg>"},
      {"a -l", "option '--layer' needs an argument: MATERIAL:FRACTION"},
      {"--spin=3 a", "option '--spin' takes no argument"},
      {"-n 5.5 a", "option '--number': '5.5' is not a whole number"},
      {"-n 1e300 a", "option '--number': '1e300' is too large"},
      {"-n 5q a", "option '--number': '5q' is not a whole number"},
      {"-n x a", "option '--number': 'x' is not a number"},
      {"-m 5s a", "option '--mass': '5s': wanted a unit like 'kg', not 's'"},
      {"-m 5kgg a", "unknown unit 'kgg' (did you mean 'kg'?)"},
      {"--factor 5km a", "option '--factor': '5km': a plain number is wanted"},
      {"--factor inf a", "option '--factor': 'inf' is not a number"},
      {"--lattice hpc a", "option '--lattice': unknown word 'hpc' (did you mean 'hcp'?)"},
      {"", "1 input wanted, 0 given"},
      {"a b c", "surplus argument 'c'"},
  };
  (void)state;
  for (int k = 0; k < N(T); k++) {
    Result r = run(T[k].words, NULL);
    char *newline = strchr(r.err, '\n');
    if (r.code != 2 || !strstr(r.err, T[k].message))
      fail_msg("demo %s: %d %s", T[k].words, r.code, r.err);
    assert_true(!strncmp(r.err, "demo: ", 6) && newline && !newline[1] && !*r.out);
    assert_non_null(strstr(r.err, "(see --help)\n"));
  }
}

static void help(void **state)
{
  Result r = run("--help --xyzzy", NULL);
  int lines = 0;
  (void)state;
  assert_int_equal(r.code, 0);
  assert_string_equal(r.err, "");
  assert_non_null(strstr(r.out, "Usage: demo [options] body.h5\nBuild a thing.\n"));
  assert_non_null(strstr(r.out, "  -n, --number <n>   particles wanted [20k]\n"));
  assert_non_null(strstr(r.out, "      --lattice hcp|shells|cubic\n"));
  for (char *line = strtok(r.out, "\n"); line; line = strtok(NULL, "\n"), lines++) {
    assert_true(strlen(line) <= 80 && line[strlen(line) - 1] != ' ');
    if (!strcmp(line, "Example:")) assert_string_equal(strtok(NULL, "\0"), "  demo -n 5 | less\n");
  }
  assert_true(lines < 40);
  right("--version", "demo (breccia ");
}

/* Every option is in the man page and in the table; what would be a request or an escape is not. */
static void documents(void **state)
{
  static const char *const NAMES[] = {"number",  "mass",  "angle", "factor",
                                      "lattice", "layer", "spin",  "output"};
  Result man = run("--man", NULL), md = run("--help-md", NULL);
  char text[64];
  (void)state;
  assert_int_equal(man.code, 0);
  assert_int_equal(strncmp(man.out, ".TH DEMO 1 ", 11), 0);
  assert_non_null(strstr(man.out, "\\-a \\eb 'c'\n\\&.d\n"));
  assert_non_null(
      strstr(md.out, "| `--lattice hcp\\|shells\\|cubic` | hcp | where the particles start |"));
  assert_non_null(strstr(md.out, "```sh\ndemo -n 5 | less\n```\n"));
  for (int k = 0; k < N(NAMES); k++) {
    snprintf(text, sizeof text, "\\fB\\-\\-%s\\fR", NAMES[k]);
    assert_non_null(strstr(man.out, text));
    snprintf(text, sizeof text, "`--%s", NAMES[k]);
    assert_non_null(strstr(md.out, text));
  }
}

/* Output that is lost is an error, whatever was printed. */
static void full_disk(void **state)
{
  static const char *const LINES[] = {"a.h5", "--help", "--man", "--version"};
  (void)state;
  for (int k = 0; k < N(LINES); k++) {
    Result r = run(LINES[k], "/dev/full");
    assert_int_equal(r.code, 1);
    assert_string_equal(r.err, "demo: cannot write to stdout: No space left on device\n");
  }
  assert_int_equal(run("--spin a.h5", "/dev/full").code, 1); /* lost before the end: unbuffered */
}

/* The history entry, fed to a shell, is the words that were given. */
static void command_line(void **state)
{
  char *argv[] = {
      "/opt/bin/my tool", "plain-1.5,a:b", "", "two words", "it's", "$HOME", "a\\b\"c", "*", NULL};
  char *line = opt_command_line(8, argv), command[512], got[512];
  FILE *shell;
  (void)state;
  assert_int_equal(strncmp(line, "'my tool' plain-1.5,a:b '' ", 27), 0);
  snprintf(command, sizeof command, "printf '[%%s]' %s", line);
  shell = popen(command, "r");
  assert_non_null(shell);
  assert_non_null(fgets(got, sizeof got, shell));
  pclose(shell);
  assert_string_equal(got, "[my tool][plain-1.5,a:b][][two words][it's][$HOME][a\\b\"c][*]");
  free(line);
}

static void errors(void **state)
{
  Err err;
  char name[3 * sizeof err.text];
  (void)state;
  assert_int_equal(err_set(&err, "cannot open '%s'", "a"), -1);
  assert_string_equal(err.text, "cannot open 'a'");
  assert_null(err_null(&err, "%d", 5));
  assert_string_equal(err.text, "5");
  assert_int_equal(err_set(NULL, "nobody listens"), -1);
  memset(name, 'x', sizeof name);
  name[sizeof name - 1] = 0;
  err_set(&err, "%s", name);
  assert_int_equal(strlen(err.text), sizeof err.text - 1); /* cut, not overrun */
  err_program("/usr/bin/clumps");
  assert_string_equal(err_name(), "clumps");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(accepted),     cmocka_unit_test(refused),   cmocka_unit_test(help),
      cmocka_unit_test(documents),    cmocka_unit_test(full_disk), cmocka_unit_test(errors),
      cmocka_unit_test(command_line),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
