/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole steps of the solver: bench/step [N] [solid|hydro] [DEVICE] [KEY=VALUE...]. Two touching
 * spheres of N particles together (basalt: Tillotson, strength, flaws; hydro: no strength),
 * self-gravity at theta 0.7, 57 neighbours. Checks one evaluation on samples against all pairs and
 * direct sums, then times 20 steps after 5 (a GPU: 100 after 20, and one for bench/ncu) and prints
 * the median step and, from as many steps again, the table of passes. */
#include <dlfcn.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "lib/gravity.h"
#include "lib/lattice.h"
#include "lib/material.h"
#include "lib/weibull.h"
#include "cost.h"

enum { SAMPLES = 100, MOST = 100 };
static const double MANY = 2e7; /* particles: fewer samples and steps */

static Err err;

static void need(int failed)
{
  if (failed) err_die("%s", err.text);
}

static double now(clockid_t clock)
{
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Spheres of 200 km that touch, closing at 100 m/s, each falling together at 1e-4 of its size a
 * second; with flaws or without. */
static Parts *spheres(long n, int flaws)
{
  const double pi = acos(-1), radius = 2e5;
  LatticeBall ball;
  MaterialName name;
  Material *material;
  WeibullGroup *group;
  int groups;
  char *text = material_find("basalt", name, &err);
  need(!text || lattice_ball(&ball, LATTICE_HCP, 3, n / 2, &err));
  double a = radius * cbrt(4 * pi / (3 * (double)ball.n * ball.volume)),
         v = ball.volume * a * a * a;
  Parts *p = part_new(2 * ball.n);
  if (!p) err_die("no memory");
  need(part_add(p, "id x v m rho u h mat body", &err) || part_add_material(p, name, text, &err));
#pragma omp parallel for
  for (long i = 0; i < p->n; i++) {
    long k = i % ball.n, body = i / ball.n;
    for (int d = 0; d < 3; d++) {
      p->x[3 * i + d] = a * ball.x[3 * k + d];
      p->v[3 * i + d] = -1e-4 * p->x[3 * i + d];
    }
    p->x[3 * i] += (body ? 1 : -1) * radius, p->v[3 * i] += body ? -50 : 50;
    p->id[i] = i, p->body[i] = (int32_t)body, p->m[i] = 2700 * v, p->rho[i] = 2700;
    p->u[i] = 1e3, p->h[i] = cbrt(57 * 3 / (4 * pi) * v);
  }
  if (!(material = material_load(p, &err))) err_die("%s", err.text);
  need(flaws && weibull_assign(p, material, &(WeibullOptions){.seed = 1, .minimum = 1}, &group,
                               &groups, &err));
  free(material), free(text);
  if (flaws) free(group);
  lattice_free(&ball);
  return p;
}

/* An array of the state on the host; zeros where this run has none. */
static double *fetch(Sim *sim, const double *from, size_t width)
{
  const size_t bytes = (size_t)sim->s.n * width * sizeof *from;
  double *to = calloc(1, bytes);
  if (!to) err_die("no memory");
  need(from && sim->b->copy(sim, to, from, bytes, &err));
  return to;
}

/* What the check reads of the state, on the host. */
static State on_host(Sim *sim)
{
  const State *d = &sim->s;
  State s = *d;
  s.x = fetch(sim, d->x, 3), s.vp = fetch(sim, d->vp, 3), s.acc = fetch(sim, d->acc, 3);
  s.h = fetch(sim, d->h, 1), s.m = fetch(sim, d->m, 1), s.rho = fetch(sim, d->rho, 1);
  s.cs = fetch(sim, d->cs, 1), s.cl = fetch(sim, d->cl, 1), s.push = fetch(sim, d->push, 1);
  s.t = fetch(sim, d->t, 9), s.du = fetch(sim, d->du, 1);
  return s;
}

static void free_host(State *s)
{
  free(s->x), free(s->vp), free(s->h), free(s->m), free(s->rho), free(s->cs), free(s->cl);
  free(s->push), free(s->t), free(s->acc), free(s->du);
}

/* Acceleration and heating of sampled particles by all pairs; gravity with an error as
 * tests/test_gravity allows. */
static void check(Sim *sim)
{
  State host = on_host(sim);
  const State *s = &host;
  PairRun run = {kernel_sigma(sim->par.kernel, 3), sim->par.alpha, sim->par.beta, 3,
                 sim->par.pressure == PARAM_PRODUCT};
  const int samples = (double)s->n > MANY ? SAMPLES / 10 : SAMPLES;
  double worst = 0, heat = 0, mean = 0;
  for (long i = 0; i < 3 * s->n; i++) mean += fabs(s->acc[i]) / (double)s->n;
#pragma omp parallel for reduction(max : heat, worst)
  for (long k = 0; k < samples; k++) {
    const long i = k * (s->n / samples);
    double a[3] = {0}, du = 0, work = 0;
    PairBody me = passes_body(s, i);
    for (long j = 0; j < s->n; j++) {
      if (j == i) continue;
      PairBody other = passes_body(s, j);
      const double *xi = &s->x[3 * i], *xj = &s->x[3 * j];
      PairVector d = {xi[0] - xj[0], xi[1] - xj[1], xi[2] - xj[2]};
      PairForce f = pair_force(d, &me, &other, sim->par.kernel, 0, sim->solid, 0, &run);
      const double r = sqrt(pair_dot(d, d)), h = .5 * (me.h + other.h), w = 1 / me.m;
      const double g =
          sim->par.G * other.m / pow(fmax(r, h), 3) * gravity_soft_force(fmin(r / h, 1));
      a[0] += w * f.fx - g * d.x, a[1] += w * f.fy - g * d.y, a[2] += w * f.fz - g * d.z;
      du += w * f.work, work += fabs(w * f.work);
    }
    heat = work > 0 ? fmax(heat, fabs(s->du[i] - du) / work) : INFINITY;
    for (int d = 0; d < 3; d++) worst = fmax(worst, fabs(s->acc[3 * i + d] - a[d]) / mean);
  }
  printf(
      "# %d particles against all pairs: acceleration off by %.1e of the mean, heating by %.1e\n",
      samples, worst, heat);
  free_host(&host);
  if (!(worst < 1e-2)) err_die("the accelerations are not what they should be");
  if (!(heat < (sim->b == &backend_cpu ? 1e-12 : 1e-5))) err_die("wrong heating");
}

static int by_size(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The median [s] of steps, and the processor's time for all of them. */
static double advance(Sim *sim, int steps, double *core)
{
  SimStep done;
  double spent[MOST];
  *core = now(CLOCK_PROCESS_CPUTIME_ID);
  for (int k = 0; k < steps; k++) {
    const double start = now(CLOCK_MONOTONIC);
    need(sim_advance(sim, 1e30, &done, &err));
    spent[k] = now(CLOCK_MONOTONIC) - start;
  }
  *core = now(CLOCK_PROCESS_CPUTIME_ID) - *core;
  qsort(spent, (size_t)steps, sizeof *spent, by_size);
  return spent[steps / 2];
}

/* The table of passes: of a card beside what it cannot do faster. */
static void print_passes(const Sim *sim, int steps)
{
  const double n = (double)sim->s.n;
  double all = 0, least = 0;
  Cost sum = {0, 0, 0, 0};
  if (sim->b == &backend_cpu) {
    profile_print(sim, steps, stdout);
    return;
  }
  cost_head(sim->solid ? "solid" : "hydro", sim->s.n);
  for (int t = 0; t < TIMERS; t++) {
    const Cost c = cost_of(sim, t);
    const double ns = 1e9 * sim->timer[t].spent / n / steps;
    if (!sim->timer[t].calls) continue;
    all += ns, sum.bytes += c.bytes, sum.flops += c.flops;
    least += cost_row(profile_names[t], &c, ns);
  }
  printf("all\t%.3f\t%.0f\t%.0f\t%.3f\t%.1f\n", all, sum.bytes / all, sum.flops / all, least,
         all / least);
}

/* Tells a profiler that waits for it (ncu --profile-from-start off) to begin, or to end. */
static void profiler(const char *call)
{
  void *driver = dlopen("libcuda.so.1", RTLD_LAZY);
  int (*function)(void);
  if (!driver) return;
  *(void **)&function = dlsym(driver, call);
  if (function) function();
  dlclose(driver);
}

int main(int argc, char **argv)
{
  err_program(argv[0]);
  const int hydro = argc > 2 && strcmp(argv[2], "hydro") == 0;
  Parts *p = spheres(argc > 1 ? atol(argv[1]) : 50000, !hydro);
  const double n = (double)p->n;
  double core, step;
  Param par;
  Sim sim;
  param_defaults(&par);
  if (hydro) need(param_set(&par, "strength.on=false", &err));
  for (int k = 4; k < argc; k++) need(param_set(&par, argv[k], &err));
  need(sim_open(&sim, &par, p, argc > 3 ? argv[3] : "cpu", &err));
  check(&sim);
  const int cpu = sim.b == &backend_cpu, steps = cpu ? 20 : n > MANY ? 10 : 100;
  advance(&sim, steps / 5, &core);
  if (!cpu) profiler("cuProfilerStart"), advance(&sim, 1, &core), profiler("cuProfilerStop");
  step = advance(&sim, steps, &core);
  printf("# %s and gravity, %.0f particles, %.1f flaws each, on %s\n", hydro ? "hydro" : "solid", n,
         (double)p->flaws / n, sim.about);
  printf("step\t%.3f ms\t%.3f ns a particle", 1e3 * step, 1e9 * step / n);
  if (cpu) printf("\t%.3f microseconds*core", 1e6 * core / n / steps);
  sim.profile = 1;
  memset(sim.timer, 0, sizeof sim.timer);
  printf("\n# the median with the passes timed: %.3f ms\n", 1e3 * advance(&sim, steps, &core));
  print_passes(&sim, steps);
  sim_close(&sim);
  part_free(p);
  return 0;
}
