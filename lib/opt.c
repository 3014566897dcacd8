/* SPDX-License-Identifier: GPL-3.0-or-later */
/* getopt_long reads the line; the messages are ours. Which options were given is kept for
 * opt_given, set once at start-up. */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "err.h"
#include "opt.h"
#include "optdoc.h"
#include "unit.h"

enum {
  MAX_OPTS = 128,
  LONG_ONLY = 256
}; /* getopt's value of option k is LONG_ONLY + k, or its letter */

const char *const opt_version = "breccia " BRECCIA_VERSION;

static const OptProgram *parsed;
static unsigned char given[MAX_OPTS];

/* The rows that getopt sees: the program's, then the standard ones. */
typedef struct {
  const Opt *row[MAX_OPTS];
  struct option name[MAX_OPTS + 1];
  char letters[2 * MAX_OPTS + 2];
  int n;
} Table;

static int append(OptList *list, const char *text, Err *err)
{
  const char **more = realloc(list->text, (size_t)(list->n + 1) * sizeof *more);
  if (!more) return err_set(err, "out of memory");
  list->text = more;
  list->text[list->n++] = text;
  return 0;
}

static int store(const Opt *o, const char *text, Err *err)
{
  switch (o->type) {
  case OPT_FLAG: *(int *)o->to = 1; return 0;
  case OPT_INT: return unit_count(text, o->to, err);
  case OPT_REAL: return unit_parse(text, o->unit ? o->unit : "1", o->to, err);
  case OPT_CHOICE:
    if (unit_choice(text, o->unit, err) < 0) return -1;
    *(const char **)o->to = text;
    return 0;
  case OPT_TEXT: *(const char **)o->to = text; return 0;
  case OPT_LIST: return append(o->to, text, err);
  }
  return err_set(err, "option without a type");
}

static void add_rows(Table *t, const Opt *o)
{
  char *letter = t->letters + strlen(t->letters);
  for (; o->name; o++, t->n++) {
    int argument = o->type == OPT_FLAG ? no_argument : required_argument;
    if (t->n == MAX_OPTS) err_die("more than %d options", MAX_OPTS);
    t->row[t->n] = o;
    t->name[t->n] = (struct option){o->name, argument, NULL, LONG_ONLY + t->n};
    if (!o->letter) continue;
    *letter++ = o->letter;
    if (argument == required_argument) *letter++ = ':';
  }
}

static int find(const Table *t, int value)
{
  if (value >= LONG_ONLY) return value - LONG_ONLY;
  for (int k = 0; k < t->n; k++)
    if (t->row[k]->letter == value) return k;
  return -1;
}

/* getopt met a long name that is none, or the beginning of several. */
static _Noreturn void wrong_name(const Table *t, const char *word)
{
  const char *names[MAX_OPTS], *near, *first = NULL;
  char name[64];
  snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
  for (int k = 0; k < t->n; k++) {
    names[k] = t->name[k].name;
    if (strncmp(names[k], name, strlen(name))) continue;
    if (first) err_usage("option '--%s' is ambiguous: '--%s' or '--%s'", name, first, names[k]);
    first = names[k];
  }
  near = unit_nearest(name, names, t->n);
  if (near) err_usage("unknown option '--%s' (did you mean '--%s'?)", name, near);
  err_usage("unknown option '--%s'", name);
}

/* What getopt complains about: c is '?' or ':', optopt the option's value, 0 for an unknown long
 * one. */
static _Noreturn void wrong(const Table *t, int c, const char *word)
{
  char argument[256];
  const Opt *o;
  int k = find(t, optopt);
  if (optopt == 0) wrong_name(t, word);
  if (k < 0) err_usage("unknown option '-%c'", optopt);
  o = t->row[k];
  if (c == ':')
    err_usage("option '--%s' needs an argument: %s", o->name,
              optdoc_argument(o, argument, sizeof argument));
  err_usage("option '--%s' takes no argument", o->name);
}

/* The standard options answer and end the program. */
static _Noreturn void answer(const OptProgram *p, const char *name)
{
  if (!strcmp(name, "help"))
    optdoc_help(p);
  else if (!strcmp(name, "man"))
    optdoc_man(p);
  else if (!strcmp(name, "help-md"))
    optdoc_markdown(p);
  else
    printf("%s (%s)\n", p->name, opt_version);
  err_close_stdout();
  exit(0);
}

static void defaults(const OptProgram *p)
{
  Err err;
  for (const Opt *o = p->opts; o->name; o++)
    if (o->value && store(o, o->value, &err)) err_die("default of --%s: %s", o->name, err.text);
}

static void check_inputs(const OptProgram *p, char **inputs, int n)
{
  if (n < p->min_inputs)
    err_usage("%d input%s wanted, %d given", p->min_inputs, p->min_inputs > 1 ? "s" : "", n);
  if (p->max_inputs >= 0 && n > p->max_inputs)
    err_usage("surplus argument '%s'", inputs[p->max_inputs]);
}

char **opt_parse(const OptProgram *program, int argc, char **argv, int *n)
{
  Table t = {.letters = ":"};
  Err err;
  int c;
  err_program(program->name);
  add_rows(&t, program->opts);
  add_rows(&t, optdoc_standard);
  parsed = program;
  defaults(program);
  opterr = 0;
  while ((c = getopt_long(argc, argv, t.letters, t.name, NULL)) != -1) {
    int k = find(&t, c);
    if (c == '?' || c == ':') wrong(&t, c, argv[optind - 1]);
    if (!t.row[k]->to) answer(program, t.row[k]->name);
    if (t.row[k]->type == OPT_LIST && !given[k]) ((OptList *)t.row[k]->to)->n = 0; /* the default */
    given[k] = 1;
    if (store(t.row[k], optarg, &err)) err_usage("option '--%s': %s", t.row[k]->name, err.text);
  }
  *n = argc - optind;
  check_inputs(program, argv + optind, *n);
  return argv + optind;
}

int opt_given(const OptProgram *program, const char *name)
{
  for (int k = 0; program == parsed && program->opts[k].name; k++)
    if (!strcmp(program->opts[k].name, name)) return given[k];
  return 0;
}

/* A word as the shell must see it. */
static void quote(FILE *to, const char *word)
{
  static const char SAFE[] =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (*word && !word[strspn(word, SAFE)]) {
    fputs(word, to);
    return;
  }
  putc('\'', to);
  for (; *word; word++)
    if (*word == '\'')
      fputs("'\\''", to);
    else
      putc(*word, to);
  putc('\'', to);
}

char *opt_command_line(int argc, char **argv)
{
  const char *slash = strrchr(argv[0], '/');
  char *line = NULL;
  size_t size;
  FILE *to = open_memstream(&line, &size);
  if (!to) return NULL;
  quote(to, slash ? slash + 1 : argv[0]);
  for (int k = 1; k < argc; k++) {
    putc(' ', to);
    quote(to, argv[k]);
  }
  if (fclose(to)) {
    free(line);
    return NULL;
  }
  return line;
}
