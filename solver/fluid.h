/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What fluids have besides pressure: physical viscosity, and energy that a run deposits from
 * outside (docs/theory.md 3.7, 3.8). Parts of the passes. */
#ifndef FLUID_H
#define FLUID_H

#include "matter.h"

/* Physical viscosity of a run, of matter without a deviatoric stress of its own. */
typedef struct {
  double shear, bulk;     /* kinematic [m^2/s] */
  double shakura, aspect; /* alpha of Shakura & Sunyaev (1973) and H/r */
  double compression;     /* f of the bulk viscosity f h^2 rho |div v| of compression */
} Fluid;

/* Energy from outside: in a ball, or around an axis through its centre. */
typedef struct {
  double rate;      /* W/kg, of a step its mean; 0: none */
  double centre[3]; /* m */
  double radius;    /* m; 0: everywhere */
  int gaussian;     /* exp(-r^2/(2 radius^2)) instead of 1 within the radius */
  int axis;         /* 1, 2, 3: r is the distance from the line along x, y, z */
} Deposit;

/* fluid_stress: the viscous stress of i [Pa],
 *   eta (dv_a/dx_b + dv_b/dx_a - 2/3 delta_ab div v) + zeta delta_ab div v
 * (Landau & Lifshitz 1987, eq. 15.3), with eta/rho the constant kinematic viscosity plus alpha c H,
 * H = aspect r (Shakura & Sunyaev 1973, A&A 24, 337), and zeta/rho the constant one plus f h^2 |div
 * v| under compression (Schaefer et al. 2004, A&A 418, 325). Its diffusion limits the step as
 * matter_slide's does: 8 times the sum over h is on top of the wave speed. */
HD_CALL Sym fluid_stress(const State *s, const Fluid *f, long i)
{
  const double *g = &s->g[9 * i], div = g[0] + g[4] + g[8];
  double shear = f->shear, bulk = f->bulk;
  Sym e = passes_strain_rate(g);
  if (f->shakura > 0) shear += f->shakura * f->aspect * s->cs[i] * matter_radius(s, i);
  if (div < 0) bulk -= f->compression * s->h[i] * s->h[i] * div;
  s->cl[i] += 8 * (shear + bulk) / s->h[i];
  const double all = s->rho[i] * (bulk - 2. / 3 * shear) * div;
  e = tensor_scale(e, 2 * s->rho[i] * shear);
  e.xx += all, e.yy += all, e.zz += all;
  return e;
}

/* fluid_deposit: what the particle at x receives [W/kg]. */
HD_CALL double fluid_deposit(const Deposit *q, const double *x)
{
  double r2 = 0;
  for (int d = 0; d < 3; d++)
    if (d + 1 != q->axis) r2 += (x[d] - q->centre[d]) * (x[d] - q->centre[d]);
  if (q->gaussian) return q->rate * exp(-0.5 * r2 / (q->radius * q->radius));
  return q->radius == 0 || r2 <= q->radius * q->radius ? q->rate : 0;
}

#endif
