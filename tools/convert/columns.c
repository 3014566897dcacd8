/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A row is a list of items, each there or not by the switches; behind FRAGMENTATION's rows stand as
 * many thresholds as the row has flaws. Source: miluphcuda, src/io.cu and `miluphcuda -Y`. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "columns.h"
#include "foreign.h"
#include "lib/spool.h"
#include "lib/unit.h"
#include "miluph.h"
#include "notes.h"

/* X(bit, name, on unless NAME=0) */
#define SWITCHES(X)                                                                                \
  X(DENSITY, "INTEGRATE_DENSITY", 1)                                                               \
  X(ENERGY, "INTEGRATE_ENERGY", 1)                                                                 \
  X(SML, "READ_INITIAL_SML_FROM_PARTICLE_FILE", 1)                                                 \
  X(SOLID, "SOLID", 0)                                                                             \
  X(FRAG, "FRAGMENTATION", 0)                                                                      \
  X(PALPHA, "PALPHA_POROSITY", 0)                                                                  \
  X(EPSALPHA, "EPSALPHA_POROSITY", 0)                                                              \
  X(SIRONO, "SIRONO_POROSITY", 0)                                                                  \
  X(JC, "JC_PLASTICITY", 0)                                                                        \
  X(NS, "NAVIER_STOKES", 0)

#define BIT(NAME, ...) PLACE_##NAME,
enum { SWITCHES(BIT) COUNT };
#undef BIT
#define BIT(NAME, ...) NAME = 1 << PLACE_##NAME,
enum { SWITCHES(BIT) ALWAYS = 1 << COUNT, NEVER = 0, NOT_PALPHA = 2 << COUNT };
#define WORD(NAME, TEXT, ON) TEXT,
static const char *const NAMES[] = {SWITCHES(WORD)};
#define BEGIN(NAME, TEXT, ON) | (ON ? NAME : 0)
static const unsigned USUAL = 0 SWITCHES(BEGIN);

/* width: 0 dimension, -1 its square, else that many; in, out: when an input or output row has it */
typedef struct {
  const char *name, *member;
  int width;
  unsigned in, out;
} Item;

/* clang-format off */
static const Item ITEMS[] = {
  {"x", "x", 0, ALWAYS, ALWAYS}, {"v", "v", 0, ALWAYS, ALWAYS}, {"m", "m", 1, ALWAYS, ALWAYS},
  {"rho", "rho", 1, DENSITY, ALWAYS}, {"e", "u", 1, ENERGY, ENERGY}, {"sml", "h", 1, SML, ALWAYS},
  {"interactions", "nngb", 1, NEVER, ALWAYS}, {"material_type", "mat", 1, ALWAYS, ALWAYS},
  {"ep", "strain", 1, JC, JC}, {"T", "T", 1, JC, JC},
  {"flaws", "nflaw", 1, FRAG, FRAG}, {"active_flaws", "nact", 1, NEVER, FRAG}, {"damage_root", "damage", 1, FRAG, FRAG},
  {"p", "p", 1, NEVER, NOT_PALPHA}, {"local_strain", NULL, 1, NEVER, SOLID}, {"S", "s", -1, SOLID, SOLID},
  {"viscous_stress", NULL, -1, NEVER, NS}, {"sirono", NULL, 9, SIRONO, SIRONO},
  {"alpha", "alpha", 1, PALPHA, PALPHA}, {"p", "p", 1, PALPHA, PALPHA},
  {"alpha", "alpha", 1, EPSALPHA, EPSALPHA}, {"epsilon_v", NULL, 1, EPSALPHA, EPSALPHA}};
/* clang-format on */

enum { ITEM_COUNT = sizeof ITEMS / sizeof *ITEMS, MOST = 64 };

static int width_of(const Item *t, int dimension)
{
  return t->width > 0 ? t->width : t->width ? dimension * dimension : dimension;
}

static int in_row(const Item *t, int kind, unsigned on)
{
  unsigned wanted = kind == COLUMNS_INPUT ? t->in : t->out;
  if (wanted == NOT_PALPHA) return !(on & PALPHA);
  return (wanted & (on | ALWAYS)) != 0;
}

/* The words of `text` into bits. */
static int parse(const char *text, unsigned *on, Err *err)
{
  char word[64];
  for (*on = USUAL; text && *text; text += *text == ',') {
    size_t n = strcspn(text, ",");
    snprintf(word, sizeof word, "%.*s", (int)n, text);
    text += n;
    char *value = strchr(word, '=');
    if (value) *value++ = 0;
    int k = 0;
    while (k < COUNT && strcmp(word, NAMES[k])) k++;
    if (k == COUNT) {
      const char *near = unit_nearest(word, NAMES, COUNT);
      return err_set(err, "--switches: no column depends on '%s'%s%s%s", word,
                     near ? " (did you mean '" : "", near ? near : "", near ? "'?)" : "");
    }
    if (value && strcmp(value, "0") && strcmp(value, "1"))
      return err_set(err, "--switches: %s is 0 or 1, not '%s'", word, value);
    *on = value && *value == '0' ? *on & ~(1u << k) : *on | 1u << k;
  }
  return 0;
}

/* ---- reading ---- */

typedef struct {
  Parts *p;
  int kind, dimension, fixed; /* columns before the thresholds */
  unsigned on;
  const char *path;
  long room; /* rows, flaws that there is memory for */
  int64_t flaw_room;
  Err *err;
} Reader;

static int wrong_columns(const Reader *r, long line, int got, int most)
{
  char names[512] = "";
  for (const Item *t = ITEMS; t < ITEMS + ITEM_COUNT; t++) {
    if (!in_row(t, r->kind, r->on)) continue;
    size_t used = strlen(names);
    int width = width_of(t, r->dimension);
    snprintf(names + used, sizeof names - used, width > 1 ? " %s[%d]" : " %s", t->name, width);
  }
  return err_set(r->err, "'%s':%ld: %d columns, not the %d of%s%s (--switches, --dimension)",
                 r->path, line, got, most, names, r->on & FRAG ? " and the thresholds" : "");
}

static int no_number(const Reader *r, long line, const char *text)
{
  int n = (int)strcspn(text, " \t\r\n");
  return err_set(r->err, "'%s':%ld: not a number: '%.*s'", r->path, line, n, text);
}

static void *grown(void *array, int64_t n, size_t size) { return realloc(array, (size_t)n * size); }

/* Memory for one more row: all the fields of the row, doubled when full. */
static int make_room(Reader *r)
{
  Parts *p = r->p;
  if (p->n < r->room) return 0;
  r->room = r->room ? 2 * r->room : 1024;
  for (const Item *t = ITEMS; t < ITEMS + ITEM_COUNT; t++) {
    const PartField *f = t->member ? part_field(t->member) : NULL;
    if (!f || !in_row(t, r->kind, r->on)) continue;
    void *array = grown(part_array(p, f), r->room, (size_t)f->size);
    if (!array) return err_set(r->err, "out of memory");
    part_set_array(p, f, array);
  }
  if (!(r->on & FRAG)) return 0;
  int32_t *count = grown(p->nflaw, r->room, sizeof *count);
  if (count) p->nflaw = count;
  return count ? 0 : err_set(r->err, "out of memory");
}

/* The numbers of an item of row i. */
static void keep(const Reader *r, const Item *t, const double *x, long i)
{
  const PartField *f = t->member ? part_field(t->member) : NULL;
  Parts *p = r->p;
  if (t->member && !strcmp(t->member, "nflaw")) p->nflaw[i] = (int32_t)*x;
  if (!f) return;
  double *to = f->kind == 'd' ? (double *)part_array(p, f) + i * f->width : NULL;
  if (!to)
    ((int32_t *)part_array(p, f))[i] = (int32_t)*x;
  else if (f->width == 6)
    foreign_tensor(x, r->dimension, to);
  else if (f->width == 3)
    for (int k = 0; k < 3; k++) to[k] = k < r->dimension ? x[k] : 0;
  else
    *to = !strcmp(t->name, "damage_root") ? miluph_damage(*x, r->dimension) : *x;
}

/* The thresholds of row i, which follow the fixed columns. */
static int keep_flaws(Reader *r, const char *text, long i, long line)
{
  Parts *p = r->p;
  int count = 0, wanted = p->nflaw[i];
  for (char *end; *(text += strspn(text, " \t\r\n")); text = end, count++) {
    double x = strtod(text, &end);
    if (end == text) return no_number(r, line, text);
    if (count >= wanted) continue;
    if (p->flaws == r->flaw_room) {
      r->flaw_room = r->flaw_room ? 2 * r->flaw_room : 4096;
      double *flaw = grown(p->flaw, r->flaw_room, sizeof *flaw);
      if (!flaw) return err_set(r->err, "out of memory");
      p->flaw = flaw;
    }
    double *first = p->flaw + p->flaws - count;
    int k = count;
    for (; k > 0 && first[k - 1] > x; k--) first[k] = first[k - 1];
    first[k] = x;
    p->flaws++;
  }
  if (count == wanted) return 0;
  return wrong_columns(r, line, r->fixed + count, r->fixed + wanted);
}

static int read_row(Reader *r, char *text, long line)
{
  double x[MOST];
  int n = 0;
  char *end, *rest = text;
  for (; n < r->fixed && *(rest += strspn(rest, " \t\r\n")); rest = end) {
    x[n] = strtod(rest, &end);
    if (end == rest) return no_number(r, line, rest);
    n++;
  }
  if (!n) return 0;
  rest += strspn(rest, " \t\r\n");
  if (n < r->fixed) return wrong_columns(r, line, n, r->fixed);
  if (make_room(r)) return -1;
  const double *at = x;
  for (const Item *t = ITEMS; t < ITEMS + ITEM_COUNT; t++)
    if (in_row(t, r->kind, r->on)) keep(r, t, at, r->p->n), at += width_of(t, r->dimension);
  long i = r->p->n++;
  if (r->on & FRAG) return keep_flaws(r, rest, i, line);
  for (; *rest; n++) {
    rest += strcspn(rest, " \t\r\n");
    rest += strspn(rest, " \t\r\n");
  }
  return n == r->fixed ? 0 : wrong_columns(r, line, n, r->fixed);
}

static void say_lost(const Reader *r)
{
  NotesList lost = {"", 0};
  for (const Item *t = ITEMS; t < ITEMS + ITEM_COUNT; t++)
    if (!t->member && in_row(t, r->kind, r->on)) notes_add(&lost, t->name);
  notes_end(&lost, "not carried over");
}

Parts *columns_read(const char *path, int kind, int dimension, const char *switches, Err *err)
{
  Reader r = {.kind = kind, .dimension = dimension, .path = path, .err = err};
  if (parse(switches, &r.on, err)) return NULL;
  for (const Item *t = ITEMS; t < ITEMS + ITEM_COUNT; t++)
    if (in_row(t, kind, r.on)) r.fixed += width_of(t, dimension);
  FILE *f = fopen(path, "r");
  if (!f) return err_null(err, "cannot open '%s': %s", path, strerror(errno));
  char *text = NULL;
  size_t size = 0;
  long line = 0;
  int rc = (r.p = part_new(0)) ? 0 : err_set(err, "out of memory");
  while (!rc && getline(&text, &size, f) > 0) rc = read_row(&r, text, ++line);
  if (!rc && ferror(f)) rc = err_set(err, "cannot read '%s': %s", path, strerror(errno));
  if (!rc && !r.p->n) rc = err_set(err, "cannot read '%s': no rows", path);
  if (!rc && (r.on & FRAG) && !r.p->flaw && !(r.p->flaw = calloc(1, sizeof *r.p->flaw)))
    rc = err_set(err, "out of memory");
  free(text);
  fclose(f);
  if (r.p) r.p->dimension = dimension;
  if (!rc) return say_lost(&r), r.p;
  part_free(r.p);
  return NULL;
}

/* ---- writing ---- */

static void write_item(FILE *f, const Parts *p, const Item *t, long i)
{
  const PartField *field = t->member ? part_field(t->member) : NULL;
  const void *array = field ? part_array(p, field) : NULL;
  double x[9] = {!strcmp(t->name, "alpha")};
  if (t->member && !strcmp(t->member, "nflaw"))
    x[0] = p->nflaw ? p->nflaw[i] : 0;
  else if (array && field->kind != 'd')
    x[0] = ((const int32_t *)array)[i];
  else if (array && field->width == 6)
    foreign_full((const double *)array + i * 6, p->dimension, x);
  else if (array)
    memcpy(x, (const double *)array + i * field->width, (size_t)field->width * sizeof *x);
  if (!strcmp(t->name, "damage_root")) x[0] = miluph_root(x[0], p->dimension);
  int whole = t->member && (!field || field->kind != 'd');
  for (int k = 0; k < width_of(t, p->dimension); k++) fprintf(f, whole ? "%.0f " : "%.17g ", x[k]);
}

static void write_rows(FILE *f, const Parts *p, unsigned on)
{
  const double *flaw = p->flaw;
  for (long i = 0; i < p->n; i++) {
    for (const Item *t = ITEMS; t < ITEMS + ITEM_COUNT; t++)
      if (in_row(t, COLUMNS_INPUT, on)) write_item(f, p, t, i);
    for (int k = 0; (on & FRAG) && p->nflaw && k < p->nflaw[i]; k++) fprintf(f, "%.17g ", *flaw++);
    fputc('\n', f);
  }
}

/* What the fields need, and what of them no column holds. */
static unsigned needed(const Parts *p)
{
  unsigned on = USUAL;
  if (p->s) on |= SOLID;
  if (p->nflaw || p->damage) on |= FRAG;
  if (p->alpha) on |= PALPHA;
  if (p->T) on |= JC;
  return on;
}

static void say(const Parts *p, unsigned on)
{
  NotesList switched = {"", 0}, lost = {"", 0};
  for (int k = 0; k < COUNT; k++)
    if (on & 1u << k) notes_add(&switched, NAMES[k]);
  notes_end(&switched, "rows for a miluphcuda compiled with");
  for (int k = 0; k < p->materials; k++)
    notes_say("material_type %d is %s", k, p->material[k].name);
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++) {
    int there = 0;
    for (const Item *t = ITEMS; t < ITEMS + ITEM_COUNT; t++)
      there |= t->member && !strcmp(t->member, f->member) && in_row(t, COLUMNS_INPUT, on);
    if (!there && part_array(p, f)) notes_add(&lost, f->name);
  }
  for (int k = 0; k < p->extras; k++) notes_add(&lost, p->extra[k].name);
  if (p->nflaw && !(on & FRAG)) notes_add(&lost, "FlawThresholds");
  if (p->time != 0) notes_add(&lost, "the time");
  notes_end(&lost, "not carried over");
}

int columns_write(const Parts *p, const char *path, const char *switches, Err *err)
{
  unsigned on;
  Spool s;
  if (parse(switches, &on, err) || part_need(p, "x v m rho u h mat", "input", err)) return -1;
  if (!switches) on = needed(p);
  if (on & SIRONO) return err_set(err, "SIRONO_POROSITY: its nine columns are not known here");
  if (spool_out(&s, path, 0, err)) return -1;
  FILE *f = fopen(s.path, "w");
  spool_opened(&s);
  if (f) write_rows(f, p, on);
  int bad = !f || ferror(f);
  if ((f && fclose(f)) || bad) {
    err_set(err, "cannot write '%s': %s", path, strerror(errno));
    spool_abort(&s);
    return -1;
  }
  say(p, on);
  return spool_commit(&s, err);
}
