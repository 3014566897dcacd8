/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../../lib/group.h"
#include "../../lib/potential.h"
#include "../../lib/unit.h"
#include "finish.h"

static const double FAR = 1.5, SPINS = 1e-4; /* in radii; of the escape speed at the surface */

/* keep [n]: bound and near. Returns the mass that is neither [kg]. */
static double choose(const Body *b, const Group *g, const double *phi, unsigned char *keep,
                     long *lost)
{
  const Parts *p = b->p;
  double far = FAR * b->s.node[b->s.n - 1].r / (1 - b->s.node[b->s.n - 1].f), mass = 0;
  for (long i = 0; i < p->n; i++) {
    double r = group_apart(p->x + 3 * i, g->x), v = group_apart(p->v + 3 * i, g->v);
    keep[i] = r < far && 0.5 * v * v + phi[i] < 0;
    if (!keep[i]) mass += p->m[i], ++*lost;
  }
  return mass;
}

int finish_eject(Body *b, Err *err)
{
  size_t n = (size_t)b->p->n;
  unsigned char *keep = malloc(n);
  double *phi = malloc(n * sizeof *phi), mass = 0;
  long *list = malloc(n * sizeof *list), lost = 0;
  Group g;
  int rc = keep && phi && list ? 0 : err_set(err, "not enough memory");
  for (size_t i = 0; !rc && i < n; i++) list[i] = (long)i;
  if (!rc) rc = potential_own(b->p, list, (long)n, 0.7, phi, err);
  if (!rc && !(rc = group_system(&g, b->p, -1, err)))
    mass = choose(b, &g, phi, keep, &lost), group_free(&g);
  if (!rc && lost == (long)n) rc = err_set(err, "the body has flown apart");
  if (!rc && lost) {
    err_warn("%ld particles, %.3g kg, were ejected and are removed", lost, mass);
    rc = body_keep(b, keep, err) || part_set_number(b->p, "body", "EjectedMass0", mass, err);
  }
  free(keep), free(phi), free(list);
  return rc ? -1 : 0;
}

/* Velocities in the frame of g: all of them rigid, or only the rotation off. */
static void rotate(Parts *p, const Group *g, int rigid, int off)
{
  for (long i = 0; i < p->n; i++)
    for (int d = 0; d < 3; d++) {
      int e = (d + 1) % 3, f = (d + 2) % 3;
      double spin = g->omega[e] * p->x[3 * i + f] - g->omega[f] * p->x[3 * i + e];
      if (rigid) p->v[3 * i + d] = off ? 0 : spin;
      if (!rigid && off) p->v[3 * i + d] -= spin;
    }
}

int finish_settle(Body *b, int rigid, Err *err)
{
  Group g;
  const StructureNode *top = &b->s.node[b->s.n - 1];
  double omega, least = SPINS * sqrt(2 * UNIT_G * top->m / top->r) / top->r;
  int spins;
  measure_settle(b->p);
  if (group_system(&g, b->p, -1, err)) return -1;
  omega = sqrt(g.omega[0] * g.omega[0] + g.omega[1] * g.omega[1] + g.omega[2] * g.omega[2]);
  spins = !isnan(b->omega) || omega > least;
  rotate(b->p, &g, rigid, !spins);
  if (spins) {
    fprintf(stderr, "relax: it turns once in %.6g s", 2 * acos(-1) / omega);
    if (!isnan(b->omega)) fprintf(stderr, "; asked for were %.6g s", 2 * acos(-1) / b->omega);
    fprintf(stderr, "\n");
  }
  group_free(&g);
  return spins ? part_set_number(b->p, "body", "MeasuredPeriod0", 2 * acos(-1) / omega, err) : 0;
}

int finish_reset(Body *b, int fluid, const Measure *m, Err *err)
{
  const StructureNode *top = &b->s.node[b->s.n - 1];
  Parts *p = b->p;
  size_t n = (size_t)p->n;
  if (p->damage) memset(p->damage, 0, sizeof *p->damage * n);
  if (p->nact) memset(p->nact, 0, sizeof *p->nact * n);
  if (p->strain) memset(p->strain, 0, sizeof *p->strain * n);
  if (p->pmax) memset(p->pmax, 0, sizeof *p->pmax * n);
  if (p->s && fluid) memset(p->s, 0, 6 * sizeof *p->s * n);
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
