/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "hdf.h"
#include "profile.h"
#include "recipe.h"
#include "spool.h"

/* The columns: X(member, column, dataset, unit). */
/* clang-format off */
#define COLUMNS(X) \
  X(r,   "r",   "Radius",         "m")      X(m,  "m",  "Mass",       "kg") \
  X(rho, "rho", "Density",        "kg/m^3") X(p,  "p",  "Pressure",   "Pa") \
  X(u,   "u",   "InternalEnergy", "J/kg")   X(s,  "s",  "Entropy",    "J/K/kg") \
  X(t,   "T",   "Temperature",    "K")      X(g,  "g",  "Gravity",    "m/s^2") \
  X(cs,  "cs",  "SoundSpeed",     "m/s")    X(f,  "f",  "Flattening", "1")
/* clang-format on */
#define AT(MEMBER, ...)                  offsetof(StructureNode, MEMBER),
#define NAME(MEMBER, COLUMN, DATASET, U) DATASET,
#define UNIT(MEMBER, COLUMN, DATASET, U) U,
static const size_t offsets[] = {COLUMNS(AT)};
static const char *const datasets[] = {COLUMNS(NAME)}, *const units[] = {COLUMNS(UNIT)};
enum { COLUMNS_N = sizeof offsets / sizeof *offsets };

static double *cell(StructureNode *n, int column)
{
  return (double *)((char *)n + offsets[column]);
}

/* A layer as recipe_layer reads it. */
static void layer_text(const StructureLayer *l, const char *name, char *out, size_t size)
{
  static const char *const words[] = {"u=%.15gJ/kg", "s=%.15g", "T=%.15gK", "T=continuous"};
  char state[64], law[64] = "";
  snprintf(state, sizeof state, words[l->anchor], l->at);
  if (l->power) snprintf(law, sizeof law, ",power=%.15g", l->exponent);
  snprintf(out, size, "%s:%.15gkg:%s%s", name, l->mass, state, law);
}

static void print(const Structure *s, const StructureBody *body, const char *const *names, FILE *f)
{
  char text[512];
  for (int k = 0; k < s->layers; k++) {
    layer_text(&body->layer[k], names[k], text, sizeof text);
    fprintf(f, "# layer %d: %s\n", k + 1, text);
  }
  fprintf(f, "# outside: %.15g Pa\n", body->outer);
  fprintf(f, "# r[m]\tm[kg]\trho[kg/m^3]\tp[Pa]\tu[J/kg]\ts[J/K/kg]\tT[K]\tg[m/s^2]\tcs[m/s]\tf\t"
             "layer\n");
  for (long i = 0; i < s->n; i++) {
    StructureNode n = s->node[i];
    for (int c = 0; c < COLUMNS_N; c++) fprintf(f, "%.15g\t", *cell(&n, c));
    fprintf(f, "%d\n", n.layer + 1);
  }
}

static int put(hid_t file, const Structure *s, Err *err)
{
  hsize_t n = (hsize_t)s->n;
  double *x = malloc((size_t)s->n * sizeof *x);
  int *layer = malloc((size_t)s->n * sizeof *layer), rc = x && layer ? 0 : -1;
  hid_t set;
  if (rc) err_set(err, "out of memory");
  for (int c = 0; !rc && c <= COLUMNS_N; c++) {
    for (long i = 0; i < s->n; i++)
      if (c < COLUMNS_N)
        x[i] = *cell(&s->node[i], c);
      else
        layer[i] = s->node[i].layer + 1;
    if (c < COLUMNS_N)
      set = hdf_put_rows(file, datasets[c], H5T_NATIVE_DOUBLE, 1, &n, x, err);
    else
      set = hdf_put_rows(file, "Layer", H5T_NATIVE_INT, 1, &n, layer, err);
    rc = set < 0 ? -1 : hdf_put_text(set, "unit", c < COLUMNS_N ? units[c] : "1", err);
    if (set >= 0) H5Dclose(set);
  }
  free(x), free(layer);
  return rc;
}

static int put_layers(hid_t file, const StructureBody *body, const char *const *names,
                      const char *const *texts, Err *err)
{
  char text[STRUCTURE_LAYERS][512], *line[STRUCTURE_LAYERS];
  for (int k = 0; k < body->layers; k++) {
    line[k] = text[k];
    layer_text(&body->layer[k], names[k], text[k], sizeof text[k]);
  }
  return hdf_put_strings(file, "Layers", line, body->layers, err) ||
                 hdf_put_strings(file, "Materials", (char *const *)texts, body->layers, err) ||
                 hdf_put(file, "OuterPressure", H5T_NATIVE_DOUBLE, 0, &body->outer, err)
             ? -1
             : 0;
}

static int is_hdf5(const char *path)
{
  size_t n = strlen(path);
  return n > 3 && !strcmp(path + n - 3, ".h5");
}

int profile_write(const char *path, const Structure *s, const StructureBody *body,
                  const char *const *names, const char *const *texts, Err *err)
{
  Spool out;
  FILE *f;
  int bad;
  if (!strcmp(path, "-")) return print(s, body, names, stdout), 0;
  if (spool_out(&out, path, 0, err)) return -1;
  if (is_hdf5(path)) {
    hid_t file = hdf_create(out.path, err);
    if (file < 0) return spool_abort(&out), -1;
    bad = put(file, s, err) || put_layers(file, body, names, texts, err);
    if (hdf_close(file, bad ? NULL : err) || bad) return spool_abort(&out), -1;
    return spool_commit(&out, err);
  }
  if (!(f = fopen(out.path, "w")))
    return spool_abort(&out), err_set(err, "cannot write '%s': %s", path, strerror(errno));
  print(s, body, names, f);
  bad = ferror(f);
  if (fclose(f) || bad)
    return spool_abort(&out), err_set(err, "cannot write '%s': %s", path, strerror(errno));
  return spool_commit(&out, err);
}

static int add_node(Structure *s, const StructureNode *n, Err *err)
{
  StructureNode *more = s->node;
  if ((s->n & (s->n - 1)) == 0)
    more = realloc(s->node, (size_t)(s->n ? 2 * s->n : 1) * sizeof *more);
  if (!more) return err_set(err, "out of memory");
  s->node = more, s->node[s->n++] = *n;
  return 0;
}

/* A layer's text; its material is found by name, or parsed from `cfg`. */
static int add_layer(Profile *out, const char *text, const char *cfg, Err *err)
{
  static const StructureLayer standard = {0};
  Recipe r = {0};
  char name[256];
  int k = out->body.layers;
  if (k == STRUCTURE_LAYERS) return err_set(err, "more than %d layers", STRUCTURE_LAYERS);
  if (recipe_layer(&r, text, &standard, name, err)) return -1;
  out->body.layer[k] = r.body.layer[0], out->body.layer[k].material = &out->material[k];
  out->body.layers++;
  if (cfg) {
    snprintf(out->name[k], sizeof out->name[k], "%.63s", name);
    out->text[k] = strdup(cfg);
    if (!out->text[k]) return err_set(err, "out of memory");
  } else if (!(out->text[k] = material_find(name, out->name[k], err)))
    return -1;
  return material_parse(&out->material[k], out->text[k], out->name[k], err);
}

static int line_read(Profile *out, char *line, Err *err)
{
  StructureNode n = {0};
  char *at = line, *end;
  line[strcspn(line, "\n")] = 0;
  if (!strncmp(line, "# layer ", 8) && (at = strstr(line, ": ")))
    return add_layer(out, at + 2, NULL, err);
  if (sscanf(line, "# outside: %lf Pa", &out->body.outer) == 1) return 0;
  if (*line == '#' || !*line) return 0;
  for (int c = 0; c < COLUMNS_N; c++, at = end) {
    *cell(&n, c) = strtod(at, &end);
    if (end == at) return err_set(err, "column %d is not a number", c + 1);
  }
  n.layer = (int)strtol(at, &end, 10) - 1;
  if (end == at || *end) return err_set(err, "there are not %d columns", COLUMNS_N + 1);
  return add_node(&out->s, &n, err);
}

static int text_read(Profile *out, const char *path, Err *err)
{
  FILE *f = fopen(path, "r");
  char *line = NULL;
  size_t room = 0;
  int rc = 0;
  Err why;
  if (!f) return err_set(err, "cannot open '%s': %s", path, strerror(errno));
  for (long number = 1; !rc && getline(&line, &room, f) >= 0; number++)
    if ((rc = line_read(out, line, &why))) err_set(err, "%s:%ld: %s", path, number, why.text);
  if (!rc && ferror(f)) rc = err_set(err, "cannot read '%s': %s", path, strerror(errno));
  free(line), fclose(f);
  return rc;
}

static int column(hid_t file, const char *name, hid_t type, long n, void *to, Err *err)
{
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  hsize_t dims[1];
  int rc = set < 0 ? hdf_fail(err, "no dataset '%s'", name) : 0;
  if (!rc && (hdf_shape(set, 1, dims) != 1 || (long)dims[0] != n))
    rc = err_set(err, "dataset '%s' has not %ld rows", name, n);
  if (!rc) rc = hdf_get_rows(set, type, to, err);
  if (set >= 0) H5Dclose(set);
  return rc;
}

static int rows_read(Profile *out, hid_t file, Err *err)
{
  hid_t set = H5Dopen2(file, "Radius", H5P_DEFAULT);
  hsize_t dims[1] = {0};
  long n = set >= 0 && hdf_shape(set, 1, dims) == 1 ? (long)dims[0] : 0;
  double *x = malloc((size_t)(n + 1) * sizeof *x);
  int *layer = malloc((size_t)(n + 1) * sizeof *layer), rc = 0;
  if (set >= 0) H5Dclose(set);
  out->s.node = calloc((size_t)(n + 1), sizeof *out->s.node), out->s.n = n;
  if (!n || !x || !layer || !out->s.node) rc = err_set(err, "it is not a profile");
  for (int c = 0; !rc && c < COLUMNS_N; c++) {
    rc = column(file, datasets[c], H5T_NATIVE_DOUBLE, n, x, err);
    for (long i = 0; !rc && i < n; i++) *cell(&out->s.node[i], c) = x[i];
  }
  if (!rc) rc = column(file, "Layer", H5T_NATIVE_INT, n, layer, err);
  for (long i = 0; !rc && i < n; i++) out->s.node[i].layer = layer[i] - 1;
  free(x), free(layer);
  return rc;
}

static int hdf5_read(Profile *out, const char *path, Err *err)
{
  hid_t file = hdf_open(path, err);
  char **line = NULL, **cfg = NULL;
  int layers = 0, cfgs = 0, rc;
  Err why;
  if (file < 0) return -1;
  rc = rows_read(out, file, &why) || hdf_get_strings(file, "Layers", &line, &layers, &why) ||
       hdf_get_strings(file, "Materials", &cfg, &cfgs, &why) ||
       hdf_get(file, "OuterPressure", H5T_NATIVE_DOUBLE, 1, &out->body.outer, &why) < 0;
  if (!rc && layers != cfgs) rc = err_set(&why, "it has %d layers of %d materials", layers, cfgs);
  for (int k = 0; !rc && k < layers; k++) rc = add_layer(out, line[k], cfg[k], &why) ? -1 : 0;
  for (int k = 0; k < layers; k++) free(line[k]);
  for (int k = 0; k < cfgs; k++) free(cfg[k]);
  free(line), free(cfg), hdf_close(file, NULL);
  return rc ? err_set(err, "'%s': %s", path, why.text) : 0;
}

/* Layers, slopes along them, masses; what cannot be is refused with its row. */
static int digest(Profile *out, Err *err)
{
  Structure *s = &out->s;
  double inside = 0;
  for (long i = 0; i < s->n; i++) {
    StructureNode *n = &s->node[i], *o = n - 1;
    int next = i && n->layer == o->layer + 1;
    if (i ? !next && n->layer != o->layer : n->layer != 0)
      return err_set(err, "row %ld: layer %d is out of order", i + 1, n->layer + 1);
    if (n->layer >= STRUCTURE_LAYERS) return err_set(err, "more than %d layers", STRUCTURE_LAYERS);
    if (!(n->rho > 0 && n->r >= 0 && n->m >= 0 && n->p >= 0 && isfinite(n->u)))
      return err_set(err, "row %ld: not a state (r, m, p >= 0, rho > 0)", i + 1);
    if (i && (next ? n->r != o->r || n->m != o->m : n->r <= o->r || n->m <= o->m || n->p > o->p))
      return err_set(err, "row %ld: %s", i + 1,
                     next ? "r and m must be those of the layer below"
                          : "r and m must rise and p must not");
    if (!i || next) s->first[n->layer] = i;
    s->layers = n->layer + 1, s->first[s->layers] = i + 1;
  }
  if (s->n < 2 || s->node[0].r != 0) return err_set(err, "it does not begin at r = 0");
  for (int k = 0; k < s->layers; k++) {
    if (s->first[k + 1] - s->first[k] < 2) return err_set(err, "layer %d has one row only", k + 1);
    for (long i = s->first[k]; i < s->first[k + 1]; i++) {
      long a = i > s->first[k] ? i - 1 : i, b = i + 1 < s->first[k + 1] ? i + 1 : i;
      double dp = s->node[b].p - s->node[a].p;
      s->node[i].rho_p = dp != 0 ? (s->node[b].rho - s->node[a].rho) / dp : 0;
      s->node[i].u_p = dp != 0 ? (s->node[b].u - s->node[a].u) / dp : 0;
    }
    out->body.layer[k].mass = s->node[s->first[k + 1] - 1].m - inside;
    inside = s->node[s->first[k + 1] - 1].m;
  }
  if (out->body.layers && out->body.layers != s->layers)
    return err_set(err, "it names %d layers and has %d", out->body.layers, s->layers);
  return 0;
}

int profile_read(Profile *out, const char *path, Err *err)
{
  Err why;
  *out = (Profile){.body = {.outer = 0}};
  if ((is_hdf5(path) ? hdf5_read : text_read)(out, path, err)) return profile_free(out), -1;
  if (!digest(out, &why)) return 0;
  profile_free(out);
  return err_set(err, "'%s': %s", path, why.text);
}

void profile_free(Profile *p)
{
  for (int k = 0; k < STRUCTURE_LAYERS; k++) {
    if (p->text[k]) material_clear(&p->material[k]);
    free(p->text[k]), p->text[k] = NULL;
  }
  structure_free(&p->s);
}
