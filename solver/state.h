/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The particles as the solver sees them: one array a field, made from lib/fields.h, plus work
 * arrays that no file holds. Pointers live where the backend lives (host or device); everything
 * here compiles in C and CUDA. Arrays are in tree order. Those of stress (s, g, cm, t, strain), of
 * flaws and of rates (ds) may be NULL where a run has no solids, no damage, no use for rates. */
#ifndef STATE_H
#define STATE_H

#include "../lib/fields.h"
#include "../physics/material.h"
#include "bounds.h"

/* Work arrays: W(type, member, width, meaning). Those of the first list move with their particle
 * when the order changes. */
/* clang-format off */
#define MOVED_FIELDS(W) \
  W(int64_t, row,    1, "row in the input and in every snapshot") \
  W(int64_t, flaw0,  1, "where its thresholds begin in flaw") \
  W(int32_t, nflaw,  1, "number of thresholds") \
  W(double,  y,      3, "position at which loop A is evaluated [m]") \
  W(double,  vp,     3, "velocity that the force loop sees [m/s]") \
  W(double,  rhoa,   1, "density at loop A [kg/m^3]") \
  W(double,  ha,     1, "h at loop A [m]")
#define WORK_FIELDS(W) \
  W(double,  g,      9, "velocity gradient dv_a/dx_b, corrected [1/s]") \
  W(double,  du,     1, "energy rate of this evaluation [W/kg]") \
  W(double,  acc,    3, "acceleration of this evaluation, gravity included [m/s^2]") \
  W(double,  ds,     6, "dS/dt, Jaumann rate included [Pa/s]") \
  W(double,  ue,     1, "energy at which the EOS was evaluated [J/kg]") \
  W(double,  cm,     6, "inverse moment matrix of loop A, what corrects the gradient") \
  W(double,  push,   1, "p/rho^2 [Pa m^6/kg^2], miscible: times m^2, product: p [Pa]; damage included") \
  W(double,  t,      9, "S C, damage included [Pa]") \
  W(double,  pull0,  3, "gravity at the evaluation before (gravity.tolerance) [m/s^2]") \
  W(double,  cl,     1, "longitudinal wave speed [m/s]") \
  W(double,  theta,  1, "sum of V_j W_ij at loop A, itself included (form.shepard)") \
  W(double,  omega,  1, "1 + h/(D rho) sum m_j dW_ij/dh_i (form.grad_h)") \
  W(double,  extra,  8, "PairExtra, of runs with more pair terms")
/* clang-format on */

/* What an integrator may put aside: the evolved quantities (active: nact), or rates of them; the
 * fields old_* are rates of the step before. */
/* clang-format off */
#define RATE_FIELDS(V) V(x, 3) V(v, 3) V(rho, 1) V(u, 1) V(s, 6) V(crack, 1) V(h, 1)
#define SAVED_FIELDS(V) RATE_FIELDS(V) V(alpha, 1) V(active, 1)
/* clang-format on */
enum { STATE_SLOTS = 4 };

typedef struct {
#define SAVED_MEMBER(MEMBER, WIDTH) double *MEMBER;
  SAVED_FIELDS(SAVED_MEMBER)
#undef SAVED_MEMBER
} Saved;

/* The least that a run lets a state have. */
typedef struct {
  int pressure; /* whether there is a floor of the pressure */
  double p, u;  /* Pa, J/kg */
  double lone;  /* of the density: in units of m/h^D */
} Floors;

typedef struct {
  long n;         /* particles */
  long all, room; /* and their images behind them (x, y, h, ha, m, id); rows there is room for */
  Image *image;   /* [room]; NULL: there are none */
  Bounds bounds;
  int dimension;
  double h_min, h_max;      /* range of h [m]; 0, INFINITY: h does not change */
  int rare;                 /* any material has laws that few runs need (material_rare) */
  const Material *material; /* [materials], indexed by mat */
  const double *flaw;       /* thresholds of all particles, ascending within one */
  Floors floors;
  double force[3];  /* constant body force [m/s^2] */
  double centre[3]; /* of the disk, for laws that depend on the distance from it [m] */
  double sheet;     /* det of a moment matrix, over the cube of its mean eigenvalue, from which on
                      gradients are corrected; INFINITY: they never are */
  double margin;    /* how far the search reaches beyond h, over h: 0, but with grad-h */
  int integrated;   /* the number density goes by its continuity equation */
#define STATE_MEMBER(TYPE, MEMBER, ...) TYPE *MEMBER;
  ALL_FIELDS(STATE_MEMBER)
  MOVED_FIELDS(STATE_MEMBER)
  WORK_FIELDS(STATE_MEMBER)
#undef STATE_MEMBER
  Saved saved[STATE_SLOTS];
} State;

#endif
