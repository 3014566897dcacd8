/* SPDX-License-Identifier: GPL-3.0-or-later */
/* relax: brings a body to hydrostatic equilibrium. The one-dimensional structure is solved and laid
 * on the particles; then the solver runs with friction and frozen entropy, first with a friction
 * time that stops sound, then with one that stops gravity modes; a proof run without friction shows
 * what the body does when left alone (docs/theory.md). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../../lib/lay.h"
#include "../../lib/material.h"
#include "../../lib/opt.h"
#include "../../lib/profile.h"
#include "../../lib/progress.h"
#include "../../lib/recipe.h"
#include "../../lib/snap.h"
#include "../../lib/unit.h"
#include "../../solver/sim.h"
#include "measure.h"

static struct {
  const char *output, *profile, *device;
  double damping, max_time, proof;
  int only, radial, nodes_given;
  long nodes;
  OptList set;
} o = {.damping = NAN, .max_time = NAN, .proof = NAN};

/* clang-format off */
static const Opt opts[] = {
  {"output",       'o', OPT_TEXT,   "-",    "FILE", "relaxed body", &o.output},
  {"profile-only", 0,   OPT_FLAG,   NULL,   NULL,   "print the one-dimensional structure (TSV) and stop", &o.only},
  {"profile",      'p', OPT_TEXT,   NULL,   "FILE", "write the one-dimensional structure (TSV) there", &o.profile},
  {"nodes",        0,   OPT_INT,    "4000", "N",    "nodes of the one-dimensional structure", &o.nodes},
  {"damping",      0,   OPT_REAL,   NULL,   "s",    "friction time of the second stage (default: 0.3 free-fall times)", &o.damping},
  {"radial",       0,   OPT_FLAG,   NULL,   NULL,   "damp the radial velocity only", &o.radial},
  {"max-time",     't', OPT_REAL,   NULL,   "s",    "longest damped run (default: 12 free-fall times)", &o.max_time},
  {"proof",        0,   OPT_REAL,   NULL,   "s",    "length of the proof run (default: 1 free-fall time; 0: none)", &o.proof},
  {"device",       0,   OPT_TEXT, "auto", "auto|cpu|cuda[:K]", "where to run; auto: a card if there is one", &o.device},
  {"set",          's', OPT_LIST,   NULL,   "KEY=VALUE", "a setting of the solver, e.g. kernel=cubic_spline", &o.set},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL},
};
/* clang-format on */

static const OptProgram program = {
    "relax",
    "bring a body to hydrostatic equilibrium",
    "[options] body.h5 > relaxed.h5",
    "Keeps the layers and their energies at zero pressure; entropy is frozen. Prints what was "
    "reached on stderr.",
    "mksphere -n 2000 --mass 9.43e20 --layer basalt:0.7 --layer ice:0.3 | relax > target.h5",
    opts,
    0,
    1};

typedef struct {
  Parts *p;
  StructureBody body;
  Structure s;
  Material *material;
  int *layer;                       /* [n] of each particle */
  double free_fall, sound, spacing; /* s, s, m */
} Body;

static int write_profile(const Body *b, const char *path, Err *err)
{
  const char *names[STRUCTURE_LAYERS], *texts[STRUCTURE_LAYERS];
  for (int k = 0; k < b->body.layers; k++) {
    names[k] = b->p->material[b->body.layer[k].mat].name;
    texts[k] = b->p->material[b->body.layer[k].mat].text;
  }
  return profile_write(path, &b->s, &b->body, names, texts, err);
}

/* Reads the body, solves its structure and lays it on the particles. */
static int prepare(Body *b, const char *path, Err *err)
{
  StructureBody *body = &b->body, recipe;
  const StructureNode *top;
  int layers;
  if (!(b->p = snap_read(path, err))) return -1;
  if (part_need(b->p, SIM_FIELDS, path ? path : "stdin", err)) return -1;
  if (part_check(b->p, path ? path : "stdin", err)) return -1;
  if (!(b->material = material_load(b->p, err))) return -1;
  if (!(b->layer = malloc(sizeof *b->layer * (size_t)(b->p->n ? b->p->n : 1))))
    return err_set(err, "not enough memory");
  if (lay_layers(b->p, b->material, body, b->layer, err) < 0) return -1;
  if ((layers = recipe_load(b->p, b->material, &recipe, err)) < 0) return -1;
  if (layers == body->layers) *body = recipe;
  if (structure_solve(&b->s, body, o.nodes, err)) return -1;
  top = &b->s.node[b->s.n - 1];
  b->free_fall = sqrt(acos(-1) * acos(-1) * pow(top->r, 3) / (8 * UNIT_G * top->m));
  b->sound = top->r / b->s.node[0].cs;
  b->spacing = cbrt(4. / 3 * acos(-1) * pow(top->r, 3) / (double)b->p->n * sqrt(2));
  if (o.profile && write_profile(b, o.profile, err)) return -1;
  return o.only ? 0 : lay_body(b->p, b->material, &b->s, err);
}

static Param settings(int damped, double tau)
{
  Param par;
  Err err;
  param_defaults(&par);
  for (int i = 0; i < o.set.n; i++)
    if (param_set(&par, o.set.text[i], &err)) err_usage("--set: %s", err.text);
  if (damped) {
    par.energy = PARAM_ISENTROPIC, par.damage = 0, par.damping = 1 / tau;
    par.damping_radial = o.radial;
  }
  return par;
}

static int quiet(const Measure *m) { return m->high < 0.01 && m->balance < 1e-5; }

/* Runs for up to `time`, with friction time tau (0: none); with `stop` until the body has been
 * quiet for one free-fall time and its density has stopped improving. *took: how long it ran.
 * Progress over the whole relaxation is first..last of 1. */
static int stage(Body *b, double tau, double time, int stop, Progress *bar, double first,
                 double last, double *took, Err *err)
{
  Param par = settings(tau > 0, tau > 0 ? tau : 1);
  Sim sim;
  SimStep done;
  Measure m;
  double end = b->p->time + time, start = b->p->time, look = 0.1 * b->free_fall,
         next = start + look, since = NAN, best = INFINITY;
  char note[64];
  int rc = sim_open(&sim, &par, b->p, o.device, err);
  if (rc) return -1;
  while (!rc && sim.time < end) {
    rc = sim_advance(&sim, fmin(next, end), &done, err);
    if (rc || sim.time < next) continue;
    next += look;
    if ((rc = sim_store(&sim, b->p, err)) ||
        (rc = measure_body(b->p, &b->s, b->layer, b->spacing, &m, err)))
      continue;
    snprintf(note, sizeof note, "rms v %.2g v_esc, density %.2g", m.rms, m.density);
    progress_show(bar, first + (last - first) * (sim.time - start) / time, note);
    if (!quiet(&m) || m.density < 0.999 * best) since = sim.time;
    best = fmin(best, m.density);
    if (stop && sim.time - since >= b->free_fall) break;
  }
  if (!rc) rc = sim_store(&sim, b->p, err);
  *took = sim.time - start;
  sim_close(&sim);
  return rc;
}

static void report(const char *what, const Body *b, const Measure *m, double time)
{
  fprintf(stderr,
          "relax: %s: %.3g s (%.2f free-fall times): rms v %.2e, 99.9 %% %.2e, max %.2e v_esc; "
          "K/|W| %.1e; density off the "
          "profile by %.2e rms; central pressure %.3f of it\n",
          what, time, time / b->free_fall, m->rms, m->high, m->max, m->balance, m->density,
          m->pressure);
}

/* Damage, histories and time back to nothing; radii into /Body. The stress stays: it is part of the
 * equilibrium. */
static int finish(Body *b, const Measure *m, Err *err)
{
  const StructureNode *top = &b->s.node[b->s.n - 1];
  Parts *p = b->p;
  memset(p->damage, 0, sizeof *p->damage * (size_t)p->n);
  memset(p->nact, 0, sizeof *p->nact * (size_t)p->n);
  memset(p->strain, 0, sizeof *p->strain * (size_t)p->n);
  memset(p->pmax, 0, sizeof *p->pmax * (size_t)p->n);
  p->time = 0;
  fprintf(
      stderr,
      "relax: radius %.6g km (profile), %.6g km (outermost + half a spacing), %.6g km (volume)\n",
      top->r / 1e3, m->radius / 1e3, m->volume / 1e3);
  return part_set_number(p, "body", "Radius0", top->r, err) |
         part_set_number(p, "body", "RadiusMax0", m->radius, err) |
         part_set_number(p, "body", "RadiusVolume0", m->volume, err) |
         part_set_number(p, "body", "CentralPressure0", b->s.node[0].p, err) |
         part_set_number(p, "body", "RelaxedSpeed0", m->rms, err);
}

/* What the body does when left alone, with all its strength; on a copy. */
static int proof(Body *b, double time, Progress *bar, Err *err)
{
  unsigned char *all = malloc((size_t)b->p->n);
  Body copy = *b;
  Measure m;
  double took = 0, before;
  int rc;
  if (!all) return err_set(err, "not enough memory");
  memset(all, 1, (size_t)b->p->n);
  copy.p = part_select(b->p, all, err);
  free(all);
  if (!copy.p || measure_body(copy.p, &b->s, b->layer, b->spacing, &m, err)) return -1;
  before = m.radius;
  rc = stage(&copy, 0, time, 0, bar, 0.7, 1, &took, err);
  if (!rc) rc = measure_body(copy.p, &b->s, b->layer, b->spacing, &m, err);
  progress_end(bar);
  if (!rc) {
    report("proof run without friction", &copy, &m, took);
    fprintf(stderr, "relax: its radius changed by %.2e\n", m.radius / before - 1);
    if (!(m.rms < 0.01)) err_warn("the body does not stay at rest: rms v is %.2g v_esc", m.rms);
  }
  part_free(copy.p);
  return rc;
}

static int relax(Body *b, Err *err)
{
  double slow = isnan(o.damping) ? 0.3 * b->free_fall : o.damping, took, spent;
  double longest = isnan(o.max_time) ? 12 * b->free_fall : o.max_time,
         left = isnan(o.proof) ? b->free_fall : o.proof;
  double fast = fmin(slow, b->sound / (2 * acos(-1))), brief = fmin(longest, 10 * b->sound);
  Measure m;
  Progress bar;
  progress_start(&bar, "relax", 30);
  if (stage(b, fast, brief, 0, &bar, 0, 0.1, &spent, err)) return -1;
  if (longest > brief && stage(b, slow, longest - brief, 1, &bar, 0.1, 0.7, &took, err)) return -1;
  measure_settle(b->p);
  if (measure_body(b->p, &b->s, b->layer, b->spacing, &m, err)) return -1;
  progress_end(&bar);
  report("damped run", b, &m, spent + (longest > brief ? took : 0));
  if (!quiet(&m))
    err_warn("not at rest after %.3g s: 99.9 %% of the speeds below %.2g v_esc", longest, m.high);
  if (finish(b, &m, err)) return -1;
  return left > 0 ? proof(b, left, &bar, err) : 0;
}

int main(int argc, char **argv)
{
  int n;
  char **inputs = opt_parse(&program, argc, argv, &n), *command = opt_command_line(argc, argv);
  Body b = {0};
  Err err;
  if (o.nodes < 100) err_usage("--nodes must be at least 100");
  if (!isnan(o.damping) && !(o.damping > 0)) err_usage("--damping must be positive");
  if (!isnan(o.max_time) && !(o.max_time > 0)) err_usage("--max-time must be positive");
  settings(0, 1);
  if (prepare(&b, n ? inputs[0] : NULL, &err)) err_die("%s", err.text);
  if (o.only ? write_profile(&b, "-", &err) : 0) err_die("%s", err.text);
  if (!o.only &&
      (relax(&b, &err) || part_history(b.p, command, &err) || snap_write(b.p, o.output, 0, &err)))
    err_die("%s", err.text);
  material_free(b.material, b.p->materials);
  part_free(b.p);
  structure_free(&b.s);
  free(b.layer);
  free(command);
  if (o.only || strcmp(o.output, "-") != 0) err_close_stdout();
  return 0;
}
