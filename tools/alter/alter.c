/* SPDX-License-Identifier: GPL-3.0-or-later */
/* alter: fields of a snapshot set to expressions of its fields, particles taken out, other
 * snapshots added: initial conditions that no other program knows. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/expr.h"
#include "lib/opt.h"
#include "lib/snap.h"
#include "lib/unit.h"

static struct {
  OptList set, join;
  const char *keep, *out, *time;
} o;

/* clang-format off */
static const Opt OPTS[] = {
  {"join",   'j', OPT_LIST, NULL, "FILE",       "first: the particles of this one too, as bodies of their own", &o.join},
  {"set",    's', OPT_LIST, NULL, "FIELD=EXPR", "then: a field or component; in the order given", &o.set},
  {"keep",   'k', OPT_TEXT, NULL, "EXPR",       "at last: leave out the particles for which this is 0", &o.keep},
  {"time",   't', OPT_TEXT, NULL, "TIME",       "the time of the snapshot", &o.time},
  {"output", 'o', OPT_TEXT, "-",  "FILE",       "where the snapshot goes", &o.out},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "alter", "set fields, take particles out, put snapshots together", "[options] [snapshot.h5] > changed.h5",
  "Expressions are of datasets (Density, Velocities.x), numbers with units, + - * / ^, comparisons, functions (sqrt, exp, sin, "
  "if(condition, a, b) ...), 'ice' for the number of a material. Whole vectors cannot be set, their components can. A bare number "
  "is SI. Ids of joined particles go past those that are there.",
  "mkshape -d 1 --shape rod --size 1m -l water -o rod.h5\n"
  "alter --set 'Velocities.x=1mm/s*sin(6.28*Coordinates.x/1m)' -k 'Coordinates.x > 0' rod.h5 >wave.h5", OPTS, 0, 1};
/* clang-format on */

/* The array that "Velocities.x" stands for: first element, elements from one particle to the next.
 */
typedef struct {
  const PartField *f; /* NULL: an unknown field */
  double *at;
  int step;
  const char *unit;
} Target;

/* The index of component "x", "yz" ... of a field of this width, or -1. */
static int component(const char *word, int width)
{
  static const char *const vector[] = {"x", "y", "z"}, *const tensor[] = {"xx", "xy", "xz",
                                                                          "yy", "yz", "zz"};
  const char *const *words = width == 3 ? vector : width == 6 ? tensor : NULL;
  for (int k = 0; words && word && k < width; k++)
    if (!strcmp(word, words[k])) return k;
  return -1;
}

/* Finds the field of the schema or of the file; one of the schema that is not there is added, one
 * that nothing knows becomes a new scalar of the expression's unit. */
static int target(Target *t, Parts *p, char *name, const char *unit, Err *err)
{
  const char *dot = strrchr(name, '.'), *part = dot ? dot + 1 : NULL;
  int width = 1, k = 0;
  if (dot) name[dot - name] = 0;
  t->f = part_field(name), t->at = NULL, t->step = 1;
  if (t->f && strcmp(t->f->name, name)) t->f = NULL; /* 'u' is not InternalEnergy here */
  if (t->f && !part_array(p, t->f) && part_add(p, t->f->member, err)) return -1;
  if (t->f) width = t->f->width, t->at = part_array(p, t->f), t->unit = t->f->unit;
  for (int e = 0; e < p->extras && !t->f; e++)
    if (!strcmp(p->extra[e].name, name)) {
      if (p->extra[e].size != p->extra[e].width * (int)sizeof(double) || p->extra[e].unit_si != 1)
        return err_set(err, "'%s' is not of doubles in SI: it cannot be set", name);
      width = p->extra[e].width, t->at = (double *)(void *)p->extra[e].data;
      t->unit = p->extra[e].unit;
    }
  if (!t->at && !dot) t->at = part_add_extra(p, name, unit, "set by alter", err), t->unit = unit;
  if (!t->at) return dot ? err_set(err, "no field '%s' to set a component of", name) : -1;
  if (width > 1 || dot) {
    if ((k = component(part, width)) < 0)
      return err_set(err, "'%s' is %s", name,
                     width == 3   ? "a vector: set its .x, .y or .z"
                     : width == 6 ? "a tensor: set its .xx, .xy, .xz, .yy, .yz or .zz"
                                  : "a number: it has no components");
  }
  t->step = width;
  if (!t->f || t->f->kind == 'd') t->at += k;
  return 0;
}

/* Whether a value of unit `from` may go where unit `to` is: bare numbers may anywhere. */
static int fits(const char *from, const char *to)
{
  int a[UNIT_BASES], b[UNIT_BASES];
  double fa, fb;
  if (!strcmp(from, "1") || !strcmp(from, to)) return 1;
  return !unit_powers(from, &fa, a, NULL) && !unit_powers(to, &fb, b, NULL) &&
         !memcmp(a, b, sizeof a);
}

static int whole(Parts *p, const Target *t, const double *value, Err *err)
{
  for (long i = 0; i < p->n; i++) {
    if (!(value[i] >= -9e15 && value[i] <= 9e15) || value[i] != (double)(int64_t)value[i] ||
        (t->f->kind == 'i' && value[i] != (double)(int32_t)value[i]))
      return err_set(err, "'%s' is of whole numbers, not %g", t->f->name, value[i]);
    if (t->f->kind == 'l')
      ((int64_t *)(void *)t->at)[i] = (int64_t)value[i];
    else
      ((int32_t *)(void *)t->at)[i] = (int32_t)value[i];
  }
  return 0;
}

/* "FIELD=EXPR" */
static int set(Parts *p, const char *text, const char *file, Err *err)
{
  const char *equals = strchr(text, '=');
  double *value = malloc((size_t)(p->n ? p->n : 1) * sizeof *value);
  char name[192];
  Target t = {0};
  Expr *e = NULL;
  int bad = 0;
  if (!value) return err_set(err, "no memory for %ld numbers", p->n);
  if (!equals || equals == text || (size_t)(equals - text) >= sizeof name || equals[1] == '=')
    bad = err_set(err, "--set '%s' is not FIELD=EXPR", text);
  if (!bad) {
    memcpy(name, text, (size_t)(equals - text)), name[equals - text] = 0;
    bad = !(e = expr_parse(equals + 1, err)) || expr_bind(e, p, file, err);
  }
  if (!bad) {
    expr_eval(e, value);
    bad = target(&t, p, name, expr_unit(e), err);
  }
  if (!bad && !fits(expr_unit(e), t.unit))
    bad = err_set(err, "--set '%s': %s does not go into %s", text, expr_unit(e), t.unit);
  if (!bad && t.f && t.f->kind != 'd')
    bad = whole(p, &t, value, err);
  else
    for (long i = 0; i < p->n && !bad; i++) t.at[t.step * i] = value[i];
  expr_free(e), free(value);
  return bad ? -1 : 0;
}

/* b behind a: its ids and bodies past those that are there. */
static Parts *join(Parts *a, const char *file, Err *err)
{
  Parts *b = snap_read(file, err), *both;
  int64_t id = 0;
  int32_t body = 0;
  if (!b) return NULL;
  if (part_need(a, "id body", "input", err) || part_need(b, "id body", file, err)) {
    part_free(b);
    return NULL;
  }
  for (long i = 0; i < a->n; i++) {
    id = a->id[i] >= id ? a->id[i] + 1 : id;
    body = a->body[i] >= body ? a->body[i] + 1 : body;
  }
  for (long i = 0; i < b->n; i++) b->id[i] += id, b->body[i] += body;
  both = part_join(a, b, err);
  part_free(b), part_free(a);
  return both;
}

static Parts *keep(Parts *p, const char *file, Err *err)
{
  unsigned char *stays = expr_select(o.keep, p, file, err);
  Parts *left = stays ? part_select(p, stays, err) : NULL;
  free(stays), part_free(p);
  return left;
}

int main(int argc, char **argv)
{
  int n;
  char *line = opt_command_line(argc, argv), **input = opt_parse(&PROGRAM, argc, argv, &n);
  const char *file = n ? input[0] : "-";
  double time = 0;
  Err err;
  if (!o.set.n && !o.join.n && !o.keep && !o.time)
    err_usage("nothing to change: give --set, --keep, --join or --time");
  if (o.time && unit_parse(o.time, "s", &time, &err)) err_usage("--time: %s", err.text);
  Parts *p = snap_read(file, &err);
  if (!p) err_die("%s", err.text);
  for (int k = 0; k < o.join.n; k++)
    if (!(p = join(p, o.join.text[k], &err))) err_die("%s", err.text);
  for (int k = 0; k < o.set.n; k++)
    if (set(p, o.set.text[k], file, &err)) err_die("%s", err.text);
  if (o.keep && !(p = keep(p, file, &err))) err_die("%s", err.text);
  if (o.time) p->time = time;
  if (part_check(p, "the result", &err) || part_history(p, line, &err) ||
      snap_write(p, o.out, 0, &err))
    err_die("%s", err.text);
  part_free(p), free(line), free(o.set.text), free(o.join.text);
  return 0;
}
