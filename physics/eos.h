/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equations of state: the list and the dispatch. A law is one file in eos/: rows of parameters, the
 * struct made from them, its density at rest, and a function that returns pressure and sound speed.
 * A new law: its file, its include, one X. */
#ifndef EOS_H
#define EOS_H

#include "hd.h"

/* Pressure [Pa] and adiabatic sound speed [m/s], c^2 = dp/drho|_u + p/rho^2 dp/du|_rho of that p.
 */
typedef struct {
  double p, cs;
} EosPoint;

/* eos_point: p and c from c^2, with the floor c_min. A condensed law takes c_min = EOS_FLOOR of the
 * sound speed at rest: c^2 is negative where a law has a van der Waals loop (Tillotson ice at 700
 * kg/m^3, 5 MJ/kg: -2.3e4 m^2/s^2). */
HD EosPoint eos_point(double p, double c2, double c_min)
{
  EosPoint point = {p, sqrt(c2 > c_min * c_min ? c2 : c_min * c_min)};
  return point;
}

/* The floor in units of the sound speed at rest (the choice of miluphcuda). */
#define EOS_FLOOR 0.01

/* eos_no_tension: p, or 0 when p < 0 at eta = rho/rho0 below rho_min (Melosh 1996: 0.8 to 0.95).
 * Only tension is cut, so that p stays continuous in u; c stays that of the law without the cut. */
HD double eos_no_tension(double p, double eta, double rho_min)
{
  return p < 0 && eta < rho_min ? 0 : p;
}

#include "eos/tillotson.h"
#include "eos/murnaghan.h"
#include "eos/liquid.h"
#include "eos/stiffened.h"
#include "eos/ideal.h"
#include "eos/polytropic.h"
#include "eos/isothermal.h"
#include "eos/local_isothermal.h"
#include "eos/table.h"

/* X(CAPITAL, name): name is the token in material files (eos.form = "tillotson"), the file, and the
 * function eos_<name>. */
/* clang-format off */
#define EOS_FORMULAS(X) \
  X(TILLOTSON, tillotson) X(MURNAGHAN, murnaghan) X(LIQUID, liquid) X(STIFFENED, stiffened) \
  X(IDEAL, ideal) X(POLYTROPIC, polytropic) X(ISOTHERMAL, isothermal) \
  X(LOCAL_ISOTHERMAL, local_isothermal)
#define EOS_LAWS(X) EOS_FORMULAS(X) X(TABLE, table)
/* clang-format on */

typedef enum {
#define EOS_ENUM(CAPITAL, NAME) EOS_##CAPITAL,
  EOS_LAWS(EOS_ENUM)
#undef EOS_ENUM
      EOS_COUNT
} EosForm;

/* EOS_WORDS: "tillotson|murnaghan|..." in the order of the enum. */
#define EOS_WORD(CAPITAL, NAME) "|" #NAME
#define EOS_WORDS               (&EOS_LAWS(EOS_WORD)[1])

typedef struct {
  int form; /* EosForm */
  union {
#define EOS_MEMBER(CAPITAL, NAME) struct eos_##NAME NAME;
    EOS_LAWS(EOS_MEMBER)
#undef EOS_MEMBER
  };
} Eos;

/* eos_formula: eos_eval without tables, whose code takes the registers of a kernel up. */
HD EosPoint eos_formula(const Eos *e, double rho, double u, double r)
{
  switch (e->form) {
#define EOS_CASE(CAPITAL, NAME)                                                                    \
  case EOS_##CAPITAL: return eos_##NAME(&e->NAME, rho, u, r);
    EOS_FORMULAS(EOS_CASE)
#undef EOS_CASE
  default: return eos_point(0, 0, 0);
  }
}

/* eos_eval: p and c at rho [kg/m^3] > 0, u [J/kg]. r: distance from the central mass [m], used by
 * local_isothermal only. */
HD EosPoint eos_eval(const Eos *e, double rho, double u, double r)
{
  return e->form == EOS_TABLE ? eos_table(&e->table, rho, u, r) : eos_formula(e, rho, u, r);
}

/* eos_rho0: density at zero pressure and energy [kg/m^3]; 0 for a gas. */
HD double eos_rho0(const Eos *e)
{
  switch (e->form) {
#define EOS_CASE(CAPITAL, NAME)                                                                    \
  case EOS_##CAPITAL: return eos_##NAME##_rho0(&e->NAME);
    EOS_LAWS(EOS_CASE)
#undef EOS_CASE
  default: return 0;
  }
}

/* eos_bulk: bulk modulus rho c^2 at zero pressure and energy [Pa]; 0 for a gas. */
HD double eos_bulk(const Eos *e)
{
  double rho0 = eos_rho0(e), c;
  if (e->form == EOS_TABLE) return e->table.bulk;
  c = rho0 > 0 ? eos_formula(e, rho0, 0, 0).cs : 0;
  return rho0 * c * c;
}

/* eos_vapour: whether there is vapour in matter at rho, u, as far as the law knows phases. */
HD int eos_vapour(const Eos *e, double rho, double u)
{
  if (e->form == EOS_TABLE) return eos_table_vapour(&e->table, rho, u);
  return e->form == EOS_TILLOTSON && u > e->tillotson.Eiv && rho < e->tillotson.rho0;
}

/* eos_uses_energy: whether p depends on u (else the energy is carried along but has no effect). */
HD int eos_uses_energy(const Eos *e)
{
  return e->form == EOS_TILLOTSON || e->form == EOS_IDEAL || e->form == EOS_TABLE ||
         (e->form == EOS_STIFFENED && e->stiffened.G > 0);
}

#endif
