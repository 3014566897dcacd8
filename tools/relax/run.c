/* SPDX-License-Identifier: GPL-3.0-or-later */
/* First a friction that stops sound, then one that stops gravity modes. A checkpoint is the
 * snapshot of a stage with its numbers in /Run, and a number for the input that it belongs to. */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "../../lib/group.h"
#include "../../lib/progress.h"
#include "../../lib/snap.h"
#include "../../lib/unit.h"
#include "../../solver/conflict.h"
#include "run.h"

static const double SAVE_EVERY = 60; /* s of the wall clock */

static volatile sig_atomic_t stop_signal;
static void on_signal(int number) { stop_signal = number; }

static void set_signals(void handler(int))
{
  struct sigaction act;
  memset(&act, 0, sizeof act);
  act.sa_handler = handler;
  sigemptyset(&act.sa_mask);
  sigaction(SIGTERM, &act, NULL), sigaction(SIGINT, &act, NULL);
}

Param run_settings(const Options *o, double tau, double outer)
{
  Param par;
  Err err;
  param_defaults(&par);
  for (int i = 0; i < o->set.n; i++)
    if (param_set(&par, o->set.text[i], &err)) err_usage("--set: %s", err.text);
  if (par.outer_pressure > 0)
    err_usage("--set outer_pressure: it is the body's own (mksphere --outer-pressure)");
  par.outer_pressure = outer;
  if (o->fluid) par.strength = 0;
  if (!(tau > 0)) return par;
  par.energy = !strcmp(o->freeze, "entropy")  ? PARAM_ISENTROPIC
               : !strcmp(o->freeze, "energy") ? PARAM_FROZEN
                                              : PARAM_FULL;
  par.damage = 0, par.damping = 1 / tau, par.damping_radial = o->radial;
  return par;
}

double run_time(const Body *b, Span time) { return time.s + time.falls * b->free_fall; }

/* Where a run is: which stage, since when, when the body became quiet (NAN: it is not), the best
 * density so far. */
typedef struct {
  int number;
  double start, since, best, begin;
} Stage;

/* A number for particles and settings (FNV-1a, 52 bits of it), by which a checkpoint knows them. */
static double print_of(const Body *b, const Options *o)
{
  uint64_t h = 14695981039346656037u;
  const unsigned char *bytes[] = {(void *)b->p->x, (void *)b->p->m, (void *)b->p->u};
  const size_t size[] = {24, 8, 8};
  char text[256];
  for (int k = 0; k < 3; k++)
    for (size_t i = 0; i < size[k] * (size_t)b->p->n; i++) h = (h ^ bytes[k][i]) * 1099511628211u;
  snprintf(text, sizeof text, "%g %g %g %d %d %s", b->recipe.outer, run_time(b, o->damping),
           run_time(b, o->max_time), o->radial, o->fluid, o->freeze);
  for (char *c = text; *c; c++) h = (h ^ (unsigned char)*c) * 1099511628211u;
  for (int k = 0; k < o->set.n; k++)
    for (const char *c = o->set.text[k]; *c; c++) h = (h ^ (unsigned char)*c) * 1099511628211u;
  return (double)(h >> 12);
}

static int save(const Body *b, const Options *o, const Stage *s, double print, Err *err)
{
  if (part_set_number(b->p, "run", "RelaxStage", s->number, err) ||
      part_set_number(b->p, "run", "RelaxBegin", s->begin, err) ||
      part_set_number(b->p, "run", "RelaxStart", s->start, err) ||
      part_set_number(b->p, "run", "RelaxSince", isnan(s->since) ? -1 : s->since, err) ||
      part_set_number(b->p, "run", "RelaxBest", isinf(s->best) ? -1 : s->best, err) ||
      part_set_number(b->p, "run", "RelaxInput", print, err))
    return -1;
  return snap_write(b->p, o->checkpoint, 1, err);
}

/* Takes the checkpoint's particles in place of the input's: 1 when there is one. */
static int restore(Body *b, const Options *o, Stage *s, double print, Err *err)
{
  Parts *p;
  if (!o->checkpoint || access(o->checkpoint, F_OK)) return 0;
  if (!(p = snap_read(o->checkpoint, err))) return -1;
  if (p->n != b->p->n || part_number(p, "run", "RelaxInput") != print) {
    part_free(p);
    return err_set(err, "'%s' is the checkpoint of another body or other settings", o->checkpoint);
  }
  s->number = (int)part_number(p, "run", "RelaxStage");
  s->begin = part_number(p, "run", "RelaxBegin"), s->start = part_number(p, "run", "RelaxStart");
  s->since = part_number(p, "run", "RelaxSince"), s->best = part_number(p, "run", "RelaxBest");
  if (s->since < 0) s->since = NAN;
  if (s->best < 0) s->best = INFINITY;
  part_free(b->p), b->p = p;
  return 1;
}

/* One stage up to `end`; with `stop` until the body has been quiet for one free-fall time. */
typedef struct {
  Param par;
  double end, print;
  int stop, restart;
  Progress *bar;
  double first, last; /* of the bar */
} Plan;

static int look(Body *b, Sim *sim, const Plan *plan, Stage *s, int *done, Err *err)
{
  Measure m;
  char note[64];
  if (sim_store(sim, b->p, err) || measure_body(b->p, &b->s, b->layer, b->spacing, &m, err))
    return -1;
  snprintf(note, sizeof note, "rms v %.2g v_esc, density %.2g", m.rms, m.density);
  progress_show(plan->bar,
                plan->first +
                    (plan->last - plan->first) * (sim->time - s->start) / (plan->end - s->start),
                note);
  if (!measure_quiet(&m) || m.density < 0.999 * s->best || isnan(s->since)) s->since = sim->time;
  s->best = fmin(s->best, m.density);
  *done = plan->stop && sim->time - s->since >= b->free_fall;
  return 0;
}

static int advance(Body *b, const Options *o, const Plan *plan, Stage *s, Err *err)
{
  Sim sim;
  SimStep step;
  double every = 0.1 * b->free_fall, saved = progress_clock();
  int rc, done = 0;
  rc = plan->restart ? sim_restart(&sim, &plan->par, b->p, o->device, err)
                     : sim_open(&sim, &plan->par, b->p, o->device, err);
  if (rc) return -1;
  if (plan->par.damping > 0) rc = conflict_unused(&plan->par, &sim, err);
  while (!rc && !done && sim.time < plan->end) {
    double next = s->start + every * (floor((sim.time - s->start) / every * (1 + 1e-12)) + 1);
    rc = sim_advance(&sim, fmin(next, plan->end), &step, err);
    if (!rc && sim.time >= next) rc = look(b, &sim, plan, s, &done, err);
    if (rc || !o->checkpoint || !(plan->par.damping > 0)) continue;
    if (!stop_signal && progress_clock() - saved < SAVE_EVERY) continue;
    rc = sim_store(&sim, b->p, err) || save(b, o, s, plan->print, err) ? -1 : 0;
    saved = progress_clock();
    if (!rc && stop_signal) rc = ERR_STOPPED;
  }
  if (!rc) rc = sim_store(&sim, b->p, err);
  sim_close(&sim);
  return rc;
}

int run_damped(Body *b, const Options *o, double *took, Err *err)
{
  double slow = run_time(b, o->damping), longest = run_time(b, o->max_time);
  double tau[2] = {fmin(slow, b->sound / (2 * acos(-1))), slow};
  double time[2] = {fmin(longest, 10 * b->sound), longest - fmin(longest, 10 * b->sound)};
  Stage s = {0, b->p->time, NAN, INFINITY, b->p->time};
  Progress bar;
  Plan plan = {.print = o->checkpoint ? print_of(b, o) : 0, .bar = &bar};
  int restored = restore(b, o, &s, plan.print, err), rc = restored < 0 ? -1 : 0;
  if (restored > 0) fprintf(stderr, "relax: goes on from '%s'\n", o->checkpoint);
  if (o->checkpoint) set_signals(on_signal);
  progress_start(&bar, "relax", 30);
  for (int k = s.number; !rc && k < 2; k++) {
    if (!(k == s.number && restored > 0)) s = (Stage){k, b->p->time, NAN, INFINITY, s.begin};
    plan.par = run_settings(o, tau[k], b->recipe.outer), plan.end = s.start + time[k],
    plan.stop = k == 1;
    plan.restart = k == s.number && restored > 0, restored = 0;
    plan.first = k ? 0.15 : 0, plan.last = k ? 1 : 0.15;
    if (time[k] > 0) rc = advance(b, o, &plan, &s, err);
  }
  progress_end(&bar);
  if (o->checkpoint) set_signals(SIG_DFL);
  *took = b->p->time - s.begin;
  return rc;
}

int run_free(Body *b, const Options *o, double time, Err *err)
{
  Stage s = {2, b->p->time, NAN, INFINITY, b->p->time};
  Progress bar;
  Plan plan = {
      .par = run_settings(o, 0, b->recipe.outer), .end = s.start + time, .bar = &bar, .last = 1};
  int rc;
  progress_start(&bar, "relax: proof", 30);
  rc = advance(b, o, &plan, &s, err);
  progress_end(&bar);
  return rc;
}

/* What the acceleration would be of a body that turns rigidly: omega x (omega x r). */
static void centripetal(const Group *g, const double x[3], double a[3])
{
  double r[3], w2 = 0, wr = 0;
  for (int d = 0; d < 3; d++) {
    r[d] = x[d] - g->x[d];
    w2 += g->omega[d] * g->omega[d], wr += g->omega[d] * r[d];
  }
  for (int d = 0; d < 3; d++) a[d] = g->omega[d] * wr - r[d] * w2;
}

int run_residual(const Body *b, const Options *o, double *residual, Err *err)
{
  Param par = run_settings(o, 0, b->recipe.outer);
  Sim sim;
  Group g;
  unsigned char *all = malloc((size_t)b->p->n);
  double sum = 0, mass = 0;
  const StructureNode *top = &b->s.node[b->s.n - 1];
  Parts *copy;
  int rc;
  if (!all) return err_set(err, "not enough memory");
  memset(all, 1, (size_t)b->p->n);
  copy = part_select(b->p, all, err), free(all);
  if (!copy) return -1;
  rc = sim_open(&sim, &par, copy, o->device, err);
  if (!rc) rc = sim_store(&sim, copy, err), sim_close(&sim);
  if (!rc) rc = group_system(&g, copy, -1, err);
  for (long i = 0; !rc && i < copy->n; i++) {
    double a[3];
    centripetal(&g, copy->x + 3 * i, a);
    for (int d = 0; d < 3; d++) sum += copy->m[i] * pow(copy->a[3 * i + d] - a[d], 2);
    mass += copy->m[i];
  }
  if (!rc) group_free(&g), *residual = sqrt(sum / mass) / (UNIT_G * top->m / (top->r * top->r));
  part_free(copy);
  return rc;
}
