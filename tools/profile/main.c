/* SPDX-License-Identifier: GPL-3.0-or-later */
/* profile: fields against the distance from a centre, in shells, in all and by material or body. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/expr.h"
#include "lib/group.h"
#include "lib/opt.h"
#include "lib/plot.h"
#include "lib/snap.h"
#include "lib/sort.h"
#include "lib/unit.h"

enum { MOST = 16 };

static struct {
  OptList of;
  const char *group, *centre, *where, *by, *spacing, *range, *out, *title;
  long bins;
} arg;

static const Opt opts[] = {
    {"of", 'f', OPT_LIST, NULL, "EXPR",
     "what is averaged, may be repeated (Density, Pressure, InternalEnergy)", &arg.of},
    {"group", 'g', OPT_TEXT, "all", "GROUP", "particles of clump:K, fragment:K, body:K, or all",
     &arg.group},
    {"centre", 'c', OPT_TEXT, NULL, "GROUP|X,Y,Z",
     "about the centre of mass of a group, or a place (default: of --group)", &arg.centre},
    {"where", 'w', OPT_TEXT, NULL, "EXPR", "only particles for which this is not 0", &arg.where},
    {"by", 'b', OPT_CHOICE, "material", "none|material|body",
     "rows of each kind beside those of all", &arg.by},
    {"bins", 'n', OPT_INT, "50", "N", "number of shells", &arg.bins},
    {"spacing", 's', OPT_CHOICE, "linear", "linear|log|number",
     "of equal thickness, equal ratio, or equal numbers of particles", &arg.spacing},
    {"range", 'r', OPT_TEXT, NULL, "LOW,HIGH",
     "distances (default: to the farthest, at most 1.2 times what holds 99 %)", &arg.range},
    {"output", 'o', OPT_TEXT, NULL, "PNG", "draw it", &arg.out},
    {"title", 't', OPT_TEXT, NULL, "TEXT", "title of the picture (default: the file)", &arg.title},
    {0}};

static const OptProgram program = {
    .name = "profile",
    .does = "print radial profiles of any field",
    .usage = "[options] snapshot.h5 > profile.tsv",
    .about = "One row a shell that holds particles, for all particles and for each material (or "
             "body): its ends, the mean distance, number and mass, the mass inside its outer end, "
             "v_r, the radial velocity relative to the centre's, and for each field mean, standard "
             "deviation, least and largest value. Means are weighted by mass. Fields are "
             "expressions as in render and columns.",
    .example = "profile --group clump:1 -f Density -f 'Pressure/1GPa' -o radial.png with_ids.h5",
    .opts = opts,
    .min_inputs = 0,
    .max_inputs = 1};

typedef struct {
  double mass, r, v, inside; /* kg; sums of m r, m v_r; kg */
  long n;
} Shell;

typedef struct {
  double sum, sum2, least, most;
} Value;

/* Everything that is asked for. */
typedef struct {
  Parts *p;
  const char *file, *text[MOST];
  Expr *expr[MOST];
  double *value[MOST]; /* [p->n] */
  int fields, kinds;   /* kind 0 is all */
  long n, *list;       /* particles, by ascending id */
  double x[3], v[3];   /* of the centre */
  double *r;           /* [n] m */
  double *edge;        /* [bins + 1] m */
  Shell *shell;        /* [kinds][bins] */
  Value *cell;         /* [kinds][bins][fields] */
} Work;

static Err err;

static void *room(size_t n, size_t size)
{
  void *p = calloc(n + 1, size);
  if (!p) err_die("out of memory");
  return p;
}

static void parse(Work *w, Expr **where)
{
  static const char *standard[] = {"Density", "Pressure", "InternalEnergy"};
  if (arg.of.n > MOST) err_usage("more than %d fields", MOST);
  if (!arg.of.n) arg.of = (OptList){standard, 3};
  w->fields = arg.of.n;
  for (int k = 0; k < w->fields; k++)
    if (!(w->expr[k] = expr_parse(w->text[k] = arg.of.text[k], &err))) err_usage("%s", err.text);
  if (arg.where && !(*where = expr_parse(arg.where, &err))) err_usage("%s", err.text);
}

/* What is needed of the file, and the values of the fields. */
static void load(Work *w, const Expr *where)
{
  char members[1024] = "id x v m mat body frag clump";
  int all = 0;
  for (int k = 0; k < w->fields; k++) all |= expr_members(w->expr[k], members, sizeof members);
  if (where) all |= expr_members(where, members, sizeof members);
  w->p = all ? snap_read(w->file, &err) : snap_read_some(w->file, members, &err);
  if (!w->p || part_need(w->p, "id x v m mat body", w->file, &err) ||
      part_check(w->p, w->file, &err))
    err_die("%s", err.text);
  for (int k = 0; k < w->fields; k++) {
    if (expr_bind(w->expr[k], w->p, w->file, &err)) err_die("%s", err.text);
    expr_eval(w->expr[k], w->value[k] = room((size_t)w->p->n, sizeof(double)));
  }
}

/* Centre of mass and its velocity, of the members by ascending id. */
static void barycentre(Work *w, const long *order, const int32_t *id, int32_t which)
{
  double mass = 0, x[3] = {0}, v[3] = {0};
  for (long k = 0; k < w->p->n; k++) {
    const long i = order[k];
    if (id && id[i] != which) continue;
    for (int a = 0; a < 3; a++)
      x[a] += w->p->m[i] * w->p->x[3 * i + a], v[a] += w->p->m[i] * w->p->v[3 * i + a];
    mass += w->p->m[i];
  }
  for (int a = 0; a < 3; a++) w->x[a] = x[a] / mass, w->v[a] = v[a] / mass;
}

static void named(const Work *w, const char *what, const char *option, const int32_t **id,
                  int32_t *which)
{
  *id = NULL;
  if (strcmp(what, "all") && group_named(w->p, what, w->file, id, which, &err))
    err_die("--%s: %s", option, err.text);
}

/* The particles and the centre: its velocity is that of the group also when it is a place. */
static void choose(Work *w)
{
  const Parts *p = w->p;
  const int place = arg.centre && strchr(arg.centre, ',');
  unsigned char *keep = NULL;
  const int32_t *id, *about;
  int32_t which = 0, whose = 0;
  long *order = room((size_t)p->n, sizeof *order);
  if (arg.where && !(keep = expr_select(arg.where, p, w->file, &err))) err_die("%s", err.text);
  if (group_order(p, order, &err)) err_die("%s", err.text);
  named(w, arg.group, "group", &id, &which);
  about = id, whose = which;
  if (arg.centre && !place) named(w, arg.centre, "centre", &about, &whose);
  barycentre(w, order, about, whose);
  if (place && unit_list(arg.centre, "m", 3, w->x, &err)) err_usage("--centre: %s", err.text);
  w->list = room((size_t)p->n, sizeof *w->list), w->r = room((size_t)p->n, sizeof *w->r);
  for (long k = 0; k < p->n; k++) {
    const long i = order[k];
    if ((id && id[i] != which) || (keep && !keep[i])) continue;
    w->r[w->n] = group_apart(p->x + 3 * i, w->x), w->list[w->n++] = i;
  }
  if (!w->n) err_die("'%s': no particle is left to look at", w->file);
  free(order), free(keep);
}

/* Ends of the shells; the last one holds its outer end. */
static void edges(Work *w)
{
  const long n = arg.bins;
  long *order = room((size_t)w->n, sizeof *order);
  double range[2];
  if (sort_reals(w->n, w->r, order)) err_die("out of memory");
  const int log_scale = !strcmp(arg.spacing, "log");
  const double most = 1.2 * w->r[order[(w->n * 99 + 99) / 100 - 1]];
  range[0] = log_scale ? w->r[order[0]] : 0, range[1] = fmin(w->r[order[w->n - 1]], most);
  if (arg.range && unit_list(arg.range, "m", 2, range, &err)) err_usage("--range: %s", err.text);
  if (arg.range && !(range[0] >= 0 && range[1] > range[0]))
    err_usage("--range: 0 <= LOW < HIGH must hold");
  if (log_scale && !(range[0] > 0)) err_usage("--spacing log needs a --range from above 0");
  long from = 0, to = w->n;
  while (from < w->n && w->r[order[from]] < range[0]) from++;
  while (to > from && w->r[order[to - 1]] > range[1]) to--;
  w->edge = room((size_t)n + 1, sizeof *w->edge);
  for (long b = 0; b <= n; b++) {
    const double part = (double)b / (double)n;
    const long k = from + (long)((double)(to - from) * part);
    w->edge[b] = log_scale ? range[0] * pow(range[1] / range[0], part)
                 : !strcmp(arg.spacing, "number")
                     ? (b == 0 || k >= w->n ? range[b > 0] : w->r[order[k]])
                     : range[0] + part * (range[1] - range[0]);
  }
  w->edge[0] = range[0], w->edge[n] = range[1];
  free(order);
}

/* The shell of a distance, -1: outside. */
static long shell_of(const Work *w, double r)
{
  long low = 0, high = arg.bins;
  if (r < w->edge[0] || r > w->edge[arg.bins]) return -1;
  while (high - low > 1) {
    const long mid = (low + high) / 2;
    if (r < w->edge[mid])
      high = mid;
    else
      low = mid;
  }
  return low;
}

static void count(Work *w, int kind, long b, long k)
{
  const Parts *p = w->p;
  const long i = w->list[k], at = (long)kind * arg.bins + b;
  const double m = p->m[i];
  Shell *s = &w->shell[at];
  double v = 0;
  for (int a = 0; a < 3; a++) v += (p->x[3 * i + a] - w->x[a]) * (p->v[3 * i + a] - w->v[a]);
  s->n++, s->mass += m, s->r += m * w->r[k], s->v += w->r[k] > 0 ? m * v / w->r[k] : 0;
  for (int f = 0; f < w->fields; f++) {
    Value *c = &w->cell[at * w->fields + f];
    const double value = w->value[f][i];
    if (s->n == 1) c->least = c->most = value;
    c->sum += m * value, c->least = fmin(c->least, value), c->most = fmax(c->most, value);
  }
}

static int kind_of(const Parts *p, long i)
{
  return !strcmp(arg.by, "none") ? 0 : 1 + (!strcmp(arg.by, "body") ? p->body[i] : p->mat[i]);
}

/* Sums over the shells, then the squares about the means. */
static void average(Work *w)
{
  const Parts *p = w->p;
  const int bodies = group_bodies(p, &err);
  if (bodies < 0) err_die("'%s': %s", w->file, err.text);
  w->kinds = 1 + (!strcmp(arg.by, "body") ? bodies : !strcmp(arg.by, "none") ? 0 : p->materials);
  const size_t cells = (size_t)w->kinds * (size_t)arg.bins;
  w->shell = room(cells, sizeof *w->shell);
  w->cell = room(cells * (size_t)w->fields, sizeof *w->cell);
  double *inside = room((size_t)w->kinds, sizeof *inside);
  for (int pass = 0; pass < 2; pass++)
    for (long k = 0; k < w->n; k++) {
      const long i = w->list[k], b = shell_of(w, w->r[k]);
      const int kind[2] = {0, kind_of(p, i)};
      for (int q = 0; q < 1 + (kind[1] > 0); q++) {
        if (!pass && b < 0 && w->r[k] < w->edge[0]) inside[kind[q]] += p->m[i];
        if (b < 0) continue;
        if (!pass) count(w, kind[q], b, k);
        const long at = (long)kind[q] * arg.bins + b;
        for (int f = 0; f < w->fields && pass; f++) {
          Value *c = &w->cell[at * w->fields + f];
          c->sum2 += p->m[i] * pow(w->value[f][i] - c->sum / w->shell[at].mass, 2);
        }
      }
    }
  for (int q = 0; q < w->kinds; q++)
    for (long b = 0; b < arg.bins; b++)
      w->shell[q * arg.bins + b].inside = inside[q] += w->shell[q * arg.bins + b].mass;
  free(inside);
}

static const char *kind_name(const Work *w, int kind, char *text, int size)
{
  if (!kind) return "all";
  if (strcmp(arg.by, "body")) return w->p->material[kind - 1].name;
  snprintf(text, (size_t)size, "body:%d", kind - 1);
  return text;
}

static void print(const Work *w)
{
  char time[64], name[32];
  long outside = 0;
  for (long k = 0; k < w->n; k++) outside += shell_of(w, w->r[k]) < 0;
  printf("# %s at %s: %ld particles about %.9g,%.9g,%.9g m, %ld of them outside the shells\n",
         w->file, unit_time_text(w->p->time, time, sizeof time), w->n, w->x[0], w->x[1], w->x[2],
         outside);
  printf("# kind\tfrom [m]\tto [m]\tr [m]\tn\tmass [kg]\tinside [kg]\tv_r [m/s]");
  for (int f = 0; f < w->fields; f++) {
    static const char *const what[] = {"", ":std", ":min", ":max"};
    for (int k = 0; k < 4; k++) printf("\t%s%s [%s]", w->text[f], what[k], expr_unit(w->expr[f]));
  }
  putchar('\n');
  for (int q = 0; q < w->kinds; q++)
    for (long b = 0; b < arg.bins; b++) {
      const Shell *s = &w->shell[q * arg.bins + b];
      if (!s->n) continue;
      printf("%s\t%.9g\t%.9g\t%.9g\t%ld\t%.9g\t%.9g\t%.9g", kind_name(w, q, name, sizeof name),
             w->edge[b], w->edge[b + 1], s->r / s->mass, s->n, s->mass, s->inside, s->v / s->mass);
      for (int f = 0; f < w->fields; f++) {
        const Value *c = &w->cell[(q * arg.bins + b) * w->fields + f];
        printf("\t%.9g\t%.9g\t%.9g\t%.9g", c->sum / s->mass, sqrt(c->sum2 / s->mass), c->least,
               c->most);
      }
      putchar('\n');
    }
}

/* The data of kind q: r, then mean, least and largest of each field. Returns whether there are. */
static int plot_data(Plot *p, const Work *w, int q)
{
  int some = 0;
  fprintf(p->script, "$k%d << EOD\n", q);
  for (long b = 0; b < arg.bins; b++) {
    const Shell *s = &w->shell[q * arg.bins + b];
    if (!s->n && some == 1) fputc('\n', p->script), some = 2; /* curves do not bridge gaps */
    if (!s->n) continue;
    some = 1, fprintf(p->script, "%.9g", s->r / s->mass / 1e3);
    for (int f = 0; f < w->fields; f++) {
      const Value *c = &w->cell[(q * arg.bins + b) * w->fields + f];
      fprintf(p->script, " %.9g %.9g %.9g", c->sum / s->mass, c->least, c->most);
    }
    fputc('\n', p->script);
  }
  fprintf(p->script, "EOD\n");
  return some;
}

static void draw(const Work *w)
{
  Plot p;
  char name[32], label[256];
  const int columns = w->fields > 3 ? 2 : 1, rows = (w->fields + columns - 1) / columns;
  int *some = room((size_t)w->kinds, sizeof *some), first = w->kinds > 2;
  if (plot_open(&p, arg.out, columns * 800, 100 + 330 * rows, &err)) err_die("%s", err.text);
  for (int q = 0; q < w->kinds; q++) some[q] = plot_data(&p, w, q);
  fprintf(p.script, "set multiplot layout %d,%d title ", rows, columns);
  plot_text(&p, arg.title ? arg.title : w->file);
  fprintf(
      p.script,
      " noenhanced\nset lmargin 14\nset xlabel 'distance [km]'\nset style fill transparent solid "
      "0.2 noborder\nset xrange [%.9g:%.9g]\n",
      w->edge[0] / 1e3, w->edge[arg.bins] / 1e3);
  if (!strcmp(arg.spacing, "log")) fprintf(p.script, "set logscale x\n");
  for (int f = 0; f < w->fields; f++) {
    snprintf(label, sizeof label, "%s [%s]", w->text[f], expr_unit(w->expr[f]));
    fprintf(p.script, "set ylabel "), plot_text(&p, label);
    fprintf(p.script, " noenhanced\nplot ");
    for (int q = first, drawn = 0; q < w->kinds; q++) {
      if (!some[q]) continue;
      const int lt = q + !first;
      fprintf(p.script,
              "%s$k%d using 1:%d:%d with filledcurves lt %d notitle, '' using 1:%d with "
              "linespoints ps 0.4 lt %d title ",
              drawn++ ? ", " : "", q, 3 * f + 3, 3 * f + 4, lt, 3 * f + 2, lt);
      plot_text(&p, kind_name(w, q, name, sizeof name));
      if (!first) break; /* a single kind is all */
    }
    fputc('\n', p.script);
  }
  fprintf(p.script, "unset multiplot\n");
  free(some);
  if (plot_close(&p, &err)) err_die("%s", err.text);
}

int main(int argc, char **argv)
{
  int inputs;
  char **input = opt_parse(&program, argc, argv, &inputs);
  Work w = {.file = inputs ? input[0] : "-"};
  Expr *where = NULL;
  if (arg.bins < 1 || arg.bins > 1000000) err_usage("--bins must lie in 1..1000000");
  if (arg.title && !arg.out) err_usage("--title needs --output");
  if (arg.out && !strcmp(arg.out, "-")) err_usage("--output: stdout holds the table: name a file");
  parse(&w, &where);
  load(&w, where);
  choose(&w), edges(&w), average(&w);
  if (arg.out) draw(&w);
  print(&w);
  err_close_stdout();
  for (int k = 0; k < w.fields; k++) expr_free(w.expr[k]), free(w.value[k]);
  expr_free(where), free(w.list), free(w.r), free(w.edge), free(w.shell), free(w.cell);
  part_free(w.p);
  return 0;
}
