/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/unit.h"
#include "notes.h"
#include "sheet.h"

static void add(Sheet *s, const char *name, const char *unit, const char *meaning, const void *data,
                hid_t type, int width)
{
  char kind = H5Tget_class(type) == H5T_FLOAT ? 'f' : H5Tget_sign(type) == H5T_SGN_2 ? 'i' : 'u';
  s->column[s->columns++] =
      (SheetColumn){name, unit, meaning, data, type, width, (int)H5Tget_size(type), kind};
}

/* Numbers that all of the formats have: 4 or 8 bytes, or integers of 1 or 2. */
static int plain(const PartExtra *x)
{
  H5T_class_t class = H5Tget_class((hid_t)x->type);
  size_t size = H5Tget_size((hid_t)x->type);
  return x->rank <= 2 && (class == H5T_FLOAT || class == H5T_INTEGER) &&
         (size == 4 || size == 8 || (class == H5T_INTEGER && size < 4));
}

static void add_all(Sheet *s, const Parts *p)
{
  NotesList lost = {"", 0};
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++)
    if (part_array(p, f))
      add(s, f->name, f->unit, f->meaning, part_array(p, f),
          f->kind == 'd'   ? H5T_NATIVE_DOUBLE
          : f->kind == 'l' ? H5T_NATIVE_INT64
                           : H5T_NATIVE_INT32,
          f->width);
  if (p->nflaw) add(s, "FlawCount", "1", "flaws of the particle", p->nflaw, H5T_NATIVE_INT32, 1);
  for (const PartExtra *x = p->extra; x < p->extra + p->extras; x++)
    if (plain(x))
      add(s, x->name, x->unit, x->meaning, x->data, (hid_t)x->type, x->width);
    else
      notes_add(&lost, x->name);
  notes_end(&lost, "not carried over, no plain numbers");
}

const SheetColumn *sheet_find(const Sheet *s, const char *name)
{
  for (int k = 0; k < s->columns; k++)
    if (!strcmp(s->column[k].name, name)) return s->column + k;
  return NULL;
}

/* Keeps the columns asked for, in the order of the file. */
static int choose(Sheet *s, const OptList *fields, Err *err)
{
  const char **names = malloc(((size_t)s->columns + 1) * sizeof *names);
  if (!names) return err_set(err, "out of memory");
  int rc = 0, kept = 0;
  for (int k = 0; k < s->columns; k++) names[k] = s->column[k].name;
  for (int j = 0; j < fields->n && !rc; j++) {
    if (sheet_find(s, fields->text[j])) continue;
    const char *near = unit_nearest(fields->text[j], names, s->columns);
    rc = err_set(err, "no field '%s'%s%s%s", fields->text[j], near ? " (did you mean '" : "",
                 near ? near : "", near ? "'?)" : "");
  }
  for (int k = 0; k < s->columns && !rc; k++)
    for (int j = 0; j < fields->n; j++)
      if (!strcmp(s->column[k].name, fields->text[j])) {
        s->column[kept++] = s->column[k];
        break;
      }
  if (!rc) s->columns = kept;
  free(names);
  return rc;
}

Sheet *sheet_new(const Parts *p, const OptList *fields, Err *err)
{
  Sheet *s = calloc(1, sizeof *s);
  size_t most = (size_t)part_field_count + (size_t)p->extras + 1;
  if (s) s->column = calloc(most, sizeof *s->column);
  if (s && s->column) {
    add_all(s, p);
    if (!fields || !fields->n || !choose(s, fields, err)) return s;
  } else
    err_set(err, "out of memory");
  sheet_free(s);
  return NULL;
}

void sheet_free(Sheet *s)
{
  if (s) free(s->column);
  free(s);
}

const char *sheet_part(const SheetColumn *c, int k, char *buf, int size)
{
  static const char *const AXES[] = {"x", "y", "z"}, *const PAIRS[] = {"xx", "xy", "xz",
                                                                       "yy", "yz", "zz"};
  if (c->width == 1)
    snprintf(buf, (size_t)size, "%s", c->name);
  else if (c->width == 3 || c->width == 6)
    snprintf(buf, (size_t)size, "%s_%s", c->name, c->width == 3 ? AXES[k] : PAIRS[k]);
  else
    snprintf(buf, (size_t)size, "%s_%d", c->name, k);
  return buf;
}
