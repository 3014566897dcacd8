/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What particles have for the terms of pair_rich.h: the state of the viscosity's switch, the
 * limiter of rotation, artificial stress. Parts of the passes. */
#ifndef RICH_H
#define RICH_H

#include "../physics/pair_rich.h"
#include "fluid.h"

enum { RICH_NONE, RICH_MORRIS_MONAGHAN, RICH_CULLEN_DEHNEN };

/* Numbers of a run. */
typedef struct {
  int squares;            /* as in PairMore */
  int viscosity, balsara; /* which switch; the limiter */
  double least;           /* smallest share of viscosity */
  double artificial;      /* factor of the artificial stress */
  double xsph, diffusion; /* factors of smoothed velocities, of the diffusion of density */
} Rich;

/* rich_curl2: |curl v|^2; rich_shear2: S:S, S the traceless symmetric part of g. */
HD double rich_curl2(const double *g)
{
  const double x = g[7] - g[5], y = g[2] - g[6], z = g[3] - g[1];
  return x * x + y * y + z * z;
}

HD double rich_shear2(const double *g)
{
  Sym e = passes_strain_rate(g);
  const double third = (e.xx + e.yy + e.zz) / 3;
  e.xx -= third, e.yy -= third, e.zz -= third;
  return tensor_dot(e, e);
}

/* rich_jump: what the share jumps to by Cullen & Dehnen (2010, MNRAS 408, 669, eq. 13 to 18), h^2
 * A/(v^2 + h^2 A), A = xi max(-D(div v)/Dt, 0), xi the limiter with R, the mean sign of div v
 * around. v: c and the approach over h. */
HD double rich_jump(const State *s, long i, double v, double dt)
{
  const double div = s->divv[i], h = s->h[i], r = 1 - s->sense[i], q = 2 * r * r * r * r * div;
  const double rate = (s->div0[i] - div) / dt, all = q * q + rich_shear2(&s->g[9 * i]);
  const double a = rate > 0 && all > 0 ? q * q / all * rate : 0;
  return h * h * a / (v * v + h * h * a);
}

/* rich_switch: the share of viscosity after dt. Morris & Monaghan (1997, J. Comput. Phys. 136,
 * 41) with the source of Rosswog et al. (2000, A&A 360, 171): da/dt = (least - a)/tau + max(-div
 * v, 0) (1 - a), tau = h/(0.2 c) (0.1 and half the support); Cullen & Dehnen: up at once, down
 * with tau = h/(0.1 v). Exact for rates that do not change in the step. */
HD_CALL void rich_switch(const State *s, const Rich *k, long i, double dt)
{
  const double c = s->cs[i], h = s->h[i], closing = s->divv[i] < 0 ? -s->divv[i] : 0;
  double a = s->viscosity[i], rate, to;
  if (dt > 0 && k->viscosity == RICH_MORRIS_MONAGHAN) {
    rate = 0.2 * c / h + closing;
    to = rate > 0 ? (0.2 * c / h * k->least + closing) / rate : a;
    a = to + (a - to) * exp(-rate * dt);
  } else if (dt > 0) {
    const double v = c + h * closing;
    to = v > 0 ? rich_jump(s, i, v, dt) : 0;
    if (to < k->least) to = k->least;
    a = a < to ? to : to + (a - to) * exp(-0.1 * v / h * dt);
  }
  s->viscosity[i] = a > k->least ? a : k->least;
  if (dt > 0) s->div0[i] = s->divv[i];
}

/* rich_balsara: |div v|/(|div v| + |curl v| + 1e-4 c/h) (Balsara 1995, J. Comput. Phys. 121, 357);
 * the curl by the corrected gradient, h the support. */
HD double rich_balsara(const State *s, long i)
{
  const double *g = &s->g[9 * i], div = fabs(g[0] + g[4] + g[8]),
               all = div + sqrt(rich_curl2(g)) + 1e-4 * s->cs[i] / s->h[i];
  return all > 0 ? div / all : 0;
}

/* rich_stress: the artificial stress over rho^2 of Monaghan (2000, J. Comput. Phys. 159, 290) and
 * Gray, Monaghan & Swift (2001, CMAME 190, 6641): -eps times what of the stress is tension along
 * its principal axes (001 eq. 37 has components of any axes). */
HD_CALL void rich_stress(const State *s, double eps, long i, double left, int solid, double *to)
{
  const double p = s->p[i] < 0 ? (1 - s->damage[i]) * s->p[i] : s->p[i];
  Sym t = tensor_scale(passes_own_stress(s, i, solid), left);
  t.xx -= p, t.yy -= p, t.zz -= p;
  passes_keep_stress(to, tensor_scale(tensor_tension(t), -eps / (s->rho[i] * s->rho[i])));
}

/* rich_extra: the record of i for pair_rich; the switch goes on by dt. left: what damage leaves of
 * S. */
HD_CALL void rich_extra(const State *s, const Rich *k, long i, double left, int solid, double dt)
{
  double *to = &s->extra[PAIR_EXTRA * i];
  if (k->viscosity) rich_switch(s, k, i, dt);
  to[0] = (k->viscosity ? s->viscosity[i] : 1) * (k->balsara ? rich_balsara(s, i) : 1);
  to[1] = s->divv[i] < 0 ? -1 - s->mat[i] : 1 + s->mat[i];
  for (int d = 2; d < PAIR_EXTRA; d++) to[d] = 0;
  if (k->artificial > 0) rich_stress(s, k->artificial, i, left, solid, to + 2);
}

#endif
