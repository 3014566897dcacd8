/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Porosity: the list and the dispatch. The distention alpha is the volume of porous matter over
 * that of its solid; the equation of state is that of the solid, p = P(alpha rho, u)/alpha
 * (Herrmann 1969, J. Appl. Phys. 40, 2490; Carroll & Holt 1972, J. Appl. Phys. 43, 759).
 *
 * The state of a particle is alpha without load. It never lies above the law's crush curve: in a
 * step that crushes, alpha is the root of alpha = crush(p(alpha)), so the curve is followed exactly
 * whatever the step, and no rate of alpha limits it. Below the curve matter is elastic, softer than
 * its solid where c_elastic says so. alpha = 1 is the solid itself. */
#ifndef POROSITY_H
#define POROSITY_H

#include "eos.h"

#include "porosity/p_alpha.h"
#include "porosity/p_alpha_two_power.h"
#include "porosity/p_alpha_blum.h"
#include "porosity/p_alpha_log.h"
#include "porosity/p_alpha_power.h"
#include "porosity/epsilon_alpha.h"
#include "porosity/sirono.h"

/* X(CAPITAL, name): token porosity.form, file porosity/<name>.h, struct porosity_<name>. Those of
 * the first list are P-alpha with crush curves porosity_<name>_crush, alpha at p [Pa]. */
/* clang-format off */
#define POROSITY_P_ALPHAS(X) \
  X(P_ALPHA, p_alpha) X(P_ALPHA_TWO_POWER, p_alpha_two_power) X(P_ALPHA_BLUM, p_alpha_blum) \
  X(P_ALPHA_LOG, p_alpha_log) X(P_ALPHA_POWER, p_alpha_power)
#define POROSITY_LAWS(X) POROSITY_P_ALPHAS(X) X(EPSILON_ALPHA, epsilon_alpha) X(SIRONO, sirono)
/* clang-format on */

typedef enum {
  POROSITY_NONE,
#define POROSITY_ENUM(CAPITAL, NAME) POROSITY_##CAPITAL,
  POROSITY_LAWS(POROSITY_ENUM)
#undef POROSITY_ENUM
      POROSITY_COUNT
} PorosityForm;

/* POROSITY_WORDS: "none|p_alpha|..." in the order of the enum. */
#define POROSITY_WORD(CAPITAL, NAME) "|" #NAME
#define POROSITY_WORDS               "none" POROSITY_LAWS(POROSITY_WORD)

typedef struct {
  int form;      /* PorosityForm */
  double alpha0; /* distention in the beginning */
  double c;      /* sound speed at alpha0 [m/s]; 0: the solid's */
  double start;  /* porosity_start, by the reader of materials */
  union {
#define POROSITY_MEMBER(CAPITAL, NAME) struct porosity_##NAME NAME;
    POROSITY_LAWS(POROSITY_MEMBER)
#undef POROSITY_MEMBER
  };
} Porosity;

/* Pressure and sound speed of porous matter, its distention without load, and the stiffness that
 * pores leave, moduli over those of the solid. */
typedef struct {
  EosPoint e;
  double alpha, stiff;
} PorousPoint;

/* porosity_curve: the distention on the crush curve of a P-alpha law at p; 1 to alpha0. */
HD double porosity_curve(const Porosity *q, double p)
{
  double alpha = q->alpha0;
  switch (q->form) {
#define POROSITY_CASE(CAPITAL, NAME)                                                               \
  case POROSITY_##CAPITAL: alpha = porosity_##NAME##_crush(&q->NAME, q->alpha0, p); break;
    POROSITY_P_ALPHAS(POROSITY_CASE)
#undef POROSITY_CASE
  default: break;
  }
  return alpha > q->alpha0 ? q->alpha0 : alpha < 1 ? 1 : alpha;
}

/* porosity_speed: elastic sound speed at alpha over the solid's, linear from 1 at alpha = 1 to
 * c_elastic at alpha0 (Herrmann 1969). */
HD_CALL double porosity_speed(const Porosity *q, const Eos *e, double alpha)
{
  double rho0 = eos_rho0(e);
  if (q->c <= 0 || alpha <= 1) return 1;
  return 1 + (alpha - 1) / (q->alpha0 - 1) * (q->c / sqrt(eos_bulk(e) / rho0) - 1);
}

/* porosity_stiffness: moduli over those of the solid without load, h^2/alpha (Sirono: as K). */
HD double porosity_stiffness(const Porosity *q, const Eos *e, double alpha)
{
  double h = porosity_speed(q, e, alpha);
  if (q->form == POROSITY_NONE) return 1;
  if (q->form == POROSITY_SIRONO) return pow(q->alpha0 / alpha, q->sirono.power);
  return h * h / alpha;
}

/* porosity_start: the pressure [Pa] at which pores begin to crush at alpha0: p_e, or where a
 * P-alpha curve without one leaves alpha0 (by bisection), that of elastic matter at the strain of
 * epsilon-alpha, the strength of Sirono's dust; 0 where they do at once, or never. */
HD double porosity_start(const Porosity *q, const Eos *e)
{
  double low = -30, high = 30, p;
  if (q->form == POROSITY_NONE || q->alpha0 <= 1) return 0;
  if (q->form == POROSITY_P_ALPHA) return q->p_alpha.p_e;
  if (q->form == POROSITY_P_ALPHA_TWO_POWER) return q->p_alpha_two_power.p_e;
  if (q->form == POROSITY_EPSILON_ALPHA)
    return -q->epsilon_alpha.epsilon_e * eos_bulk(e) * porosity_stiffness(q, e, q->alpha0);
  if (q->form == POROSITY_SIRONO) {
    p = porosity_sirono_crush(&q->sirono, 1 / q->alpha0);
    return p < INFINITY ? p : 0;
  }
  if (porosity_curve(q, pow(10., low)) < q->alpha0 ||
      porosity_curve(q, pow(10., high)) >= q->alpha0)
    return 0;
  for (int k = 0; k < 100; k++) {
    const double mid = 0.5 * (low + high);
    if (porosity_curve(q, pow(10., mid)) < q->alpha0)
      high = mid;
    else
      low = mid;
  }
  return pow(10., low);
}

/* porosity_strain: the volumetric strain of epsilon-alpha, negative in compression. */
HD double porosity_strain(const Porosity *q, const Eos *e, double rho, double u)
{
  double rho0 = eos_rho0(e), gamma = q->epsilon_alpha.gamma;
  return -log(rho * q->alpha0 / rho0) - (gamma > 0 ? gamma * u * rho0 / eos_bulk(e) : 0);
}

/* Porous matter with its solid at alpha rho: what a root is looked for in. */
typedef struct {
  const Porosity *q;
  const Eos *e;
  double rho, u, r, old; /* old: distention without load before */
  EosPoint solid;        /* at alpha rho */
  double p, rest, slope; /* then: pressure, distention without load, d alpha/dp of elastic matter */
} PorousTrial;

/* The excess of alpha over what it should be at the pressure that it makes, rest + slope p: rises
 * with alpha. */
HD_CALL double porosity_excess(PorousTrial *t, double alpha)
{
  double bulk, h;
  t->solid = eos_eval(t->e, alpha * t->rho, t->u, t->r);
  t->p = t->solid.p / alpha;
  t->rest = porosity_curve(t->q, t->p);
  if (t->rest > t->old) t->rest = t->old;
  t->slope = 0;
  if (t->q->c > 0 && t->rest > 1) {
    bulk = eos_bulk(t->e), h = porosity_speed(t->q, t->e, t->rest);
    t->slope = t->rest * t->rest / bulk * (1 - 1 / (h * h));
  }
  return alpha - t->rest - t->slope * t->p;
}

/* The root between low and high by the Illinois method (Dowell & Jarratt 1971, BIT 11, 168); t is
 * left there. */
HD double porosity_root(PorousTrial *t, double low, double high)
{
  double f_low = porosity_excess(t, low), f_high, mid = low, f;
  int side = 0;
  if (f_low >= 0) return low;
  f_high = porosity_excess(t, high), mid = high;
  if (f_high <= 0) return high;
  for (int k = 0; k < 200 && high - low > 1e-15 * high; k++) {
    mid = (f_high * low - f_low * high) / (f_high - f_low);
    f = porosity_excess(t, mid);
    if (fabs(f) < 1e-14) break;
    if (f < 0) {
      low = mid, f_low = f;
      if (side < 0) f_high *= 0.5;
      side = -1;
    } else {
      high = mid, f_high = f;
      if (side > 0) f_low *= 0.5;
      side = 1;
    }
  }
  return mid;
}

/* P-alpha and epsilon-alpha; old > 1. */
HD PorousPoint porosity_solve(const Porosity *q, const Eos *e, double rho, double u, double r,
                              double old)
{
  PorousTrial t = {q, e, rho, u, r, old, {0, 0}, 0, 1, 0};
  PorousPoint out;
  double excess, alpha = old, c2;
  if (q->form == POROSITY_EPSILON_ALPHA) {
    double now =
        porosity_epsilon_alpha_crush(&q->epsilon_alpha, q->alpha0, porosity_strain(q, e, rho, u));
    if (now < t.old) t.old = alpha = now;
  }
  excess = porosity_excess(&t, alpha);
  if (excess > 0)
    alpha = porosity_root(&t, 1, alpha);
  else if (excess < 0) /* elastic tension */
    alpha = porosity_root(&t, alpha, alpha - excess);
  c2 = t.solid.cs * t.solid.cs;
  out.e.p = t.p;
  out.e.cs = t.solid.cs / sqrt(1 - t.slope * (rho * c2 - t.p) / alpha);
  /* the more exact of the two; where compliance has used all pores up alpha is 1 under load */
  out.alpha = t.rest < t.old && alpha > 1 ? alpha - t.slope * t.p : t.rest;
  out.stiff = porosity_stiffness(q, e, out.alpha);
  return out;
}

/* Sirono's matter: the filling without load for which p is `limit` at phi, between two of them (p
 * falls with it). */
HD double porosity_sirono_rest(const Porosity *q, double phi, double limit, double low, double high)
{
  for (int k = 0; k < 200 && high - low > 1e-15 * high; k++) {
    double mid = 0.5 * (low + high);
    if (porosity_sirono_p(&q->sirono, q->alpha0, phi, mid) > limit)
      low = mid;
    else
      high = mid;
  }
  return 0.5 * (low + high);
}

HD PorousPoint porosity_dust(const Porosity *q, const Eos *e, double rho, double old)
{
  const struct porosity_sirono *law = &q->sirono;
  double phi = rho / eos_rho0(e), rest = 1 / old, p = porosity_sirono_p(law, q->alpha0, phi, rest);
  double most = porosity_sirono_crush(law, phi), least = -porosity_sirono_tension(law, phi);
  double bulk;
  PorousPoint out;
  if (p > most) p = most, rest = porosity_sirono_rest(q, phi, p, rest, phi);
  if (p < least) p = least, rest = porosity_sirono_rest(q, phi, p, phi, rest);
  bulk = porosity_sirono_bulk(law, q->alpha0, rest);
  out.e.p = p, out.e.cs = sqrt(bulk / (rest * eos_rho0(e)));
  out.alpha = 1 / rest;
  out.stiff = porosity_stiffness(q, e, out.alpha);
  return out;
}

/* porosity_eval: porous matter at bulk density rho > 0 and energy u whose distention without load
 * was `old`; r as in eos_eval. */
HD_CALL PorousPoint porosity_eval(const Porosity *q, const Eos *e, double rho, double u, double r,
                                  double old)
{
  PorousPoint solid = {{0, 0}, 1, 1};
  if (q->form != POROSITY_NONE && old > 1)
    return q->form == POROSITY_SIRONO ? porosity_dust(q, e, rho, old)
                                      : porosity_solve(q, e, rho, u, r, old);
  solid.e = eos_eval(e, old * rho, u, r);
  if (old > 1) solid.e.p /= old, solid.alpha = old; /* soil that has opened */
  return solid;
}

/* porosity_share: the part of a strain that the solid takes, f = 1 + dln(alpha)/dln(rho) <= 1
 * (Jutzi et al. 2008): h^2 in elastic matter, by the slope of the curve where pores crush (on it,
 * and compressed). rho, u, p: of the porous matter. */
HD_CALL double porosity_share(const Porosity *q, const Eos *e, double rho, double u, double p,
                              double alpha, int compressed)
{
  const int strains = q->form == POROSITY_EPSILON_ALPHA;
  double h = porosity_speed(q, e, alpha), f = h * h, c, x, d, a, b;
  if (!compressed || q->form == POROSITY_SIRONO || alpha <= 1) return f;
  x = strains ? porosity_strain(q, e, rho, u) : p, d = 1e-4 * fabs(x);
  a = strains ? porosity_epsilon_alpha_crush(&q->epsilon_alpha, q->alpha0, x - d)
              : porosity_curve(q, x - d);
  b = strains ? porosity_epsilon_alpha_crush(&q->epsilon_alpha, q->alpha0, x + d)
              : porosity_curve(q, x + d);
  if (d <= 0 || fmin(a, b) > alpha || fmax(a, b) < alpha) return f;
  b = (b - a) / (2 * d), c = eos_eval(e, alpha * rho, u, 0).cs;
  f += strains ? -b / alpha : b * rho * c * c / (alpha - b * (rho * c * c - p));
  return f > 0 ? f : 0;
}

/* porosity_shear_strength: of the pores (Sirono's dust), sqrt(C T) [Pa]. */
HD double porosity_shear_strength(const Porosity *q, const Eos *e, double rho)
{
  double phi = rho / eos_rho0(e);
  return sqrt(porosity_sirono_crush(&q->sirono, phi) * porosity_sirono_tension(&q->sirono, phi));
}

/* porosity_broken: cube root of the damage that crushing from alpha0 to alpha has done, 0 to 1
 * (Jutzi et al. 2008, the integral of their rate): all of the solid is broken when the pores are
 * gone. */
HD double porosity_broken(const Porosity *q, double alpha)
{
  const double delta = 0.01;
  double crushed = q->alpha0 > 1 ? 1 - (alpha - 1) / (q->alpha0 - 1) : 0;
  crushed = crushed < 0 ? 0 : crushed > 1 ? 1 : crushed;
  return (cbrt(crushed + delta) - cbrt(delta)) / (cbrt(1 + delta) - cbrt(delta));
}

#endif
