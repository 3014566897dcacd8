/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The CPU backend: memory, order, and the stamps of the per-particle passes. The pair loops are in
 * loops.c, the reductions in reduce.c; tree, search and gravity are the library's. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <omp.h>
#include "../../lib/hilbert.h"
#include "../recoil.h"
#include "cpu.h"

/* alloc: the arrays of the state that this run needs, zeroed; -1 for lack of memory. */
static int alloc_state(Sim *sim)
{
  State *s = &sim->s;
  size_t n = (size_t)s->n;
  int bad = 0;
#define CPU_ALLOC(TYPE, MEMBER, WIDTH, ...)                                                        \
  if (!backend_idle(sim, #MEMBER)) bad |= !(s->MEMBER = calloc(n ? n * (WIDTH) : 1, sizeof(TYPE)));
  ALL_FIELDS(CPU_ALLOC)
  MOVED_FIELDS(CPU_ALLOC)
  WORK_FIELDS(CPU_ALLOC)
#undef CPU_ALLOC
  for (int k = 0; k < sim->slots; k++) {
#define CPU_SLOT(MEMBER, WIDTH)                                                                    \
  if (!backend_idle(sim, #MEMBER))                                                                 \
    bad |= !(s->saved[k].MEMBER = calloc(n ? n * (WIDTH) : 1, sizeof(double)));
    SAVED_FIELDS(CPU_SLOT)
#undef CPU_SLOT
  }
  return bad ? -1 : 0;
}

static void free_state(State *s)
{
#define CPU_FREE(TYPE, MEMBER, ...) free(s->MEMBER);
  ALL_FIELDS(CPU_FREE)
  MOVED_FIELDS(CPU_FREE)
  WORK_FIELDS(CPU_FREE)
#undef CPU_FREE
  for (int k = 0; k < STATE_SLOTS; k++) {
#define CPU_FREE_SLOT(MEMBER, WIDTH) free(s->saved[k].MEMBER);
    SAVED_FIELDS(CPU_FREE_SLOT)
#undef CPU_FREE_SLOT
  }
}

/* The particles' own data into the state; what the file lacks stays zero. */
static int fill(Sim *sim, const Parts *p, Err *err)
{
  State *s = &sim->s;
  Cpu *c = sim->own;
  size_t n = (size_t)s->n;
  int64_t at = 0;
#define CPU_COPY(TYPE, MEMBER, WIDTH, ...)                                                         \
  if (p->MEMBER && s->MEMBER) memcpy(s->MEMBER, p->MEMBER, n *(WIDTH) * sizeof(TYPE));
  ALL_FIELDS(CPU_COPY)
#undef CPU_COPY
  for (long i = 0; i < s->n; i++) {
    s->row[i] = i;
    s->flaw0[i] = at;
    s->nflaw[i] = p->nflaw ? p->nflaw[i] : 0;
    at += s->nflaw[i];
  }
  c->flaw = malloc(sizeof(double) * (size_t)(at ? at : 1));
  if (!c->flaw) return err_set(err, "not enough memory for %lld flaws", (long long)at);
  if (at) memcpy(c->flaw, p->flaw, sizeof(double) * (size_t)at);
  s->flaw = c->flaw;
  return 0;
}

static void cpu_close(Sim *sim)
{
  Cpu *c = sim->own;
  if (!c) return;
  tree_free(&c->tree);
  ngb_free(&c->ngb);
  free(c->order), free(c->record), free(c->scratch), free(c->flaw), free(sim->s.image);
  free(c);
  sim->own = NULL;
  free_state(&sim->s);
  memset(&sim->s, 0, sizeof sim->s);
}

static int cpu_open(Sim *sim, const Parts *p, Err *err)
{
  Cpu *c = calloc(1, sizeof *c);
  size_t n = (size_t)p->n;
  if (!c) return err_set(err, "not enough memory");
  sim->own = c;
  snprintf(sim->about, sizeof sim->about, "cpu, %d threads", omp_get_max_threads());
  memset(&sim->s, 0, sizeof sim->s);
  sim->s.n = sim->s.all = sim->s.room = p->n;
  sim->s.bounds = sim->bounds;
  sim->s.dimension = p->dimension;
  sim->s.rare = sim->rare;
  backend_range(sim);
  sim->s.material = sim->material;
  c->order = malloc((n + 1) * sizeof *c->order);
  c->record = malloc((n + 1) * CPU_RECORD * sizeof(double));
  c->share = (n + 1) * 9 * sizeof(double);
  c->scratch = malloc(c->share * (size_t)omp_get_max_threads());
  c->run = backend_pair(sim, p->dimension);
  if (!c->order || !c->record || !c->scratch || alloc_state(sim)) {
    cpu_close(sim);
    return err_set(err, "not enough memory for %ld particles", p->n);
  }
  if (fill(sim, p, err)) return cpu_close(sim), -1;
  return 0;
}

static int cpu_store(Sim *sim, Parts *p, Err *err)
{
  const State *s = &sim->s;
  (void)err;
#define CPU_STORE(TYPE, MEMBER, WIDTH, ...)                                                        \
  for (long i = 0; p->MEMBER && s->MEMBER && i < s->n; i++)                                        \
    memcpy(p->MEMBER + s->row[i] * (WIDTH), s->MEMBER + i * (WIDTH), sizeof(TYPE) * (WIDTH));
  ALL_FIELDS(CPU_STORE)
#undef CPU_STORE
  return 0;
}

/* The arrays that move with their particles, as bytes. */
typedef struct {
  char *array;
  size_t size; /* bytes a particle */
} Column;

enum { COLUMNS = 128 };

static int columns_of(const Sim *sim, Column column[COLUMNS])
{
  const State *s = &sim->s;
  int n = 0;
#define CPU_COLUMN(TYPE, MEMBER, WIDTH, ...)                                                       \
  if (s->MEMBER) column[n].array = (char *)s->MEMBER, column[n++].size = sizeof(TYPE) * (WIDTH);
  ALL_FIELDS(CPU_COLUMN)
  MOVED_FIELDS(CPU_COLUMN)
#undef CPU_COLUMN
  for (int slot = 0; slot < sim->slots; slot++) {
#define CPU_SLOT_COLUMN(MEMBER, WIDTH)                                                             \
  if (s->saved[slot].MEMBER)                                                                       \
    column[n].array = (char *)s->saved[slot].MEMBER, column[n++].size = sizeof(double) * (WIDTH);
    SAVED_FIELDS(CPU_SLOT_COLUMN)
#undef CPU_SLOT_COLUMN
  }
  return n;
}

/* Everything into the new order, one array per thread at a time. */
static void reorder_all(Sim *sim)
{
  const Cpu *c = sim->own;
  Column column[COLUMNS];
  long n = sim->s.n, k = 0;
  int columns = columns_of(sim, column);
  while (k < n && c->order[k] == k) k++;
  if (k == n) return;
#pragma omp parallel for schedule(dynamic, 1)
  for (int a = 0; a < columns; a++) {
    char *from = column[a].array,
         *to = (char *)c->scratch + (size_t)omp_get_thread_num() * c->share;
    size_t size = column[a].size;
    for (long i = 0; i < n; i++)
      memcpy(to + (size_t)i * size, from + (size_t)c->order[i] * size, size);
    memcpy(from, to, (size_t)n * size);
  }
}

static int cpu_search(Sim *sim, Err *err)
{
  Cpu *c = sim->own;
  State *s = &sim->s;
  double *reach; /* the larger of both h: at x a pair has h, at y ha */
  int bad;
  backend_begin(sim, TIMER_ORDER);
  /* Errors of the tree that stay the same from step to step pull a body as a whole: another cube
   * every few steps keeps them from adding up. */
  c->tree.shift = hilbert_shift(sim->step);
  bad = cpu_images_find(sim, err);
  c->tree.split = s->all > s->n ? s->n : 0;
  bad = bad || tree_order_parts(s->all, c->tree.split, s->x, s->id, c->tree.shift, c->order, err);
  if (!bad) reorder_all(sim);
  bad = bad || cpu_images_order(sim, err);
  reach = c->record;
  for (long i = 0; i < s->all; i++)
    reach[i] = (1 + s->margin) * (s->ha[i] > s->h[i] ? s->ha[i] : s->h[i]);
  bad = bad || tree_build(&c->tree, s->all, s->x, s->m, reach, err);
  backend_end(sim, TIMER_ORDER);
  if (bad) return -1;
  backend_begin(sim, TIMER_SEARCH);
  bad = ngb_search(&c->ngb, &c->tree, s->x, s->y, reach, 1, err);
  backend_end(sim, TIMER_SEARCH);
  return bad;
}

/* Force and torque that the tree's errors leave over are taken off (recoil.h). */
static void take_recoil(const State *s)
{
  RecoilForce force;
  RecoilTorque torque;
  memset(&force, 0, sizeof force), memset(&torque, 0, sizeof torque);
  for (long i = 0; i < s->n; i++) recoil_add_force(&force, s->m[i], &s->x[3 * i], &s->pull[3 * i]);
  Recoil off = recoil_mean(&force);
  for (long i = 0; i < s->n; i++)
    recoil_add_torque(&torque, &off, s->m[i], &s->x[3 * i], &s->pull[3 * i]);
  recoil_turn(&off, &torque);
  for (long i = 0; i < s->n; i++) recoil_take(&off, &s->x[3 * i], &s->pull[3 * i]);
}

/* pull and phi at x. */
static int pull(Sim *sim, Err *err)
{
  Cpu *c = sim->own;
  const State *s = &sim->s;
  const Param *p = &sim->par;
  const GravityOptions o = {p->theta, p->G, p->precision == PARAM_MIXED, p->softening, p->epsilon};
  if (s->pull0) memcpy(s->pull0, s->pull, 3 * (size_t)s->n * sizeof *s->pull);
  if (sim->par.gravity == PARAM_DIRECT)
    return gravity_direct(s->n, s->x, s->m, s->h, &o, s->pull, s->phi, err);
  if (gravity_tree(&c->tree, s->x, s->m, s->h, &o, s->pull, s->phi, err)) return -1;
  take_recoil(s);
  return 0;
}

static int cpu_gravity(Sim *sim, Err *err)
{
  const State *s = &sim->s;
  const int pulls = sim->par.gravity != PARAM_NONE;
  int bad;
  if (!pulls && !sim->points.n) return 0;
  backend_begin(sim, TIMER_GRAVITY);
  bad = pulls && sim->pull_due && pull(sim, err);
  for (long i = 0; i < 3 * s->n && pulls && !bad; i++) s->acc[i] += s->pull[i];
  bad = bad || points_exchange(sim, err);
  backend_end(sim, TIMER_GRAVITY);
  return bad ? -1 : 0;
}

/* The stamps of the per-particle passes. */
static void cpu_pass(Sim *sim, int pass, const Step *step)
{
  const State *s = &sim->s;
  points_pass(sim, pass, step);
  backend_begin(sim, TIMER_LOCAL);
  switch (pass) {
#define CPU_PASS(CAPITAL, NAME)                                                                    \
  case PASS_##CAPITAL:                                                                             \
    _Pragma("omp parallel for schedule(static)") for (long i = 0; i < s->n; i++)                   \
        pass_##NAME(s, step, i);                                                                   \
    break;
    PASSES(CPU_PASS)
#undef CPU_PASS
  default: break;
  }
  backend_end(sim, TIMER_LOCAL);
}

static int cpu_leaving(Sim *sim, const Leave *test, long *count, Err *err)
{
  const State *s = &sim->s;
  long sum = 0;
  (void)err;
#pragma omp parallel for schedule(static) reduction(+ : sum)
  for (long i = 0; i < s->n; i++) sum += leave_where(test, s, i) != LEAVE_STAYS;
  *count = sum;
  return 0;
}

static int cpu_keep(Sim *sim, const uint32_t *kept, long n, Err *err)
{
  Column column[COLUMNS];
  const int columns = columns_of(sim, column);
  (void)err;
  for (int a = 0; a < columns; a++)
    for (long i = 0; i < n; i++)
      memmove(column[a].array + (size_t)i * column[a].size,
              column[a].array + (size_t)kept[i] * column[a].size, column[a].size);
  sim->s.n = sim->s.all = n;
  return 0;
}

/* cpu_store leaves nothing to do. */
static int cpu_fetch(Sim *sim, Parts *p, Err *err)
{
  (void)sim, (void)p, (void)err;
  return 0;
}

static int cpu_copy(Sim *sim, void *to, const void *from, size_t bytes, Err *err)
{
  (void)sim, (void)err;
  memcpy(to, from, bytes);
  return 0;
}

static int cpu_cards(void) { return 1; }

/* clang-format off */
const struct backend backend_cpu = {
  "cpu", cpu_cards, cpu_open, cpu_close, cpu_store, cpu_fetch, cpu_copy, cpu_search, cpu_pass,
  cpu_gradient, cpu_density, cpu_force, cpu_gravity, cpu_leaving, cpu_keep, cpu_points, cpu_limits, cpu_sums, cpu_bodies,
  cpu_change, cpu_error};
/* clang-format on */
