/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Recursive descent into a tree of nodes in one array, children before parents; the root is the
 * last. Evaluated in blocks of particles. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "choose.h"
#include "column.h"
#include "expr.h"
#include "unit.h"

enum { NODES = 500, DEEPEST = 60, BLOCK = 128, NAME = 128 };

typedef enum { SAME, ROOT2, ROOT3, PLAIN, LOG, ANGLE, RATIO, IF } Rule;
enum {
#define EXPR_ENUM(FUNCTION, ...) CALL_##FUNCTION,
  EXPR_FUNCTIONS(EXPR_ENUM)
#undef EXPR_ENUM
      CALLS
};

#define EXPR_ROW(FUNCTION, ARGUMENTS, RULE, ...) {#FUNCTION, ARGUMENTS, RULE},
static const struct {
  const char *name;
  int arguments;
  Rule rule;
} functions[] = {EXPR_FUNCTIONS(EXPR_ROW)};

typedef enum { NUMBER, FIELD, MATERIAL, CALL, MINUS, NOT, BINARY } What;
typedef enum { OR, AND, EQ, NE, LE, GE, LT, GT, ADD, SUB, MUL, DIV, POW } Operator;
static const struct {
  const char *text;
  int level; /* how tightly it binds */
} operators[] = {{"||", 0}, {"&&", 1}, {"==", 2}, {"!=", 2}, {"<=", 2}, {">=", 2}, {"<", 2},
                 {">", 2},  {"+", 3},  {"-", 3},  {"*", 4},  {"/", 4},  {"^", 5}};
enum { COMPARES = 2, TIGHTEST = 4 };

/* Powers of the base units; `bare` numbers fit to any. */
typedef struct {
  double power[UNIT_BASES];
  int bare;
} Dim;

typedef struct {
  What what;
  int op; /* Operator, or which function */
  int child[3];
  double number;
  char name[NAME], component[8];
  Column column;
  Dim dim;
} Node;

struct Expr {
  char *text;
  Node *node; /* [nodes] */
  int nodes;
  long n; /* particles of what it is bound to */
  char unit[96];
  const char *at; /* while it is parsed */
  int bars, depth;
};

/* ---- parsing ---- */

static int fail(Expr *e, const char *why, Err *err)
{
  if (!*e->at) return err_set(err, "'%s': %s at the end", e->text, why);
  return err_set(err, "'%s': %s at '%.20s'", e->text, why, e->at);
}

static void skip(Expr *e) { e->at += strspn(e->at, " \t\n"); }

static int add(Expr *e, Node node, Err *err)
{
  if (e->nodes == NODES) return err_set(err, "'%.60s...' is too long", e->text);
  e->node[e->nodes] = node;
  return e->nodes++;
}

static int word_length(const char *s)
{
  int n = 0;
  if (isalpha((unsigned char)*s) || *s == '_')
    while (isalnum((unsigned char)s[n]) || s[n] == '_') n++;
  return n;
}

/* How much of `text` continues a unit: a name of one, perhaps with a power. */
static int unit_length(const char *text)
{
  char name[24];
  double factor;
  int power[UNIT_BASES], n = *text == '%' ? 1 : word_length(text);
  if (!n || n >= (int)sizeof name || text[n] == '(') return 0;
  memcpy(name, text, (size_t)n), name[n] = 0;
  if (unit_powers(name, &factor, power, NULL)) return 0;
  if (text[n] == '^' && isdigit((unsigned char)text[n + 1])) n += 2;
  return n;
}

/* 12, 1e3, 3km, 2.7g/cc: factors follow as long as they are units and there is no blank. */
static int number(Expr *e, Err *err)
{
  char unit[80], *end;
  Node node = {.what = NUMBER, .dim = {.bare = 1}};
  double factor;
  int power[UNIT_BASES], n = 0, more;
  node.number = strtod(e->at, &end);
  if (!isfinite(node.number) || (e->at[0] == '0' && tolower((unsigned char)e->at[1]) == 'x'))
    return fail(e, "not a number", err);
  if (*end == '%' || isalpha((unsigned char)*end)) {
    if (!(n = unit_length(end))) {
      e->at = end;
      return fail(e, "an unknown unit", err);
    }
    while ((end[n] == '/' || end[n] == '*') && (more = unit_length(end + n + 1))) n += 1 + more;
    if (n >= (int)sizeof unit) return fail(e, "a unit that is too long", err);
    memcpy(unit, end, (size_t)n), unit[n] = 0;
    if (unit_powers(unit, &factor, power, err)) return -1;
    node.number *= factor, node.dim.bare = 0;
    for (int b = 0; b < UNIT_BASES; b++) node.dim.power[b] = power[b];
  }
  e->at = end + n;
  return add(e, node, err);
}

static int expression(Expr *e, int level, Err *err);

static int call(Expr *e, const char *name, Err *err)
{
  const char *names[CALLS], *near;
  Node node = {.what = CALL};
  for (node.op = 0; node.op < CALLS && strcmp(name, functions[node.op].name); node.op++)
    names[node.op] = functions[node.op].name;
  if (node.op == CALLS) {
    near = unit_nearest(name, names, CALLS);
    return err_set(err, "no function '%s'%s%s%s", name, near ? " (did you mean '" : "",
                   near ? near : "", near ? "'?)" : "");
  }
  int bars = e->bars;
  e->bars = 0, e->at++;
  for (int k = 0; k < functions[node.op].arguments; k++) {
    if (k && *e->at++ != ',')
      return err_set(err, "'%s': '%s' takes %d arguments", e->text, name,
                     functions[node.op].arguments);
    if ((node.child[k] = expression(e, 0, err)) < 0) return -1;
  }
  if (*e->at != ')') return fail(e, "a ')' is missing", err);
  e->at++, e->bars = bars;
  return add(e, node, err);
}

/* A word: function, constant or field with its component. */
static int word(Expr *e, Err *err)
{
  static const struct {
    const char *name;
    double value;
  } constants[] = {{"pi", 3.14159265358979323846}};
  Node node = {.what = FIELD, .dim = {.bare = 1}};
  int n = word_length(e->at), more;
  if (n >= NAME) return fail(e, "a name that is too long", err);
  memcpy(node.name, e->at, (size_t)n);
  e->at += n;
  if (*e->at == '(') return call(e, node.name, err);
  if (!strcmp(node.name, constants[0].name)) node.what = NUMBER, node.number = constants[0].value;
  if (node.what == FIELD && *e->at == '.') {
    if (!(more = word_length(e->at + 1)) || more >= (int)sizeof node.component)
      return fail(e, "a component is missing", err);
    memcpy(node.component, e->at + 1, (size_t)more);
    e->at += 1 + more;
  }
  return add(e, node, err);
}

/* 'material' or `dataset`. */
static int quoted(Expr *e, Err *err)
{
  Node node = {.what = *e->at == '`' ? FIELD : MATERIAL};
  const char *end = strchr(e->at + 1, *e->at);
  if (!end) return fail(e, "a quote does not end", err);
  if (end - e->at > NAME) return fail(e, "a name that is too long", err);
  memcpy(node.name, e->at + 1, (size_t)(end - e->at - 1));
  e->at = end + 1;
  return add(e, node, err);
}

/* What stands in brackets or bars. */
static int enclosed(Expr *e, Err *err)
{
  int bars = e->bars, magnitude = *e->at == '|', inside;
  e->at++, e->bars = magnitude;
  if ((inside = expression(e, 0, err)) < 0) return -1;
  if (*e->at != (magnitude ? '|' : ')'))
    return fail(e, magnitude ? "a '|' is missing" : "a ')' is missing", err);
  e->at++, e->bars = bars;
  if (!magnitude) return inside;
  return add(e, (Node){.what = CALL, .op = CALL_abs, .child = {inside}}, err);
}

/* A value with its signs and powers: -a^b is -(a^b). */
static int value(Expr *e, Err *err)
{
  int base, exponent;
  skip(e);
  if (*e->at == '-' || *e->at == '+' || *e->at == '!') {
    char sign = *e->at++;
    if (++e->depth > DEEPEST) return fail(e, "too deep", err);
    base = value(e, err), e->depth--;
    if (base < 0 || sign == '+') return base;
    return add(e, (Node){.what = sign == '-' ? MINUS : NOT, .child = {base}}, err);
  }
  if (isdigit((unsigned char)*e->at) || *e->at == '.')
    base = number(e, err);
  else if (word_length(e->at))
    base = word(e, err);
  else if (*e->at && strchr("'\"`", *e->at))
    base = quoted(e, err);
  else if (*e->at == '(' || *e->at == '|')
    base = enclosed(e, err);
  else
    return fail(e, "a value is missing", err);
  skip(e);
  if (base < 0 || *e->at != '^') return base;
  e->at++;
  if (++e->depth > DEEPEST) return fail(e, "too deep", err);
  exponent = value(e, err), e->depth--;
  if (exponent < 0) return -1;
  return add(e, (Node){.what = BINARY, .op = POW, .child = {base, exponent}}, err);
}

/* The operator that stands here, of this level, or -1. */
static int operator_at(const Expr *e, int level)
{
  if (e->bars && *e->at == '|') return -1;
  for (int k = 0; k < POW; k++)
    if (operators[k].level == level &&
        !strncmp(e->at, operators[k].text, strlen(operators[k].text)))
      return k;
  return -1;
}

static int expression(Expr *e, int level, Err *err)
{
  if (level > TIGHTEST) return value(e, err);
  if (level == 0 && ++e->depth > DEEPEST) return fail(e, "too deep", err);
  int left = expression(e, level + 1, err), op, again = 0;
  while (left >= 0 && (skip(e), op = operator_at(e, level)) >= 0) {
    if (level == COMPARES && again++)
      return fail(e, "comparisons do not chain (join them with &&)", err);
    e->at += strlen(operators[op].text);
    int right = expression(e, level + 1, err);
    if (right < 0) return -1;
    left = add(e, (Node){.what = BINARY, .op = op, .child = {left, right}}, err);
  }
  if (level == 0) e->depth--;
  return left;
}

Expr *expr_parse(const char *text, Err *err)
{
  Expr *e = calloc(1, sizeof *e);
  if (e) e->text = malloc(strlen(text) + 1), e->node = calloc(NODES, sizeof *e->node);
  if (!e || !e->text || !e->node) {
    expr_free(e);
    return err_null(err, "out of memory");
  }
  e->at = strcpy(e->text, text);
  int root = expression(e, 0, err);
  if (root >= 0 && *e->at) root = fail(e, "an operator is missing", err);
  if (root >= 0) return e;
  expr_free(e);
  return NULL;
}

void expr_free(Expr *e)
{
  if (!e) return;
  for (int k = 0; e->node && k < e->nodes; k++) column_free(&e->node[k].column);
  free(e->node), free(e->text), free(e);
}

int expr_members(const Expr *e, char *members, int size)
{
  int unknown = 0;
  for (int k = 0; k < e->nodes; k++) {
    char key[40], all[2048];
    if (e->node[k].what != FIELD) continue;
    const PartField *f = part_field(e->node[k].name);
    if (!f || strcmp(f->name, e->node[k].name)) {
      unknown = 1;
      continue;
    }
    snprintf(key, sizeof key, " %s ", f->member), snprintf(all, sizeof all, " %s ", members);
    if (strstr(all, key)) continue;
    if (strlen(members) + strlen(key) >= (size_t)size) return -1;
    strcat(strcat(members, " "), f->member);
  }
  return unknown;
}

/* ---- units ---- */

static int plain(const Dim *d)
{
  double sum = 0;
  for (int b = 0; b < UNIT_BASES; b++) sum += fabs(d->power[b]);
  return d->bare || sum == 0;
}

/* The unit in the words of the schema, else by its powers. */
static void describe(const Dim *d, char *text, size_t size)
{
  static const char *const known[] = {"1",   "m",    "s",      "kg",     "K",    "rad",
                                      "m/s", "J/kg", "kg/m^3", "Pa",     "W/kg", "m/s^2",
                                      "1/s", "J",    "W",      "kg*m/s", "N",    "kg/m^2"};
  static const char *const base[] = {"m", "kg", "s", "K", "rad"};
  for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
    double factor, off = 0;
    int power[UNIT_BASES];
    if (unit_powers(known[k], &factor, power, NULL)) continue;
    for (int b = 0; b < UNIT_BASES; b++) off += fabs(d->power[b] - power[b]);
    if (off == 0) {
      snprintf(text, size, "%s", known[k]);
      return;
    }
  }
  int n = 0;
  for (int under = 0; under < 2; under++)
    for (int b = 0; b < UNIT_BASES; b++) {
      double p = under ? -d->power[b] : d->power[b];
      if (p <= 0) continue;
      n += snprintf(text + n, size - (size_t)n, "%s%s",
                    under ? n ? "/" : "1/"
                    : n   ? "*"
                          : "",
                    base[b]);
      if (p != 1) n += snprintf(text + n, size - (size_t)n, "^%.3g", p);
    }
}

static Dim scaled(const Dim *d, double f)
{
  Dim s = *d;
  for (int b = 0; b < UNIT_BASES; b++) s.power[b] *= f;
  return s;
}

/* The unit that a sum or comparison has; -1: they do not fit. */
static int common(const Dim *a, const Dim *b, Dim *to, const Expr *e, Err *err)
{
  char first[96], second[96];
  *to = a->bare ? *b : *a;
  if (a->bare || b->bare || !memcmp(a->power, b->power, sizeof a->power)) return 0;
  describe(a, first, sizeof first), describe(b, second, sizeof second);
  return err_set(err, "'%s': '%s' and '%s' do not go together", e->text, first, second);
}

static int unit_of_call(const Expr *e, Node *node, Err *err)
{
  static const double angle[UNIT_BASES] = {0, 0, 0, 0, 1};
  const Dim *a = &e->node[node->child[0]].dim, *b = &e->node[node->child[1]].dim;
  Dim both;
  int arguments = functions[node->op].arguments;
  if (functions[node->op].rule != IF && arguments == 2 && common(a, b, &both, e, err)) return -1;
  node->dim = (Dim){0};
  switch (functions[node->op].rule) {
  case SAME: node->dim = arguments == 2 ? both : *a; return 0;
  case ROOT2: node->dim = scaled(a, 1. / 2); return 0;
  case ROOT3: node->dim = scaled(a, 1. / 3); return 0;
  case LOG:
  case RATIO: return 0;
  case IF: return common(b, &e->node[node->child[2]].dim, &node->dim, e, err);
  case ANGLE:
    if (!memcmp(a->power, angle, sizeof angle)) return 0; /* fall through */
  case PLAIN: break;
  }
  if (plain(a)) return 0;
  return err_set(err, "'%s': '%s' wants a number without a unit", e->text,
                 functions[node->op].name);
}

/* Whether the value is the same for all particles, and which. */
static int constant(const Expr *e, int k, double *x)
{
  const Node *node = &e->node[k];
  double a = 0, b = 0;
  if (node->what == NUMBER) return *x = node->number, 1;
  if (node->what == MINUS && constant(e, node->child[0], &a)) return *x = -a, 1;
  if (node->what != BINARY || node->op != DIV || !constant(e, node->child[0], &a) ||
      !constant(e, node->child[1], &b))
    return 0;
  return *x = a / b, 1;
}

static int unit_of_binary(const Expr *e, Node *node, Err *err)
{
  const Dim *a = &e->node[node->child[0]].dim, *b = &e->node[node->child[1]].dim;
  double x;
  node->dim = (Dim){0};
  switch ((Operator)node->op) {
  case OR:
  case AND: return 0;
  case ADD:
  case SUB: return common(a, b, &node->dim, e, err);
  case MUL:
  case DIV:
    for (int k = 0; k < UNIT_BASES; k++)
      node->dim.power[k] = a->power[k] + (node->op == MUL ? b->power[k] : -b->power[k]);
    node->dim.bare = a->bare && b->bare;
    return 0;
  case POW:
    if (!plain(b)) return err_set(err, "'%s': an exponent has no unit", e->text);
    if (plain(a)) return node->dim.bare = a->bare, 0;
    if (!constant(e, node->child[1], &x))
      return err_set(err, "'%s': what has a unit takes a number as exponent", e->text);
    return node->dim = scaled(a, x), 0;
  default: break;
  }
  Dim any;
  return common(a, b, &any, e, err);
}

/* Those of children are known. */
static int bind(Expr *e, Node *node, const Parts *p, const char *file, Err *err)
{
  static const char *const words[] = {"ColumnDensity", "pi", NULL};
  double factor;
  int power[UNIT_BASES];
  switch (node->what) {
  case NUMBER: return 0;
  case FIELD:
    column_free(&node->column);
    if (column_get(&node->column, p, node->name, *node->component ? node->component : NULL, words,
                   file, err))
      return -1;
    node->dim = (Dim){.bare = !!unit_powers(node->column.unit, &factor, power, NULL)};
    for (int b = 0; b < UNIT_BASES && !node->dim.bare; b++) node->dim.power[b] = power[b];
    return 0;
  case MATERIAL:
    node->op = choose_material(p, node->name, err);
    return node->number = node->op, node->op < 0 ? -1 : 0;
  case CALL: return unit_of_call(e, node, err);
  case MINUS: return node->dim = e->node[node->child[0]].dim, 0;
  case NOT: return node->dim = (Dim){0}, 0;
  case BINARY: break;
  }
  return unit_of_binary(e, node, err);
}

int expr_bind(Expr *e, const Parts *p, const char *file, Err *err)
{
  const Node *root = &e->node[e->nodes - 1];
  for (int k = 0; k < e->nodes; k++)
    if (bind(e, &e->node[k], p, file, err)) return -1;
  e->n = p->n;
  if (root->what == FIELD)
    snprintf(e->unit, sizeof e->unit, "%s", *root->column.unit ? root->column.unit : "1");
  else
    describe(&root->dim, e->unit, sizeof e->unit);
  return 0;
}

const char *expr_unit(const Expr *e) { return e->unit; }

int expr_kinds(const Expr *e)
{
  const Node *root = &e->node[e->nodes - 1];
  return root->what == FIELD && root->column.kinds;
}

/* ---- evaluation ---- */

#define EACH(VALUE)                                                                                \
  for (int i = 0; i < n; i++) out[i] = (VALUE)
#define EXPR_CASE(FUNCTION, ARGUMENTS, RULE, ...)                                                  \
  case CALL_##FUNCTION:                                                                            \
    for (int i = 0; i < n; i++) out[i] = FUNCTION##_of(x[i], y[i], z[i]);                          \
    return;
#define EXPR_FUNCTION(FUNCTION, ARGUMENTS, RULE, ...)                                              \
  static double FUNCTION##_of(double a, double b, double c)                                        \
  {                                                                                                \
    (void)b, (void)c;                                                                              \
    return __VA_ARGS__;                                                                            \
  }
EXPR_FUNCTIONS(EXPR_FUNCTION)

static void call_of(int op, const double *x, const double *y, const double *z, int n, double *out)
{
  switch (op) {
    EXPR_FUNCTIONS(EXPR_CASE)
  }
}

static void binary_of(int op, const double *a, const double *b, int n, double *out)
{
  switch ((Operator)op) {
  case OR: EACH(a[i] != 0 || b[i] != 0); return;
  case AND: EACH(a[i] != 0 && b[i] != 0); return;
  case EQ: EACH(a[i] == b[i]); return;
  case NE: EACH(a[i] != b[i]); return;
  case LE: EACH(a[i] <= b[i]); return;
  case GE: EACH(a[i] >= b[i]); return;
  case LT: EACH(a[i] < b[i]); return;
  case GT: EACH(a[i] > b[i]); return;
  case ADD: EACH(a[i] + b[i]); return;
  case SUB: EACH(a[i] - b[i]); return;
  case MUL: EACH(a[i] * b[i]); return;
  case DIV: EACH(a[i] / b[i]); return;
  case POW: EACH(b[i] == 2 ? a[i] * a[i] : pow(a[i], b[i])); return;
  }
}

static void evaluate(const Expr *e, int k, long from, int n, double *out)
{
  const Node *node = &e->node[k];
  double x[3][BLOCK];
  int children = node->what == CALL                         ? functions[node->op].arguments
                 : node->what == BINARY                     ? 2
                 : node->what == MINUS || node->what == NOT ? 1
                                                            : 0;
  for (int c = 0; c < 3; c++)
    if (c < children)
      evaluate(e, node->child[c], from, n, x[c]);
    else
      memset(x[c], 0, sizeof x[c]);
  switch (node->what) {
  case NUMBER:
  case MATERIAL: EACH(node->number); return;
  case FIELD: column_read(&node->column, from, n, out); return;
  case CALL: call_of(node->op, x[0], x[1], x[2], n, out); return;
  case MINUS: EACH(-x[0][i]); return;
  case NOT: EACH(x[0][i] == 0); return;
  case BINARY: binary_of(node->op, x[0], x[1], n, out); return;
  }
}

void expr_eval(const Expr *e, double *out)
{
#pragma omp parallel for schedule(static)
  for (long from = 0; from < e->n; from += BLOCK) {
    int n = e->n - from < BLOCK ? (int)(e->n - from) : BLOCK;
    evaluate(e, e->nodes - 1, from, n, out + from);
  }
}

void expr_eval_float(const Expr *e, float *out)
{
#pragma omp parallel for schedule(static)
  for (long from = 0; from < e->n; from += BLOCK) {
    double value[BLOCK];
    int n = e->n - from < BLOCK ? (int)(e->n - from) : BLOCK;
    evaluate(e, e->nodes - 1, from, n, value);
    for (int i = 0; i < n; i++) out[from + i] = (float)value[i];
  }
}

unsigned char *expr_select(const char *text, const Parts *p, const char *file, Err *err)
{
  Expr *e = expr_parse(text, err);
  double *value = malloc((size_t)(p->n + 1) * sizeof *value);
  unsigned char *keep = malloc((size_t)p->n + 1);
  long found = 0;
  int failed = !e || expr_bind(e, p, file, err);
  if (!failed && (!value || !keep)) failed = 1, err_set(err, "out of memory");
  if (!failed) expr_eval(e, value);
  for (long i = 0; i < p->n && !failed; i++) found += keep[i] = value[i] != 0 && !isnan(value[i]);
  if (!failed && !found) failed = 1, err_set(err, "'%s': '%s' holds for no particle", file, text);
  expr_free(e), free(value);
  if (!failed) return keep;
  free(keep);
  return NULL;
}
