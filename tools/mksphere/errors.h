/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How well particles stand for the structure that they were placed on. */
#ifndef ERRORS_H
#define ERRORS_H

#include "lib/part.h"
#include "lib/structure.h"

typedef struct {
  long inside;     /* particles whose support holds one layer and no surface */
  double density;  /* rms of SPH density over the structure's, minus 1; of those inside */
  double noise;    /* standard deviation of the same: what is left when the mean is taken off */
  double push;     /* how much weaker (< 0) or stronger than p pressure acts: mean of
                      -(1/D) sum V_j x.grad W minus 1; of those inside */
  double pressure; /* rms of p(SPH density, u) minus the structure's, over the central pressure */
  double mass;     /* rms of M(<r) of the particles minus the structure's, over the whole */
} Errors;

/* errors_measure: with the kernel that the solver takes by default. s: NULL when there is none
 * (pressure and mass become NAN). material: by mat. */
int errors_measure(Errors *out, const Parts *p, const Material *const *material, const Structure *s,
                   Err *err);

#endif
