/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of a law become a table of CfgRows here. A law's struct is its rows as doubles, in
 * order, so row k lies k doubles behind the struct's start. */
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "cfg.h"
#include "material.h"
#include "spool.h"
#include "tabfile.h"
#include "unit.h"

enum { MAX_ROWS = 32, MAX_PATH = 4096 };

typedef struct {
  const CfgRow *rows;
  int n;
} Law;

#define N(ARRAY) (int)(sizeof(ARRAY) / sizeof *(ARRAY))
#define ROW(MEMBER, UNIT, VALUE, MIN, MAX, MEANING)                                                \
  {#MEMBER, CFG_REAL, 0, UNIT, VALUE, MIN, MAX, MEANING},

#define EOS_ROW_TABLE(CAPITAL, NAME)                                                               \
  static const CfgRow eos_rows_##NAME[] = {EOS_##CAPITAL##_ROWS(ROW)};
#define EOS_ENTRY(CAPITAL, NAME) {eos_rows_##NAME, N(eos_rows_##NAME)},
#define YIELD_ROW_TABLE(CAPITAL, NAME)                                                             \
  static const CfgRow yield_rows_##NAME[] = {YIELD_##CAPITAL##_ROWS(ROW)};
#define YIELD_ENTRY(CAPITAL, NAME) {yield_rows_##NAME, N(yield_rows_##NAME)},
#define DAMAGE_ROW_TABLE(CAPITAL, NAME)                                                            \
  static const CfgRow damage_rows_##NAME[] = {DAMAGE_##CAPITAL##_ROWS(ROW)};
#define DAMAGE_ENTRY(CAPITAL, NAME) {damage_rows_##NAME, N(damage_rows_##NAME)},

EOS_LAWS(EOS_ROW_TABLE)
YIELD_LAWS(YIELD_ROW_TABLE)
DAMAGE_LAWS(DAMAGE_ROW_TABLE)

static const Law EOS[] = {EOS_LAWS(EOS_ENTRY)};
static const Law YIELD[] = {{NULL, 0}, YIELD_LAWS(YIELD_ENTRY)};
static const Law DAMAGE[] = {{NULL, 0}, DAMAGE_LAWS(DAMAGE_ENTRY)};

#define POROSITY_ROW_TABLE(CAPITAL, NAME)                                                          \
  static const CfgRow porosity_rows_##NAME[] = {POROSITY_##CAPITAL##_ROWS(ROW)};
#define POROSITY_ENTRY(CAPITAL, NAME) {porosity_rows_##NAME, N(porosity_rows_##NAME)},
POROSITY_LAWS(POROSITY_ROW_TABLE)
static const Law POROSITY[] = {{NULL, 0}, POROSITY_LAWS(POROSITY_ENTRY)};

#define OWN_ROW(KEY, MEMBER, UNIT, VALUE, MIN, MAX, MEANING)                                       \
  {#KEY, CFG_REAL, offsetof(Material, MEMBER), UNIT, VALUE, MIN, MAX, MEANING},
static const CfgRow EOS_OWN[] = {MATERIAL_EOS_ROWS(OWN_ROW)};
static const CfgRow PORES[] = {MATERIAL_POROSITY_ROWS(OWN_ROW)};
static const CfgRow STRENGTH[] = {MATERIAL_STRENGTH_ROWS(OWN_ROW)};

/* A group of the file: its name, the words of `form`, the laws, where form and parameters go. */
typedef struct {
  const char *name, *words;
  const Law *laws;
  size_t form, parameters;
  const CfgRow *own;
  int nown;
} Group;

/* The form alone, so that the keys that are allowed beside it are known. */
static int form_read(const config_setting_t *group, const Group *part, Material *m,
                     const char *label, Err *err)
{
  CfgRow row = {"form", CFG_CHOICE, part->form, part->words, NULL, 0, 0, "the law"};
  int n = config_setting_is_group(group) ? config_setting_length(group) : 0, failed;
  const char **names = malloc((size_t)(n + 1) * sizeof *names);
  if (!names) return err_set(err, "no memory for %d keys", n);
  for (int k = 0; k < n; k++)
    names[k] = config_setting_name(config_setting_get_elem(group, (unsigned)k));
  failed = cfg_read(group, &row, 1, m, names, n, label, err);
  free(names);
  return failed;
}

static int source_check(const config_setting_t *group, const char *label, Err *err)
{
  const config_setting_t *s = config_setting_get_member(group, "source");
  if (!s || config_setting_type(s) == CONFIG_TYPE_STRING) return 0;
  return cfg_where(err, s, label, "'source' must be a text in quotes");
}

static int part_read(const config_setting_t *group, const Group *part, Material *m,
                     const char *label, Err *err)
{
  static const char *const also[] = {"form", "source", "file"};
  CfgRow rows[MAX_ROWS];
  const Law *law;
  int n = 0, table;
  if (form_read(group, part, m, label, err) || source_check(group, label, err)) return -1;
  law = &part->laws[*(int *)((char *)m + part->form)];
  for (int k = 0; k < part->nown; k++) rows[n++] = part->own[k];
  for (int k = 0; k < law->n; k++) {
    rows[n] = law->rows[k];
    rows[n++].offset = part->parameters + (size_t)k * sizeof(double);
  }
  table = !strcmp(part->name, "eos") && m->eos.form == EOS_TABLE;
  return cfg_read(group, rows, n, m, also, N(also) - !table, label, err);
}

/* The k-th folder to look into, "" when there is none of that kind; 0 behind the last. */
static int folder(int k, char path[MAX_PATH / 2])
{
  static const char *const beside[] = {"../materials", "../share/breccia/materials"};
  const char *given = getenv("BRECCIA_MATERIALS");
  char program[MAX_PATH / 4], *slash;
  ssize_t n;
  path[0] = '\0';
  if (k >= 2 + N(beside)) return 0;
  if (k == 0 && given) snprintf(path, MAX_PATH / 2, "%s", given);
  if (k == 1) snprintf(path, MAX_PATH / 2, "materials");
  if (k < 2) return 1;
  n = readlink("/proc/self/exe", program, sizeof program - 1);
  if (n < 0) return 1;
  program[n] = '\0';
  if (!(slash = strrchr(program, '/'))) return 1;
  *slash = '\0';
  snprintf(path, MAX_PATH / 2, "%s/%s", program, beside[k - 2]);
  return 1;
}

/* ---- tables ---- */

/* The text of a key, NULL when it is missing or none. */
static const char *text_of(const config_setting_t *group, const char *key)
{
  const config_setting_t *s = group ? config_setting_get_member(group, key) : NULL;
  const char *text =
      s && config_setting_type(s) == CONFIG_TYPE_STRING ? config_setting_get_string(s) : NULL;
  return text && *text ? text : NULL;
}

/* What a material says of its table: `file` in eos, and the group `table` that material_find adds.
 */
typedef struct {
  const char *file, *path, *checksum;
} TableKeys;

static int table_keys(const config_setting_t *root, TableKeys *k, const char *label, Err *err)
{
  static const CfgRow none[] = {{NULL, CFG_TEXT, 0, NULL, NULL, 0, 0, NULL}};
  static const char *const also[] = {"path", "checksum"};
  const config_setting_t *eos = config_setting_get_member(root, "eos");
  const config_setting_t *table = config_setting_get_member(root, "table");
  k->file = text_of(eos, "file");
  k->path = text_of(table, "path"), k->checksum = text_of(table, "checksum");
  if (!k->file) return cfg_where(err, eos, label, "missing key 'file' (the table)");
  if (table && cfg_read(table, none, 0, NULL, also, N(also), label, err)) return -1;
  if (table && !k->checksum)
    return cfg_where(err, table, label, "'table' needs a 'checksum', a text");
  return 0;
}

/* Whether the table lies at path; 0 also when it is another one, which is noted in `other`. */
static int table_at(const char *path, const char *checksum, char *other, size_t size, Err *err)
{
  char sum[9];
  if (access(path, F_OK)) return 0;
  if (!checksum) return 1;
  if (tabfile_checksum(path, sum, err)) return -1;
  if (!strcmp(sum, checksum)) return 1;
  if (!*other) snprintf(other, size, "'%s' has the checksum %s, not %s", path, sum, checksum);
  return 0;
}

/* The file of a table: where it was found before, in the folders of materials, as it is given. */
static int table_find(const TableKeys *k, char path[MAX_PATH], Err *err)
{
  char at[MAX_PATH / 2], other[MAX_PATH / 4] = "";
  int found = 0;
  if (k->path) {
    snprintf(path, MAX_PATH, "%s", k->path);
    found = table_at(path, k->checksum, other, sizeof other, err);
  }
  for (int f = 0; !found && *k->file != '/' && folder(f, at); f++) {
    if (!*at) continue;
    snprintf(path, MAX_PATH, "%s/%s", at, k->file);
    found = table_at(path, k->checksum, other, sizeof other, err);
  }
  if (!found) {
    snprintf(path, MAX_PATH, "%s", k->file);
    found = table_at(path, k->checksum, other, sizeof other, err);
  }
  if (found) return found < 0 ? -1 : 0;
  if (*other)
    return err_set(err, "the table is another than the material was made with: %s", other);
  return err_set(
      err, "no table '%s' in $BRECCIA_MATERIALS, 'materials', beside the program or here", k->file);
}

static int table_load(const config_setting_t *root, Material *m, const char *label, Err *err)
{
  const config_setting_t *eos = config_setting_get_member(root, "eos");
  char path[MAX_PATH];
  TableKeys k;
  Table t;
  Err why;
  if (m->eos.form != EOS_TABLE) {
    const config_setting_t *table = config_setting_get_member(root, "table");
    return table ? cfg_where(err, table, label, "'table' goes with eos.form = \"table\" only") : 0;
  }
  if (table_keys(root, &k, label, err)) return -1;
  if (table_find(&k, path, &why))
    return cfg_where(err, config_setting_get_member(eos, "file"), label, "%s", why.text);
  if (m->heat > 0)
    return cfg_where(err, config_setting_get_member(eos, "heat_capacity"), label,
                     "a table has its own temperatures: no 'heat_capacity'");
  if (tabfile_read(&t, path, err)) return -1;
  if (table_law(&m->eos.table, &t, err)) return table_free(&t), -1;
  m->heat = table_heat(&m->eos.table);
  return table_free(&t), 0;
}

static int porous_consistent(const config_setting_t *root, const Material *m, const char *label,
                             Err *err)
{
  const config_setting_t *pores = config_setting_get_member(root, "porosity");
  const Porosity *q = &m->porosity;
  const char *wrong = NULL;
  if (m->yield.form == YIELD_POROUS && q->form != POROSITY_SIRONO)
    return cfg_where(err, config_setting_get_member(root, "strength"), label,
                     "the strength 'porous' needs the porosity 'sirono'");
  if (q->form == POROSITY_NONE) return 0;
  if (m->yield.form == YIELD_REGOLITH)
    return cfg_where(err, pores, label, "the strength 'regolith' opens pores of its own");
  if (eos_rho0(&m->eos) <= 0)
    wrong = "a gas has no pores";
  else if (q->c > 0 && q->form == POROSITY_SIRONO)
    wrong = "sirono has a bulk modulus of its own: no 'c_elastic'";
  else if (q->c > sqrt(eos_bulk(&m->eos) / eos_rho0(&m->eos)))
    wrong = "'c_elastic' must not be above the sound speed of the solid";
  else if (q->form == POROSITY_P_ALPHA && q->p_alpha.p_s <= q->p_alpha.p_e)
    wrong = "'p_s' must be above 'p_e'";
  else if (q->form == POROSITY_P_ALPHA_TWO_POWER &&
           (q->p_alpha_two_power.p_t <= q->p_alpha_two_power.p_e ||
            q->p_alpha_two_power.p_s < q->p_alpha_two_power.p_t ||
            q->p_alpha_two_power.alpha_e < q->p_alpha_two_power.alpha_t))
    wrong = "wants p_e < p_t <= p_s and alpha_t <= alpha_e";
  else if (q->form == POROSITY_EPSILON_ALPHA &&
           q->epsilon_alpha.epsilon_x >= q->epsilon_alpha.epsilon_e)
    wrong = "'epsilon_x' must be below 'epsilon_e' (compression is negative)";
  else if (q->form == POROSITY_SIRONO &&
           (q->alpha0 * q->sirono.phi_min >= 1 || q->alpha0 * q->sirono.phi_max <= 1))
    wrong = "1/alpha_0 must lie between 'phi_min' and 'phi_max'";
  return wrong ? cfg_where(err, pores, label, "%s", wrong) : 0;
}

/* What no single row can say. */
static int consistent(const config_setting_t *root, const Material *m, const char *label, Err *err)
{
  const config_setting_t *eos = config_setting_get_member(root, "eos");
  const config_setting_t *strength = config_setting_get_member(root, "strength");
  const config_setting_t *damage = config_setting_get_member(root, "damage");
  if (m->eos.form == EOS_TILLOTSON && m->eos.tillotson.Ecv <= m->eos.tillotson.Eiv)
    return cfg_where(err, config_setting_get_member(eos, "Ecv"), label,
                     "'Ecv' must be above 'Eiv'");
  if (m->mu > 0 && eos_rho0(&m->eos) <= 0)
    return cfg_where(err, strength, label, "a gas has no shear modulus");
  if (m->yield.form != YIELD_NONE && m->mu <= 0)
    return cfg_where(err, strength, label, "a yield stress needs a 'shear_modulus' above 0");
  if (m->yield.form == YIELD_JOHNSON_COOK && m->heat <= 0)
    return cfg_where(err, strength, label, "johnson_cook needs a 'heat_capacity' in 'eos'");
  if (m->yield.form == YIELD_JOHNSON_COOK &&
      m->yield.johnson_cook.Tmelt <= m->yield.johnson_cook.T0)
    return cfg_where(err, config_setting_get_member(strength, "Tmelt"), label,
                     "'Tmelt' must be above 'T0'");
  if (m->yield.form == YIELD_COLLINS && m->yield.collins.limit < m->yield.collins.cohesion)
    return cfg_where(err, config_setting_get_member(strength, "limit"), label,
                     "'limit' must not be below 'cohesion'");
  if (m->yield.form == YIELD_COLLINS && m->damage.form != DAMAGE_NONE &&
      m->damage.grady_kipp.shear > 0)
    return cfg_where(err, damage, label,
                     "collins has a strength for damaged rock of its own: 'shear' must be 0");
  if (m->damage.form != DAMAGE_NONE &&
      (m->yield.form == YIELD_REGOLITH || m->yield.form == YIELD_VISCOUS_REGOLITH))
    return cfg_where(err, damage, label, "soil does not break: no 'damage' with this strength");
  if (m->damage.form != DAMAGE_NONE && m->mu <= 0)
    return cfg_where(err, damage, label, "'damage' needs a 'shear_modulus' above 0 in 'strength'");
  return porous_consistent(root, m, label, err);
}

static int name_read(const config_setting_t *root, MaterialName name, const char *label, Err *err)
{
  static const char *const also[] = {"eos", "strength", "damage", "porosity", "table"};
  CfgRow row = {"name", CFG_TEXT, 0, NULL, NULL, 0, 0, "what the material is called"};
  if (cfg_read(root, &row, 1, name, also, N(also), label, err)) return -1;
  if (name[0] && !strpbrk(name, "/. \t\n")) return 0;
  return cfg_where(err, config_setting_get_member(root, "name"), label,
                   "'name' must not be empty nor contain '/', '.' or blanks: '%s'", name);
}

static int root_read(const config_setting_t *root, Material *m, const char *label, Err *err)
{
  const Group parts[] = {
      {"eos", EOS_WORDS, EOS, (size_t)((char *)&m->eos.form - (char *)m),
       (size_t)((char *)&m->eos.tillotson - (char *)m), EOS_OWN, N(EOS_OWN)},
      {"strength", YIELD_WORDS, YIELD, (size_t)((char *)&m->yield.form - (char *)m),
       (size_t)((char *)&m->yield.von_mises - (char *)m), STRENGTH, N(STRENGTH)},
      {"damage", DAMAGE_WORDS, DAMAGE, (size_t)((char *)&m->damage.form - (char *)m),
       (size_t)((char *)&m->damage.grady_kipp - (char *)m), NULL, 0},
      {"porosity", POROSITY_WORDS, POROSITY, (size_t)((char *)&m->porosity.form - (char *)m),
       (size_t)((char *)&m->porosity.p_alpha - (char *)m), PORES, N(PORES)}};
  MaterialName name;
  if (name_read(root, name, label, err)) return -1;
  if (!config_setting_get_member(root, "eos"))
    return err_set(err, "%s: missing group 'eos' (equation of state)", label);
  for (int k = 0; k < N(parts); k++) {
    const config_setting_t *group = config_setting_get_member(root, parts[k].name);
    if (group && part_read(group, &parts[k], m, label, err)) return -1;
    if (k == 0 && table_load(root, m, label, err)) return -1;
  }
  m->porosity.start = porosity_start(&m->porosity, &m->eos);
  return consistent(root, m, label, err);
}

int material_parse(Material *m, const char *text, const char *label, Err *err)
{
  config_t cfg;
  int failed;
  memset(m, 0, sizeof *m);
  if (cfg_open_text(&cfg, text, label, err)) return -1;
  failed = root_read(config_root_setting(&cfg), m, label, err);
  config_destroy(&cfg);
  if (failed) material_clear(m);
  return failed;
}

void material_clear(Material *m)
{
  if (m->eos.form == EOS_TABLE) table_law_free(&m->eos.table);
}

void material_free(Material *m, int n)
{
  for (int k = 0; m && k < n; k++) material_clear(&m[k]);
  free(m);
}

Material *material_load(const Parts *p, Err *err)
{
  Material *m = malloc((size_t)(p->materials + 1) * sizeof *m);
  char label[96];
  if (!m) return err_null(err, "no memory for %d materials", p->materials);
  for (int k = 0; k < p->materials; k++) {
    snprintf(label, sizeof label, "/Materials/%s", p->material[k].name);
    if (material_parse(&m[k], p->material[k].text, label, err)) {
      material_free(m, k);
      return NULL;
    }
  }
  return m;
}

static int by_name(const void *a, const void *b) { return strcmp(a, b); }

/* Adds the names of the .cfg files of a folder; a folder that is not there has none. */
static int names_add(const char *path, MaterialName **names, int *n)
{
  struct dirent *entry;
  DIR *dir = *path ? opendir(path) : NULL;
  if (!dir) return 0;
  while ((entry = readdir(dir))) {
    size_t length = strlen(entry->d_name);
    MaterialName *more;
    if (length < 5 || length >= sizeof **names + 4 || strcmp(entry->d_name + length - 4, ".cfg"))
      continue;
    if (!(more = realloc(*names, (size_t)(*n + 1) * sizeof *more))) {
      closedir(dir);
      return -1;
    }
    *names = more;
    snprintf(more[(*n)++], sizeof *more, "%.*s", (int)length - 4, entry->d_name);
  }
  closedir(dir);
  return 0;
}

MaterialName *material_names(int *n)
{
  MaterialName *names = calloc(1, sizeof *names);
  char path[MAX_PATH / 2];
  int all = 0;
  *n = 0;
  for (int k = 0; names && folder(k, path); k++)
    if (names_add(path, &names, &all)) {
      free(names);
      return NULL;
    }
  if (!names) return NULL;
  qsort(names, (size_t)all, sizeof *names, by_name);
  for (int k = 0; k < all; k++)
    if (!*n || strcmp(names[*n - 1], names[k])) memmove(names[(*n)++], names[k], sizeof *names);
  return names;
}

static char *unknown(const char *name, Err *err)
{
  int n = 0;
  MaterialName *names = material_names(&n);
  const char **list = malloc((size_t)(n + 1) * sizeof *list), *near = NULL;
  char known[512] = "";
  for (int k = 0; names && list && k < n; k++) {
    size_t used = strlen(known);
    list[k] = names[k];
    snprintf(known + used, sizeof known - used, "%s%s", k ? ", " : "", names[k]);
  }
  if (names && list) near = unit_nearest(name, list, n);
  if (near)
    err_set(err, "unknown material '%s' (did you mean '%s'?)", name, near);
  else if (n)
    err_set(err, "unknown material '%s' (known: %s)", name, known);
  else
    err_set(err,
            "unknown material '%s': no materials in $BRECCIA_MATERIALS, 'materials' or beside the "
            "program",
            name);
  free(names);
  free(list);
  return NULL;
}

/* Adds to the text of a material with a table, unless it has that, what finds the same table again:
 * the checksum, and where it is when it lies beside a .cfg that was given by its path. */
static char *table_note(char *text, const config_setting_t *root, const char *beside, Err *err)
{
  const char *file = text_of(config_setting_get_member(root, "eos"), "file"),
             *form = text_of(config_setting_get_member(root, "eos"), "form");
  char note[MAX_PATH + 64], path[MAX_PATH] = "", sum[9], *longer;
  TableKeys k = {file, NULL, NULL};
  int there = 0;
  if (!file || !form || strcmp(form, "table") || config_setting_get_member(root, "table"))
    return text;
  if (beside && *file != '/') {
    int folder_length = (int)(strrchr(beside, '/') ? strrchr(beside, '/') - beside + 1 : 0);
    snprintf(path, sizeof path, "%.*s%s", folder_length, beside, file);
    there = !access(path, F_OK);
  }
  if (there)
    snprintf(note, sizeof note, "path = \"%s\"; ", path);
  else
    *note = '\0';
  if ((!there && table_find(&k, path, err)) || tabfile_checksum(path, sum, err)) return NULL;
  if (!(longer = malloc(strlen(text) + strlen(note) + 64))) return err_null(err, "no memory");
  sprintf(longer, "%s\ntable = { %schecksum = \"%s\"; };\n", text, note, sum);
  free(text);
  return longer;
}

/* beside: the path of the .cfg when it was given, NULL when it was found by name. */
static char *named(const char *path, const char *beside, MaterialName name, Err *err)
{
  char *text = spool_slurp(path, err), *longer = NULL;
  config_t cfg;
  if (!text || cfg_open_text(&cfg, text, path, err)) {
    free(text);
    return NULL;
  }
  if (!name_read(config_root_setting(&cfg), name, path, err))
    longer = table_note(text, config_root_setting(&cfg), beside, err);
  config_destroy(&cfg);
  if (!longer) free(text);
  return longer;
}

char *material_find(const char *name_or_path, MaterialName name, Err *err)
{
  size_t length = strlen(name_or_path);
  char at[MAX_PATH / 2], path[MAX_PATH];
  if (strchr(name_or_path, '/') || (length > 4 && !strcmp(name_or_path + length - 4, ".cfg")))
    return named(name_or_path, name_or_path, name, err);
  for (int k = 0; length > 0 && length < sizeof(MaterialName) && folder(k, at); k++) {
    snprintf(path, sizeof path, "%s/%s.cfg", at, name_or_path);
    if (*at && !access(path, F_OK)) return named(path, NULL, name, err);
  }
  return unknown(name_or_path, err);
}
