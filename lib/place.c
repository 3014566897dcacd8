/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every particle belongs to a layer and has a mass coordinate in it; the structure says at which
 * radius that is. Lattices that are not stretched have their own radii, and masses in proportion to
 * the density there. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "figure.h"
#include "place.h"
#include "recipe.h"
#include "rng.h"
#include "shells.h"

static const double PI = 3.14159265358979323846;

typedef struct {
  const Place *how;
  const StructureBody *body;
  const Structure *s;
  StructureNode rest[STRUCTURE_LAYERS]; /* at the pressure outside */
  double mass[STRUCTURE_LAYERS + 1];    /* inside of each layer [kg] */
  double volume[STRUCTURE_LAYERS + 1];  /* the same at rest */
  long end[STRUCTURE_LAYERS + 1];       /* particles, likewise */
  double *x;                            /* [n][3] m */
  StructureNode *at;                    /* [n] state */
  double *share;                        /* [n] mass before it is scaled */
  long n;
  double total; /* volume of the body [m^3] */
} Task;

/* State at a mass coordinate of a layer: without gravity that of its rest, at the radius of the
 * volume. */
static StructureNode state(const Task *t, int layer, double m)
{
  StructureNode node = t->rest[layer];
  if (!t->body->weightless) return structure_at_mass(t->s, layer, m);
  node.m = m;
  node.r = recipe_radius(t->how->dimension, t->volume[layer] + (m - t->mass[layer]) / node.rho);
  return node;
}

/* The same at a radius, kept within the layer. */
static StructureNode state_at_radius(const Task *t, int layer, double r)
{
  const StructureNode *first, *last;
  if (t->body->weightless) return t->rest[layer];
  first = &t->s->node[t->s->first[layer]], last = &t->s->node[t->s->first[layer + 1] - 1];
  if (r <= first->r) return *first;
  return r >= last->r ? *last : structure_at_radius(t->s, r);
}

static int rest(Task *t, Err *err)
{
  const StructureBody *body = t->body;
  StructureState anchor[STRUCTURE_LAYERS], at;
  if (structure_anchors(body, anchor, err)) return -1;
  for (int k = 0; k < body->layers; k++) {
    const StructureLayer *l = &body->layer[k];
    EosPoint point;
    if (structure_move(l, &anchor[k], body->outer, &at))
      return err_set(err, "layer %d has no state at %g Pa", k + 1, body->outer);
    point = eos_eval(&l->material->eos, at.rho, at.u, 0);
    t->rest[k] = (StructureNode){
        .rho = at.rho * (1 - l->pores), .u = at.u, .p = point.p, .cs = point.cs, .layer = k};
  }
  return 0;
}

static int prepare(Task *t, Err *err)
{
  const StructureBody *body = t->body;
  if (body->weightless && rest(t, err)) return -1;
  for (int k = 0; k < body->layers; k++) {
    double rho = t->rest[k].rho;
    if (!body->weightless) rho = eos_rho0(&body->layer[k].material->eos);
    if (!(rho > 0)) rho = t->s->node[t->s->first[k + 1] - 1].rho;
    t->mass[k + 1] = t->mass[k] + body->layer[k].mass;
    t->volume[k + 1] = t->volume[k] + body->layer[k].mass / rho;
  }
  t->total = t->volume[body->layers];
  if (!body->weightless) t->total = recipe_volume(3, t->s->node[t->s->n - 1].r);
  return 0;
}

/* Which part of the particles lies inside of layer k's end. */
static double inside(const Task *t, int k)
{
  int n = t->body->layers, rigid = t->how->placing == PLACE_HCP || t->how->placing == PLACE_CUBIC;
  if (t->how->equal_mass && !rigid) return t->mass[k + 1] / t->mass[n];
  if (!t->body->weightless && rigid)
    return pow(t->s->node[t->s->first[k + 1] - 1].r / t->s->node[t->s->n - 1].r, 3);
  return t->volume[k + 1] / t->volume[n];
}

static int ends(Task *t, const LatticeBall *ball, Err *err)
{
  int layers = t->body->layers;
  for (int k = 0; k < layers; k++) {
    long n = lround(inside(t, k) * (double)t->n), shells;
    if (ball) {
      shells = k == layers - 1 ? ball->shells : lattice_cut(ball, inside(t, k) * (double)ball->n);
      n = shells ? ball->within[shells - 1] : 0;
    }
    t->end[k + 1] = n;
    if (n <= t->end[k])
      return err_set(err, "layer %d is too thin for a particle: more are needed", k + 1);
  }
  return 0;
}

static int allocate(Task *t, Err *err)
{
  t->x = malloc((size_t)t->n * 3 * sizeof *t->x);
  t->at = malloc((size_t)t->n * sizeof *t->at);
  t->share = malloc((size_t)t->n * sizeof *t->share);
  return t->x && t->at && t->share ? 0 : err_set(err, "no memory for %ld particles", t->n);
}

/* Site i of a lattice, r from its centre in units of `spacing`. */
static void site(Task *t, const LatticeBall *ball, long i, double spacing)
{
  int k = 0, d = t->how->dimension;
  const double *x = ball->x + 3 * i;
  double r = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]), scale = spacing;
  while (ball->within[ball->shell[i]] > t->end[k + 1]) k++;
  if (t->how->placing == PLACE_STRETCHED) {
    double sites = recipe_volume(d, r) / ball->volume, n = (double)(t->end[k + 1] - t->end[k]);
    double part = fmin(fmax((sites - (double)t->end[k]) / n, 0), 1);
    t->at[i] = state(t, k, t->mass[k] + part * (t->mass[k + 1] - t->mass[k]));
    scale = r > 0 ? t->at[i].r / r : 0, t->share[i] = 1;
  } else {
    t->at[i] = state_at_radius(t, k, r * spacing),
    t->share[i] = t->body->weightless ? 1 : t->at[i].rho;
  }
  t->at[i].layer = k;
  for (int a = 0; a < 3; a++) t->x[3 * i + a] = scale * x[a];
}

static int lattice(Task *t, Err *err)
{
  LatticeBall ball;
  int d = t->how->dimension, rc = -1;
  double spacing;
  if (lattice_ball(&ball, t->how->placing == PLACE_CUBIC ? LATTICE_CUBIC : LATTICE_HCP, d,
                   t->how->n, err))
    return -1;
  t->n = ball.n;
  spacing = pow(t->total / (double)ball.n / ball.volume, 1. / d);
  if (!ends(t, &ball, err) && !allocate(t, err)) {
    for (long i = 0; i < ball.n; i++) site(t, &ball, i, spacing);
    rc = 0;
  }
  lattice_free(&ball);
  return rc;
}

/* One layer of shells: their edges at equal steps of the integral of dr/spacing, moved so that each
 * shell holds a whole number of particles; particles at the radius that halves the shell's mass. */
static void layer_shells(Task *t, int k)
{
  enum { SAMPLES = 2000 };
  long n = t->end[k + 1] - t->end[k], done = 0, shells, j = 1;
  double one = (t->mass[k + 1] - t->mass[k]) / (double)n, sum = 0, steps[SAMPLES + 1] = {0};
  StructureNode last = state(t, k, t->mass[k]);
  uint64_t seed = t->how->seed < 0 ? 0 : (uint64_t)t->how->seed;
  for (int i = 1; i <= SAMPLES; i++) {
    double part = k ? i / (double)SAMPLES : pow(i / (double)SAMPLES, 3);
    StructureNode here = state(t, k, t->mass[k] + part * (double)n * one);
    steps[i] = sum += (here.r - last.r) * cbrt((here.rho + last.rho) / 2 / one);
    last = here;
  }
  shells = (long)fmax(1, round(sum));
  for (int i = 1; i <= SAMPLES; i++) {
    double part = k ? i / (double)SAMPLES : pow(i / (double)SAMPLES, 3);
    long end = i == SAMPLES ? n : lround(part * (double)n), first = t->end[k] + done;
    if (end <= done || (i < SAMPLES && steps[i] < sum * (double)j / (double)shells)) continue;
    shells_points(end - done, seed * 1000003 + (uint64_t)(1000 * k + j), t->x + 3 * first);
    for (long q = first; q < t->end[k] + end; q++) {
      t->at[q] = state(t, k, t->mass[k] + 0.5 * (double)(done + end) * one), t->share[q] = 1;
      if (end == 1 && !k && !done) t->at[q].r = 0;
      for (int a = 0; a < 3; a++) t->x[3 * q + a] *= t->at[q].r;
    }
    done = end, j++;
  }
}

static int shells(Task *t, Err *err)
{
  t->n = t->how->n;
  if (ends(t, NULL, err) || allocate(t, err)) return -1;
  for (int k = 0; k < t->body->layers; k++) layer_shells(t, k);
  return 0;
}

static void turn(Parts *p, uint64_t seed)
{
  double m[3][3], angle = 2 * PI * rng_uniform(seed, 0, 0), c = cos(angle), s = sin(angle);
  if (p->dimension == 3)
    rng_rotation(seed, m);
  else
    memcpy(m, (double[3][3]){{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, sizeof m);
  for (long i = 0; i < p->n; i++) {
    double *x = p->x + 3 * i, old[3] = {x[0], x[1], x[2]};
    for (int a = 0; a < 3; a++) x[a] = m[a][0] * old[0] + m[a][1] * old[1] + m[a][2] * old[2];
  }
}

static void recentre(Parts *p, double mass)
{
  double com[3] = {0};
  for (long i = 0; i < p->n; i++)
    for (int a = 0; a < 3; a++) com[a] += p->m[i] * p->x[3 * i + a] / mass;
  for (long i = 0; i < p->n; i++)
    for (int a = 0; a < 3; a++) p->x[3 * i + a] -= com[a];
}

/* The field Distention, where any layer has pores. */
static int add_pores(const Task *t, Parts *p, Err *err)
{
  double most = 0, *d;
  for (int k = 0; k < t->body->layers; k++) most = fmax(most, t->body->layer[k].pores);
  if (most == 0) return 0;
  if (!(d = part_add_extra(p, "Distention", "1", "solid over bulk density", err))) return -1;
  for (long i = 0; i < p->n; i++) d[i] = 1 / (1 - t->body->layer[t->at[i].layer].pores);
  return 0;
}

/* Masses scaled to those of the layers, states, supports for the wanted number of neighbours. */
static int fill(const Task *t, Placed *out, Err *err)
{
  double sum[STRUCTURE_LAYERS] = {0};
  int d = t->how->dimension, rigid = t->how->placing == PLACE_HCP || t->how->placing == PLACE_CUBIC;
  Parts *p = out->p = part_new(t->n);
  if (!p || part_add(p, "id x v m rho u h mat body", err) ||
      (!t->body->weightless && part_add(p, "p cs", err)))
    return err_set(err, "no memory for %ld particles", t->n);
  p->dimension = d;
  for (int k = 0; k < t->body->layers; k++) out->number[k] = t->end[k + 1] - t->end[k];
  for (long i = 0; i < t->n; i++) sum[t->at[i].layer] += t->share[i];
  memcpy(p->x, t->x, (size_t)t->n * 3 * sizeof *p->x);
  for (long i = 0; i < t->n; i++) {
    const StructureNode *at = &t->at[i];
    const StructureLayer *l = &t->body->layer[at->layer];
    double volume = t->total / (double)t->n;
    p->id[i] = i, p->mat[i] = l->mat;
    p->m[i] = l->mass * t->share[i] / sum[at->layer];
    p->rho[i] = at->rho, p->u[i] = at->u;
    if (!rigid) volume = p->m[i] / at->rho;
    p->h[i] = recipe_radius(d, t->how->neighbours * volume);
    if (!t->body->weightless) p->p[i] = at->p, p->cs[i] = at->cs;
  }
  out->h = recipe_radius(d, t->how->neighbours * t->total / (double)t->n);
  out->spacing = pow(t->total / (double)t->n *
                         (t->how->placing == PLACE_CUBIC || d == 1 ? 1
                          : d == 2                                 ? 2 / sqrt(3)
                                                                   : sqrt(2)),
                     1. / d);
  if (t->how->seed >= 0 && t->how->placing != PLACE_SHELLS) turn(p, (uint64_t)t->how->seed);
  for (long i = 0; i < t->n; i++) figure_flatten(&t->at[i], p->x + 3 * i);
  recentre(p, t->mass[t->body->layers]);
  return add_pores(t, p, err);
}

int place_ball(Placed *out, const Place *how, const StructureBody *body, const Structure *s,
               Err *err)
{
  Task t = {.how = how, .body = body, .s = s};
  int rc;
  *out = (Placed){0};
  if (how->dimension < 3 && how->placing == PLACE_SHELLS)
    return err_set(err, "shells need 3 dimensions");
  rc = prepare(&t, err);
  if (!rc) rc = how->placing == PLACE_SHELLS ? shells(&t, err) : lattice(&t, err);
  if (!rc) rc = fill(&t, out, err);
  if (rc) part_free(out->p), out->p = NULL;
  free(t.x), free(t.at), free(t.share);
  return rc;
}
