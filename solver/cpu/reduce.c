/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reductions: sums are taken in blocks of fixed size, then over the blocks in order, so that the
 * result does not depend on the number of threads; minima break ties by id. */
#include <stdlib.h>
#include <string.h>
#include "../reduce.h"
#include "cpu.h"

enum { BLOCK = 1024 };

int cpu_sums(Sim *sim, Sums *out, Err *err)
{
  const State *s = &sim->s;
  long blocks = (s->n + BLOCK - 1) / BLOCK;
  ReduceSums *part = calloc((size_t)(blocks ? blocks : 1), sizeof *part), all = {{0}};
  if (!part) return err_set(err, "not enough memory");
#pragma omp parallel for schedule(static)
  for (long b = 0; b < blocks; b++)
    for (long i = b * BLOCK; i < s->n && i < (b + 1) * BLOCK; i++) reduce_add_sums(&part[b], s, i);
  for (long b = 0; b < blocks; b++) reduce_merge_sums(&all, &part[b]);
  free(part);
  reduce_sums(&all, out);
  return 0;
}

int cpu_limits(Sim *sim, const Step *step, Limits *out, Err *err)
{
  const State *s = &sim->s;
  (void)err;
  backend_begin(sim, TIMER_REDUCE);
  *out = reduce_no_limits();
#pragma omp parallel
  {
    Limits mine = reduce_no_limits();
#pragma omp for schedule(static) nowait
    for (long i = 0; i < s->n; i++) reduce_add_limits(&mine, s, step, i, step->limited);
#pragma omp critical
    reduce_merge_limits(out, &mine);
  }
  backend_end(sim, TIMER_REDUCE);
  return 0;
}

int cpu_bodies(Sim *sim, Step *step, Err *err)
{
  const State *s = &sim->s;
  ReduceMotion motion[BODIES];
  ReduceSpin spin[BODIES];
  (void)err;
  memset(motion, 0, sizeof motion), memset(spin, 0, sizeof spin);
  for (long i = 0; i < s->n; i++) reduce_add_motion(&motion[reduce_body(s, i)], s, i);
  for (int b = 0; b < BODIES; b++) reduce_motion(&motion[b], step->centre[b], step->velocity[b]);
  for (long i = 0; i < s->n; i++) {
    const int b = reduce_body(s, i);
    reduce_add_spin(&spin[b], s, step->centre[b], step->velocity[b], i);
  }
  for (int b = 0; b < BODIES; b++) reduce_spin(&spin[b], step->omega[b]);
  return 0;
}

int cpu_error(Sim *sim, const Step *step, double *worst, Err *err)
{
  const State *s = &sim->s;
  double most = 0;
  (void)err;
#pragma omp parallel for reduction(max : most)
  for (long i = 0; i < s->n; i++) {
    const double e = reduce_error(s, step, i);
    most = e > most ? e : most;
  }
  *worst = most;
  return 0;
}

int cpu_points(Sim *sim, const PointField *field, PointReaction *reaction, Err *err)
{
  const State *s = &sim->s;
  const long blocks = (s->n + BLOCK - 1) / BLOCK;
  PointReaction *part = calloc((size_t)(blocks * field->n) + 1, sizeof *part);
  if (!part) return err_set(err, "not enough memory");
#pragma omp parallel for schedule(static)
  for (long b = 0; b < blocks; b++)
    for (long i = b * BLOCK; i < s->n && i < (b + 1) * BLOCK; i++) {
      points_pull(field, &s->x[3 * i], &s->acc[3 * i]);
      for (int k = 0; k < field->n; k++)
        points_react(&part[b * field->n + k], &field->at[k], s->m[i], &s->x[3 * i]);
    }
  memset(reaction, 0, (size_t)field->n * sizeof *reaction);
  for (long b = 0; b < blocks; b++)
    for (int k = 0; k < field->n; k++) points_merge(&reaction[k], &part[b * field->n + k]);
  free(part);
  return 0;
}

int cpu_change(Sim *sim, double *relative, Err *err)
{
  const State *s = &sim->s;
  ReduceChange all = {0, 0, 0};
  (void)err;
  for (long i = 0; i < s->n; i++) reduce_add_change(&all, s, i);
  *relative = reduce_change(&all);
  return 0;
}
