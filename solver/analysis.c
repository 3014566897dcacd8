/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A line is written, read again, and only then counted. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "../lib/clump.h"
#include "../lib/group.h"
#include "../lib/pointmass.h"
#include "analysis.h"

static const char HEADER[] =
    "# step\ttime[s]\tk_vir[1]\tbodies\tM[kg]\tM_bound[kg]\tM_1[kg]\tM_2[kg]"
    "\tM_3[kg]\tn_1\tn_2\tn_3\n";

/* What is due now is at most this much of analysis.every away: multiples that are also an output's
 * time may differ in the last digit. */
#define CLOSE 1e-9

static void masses(AnalysisRow *row, const Parts *p, const long *start, const long *list)
{
  for (long c = 1; c <= row->bodies; c++) {
    double sum = 0;
    long points = 0;
    for (long k = start[c]; k < start[c + 1]; k++)
      sum += p->m[list[k]], points += pointmass_row(p, list[k]);
    row->bound += sum;
    if (c <= ANALYSIS_TOP) row->mass[c - 1] = sum, row->n[c - 1] = start[c + 1] - start[c] - points;
  }
}

static int measure(AnalysisRow *row, const Param *par, const Parts *p, Err *err)
{
  const ClumpOptions o = {par->analysis_method, (ClumpLevel)par->analysis_criterion,
                          par->analysis_link, par->analysis_theta, par->analysis_least};
  int32_t *id = calloc((size_t)p->n + 1, sizeof *id);
  double *phi = malloc(((size_t)p->n + 1) * sizeof *phi);
  long *start, *list;
  Group all;
  *row = (AnalysisRow){.time = p->time, .bound = NAN, .mass = {NAN, NAN, NAN}};
  int failed = !id || !phi ? err_set(err, "not enough memory for bound.tsv")
                           : group_system(&all, p, par->analysis_theta, err);
  if (!failed) {
    row->total = all.mass, row->virial = -2 * all.e_kin / all.e_pot;
    group_free(&all);
  }
  if (!failed && !(par->analysis_virial > 0 && row->virial > par->analysis_virial)) {
    row->bodies = clump_find(p, &o, id, phi, err);
    failed = row->bodies < 0 || group_lists(p, id, row->bodies, &start, &list, err) ? -1 : 0;
    row->bound = 0, memset(row->mass, 0, sizeof row->mass);
    if (!failed) masses(row, p, start, list), free(start), free(list);
  }
  free(id), free(phi);
  return failed;
}

/* A copy of the particles with a row for each point mass. */
static Parts *with_points(const Parts *p, Err *err)
{
  unsigned char *all = malloc((size_t)p->n + 1);
  if (!all) return err_null(err, "not enough memory for bound.tsv");
  memset(all, 1, (size_t)p->n + 1);
  Parts *q = part_select(p, all, err);
  free(all);
  if (q && pointmass_rows(q, err)) part_free(q), q = NULL;
  return q;
}

int analysis_measure(AnalysisRow *row, const Param *par, const Parts *parts, Err *err)
{
  Parts *with = NULL;
  if (parts->points && par->analysis_points && !(with = with_points(parts, err))) return -1;
  const int failed = measure(row, par, with ? with : parts, err);
  part_free(with);
  return failed;
}

/* A line of the table back into a row; returns whether it is one. */
static int parse(const char *line, AnalysisRow *r)
{
  return sscanf(line, "%ld %lf %lf %ld %lf %lf %lf %lf %lf %ld %ld %ld", &r->step, &r->time,
                &r->virial, &r->bodies, &r->total, &r->bound, &r->mass[0], &r->mass[1], &r->mass[2],
                &r->n[0], &r->n[1], &r->n[2]) == 12;
}

static void count(Analysis *a, const Param *par, const AnalysisRow *row)
{
  if (row->time >= par->analysis_after) a->last[a->lines++ % par->analysis_window] = *row;
}

static int prepare(Analysis *a, const Output *o, const Sim *sim, long step, Err *err)
{
  const Param *par = &sim->par;
  *a = (Analysis){.start = o->start};
  if (!(par->analysis_every > 0)) return 0;
  a->last = calloc((size_t)par->analysis_window, sizeof *a->last);
  if (!a->last) return err_set(err, "not enough memory");
  return output_table(o, "bound.tsv", HEADER, step, &a->table, err);
}

int analysis_open(Analysis *a, const Output *o, const Sim *sim, Err *err)
{
  return prepare(a, o, sim, -1, err);
}

int analysis_resume(Analysis *a, const Output *o, const Sim *sim, Err *err)
{
  const Param *par = &sim->par;
  char *line = NULL;
  size_t room = 0;
  AnalysisRow row;
  if (prepare(a, o, sim, sim->step, err)) return -1;
  if (!a->table) return 0;
  rewind(a->table);
  while (getline(&line, &room, a->table) > 0)
    if (line[0] != '#' && parse(line, &row)) count(a, par, &row);
  free(line);
  a->next = (long)floor((sim->time - a->start) / par->analysis_every + CLOSE) + 1;
  return 0;
}

void analysis_close(Analysis *a)
{
  if (a->table) fclose(a->table);
  free(a->last);
  *a = (Analysis){0};
}

int analysis_due(const Analysis *a, const Sim *sim)
{
  const double every = sim->par.analysis_every;
  return a->table && sim->time >= a->start + ((double)a->next - CLOSE) * every;
}

int analysis_line(Analysis *a, const Sim *sim, const Parts *parts, Err *err)
{
  AnalysisRow r, written;
  char line[512];
  if (analysis_measure(&r, &sim->par, parts, err)) return -1;
  snprintf(line, sizeof line, "%ld\t%.9g\t%.6g\t%ld\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\t%ld\t%ld\t%ld\n",
           sim->step, r.time, r.virial, r.bodies, r.total, r.bound, r.mass[0], r.mass[1], r.mass[2],
           r.n[0], r.n[1], r.n[2]);
  if (fputs(line, a->table) == EOF || fflush(a->table))
    return err_set(err, "cannot write 'bound.tsv': %s", strerror(errno));
  if (parse(line, &written)) count(a, &sim->par, &written);
  a->next = (long)floor((sim->time - a->start) / sim->par.analysis_every + CLOSE) + 1;
  return 0;
}

int analysis_converged(const Analysis *a, const Param *par)
{
  if (!a->table || !(par->analysis_converged > 0) || a->lines < par->analysis_window) return 0;
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {0};
  for (int k = 0; k < par->analysis_window; k++) {
    const AnalysisRow *r = &a->last[k];
    const double value[3] = {r->bound, r->mass[0], r->mass[1]};
    for (int q = 0; q < 3; q++) {
      if (!(value[q] >= 0)) return 0; /* not searched */
      low[q] = fmin(low[q], value[q]), high[q] = fmax(high[q], value[q]);
    }
  }
  for (int q = 0; q < 3; q++)
    if (high[q] - low[q] > par->analysis_converged * a->last[0].total) return 0;
  return 1;
}
