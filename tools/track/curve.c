/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "curve.h"
#include "lib/plot.h"

/* X(name, unit, value) of a CurvePoint *p; what is averaged at the end. */
/* clang-format off */
#define COLUMNS(X) \
  X("M", "kg", p->total) X("M_held", "kg", p->held) X("M_1", "kg", p->mass[0]) X("M_2", "kg", p->mass[1]) \
  X("M_3", "kg", p->mass[2]) X("M_4", "kg", p->mass[3]) X("M_5", "kg", p->mass[4]) \
  X("M_1/M", "1", p->mass[0]/p->total) X("M_2/M", "1", p->mass[1]/p->total) X("xi", "1", p->xi) \
  X("E_th", "J", p->u) X("heating", "1", p->heating)
/* clang-format on */

/* Mass of a group that comes from body b [kg]. */
static double from(const Group *g, const Parts *p, int b)
{
  double sum = 0;
  for (int c = 0; c < p->materials && b < g->bodies; c++) sum += g->part[c * g->bodies + b];
  return sum;
}

int curve_add(Curve *c, double time, const Group *system, const Group *g, long n, const Parts *p,
              Err *err)
{
  void *more = realloc(c->point, (size_t)(c->n + 1) * sizeof *c->point);
  if (!more) return err_set(err, "out of memory for %ld dumps", c->n + 1);
  c->point = more;
  CurvePoint *q = &c->point[c->n++];
  *q = (CurvePoint){.time = time, .total = system->mass, .objects = n, .xi = NAN};
  for (long k = 0; k < n; k++) {
    q->held += g[k].mass;
    if (k < CURVE_TOP) q->mass[k] = g[k].mass;
  }
  const double target = from(system, p, 0), impactor = from(system, p, 1);
  if (impactor > 0 && n > 0) q->xi = (g[0].mass - target) / impactor;
  const double v = part_number(p, "collision", "ContactSpeed");
  q->u = system->e_th;
  q->heating = (q->u - c->point[0].u) / (0.5 * target * impactor / (target + impactor) * v * v);
  return 0;
}

void curve_free(Curve *c) { free(c->point); }

/* The first point of the last tenth. */
static long last_tenth(const Curve *c)
{
  const double end = c->point[c->n - 1].time, begin = end - 0.1 * (end - c->point[0].time);
  long k = c->n - 1;
  while (k > 0 && (c->point[k - 1].time >= begin || k == c->n - 1)) k--;
  return k;
}

static void statistics(FILE *f, const Curve *c, int deviation)
{
  const long first = last_tenth(c), n = c->n - first;
#define STATISTIC(NAME, UNIT, VALUE)                                                               \
  {                                                                                                \
    double mean = 0, sum = 0;                                                                      \
    for (const CurvePoint *p = c->point + first; p < c->point + c->n; p++) mean += (VALUE);        \
    mean /= (double)n;                                                                             \
    for (const CurvePoint *p = c->point + first; p < c->point + c->n; p++)                         \
      sum += ((VALUE)-mean) * ((VALUE)-mean);                                                      \
    const double value = deviation ? sqrt(sum / (double)(n > 1 ? n - 1 : 1)) : mean;               \
    fprintf(f, isnan(value) ? "\tnan" : "\t%.9g", value);                                          \
  }
  COLUMNS(STATISTIC)
#undef STATISTIC
  fputc('\n', f);
}

int curve_write(const char *path, const Curve *c, Err *err)
{
  char *text = NULL;
  size_t size;
  FILE *f = open_memstream(&text, &size);
  if (!f) return err_set(err, "cannot write '%s': out of memory", path);
  fprintf(f, "# mean and standard deviation over %ld dumps from %.9g s on\n# mean\t",
          c->n - last_tenth(c), c->point[last_tenth(c)].time);
  statistics(f, c, 0);
  fputs("# deviation\t", f), statistics(f, c, 1);
  fputs("# time [s]\tobjects [1]", f);
#define HEAD(NAME, UNIT, VALUE) fputs("\t" NAME " [" UNIT "]", f);
  COLUMNS(HEAD)
#undef HEAD
  fputc('\n', f);
  for (const CurvePoint *p = c->point; p < c->point + c->n; p++) {
    fprintf(f, "%.9g\t%ld", p->time, p->objects);
#define CELL(NAME, UNIT, VALUE) fprintf(f, isnan(VALUE) ? "\tnan" : "\t%.9g", VALUE);
    COLUMNS(CELL)
#undef CELL
    fputc('\n', f);
  }
  int failed = fclose(f) ? err_set(err, "cannot write '%s': out of memory", path)
                         : spool_text(path, text, err);
  free(text);
  return failed;
}

int curve_draw(const char *path, const Curve *c, const char *title, Err *err)
{
  Plot p;
  if (plot_open(&p, path, 900, 600, err)) return -1;
  fprintf(p.script, "$d << EOD\n");
  for (const CurvePoint *q = c->point; q < c->point + c->n; q++) {
    fprintf(p.script, "%.9g %.9g", q->time / 3600, q->held / q->total);
    for (int k = 0; k < CURVE_TOP; k++)
      fprintf(p.script, " %.9g", q->mass[k] > 0 ? q->mass[k] / q->total : NAN);
    fputc('\n', p.script);
  }
  fprintf(p.script, "EOD\n");
  if (title)
    fprintf(p.script, "set title "), plot_text(&p, title), fprintf(p.script, " noenhanced\n");
  fprintf(p.script, "set xlabel 'time [h]'\nset ylabel 'mass / total'\nset logscale y\n"
                    "set format y '10^{%%L}'\nset yrange [*:1.2]\nset autoscale xfix\n"
                    "plot $d using 1:2 with lines lt 8 title 'in all objects'");
  for (int k = 0; k < CURVE_TOP; k++) {
    long some = 0;
    for (long q = 0; q < c->n; q++) some += c->point[q].mass[k] > 0;
    if (some)
      fprintf(p.script, ", '' using 1:%d with linespoints ps 0.4 lt %d title 'M_%d'", k + 3, k + 1,
              k + 1);
  }
  fputc('\n', p.script);
  return plot_close(&p, err);
}
