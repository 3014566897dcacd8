/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far a body is from equilibrium. */
#ifndef MEASURE_H
#define MEASURE_H

#include "../../lib/structure.h"

typedef struct {
  double vesc; /* sqrt(2 G M/R) of the profile [m/s] */
  double rms, high,
      max;         /* speed in the body's own (co-rotating) frame over vesc: rms, 99.9 %, max */
  double balance;  /* K/|W|: kinetic over gravitational energy in that frame */
  double density;  /* rms of rho/rho_profile(r) - 1, within the particle's own layer */
  double inside;   /* the same of those farther than h from the ends of their layer; NAN: none */
  double pressure; /* mean pressure of the innermost 1 % of mass over the profile's there */
  double radius, volume; /* largest |r| + half a spacing; radius of the volume sum m/rho [m] */
} Measure;

/* measure_body: p about its centre of mass, against the profile s. layer [p->n]: of each
 * particle. */
int measure_body(const Parts *p, const Structure *s, const int *layer, double spacing, Measure *out,
                 Err *err);

/* measure_quiet: 99.9 % of the speeds below 1 % of vesc, K/|W| below 1e-5. */
int measure_quiet(const Measure *m);

/* measure_settle: takes the mean velocity off, moves the centre of mass to 0; keeps a spin. */
void measure_settle(Parts *p);

#endif
