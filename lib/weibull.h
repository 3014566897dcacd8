/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flaws of brittle materials after Weibull, thrown as by Benz & Asphaug (1994) and 001 sect. 3.2:
 * in a volume V there are k V e^m flaws that a strain e activates, so flaw number j has the
 * threshold (j/(k V))^(1/m) (001 eq. 45). They are thrown in this order at random particles until
 * each has at least one; that takes N H_N = N (ln N + 0.577) + 1/2 flaws on average. V is the
 * volume of the solid: pores do not break. */
#ifndef WEIBULL_H
#define WEIBULL_H

#include "part.h"
#include "../physics/material.h"

typedef struct {
  int32_t body;
  uint64_t seed;
} WeibullSeed;

typedef struct {
  uint64_t seed;            /* of all bodies ... */
  const WeibullSeed *seeds; /* [bodies] ... but these */
  int bodies;
  const double *k, *m; /* [materials] instead of the material's own; NULL or NAN: its own */
  double flaws;        /* throw at least so many a particle, on average */
  long minimum;        /* and go on until each particle has so many; the usual is 1 */
} WeibullOptions;

/* Particles of one brittle material in one body share one volume and one sequence of flaws. */
typedef struct {
  int32_t body, mat;
  long n;        /* particles */
  double volume; /* of the solid, sum m/(rho distention) [m^3] */
  double k, m;   /* Weibull parameters [1/m^3, 1] */
  uint64_t seed;
  int64_t flaws;            /* thrown */
  double expected, scatter; /* flaws thrown: mean and standard deviation over all seeds */
  int32_t least, most;      /* flaws of a particle */
  double lowest, highest;   /* thresholds (strain) */
  double weakest; /* threshold of a particle's weakest flaw, mean of those that have one */
  double weakest_expected;
} WeibullGroup;

/* weibull_threshold: strain at which flaw j = 1, 2, ... becomes active, by logarithms (k V reaches
 * 1e80). */
double weibull_threshold(int64_t j, double k, double m, double volume);

/* weibull_expected: how many flaws are thrown at n particles on average, N integral_0^inf
 * 1 - (1 - P(fewer than `minimum` of t))^N dt with P of Poisson's distribution, from `flaws` a
 * particle on, and their standard deviation (both exact for flaws = 0; N H_N and nearly
 * pi/sqrt(6) N for a minimum of 1). Source: Newman & Shepp (1960), Amer. Math. Monthly 67, 58. */
double weibull_expected(long n, long minimum, double flaws, double *scatter);

/* weibull_assign: sets nflaw and flaw of all particles, and damage (and nact, if there) to zero.
 * Flaw j of a group goes to the particle that a random number keyed by (seed, j, group) chooses
 * among its particles in order of id: the order of the particles and the machine do not matter.
 * Needs id m rho mat body; unique ids. Pores by the field Distention when there is one. *group
 * [*groups] is for the caller to free. */
int weibull_assign(Parts *p, const Material *material, const WeibullOptions *o,
                   WeibullGroup **group, int *groups, Err *err);

#endif
