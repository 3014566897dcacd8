/* SPDX-License-Identifier: GPL-3.0-or-later */
/* histo: spectra of fragments, bound bodies or whatever a table lists: masses, sizes, speeds. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/opt.h"
#include "lib/plot.h"
#include "lib/sort.h"
#include "lib/tsv.h"
#include "lib/unit.h"

static struct {
  const char *column, *weight, *out, *title, *fit;
  long bins, skip;
  int linear, relative;
} arg;

static const Opt opts[] = {
    {"column", 'c', OPT_TEXT, "mass", "NAME", "what is counted: mass, radius, v, ... of the table",
     &arg.column},
    {"bins", 'b', OPT_INT, "0", "N", "histogram with N bins (0: the cumulative spectrum N(>= x))",
     &arg.bins},
    {"linear", 'l', OPT_FLAG, NULL, NULL, "bins of equal width, not of equal ratio", &arg.linear},
    {"weight", 'w', OPT_TEXT, "mass", "NAME", "what `share` sums", &arg.weight},
    {"relative", 'r', OPT_FLAG, NULL, NULL,
     "values over the sum of all in the table (masses: of all "
     "that is listed)",
     &arg.relative},
    {"skip", 'k', OPT_INT, "0", "N", "leave out the N largest (1: the largest remnant)", &arg.skip},
    {"fit", 'f', OPT_TEXT, NULL, "LOW:HIGH",
     "slope b of N(>= x) ~ x^-b of the values in this range", &arg.fit},
    {"output", 'o', OPT_TEXT, NULL, "PNG", "draw it", &arg.out},
    {"title", 't', OPT_TEXT, NULL, "TEXT", "title of the picture", &arg.title},
    {0}};

static const OptProgram program = {
    .name = "histo",
    .does = "make mass, size and velocity spectra from tables of fof or clumps",
    .usage = "[options] [table.tsv ...] > spectrum.tsv",
    .about = "Each table is a series. The cumulative spectrum (001 fig. 8) has one row a value, "
             "descending: how many are at least that large, and their share of all weights. A "
             "histogram has one row a bin: its ends, the count, count per width (per factor 10 "
             "unless --linear), and its share. --fit prints the maximum-likelihood exponent of a "
             "power law cut off at both ends, N(>= x) - N(>= HIGH) ~ x^-b - HIGH^-b, and its "
             "standard error. Values that are not positive have no place in logarithmic bins: "
             "their number is in the header. A fragment of one or two particles is a number of "
             "particles more than a mass: fof --min-particles leaves them out.",
    .example =
        "fof --max-damage 1 --link 1.01 --min-particles 3 snap_0100.h5 | histo -o spectrum.png",
    .opts = opts,
    .min_inputs = 0,
    .max_inputs = -1};

/* One table: values and weights, descending. */
typedef struct {
  char label[256], unit[64];
  long n, dropped;                /* dropped: not finite, or not positive where it must be */
  double *x, *w, all;             /* all: sum of the weights of the table */
  double low, high, slope, error; /* fit; slope NAN: no value to fit */
  long fitted;
} Series;

static int logarithmic(void) { return !arg.linear; }

static Series load(const char *path)
{
  Err err;
  Tsv t;
  Series s = {.slope = NAN};
  if (tsv_read(&t, path, &err)) err_die("%s", err.text);
  snprintf(s.label, sizeof s.label, "%s", t.label);
  const int c = tsv_column(&t, arg.column, &err);
  double *x = c < 0 ? NULL : tsv_numbers(&t, arg.column, &err);
  double *w = x ? tsv_numbers(&t, arg.weight, &err) : NULL;
  long *order = malloc(((size_t)t.rows + 1) * sizeof *order), n = 0;
  if (!w) err_die("%s", err.text);
  snprintf(s.unit, sizeof s.unit, "%s", arg.relative ? "1" : t.unit[c]);
  double sum = 0;
  for (long i = 0; i < t.rows; i++) sum += x[i], s.all += w[i];
  for (long i = 0; i < t.rows; i++) {
    const double value = arg.relative ? x[i] / sum : x[i];
    if (!isfinite(value) || (logarithmic() && value <= 0)) continue;
    x[n] = -value, w[n++] = w[i]; /* - : the sort ascends */
  }
  s.dropped = t.rows - n;
  s.x = malloc(2 * ((size_t)n + 1) * sizeof *s.x), s.w = s.x + n + 1;
  if (!order || !s.x || sort_reals(n, x, order)) err_die("out of memory");
  for (long k = arg.skip; k < n; k++) s.x[s.n] = -x[order[k]], s.w[s.n++] = w[order[k]];
  free(x), free(w), free(order), tsv_free(&t);
  return s;
}

/* d/db of the log likelihood of the density b x^-(b+1)/(low^-b - high^-b), over the number. */
static double score(double b, double mean, double span)
{
  const double e = b * span; /* span = ln(high/low); mean = <ln(x/low)> */
  if (fabs(e) < 1e-6) return span / 2 - mean - span * e / 12;
  return 1 / b - mean - span / expm1(e);
}

/* The root by bisection: the score falls with b. */
static void fit(Series *s, double low, double high)
{
  double sum = 0, a = -1, b = 1;
  long n = 0;
  for (long k = 0; k < s->n; k++)
    if (s->x[k] >= low && s->x[k] <= high) sum += log(s->x[k] / low), n++;
  s->low = low, s->high = high, s->fitted = n;
  if (n < 2 || sum <= 0) return;
  const double span = log(high / low), mean = sum / (double)n;
  while (score(a, mean, span) < 0 && a > -1e6) a *= 2;
  while (score(b, mean, span) > 0 && b < 1e6) b *= 2;
  for (int k = 0; k < 200; k++)
    if (score(0.5 * (a + b), mean, span) > 0)
      a = 0.5 * (a + b);
    else
      b = 0.5 * (a + b);
  const double h = 1e-4 * (1 + fabs(a)),
               bend = (score(a - h, mean, span) - score(a + h, mean, span)) / (2 * h);
  s->slope = a, s->error = 1 / sqrt((double)n * bend);
}

static void fit_range(const Series *s, double *low, double *high)
{
  char text[64];
  Err err;
  const char *colon = strchr(arg.fit, ':');
  if (!colon || colon - arg.fit >= (long)sizeof text)
    err_usage("--fit: '%s' is not LOW:HIGH", arg.fit);
  snprintf(text, sizeof text, "%.*s", (int)(colon - arg.fit), arg.fit);
  const char *unit = *s->unit ? s->unit : "1";
  if (unit_parse(text, unit, low, &err) || unit_parse(colon + 1, unit, high, &err))
    err_usage("--fit: %s", err.text);
  if (!(*low > 0 && *high > *low)) err_usage("--fit: 0 < LOW < HIGH must hold");
}

static void print_cumulative(const Series *s, int series)
{
  double sum = 0;
  for (long k = 0; k < s->n; k++) {
    sum += s->w[k];
    if (k + 1 < s->n && s->x[k + 1] == s->x[k]) continue; /* equal ones are one row */
    printf("%d\t%.9g\t%ld\t%.9g\n", series, s->x[k], k + 1, sum / s->all);
  }
}

/* The ends of all series' values; bins are the same for all. */
static void ends(const Series *s, int n, double *low, double *high)
{
  *low = INFINITY, *high = -INFINITY;
  for (int k = 0; k < n; k++)
    if (s[k].n) *low = fmin(*low, s[k].x[s[k].n - 1]), *high = fmax(*high, s[k].x[0]);
  if (*low == *high) {
    const double more = *low != 0 ? 1e-9 * fabs(*low) : 1e-9;
    *low -= more, *high += more;
  }
}

static double edge(long b, double low, double high)
{
  const double part = (double)b / (double)arg.bins;
  if (b == arg.bins) return high;
  return arg.linear ? low + part * (high - low) : low * pow(high / low, part);
}

static void print_bins(const Series *s, int series, double low, double high)
{
  long k = s->n; /* from the smallest on */
  for (long b = 0; b < arg.bins; b++) {
    const double from = edge(b, low, high), to = edge(b + 1, low, high);
    const double width = arg.linear ? to - from : log10(to / from);
    long count = 0;
    double sum = 0;
    for (; k > 0 && (s->x[k - 1] < to || b == arg.bins - 1); k--) count++, sum += s->w[k - 1];
    printf("%d\t%.9g\t%.9g\t%ld\t%.9g\t%.9g\n", series, from, to, count, (double)count / width,
           sum / s->all);
  }
}

static void draw(const Series *s, int n, double low, double high)
{
  Plot p;
  Err err;
  if (plot_open(&p, arg.out, 900, 650, &err)) err_die("%s", err.text);
  for (int k = 0; k < n; k++) {
    fprintf(p.script, "$s%d << EOD\n", k);
    if (arg.bins) {
      long at = s[k].n;
      for (long b = 0; b < arg.bins; b++) {
        const double from = edge(b, low, high), to = edge(b + 1, low, high);
        long count = 0;
        for (; at > 0 && (s[k].x[at - 1] < to || b == arg.bins - 1); at--) count++;
        fprintf(p.script, "%.9g %ld\n%.9g %ld\n", from, count, to, count);
      }
    } else
      for (long i = 0; i < s[k].n; i++) fprintf(p.script, "%.9g %ld\n", s[k].x[i], i + 1);
    fprintf(p.script, "%sEOD\n", s[k].n || arg.bins ? "" : "NaN NaN\n");
  }
  if (arg.title) fprintf(p.script, "set title "), plot_text(&p, arg.title);
  fprintf(p.script, "%s\nset key inside %s top\nset xlabel ", arg.title ? " noenhanced" : "",
          arg.bins ? "left" : "right");
  char label[256];
  snprintf(label, sizeof label, "%s%s [%s]", arg.column, arg.relative ? " / sum" : "", s[0].unit);
  plot_text(&p, label);
  fprintf(p.script, " noenhanced\nset ylabel '%s'\n",
          arg.bins ? "number" : "number of at least that size");
  if (logarithmic()) fprintf(p.script, "set logscale x\nset format x '10^{%%L}'\nset mxtics 10\n");
  if (!arg.bins) fprintf(p.script, "set logscale y\nset yrange [0.8:*]\n");
  if (!(low < high)) fprintf(p.script, "set xrange [1:10]\nset yrange [1:10]\n"); /* no values */
  fprintf(p.script, "plot ");
  for (int k = 0; k < n; k++) {
    fprintf(p.script, "%s$s%d using 1:2 with %s lt %d title ", k ? ", " : "", k,
            arg.bins ? "lines" : "linespoints ps 0.6", k + 1);
    plot_text(&p, s[k].label);
    if (arg.bins || isnan(s[k].slope)) continue;
    long above = 0;
    while (above < s[k].n && s[k].x[above] > s[k].high) above++;
    const double b = s[k].slope;
    fprintf(p.script,
            ", [%.9g:%.9g] %ld + %ld*(x**%.9g - %.9g)/%.9g lt %d dt 2 title 'slope %.2f +- %.2f'",
            s[k].low, s[k].high, above, s[k].fitted, -b, pow(s[k].high, -b),
            pow(s[k].low, -b) - pow(s[k].high, -b), k + 1, -b, s[k].error);
  }
  fputc('\n', p.script);
  if (plot_close(&p, &err)) err_die("%s", err.text);
}

static void print_head(const Series *s, int n)
{
  for (int k = 0; k < n; k++) {
    printf("# %d: %s: %ld values", k + 1, s[k].label, s[k].n);
    if (s[k].dropped) printf(", %ld not finite or not positive", s[k].dropped);
    if (arg.fit && isnan(s[k].slope)) printf("; too few to fit");
    if (arg.fit && !isnan(s[k].slope))
      printf("; b = %.6g +- %.2g of %ld from %.9g to %.9g", s[k].slope, s[k].error, s[k].fitted,
             s[k].low, s[k].high);
    putchar('\n');
  }
  if (!arg.bins)
    printf("# series\t%s [%s]\tnumber [1]\tshare [1]\n", arg.column, s[0].unit);
  else
    printf("# series\tfrom [%s]\tto [%s]\tcount [1]\t%s\tshare [1]\n", s[0].unit, s[0].unit,
           arg.linear ? "count_per_width" : "count_per_decade");
}

int main(int argc, char **argv)
{
  int n;
  char **input = opt_parse(&program, argc, argv, &n), *standard[] = {"-"};
  double low, high;
  if (arg.bins < 0 || arg.bins > 100000) err_usage("--bins must lie in 0..100000");
  if (arg.linear && !arg.bins && arg.fit)
    err_usage("--fit needs positive values: not with --linear");
  if (arg.skip < 0) err_usage("--skip must not be negative");
  if (arg.title && !arg.out) err_usage("--title needs --output");
  if (arg.out && !strcmp(arg.out, "-")) err_usage("--output: stdout holds the table: name a file");
  if (!n) input = standard, n = 1;
  Series *s = calloc((size_t)n, sizeof *s);
  if (!s) err_die("out of memory");
  for (int k = 0; k < n; k++) {
    s[k] = load(input[k]);
    if (strcmp(s[k].unit, s[0].unit))
      err_die("'%s' has %s in %s, '%s' in %s", s[0].label, arg.column, s[0].unit, s[k].label,
              s[k].unit);
    if (arg.fit) fit_range(&s[k], &low, &high), fit(&s[k], low, high);
  }
  ends(s, n, &low, &high);
  if (arg.out) draw(s, n, low, high);
  print_head(s, n);
  for (int k = 0; k < n; k++)
    if (arg.bins)
      print_bins(&s[k], k + 1, low, high);
    else
      print_cumulative(&s[k], k + 1);
  err_close_stdout();
  return 0;
}
