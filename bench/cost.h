/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What each pass must move and do for a particle, whoever does it, and how long an H200 takes for
 * that at least: the table that all benches of a card print. Counts: 57 neighbours; other theta
 * than 0.7 makes gravity another. */
#ifndef COST_H
#define COST_H

#include <math.h>
#include <stdio.h>
#include "solver/profile.h"

/* An H200 SXM: 132 multiprocessors at 1.98 GHz, each 128 fused operations in single and 64 in
 * double precision and one line of L1 a clock; device memory as a copy on it measured. */
#define COST_CLOCK      (132 * 1.98e9)         /* clocks of all multiprocessors a second */
#define COST_SINGLE     (COST_CLOCK * 128 * 2) /* flop/s */
#define COST_DOUBLE     (COST_CLOCK * 64 * 2)  /* flop/s */
#define COST_MEMORY     4.3e12                 /* B/s */
#define COST_NEIGHBOURS 57                     /* in a support */
#define COST_LIST       (4 * COST_NEIGHBOURS)  /* B of a list */
/* Lines of L1 for one record of 16 bytes of all neighbours: a warp makes 64 gathers (its longest
 * list) of 13.6 lines each, measured in Hilbert order. */
#define COST_GATHER (64 * 13.6 / 32)

/* Of a particle: bytes from and to device memory, flops and at which peak [flop/s], lines of L1. */
typedef struct {
  double bytes, flops, peak, lines;
} Cost;

/* Sort of a key of 8 bytes and an index of 4, a byte of the key at a time (two levels more than
 * would tell n particles apart), after one look at the keys; then the whole state in and out. */
static inline Cost cost_order(const Sim *sim)
{
  const State *s = &sim->s;
  double passes = ceil((log2((double)s->n) + 6) / 8), state = 0;
#define COST_ARRAY(TYPE, MEMBER, WIDTH, ...) state += s->MEMBER ? sizeof(TYPE) * (WIDTH) : 0;
  ALL_FIELDS(COST_ARRAY)
  MOVED_FIELDS(COST_ARRAY)
#undef COST_ARRAY
  Cost c = {passes * 2 * (8 + 4) + 8 + 2 * state, 0, COST_DOUBLE, 0};
  return c;
}

/* x, y, h, m in; points in single precision out; 0.3 nodes of 224 bytes. */
static inline Cost cost_tree(void)
{
  Cost c = {8 * 8 + 48 + 0.3 * 224, 0, COST_SINGLE, 0};
  return c;
}

/* A pair loop that reads so many numbers of each neighbour, and of its own particle so many doubles
 * in and out; the neighbours' records are written and read once. */
static inline Cost cost_loop(const Sim *sim, int numbers, double flops, int own)
{
  const int wide = sim->par.precision == PARAM_DOUBLE, size = wide ? 8 : 4;
  const double records = ceil(numbers * size / 16.);
  Cost c = {COST_LIST + 8 * own + 2 * 16 * records, COST_NEIGHBOURS * flops,
            wide ? COST_DOUBLE : COST_SINGLE, COST_GATHER * records};
  return c;
}

/* x, m, h in, pull and phi out, acc in and out. The tree: 766 quadrupoles of 65 and 629 particles
 * of 23 flops in two touching spheres at theta 0.7. */
static inline Cost cost_gravity(const Sim *sim)
{
  const double every = sim->par.gravity_every > 1 ? sim->par.gravity_every : 1;
  const double flops =
      sim->par.gravity == PARAM_DIRECT ? 23. * (double)sim->s.n : 766 * 65 + 629 * 23;
  Cost c = {8 * (5 + 4) / every + 8 * 6, flops / every,
            sim->par.precision == PARAM_DOUBLE ? COST_DOUBLE : COST_SINGLE, 0};
  return c;
}

/* Doubles in and out of kick, drift, advance and finish: 9 + 24 + 14 + 26; a solid's advance and
 * finish also have g, cm, S, t and the damage: 39 + 16, and some thresholds. */
static inline Cost cost_local(const Sim *sim)
{
  const double solid = sim->solid ? 1 : 0;
  Cost c = {8 * (9 + 24 + 14 + 26 + solid * (39 + 16 + 4)) + 8, 300 + 900 * solid, COST_DOUBLE, 0};
  return c;
}

/* cost_of: of the pass with this timer, as the run has it. */
static inline Cost cost_of(const Sim *sim, int timer)
{
  const int solid = sim->solid;
  Cost c = {0, 0, COST_DOUBLE, 0};
  switch (timer) {
  case TIMER_ORDER: c = cost_order(sim), c.bytes += cost_tree().bytes; break;
  case TIMER_SEARCH: /* 505 tests of 8 flops for groups of 32; x, y, h, ha in, the list out */
    c.bytes = 8 * 8 + COST_LIST, c.flops = 505 * 8, c.peak = COST_SINGLE;
    break;
  case TIMER_A: /* of j: y, v, h, volume */
    c = cost_loop(sim, 8, solid ? 32 : 18, 9 + (solid ? 16 : 1));
    break;
  case TIMER_LOCAL: c = cost_local(sim); break;
  case TIMER_DENSITY: /* x, h, m */ c = cost_loop(sim, 5, 18, 5 + 4); break;
  case TIMER_B: /* x, v, h, m, rho, both sound speeds, p; solid: the nine of S C */
    c = cost_loop(sim, solid ? 21 : 12, solid ? 75 : 50, (solid ? 21 : 12) + 6);
    break;
  case TIMER_GRAVITY: c = cost_gravity(sim); break;
  case TIMER_REDUCE: /* x, v, a, S, rho, u, h, signal, div v, crack rate, id */
    c.bytes = 8 * (3 * 3 + 6 + 7), c.flops = 50;
    break;
  default: break;
  }
  return c;
}

/* cost_floor: ns, and what bounds it there. */
static inline double cost_floor(const Cost *c, const char **bound)
{
  const double t[3] = {1e9 * c->bytes / COST_MEMORY, 1e9 * c->flops / c->peak,
                       1e9 * c->lines / COST_CLOCK};
  const char *const name[3] = {"memory", c->peak > COST_DOUBLE ? "fp32" : "fp64", "L1"};
  int most = 0;
  for (int k = 1; k < 3; k++)
    if (t[k] > t[most]) most = k;
  *bound = name[most];
  return t[most];
}

static inline void cost_head(const char *what, long n)
{
  printf("# %s, %ld particles; the floor is an H200's\n", what, n);
  printf("# pass\tns a particle\tGB/s\tGFLOP/s\tfloor\tratio\tbound by\n");
}

/* cost_row: a pass that takes ns a particle; returns its floor. Bytes a ns are GB/s. */
static inline double cost_row(const char *pass, const Cost *c, double ns)
{
  const char *bound;
  const double floor = cost_floor(c, &bound);
  printf("%s\t%.3f\t%.0f\t%.0f\t%.3f\t%.1f\t%s\n", pass, ns, c->bytes / ns, c->flops / ns, floor,
         ns / floor, bound);
  fflush(stdout);
  return floor;
}

#endif
