/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One-dimensional hydrostatic structure of a layered body: dp/dr = -G m rho/r^2 with a given
 * pressure outside. Each layer has its material and its thermal law, an isentrope (du = p/rho^2
 * drho) or T ~ rho^a, and one state that this law passes through; layers meet at exact mass
 * coordinates with the same pressure. Two independent ways (docs/theory.md 6.2): structure_solve
 * integrates outwards and finds the central pressure, lagrange_relax (lagrange.h) lets shells fall
 * to rest. */
#ifndef STRUCTURE_H
#define STRUCTURE_H

#include "err.h"
#include "../physics/material.h"

enum { STRUCTURE_LAYERS = 16 };

/* What is known of a layer's thermal state: X(CAPITAL, name, unit, meaning); the name is the word
 * in layers' texts and files. */
/* clang-format off */
#define STRUCTURE_ANCHORS(X) \
  X(ENERGY,      u, "J/kg",   "energy at zero pressure") \
  X(ENTROPY,     s, "J/K/kg", "entropy at the top of the layer") \
  X(TEMPERATURE, T, "K",      "temperature at the top of the layer") \
  X(CONTINUOUS,  continuous, "1", "temperature as at the bottom of the layer above")
/* clang-format on */
enum {
#define STRUCTURE_ANCHOR(CAPITAL, ...) STRUCTURE_##CAPITAL,
  STRUCTURE_ANCHORS(STRUCTURE_ANCHOR)
#undef STRUCTURE_ANCHOR
};

/* A state on a layer's law: Pa, kg/m^3, J/kg, K (NAN without a heat capacity). */
typedef struct {
  double p, rho, u, t;
} StructureState;

typedef struct {
  const Material *material;
  double mass;     /* kg */
  double at;       /* value of the anchor */
  int mat;         /* number of the material among the particles' */
  int anchor;      /* STRUCTURE_ENERGY ... */
  int power;       /* 0: isentropic; else T ~ rho^exponent (0: isothermal) */
  double exponent; /* only with `power` */
  double pores;    /* volume of pores over the whole; only without gravity */
} StructureLayer;

typedef struct {
  StructureLayer layer[STRUCTURE_LAYERS]; /* from the centre outwards */
  int layers;
  double outer;   /* pressure outside [Pa] */
  int weightless; /* no gravity: the pressure is `outer` everywhere */
} StructureBody;

typedef struct {
  double r, m, rho, p, u, s, t, g, cs; /* m, kg inside r, kg/m^3, Pa, J/kg, J/K/kg, K, m/s^2, m/s */
  double rho_p, u_p;                   /* drho/dp, du/dp along the layer's law */
  double f; /* flattening 1 - c/a of the level surface; r is that of the same volume */
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

/* structure_solve: about `nodes` nodes in all. Exact to about 1e-9. */
int structure_solve(Structure *s, const StructureBody *body, long nodes, Err *err);
void structure_free(Structure *s);

/* structure_anchors: the states that the layers' laws pass through, [layers]; those that depend on
 * the structure (a temperature below the surface) by solving it. */
int structure_anchors(const StructureBody *body, StructureState *anchor, Err *err);

/* structure_move: a state along its layer's law to another pressure. structure_stiffness: dp/drho
 * [m^2/s^2] and du/drho along the law. */
int structure_move(const StructureLayer *l, const StructureState *anchor, double p,
                   StructureState *state);
double structure_stiffness(const StructureLayer *l, const StructureState *anchor, double rho,
                           double u, double *dudrho);

/* structure_heat: temperature and entropy of all nodes from their density and energy. */
void structure_heat(Structure *s, const StructureBody *body);

/* structure_at_mass: state at mass m of a layer, cubic with the exact slopes within that layer
 * (clamped to it). structure_at_radius: the same at radius r, of the layer that holds r. */
StructureNode structure_at_mass(const Structure *s, int layer, double m);
StructureNode structure_at_radius(const Structure *s, double r);

#endif
