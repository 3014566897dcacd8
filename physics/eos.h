/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equations of state: the list and the dispatch. A law is one file in eos/: a struct of parameters made from its rows
 * (LAW_ROWS), and a function that returns pressure and adiabatic sound speed. A new law: its file, its include, one X. */
#ifndef EOS_H
#define EOS_H

#include "hd.h"

/* Pressure [Pa] and adiabatic sound speed [m/s], c^2 = dp/drho|_u + p/rho^2 dp/du|_rho of the p returned, kept above a small
 * positive floor (the square of 1 % of the zero-pressure bulk sound speed, or of cs_min where a law has it). */
typedef struct {
  double p, cs;
} EosPoint;

#include "eos/tillotson.h"
#include "eos/murnaghan.h"
#include "eos/liquid.h"
#include "eos/stiffened.h"
#include "eos/ideal.h"
#include "eos/polytropic.h"
#include "eos/isothermal.h"
#include "eos/local_isothermal.h"

/* X(CAPITAL, name): name is the token in material files (eos.form = "tillotson"), the file, and the function eos_<name>. */
#define EOS_LAWS(X) \
  X(TILLOTSON, tillotson) X(MURNAGHAN, murnaghan) X(LIQUID, liquid) X(STIFFENED, stiffened) X(IDEAL, ideal) \
  X(POLYTROPIC, polytropic) X(ISOTHERMAL, isothermal) X(LOCAL_ISOTHERMAL, local_isothermal)

typedef enum {
#define EOS_ENUM(CAPITAL, NAME) EOS_##CAPITAL,
  EOS_LAWS(EOS_ENUM)
#undef EOS_ENUM
  EOS_COUNT
} EosForm;

typedef struct {
  int form; /* EosForm */
  union {
#define EOS_MEMBER(CAPITAL, NAME) struct eos_##NAME NAME;
    EOS_LAWS(EOS_MEMBER)
#undef EOS_MEMBER
  };
} Eos;

/* eos_eval: p and c at rho [kg/m^3] > 0, u [J/kg]. r: distance from the central mass [m], used by local_isothermal only. */
HD EosPoint eos_eval(const Eos *e, double rho, double u, double r)
{
  switch (e->form) {
#define EOS_CASE(CAPITAL, NAME) \
  case EOS_##CAPITAL: return eos_##NAME(&e->NAME, rho, u, r);
    EOS_LAWS(EOS_CASE)
#undef EOS_CASE
  default: {
    EosPoint none = {0, 0};
    return none;
  }
  }
}

/* eos_rho0: density at zero pressure and energy [kg/m^3]; 0 for a gas. */
HD double eos_rho0(const Eos *e)
{
  switch (e->form) {
#define EOS_CASE(CAPITAL, NAME) \
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
  if (rho0 <= 0) return 0;
  c = eos_eval(e, rho0, 0, 0).cs;
  return rho0 * c * c;
}

/* eos_uses_energy: whether p depends on u (else the energy is carried along but has no effect). */
HD int eos_uses_energy(const Eos *e)
{
  return e->form == EOS_TILLOTSON || e->form == EOS_STIFFENED || e->form == EOS_IDEAL;
}

#endif
