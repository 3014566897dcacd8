/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Edges k = 0..n carry r and v, cells k+1/2 the state; cell k lies between the edges k and k+1.
 * Equations: docs/theory.md 6.2. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "lagrange.h"
#include "unit.h"

/* Artificial viscosity, friction and stopping. */
static const double PI = 3.14159265358979323846, ALPHA = 1, BETA2 = 4, COURANT = 0.3, SLOW = 1e-4,
                    BALANCED = 1e-3;

typedef struct {
  double m, rho, u, p, c, q; /* kg, kg/m^3, J/kg, Pa (not cut at 0), m/s, Pa */
  const StructureLayer *law;
  const StructureState *anchor;
  int layer;
} Cell;

typedef struct {
  long n;
  Cell *cell;                 /* [n + 1]; cell n is the vacuum outside */
  double *r, *v, *m;          /* [n + 1] radius, velocity, mass inside of the edges */
  double tau, dt, t;          /* friction time, last step, time [s] */
  long end[STRUCTURE_LAYERS]; /* first cell outside of the layer */
} Shells;

static double area(const Shells *s, long k) { return 4 * PI * s->r[k] * s->r[k]; }
static double push(const Cell *c) { return fmax(c->p, 0); }

static double mean_area(const Shells *s, long k) { return (area(s, k) + area(s, k + 1)) / 2; }

/* Pressure force per mass on edge k, and the part of the viscosity. */
static double force(const Shells *s, long k, double *viscous)
{
  const Cell *out = s->cell + k, *in = out - 1;
  double a = area(s, k), dm = (in->m + out->m) / 2, ai = mean_area(s, k - 1),
         ao = k < s->n ? mean_area(s, k) : 0;
  *viscous = -0.5 * (out->q * (3 * ao - a) - in->q * (3 * ai - a)) / dm;
  return -a * (push(out) - push(in)) / dm;
}

static double gravity(const Shells *s, long k) { return UNIT_G * s->m[k] / (s->r[k] * s->r[k]); }

static double time_step(const Shells *s)
{
  double dt = INFINITY;
  for (long k = 0; k < s->n; k++) {
    double dr = s->r[k + 1] - s->r[k], dv = fabs(s->v[k + 1] - s->v[k]);
    dt = fmin(dt, COURANT * dr / (s->cell[k].c + dv));
    if (dv > 0) dt = fmin(dt, dr / (4 * BETA2 * dv));
  }
  return dt;
}

/* Along the layer's law to a new density, by the midpoint rule. */
static void compress(Cell *c, double rho)
{
  const Eos *eos = &c->law->material->eos;
  double mid = (c->rho + rho) / 2, half, slope;
  EosPoint point;
  structure_stiffness(c->law, c->anchor, c->rho, c->u, &slope);
  half = c->u + slope * (mid - c->rho);
  structure_stiffness(c->law, c->anchor, mid, half, &slope);
  c->u += slope * (rho - c->rho);
  point = eos_eval(eos, rho, c->u, 0);
  c->rho = rho, c->p = point.p, c->c = point.cs;
}

/* Step 4: only where a cell is squeezed, also as a fraction of its volume (g < 0). */
static double viscosity(const Shells *s, long k, double rho)
{
  double a = mean_area(s, k), v0 = s->v[k], v1 = s->v[k + 1], g;
  if (v1 >= v0) return 0;
  g = (v1 * (a - area(s, k + 1) / 3) - v0 * (a - area(s, k) / 3)) / a;
  return g < 0 ? -1.5 * rho * g * (ALPHA * s->cell[k].c + BETA2 * (v0 - v1)) : 0;
}

static int step(Shells *s, Err *err)
{
  double next = time_step(s), dt = s->dt > 0 ? (s->dt + next) / 2 : next, drag = dt / (2 * s->tau),
         viscous;
  for (long k = 1; k <= s->n; k++) {
    double a = force(s, k, &viscous) + viscous - gravity(s, k);
    s->v[k] = (s->v[k] * (1 - drag) + a * dt) / (1 + drag);
  }
  for (long k = 1; k <= s->n; k++) s->r[k] += s->v[k] * next;
  for (long k = 0; k < s->n; k++) {
    double volume = 4 * PI / 3 * (pow(s->r[k + 1], 3) - pow(s->r[k], 3)), old = s->cell[k].rho;
    if (!(volume > 0)) return err_set(err, "shell %ld collapsed", k);
    compress(s->cell + k, s->cell[k].m / volume);
    s->cell[k].q = viscosity(s, k, (old + s->cell[k].rho) / 2);
  }
  s->dt = next, s->t += next;
  return 0;
}

static int at_rest(const Shells *s)
{
  double slow = SLOW * sqrt(2 * UNIT_G * s->m[s->n] / s->r[s->n]), viscous;
  for (long k = 1; k <= s->n; k++) {
    double g = gravity(s, k);
    if (!(fabs(s->v[k]) < slow && fabs(force(s, k, &viscous) - g) < BALANCED * g)) return 0;
  }
  return 1;
}

static void shells_free(Shells *s) { free(s->cell), free(s->r), free(s->v), free(s->m); }

static int allocate(Shells *s, long n, Err *err)
{
  size_t room = (size_t)n + STRUCTURE_LAYERS * 4;
  s->cell = calloc(room, sizeof *s->cell), s->r = calloc(room, sizeof(double));
  s->v = calloc(room, sizeof(double)), s->m = calloc(room, sizeof(double));
  return s->cell && s->r && s->v && s->m ? 0 : err_set(err, "out of memory");
}

/* The body at rest, all at the pressure outside. */
static int start(Shells *s, const StructureBody *body, const StructureState *anchor, long cells,
                 Err *err)
{
  const StructureLayer *layer = body->layer;
  double inside = 0, mass = 0, volume = 0, c = 0, before = 0;
  for (int k = 0; k < body->layers; k++) mass += layer[k].mass;
  for (int k = 0; k < body->layers; k++) {
    double third = cbrt((inside + layer[k].mass) / mass), rho;
    long n = (long)fmax(3, (double)cells * (third - before));
    StructureState state;
    if (structure_move(&layer[k], &anchor[k], body->outer, &state))
      return err_set(err, "layer %d has no state at %g Pa", k + 1, body->outer);
    rho = state.rho;
    for (long i = 1; i <= n; i++) {
      double at = before + (third - before) * (double)i / (double)n;
      Cell *cell = s->cell + s->n++;
      s->m[s->n] = i == n ? inside + layer[k].mass : at * at * at * mass;
      *cell = (Cell){.m = s->m[s->n] - s->m[s->n - 1],
                     .rho = rho,
                     .u = state.u,
                     .law = &layer[k],
                     .anchor = &anchor[k],
                     .layer = k};
      compress(cell, rho);
      volume += cell->m / rho, c += cell->c * cell->m / mass;
      s->r[s->n] = cbrt(volume / (4 * PI / 3));
    }
    inside += layer[k].mass, before = third, s->end[k] = s->n;
  }
  s->cell[s->n].p = body->outer;
  s->tau = fmin(0.3 * sqrt(3 * PI / 32 / UNIT_G * volume / mass), s->r[s->n] / (2 * PI * c));
  return 0;
}

static StructureNode state(const Cell *c, double r, double m)
{
  double du, stiff = structure_stiffness(c->law, c->anchor, c->rho, c->u, &du);
  return (StructureNode){.r = r,
                         .m = m,
                         .rho = c->rho,
                         .p = push(c),
                         .u = c->u,
                         .g = r > 0 ? UNIT_G * m / (r * r) : 0,
                         .cs = c->c,
                         .rho_p = 1 / stiff,
                         .u_p = du / stiff,
                         .layer = c->layer};
}

/* The state at an edge of a cell, where m lies inside: the pressure by the weight of half the cell,
 * as in step 1 (at the centre p_c = p + 2 pi/3 G rho^2 r^2), the density on the cell's law by
 * Newton's method. */
static StructureNode edge(const Cell *cell, double from, double r, double m, double half)
{
  double g = r > 0 ? UNIT_G * m / (r * r) : 0, du;
  double p = cell->p +
             (r > 0 ? g * half / (4 * PI * r * r) : 2 * PI / 3 * UNIT_G * pow(cell->rho * from, 2));
  Cell c = *cell;
  for (int k = 0; k < 4; k++)
    compress(&c, c.rho + (p - c.p) / structure_stiffness(c.law, c.anchor, c.rho, c.u, &du));
  c.p = p;
  return state(&c, r, m);
}

/* Nodes at the middle of the cells (of volume and mass) and at both ends of each layer. */
static int result(const Shells *s, Structure *out, int layers, Err *err)
{
  *out = (Structure){.layers = layers};
  out->node = malloc((size_t)(s->n + 2 * layers) * sizeof *out->node);
  if (!out->node) return err_set(err, "out of memory");
  for (long k = 0, layer = 0; k < s->n; k++) {
    const Cell *c = s->cell + k;
    double mid = cbrt((pow(s->r[k], 3) + pow(s->r[k + 1], 3)) / 2), m = s->m[k] + c->m / 2;
    if (k == 0 || k == s->end[layer - 1])
      out->node[out->n++] = edge(c, mid, s->r[k], s->m[k], c->m / 2), layer++;
    out->node[out->n++] = state(c, mid, m);
    if (k + 1 == s->end[layer - 1]) {
      out->node[out->n++] = edge(c, mid, s->r[k + 1], s->m[k + 1], -c->m / 2);
      out->first[layer] = out->n;
    }
  }
  return 0;
}

/* The layers' laws: an isentrope of a condensed material needs no structure. */
static int anchors(const StructureBody *body, StructureState *anchor, Err *err)
{
  int known = 1;
  for (int k = 0; k < body->layers; k++) {
    const StructureLayer *l = &body->layer[k];
    known = known && l->anchor == STRUCTURE_ENERGY && !l->power && eos_rho0(&l->material->eos) > 0;
  }
  if (!known) return structure_anchors(body, anchor, err);
  for (int k = 0; k < body->layers; k++) {
    const StructureLayer *l = &body->layer[k];
    anchor[k] = (StructureState){0, 0, l->at, NAN};
    if (structure_density(&l->material->eos, l->at, &anchor[k].rho, err)) return -1;
  }
  return 0;
}

int lagrange_relax(Structure *out, const StructureBody *body, long cells, Err *err)
{
  Shells s = {0};
  StructureState anchor[STRUCTURE_LAYERS];
  double quiet = 0, fall, end;
  int rc = -1, layers = body->layers;
  if (layers < 1 || layers > STRUCTURE_LAYERS)
    return err_set(err, "%d layers, not 1..%d", layers, STRUCTURE_LAYERS);
  if (cells < 16 || cells > 100000) return err_set(err, "%ld shells, not 16..100000", cells);
  if (body->weightless) return err_set(err, "without gravity there is nothing to relax");
  if (anchors(body, anchor, err)) return -1;
  if (allocate(&s, cells, err) || start(&s, body, anchor, cells, err)) goto done;
  fall = sqrt(PI * PI / 8 * pow(s.r[s.n], 3) / (UNIT_G * s.m[s.n])); /* sqrt(3 pi/(32 G rho)) */
  end = 200 * fall;
  while (quiet < 2 * fall && s.t < end) {
    if (step(&s, err)) goto done;
    quiet = at_rest(&s) ? quiet + s.dt : 0;
  }
  if (quiet < 2 * fall)
    err_set(err, "the shells did not come to rest in 200 free-fall times (%.3g s)", end);
  else
    rc = result(&s, out, layers, err);
  if (!rc) structure_heat(out, body);
done:
  shells_free(&s);
  return rc;
}
