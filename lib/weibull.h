/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flaws of brittle materials after Weibull, thrown as by Benz & Asphaug (1994) and 001 sect. 3.2:
 * in a volume V there are k V e^m flaws that a strain e activates, so flaw number j has the
 * threshold (j/(k V))^(1/m) (001 eq. 45). They are thrown in this order at random particles until
 * each has at least one; that takes N H_N = N (ln N + 0.577) + 1/2 flaws on average. */
#ifndef WEIBULL_H
#define WEIBULL_H

#include "part.h"
#include "../physics/material.h"

/* Particles of one brittle material in one body share one volume and one sequence of flaws. */
typedef struct {
  int32_t body, mat;
  long n;                 /* particles */
  double volume;          /* sum m/rho [m^3] */
  double k, m;            /* Weibull parameters [1/m^3, 1] */
  int64_t flaws;          /* thrown */
  double lowest, highest; /* thresholds (strain) */
} WeibullGroup;

/* weibull_threshold: strain at which flaw j = 1, 2, ... becomes active, by logarithms (k V reaches
 * 1e80). */
double weibull_threshold(int64_t j, double k, double m, double volume);

/* weibull_assign: sets nflaw and flaw of all particles, and damage (and nact, if there) to zero. k,
 * m override those of every brittle material unless they are NAN. Flaw j of a group goes to the
 * particle that a random number keyed by (seed, j, group) chooses among its particles in order of
 * id: the order of the particles and the machine do not matter. Needs id m rho mat body; unique
 * ids. *group [*groups] is for the caller to free. */
int weibull_assign(Parts *p, const Material *material, uint64_t seed, double k, double m,
                   WeibullGroup **group, int *groups, Err *err);

#endif
