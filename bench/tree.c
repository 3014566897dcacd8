/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The passes of the host tree: Hilbert order, build, neighbour search, gravity. Checks samples
 * against brute force, then prints core time: bench/tree [N] [theta]. A sphere of N particles on a
 * jittered lattice, 57 neighbours each. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "lib/gravity.h"
#include "lib/ngb.h"
#include "lib/rng.h"

enum { REPEAT = 7, SAMPLES = 200 };

typedef struct {
  long n;
  double *x, *y, *m, *h, *a, *phi; /* y: x and a drift */
  GravityOptions gravity;
  Tree tree;
  Ngb ngb;
  int two; /* search at x and y */
} Case;

static Err err;

static void need(int failed)
{
  if (failed) err_die("%s", err.text);
}

static double *column(long n) /* a bench may just die of want */
{
  double *p = calloc((size_t)n, sizeof *p);
  if (!p) err_die("no memory");
  return p;
}

/* Earth-like: radius 6.4e6 m, mass 6e24 kg. In Hilbert order. */
static void sphere(Case *c, long n)
{
  const double pi = acos(-1), radius = 6.4e6, d = radius * cbrt(4 * pi / (3 * (double)n));
  const int w = (int)(radius / d) + 2;
  double *raw = column(4 * n + 3 * 64 * (long)w * w);
  long *order, k = 0;
  for (long i = 0; i < 8L * w * w * w; i++) {
    double p[3], r2 = 0;
    for (int e = 0; e < 3; e++) {
      long cell = (e ? e == 1 ? i / (2 * w) : i / (4L * w * w) : i) % (2 * w) - w;
      p[e] = d * ((double)cell + 0.5 * rng_uniform(1, (uint64_t)i, (uint32_t)e));
      r2 += p[e] * p[e];
    }
    if (r2 < radius * radius) memcpy(raw + 3 * k++, p, sizeof p);
  }
  c->n = k, c->x = column(3 * k), c->y = column(3 * k), c->m = column(k), c->h = column(k);
  c->a = column(3 * k), c->phi = column(k), order = malloc((size_t)k * sizeof *order);
  need(!order || tree_order(k, raw, NULL, 0, order, &err));
  for (long i = 0; i < k; i++) {
    for (int e = 0; e < 3; e++) {
      c->x[3 * i + e] = raw[3 * order[i] + e];
      c->y[3 * i + e] = c->x[3 * i + e] + d * (0.1 * rng_uniform(2, (uint64_t)i, (uint32_t)e) + 3);
    }
    c->m[i] = 6e24 / (double)k, c->h[i] = d * cbrt(57 * 3 / (4 * pi));
  }
  free(raw), free(order);
}

static void order(Case *c)
{
  long *o = malloc((size_t)c->n * sizeof *o);
  need(!o || tree_order(c->n, c->y, NULL, 0, o, &err));
  free(o);
}
static void build(Case *c) { need(tree_build(&c->tree, c->n, c->x, c->m, c->h, &err)); }
static void find(Case *c)
{
  need(ngb_search(&c->ngb, &c->tree, c->x, c->two ? c->y : NULL, c->h, 1, &err));
}
static void pull(Case *c)
{
  need(gravity_tree(&c->tree, c->x, c->m, c->h, &c->gravity, c->a, NULL, &err));
}
static void pull_phi(Case *c)
{
  need(gravity_tree(&c->tree, c->x, c->m, c->h, &c->gravity, c->a, c->phi, &err));
}

static int by_size(const void *a, const void *b)
{
  const double s = *(const double *)a, t = *(const double *)b;
  return (s > t) - (s < t);
}

/* Lists of sampled particles against all pairs. */
static void check_lists(const Case *c)
{
  double sum = 0;
  for (long k = 0; k < SAMPLES; k++) {
    const long i = k * (c->n / SAMPLES);
    int64_t at = c->ngb.start[i];
    for (long j = 0; j < c->n; j++) {
      const double *p = c->x + 3 * i, *q = c->x + 3 * j, *u = c->y + 3 * i, *v = c->y + 3 * j;
      double l2 = pow(0.5 * (c->h[i] + c->h[j]), 2);
      double r2 = pow(p[0] - q[0], 2) + pow(p[1] - q[1], 2) + pow(p[2] - q[2], 2);
      if (c->two) r2 = fmin(r2, pow(u[0] - v[0], 2) + pow(u[1] - v[1], 2) + pow(u[2] - v[2], 2));
      if (j == i || r2 >= l2) continue;
      if (at >= c->ngb.start[i + 1] || c->ngb.list[at++] != j)
        err_die("wrong neighbours of %ld", i);
    }
    if (at != c->ngb.start[i + 1]) err_die("too many neighbours of %ld", i);
    sum += (double)(c->ngb.start[i + 1] - c->ngb.start[i]);
  }
  printf("# lists equal brute force, %.1f neighbours\n", sum / SAMPLES);
}

/* Errors of sampled accelerations against direct sums, in units of |a| or, near the centre, of the
 * mean |a|. */
static void check_gravity(const Case *c)
{
  double e[SAMPLES], mean = 0;
  for (long i = 0; i < c->n; i++)
    mean += hypot(hypot(c->a[3 * i], c->a[3 * i + 1]), c->a[3 * i + 2]) / (double)c->n;
  for (long k = 0; k < SAMPLES; k++) {
    const long i = k * (c->n / SAMPLES);
    double s[3] = {0};
    for (long j = 0; j < c->n; j++) {
      const double *p = c->x + 3 * i, *q = c->x + 3 * j,
                   d[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
      double h = 0.5 * (c->h[i] + c->h[j]), r = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      double f = c->gravity.G * c->m[j] / pow(fmax(r, h), 3) * softening_force(fmin(r / h, 1));
      for (int b = 0; b < 3; b++) s[b] -= f * d[b];
    }
    const double *a = c->a + 3 * i;
    e[k] = hypot(hypot(a[0] - s[0], a[1] - s[1]), a[2] - s[2]) /
           fmax(mean, hypot(hypot(s[0], s[1]), s[2]));
  }
  qsort(e, SAMPLES, sizeof *e, by_size);
  printf("# gravity theta %g: error median %.2e, 99 %% %.2e\n", c->gravity.theta, e[SAMPLES / 2],
         e[SAMPLES * 99 / 100]);
  if (!(e[SAMPLES / 2] < 1e-3 && e[SAMPLES * 99 / 100] < 1e-2))
    err_die("gravity is not what it should be");
}

static double core_time(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void time_it(Case *c, const char *what, void (*pass)(Case *))
{
  double best = 1e9;
  for (int k = 0; k < REPEAT; k++) {
    double t = core_time();
    pass(c);
    best = fmin(best, core_time() - t);
  }
  printf("%-24s %8.1f\n", what, best / (double)c->n * 1e9);
}

int main(int argc, char **argv)
{
  err_program(argv[0]);
  Case c = {.gravity = {argc > 2 ? atof(argv[2]) : 0.7, 6.67430e-11, 1}};
  sphere(&c, argc > 1 ? atol(argv[1]) : 50000);
  build(&c);
  for (c.two = 0; c.two < 2; c.two++) find(&c), check_lists(&c);
  pull(&c), check_gravity(&c);
  printf("# %ld particles\n# pass         core ns a particle\n", c.n);
  time_it(&c, "order", order);
  time_it(&c, "build", build);
  c.two = 0, time_it(&c, "search", find);
  c.two = 1, time_it(&c, "search, two sets", find);
  time_it(&c, "gravity, single", pull);
  time_it(&c, "gravity and potential", pull_phi);
  c.gravity.single = 0, time_it(&c, "gravity, double", pull);
  return 0;
}
