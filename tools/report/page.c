/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sections are written one after the other; those that come out empty leave no heading. */
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "child.h"
#include "dumps.h"
#include "html.h"
#include "lib/expr.h"
#include "lib/plot.h"
#include "lib/snap.h"
#include "lib/spool.h"
#include "lib/tsv.h"
#include "lib/unit.h"
#include "page.h"

enum { SECTIONS = 12, COLUMNS = 11, MADE = 32, ARGUMENTS = 64 };

typedef struct {
  const PageAsk *ask;
  Dumps dumps;
  Parts *last;           /* of the last snapshot: what is not in its arrays, and a few of them */
  double first_time;     /* s */
  FILE *f;               /* the body */
  char folder[3072];     /* where pictures and tables are made */
  char made[MADE][4096]; /* files in it */
  int files;
  const char *id[SECTIONS], *title[SECTIONS];
  int sections;
} Page;

static void section(Page *g, const char *id, const char *title)
{
  html_section(g->f, id, title);
  g->id[g->sections] = id, g->title[g->sections++] = title;
}

/* The path of a file that is to be made. */
static const char *scratch(Page *g, const char *name)
{
  char *path = g->made[g->files++];
  snprintf(path, sizeof g->made[0], "%s/%s", g->folder, name);
  return path;
}

static const char *last_dump(const Page *g) { return g->dumps.file[g->dumps.n - 1]; }

/* FILE:CAPTION; without a caption the file's name. Returns the caption. */
static const char *split(const char *word, char *path, size_t size)
{
  const char *colon = strchr(word, ':'), *slash;
  snprintf(path, size, "%.*s", (int)(colon ? colon - word : (long)strlen(word)), word);
  slash = strrchr(path, '/');
  return colon ? colon + 1 : slash ? slash + 1 : path;
}

/* ---- at a glance ---- */

static void pair(Page *g, const char *name, const char *format, ...)
{
  char text[1024];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  html_pair(g->f, name, text);
}

static void composition(Page *g, const Parts *p)
{
  char text[1024] = "";
  double all = 0, *mass = calloc((size_t)p->materials + 1, sizeof *mass);
  if (!mass) return;
  for (long i = 0; i < p->n; i++) all += p->m[i], mass[p->mat[i]] += p->m[i];
  for (int c = 0; c < p->materials; c++) {
    size_t n = strlen(text);
    snprintf(text + n, sizeof text - n, "%s%s %.3g %%", n ? ", " : "", p->material[c].name,
             100 * mass[c] / all);
  }
  pair(g, "Mass", "%.6g kg", all);
  pair(g, "Materials", "%s", text);
  free(mass);
}

static void collision(Page *g, const Parts *p)
{
  double angle = part_number(p, "collision", "ContactAngle"),
         speed = part_number(p, "collision", "ContactSpeed"),
         ratio = part_number(p, "collision", "ContactSpeedRatio");
  if (!isnan(angle) && !isnan(speed))
    pair(g, "Collision", "%.4g degrees at contact, %.4g m/s, %.4g mutual escape speeds",
         angle * 57.29577951308232, speed, ratio);
}

/* The first line of the log says on what: `... on cpu, 2 threads`. */
static void machine(Page *g)
{
  const char *log = g->dumps.log, *on = NULL;
  size_t line = log ? strcspn(log, "\n") : 0;
  for (const char *s = log; s && (s = strstr(s, " on ")) && s < log + line; s += 4) on = s + 4;
  if (on) pair(g, "Computed on", "%.*s", (int)(log + line - on), on);
  if (!isnan(g->dumps.steps))
    pair(g, "Timing", "%.0f steps in %.4g s of wall clock, %.3g ms a step", g->dumps.steps,
         g->dumps.seconds, 1e3 * g->dumps.seconds / g->dumps.steps);
}

/* Versions that the history names, each once. */
static void versions(Page *g, const Parts *p)
{
  char text[512] = "";
  for (int k = 0; k < p->histories; k++) {
    const char *tab = strrchr(p->history[k], '\t');
    size_t n = strlen(text);
    if (tab && !strstr(text, tab + 1))
      snprintf(text + n, sizeof text - n, "%s%s", n ? ", " : "", tab + 1);
  }
  if (*text) pair(g, "Made with", "breccia %s; this page: %s", text, opt_version);
}

static void glance(Page *g)
{
  const Parts *p = g->last;
  char from[64], to[64];
  int bodies = 0;
  if (!p) return;
  section(g, "glance", "At a glance");
  html_pairs(g->f, 1);
  for (long i = 0; i < p->n && p->body; i++)
    bodies = p->body[i] >= bodies ? p->body[i] + 1 : bodies;
  pair(g, "Particles", "%ld in %dD, %d %s", p->n, p->dimension, bodies,
       bodies == 1 ? "body" : "bodies");
  composition(g, p);
  collision(g, p);
  if (g->dumps.n > 1)
    pair(g, "Time", "%s to %s, %d snapshots", unit_time_text(g->first_time, from, sizeof from),
         unit_time_text(p->time, to, sizeof to), g->dumps.n);
  else
    pair(g, "Time", "%s", unit_time_text(p->time, to, sizeof to));
  machine(g);
  versions(g, p);
  html_pairs(g->f, 0);
}

/* ---- what is given ---- */

static int given_texts(Page *g, Err *err)
{
  char path[4096];
  if (g->ask->text.n) section(g, "text", "Results");
  for (int k = 0; k < g->ask->text.n; k++) {
    const char *caption = split(g->ask->text.text[k], path, sizeof path);
    char *text = spool_slurp(path, err);
    if (!text) return -1;
    fputs("<h3>", g->f), html_text(g->f, caption), fputs("</h3>\n", g->f);
    html_pre(g->f, text, NULL);
    free(text);
  }
  return 0;
}

static int given_pictures(Page *g, Err *err)
{
  char path[4096];
  for (int k = 0; k < g->ask->picture.n; k++) {
    const char *caption = split(g->ask->picture.text[k], path, sizeof path);
    if (html_picture(g->f, path, caption, err)) return -1;
  }
  return 0;
}

static int given_tables(Page *g, Err *err)
{
  char path[4096];
  for (int k = 0; k < g->ask->table.n; k++) {
    const char *caption = split(g->ask->table.text[k], path, sizeof path);
    if (html_table(g->f, path, caption, g->ask->rows, COLUMNS, err)) return -1;
  }
  return 0;
}

/* ---- what is made ---- */

/* Snapshots from the first to the last in equal steps into argv; returns how many. */
static int some_dumps(const Page *g, const char **argv, long most)
{
  const Dumps *d = &g->dumps;
  int n = d->n < most ? d->n : (int)most;
  for (int k = 0; k < n; k++) argv[k] = d->file[n == 1 ? d->n - 1 : (long)k * (d->n - 1) / (n - 1)];
  return n;
}

static int draw(Page *g, const char *name, const char *caption, const char *const *more, int dumps,
                Err *err)
{
  const char *argv[ARGUMENTS] = {"render", "-s", "1600x1000", "-o", NULL};
  int n = 5;
  const char *path = argv[4] = scratch(g, name);
  for (; *more; more++) argv[n++] = *more;
  n += some_dumps(g, argv + n, dumps);
  argv[n] = NULL;
  if (child_run(argv, NULL, err)) return -1;
  return html_picture(g->f, path, caption, err);
}

static int drawn(Page *g, Err *err)
{
  static const char *const plain[] = {NULL}, *const damage[] = {"-c", "Damage", "-r", "0:1", NULL},
                           *const column[] = {"-v", "projection", "-c",      "ColumnDensity",
                                              "-l", "-m",         "inferno", NULL};
  int frames = (int)g->ask->frames;
  if (draw(g, "materials.png", "Materials, cut open in the plane of the picture.", plain, frames,
           err))
    return -1;
  if (g->last->damage &&
      draw(g, "damage.png", "Damage: 0 intact, 1 fully damaged.", damage, frames, err))
    return -1;
  return draw(g, "column.png", "Column density along the line of sight, at the end.", column, 1,
              err);
}

static int pictures(Page *g, Err *err)
{
  int own = g->dumps.n && !g->ask->only;
  if (!own && !g->ask->picture.n) return 0;
  section(g, "pictures", "Pictures");
  if (given_pictures(g, err)) return -1;
  return own && !g->ask->picture.n ? drawn(g, err) : 0;
}

/* Masses of the bound bodies against time, from what the solver wrote while it ran. */
static int bound_curve(Page *g, const char *bound, Err *err)
{
  Tsv t;
  Plot plot;
  const char *path = scratch(g, "bound.png");
  if (tsv_read(&t, bound, err)) return -1;
  double *time = tsv_numbers(&t, "time", err), *mass[4] = {NULL};
  static const char *const names[4] = {"M_bound", "M_1", "M_2", "M_3"}, *const words[4] = {
                                                                            "all that is bound",
                                                                            "largest", "second",
                                                                            "third"};
  int bad = !time;
  for (int k = 0; k < 4 && !bad; k++) bad = !(mass[k] = tsv_numbers(&t, names[k], err));
  if (!bad && !(bad = plot_open(&plot, path, 1100, 480, err))) {
    FILE *f = plot.script;
    fprintf(f, "$bound << EOD\n");
    for (long r = 0; r < t.rows; r++)
      fprintf(f, "%.9g %.9g %.9g %.9g %.9g\n", time[r] / 3600, mass[0][r], mass[1][r], mass[2][r],
              mass[3][r]);
    fprintf(f, "EOD\nset xlabel 'time [h]'\nset ylabel 'mass [kg]'\nset yrange [0:*]\nplot ");
    for (int k = 0; k < 4; k++)
      fprintf(f, "%s$bound using 1:%d with lines title '%s'", k ? ", " : "", k + 2, words[k]);
    fputc('\n', f);
    bad = plot_close(&plot, err) ||
          html_picture(g->f, path, "Masses of the gravitationally bound bodies.", err);
  }
  free(time);
  for (int k = 0; k < 4; k++) free(mass[k]);
  tsv_free(&t);
  return bad ? -1 : 0;
}

static int curves(Page *g, Err *err)
{
  char conserved[4096], bound[4096];
  int has = dumps_has(&g->dumps, "conserved.tsv", conserved, sizeof conserved) && !g->ask->only;
  if (!has) return 0;
  section(g, "curves", "Conservation");
  const char *table = scratch(g, "drifts.tsv");
  if (!child_there("gnuplot")) {
    fputs("<p class=\"note\">Curves need gnuplot, which was not there.</p>\n", g->f);
    const char *const argv[] = {"conserved", conserved, NULL};
    if (child_run(argv, table, err)) return -1;
  } else {
    const char *path = scratch(g, "conserved.png"), *const argv[] = {"conserved", "-o", path,
                                                                     conserved, NULL};
    if (child_run(argv, table, err) ||
        html_picture(g->f, path, "Energies, drifts of what is conserved, time steps.", err) ||
        (dumps_has(&g->dumps, "bound.tsv", bound, sizeof bound) && bound_curve(g, bound, err)))
      return -1;
  }
  return html_table(g->f, table, "Drifts", g->ask->rows, COLUMNS, err);
}

static int found(Page *g, Err *err)
{
  const char *fragments = scratch(g, "fragments.tsv"),
             *clumps = scratch(g, "clumps.tsv"), *const fof_line[] = {"fof", last_dump(g), NULL},
             *const clumps_line[] = {"clumps", last_dump(g), NULL};
  if (child_run(fof_line, fragments, err) ||
      html_table(g->f, fragments, "Fragments (fof): particles that touch", g->ask->rows, COLUMNS,
                 err))
    return -1;
  if (!g->last->v) return 0; /* a snapshot without motion has no bound bodies */
  if (child_run(clumps_line, clumps, err)) return -1;
  return html_table(g->f, clumps, "Bound bodies (clumps): held together by gravity", g->ask->rows,
                    COLUMNS, err);
}

static int tables(Page *g, Err *err)
{
  int own = g->dumps.n && !g->ask->only && g->last->dimension == 3;
  if (!own && !g->ask->table.n) return 0;
  section(g, "tables", "What is left");
  if (given_tables(g, err)) return -1;
  return own && !g->ask->table.n ? found(g, err) : 0;
}

/* ---- how it was made ---- */

static void settings(Page *g)
{
  const Parts *p = g->last;
  int given = 0;
  if (!p || !p->parameters) return;
  section(g, "settings", "Settings");
  for (int all = 0; all < 2; all++) {
    fputs(all ? "<details><summary>all settings</summary>\n" : "", g->f);
    html_pairs(g->f, 1);
    for (int k = 0; k < p->parameters; k++) {
      char key[128], value[512], from[32];
      if (sscanf(p->parameter[k], "%127[^\t]\t%511[^\t]\t%31s", key, value, from) != 3) continue;
      if (all || strcmp(from, "default")) html_pair(g->f, key, value), given += !all;
    }
    html_pairs(g->f, 0);
    if (!all && !given) fputs("<p class=\"note\">All as by default.</p>\n", g->f);
  }
  fputs("</details>\n", g->f);
}

static void history(Page *g)
{
  const Parts *p = g->last;
  if (!p) return;
  section(g, "history", "How it was made");
  fputs("<ol class=\"history\">\n", g->f);
  for (int k = 0; k < p->histories; k++) {
    char line[4096];
    snprintf(line, sizeof line, "%s", p->history[k]);
    char *tab = strrchr(line, '\t');
    if (tab) *tab = 0;
    fputs("<li><code>", g->f), html_text(g->f, line), fputs("</code>", g->f);
    if (tab) fputs(" <small>", g->f), html_text(g->f, tab + 1), fputs("</small>", g->f);
    fputs("</li>\n", g->f);
  }
  fputs("</ol>\n", g->f);
  for (int c = 0; c < p->materials; c++) {
    char title[96];
    snprintf(title, sizeof title, "material %s", p->material[c].name);
    html_pre(g->f, p->material[c].text, title);
  }
  if (g->dumps.log) html_pre(g->f, g->dumps.log, "log of the run");
}

static int body(Page *g, Err *err)
{
  const PageAsk *ask = g->ask;
  if (ask->input && dumps_find(&g->dumps, ask->input, err)) return -1;
  if (g->dumps.n) {
    Parts *first = snap_read_some(g->dumps.file[0], "id", err);
    if (!first) return -1;
    g->first_time = first->time;
    part_free(first);
    g->last = snap_read_some(last_dump(g), "id m v mat body damage", err);
    if (!g->last || part_need(g->last, "id m mat", last_dump(g), err)) return -1;
  }
  glance(g);
  if (given_texts(g, err) || pictures(g, err) || tables(g, err) || curves(g, err)) return -1;
  settings(g), history(g);
  return 0;
}

static int make_folder(Page *g, Err *err)
{
  const char *tmp = getenv("TMPDIR");
  snprintf(g->folder, sizeof g->folder, "%s/report.XXXXXX", tmp && *tmp ? tmp : "/tmp");
  return mkdtemp(g->folder) ? 0 : err_set(err, "cannot make '%s': %s", g->folder, strerror(errno));
}

static char *whole(const Page *g, const char *text)
{
  char *page = NULL;
  size_t size;
  FILE *f = open_memstream(&page, &size);
  if (!f) return NULL;
  html_begin(f,
             g->ask->title   ? g->ask->title
             : g->ask->input ? g->ask->input
                             : "Report",
             g->ask->title && g->ask->input ? g->ask->input : "");
  fputs("<nav>", f);
  for (int k = 0; k < g->sections; k++)
    fprintf(f, "<a href=\"#%s\">%s</a>\n", g->id[k], g->title[k]);
  fputs("</nav>\n", f);
  fputs(text, f);
  html_end(f, opt_version);
  return fclose(f) ? NULL : page;
}

char *page_write(const PageAsk *ask, Err *err)
{
  Page *g = calloc(1, sizeof *g);
  char *text = NULL, *page = NULL;
  size_t size;
  if (!g) return err_null(err, "out of memory");
  g->ask = ask;
  if (make_folder(g, err)) return free(g), NULL;
  g->f = open_memstream(&text, &size);
  int bad = g->f ? body(g, err) : err_set(err, "out of memory");
  if (g->f && fclose(g->f) && !bad) bad = err_set(err, "out of memory");
  if (!bad && !(page = whole(g, text))) err_set(err, "out of memory");
  for (int k = 0; k < g->files; k++) unlink(g->made[k]);
  rmdir(g->folder);
  dumps_free(&g->dumps), part_free(g->last), free(text), free(g);
  return page;
}
