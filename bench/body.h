/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles for the benches of whole steps. Every failure ends the program. */
#ifndef BODY_H
#define BODY_H

#include <math.h>
#include <stdlib.h>
#include "lib/lattice.h"
#include "lib/material.h"
#include "lib/rng.h"
#include "lib/weibull.h"

static const double BODY_PI = 3.14159265358979323846;
static const double BODY_NEIGHBOURS = 57, BODY_ENERGY = 1e3; /* J/kg */
static const double BODY_RADIUS = 2e5, BODY_EDGE = 4e5;      /* m */

/* body_need: dies when failed. */
static inline void body_need(int failed, const Err *err)
{
  if (failed) err_die("%s", err->text);
}

static inline Parts *body_new(long n, const char *name, const char *text)
{
  Err err;
  Parts *p = part_new(n);
  if (!p) err_die("no memory");
  body_need(part_add(p, "id x v m rho u h mat body", &err) ||
                part_add_material(p, name, text, &err),
            &err);
  return p;
}

/* What all particles have of a volume [m^3] at the density of their bulk; flaws where the material
 * breaks and `flaws` asks for them. */
static inline void body_fill(Parts *p, double volume, int flaws)
{
  Err err;
  WeibullGroup *group;
  int groups;
  Material *m = material_load(p, &err);
  body_need(!m, &err);
  const double solid = eos_rho0(&m->eos), alpha = material_distention(m);
  const double rho = (solid > 0 ? solid : 2700) / alpha;
#pragma omp parallel for
  for (long i = 0; i < p->n; i++) {
    p->id[i] = i, p->rho[i] = rho, p->m[i] = rho * volume, p->u[i] = BODY_ENERGY;
    p->h[i] = cbrt(BODY_NEIGHBOURS * 3 / (4 * BODY_PI) * volume);
  }
  if (flaws && material_brittle(m)) {
    body_need(
        weibull_assign(p, m, &(WeibullOptions){.seed = 1, .minimum = 1}, &group, &groups, &err),
        &err);
    free(group);
  }
  material_free(m, p->materials);
}

/* body_spheres: two of 200 km on HCP lattices that touch, closing at 100 m/s, each falling together
 * at 1e-4 of its size a second; n particles together. */
static inline Parts *body_spheres(long n, const char *name, const char *text, int flaws)
{
  Err err;
  LatticeBall ball;
  body_need(lattice_ball(&ball, LATTICE_HCP, 3, n / 2, &err), &err);
  const double a = BODY_RADIUS * cbrt(4 * BODY_PI / (3 * (double)ball.n * ball.volume));
  Parts *p = body_new(2 * ball.n, name, text);
#pragma omp parallel for
  for (long i = 0; i < p->n; i++) {
    const long k = i % ball.n, body = i / ball.n;
    for (int d = 0; d < 3; d++) {
      p->x[3 * i + d] = a * ball.x[3 * k + d];
      p->v[3 * i + d] = -1e-4 * p->x[3 * i + d];
    }
    p->x[3 * i] += (body ? 1 : -1) * BODY_RADIUS, p->v[3 * i] += body ? -50 : 50;
    p->body[i] = (int32_t)body;
  }
  body_fill(p, a * a * a * ball.volume, flaws);
  lattice_free(&ball);
  return p;
}

/* body_box: a cube from 0 to 400 km on a cubic lattice, each particle off its place by up to 5 % of
 * the spacing, in a wave of 50 m/s; its lowest tenth in z is body 1. Opposite faces fit. */
static inline Parts *body_box(long n, const char *name, const char *text, int flaws)
{
  const long side = lround(cbrt((double)n));
  const double a = BODY_EDGE / (double)side;
  Parts *p = body_new(side * side * side, name, text);
#pragma omp parallel for
  for (long i = 0; i < p->n; i++) {
    const long at[3] = {i % side, i / side % side, i / side / side};
    for (uint32_t d = 0; d < 3; d++)
      p->x[3 * i + d] = a * ((double)at[d] + 0.5 + 0.1 * (rng_uniform(1, (uint64_t)i, d) - 0.5));
    p->v[3 * i + 1] = 50 * sin(2 * BODY_PI * p->x[3 * i] / BODY_EDGE);
    p->body[i] = 10 * at[2] < side;
  }
  body_fill(p, a * a * a, flaws);
  return p;
}

#endif
