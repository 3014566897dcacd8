/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pair terms of runs that want more of them than pair.h has (docs/theory.md 2.9 to 2.13): other
 * weights of pressure and stress, viscosity with a switch, artificial stress, smoothed velocities,
 * diffusion of density. One instance has all of them, as numbers. As in pair.h, forces change sign
 * exactly when i and j change places. */
#ifndef PAIR_RICH_H
#define PAIR_RICH_H

#include "pair.h"

/* What is the same for all pairs. */
typedef struct {
  int miscible; /* the number-density form */
  int squares;  /* stresses S_i/rho_i^2 + S_j/rho_j^2; else (S_i + S_j)/(rho_i rho_j) */
  int own;      /* each particle's own pressure and stress do its work */
  int grad;     /* pressures act through kernels of their own h (grad-h) */
  int exponent; /* n of the artificial stress, 0..15 */
  double over;  /* 1/w at the mean distance of particles */
  double g[3];  /* body force, whose hydrostatic density does not diffuse [m/s^2] */
} PairMore;

/* What a particle has for them besides its PairBody. */
typedef struct {
  real viscosity;                    /* share of the artificial viscosity that acts */
  real sense;                        /* 1 + material, with the sign of div v */
  real zxx, zxy, zxz, zyy, zyz, zzz; /* artificial stress over rho^2 [Pa m^6/kg^2] */
} PairExtra;
enum { PAIR_EXTRA = 8 };

typedef struct {
  PairForce f;
  real wx, wy, wz; /* 2 m_i m_j W (v_j - v_i)/(rho_i + rho_j) [kg m/s] */
  real sense;      /* m_j W sign(div v_j) [kg/m^D] */
  real rate;       /* of the density of i, without the coefficient [kg/m^D/s] */
} PairRich;

/* pair_power: x^n, 0 <= n < 16, without branches. */
HD real pair_power(real x, int n)
{
  real x2 = x * x, x4 = x2 * x2;
  return (n & 1 ? x : 1) * (n & 2 ? x2 : 1) * (n & 4 ? x4 : 1) * (n & 8 ? x4 * x4 : 1);
}

/* pair_diffusion: h c psi . grad W V_j of Molteni & Colagrossi (2009, Comput. Phys. Commun. 180,
 * 861), psi = 2 (rho_j - rho_i - rho g.(x_j - x_i)/c^2) (x_j - x_i)/r^2: of what deviates from
 * the hydrostatic density (Fourtakas et al. 2019, Comput. Fluids 190, 346); nothing between
 * materials. f: of grad W = f r. */
HD real pair_diffusion(PairVector r, const PairBody *i, const PairBody *j, real same, real f,
                       real h, real cs, const PairMore *more)
{
  real down = (real)more->g[0] * r.x + (real)more->g[1] * r.y + (real)more->g[2] * r.z;
  real excess = (j->rho - i->rho) + 0.5f * (i->rho + j->rho) * down * real_inverse(cs * cs);
  return -2 * same * h * cs * f * excess * (j->m * j->inverse_rho);
}

/* pair_artificial: (z_i + z_j) r. */
HD PairVector pair_artificial(const PairExtra *i, const PairExtra *j, PairVector r)
{
  real xy = i->zxy + j->zxy, xz = i->zxz + j->zxz, yz = i->zyz + j->zyz;
  PairVector o = {(i->zxx + j->zxx) * r.x + xy * r.y + xz * r.z,
                  xy * r.x + (i->zyy + j->zyy) * r.y + yz * r.z,
                  xz * r.x + yz * r.y + (i->zzz + j->zzz) * r.z};
  return o;
}

/* pair_rich: F = m_i m_j T . grad W with T = -(p + Pi) 1 + S + f^n (z_i + z_j), f = W/W at the mean
 * distance; p, S as more says, Pi times the mean share of both; heating -1/2 v_ij . F, or with
 * `own` i's part of p and S and half of the rest. grad (a literal; it goes with own): the pressures
 * act as p_i grad W(h_i) + p_j grad W(h_j), which is symmetric as a sum of products of sums and
 * differences, however the compiler contracts. */
HD PairRich pair_rich(PairVector r, const PairBody *i, const PairBody *j, const PairExtra *a,
                      const PairExtra *b, int kern, int line, int grad, const PairRun *run,
                      const PairMore *more)
{
  PairRich o;
  int inside;
  PairVector v = {i->vx - j->vx, i->vy - j->vy, i->vz - j->vz}, t, z, d = pair_shear(i, j, r);
  real r2 = pair_dot(r, r), vr = pair_dot(v, r), h = 0.5f * (i->h + j->h), over_r, own;
  real r1 = real_root(r2, &over_r), f = pair_slope(kern, line, run, r1, h, &inside);
  real w = pair_weight(kern, line, run, r2, h), mm = i->m * j->m;
  real nu = viscosity_nu(vr, r2, h), cs = 0.5f * (i->cs + j->cs), sum = i->rho + j->rho;
  real share = 0.5f * (a->viscosity + b->viscosity);
  real pi = mm * share * viscosity_pi(nu, cs, 0.5f * sum, (real)run->alpha, (real)run->beta);
  real both = mm * (i->inverse_rho * j->inverse_rho);
  real wp = more->miscible ? 1
            : run->volumes ? both
                           : mm,
       ws = more->squares     ? mm
            : run->integrated ? 1
                              : both;
  real x = kernel_w(kern, line ? 1 : 3, r1 * real_inverse(h)) * (real)more->over;
  real p = grad ? 0 : wp * (i->p + j->p), push = 0, fi = 0,
       lift = mm * pair_power(x, more->exponent);
  real across = 2 * mm * w * real_inverse(sum);
  if (grad) {
    int near;
    real fj = pair_slope(kern, line, run, r1, j->h, &near);
    fi = pair_slope(kern, line, run, r1, i->h, &near);
    push = 0.5f * wp * ((fi + fj) * (i->p + j->p) + (fi - fj) * (i->p - j->p));
  }
  z = pair_artificial(a, b, r);
  z.x *= lift, z.y *= lift, z.z *= lift;
  t.x = ws * d.x - p * r.x, t.y = ws * d.y - p * r.y, t.z = ws * d.z - p * r.z;
  own = more->own ? 2 * (ws * pair_shear_work(i, r, v) - (grad ? 0 : wp * i->p * vr))
                  : pair_dot(v, t);
  o.f.fx = f * (t.x + z.x - pi * r.x), o.f.fy = f * (t.y + z.y - pi * r.y);
  o.f.fz = f * (t.z + z.z - pi * r.z);
  o.f.fx -= push * r.x, o.f.fy -= push * r.y, o.f.fz -= push * r.z;
  o.f.work = 0.5f * f * (pi * vr - own - pair_dot(v, z)) + wp * i->p * fi * vr;
  o.f.signal = inside ? pair_signal(i->signal + j->signal, vr, over_r,
                                    share * ((real)run->alpha * cs - (real)run->beta * nu))
                      : 0;
  o.f.near = inside ? 1 : 0;
  o.wx = -across * v.x, o.wy = -across * v.y, o.wz = -across * v.z;
  o.sense = b->sense < 0 ? -j->m * w : j->m * w;
  real same = a->sense * a->sense == b->sense * b->sense ? 1 : 0;
  o.rate = inside ? pair_diffusion(r, i, j, same, f, h, cs, more) : 0;
  return o;
}

#endif
