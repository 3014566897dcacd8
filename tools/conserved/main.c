/* SPDX-License-Identifier: GPL-3.0-or-later */
/* conserved: how well a run keeps what must be kept, from its conserved.tsv. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "lib/opt.h"
#include "lib/plot.h"
#include "lib/tsv.h"

static const char *out, *title;

static const Opt opts[] = {
    {"output", 'o', OPT_TEXT, NULL, "PNG", "draw energies, drifts and time steps", &out},
    {"title", 't', OPT_TEXT, NULL, "TEXT", "title of the picture (default: the file)", &title},
    {0}};

static const OptProgram program = {
    .name = "conserved",
    .does = "show what a run conserves, and how well",
    .usage = "[options] run/ > drifts.tsv",
    .about =
        "The input is a run directory or its conserved.tsv. One row a quantity: its value at "
        "the start and at the end, how far it drifted at the end and at most, and what that is "
        "relative to: for the energy the largest kinetic energy (the total at the start where "
        "nothing moves), for the angular momentum its amount at the start, or, where that is "
        "less than a thousandth of sum m |r x v|, the largest of this; for the momentum the "
        "largest sum m |v|; for the mass itself.",
    .example = "conserved -o conserved.png run/",
    .opts = opts,
    .min_inputs = 0,
    .max_inputs = 1};

enum { ENERGY, MOMENTUM, ANGULAR, MASS, QUANTITIES };
static const char *const names[] = {"energy", "momentum", "angular_momentum", "mass"};
static const char *const units[] = {"J", "kg m/s", "kg m^2/s", "kg"};
static const char *const titles[] = {"energy", "momentum", "angular momentum", "mass"};

typedef struct {
  long n;
  double *t, *dt, *kinetic, *internal, *potential, *total, *vector[2][3], *scale[2], *mass;
  double *drift[QUANTITIES]; /* [n], absolute */
} Run;

typedef struct {
  double start, end, last, most, at, scale; /* drifts relative to scale; at [s] */
} Drift;

static double *numbers(const Tsv *t, const char *name)
{
  Err err;
  double *value = tsv_numbers(t, name, &err);
  if (!value) err_die("%s", err.text);
  return value;
}

static Run load(const Tsv *t)
{
  static const char *const vector[2][3] = {{"p_x", "p_y", "p_z"}, {"L_x", "L_y", "L_z"}};
  Run r = {.n = t->rows, .t = numbers(t, "time"), .dt = numbers(t, "dt")};
  r.kinetic = numbers(t, "E_kinetic"), r.internal = numbers(t, "E_internal");
  r.potential = numbers(t, "E_potential"), r.total = numbers(t, "E_total");
  r.mass = numbers(t, "mass");
  r.scale[0] = numbers(t, "sum_mv"), r.scale[1] = numbers(t, "sum_mrv");
  for (int k = 0; k < 2; k++)
    for (int a = 0; a < 3; a++) r.vector[k][a] = numbers(t, vector[k][a]);
  for (int q = 0; q < QUANTITIES; q++)
    if (!(r.drift[q] = calloc((size_t)r.n, sizeof(double)))) err_die("out of memory");
  for (long i = 0; i < r.n; i++) {
    r.drift[ENERGY][i] = fabs(r.total[i] - r.total[0]);
    r.drift[MASS][i] = fabs(r.mass[i] - r.mass[0]);
    for (int k = 0; k < 2; k++) {
      double **v = r.vector[k], sum = 0;
      for (int a = 0; a < 3; a++) sum += pow(v[a][i] - v[a][0], 2);
      r.drift[MOMENTUM + k][i] = sqrt(sum);
    }
  }
  return r;
}

static double largest(const double *value, long n)
{
  double most = 0;
  for (long i = 0; i < n; i++) most = fmax(most, fabs(value[i]));
  return most;
}

static double amount(double *const v[3], long i)
{
  return sqrt(v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i]);
}

static double scale_of(const Run *r, int q)
{
  const double turning = q == ANGULAR ? amount(r->vector[1], 0) : 0;
  switch (q) {
  case ENERGY: return largest(r->kinetic, r->n) > 0 ? largest(r->kinetic, r->n) : fabs(r->total[0]);
  case MOMENTUM: return largest(r->scale[0], r->n);
  case ANGULAR: return turning > 1e-3 * r->scale[1][0] ? turning : largest(r->scale[1], r->n);
  default: return r->mass[0];
  }
}

static Drift judge(const Run *r, int q)
{
  const long end = r->n - 1;
  Drift d = {.scale = scale_of(r, q)};
  d.start = q == ENERGY ? r->total[0] : q == MASS ? r->mass[0] : amount(r->vector[q - 1], 0);
  d.end = q == ENERGY ? r->total[end] : q == MASS ? r->mass[end] : amount(r->vector[q - 1], end);
  const double unit = d.scale > 0 ? d.scale : 1; /* nothing there: nothing drifts */
  d.last = r->drift[q][end] / unit, d.at = r->t[0];
  for (long i = 0; i < r->n; i++)
    if (r->drift[q][i] / unit > d.most) d.most = r->drift[q][i] / unit, d.at = r->t[i];
  return d;
}

/* The unit in which times are shown: its name and its length [s]. */
static const char *clock_of(const Run *r, double *length)
{
  const double span = r->t[r->n - 1] - r->t[0];
  static const struct {
    const char *name;
    double length;
  } units_of_time[] = {{"a", 3.15576e7}, {"d", 86400}, {"h", 3600}, {"min", 60}, {"s", 1}};
  for (int k = 0; k < 5; k++) {
    *length = units_of_time[k].length;
    if (span >= 3 * *length) return units_of_time[k].name;
  }
  *length = span < 3e-3 ? 1e-6 : 1;
  return span < 3e-3 ? "us" : "s";
}

static void draw(const Run *r, const char *label)
{
  Plot p;
  Err err;
  double unit, scale[QUANTITIES];
  const char *clock = clock_of(r, &unit);
  if (plot_open(&p, out, 1000, 1100, &err)) err_die("%s", err.text);
  fprintf(p.script, "$d << EOD\n");
  for (int q = 0; q < QUANTITIES; q++) scale[q] = judge(r, q).scale;
  for (long i = 0; i < r->n; i++) {
    fprintf(p.script, "%.9g %.9g %.9g %.9g %.9g %.9g", r->t[i] / unit, r->kinetic[i],
            r->internal[i], r->potential[i], r->total[i], r->dt[i]);
    for (int q = 0; q < QUANTITIES; q++)
      fprintf(p.script, " %.6g",
              scale[q] > 0 && r->drift[q][i] > 0 ? r->drift[q][i] / scale[q] : NAN);
    fputc('\n', p.script);
  }
  fprintf(p.script, "EOD\nset multiplot layout 3,1 title ");
  plot_text(&p, label);
  fprintf(p.script,
          " noenhanced\nset lmargin 14\nset rmargin 23\nset format x '%%g'\n"
          "set ylabel 'energy [J]'\nset xrange [%.9g:%.9g]\n"
          "plot $d using 1:2 with lines title 'kinetic', '' using 1:3 with lines title "
          "'internal', '' using 1:4 with lines title 'potential', '' using 1:5 with "
          "lines title 'total'\n",
          r->t[0] / unit, r->t[r->n - 1] > r->t[0] ? r->t[r->n - 1] / unit : r->t[0] / unit + 1);
  fprintf(p.script, "set ylabel 'drift'\nset logscale y\nset format y '10^{%%L}'\n"
                    "set yrange [1e-17<*:*]\nplot 1e-17 notitle lc rgb '#00000000' lw 0");
  for (int q = 0; q < QUANTITIES; q++)
    fprintf(p.script, ", $d using 1:%d with lines lt %d title '%s'", 7 + q, q + 1, titles[q]);
  fprintf(p.script,
          "\nset yrange [*:*]\nset xlabel 'time [%s]'\nset ylabel 'time step [s]'\n"
          "plot $d using 1:($6 > 0 ? $6 : NaN) with lines title 'dt'\nunset multiplot\n",
          clock);
  if (plot_close(&p, &err)) err_die("%s", err.text);
}

int main(int argc, char **argv)
{
  Err err;
  int inputs;
  char **input = opt_parse(&program, argc, argv, &inputs), path[4096];
  struct stat s;
  Tsv t;
  const char *file = inputs ? input[0] : "-";
  const int folder = !stat(file, &s) && S_ISDIR(s.st_mode);
  snprintf(path, sizeof path, "%s%s", file, folder ? "/conserved.tsv" : "");
  if (out && !strcmp(out, "-")) err_usage("--output: stdout holds the table: name a file");
  if (title && !out) err_usage("--title needs --output");
  if (tsv_read(&t, path, &err)) err_die("%s", err.text);
  if (!t.rows) err_die("'%s' has no rows", t.label);
  const Run r = load(&t);
  if (out) draw(&r, title ? title : t.label);
  printf("# %s: %ld lines, from %.9g s to %.9g s\n", t.label, r.n, r.t[0], r.t[r.n - 1]);
  printf("# quantity\tunit\tstart\tend\tdrift_end [1]\tdrift_max [1]\tat [s]\trelative_to\n");
  for (int q = 0; q < QUANTITIES; q++) {
    const Drift d = judge(&r, q);
    printf("%s\t%s\t%.9g\t%.9g\t%.4g\t%.4g\t%.9g\t%.9g\n", names[q], units[q], d.start, d.end,
           d.last, d.most, d.at, d.scale);
  }
  err_close_stdout();
  return 0;
}
