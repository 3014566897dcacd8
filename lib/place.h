/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles placed in a layered ball, each layer with exactly its mass (docs/theory.md 6.1). */
#ifndef PLACE_H
#define PLACE_H

#include "lattice.h"
#include "part.h"
#include "structure.h"

/* X(CAPITAL, name): lattices as they are (the particles have equal volumes); the close packing with
 * its shells moved in radius; shells of stretched equal areas. */
#define PLACES(X) X(HCP, hcp) X(CUBIC, cubic) X(STRETCHED, stretched) X(SHELLS, shells)

typedef enum {
#define PLACE_ENUM(CAPITAL, NAME) PLACE_##CAPITAL,
  PLACES(PLACE_ENUM)
#undef PLACE_ENUM
} Placing;

#define PLACE_WORD(CAPITAL, NAME) "|" #NAME
#define PLACE_WORDS               (&PLACES(PLACE_WORD)[1])

typedef struct {
  int dimension; /* 1, 2 or 3; below 3 without gravity, and a lattice */
  long n;        /* particles wanted; shells have exactly as many */
  Placing placing;
  int equal_mass;    /* of STRETCHED and SHELLS: all masses the same, else all volumes at rest */
  double neighbours; /* in the support, itself included */
  long seed;         /* turns the lattice at random; < 0: not */
} Place;

typedef struct {
  Parts *p;
  double spacing, h; /* of a close packing with the mean volume, m; mean support */
  long number[STRUCTURE_LAYERS];
} Placed;

/* place_ball: fields x m rho u h mat id body, and p cs with gravity; the centre of mass is the
 * origin. s: the structure of the body; not looked at when it is without gravity. Errors: a layer
 * too thin for a particle. */
int place_ball(Placed *out, const Place *how, const StructureBody *body, const Structure *s,
               Err *err);

#endif
