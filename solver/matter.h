/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What its material makes of a particle's state: equation of state, strength, damage. Parts of the
 * passes; each looks the material up and works on row i. */
#ifndef MATTER_H
#define MATTER_H

#include "../physics/tensor.h"
#include "state.h"

/* passes_stress: the six numbers of particle i as a tensor, and back. */
HD Sym passes_stress(const double *s)
{
  Sym t = {s[0], s[1], s[2], s[3], s[4], s[5]};
  return t;
}

HD void passes_keep_stress(double *s, Sym t)
{
  s[0] = t.xx, s[1] = t.xy, s[2] = t.xz, s[3] = t.yy, s[4] = t.yz, s[5] = t.zz;
}

/* passes_own_stress: S of particle i; none when it is no solid. */
HD Sym passes_own_stress(const State *s, long i, int solid)
{
  const Sym none = {0, 0, 0, 0, 0, 0};
  return solid ? passes_stress(&s->s[6 * i]) : none;
}

/* passes_strain_rate: the symmetric part of g. */
HD Sym passes_strain_rate(const double *g)
{
  Sym e = {g[0], 0.5 * (g[1] + g[3]), 0.5 * (g[2] + g[6]), g[4], 0.5 * (g[5] + g[7]), g[8]};
  return e;
}

/* matter_porous: whether its matter has a distention. */
HD int matter_porous(const State *s, const Material *m) { return s->rare && material_distends(m); }

/* matter_alpha: the distention of i without load. */
HD double matter_alpha(const State *s, const Material *m, long i)
{
  return matter_porous(s, m) ? s->alpha[i] : 1;
}

/* matter_distention: the same without a look at the material. */
HD double matter_distention(const State *s, long i)
{
  return s->rare && s->alpha ? s->alpha[i] : 1;
}

/* matter_weak: what low density leaves of the cohesion. */
HD double matter_weak(const State *s, const Material *m, double rho)
{
  return s->rare && m->weak.limit > 0 ? yield_weak(&m->weak, rho / eos_rho0(&m->eos)) : 1;
}

/* matter_tension: p, or the largest tension that the strength allows; rho: of the solid. */
HD_CALL double matter_tension(const State *s, const Material *m, long i, double p, double rho)
{
  double most =
      yield_tension(&m->yield, s->damage[i], yield_soft(s->ue[i], m->melt), matter_weak(s, m, rho));
  return p < -most ? -most : p;
}

/* matter_radius: the distance of i from the centre of the disk. */
HD double matter_radius(const State *s, long i)
{
  const double x = s->x[3 * i] - s->centre[0], y = s->x[3 * i + 1] - s->centre[1],
               z = s->x[3 * i + 2] - s->centre[2];
  return sqrt(x * x + y * y + z * z);
}

/* matter_eos: p, cs and the longitudinal wave speed of i at energy u; with strength on, no more
 * tension than the yield law has; no pressure below its floor. */
HD void matter_eos(const State *s, long i, double u, int strength)
{
  const Material *m = &s->material[s->mat[i]];
  double r = matter_radius(s, i), alpha = 1, mu = m->mu;
  EosPoint e;
  if (matter_porous(s, m)) {
    PorousPoint q = porosity_eval(&m->porosity, &m->eos, s->rho[i], u, r, s->alpha[i]);
    s->alpha[i] = alpha = q.alpha, mu *= q.stiff, e = q.e;
  } else
    e = s->rare ? eos_eval(&m->eos, s->rho[i], u, r) : eos_formula(&m->eos, s->rho[i], u, r);
  s->ue[i] = u;
  if (s->rare && e.p < 0 && strength && m->mu > 0 && yield_knows_pressure(&m->yield))
    e.p = matter_tension(s, m, i, e.p, alpha * s->rho[i]);
  if (s->floors.pressure && e.p < s->floors.p) e.p = s->floors.p;
  s->p[i] = e.p;
  s->cs[i] = e.cs;
  s->cl[i] = mu > 0 ? sqrt(e.cs * e.cs + 4. / 3 * mu / s->rho[i]) : e.cs;
}

/* matter_stiff: moduli of i over those of its solid. */
HD double matter_stiff(const State *s, const Material *m, long i)
{
  return matter_porous(s, m) ? porosity_stiffness(&m->porosity, &m->eos, s->alpha[i]) : 1;
}

/* matter_shear: the shear modulus that S of i grows with, f mu/alpha with the share f of the strain
 * that the solid takes (Jutzi et al. 2008); Sirono: as K. */
HD_CALL double matter_porous_shear(const State *s, const Material *m, long i)
{
  const double alpha = s->alpha[i];
  if (m->porosity.form == POROSITY_SIRONO || !material_porous(m))
    return m->mu * matter_stiff(s, m, i);
  return m->mu / alpha *
         porosity_share(&m->porosity, &m->eos, s->rho[i], s->u[i], s->p[i], alpha, s->divv[i] < 0);
}

HD double matter_shear(const State *s, long i)
{
  const Material *m = &s->material[s->mat[i]];
  if (s->rare && m->yield.form == YIELD_VISCOUS_REGOLITH) return 0;
  return matter_porous(s, m) ? matter_porous_shear(s, m, i) : m->mu;
}

/* matter_compact: what follows from a change of the distention of i that was `old` before: S of the
 * porous matter is that of its solid over alpha, and crushing breaks (where damage is on). */
HD_CALL void matter_compact(const State *s, long i, double old, int solid, int damage)
{
  const Material *m = &s->material[s->mat[i]];
  double alpha = s->alpha[i], grown;
  if (alpha == old) return;
  if (solid && m->porosity.form != POROSITY_SIRONO)
    passes_keep_stress(&s->s[6 * i], tensor_scale(passes_stress(&s->s[6 * i]), old / alpha));
  if (!damage || m->damage.form == DAMAGE_NONE || alpha > old) return;
  grown = cbrt(s->damage[i]) + m->damage.grady_kipp.pores * (porosity_broken(&m->porosity, alpha) -
                                                             porosity_broken(&m->porosity, old));
  s->damage[i] = grown < 1 ? grown * grown * grown : 1;
}

/* matter_rate: the equivalent strain rate sqrt(2/3 e:e) of the deviatoric strain rate [1/s]. */
HD double matter_rate(const double *g)
{
  Sym e = passes_strain_rate(g);
  double third = (e.xx + e.yy + e.zz) / 3;
  e.xx -= third, e.yy -= third, e.zz -= third;
  return sqrt(4 * tensor_j2(e) / 3);
}

/* matter_point: what a yield law may look at. */
HD YieldPoint matter_point(const State *s, const Material *m, long i)
{
  Sym d = passes_stress(&s->s[6 * i]);
  int heats = s->rare && material_heats(m);
  double rho = s->rho[i] * matter_alpha(s, m, i);
  double soft = yield_soft(s->ue[i], m->melt), weak = matter_weak(s, m, rho);
  YieldPoint at = {d, tensor_j2(d), s->p[i], s->damage[i], soft, weak, 0, 0, 0, 0};
  if (heats) at.strain = s->strain[i], at.rate = matter_rate(&s->g[9 * i]), at.T = s->T[i];
  return at;
}

/* The laws beside von Mises. */
HD_CALL double matter_other_factor(const State *s, const Material *m, long i)
{
  YieldPoint at = matter_point(s, m, i);
  if (m->yield.form == YIELD_POROUS)
    at.pores = porosity_shear_strength(&m->porosity, &m->eos, s->rho[i]);
  return yield_factor(&m->yield, &at);
}

/* matter_factor: what the strength leaves of the deviatoric stress; nothing in vapour. */
HD double matter_factor(const State *s, const Material *m, long i)
{
  const int knows = s->rare || m->eos.form != EOS_TABLE; /* a GPU's passes without tables */
  if (knows && eos_vapour(&m->eos, s->rho[i] * matter_alpha(s, m, i), s->ue[i])) return 0;
  if (m->yield.form == YIELD_NONE) return 1;
  if (m->yield.form == YIELD_VON_MISES) {
    YieldPoint at = matter_point(s, m, i);
    return at.soft > 0 ? yield_von_mises(&m->yield.von_mises, &at) : 0;
  }
  return s->rare ? matter_other_factor(s, m, i) : 1;
}

/* matter_open: soil that flows or is pulled apart takes up volume, so that p returns. */
HD_CALL void matter_open(const State *s, const Material *m, long i, int strength)
{
  double p = s->p[i], bulk = s->rho[i] * s->cs[i] * s->cs[i] - p; /* dp/dln(alpha) */
  YieldPoint at = matter_point(s, m, i);
  double rise = yield_regolith_pressure(&m->yield.regolith, &at, bulk, m->mu) - p;
  if (!(rise > 0)) return;
  s->alpha[i] *= exp(rise / bulk);
  matter_eos(s, i, s->ue[i], strength);
}

/* matter_slide: the stress of a viscous soil; its diffusion limits the step by a speed 8 eta/(rho
 * h) on top of the sound's, dt <= 0.4 h/(16 eta/(rho h)). */
HD_CALL void matter_slide(const State *s, const Material *m, long i, double dt)
{
  Sym e = passes_strain_rate(&s->g[9 * i]);
  double third = (e.xx + e.yy + e.zz) / 3, rate, eta, left;
  e.xx -= third, e.yy -= third, e.zz -= third;
  rate = 2 * sqrt(tensor_j2(e)),
  left = yield_soft(s->ue[i], m->melt) * matter_weak(s, m, s->rho[i]);
  eta = yield_viscous_regolith_eta(&m->yield.viscous_regolith, s->p[i], rate, left);
  passes_keep_stress(&s->s[6 * i], tensor_scale(e, 2 * eta));
  s->cl[i] = s->cs[i] + 8 * eta / (s->rho[i] * s->h[i]);
  s->strain[i] += dt * rate / 1.7320508075688773;
}

/* matter_yield: limits the deviatoric stress of i; what it gives up is plastic strain, and heat
 * where the law wants a temperature. At the end of a step, count = 1, these are added up, and heat
 * [J/kg], what viscosity made in it, of length dt; else the stress alone is limited. */
HD void matter_yield(const State *s, long i, int count, double heat, double dt)
{
  const Material *m = &s->material[s->mat[i]];
  if (s->rare && m->yield.form == YIELD_VISCOUS_REGOLITH) {
    matter_slide(s, m, i, count ? dt : 0);
    return;
  }
  if (s->rare && m->yield.form == YIELD_REGOLITH) matter_open(s, m, i, 1);
  const int heats = s->rare && count && material_heats(m);
  Sym d = passes_stress(&s->s[6 * i]);
  double j2 = tensor_j2(d), f, strain;
  if (heats) s->T[i] += heat / m->heat;
  f = matter_factor(s, m, i);
  if (f >= 1) return;
  strain = (1 - f) * sqrt(3 * j2) / (3 * m->mu * matter_stiff(s, m, i));
  if (count) s->strain[i] += strain;
  if (heats)
    s->T[i] += m->yield.johnson_cook.heating * f * sqrt(3 * j2) * strain / (s->rho[i] * m->heat);
  passes_keep_stress(&s->s[6 * i], tensor_scale(d, f));
}

/* passes_strain: the local scalar strain sigma_max/((1-D) E) (001 eq. 48); the stress is the
 * damaged one. Where damage does not act on S, E is the whole one, too. At D = 1 its limit: in
 * tension that does not depend on D, under pressure there is none. */
HD double passes_strain(const State *s, long i)
{
  const Material *m = &s->material[s->mat[i]];
  double left = damage_shear(&m->damage, s->damage[i]), whole = 1 - s->damage[i], p = s->p[i];
  double largest;
  if (left <= 0 && p >= 0) return 0;
  if (left <= 0) left = whole = 1;
  largest = left * tensor_largest(passes_stress(&s->s[6 * i])) - (p < 0 ? whole * p : p);
  return largest > 0 ? largest / (left * matter_stiff(s, m, i) * material_young(m)) : 0;
}

/* passes_crack: the crack speed of i at damage D. */
HD double passes_crack(const State *s, const Material *m, long i, double damage)
{
  double stiff = matter_stiff(s, m, i), bulk = eos_bulk(&m->eos);
  return damage_crack_speed(&m->damage.grady_kipp, stiff * bulk, stiff * m->mu, damage, s->rho[i]);
}

/* passes_damage: activates flaws and lets cracks grow for dt, at the crack speed of the middle of
 * the step. The step needs no limit for it: the strain that flaws feel does not depend on D in
 * tension, and growth at a constant rate is exact. Keeps the rate of the cube root of D whether or
 * not D is at its limit: a stage of another integrator that is there already must not stop the step
 * short of it (passes_crack_rate). */
HD void passes_damage(const State *s, long i, double dt)
{
  const Material *m = &s->material[s->mat[i]];
  int active;
  double half, cg, h = s->h[i];
  s->dcrack[i] = 0;
  if (m->damage.form == DAMAGE_NONE || s->nflaw[i] == 0 || m->mu <= 0) return;
  if (dt > 0 && s->damage[i] >= 1) return;
  active = damage_active(s->flaw + s->flaw0[i], s->nflaw[i], passes_strain(s, i));
  if (active == 0) return;
  if (active > s->nact[i]) s->nact[i] = active;
  cg = passes_crack(s, m, i, s->damage[i]);
  s->dcrack[i] = active * cg / h;
  if (dt <= 0) return;
  half = damage_grow(s->damage[i], active, s->nact[i], s->nflaw[i], cg, h, 0.5 * dt);
  cg = passes_crack(s, m, i, half);
  s->damage[i] = damage_grow(s->damage[i], active, s->nact[i], s->nflaw[i], cg, h, dt);
}

/* passes_crack_rate: the rate at which the cube root of D, now root, grows; 0 at its limit. */
HD double passes_crack_rate(const State *s, long i, double root)
{
  if (!(s->dcrack[i] > 0)) return 0;
  return damage_left(root, s->nact[i], s->nflaw[i]) > 0 ? s->dcrack[i] : 0;
}

#endif
