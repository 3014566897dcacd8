/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "adopt.h"
#include "lib/material.h"
#include "lib/unit.h"
#include "notes.h"
#include "swift.h"

static Parts *drop_dead(Parts *p, Err *err)
{
  unsigned char *keep = malloc((size_t)p->n + 1);
  if (!keep) return part_free(p), err_null(err, "out of memory");
  long kept = 0;
  for (long i = 0; i < p->n; i++) {
    keep[i] = !((p->mat && p->mat[i] < 0) || (p->h && p->h[i] <= 0));
    kept += keep[i];
  }
  Parts *alive = p;
  if (kept < p->n) {
    notes_say("not carried over: %ld particles that had been taken out (no material or no size)",
              p->n - kept);
    alive = kept ? part_select(p, keep, err) : err_null(err, "has no particle left");
    if (alive) alive->time = p->time;
    part_free(p);
  }
  free(keep);
  return alive;
}

Parts *adopt_rows(Parts *p, const AdoptOptions *o, Err *err)
{
  for (long i = 0; p->h && i < p->n; i++) p->h[i] *= o->support;
  if (!p->id) {
    if (part_add(p, "id", err)) return part_free(p), NULL;
    for (long i = 0; i < p->n; i++) p->id[i] = i;
  }
  return drop_dead(p, err);
}

static int set_bodies(Parts *p, const AdoptOptions *o, Err *err)
{
  int given = p->body != NULL;
  if (part_add(p, "body", err)) return -1;
  if (o->second_body < 0) {
    if (!given) notes_say("all particles are body 0 (--second-body ID tells bodies apart)");
    return 0;
  }
  for (long i = 0; i < p->n; i++) p->body[i] = p->id[i] >= o->second_body;
  return 0;
}

static int by_number(const void *a, const void *b)
{
  int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return (x > y) - (x < y);
}

/* The numbers that occur, ascending, without repetition; *n of them. */
static int32_t *numbers(const Parts *p, int *n)
{
  int32_t *list = malloc((size_t)p->n * sizeof *list + 1);
  *n = 0;
  if (!list) return NULL;
  for (long i = 0; i < p->n; i++) {
    int k = 0;
    while (k < *n && list[k] != p->mat[i]) k++;
    if (k == *n) list[(*n)++] = p->mat[i];
  }
  qsort(list, (size_t)*n, sizeof *list, by_number);
  return list;
}

/* The name that NUMBER:NAME gives to `number`, or what SWIFT means by it; NULL without either. */
static const char *name_of(int32_t number, const AdoptOptions *o)
{
  for (int k = 0; k < o->material->n; k++) {
    char *end;
    long given = strtol(o->material->text[k], &end, 10);
    if (given == number && *end == ':') return end + 1;
  }
  return o->swift ? swift_material(number) : NULL;
}

/* Every --material must be NUMBER:NAME of a number that occurs. */
static int check_given(const AdoptOptions *o, const int32_t *list, int n, const char *file,
                       Err *err)
{
  for (int k = 0; k < o->material->n; k++) {
    char *end;
    const char *text = o->material->text[k];
    long given = strtol(text, &end, 10);
    if (end == text || *end != ':' || !end[1])
      return err_set(err, "--material: '%s' is not NUMBER:NAME", text);
    int there = 0;
    for (int j = 0; j < n; j++) there |= list[j] == given;
    if (!there) return err_set(err, "--material: '%s' has no material %ld", file, given);
  }
  return 0;
}

static int unnamed(const AdoptOptions *o, const int32_t *list, int n, const char *file, Err *err)
{
  NotesList missing = {"", 0};
  char word[16];
  for (int k = 0; k < n; k++) {
    snprintf(word, sizeof word, "%d", list[k]);
    if (!name_of(list[k], o)) notes_add(&missing, word);
  }
  return err_set(err, "'%s': which material is number %s? say --material NUMBER:NAME", file,
                 missing.text);
}

static int set_materials(Parts *p, const AdoptOptions *o, const char *file, Err *err)
{
  int n, rc = 0;
  if (p->materials && !o->material->n) return 0; /* the file had them */
  int32_t *list = numbers(p, &n);
  int *index = malloc(((size_t)n + 1) * sizeof *index);
  if (!list || !index) rc = err_set(err, "out of memory");
  rc = rc || check_given(o, list, n, file, err);
  for (int k = 0; k < n && !rc; k++)
    if (!name_of(list[k], o)) rc = unnamed(o, list, n, file, err);
  for (int k = 0; k < n && !rc; k++) {
    MaterialName own;
    char *text = material_find(name_of(list[k], o), own, err);
    index[k] = text ? part_add_material(p, own, text, err) : -1;
    rc = index[k] < 0;
    if (!rc) notes_say("material %d is %s", list[k], own);
    free(text);
  }
  for (long i = 0; i < p->n && !rc; i++) {
    int k = 0;
    while (list[k] != p->mat[i]) k++;
    p->mat[i] = index[k];
  }
  free(list);
  free(index);
  return rc ? -1 : 0;
}

int adopt_snapshot(Parts *p, const AdoptOptions *o, const char *file, Err *err)
{
  NotesList absent = {"", 0};
  if (!p->mat && part_add(p, "mat", err)) return -1;
  if (set_bodies(p, o, err) || set_materials(p, o, file, err)) return -1;
  if (!p->m) notes_add(&absent, "Masses");
  if (!p->rho) notes_add(&absent, "Density");
  if (!p->u) notes_add(&absent, "InternalEnergy");
  if (!p->h) notes_add(&absent, "SmoothingLength");
  notes_end(&absent, "absent, and needed by the solver");
  return part_check(p, file, err);
}
