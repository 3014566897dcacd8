/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A material: the form of each law and its parameters. Looked up as material[mat[i]]; SI units (the
 * reader sees to it). */
#ifndef PHYSICS_MATERIAL_H
#define PHYSICS_MATERIAL_H

#include "eos.h"
#include "yield.h"
#include "damage.h"
#include "porosity.h"

/* What the groups hold besides their laws:
 * X(key, member, SI unit, default, min, max, meaning). */
/* clang-format off */
#define MATERIAL_EOS_ROWS(X) \
  X(heat_capacity, heat, "J/K/kg", "0", 0, 1e6, "at constant volume: T = (u - u_cold(rho))/heat_capacity; 0: no temperature")
#define MATERIAL_STRENGTH_ROWS(X) \
  X(shear_modulus, mu,   "Pa",   NULL, 0, 1e30, "shear modulus") \
  X(melt_energy,   melt, "J/kg", "0",  0, 1e30, "specific energy of the melt; 0: strength does not depend on u") \
  X(weak_limit, weak.limit, "1", "0", 0, 1, "low-density weakening: rho/rho0 down to which the cohesion falls to weak_gamma; 0: none") \
  X(weak_alpha, weak.alpha, "1", "1", 0, 100, "exponent above weak_limit") \
  X(weak_beta,  weak.beta,  "1", "1", 0, 100, "exponent below weak_limit") \
  X(weak_gamma, weak.gamma, "1", "1", 0, 1,   "what is left of the cohesion at weak_limit")
#define MATERIAL_POROSITY_ROWS(X) \
  X(alpha_0,   porosity.alpha0, "1",   NULL, 1, 1000, "distention where the input has none: rho_solid/rho, 1/(1 - porosity)") \
  X(c_elastic, porosity.c,      "m/s", "0",  0, 1e30, "sound speed of elastic matter at alpha_0; 0: the solid's")
/* clang-format on */

typedef struct {
  Eos eos;           /* equation of state */
  double heat;       /* heat capacity at constant volume [J/K/kg]; 0: unknown */
  double mu;         /* shear modulus [Pa]; 0: a fluid, no deviatoric stress */
  Yield yield;       /* limit of the deviatoric stress */
  Damage damage;     /* brittle fragmentation */
  Porosity porosity; /* pores, and how they crush */
  double melt;       /* specific energy at which the material melts [J/kg]; 0: unknown */
  YieldWeak weak;    /* low-density weakening; limit 0: none */
} Material;

/* material_brittle: whether weibull gives it flaws. */
HD int material_brittle(const Material *m) { return m->damage.form != DAMAGE_NONE; }

/* material_heats: whether its strength has a temperature of its own (field Temperature). */
HD int material_heats(const Material *m) { return m->yield.form == YIELD_JOHNSON_COOK; }

/* material_porous: whether it can have pores. */
HD int material_porous(const Material *m) { return m->porosity.form != POROSITY_NONE; }

/* material_distends: whether it has a distention (field Distention): pores, or soil that opens. */
HD int material_distends(const Material *m)
{
  return material_porous(m) || m->yield.form == YIELD_REGOLITH;
}

/* material_rare: whether it has laws that few runs need: a table, pores, strength beyond von Mises.
 * A GPU's passes without them need fewer registers. */
HD int material_rare(const Material *m)
{
  return m->eos.form == EOS_TABLE || material_porous(m) || m->weak.limit > 0 ||
         m->yield.form > YIELD_VON_MISES;
}

/* material_distention: what it begins with. */
HD double material_distention(const Material *m)
{
  return material_porous(m) ? m->porosity.alpha0 : 1;
}

/* material_young: Young's modulus [Pa] E = 9 K mu / (3 K + mu), K the bulk modulus of the EOS at
 * zero pressure (001 eq. 49). */
HD double material_young(const Material *m)
{
  double k = eos_bulk(&m->eos);
  return m->mu > 0 ? 9 * k * m->mu / (3 * k + m->mu) : 0;
}

#endif
