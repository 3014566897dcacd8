/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Speeds are taken relative to the body's centre and rigid spin omega = I^-1 L, as the damping
 * does. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_sort.h>
#include "../../lib/figure.h"
#include "../../lib/group.h"
#include "../../lib/unit.h"
#include "measure.h"

int measure_quiet(const Measure *m) { return m->high < 0.01 && m->balance < 1e-5; }

void measure_settle(Parts *p)
{
  double mass = 0, x[3] = {0}, v[3] = {0};
  for (long i = 0; i < p->n; i++) {
    mass += p->m[i];
    for (int d = 0; d < 3; d++)
      x[d] += p->m[i] * p->x[3 * i + d], v[d] += p->m[i] * p->v[3 * i + d];
  }
  for (long i = 0; i < p->n; i++)
    for (int d = 0; d < 3; d++) p->x[3 * i + d] -= x[d] / mass, p->v[3 * i + d] -= v[d] / mass;
}

/* Velocity of particle i in the frame of g; returns |r|, and in *level the mean radius of its level
 * surface. */
static double place(const Parts *p, const Structure *s, const Group *g, long i, double v[3],
                    double *level)
{
  double w2 = 0, wr = 0, r2 = 0, high;
  double r[3], spin[3];
  for (int d = 0; d < 3; d++) r[d] = p->x[3 * i + d] - g->x[d];
  for (int d = 0; d < 3; d++) {
    int e = (d + 1) % 3, f = (d + 2) % 3;
    spin[d] = g->omega[e] * r[f] - g->omega[f] * r[e];
    v[d] = p->v[3 * i + d] - g->v[d] - spin[d];
  }
  for (int d = 0; d < 3; d++)
    r2 += r[d] * r[d], w2 += g->omega[d] * g->omega[d], wr += g->omega[d] * r[d];
  high = w2 > 0 ? wr / sqrt(w2) : 0;
  *level = figure_level(s, sqrt(fmax(0, r2 - high * high)), high);
  return sqrt(r2);
}

/* Whether a ball of radius h about a point of the level r lies in the layer. */
static int inside(const Structure *s, int layer, double r, double h)
{
  double low = s->node[s->first[layer]].r, high = s->node[s->first[layer + 1] - 1].r;
  return (layer == 0 || r - h > low) && r + h < high;
}

/* The profile at r, or where the layer begins or ends when r lies outside of it. */
static StructureNode within(const Structure *s, int layer, double r)
{
  const StructureNode *first = &s->node[s->first[layer]], *last = &s->node[s->first[layer + 1] - 1];
  return r <= first->r ? *first : r >= last->r ? *last : structure_at_radius(s, r);
}

static void sums(const Parts *p, const Structure *s, const int *layer, const Group *g,
                 double *speed, Measure *o)
{
  double kinetic = 0, off = 0, centre = 0, want = 0, off_inside = 0, v[3];
  long n_inside = 0;
  for (long i = 0; i < p->n; i++) {
    double level, r = place(p, s, g, i, v, &level), v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    StructureNode at = within(s, layer[i], level);
    speed[i] = sqrt(v2);
    kinetic += 0.5 * p->m[i] * v2;
    off += pow(p->rho[i] / at.rho - 1, 2);
    if (inside(s, layer[i], level, p->h[i])) {
      off_inside += pow(p->rho[i] / at.rho - 1, 2);
      n_inside++;
    }
    if (r > o->radius) o->radius = r;
    if (at.m < 0.01 * g->mass) centre += p->m[i] * p->p[i], want += p->m[i] * at.p;
  }
  o->balance = g->e_pot < 0 ? kinetic / -g->e_pot : NAN;
  o->rms = sqrt(2 * kinetic / g->mass) / o->vesc;
  o->density = sqrt(off / (double)p->n);
  o->inside = n_inside ? sqrt(off_inside / (double)n_inside) : NAN;
  o->pressure = want > 0 ? centre / want : NAN;
}

int measure_body(const Parts *p, const Structure *s, const int *layer, double spacing, Measure *o,
                 Err *err)
{
  Group g;
  double *speed;
  memset(o, 0, sizeof *o);
  if (group_system(&g, p, 0.7, err)) return -1;
  if (!(speed = malloc(sizeof *speed * (size_t)p->n))) {
    group_free(&g);
    return err_set(err, "not enough memory");
  }
  o->vesc = sqrt(2 * UNIT_G * g.mass / s->node[s->n - 1].r);
  sums(p, s, layer, &g, speed, o);
  gsl_sort(speed, 1, (size_t)p->n);
  o->max = speed[p->n - 1] / o->vesc;
  o->high = speed[(long)(0.999 * (double)(p->n - 1))] / o->vesc;
  o->radius += 0.5 * spacing;
  o->volume = cbrt(0.75 * g.volume / acos(-1));
  free(speed);
  group_free(&g);
  return 0;
}
