/* SPDX-License-Identifier: GPL-3.0-or-later */
/* info: what is in a snapshot. One screen for a person, or one part of it whole, as a table. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/opt.h"
#include "lib/snap.h"
#include "lib/unit.h"
#include "scan.h"

#define SECTIONS "fields|bodies|materials|collision|parameters|history|text"
enum { FIELDS_, BODIES, MATERIALS, COLLISION, PARAMETERS, HISTORY, TEXT, ALL };

static struct {
  const char *show;
} o;

/* clang-format off */
static const Opt OPTS[] = {
  {"show", 's', OPT_CHOICE, NULL, SECTIONS, "only this, whole, as a table (text: of the materials)", &o.show},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "info", "show what is in a snapshot", "[options] [snapshot.h5]",
  "One screen: time, bodies, materials, every field with its range, the collision, which settings were given, and which programs made it. "
  "--show prints one of these in full, tab-separated with a header, in SI.",
  "info run/snap_0100.h5\ninfo --show fields run/snap_0100.h5 | cut -f 1,4-7", OPTS, 0, 1};
/* clang-format on */

enum { SCREEN_ROWS = 8, SCREEN_WIDTH = 100 };

/* ---- tables ---- */

static void table_fields(const Parts *p)
{
  int n;
  ScanField *f = scan_fields(p, &n);
  if (!f) err_die("out of memory");
  printf("# field\ttype\tshape\tunit\tleast\tmean\tgreatest\tnot_finite\tmeaning\n");
  for (int k = 0; k < n; k++)
    printf("%s\t%s\t%s\t%s\t%.17g\t%.17g\t%.17g\t%ld\t%s\n", f[k].name, f[k].type, f[k].shape,
           f[k].unit, f[k].least, f[k].mean, f[k].greatest, f[k].bad, f[k].meaning);
  free(f);
}

static ScanGroup *groups(const Parts *p, const int32_t *key, int *n)
{
  ScanGroup *g = scan_groups(p, key, n);
  if (!g) err_die("out of memory");
  return g;
}

static void table_bodies(const Parts *p)
{
  int n;
  ScanGroup *g = groups(p, p->body, &n);
  printf("# body\tn\tmass [kg]\tx [m]\ty [m]\tz [m]\tv_x [m/s]\tv_y [m/s]\tv_z [m/s]\treach [m]\n");
  for (int k = 0; k < n; k++)
    printf("%d\t%ld\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\n", g[k].id, g[k].n,
           g[k].mass, g[k].x[0], g[k].x[1], g[k].x[2], g[k].v[0], g[k].v[1], g[k].v[2], g[k].reach);
  free(g);
}

/* The laws of a material, as `a b c d`, or with tabs. */
static void print_laws(const char *text, const char *between)
{
  static const char *const GROUP[] = {"eos", "strength", "damage", "porosity"};
  for (int k = 0; k < 4; k++) {
    char form[64];
    scan_form(text, GROUP[k], form, sizeof form);
    printf("%s%s", k ? between : "", form);
  }
}

/* The row of material c, whether or not a particle has it. */
static const ScanGroup *group_of(const ScanGroup *g, int n, int32_t c)
{
  static const ScanGroup NONE;
  for (int k = 0; k < n; k++)
    if (g[k].id == c) return g + k;
  return &NONE;
}

static void table_materials(const Parts *p)
{
  int n;
  ScanGroup *g = groups(p, p->mat, &n);
  printf("# material\tname\tn\tmass [kg]\teos\tstrength\tdamage\tporosity\n");
  for (int c = 0; c < p->materials; c++) {
    const ScanGroup *own = group_of(g, n, c);
    printf("%d\t%s\t%ld\t%.17g\t", c, p->material[c].name, own->n, own->mass);
    print_laws(p->material[c].text, "\t");
    putchar('\n');
  }
  free(g);
}

static void print_numbers(const char *group, const PartNumber *x, int n)
{
  for (int k = 0; k < n; k++) printf("%s\t%s\t%.17g\n", group, x[k].name, x[k].value);
}

static void table_collision(const Parts *p)
{
  printf("# group\tname\tvalue\n");
  print_numbers("Collision", p->collision, p->collisions);
  print_numbers("Body", p->body_info, p->body_infos);
  print_numbers("Run", p->run, p->runs);
}

static void table(const Parts *p, int section)
{
  switch (section) {
  case FIELDS_: table_fields(p); break;
  case BODIES: table_bodies(p); break;
  case MATERIALS: table_materials(p); break;
  case COLLISION: table_collision(p); break;
  case PARAMETERS:
    printf("# key\tvalue\tfrom\n");
    for (int k = 0; k < p->parameters; k++) puts(p->parameter[k]);
    break;
  case HISTORY:
    printf("# command\tversion\n");
    for (int k = 0; k < p->histories; k++) puts(p->history[k]);
    break;
  default:
    for (int c = 0; c < p->materials; c++)
      printf("%s# ---- material %d ----\n%s", c ? "\n" : "", c, p->material[c].text);
  }
}

/* ---- the screen ---- */

static void say_more(int n, const char *section)
{
  if (n > SCREEN_ROWS) printf("  ... %d more (--show %s)\n", n - SCREEN_ROWS, section);
}

static void screen_head(const Parts *p, const char *file)
{
  char time[64];
  printf("%s: %ld particles, %dD, t = %s (%.9g s)", file, p->n, p->dimension,
         unit_time_text(p->time, time, sizeof time), p->time);
  if (p->points) printf(", %d point mass%s", p->points, p->points > 1 ? "es" : "");
  puts(p->a ? ", a checkpoint" : "");
}

static void screen_bodies(const Parts *p)
{
  int n;
  ScanGroup *g = groups(p, p->body, &n);
  printf("\n%-6s %10s %12s %12s %12s\n", "body", "particles", "mass [kg]", "reach [m]",
         "|v| [m/s]");
  for (int k = 0; k < n && k < SCREEN_ROWS; k++)
    printf("%-6d %10ld %12.5g %12.5g %12.5g\n", g[k].id, g[k].n, g[k].mass, g[k].reach,
           sqrt(g[k].v[0] * g[k].v[0] + g[k].v[1] * g[k].v[1] + g[k].v[2] * g[k].v[2]));
  say_more(n, "bodies");
  free(g);
}

static void screen_materials(const Parts *p)
{
  int n;
  ScanGroup *g = groups(p, p->mat, &n);
  if (p->materials)
    printf("\n%-17s %10s %12s eos, strength, damage, porosity\n", "material", "particles",
           "mass [kg]");
  for (int c = 0; c < p->materials && c < SCREEN_ROWS; c++) {
    const ScanGroup *own = group_of(g, n, c);
    printf("%d %-15s %10ld %12.5g ", c, p->material[c].name, own->n, own->mass);
    print_laws(p->material[c].text, ", ");
    putchar('\n');
  }
  say_more(p->materials, "materials");
  free(g);
}

static void screen_fields(const Parts *p)
{
  int n;
  ScanField *f = scan_fields(p, &n);
  if (!f) err_die("out of memory");
  printf("\n%-22s %-10s %12s %12s %12s  %s\n", "field", "unit", "least", "mean", "greatest",
         "shape");
  for (int k = 0; k < n; k++) {
    printf("%-22s %-10s %12.5g %12.5g %12.5g  %s", f[k].name, f[k].unit, f[k].least, f[k].mean,
           f[k].greatest, f[k].shape);
    if (f[k].bad) printf("  %ld NOT FINITE", f[k].bad);
    putchar('\n');
  }
  free(f);
}

/* `name value` of the first numbers of a group, on one line. */
static void screen_numbers(const char *title, const PartNumber *x, int n)
{
  int used = printf("%s%-10s", n ? "\n" : "", n ? title : ""), k = 0;
  for (; k < n; k++) {
    char word[128];
    int length =
        snprintf(word, sizeof word, " %s %.6g%s", x[k].name, x[k].value, k + 1 < n ? "," : "");
    if (used + length > SCREEN_WIDTH - 4) break;
    used += printf("%s", word);
  }
  if (k < n) printf(" ...");
  if (n) putchar('\n');
}

/* Settings that were not left at their defaults. */
static void screen_parameters(const Parts *p)
{
  int used = p->parameters ? printf("\n%-10s", "settings") : 0, given = 0;
  for (int k = 0; k < p->parameters; k++) {
    const char *key = p->parameter[k], *value = strchr(key, '\t');
    const char *from = value ? strchr(value + 1, '\t') : NULL;
    if (!from || !strcmp(from, "\tdefault")) continue;
    int length = (int)(from - key) + 2;
    if (used + length > SCREEN_WIDTH - 4) {
      printf(" ...");
      break;
    }
    used += printf("%s %.*s=%.*s", given++ ? "," : "", (int)(value - key), key,
                   (int)(from - value - 1), value + 1);
  }
  if (p->parameters) puts(given ? "" : " all at their defaults");
}

static void screen_history(const Parts *p)
{
  enum { LAST = 4 };
  for (int k = p->histories > LAST ? p->histories - LAST : 0; k < p->histories; k++) {
    int length = (int)strcspn(p->history[k], "\t"), most = SCREEN_WIDTH - 14;
    printf("%s%-10s %.*s%s\n", k && p->histories - k < LAST ? "" : "\n",
           k && p->histories - k < LAST ? "" : "history", length < most ? length : most,
           p->history[k], length < most ? "" : "...");
  }
}

int main(int argc, char **argv)
{
  Err err;
  int n;
  char **input = opt_parse(&PROGRAM, argc, argv, &n);
  int section = o.show ? unit_choice(o.show, SECTIONS, &err) : ALL;
  int needs_all = section == FIELDS_ || section == ALL;
  const char *file = n ? input[0] : "-";
  Parts *p = needs_all ? snap_read(file, &err) : snap_read_some(file, "x v m body mat", &err);
  if (!p) err_die("%s", err.text);
  if (part_need(p, "x", file, &err)) err_die("%s", err.text);
  if (section != ALL) {
    table(p, section);
  } else {
    screen_head(p, file);
    screen_bodies(p);
    screen_materials(p);
    screen_fields(p);
    screen_numbers("collision", p->collision, p->collisions);
    screen_parameters(p);
    screen_history(p);
  }
  part_free(p);
  err_close_stdout();
  return 0;
}
