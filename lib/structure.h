/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One-dimensional hydrostatic structure of a layered body at rest: dp/dr = -G m rho/r^2 with p = 0
 * outside. Each layer lies on the isentrope that passes through its energy u0 at zero pressure (du
 * = p/rho^2 drho), with the equation of state that the solver uses; layers meet at exact mass
 * coordinates with the same pressure. Two independent ways (docs/theory.md 6.2):
 * structure_solve integrates outwards and finds the central pressure, lagrange_relax (lagrange.h)
 * lets shells fall to rest. */
#ifndef STRUCTURE_H
#define STRUCTURE_H

#include "part.h"
#include "../physics/material.h"

enum { STRUCTURE_LAYERS = 16 };

typedef struct {
  const Eos *eos;
  double mass; /* kg */
  double u0;   /* specific energy at zero pressure [J/kg] */
  int mat;     /* material of its particles */
} StructureLayer;

typedef struct {
  double r, m, rho, p, u, g, cs; /* m, kg inside r, kg/m^3, Pa, J/kg, m/s^2, m/s */
  int layer;
} StructureNode;

/* From the centre to the surface; each side of an interface has its node. */
typedef struct {
  StructureNode *node; /* [n] */
  long n;
  int layers;
  long first[STRUCTURE_LAYERS + 1]; /* first node of each layer, and n */
} Structure;

/* structure_density: density [kg/m^3] at zero pressure and energy u >= 0: the root of p(rho, u)
 * closest to rho0. Errors: a gas, or an energy at which the material is not condensed. */
int structure_density(const Eos *eos, double u, double *rho, Err *err);

/* structure_solve: layers from the centre outwards, about `nodes` nodes in all. Exact to about
 * 1e-9. */
int structure_solve(Structure *s, const StructureLayer *layer, int layers, long nodes, Err *err);
void structure_free(Structure *s);

/* structure_at_mass: state at mass m of a layer, cubic with the exact slopes within that layer
 * (clamped to it). structure_at_radius: the same at radius r, of the layer that holds r. */
StructureNode structure_at_mass(const Structure *s, int layer, double m);
StructureNode structure_at_radius(const Structure *s, double r);

/* structure_layers: the layers of an uncompressed 3D body as mksphere makes it (each of one
 * material, density and energy), by distance from the centre of mass. of [p->n] receives the layer
 * of each particle. Returns their number, or -1. */
int structure_layers(const Parts *p, const Material *material,
                     StructureLayer layer[STRUCTURE_LAYERS], int *of, Err *err);

/* structure_lay: moves the particles of such a body radially so that each keeps its mass
 * coordinate, and sets rho, u, p, cs and h from the profile; the centre of mass goes to the origin.
 * Masses are not touched: each layer has its exact mass. */
int structure_lay(Parts *p, const Material *material, const Structure *s, Err *err);

#endif
