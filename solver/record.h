/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the force loop reads of a particle besides its place: made before the loop, taken up by it,
 * turned where a mirror shows it. Parts of the passes. */
#ifndef RECORD_H
#define RECORD_H

#include "elastic.h"
#include "step.h"

/* passes_pack: p and S C (of a viscous fluid its stress times C) as the force loop takes them: p
 * (of walls of a fluid never negative) above the pressure outside, which thereby acts on free
 * surfaces. C, the inverse moment matrix of loop A,
 * is turned by the spin over dt, from loop A's positions to those of the force loop. As C also
 * corrects the gradient that drives S, the two are adjoint; and as sum V_j r W' C = 1, the stress
 * exerts no torque on a neighbourhood (Bonet & Lok 1999, CMAME 180, 97). */
HD void passes_pack(const State *s, const Step *k, long i, int solid, double dt)
{
  double left = damage_shear(&s->material[s->mat[i]].damage, s->damage[i]), *t = &s->t[9 * i];
  double size = k->volumes ? 1 : (k->density > 1 ? s->m[i] : 1) / s->rho[i]; /* 2, 3: miscible */
  double p = s->p[i] < 0 ? (1 - s->damage[i]) * s->p[i] : s->p[i];
  if (k->hold.walls && p < 0 && !solid && hold_wall(s, &k->hold, i)) p = 0;
  s->push[i] = (p - k->outer) * size * size;
  if (k->rich && s->omega) s->push[i] /= s->omega[i];
  for (int d = 0; d < 9 && !solid && s->t; d++) t[d] = 0;
  if (solid || k->viscous) {
    Sym c = passes_rotate(passes_stress(&s->cm[6 * i]), &s->g[9 * i], dt);
    Sym dev = k->viscous && !solid ? fluid_stress(s, &k->fluid, i)
                                   : tensor_scale(passes_stress(&s->s[6 * i]), left);
    if ((k->rich && k->more.squares) || k->density == 3) dev = tensor_scale(dev, size * size);
    tensor_product(dev, c, t);
  }
  if (k->rich) rich_extra(s, &k->more, i, left, solid, k->dt);
}

/* passes_part: what each of a pair contributes to the pair's kernel, W_ij/sqrt(theta_i theta_j)
 * (docs/theory.md 2.14); 1 where it is W_ij. */
HD double passes_part(const State *s, long i) { return s->theta ? 1 / sqrt(s->theta[i]) : 1; }

/* passes_mass: the mass of i as the force loop takes it: with its part of the kernel. */
HD double passes_mass(const State *s, long i) { return s->m[i] * passes_part(s, i); }

/* passes_volume: the weight of i in the sums of loop A; passes_share: what its own sums are
 * multiplied by. The continuity equation of the number density has the volume of the particle
 * itself (004 eq. 2.50). */
HD double passes_volume(const State *s, long i)
{
  return s->integrated ? 1 : s->m[i] / s->rhoa[i] * passes_part(s, i);
}

HD double passes_share(const State *s, long i)
{
  return s->integrated ? s->m[i] / s->rhoa[i] : passes_part(s, i);
}

/* passes_body: the record of i for the force loop. */
HD PairBody passes_body(const State *s, long i)
{
  const double *v = &s->vp[3 * i], *t = &s->t[9 * i], rho = s->rho[i];
  PairBody b = {
      (real)v[0], (real)v[1],      (real)v[2],     (real)s->h[i],  (real)passes_mass(s, i),
      (real)rho,  (real)(1 / rho), (real)s->cs[i], (real)s->cl[i], (real)s->push[i],
      (real)t[0], (real)t[1],      (real)t[2],     (real)t[3],     (real)t[4],
      (real)t[5], (real)t[6],      (real)t[7],     (real)t[8]};
  return b;
}

/* passes_turn_body: the record of what is seen in a mirror: vectors times w, tensors times w w. */
HD void passes_turn_body(PairBody *b, const double w[3])
{
  const real x = (real)w[0], y = (real)w[1], z = (real)w[2];
  b->vx *= x, b->vy *= y, b->vz *= z;
  b->dxy *= x * y, b->dxz *= x * z, b->dyx *= y * x, b->dyz *= y * z, b->dzx *= z * x,
      b->dzy *= z * y;
}

#endif
