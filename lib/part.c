/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles in memory. All that moves particles (select, permute, join) loops over the table of
 * fields; flaws are ragged and go by their starts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <hdf5.h>

#include "part.h"
#include "pointmass.h"
#include "sort.h"

#define KIND(TYPE) _Generic((TYPE)0, double : 'd', int64_t : 'l', int32_t : 'i')
/* clang-format off */
#define ROW(CHECKPOINT, TYPE, MEMBER, WIDTH, NAME, UNIT, MAKER, MEANING) \
  {#MEMBER, NAME, UNIT, MAKER, MEANING, KIND(TYPE), WIDTH, WIDTH * (int)sizeof(TYPE), CHECKPOINT, offsetof(Parts, MEMBER)},
#define SNAPSHOT_ROW(...) ROW(0, __VA_ARGS__)
#define CHECKPOINT_ROW(...) ROW(1, __VA_ARGS__)
/* clang-format on */
const PartField part_fields[] = {FIELDS(SNAPSHOT_ROW) CHECKPOINT_FIELDS(CHECKPOINT_ROW)};
const int part_field_count = sizeof part_fields / sizeof *part_fields;

#define FOR_FIELDS(F)                                                                              \
  for (const PartField *F = part_fields; F < part_fields + part_field_count; F++)

const PartField *part_field(const char *name)
{
  FOR_FIELDS(f)
  if (!strcmp(name, f->member) || !strcmp(name, f->name)) return f;
  return NULL;
}

/* POSIX gives all pointers one representation; memcpy keeps clear of aliasing double * and void *.
 */
void *part_array(const Parts *p, const PartField *f)
{
  void *array;
  memcpy(&array, (const char *)p + f->offset, sizeof array);
  return array;
}

void part_set_array(Parts *p, const PartField *f, void *array)
{
  memcpy((char *)p + f->offset, &array, sizeof array);
}

static int no_memory(Err *err) { return err_set(err, "out of memory"); }

static void *allocate(long n, long size) { return calloc(n > 0 ? (size_t)n : 1, (size_t)size); }

static char *duplicate(const char *s)
{
  size_t size = strlen(s) + 1;
  char *d = malloc(size);
  return d ? memcpy(d, s, size) : NULL;
}

Parts *part_new(long n)
{
  Parts *p = calloc(1, sizeof *p);
  if (p) p->n = n, p->dimension = 3;
  return p;
}

static void free_lines(char **line, int n)
{
  for (int i = 0; i < n; i++) free(line[i]);
  free(line);
}

void part_free(Parts *p)
{
  if (!p) return;
  FOR_FIELDS(f) free(part_array(p, f));
  free(p->nflaw);
  free(p->flaw);
  for (int i = 0; i < p->materials; i++) free(p->material[i].text);
  free(p->material);
  free_lines(p->history, p->histories);
  free_lines(p->parameter, p->parameters);
  free(p->collision);
  free(p->body_info);
  free(p->run);
  free(p->point);
  for (int i = 0; i < p->extras; i++) {
    if (p->extra[i].type > 0) H5Tclose((hid_t)p->extra[i].type);
    free(p->extra[i].data);
  }
  free(p->extra);
  free(p);
}

/* The next blank-separated word of *list into word; 0 at the end. */
static int next_word(const char **list, char word[64])
{
  *list += strspn(*list, " ");
  size_t n = strcspn(*list, " ");
  if (!n) return 0;
  snprintf(word, 64, "%.*s", (int)n, *list);
  *list += n;
  return 1;
}

int part_add(Parts *p, const char *members, Err *err)
{
  char word[64];
  while (next_word(&members, word)) {
    const PartField *f = part_field(word);
    if (!f) return err_set(err, "no such field: '%s'", word);
    if (part_array(p, f)) continue;
    void *array = allocate(p->n, f->size);
    if (!array) return no_memory(err);
    part_set_array(p, f, array);
  }
  return 0;
}

int part_need(const Parts *p, const char *members, const char *file, Err *err)
{
  char word[64];
  while (next_word(&members, word)) {
    const PartField *f = part_field(word);
    int flaws = !strcmp(word, "nflaw");
    if (!f && !flaws) return err_set(err, "no such field: '%s'", word);
    if (flaws ? (void *)p->nflaw : part_array(p, f)) continue;
    return err_set(err, "'%s' lacks field '%s' (made by %s)", file, flaws ? "FlawCount" : f->name,
                   flaws ? "weibull" : f->maker);
  }
  return 0;
}

/* ---- validity ---- */

static int bad(Err *err, const Parts *p, const char *file, long i, const char *name, double value,
               const char *must)
{
  return err_set(err, "'%s': particle %lld: %s is %g, must be %s", file,
                 p->id ? (long long)p->id[i] : (long long)i, name, value, must);
}

static int check_finite(const Parts *p, const char *file, Err *err)
{
  FOR_FIELDS(f)
  {
    const double *a = f->kind == 'd' ? part_array(p, f) : NULL;
    for (long i = 0; a && i < p->n * f->width; i++)
      if (!isfinite(a[i])) return bad(err, p, file, i / f->width, f->name, a[i], "finite");
  }
  return 0;
}

static int check_range(const Parts *p, const char *file, Err *err)
{
  for (long i = 0; i < p->n; i++) {
    if (p->m && !(p->m[i] > 0)) return bad(err, p, file, i, "Masses", p->m[i], "positive");
    if (p->h && !(p->h[i] > 0)) return bad(err, p, file, i, "SmoothingLength", p->h[i], "positive");
    if (p->rho && !(p->rho[i] > 0)) return bad(err, p, file, i, "Density", p->rho[i], "positive");
    if (p->damage && !(p->damage[i] >= 0 && p->damage[i] <= 1))
      return bad(err, p, file, i, "Damage", p->damage[i], "in 0..1");
    if (p->body && p->body[i] < 0)
      return bad(err, p, file, i, "BodyID", p->body[i], "zero or positive");
    if (p->mat && (p->mat[i] < 0 || p->mat[i] >= p->materials))
      return err_set(err, "'%s': particle %lld: MaterialID is %d, but /Materials holds %d", file,
                     p->id ? (long long)p->id[i] : (long long)i, p->mat[i], p->materials);
  }
  return 0;
}

static int check_thresholds(const Parts *p, const char *file, Err *err)
{
  const double *flaw = p->flaw;
  for (long i = 0; p->nflaw && i < p->n; i++)
    for (int j = 0; j < p->nflaw[i]; j++, flaw++) {
      if (!(*flaw > 0 && isfinite(*flaw)))
        return bad(err, p, file, i, "FlawThresholds", *flaw, "positive and finite");
      if (j && *flaw < flaw[-1]) return bad(err, p, file, i, "FlawThresholds", *flaw, "ascending");
    }
  return 0;
}

static int check_flaws(const Parts *p, const char *file, Err *err)
{
  int64_t sum = 0;
  for (long i = 0; i < p->n; i++) {
    int32_t count = p->nflaw ? p->nflaw[i] : 0;
    if (count < 0) return bad(err, p, file, i, "FlawCount", count, "zero or positive");
    if (p->nact && (p->nact[i] < 0 || p->nact[i] > count))
      return bad(err, p, file, i, "ActiveFlaws", p->nact[i], "in 0..FlawCount");
    sum += count;
  }
  if (sum != p->flaws)
    return err_set(err, "'%s': FlawCount does not add up to the %lld rows of FlawThresholds", file,
                   (long long)p->flaws);
  return check_thresholds(p, file, err);
}

/* An id that occurs twice in a and b (may be NULL), into *twice; 1 when there is one, -1 without
 * memory. */
static int repeated_id(const Parts *a, const Parts *b, int64_t *twice)
{
  const long n = a->n + (b ? b->n : 0);
  int64_t *id = allocate(n, sizeof *id);
  long *order = allocate(n, sizeof *order);
  int found = id && order ? 0 : -1;
  if (!found) memcpy(id, a->id, (size_t)a->n * sizeof *id);
  if (!found && b) memcpy(id + a->n, b->id, (size_t)b->n * sizeof *id);
  if (!found) found = sort_ids(n, id, order);
  for (long k = 1; k < n && !found; k++)
    if (id[order[k]] == id[order[k - 1]]) *twice = id[order[k]], found = 1;
  free(id), free(order);
  return found;
}

int part_check(const Parts *p, const char *file, Err *err)
{
  if (p->dimension < 1 || p->dimension > 3)
    return err_set(err, "'%s': Dimension is %d, must be 1, 2 or 3", file, p->dimension);
  if (!isfinite(p->time)) return err_set(err, "'%s': Time is %g", file, p->time);
  if (check_finite(p, file, err) || check_range(p, file, err) || check_flaws(p, file, err))
    return -1;
  int64_t id;
  int found = p->id ? repeated_id(p, NULL, &id) : 0;
  if (found < 0) return no_memory(err);
  if (found) return err_set(err, "'%s': ParticleIDs: %lld occurs twice", file, (long long)id);
  return 0;
}

/* ---- named things ---- */

/* Room for one more element of *array; NULL without memory. The caller counts. */
static void *grow(void *array, int n, size_t size)
{
  return realloc(array, ((size_t)n + 1) * size);
}

static int add_line(char ***line, int *n, const char *text, Err *err)
{
  char **grown = grow(*line, *n, sizeof *grown), *copy = grown ? duplicate(text) : NULL;
  if (grown) *line = grown;
  if (!copy) return no_memory(err);
  grown[(*n)++] = copy;
  return 0;
}

int part_history(Parts *p, const char *command_line, Err *err)
{
  size_t size = strlen(command_line) + sizeof "\t" BRECCIA_VERSION;
  char *text = malloc(size);
  if (!text) return no_memory(err);
  snprintf(text, size, "%s\t%s", command_line, BRECCIA_VERSION);
  int rc = add_line(&p->history, &p->histories, text, err);
  free(text);
  return rc;
}

/* The list of named numbers that a group's name stands for; NULL for another name. */
static PartNumber **numbers(Parts *p, const char *group, int **n)
{
  if (!strcmp(group, "collision")) return *n = &p->collisions, &p->collision;
  if (!strcmp(group, "body")) return *n = &p->body_infos, &p->body_info;
  if (!strcmp(group, "run")) return *n = &p->runs, &p->run;
  return NULL;
}

static PartNumber *find_number(PartNumber *list, int n, const char *name)
{
  for (int i = 0; i < n; i++)
    if (!strcmp(list[i].name, name)) return list + i;
  return NULL;
}

int part_set_number(Parts *p, const char *group, const char *name, double value, Err *err)
{
  int *n;
  PartNumber **list = numbers(p, group, &n);
  if (!list) return err_set(err, "no such group of numbers: '%s'", group);
  if (!*name || strlen(name) >= sizeof(*list)->name)
    return err_set(err, "name of a number is empty or too long: '%s'", name);
  PartNumber *x = find_number(*list, *n, name);
  if (!x) {
    PartNumber *grown = grow(*list, *n, sizeof *grown);
    if (!grown) return no_memory(err);
    *list = grown, x = grown + (*n)++;
    memset(x, 0, sizeof *x);
    strcpy(x->name, name);
  }
  x->value = value;
  return 0;
}

double part_number(const Parts *p, const char *group, const char *name)
{
  int *n;
  Parts shallow = *p; /* numbers() serves the writer too, hence not const */
  PartNumber **list = numbers(&shallow, group, &n);
  PartNumber *x = list ? find_number(*list, *n, name) : NULL;
  return x ? x->value : NAN;
}

int part_add_material(Parts *p, const char *name, const char *text, Err *err)
{
  if (!*name || strlen(name) >= sizeof p->material->name)
    return err_set(err, "name of a material is empty or too long: '%s'", name);
  for (int i = 0; i < p->materials; i++)
    if (!strcmp(p->material[i].name, name) && !strcmp(p->material[i].text, text)) return i;
  PartMaterial *grown = grow(p->material, p->materials, sizeof *grown);
  if (grown) p->material = grown;
  char *copy = grown ? duplicate(text) : NULL;
  if (!copy) return no_memory(err);
  PartMaterial *m = grown + p->materials;
  memset(m, 0, sizeof *m);
  strcpy(m->name, name);
  m->text = copy;
  return p->materials++;
}

/* What has names in b, and its point masses, appended to those of a copy; index[] gets the new
 * numbers of
 * b's materials. */
static int add_names(Parts *p, const Parts *b, int *index, Err *err)
{
  for (int i = 0; i < b->materials; i++) {
    int k = part_add_material(p, b->material[i].name, b->material[i].text, err);
    if (k < 0) return -1;
    if (index) index[i] = k;
  }
  for (int i = 0; i < b->histories; i++)
    if (add_line(&p->history, &p->histories, b->history[i], err)) return -1;
  for (int i = 0; i < b->parameters; i++)
    if (add_line(&p->parameter, &p->parameters, b->parameter[i], err)) return -1;
  for (int i = 0; i < b->collisions; i++)
    if (!find_number(p->collision, p->collisions, b->collision[i].name) &&
        part_set_number(p, "collision", b->collision[i].name, b->collision[i].value, err))
      return -1;
  for (int i = 0; i < b->body_infos; i++)
    if (!find_number(p->body_info, p->body_infos, b->body_info[i].name) &&
        part_set_number(p, "body", b->body_info[i].name, b->body_info[i].value, err))
      return -1;
  return pointmass_append(&p->point, &p->points, b->point, b->points, err);
}

/* ---- moving particles ---- */

static void gather(void *to, const void *from, int size, const long *order, long n)
{
  for (long i = 0; i < n; i++)
    memcpy((char *)to + i * size, (const char *)from + order[i] * size, (size_t)size);
}

int64_t *part_flaw_start(const Parts *p)
{
  int64_t *start = allocate(p->n + 1, sizeof *start);
  for (long i = 0; start && i < p->n; i++) start[i + 1] = start[i] + (p->nflaw ? p->nflaw[i] : 0);
  return start;
}

/* Thresholds of the particles order[], one after the other; returns how many. */
static int64_t gather_flaws(double *to, const Parts *p, const int64_t *start, const long *order,
                            long n)
{
  int64_t k = 0;
  for (long i = 0; i < n; i++) {
    int64_t from = start[order[i]], count = start[order[i] + 1] - from;
    if (to && count) memcpy(to + k, p->flaw + from, (size_t)count * sizeof *to);
    k += count;
  }
  return k;
}

/* A further unknown field like x, with zeroed rows; NULL without memory. */
static PartExtra *add_extra(Parts *p, const PartExtra *x)
{
  PartExtra *grown = grow(p->extra, p->extras, sizeof *grown);
  if (!grown) return NULL;
  p->extra = grown;
  PartExtra *y = grown + p->extras;
  *y = *x;
  y->data = allocate(p->n, x->size);
  y->type = y->data ? H5Tcopy((hid_t)x->type) : -1;
  if (y->type < 0) return free(y->data), NULL;
  p->extras++;
  return y;
}

double *part_add_extra(Parts *p, const char *name, const char *unit, const char *meaning, Err *err)
{
  PartExtra x = {.type = H5T_NATIVE_DOUBLE, .rank = 1, .width = 1, .size = 8, .unit_si = 1};
  PartExtra *y;
  snprintf(x.name, sizeof x.name, "%s", name), snprintf(x.unit, sizeof x.unit, "%s", unit);
  snprintf(x.meaning, sizeof x.meaning, "%s", meaning);
  if (!(y = add_extra(p, &x))) return err_null(err, "out of memory for field '%s'", name);
  return (double *)(void *)y->data;
}

static int select_flaws(Parts *q, const Parts *p, const long *order)
{
  int64_t *start = part_flaw_start(p);
  q->nflaw = allocate(q->n, sizeof *q->nflaw);
  if (start) q->flaws = gather_flaws(NULL, p, start, order, q->n);
  q->flaw = start ? allocate(q->flaws, sizeof *q->flaw) : NULL;
  int ok = q->nflaw && q->flaw;
  if (ok) {
    gather(q->nflaw, p->nflaw, sizeof *p->nflaw, order, q->n);
    gather_flaws(q->flaw, p, start, order, q->n);
  }
  free(start);
  return ok ? 0 : -1;
}

static int select_rows(Parts *q, const Parts *p, const long *order, Err *err)
{
  FOR_FIELDS(f)
  {
    if (!part_array(p, f)) continue;
    if (part_add(q, f->member, err)) return -1;
    gather(part_array(q, f), part_array(p, f), f->size, order, q->n);
  }
  for (int k = 0; k < p->extras; k++) {
    PartExtra *x = add_extra(q, p->extra + k);
    if (!x) return no_memory(err);
    gather(x->data, p->extra[k].data, x->size, order, q->n);
  }
  if (p->nflaw && select_flaws(q, p, order)) return no_memory(err);
  return add_names(q, p, NULL, err);
}

Parts *part_select(const Parts *p, const unsigned char *keep, Err *err)
{
  long n = 0;
  for (long i = 0; i < p->n; i++) n += keep[i] != 0;
  long *order = allocate(n, sizeof *order);
  Parts *q = part_new(n);
  if (!order || !q) {
    free(order);
    part_free(q);
    return err_null(err, "out of memory");
  }
  for (long i = 0, k = 0; i < p->n; i++)
    if (keep[i]) order[k++] = i;
  q->dimension = p->dimension, q->time = p->time;
  int rc = select_rows(q, p, order, err);
  free(order);
  if (rc) part_free(q), q = NULL;
  return q;
}

/* All memory is taken before anything moves, so that a failure leaves p as it was. */
int part_permute(Parts *p, const long *order, Err *err)
{
  size_t n = (size_t)p->n, most = p->nflaw ? (size_t)p->flaws * sizeof *p->flaw : 0;
  FOR_FIELDS(f)
  if (part_array(p, f) && n * (size_t)f->size > most) most = n * (size_t)f->size;
  for (int k = 0; k < p->extras; k++)
    if (n * (size_t)p->extra[k].size > most) most = n * (size_t)p->extra[k].size;
  void *rows = malloc(most + 1);
  int64_t *start = p->nflaw ? part_flaw_start(p) : NULL;
  if (!rows || (p->nflaw && !start)) {
    free(rows);
    free(start);
    return no_memory(err);
  }
  FOR_FIELDS(f)
  {
    if (!part_array(p, f)) continue;
    gather(rows, part_array(p, f), f->size, order, p->n);
    memcpy(part_array(p, f), rows, n * (size_t)f->size);
  }
  for (PartExtra *x = p->extra; x < p->extra + p->extras; x++) {
    gather(rows, x->data, x->size, order, p->n);
    memcpy(x->data, rows, n * (size_t)x->size);
  }
  if (p->nflaw) {
    gather_flaws(rows, p, start, order, p->n);
    memcpy(p->flaw, rows, (size_t)p->flaws * sizeof *p->flaw);
    gather(rows, p->nflaw, sizeof *p->nflaw, order, p->n);
    memcpy(p->nflaw, rows, n * sizeof *p->nflaw);
  }
  free(start);
  free(rows);
  return 0;
}

/* ---- join ---- */

static void append(void *to, const void *a, const void *b, size_t na, size_t nb)
{
  if (a && na) memcpy(to, a, na);
  if (b && nb) memcpy((char *)to + na, b, nb);
}

static const PartExtra *find_extra(const Parts *p, const char *name)
{
  for (int k = 0; k < p->extras; k++)
    if (!strcmp(p->extra[k].name, name)) return p->extra + k;
  return NULL;
}

static int same_kind(const PartExtra *x, const PartExtra *y)
{
  return x->rank == y->rank && !memcmp(x->dim, y->dim, (size_t)(x->rank - 1) * sizeof *x->dim) &&
         H5Tequal((hid_t)x->type, (hid_t)y->type) > 0 && x->unit_si == y->unit_si &&
         !strcmp(x->unit, y->unit);
}

/* n rows of what a particle without the field has: zeros, but a distention of 1. */
static void fill_absent(void *rows, long n, const char *name, hid_t type, int size)
{
  double one[2] = {1, 0}; /* the largest type is twice as long */
  if (strcmp(name, "Distention") || size > (int)sizeof one ||
      H5Tconvert(H5T_NATIVE_DOUBLE, type, 1, one, NULL, H5P_DEFAULT) < 0)
    return;
  for (long i = 0; i < n; i++) memcpy((char *)rows + i * size, one, (size_t)size);
}

static int join_extra(Parts *q, const Parts *a, const Parts *b, const char *name, Err *err)
{
  const PartExtra *x = find_extra(a, name), *y = find_extra(b, name);
  if (x && y && !same_kind(x, y))
    return err_set(err, "field '%s' has another shape, type or unit in the second body", name);
  PartExtra *z = add_extra(q, x ? x : y);
  if (!z) return no_memory(err);
  append(z->data, x ? x->data : NULL, y ? y->data : NULL, (size_t)a->n * (size_t)z->size,
         (size_t)b->n * (size_t)z->size);
  if (!x) fill_absent(z->data, a->n, name, (hid_t)z->type, z->size);
  if (!y) fill_absent(z->data + a->n * z->size, b->n, name, (hid_t)z->type, z->size);
  return 0;
}

static int join_flaws(Parts *q, const Parts *a, const Parts *b)
{
  if (!a->nflaw && !b->nflaw) return 0;
  q->flaws = a->flaws + b->flaws;
  q->nflaw = allocate(q->n, sizeof *q->nflaw);
  q->flaw = allocate(q->flaws, sizeof *q->flaw);
  if (!q->nflaw || !q->flaw) return -1;
  append(q->nflaw, a->nflaw, b->nflaw, (size_t)a->n * sizeof *q->nflaw,
         (size_t)b->n * sizeof *q->nflaw);
  append(q->flaw, a->flaw, b->flaw, (size_t)a->flaws * sizeof *q->flaw,
         (size_t)b->flaws * sizeof *q->flaw);
  return 0;
}

static int join_rows(Parts *q, const Parts *a, const Parts *b, Err *err)
{
  FOR_FIELDS(f)
  {
    if (!part_array(a, f) && !part_array(b, f)) continue;
    if (part_add(q, f->member, err)) return -1;
    append(part_array(q, f), part_array(a, f), part_array(b, f), (size_t)a->n * (size_t)f->size,
           (size_t)b->n * (size_t)f->size);
    char *rows = part_array(q, f);
    if (!part_array(a, f)) fill_absent(rows, a->n, f->name, H5T_NATIVE_DOUBLE, f->size);
    if (!part_array(b, f))
      fill_absent(rows + a->n * f->size, b->n, f->name, H5T_NATIVE_DOUBLE, f->size);
  }
  for (int k = 0; k < a->extras; k++)
    if (join_extra(q, a, b, a->extra[k].name, err)) return -1;
  for (int k = 0; k < b->extras; k++)
    if (!find_extra(a, b->extra[k].name) && join_extra(q, a, b, b->extra[k].name, err)) return -1;
  return join_flaws(q, a, b) ? no_memory(err) : 0;
}

static int join_materials(Parts *q, const Parts *a, const Parts *b, Err *err)
{
  int *index = allocate(b->materials, sizeof *index);
  if (!index) return no_memory(err);
  int rc = add_names(q, a, NULL, err) || add_names(q, b, index, err) ? -1 : 0;
  for (long i = a->n; !rc && b->mat && i < q->n; i++)
    if (q->mat[i] >= 0 && q->mat[i] < b->materials)
      q->mat[i] = index[q->mat[i]];
    else
      rc = err_set(err, "MaterialID %d, but /Materials holds %d", q->mat[i], b->materials);
  free(index);
  return rc;
}

Parts *part_join(const Parts *a, const Parts *b, Err *err)
{
  int64_t id;
  int found = a->id && b->id ? repeated_id(a, b, &id) : 0;
  if (found > 0) return err_null(err, "particle id %lld occurs twice", (long long)id);
  if (a->dimension != b->dimension)
    return err_null(err, "bodies of %d and %d dimensions", a->dimension, b->dimension);
  Parts *q = found < 0 ? NULL : part_new(a->n + b->n);
  if (!q) return err_null(err, "out of memory");
  q->dimension = a->dimension, q->time = a->time;
  if (join_rows(q, a, b, err) || join_materials(q, a, b, err)) part_free(q), q = NULL;
  return q;
}
