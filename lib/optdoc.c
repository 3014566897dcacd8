/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each format is one pass over the program's rows, then over the standard ones. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include "optdoc.h"

enum {
  WIDTH = 80,
  COLUMN = 32
}; /* of a line of --help, and where its second column begins at most */

const Opt optdoc_standard[] = {
    {"help", 0, OPT_FLAG, NULL, NULL, "print this text and exit", NULL},
    {"version", 0, OPT_FLAG, NULL, NULL, "print the version and exit", NULL},
    {"man", 0, OPT_FLAG, NULL, NULL, "print the man page (read it with: man -l -)", NULL},
    {"help-md", 0, OPT_FLAG, NULL, NULL, "print this text as markdown", NULL},
    {0},
};

static const char QUANTITIES[] =
    "Quantities are SI or carry a unit: 437km, 2000min, 48deg, 2.7g/cc.";
static const char EXITS[] = "0 done, 1 failed, 2 wrong usage, 3 stopped and resumable.";

const char *optdoc_argument(const Opt *o, char *buf, int size)
{
  const char *unit = o->unit;
  switch (o->type) {
  case OPT_FLAG: snprintf(buf, (size_t)size, "%s", ""); break;
  case OPT_REAL: snprintf(buf, (size_t)size, "<%s>", unit && strcmp(unit, "1") ? unit : "x"); break;
  case OPT_INT: snprintf(buf, (size_t)size, "%s", unit ? unit : "<n>"); break;
  default: snprintf(buf, (size_t)size, "%s", unit ? unit : "<text>"); break;
  }
  return buf;
}

static int has_units(const OptProgram *p)
{
  for (const Opt *o = p->opts; o->name; o++)
    if (o->type == OPT_REAL && o->unit && strcmp(o->unit, "1")) return 1;
  return 0;
}

/* The option's help with what its row also says. */
static const char *meaning(const Opt *o, int with_default, char *buf, int size)
{
  int n = snprintf(buf, (size_t)size, "%s", o->help);
  if (o->type == OPT_LIST && n < size)
    n += snprintf(buf + n, (size_t)(size - n), " (may be repeated)");
  if (with_default && o->value && n < size)
    snprintf(buf + n, (size_t)(size - n), " [%s]", o->value);
  return buf;
}

/* Words from `column` on, in lines that begin with `indent` blanks; newlines in the text stay. */
static void wrap(const char *text, int column, int indent)
{
  while (*text) {
    int length = (int)strcspn(text, " \n");
    if (column > indent && column + 1 + length > WIDTH)
      column = printf("\n%*s", indent, "") - 1;
    else if (column > indent && length > 0)
      column += printf(" ");
    column += printf("%.*s", length, text);
    text += length;
    if (*text == '\n') column = printf("\n%*s", text[1] == '\n' ? 0 : indent, "") - 1;
    if (*text) text++;
  }
  putchar('\n');
}

static int spell(const Opt *o, char *buf, int size)
{
  char arg[256], letter[8] = "    ";
  if (o->letter) snprintf(letter, sizeof letter, "-%c, ", o->letter);
  optdoc_argument(o, arg, sizeof arg);
  return snprintf(buf, (size_t)size, "  %s--%s%s%s", letter, o->name, *arg ? " " : "", arg);
}

static int column_of(const Opt *o, int column)
{
  char left[512];
  for (; o->name; o++) {
    int length = spell(o, left, sizeof left) + 2;
    if (length > column && length <= COLUMN) column = length;
  }
  return column;
}

static void help_rows(const Opt *o, int column)
{
  char left[512], right[1024];
  for (; o->name; o++) {
    int length = spell(o, left, sizeof left);
    fputs(left, stdout);
    if (length + 2 > column)
      printf("\n%*s", column, "");
    else
      printf("%*s", column - length, "");
    wrap(meaning(o, 1, right, sizeof right), column, column);
  }
}

/* Each line of the text behind a prefix. */
static void print_lines(const char *prefix, const char *text)
{
  while (*text) {
    int length = (int)strcspn(text, "\n");
    printf("%s%.*s\n", prefix, length, text);
    text += length + (text[length] == '\n');
  }
}

void optdoc_help(const OptProgram *p)
{
  int column = column_of(p->opts, column_of(optdoc_standard, 0));
  printf("Usage: %s %s\n%c%s.\n", p->name, p->usage, toupper((unsigned char)p->does[0]),
         p->does + 1);
  if (p->about) {
    putchar('\n');
    wrap(p->about, 0, 0);
  }
  printf("\nOptions:\n");
  help_rows(p->opts, column);
  help_rows(optdoc_standard, column);
  if (has_units(p)) puts(QUANTITIES);
  printf("\nExample:\n");
  print_lines("  ", p->example);
}

/* troff: backslashes and hyphens escaped, no line that could be taken for a request. */
static void troff(const char *text)
{
  int start = 1;
  for (; *text; text++) {
    if (start && (*text == '.' || *text == '\'')) fputs("\\&", stdout);
    if (*text == '\\')
      fputs("\\e", stdout);
    else if (*text == '-')
      fputs("\\-", stdout);
    else
      putchar(*text);
    start = *text == '\n';
  }
}

static void man_rows(const Opt *o)
{
  char arg[256], text[1024];
  for (; o->name; o++) {
    printf(".TP\n");
    if (o->letter) printf("\\fB\\-%c\\fR, ", o->letter);
    printf("\\fB\\-\\-");
    troff(o->name);
    printf("\\fR");
    if (o->type != OPT_FLAG) printf(" \\fI");
    troff(optdoc_argument(o, arg, sizeof arg));
    printf(o->type != OPT_FLAG ? "\\fR\n" : "\n");
    troff(meaning(o, 1, text, sizeof text));
    putchar('\n');
  }
}

static void man_section(const char *title, const char *text)
{
  printf(".SH %s\n", title);
  troff(text);
  putchar('\n');
}

void optdoc_man(const OptProgram *p)
{
  printf(".TH ");
  for (const char *c = p->name; *c; c++) putchar(toupper((unsigned char)*c));
  printf(" 1 \"\" \"%s\" \"breccia\"\n.SH NAME\n%s \\- ", opt_version, p->name);
  troff(p->does);
  printf("\n.SH SYNOPSIS\n.B %s\n", p->name);
  troff(p->usage);
  putchar('\n');
  man_section("DESCRIPTION", p->about ? p->about : p->does);
  printf(".SH OPTIONS\n");
  man_rows(p->opts);
  man_rows(optdoc_standard);
  if (has_units(p)) printf(".PP\n%s\n", QUANTITIES);
  man_section("EXIT STATUS", EXITS);
  printf(".SH EXAMPLES\n.nf\n");
  troff(p->example);
  printf("\n.fi\n");
}

/* A table cell: a bar would end it. */
static void cell(const char *text)
{
  for (; *text; text++) printf(*text == '|' ? "\\|" : "%c", *text);
}

static void markdown_row(const Opt *o)
{
  char arg[256], text[1024];
  printf("| ");
  if (o->letter) printf("`-%c`, ", o->letter);
  printf("`--%s%s", o->name, o->type == OPT_FLAG ? "" : " ");
  cell(optdoc_argument(o, arg, sizeof arg));
  printf("` | ");
  cell(o->value ? o->value : "");
  printf(" | ");
  cell(meaning(o, 0, text, sizeof text));
  printf(" |\n");
}

void optdoc_markdown(const OptProgram *p)
{
  printf("## %s\n\n%c%s.\n\n```\n%s %s\n```\n\n", p->name, toupper((unsigned char)p->does[0]),
         p->does + 1, p->name, p->usage);
  if (p->about) printf("%s\n\n", p->about);
  printf("| option | default | meaning |\n|---|---|---|\n");
  for (const Opt *o = p->opts; o->name; o++) markdown_row(o);
  printf("\n```sh\n%s\n```\n", p->example);
}
