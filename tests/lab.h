/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What tests of the solver share: particles made in memory, runs without files. Every failure to
 * set up fails the test. */
#ifndef LAB_H
#define LAB_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "../lib/part.h"
#include "../solver/sim.h"

#define LAB_PI 3.14159265358979323846

/* lab_parts: n particles of one material, at rest, ids 0..n-1, all else zero. */
static inline Parts *lab_parts(long n, int dimension, const char *material)
{
  Err err;
  Parts *p = part_new(n);
  assert_non_null(p);
  p->dimension = dimension;
  assert_return_code(part_add(p, "id x v m rho u h mat body", &err), 0);
  assert_true(part_add_material(p, "stuff", material, &err) == 0);
  for (long i = 0; i < n; i++) p->id[i] = i;
  return p;
}

/* lab_param: defaults, then the settings given as "key=value", ended by NULL. */
static inline Param lab_param(const char *first, ...)
{
  Param par;
  Err err;
  va_list args;
  param_defaults(&par);
  va_start(args, first);
  for (const char *s = first; s; s = va_arg(args, const char *))
    if (param_set(&par, s, &err)) fail_msg("%s", err.text);
  va_end(args);
  return par;
}

/* lab_set: more settings, a space between two; NULL: none. */
static inline void lab_set(Param *par, const char *settings)
{
  char copy[1024], *rest = copy;
  Err err;
  snprintf(copy, sizeof copy, "%s", settings ? settings : "");
  for (char *word; (word = strtok_r(rest, " ", &rest));)
    if (param_set(par, word, &err)) fail_msg("%s", err.text);
}

/* lab_device: where the tests run: BRECCIA_TEST_DEVICE, or cpu. */
static inline const char *lab_device(void)
{
  const char *device = getenv("BRECCIA_TEST_DEVICE");
  return device ? device : "cpu";
}

static inline void lab_open(Sim *sim, const Param *par, const Parts *p)
{
  Err err;
  if (sim_open(sim, par, p, lab_device(), &err)) fail_msg("%s", err.text);
}

/* lab_run: to time `until`; returns the number of steps. */
static inline long lab_run(Sim *sim, double until)
{
  Err err;
  SimStep done;
  long first = sim->step;
  while (sim->time < until)
    if (sim_advance(sim, until, &done, &err)) fail_msg("%s", err.text);
  return sim->step - first;
}

static inline void lab_store(Sim *sim, Parts *p)
{
  Err err;
  if (sim_store(sim, p, &err)) fail_msg("%s", err.text);
}

static inline void lab_sums(Sim *sim, Sums *out)
{
  Err err;
  if (sim_sums(sim, out, &err)) fail_msg("%s", err.text);
}

/* lab_state: the State as it is now, its arrays on the host, wherever the backend has them;
 * lab_keep: these arrays back; lab_forget: freed. */
static inline State lab_state(Sim *sim)
{
  State s = sim->s;
  const size_t n = (size_t)s.n;
  Err err;
#define LAB_DOWN(TYPE, MEMBER, WIDTH, ...)                                                         \
  s.MEMBER = sim->s.MEMBER ? calloc(n * (WIDTH), sizeof(TYPE)) : NULL;                             \
  if (s.MEMBER && sim->b->copy(sim, s.MEMBER, sim->s.MEMBER, n * (WIDTH) * sizeof(TYPE), &err))    \
    fail_msg("%s", err.text);
  ALL_FIELDS(LAB_DOWN)
  MOVED_FIELDS(LAB_DOWN)
  WORK_FIELDS(LAB_DOWN)
#undef LAB_DOWN
  s.material = sim->material, s.flaw = NULL;
  return s;
}

static inline void lab_keep(Sim *sim, const State *s)
{
  const size_t n = (size_t)s->n;
  Err err;
#define LAB_UP(TYPE, MEMBER, WIDTH, ...)                                                           \
  if (s->MEMBER && sim->b->copy(sim, sim->s.MEMBER, s->MEMBER, n * (WIDTH) * sizeof(TYPE), &err))  \
    fail_msg("%s", err.text);
  ALL_FIELDS(LAB_UP)
  MOVED_FIELDS(LAB_UP)
  WORK_FIELDS(LAB_UP)
#undef LAB_UP
}

static inline void lab_forget(State *s)
{
#define LAB_FREE(TYPE, MEMBER, ...) free(s->MEMBER);
  ALL_FIELDS(LAB_FREE)
  MOVED_FIELDS(LAB_FREE)
  WORK_FIELDS(LAB_FREE)
#undef LAB_FREE
}

/* lab_lattice: positions of a cubic lattice of spacing dx whose points satisfy inside(x, data);
 * counts when x is NULL. */
static inline long lab_lattice(double dx, int half, int dimension,
                               int (*inside)(const double *x, void *data), void *data, double *x)
{
  long n = 0;
  int hy = dimension > 1 ? half : 0, hz = dimension > 2 ? half : 0;
  for (int a = -half; a <= half; a++)
    for (int b = -hy; b <= hy; b++)
      for (int c = -hz; c <= hz; c++) {
        double q[3] = {a * dx, b * dx, c * dx};
        if (!inside(q, data)) continue;
        if (x) memcpy(x + 3 * n, q, sizeof q);
        n++;
      }
  return n;
}

#endif
