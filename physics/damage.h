/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Brittle damage after Grady & Kipp (1980) with explicit flaws, as in Benz & Asphaug (1994, 1995)
 * and 001 sect. 2.7 and 3.2. D in 0..1 is the damage; what grows at a constant rate is D^(1/3). */
#ifndef DAMAGE_H
#define DAMAGE_H

#include "hd.h"

/* X(CAPITAL, name) */
#define DAMAGE_LAWS(X) X(GRADY_KIPP, grady_kipp)

typedef enum {
  DAMAGE_NONE,
#define DAMAGE_ENUM(CAPITAL, NAME) DAMAGE_##CAPITAL,
  DAMAGE_LAWS(DAMAGE_ENUM)
#undef DAMAGE_ENUM
      DAMAGE_COUNT
} DamageForm;

/* DAMAGE_WORDS: "none|grady_kipp" in the order of the enum. */
#define DAMAGE_WORD(CAPITAL, NAME) "|" #NAME
#define DAMAGE_WORDS               "none" DAMAGE_LAWS(DAMAGE_WORD)

/* Parameters: X(member, SI unit, default, min, max, meaning). The Weibull k spans 1e22..1e61:
 * double only. */
/* clang-format off */
#define DAMAGE_GRADY_KIPP_ROWS(X) \
  X(k,     "1/m^3", NULL,  1e-300, 1e300, "Weibull k: k e^m flaws a volume fail below strain e") \
  X(m,     "1",     NULL,  1,      100,   "Weibull m") \
  X(crack, "1",     "0.4", 0,      1,     "crack speed in units of the longitudinal wave speed") \
  X(shear, "1",     "1",   0,      1,     "part of the damage that acts on the deviatoric stress; 0: on tension alone") \
  X(pores, "1",     "1",   0,      1,     "part of the damage that crushing of pores does; 0: none")
/* clang-format on */

struct damage_grady_kipp {
#define DAMAGE_ROW(MEMBER, ...) double MEMBER;
  DAMAGE_GRADY_KIPP_ROWS(DAMAGE_ROW)
#undef DAMAGE_ROW
};

typedef struct {
  int form; /* DamageForm */
  struct damage_grady_kipp grady_kipp;
} Damage;

/* damage_shear: what damage leaves of the deviatoric stress; of tension it leaves 1 - D. */
HD double damage_shear(const Damage *d, double damage)
{
  return 1 - (d->form == DAMAGE_NONE ? damage : d->grady_kipp.shear * damage);
}

/* damage_active: how many of the n thresholds flaw[n] (ascending strains) lie below strain e. */
HD int damage_active(const double *flaw, int n, double e)
{
  int low = 0, high = n;
  while (low < high) {
    int mid = (low + high) / 2;
    if (flaw[mid] < e)
      low = mid + 1;
    else
      high = mid;
  }
  return low;
}

/* damage_crack_speed: c_g [m/s] = crack sqrt((K + 4/3 mu (1-D))/rho), K and mu in Pa. Corrects the
 * units of 001 eq. 24. */
HD double damage_crack_speed(const struct damage_grady_kipp *d, double bulk, double mu,
                             double damage, double rho)
{
  return d->crack * sqrt((bulk + 4. / 3 * mu * (1 - damage)) / rho);
}

/* damage_left: by how much root = D^(1/3) can still grow before D meets the limit ever/ntot, ntot >
 * 0; 0 there. */
HD double damage_left(double root, int ever, int ntot)
{
  double limit = cbrt((double)ever / ntot);
  return root < limit ? limit - root : 0;
}

/* damage_grow: D after dt [s] with nact of ntot flaws active now and `ever` so far. D^(1/3) grows
 * at nact cg/rs (001 eq. 46), rs [m] the radius of the volume that a flaw has to cross: h, the
 * kernel's support, as in miluphcuda. D <= ever/ntot (001 eq. 47: the limit is one of D, not of
 * D^(1/3)). Exact while nact and cg are constant, for any dt. Never shrinks. */
HD double damage_grow(double damage, int nact, int ever, int ntot, double cg, double rs, double dt)
{
  double d = cbrt(damage) + nact * cg / rs * dt, limit = ntot > 0 ? (double)ever / ntot : 0;
  d = d * d * d;
  if (d > limit) d = limit;
  return d > damage ? d : damage;
}

#endif
