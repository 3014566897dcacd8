/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plasticity: the list and the dispatch. A law is one file in yield/ that returns the factor f <= 1
 * by which the deviatoric stress is scaled. Form "none" leaves the stress alone (elastic). */
#ifndef YIELD_H
#define YIELD_H

#include "hd.h"

#include "yield/von_mises.h"
#include "yield/benz_asphaug.h"

/* X(CAPITAL, name): token strength.form, file yield/<name>.h, struct yield_<name>, function
 * yield_<name>. */
#define YIELD_LAWS(X) X(VON_MISES, von_mises) X(BENZ_ASPHAUG, benz_asphaug)

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

/* yield_factor: f in 0..1 for j2 [Pa^2], pressure p [Pa], damage 0..1, energy u [J/kg] and melt
 * energy [J/kg] (0: none). Laws use what they need; above the melt energy f is 0, below it the
 * yield stress falls with (1 - u/melt) (as Benz & Asphaug 1999 do). */
HD double yield_factor(const Yield *y, double j2, double p, double damage, double u, double melt)
{
  double soft = melt > 0 ? 1 - u / melt : 1;
  if (y->form == YIELD_NONE) return 1;
  if (soft <= 0) return 0;
  if (soft > 1) soft = 1;
  switch (y->form) {
#define YIELD_CASE(CAPITAL, NAME)                                                                  \
  case YIELD_##CAPITAL: return yield_##NAME(&y->NAME, j2, p, damage, soft);
    YIELD_LAWS(YIELD_CASE)
#undef YIELD_CASE
  default: return 1;
  }
}

#endif
