/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole steps of the solver, of bodies of any material with any settings. Checks one evaluation on
 * samples against all pairs and direct sums, then times 20 steps after 4 (a GPU: 100 after 20, and
 * one for bench/ncu) and prints the median step and, from as many steps again, the table of passes.
 * bench/cost runs it for one setting after the other. */
#include <dlfcn.h>
#include <fcntl.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include "lib/opt.h"
#include "solver/conflict.h"
#include "body.h"
#include "cost.h"

static const double MANY = 2e7; /* particles: fewer samples and steps */

static struct {
  const char *config, *shape, *turn;
  long steps, warm, samples;
  int brief, sums;
} o;

/* clang-format off */
static const Opt OPTS[] = {
  {"config",  'c', OPT_TEXT,   NULL,      "FILE", "settings from a run.cfg before those of the command line", &o.config},
  {"shape",   0,   OPT_CHOICE, "spheres", "spheres|box", "two that touch, or a box from 0 to 400 km, its lowest tenth body 1", &o.shape},
  {"steps",   0,   OPT_INT,    "0",       "N", "steps to time; 0: 20, on a GPU 100 (10 of very many particles)", &o.steps},
  {"warm",    0,   OPT_INT,    "-1",      "N", "steps before them; -1: a fifth as many", &o.warm},
  {"samples", 0,   OPT_INT,    "100",     "N", "particles to check against all pairs; 0: none", &o.samples},
  {"sums",    0,   OPT_FLAG,   NULL,      NULL, "the sums of a line of conserved.tsv after each step", &o.sums},
  {"brief",   'b', OPT_FLAG,   NULL,      NULL, "the time of a step, not of its passes", &o.brief},
  {"turn",    0,   OPT_TEXT,   NULL,      "FILE", "one process at a time uses the device, the one that has locked FILE", &o.turn},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "step", "time whole steps of the solver", "[options] [N] [solid|hydro|MATERIAL] [DEVICE] [KEY=VALUE ...]",
  "N particles (50000) of basalt with strength and flaws, of basalt without strength (hydro), or of a material by name or path of a "
  ".cfg, 57 neighbours each, self-gravity at theta 0.7, on a DEVICE (cpu), with settings as solver --set has them. Prints the "
  "median step, also a particle, and the mean of the better of two halves of the steps, a particle.",
  "step 1000000 solid cuda gravity.every=4", OPTS, 0, -1};
/* clang-format on */

static Err err;

static void need(int failed) { body_need(failed, &err); }

static double now(clockid_t clock)
{
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
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
  s.extra = fetch(sim, d->extra, PAIR_EXTRA);
  if (d->theta) s.theta = fetch(sim, d->theta, 1);
  return s;
}

static void free_host(State *s)
{
  free(s->x), free(s->vp), free(s->h), free(s->m), free(s->rho), free(s->cs), free(s->cl);
  free(s->push), free(s->t), free(s->acc), free(s->du), free(s->extra), free(s->theta);
}

/* Why the accelerations are not the sum of what check adds up; NULL: they are. */
static const char *unchecked(const Sim *sim)
{
  if (o.samples == 0) return "not asked for";
  if (conflict_mirrors(&sim->par)) return "there are mirrors";
  if (sim->hold.on) return "walls or a layer change them";
  if (sim->par.damping > 0 || sim->par.spin_rate > 0) return "damping or spin change them";
  if (sim->par.grad_h) return "grad-h terms are not in its sums (test_grad has them)";
  return NULL;
}

/* From j to i, the shortest way through periodic faces. */
static PairVector apart(const State *s, long i, long j)
{
  double d[3];
  for (int e = 0; e < 3; e++) {
    const double edge = s->bounds.hi[e] - s->bounds.lo[e];
    d[e] = s->x[3 * i + e] - s->x[3 * j + e];
    if (s->bounds.low[e] == BOUNDS_PERIODIC) d[e] -= edge * round(d[e] / edge);
  }
  return (PairVector){d[0], d[1], d[2]};
}

/* What a particle feels: acceleration, heating, and the sizes of its parts added up. */
typedef struct {
  double a[3], du, work;
} Felt;

/* What gravity is of G m r: 1/r^3, softened [1/m^3]. */
static double pull_over_r(const Param *p, double r, double h)
{
  const double e = p->epsilon, support = e > 0 ? SOFTENING_SUPPORT * e : h;
  if (p->gravity == PARAM_NONE) return 0;
  if (p->softening == SOFTENING_PLUMMER) return pow(r * r + e * e, -1.5);
  return softening_force(fmin(r / support, 1)) / pow(fmax(r, support), 3);
}

/* By one other particle. */
static void feel(const Sim *sim, const State *s, const PairRun *run, long i, long j, Felt *f)
{
  const int kernel = sim->par.kernel;
  const PairBody me = passes_body(s, i), other = passes_body(s, j);
  const PairExtra *e = (const PairExtra *)s->extra;
  const PairVector d = apart(s, i, j);
  const PairForce p = sim->rich
                          ? pair_rich(d, &me, &other, &e[i], &e[j], kernel, 0, 0, run, &sim->more).f
                          : pair_force(d, &me, &other, kernel, 0, sim->tensor, sim->miscible, run);
  const double r = sqrt(pair_dot(d, d)), h = .5 * (me.h + other.h), w = 1 / s->m[i];
  const double g = sim->par.G * s->m[j] * pull_over_r(&sim->par, r, h);
  f->a[0] += w * p.fx - g * d.x, f->a[1] += w * p.fy - g * d.y, f->a[2] += w * p.fz - g * d.z;
  f->du += w * p.work, f->work += fabs(w * p.work);
}

/* Acceleration and heating of sampled particles by all pairs; gravity with an error as
 * tests/test_gravity allows. */
static void check(Sim *sim)
{
  State host = on_host(sim);
  const State *s = &host;
  const PairRun run = backend_pair(sim, 3);
  const long most = (double)s->n > MANY ? o.samples / 10 + 1 : o.samples,
             samples = most < s->n ? most : s->n;
  PointField field;
  double worst = 0, heat = 0, mean = 0;
  points_field(sim, &field);
  for (long i = 0; i < 3 * s->n; i++) mean += fabs(s->acc[i]) / (double)s->n;
#pragma omp parallel for reduction(max : heat, worst)
  for (long k = 0; k < samples; k++) {
    const long i = k * (s->n / samples);
    const double *b = sim->par.force;
    Felt f = {{b[0], b[1], b[2]}, 0, 0};
    for (long j = 0; j < s->n; j++)
      if (j != i) feel(sim, s, &run, i, j, &f);
    points_pull(&field, &s->x[3 * i], f.a);
    heat = fmax(heat, f.work > 0 ? fabs(s->du[i] - f.du) / f.work : INFINITY);
    for (int d = 0; d < 3; d++) worst = fmax(worst, fabs(s->acc[3 * i + d] - f.a[d]) / mean);
  }
  printf("# %ld particles against all pairs: acceleration off by %.1e of the mean, heating by "
         "%.1e\n",
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

/* Seconds of a step: the median, the mean of the better of two halves of all steps; the
 * processor's time for all. */
typedef struct {
  double median, mean, core;
} Timing;

/* A step as a run takes it, with the looks and sums between steps. */
static void advance(Sim *sim)
{
  SimStep done;
  LeaveFound found;
  Sums sums;
  need(sim_advance(sim, 1e30, &done, &err));
  need(leave_possible(sim) && leave_find(sim, &found, &err));
  need(o.sums && sim_sums(sim, &sums, &err));
}

static Timing measure(Sim *sim, long steps)
{
  const long half = (steps + 1) / 2;
  double *spent = calloc((size_t)steps + 1, sizeof *spent), part[2] = {0, 0};
  Timing t = {0, 0, now(CLOCK_PROCESS_CPUTIME_ID)};
  if (!spent) err_die("no memory");
  for (long k = 0; k < steps; k++) {
    const double start = now(CLOCK_MONOTONIC);
    advance(sim);
    spent[k] = now(CLOCK_MONOTONIC) - start;
    part[k >= half] += spent[k] / (double)(k >= half ? steps - half : half);
  }
  t.core = now(CLOCK_PROCESS_CPUTIME_ID) - t.core;
  qsort(spent, (size_t)steps, sizeof *spent, by_size);
  t.median = spent[steps / 2], t.mean = steps > 1 ? fmin(part[0], part[1]) : part[0];
  free(spent);
  return t;
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

/* The particles; what: solid, hydro or a material. */
static Parts *particles(const char *count, const char *what, int flaws)
{
  const int basalt = strcmp(what, "solid") == 0 || strcmp(what, "hydro") == 0;
  MaterialName name;
  char *text = material_find(basalt ? "basalt" : what, name, &err), *end;
  const double n = strtod(count, &end);
  need(!text);
  if (*end || !(n >= 2 && n < 2e9)) err_usage("'%s' is no number of particles", count);
  Parts *p = (strcmp(o.shape, "box") == 0 ? body_box : body_spheres)((long)n, name, text, flaws);
  free(text);
  return p;
}

/* Waits until this process is the only one that has locked the file, which is returned. */
static int take_turn(const char *path)
{
  const int file = open(path, O_RDWR | O_CREAT, 0666);
  struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
  if (file < 0 || fcntl(file, F_SETLKW, &whole) < 0) err_die("cannot lock '%s'", path);
  return file;
}

static void report(Sim *sim, const char *what, long flaws)
{
  const double n = (double)sim->s.n;
  const int cpu = sim->b == &backend_cpu;
  const long steps = o.steps > 0 ? o.steps : cpu ? 20 : n > MANY ? 10 : 100;
  measure(sim, o.warm >= 0 ? o.warm : steps / 5);
  if (!cpu && !o.brief) profiler("cuProfilerStart"), advance(sim), profiler("cuProfilerStop");
  const Timing t = measure(sim, steps);
  printf("# %s, %.0f particles, %.1f flaws each, on %s\n", what, n, (double)flaws / n, sim->about);
  printf("step\t%.3f ms\t%.3f ns a particle\t%.3f mean", 1e3 * t.median, 1e9 * t.median / n,
         1e9 * t.mean / n);
  if (cpu) printf("\t%.3f microseconds*core", 1e6 * t.core / n / (double)steps);
  printf("\n");
  if (o.brief) return;
  sim->profile = 1;
  memset(sim->timer, 0, sizeof sim->timer);
  printf("# the median with the passes timed: %.3f ms\n", 1e3 * measure(sim, steps).median);
  print_passes(sim, (int)steps);
}

int main(int argc, char **argv)
{
  int given, turn = -1;
  char **input = opt_parse(&PROGRAM, argc, argv, &given);
  const char *what = given > 1 ? input[1] : "solid";
  Param par;
  Sim sim;
  param_defaults(&par);
  need(o.config && param_read(&par, o.config, &err));
  if (strcmp(what, "hydro") == 0) need(param_set(&par, "strength.on=false", &err));
  for (int k = 3; k < given; k++) need(param_set(&par, input[k], &err));
  Parts *p = particles(given > 0 ? input[0] : "50000", what, par.strength && par.damage);
  if (o.turn) turn = take_turn(o.turn);
  need(sim_open(&sim, &par, p, given > 2 ? input[2] : "cpu", &err) ||
       conflict_unused(&par, &sim, &err));
  if (unchecked(&sim))
    printf("# not checked against all pairs: %s\n", unchecked(&sim));
  else
    check(&sim);
  report(&sim, what, p->flaws);
  if (turn >= 0) close(turn);
  sim_close(&sim);
  part_free(p);
  err_close_stdout();
  return 0;
}
