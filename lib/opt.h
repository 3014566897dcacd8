/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options of a program in one table: from it come the parser, --help, the man page, the docs and
 * the history entry. GNU long options; `--` ends options; `-` is stdin or stdout; input last. */
#ifndef OPT_H
#define OPT_H

#include <stddef.h>

typedef enum {
  OPT_FLAG,   /* no argument; int */
  OPT_INT,    /* long; accepts 20000, 2e4, 20k, 1M */
  OPT_REAL,   /* double in SI; unit names the kind (see unit.h) */
  OPT_TEXT,   /* const char * */
  OPT_CHOICE, /* const char *; unit lists the words allowed: "hcp|shells|cubic" */
  OPT_LIST    /* OptList; may be given several times */
} OptType;

typedef struct {
  const char **text; /* [n], in the order given */
  int n;
} OptList;

typedef struct {
  const char *name; /* long name without dashes; NULL ends the table */
  char letter;      /* short name or 0 */
  OptType type;
  const char
      *value;       /* default as the user would type it, parsed like user input; NULL: not given */
  const char *unit; /* OPT_REAL: the SI unit; OPT_CHOICE: the words; others: how the argument is
                       shown in --help (or NULL) */
  const char *help; /* one line, lower case, no full stop */
  void *to; /* where the value goes; for NULL defaults it is left alone (so callers preset NAN,
               NULL, -1) */
} Opt;

typedef struct {
  const char *name;    /* "mksphere" */
  const char *does;    /* one line: "build a sphere of particles" */
  const char *usage;   /* "[options] > body.h5" */
  const char *about;   /* a paragraph for --help and the man page, or NULL */
  const char *example; /* a real command line that works, or several separated by newlines */
  const Opt *opts;
  int min_inputs, max_inputs; /* positional arguments allowed; max < 0: any number */
} OptProgram;

/* opt_parse: fills the table's targets. Adds --help and --version (stdout, exit 0), --man (the man
 * page as troff) and --help-md (a docs section). Any mistake is one line and exit 2: unknown option
 * (with the nearest known), missing or surplus argument, bad number, wrong unit, word not in the
 * choice, too few or too many inputs. Returns the positional arguments (NULL-terminated, pointing
 * into argv); *n is their number. Also calls err_program. */
char **opt_parse(const OptProgram *program, int argc, char **argv, int *n);

/* opt_given: whether the option was on the command line (not just its default). */
int opt_given(const OptProgram *program, const char *name);

/* opt_command_line: argv as one line, quoted for the shell where needed (argv[0] without its
 * folder); malloc'ed. For /History. */
char *opt_command_line(int argc, char **argv);

/* OPT_VERSION: "breccia 0.1.0" (from the Makefile's VERSION). */
extern const char *const opt_version;

#endif
