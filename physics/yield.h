/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plasticity: the list and the dispatch. A law is one file in yield/ that returns the factor f <= 1
 * by which the deviatoric stress is scaled. Form "none" leaves the stress alone (elastic).
 *
 * Which stress a law limits is part of it: metals are measured in uniaxial tension, so von_mises,
 * benz_asphaug and johnson_cook limit sqrt(3 J2); the strength of rock and soil is one of shear, so
 * the others limit sqrt(J2) (docs/theory.md 3.3). */
#ifndef YIELD_H
#define YIELD_H

#include "tensor.h"

/* What a law may look at. */
typedef struct {
  Sym s;         /* deviatoric stress before [Pa] */
  double j2;     /* its second invariant [Pa^2] */
  double p;      /* pressure [Pa] */
  double damage; /* 0..1 */
  double soft;   /* what heat leaves of the strength, 0..1 */
  double weak;   /* what low density leaves of the cohesion, 0..1 */
  double strain; /* equivalent plastic strain so far */
  double rate;   /* equivalent strain rate [1/s] */
  double T;      /* temperature [K] */
  double pores;  /* shear strength that the porosity law gives [Pa] */
} YieldPoint;

/* yield_return: the factor that takes a stress back to its limit. */
HD double yield_return(double stress, double limit)
{
  return stress > limit ? (limit > 0 ? limit / stress : 0) : 1;
}

#include "yield/von_mises.h"
#include "yield/benz_asphaug.h"
#include "yield/drucker_prager.h"
#include "yield/mohr_coulomb.h"
#include "yield/lundborg.h"
#include "yield/collins.h"
#include "yield/johnson_cook.h"
#include "yield/porous.h"
#include "yield/regolith.h"
#include "yield/viscous_regolith.h"

/* X(CAPITAL, name): token strength.form, file yield/<name>.h, struct yield_<name>, function
 * yield_<name>. */
#define YIELD_LAWS(X)                                                                              \
  X(VON_MISES, von_mises)                                                                          \
  X(BENZ_ASPHAUG, benz_asphaug)                                                                    \
  X(DRUCKER_PRAGER, drucker_prager)                                                                \
  X(MOHR_COULOMB, mohr_coulomb)                                                                    \
  X(LUNDBORG, lundborg)                                                                            \
  X(COLLINS, collins)                                                                              \
  X(JOHNSON_COOK, johnson_cook)                                                                    \
  X(POROUS, porous) X(REGOLITH, regolith) X(VISCOUS_REGOLITH, viscous_regolith)

typedef enum {
  YIELD_NONE,
#define YIELD_ENUM(CAPITAL, NAME) YIELD_##CAPITAL,
  YIELD_LAWS(YIELD_ENUM)
#undef YIELD_ENUM
      YIELD_COUNT
} YieldForm;

/* YIELD_WORDS: "none|von_mises|..." in the order of the enum. */
#define YIELD_WORD(CAPITAL, NAME) "|" #NAME
#define YIELD_WORDS               "none" YIELD_LAWS(YIELD_WORD)

typedef struct {
  int form; /* YieldForm */
  union {
#define YIELD_MEMBER(CAPITAL, NAME) struct yield_##NAME NAME;
    YIELD_LAWS(YIELD_MEMBER)
#undef YIELD_MEMBER
  };
} Yield;

/* yield_factor: f in 0..1. */
HD double yield_factor(const Yield *y, const YieldPoint *at)
{
  if (y->form != YIELD_NONE && at->soft <= 0) return 0;
  switch (y->form) {
#define YIELD_CASE(CAPITAL, NAME)                                                                  \
  case YIELD_##CAPITAL: return yield_##NAME(&y->NAME, at);
    YIELD_LAWS(YIELD_CASE)
#undef YIELD_CASE
  default: return 1;
  }
}

/* yield_knows_pressure: whether the law depends on p. */
HD int yield_knows_pressure(const Yield *y)
{
  return y->form == YIELD_DRUCKER_PRAGER || y->form == YIELD_MOHR_COULOMB ||
         y->form == YIELD_LUNDBORG || y->form == YIELD_COLLINS;
}

/* yield_tension: the largest tension -p [Pa] that the law allows, where its strength in shear ends:
 * INFINITY for the laws that do not know pressure. */
HD double yield_tension(const Yield *y, double damage, double soft, double weak)
{
  switch (y->form) {
  case YIELD_DRUCKER_PRAGER: return soft * yield_drucker_prager_apex(&y->drucker_prager, weak);
  case YIELD_MOHR_COULOMB: return soft * yield_mohr_coulomb_apex(&y->mohr_coulomb, weak);
  case YIELD_LUNDBORG: return soft * weak * y->lundborg.cohesion;
  case YIELD_COLLINS: return soft * yield_collins_apex(&y->collins, damage, weak);
  default: return INFINITY;
  }
}

/* yield_soft: what heat leaves of the strength, 1 - u/melt in 0..1 (as Benz & Asphaug 1999 do);
 * melt = 0: no melt energy known. */
HD double yield_soft(double u, double melt)
{
  double soft = melt > 0 ? 1 - u / melt : 1;
  return soft < 0 ? 0 : soft > 1 ? 1 : soft;
}

/* Low-density weakening: what has been pulled or thrown apart has lost its contacts. Factor of the
 * cohesion at eta = rho/rho0 (of the solid, where it is porous): 1 for eta >= 1, down to gamma at
 * eta = limit as ((eta - limit)/(1 - limit))^alpha, then gamma (eta/limit)^beta. As in miluphcuda;
 * Luther et al. (2022), Planet. Sci. J. 3, 227. */
typedef struct {
  double limit, alpha, beta, gamma;
} YieldWeak;

HD_CALL double yield_weak(const YieldWeak *w, double eta)
{
  if (eta >= 1) return 1;
  if (eta <= 0) return 0;
  if (eta > w->limit)
    return pow((eta - w->limit) / (1 - w->limit), w->alpha) * (1 - w->gamma) + w->gamma;
  return pow(eta / w->limit, w->beta) * w->gamma;
}

#endif
