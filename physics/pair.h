/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pair terms of SPH: what particles i and j exchange. Sums over j are the backend's, which also
 * holds the coordinates and takes their difference r = r_i - r_j as exactly as it can. Kernel,
 * dimension class (line: 1D), solid and miscible are literals of the pair loops. h = (h_i + h_j)/2,
 * grad_i W = sigma_D/h^(D+2) (w'(q)/q) r. Forces change sign exactly when i and j change places,
 * however the compiler contracts. In single precision (real, hd.h) use units in which r^5 and m^2
 * stay in range. */
#ifndef PAIR_H
#define PAIR_H

#include "kernel.h"
#include "viscosity.h"

/* What is the same for all pairs of a run. */
typedef struct {
  double sigma;       /* kernel_sigma(kern, dimension) */
  double alpha, beta; /* artificial viscosity */
  int dimension;
  int volumes;    /* pressures act on volumes: (p_i + p_j)/(rho_i rho_j) */
  int integrated; /* miscible: stresses come with the squares of their own volumes */
} PairRun;

typedef struct {
  real x, y, z;
} PairVector;

HD real pair_dot(PairVector a, PairVector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/* pair_slope: f of grad_i W = f r [m^-(D+2)]; *inside: whether the pair interacts. */
HD real pair_slope(int kern, int line, const PairRun *run, real r, real h, int *inside)
{
  real ih = real_inverse(h), q = r * ih, power = ih * ih * ih;
  if (!line) power *= run->dimension == 3 ? ih * ih : ih;
  *inside = q < 1;
  return (real)run->sigma * power * kernel_dwq(kern, line ? 1 : 3, q);
}

/* pair_weight: W_ij [m^-D]. */
HD real pair_weight(int kern, int line, const PairRun *run, real r2, real h)
{
  real over, ih = real_inverse(h), q = real_root(r2, &over) * ih, power = ih;
  if (!line) power *= run->dimension == 3 ? ih * ih : ih;
  return (real)run->sigma * power * kernel_w(kern, line ? 1 : 3, q);
}

/* pair_weight_rate: dW/dh [m^-(D+1)]. */
HD real pair_weight_rate(int kern, int line, const PairRun *run, real r2, real h)
{
  real over, ih = real_inverse(h), q = real_root(r2, &over) * ih, power = ih * ih;
  if (!line) power *= run->dimension == 3 ? ih * ih : ih;
  return -(real)run->sigma * power *
         ((real)run->dimension * kernel_w(kern, line ? 1 : 3, q) +
          q * q * kernel_dwq(kern, line ? 1 : 3, q));
}

/* Loop A: contributions to the raw velocity gradient g_ab = sum V_j (v_j - v_i)_a dW_b [1/s], to
 * the moment matrix M_ab = sum V_j (x_j - x_i)_a dW_b, symmetric (001 eq. 41-44 with the errata of
 * docs/theory.md 9). spread: M_aa less what it would be if all of r^2 were D h^2/60; at most 0
 * where neighbours are closer than that in the mean (theory 2.3). */
typedef struct {
  real gxx, gxy, gxz, gyx, gyy, gyz, gzx, gzy, gzz;
  real mxx, mxy, mxz, myy, myz, mzz;
  real spread;
} PairGradient;

/* pair_wide: the factor on a whole M: 1, or 0 where spread says that the neighbours lie close
 * together and gradients stay raw (a factor, as a flag costs the loops on a card registers). */
HD real pair_wide(real spread) { return spread > 0; }

/* pair_gradient: r = r_i - r_j [m], v = v_i - v_j [m/s], volume m_j/rho_j [m^D]; for a fluid only
 * gxx is set, and holds the divergence. */
HD PairGradient pair_gradient(PairVector r, PairVector v, real h, real volume, int kern, int line,
                              int solid, const PairRun *run)
{
  PairGradient o = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  int inside;
  real over, r2 = pair_dot(r, r),
             f = -volume * pair_slope(kern, line, run, real_root(r2, &over), h, &inside);
  real wx = f * r.x, wy = f * r.y, wz = f * r.z;
  if (!solid) {
    o.gxx = v.x * wx + v.y * wy + v.z * wz;
    return o;
  }
  o.gxx = v.x * wx, o.gxy = v.x * wy, o.gxz = v.x * wz;
  o.gyx = v.y * wx, o.gyy = v.y * wy, o.gyz = v.y * wz;
  o.gzx = v.z * wx, o.gzy = v.z * wy, o.gzz = v.z * wz;
  o.mxx = r.x * wx, o.mxy = r.x * wy, o.mxz = r.x * wz;
  o.myy = r.y * wy, o.myz = r.y * wz, o.mzz = r.z * wz;
  o.spread = f * (r2 - (real)run->dimension / 60 * h * h);
  return o;
}

/* Loop B: what it reads of a particle besides its place. p and S as damage leaves them (001 eq.
 * 20-21); C is the inverse moment matrix (passes_pack). A fluid has no d. */
typedef struct {
  real vx, vy, vz;       /* m/s */
  real h, m;             /* m, kg */
  real rho, inverse_rho; /* kg/m^3, m^3/kg */
  real cs, signal;       /* m/s: bulk and longitudinal wave speed */
  real p; /* volumes: p [Pa]; else p/rho^2 [Pa m^6/kg^2]; miscible: times m^2 [Pa m^6] */
  real dxx, dxy, dxz, dyx, dyy, dyz, dzx, dzy, dzz; /* S C [Pa] */
} PairBody;

typedef struct {
  real fx, fy, fz; /* force on i [N] */
  real work;       /* power that heats i [W] */
  real signal;     /* m/s: what limits the step; 0 for a pair that does not interact */
  real near;       /* 1 when the pair interacts */
} PairForce;

/* pair_signal: what limits the step [m/s]: waves from both sides and approach, c_i + c_j - 3
 * v_ij.r_ij/r; or the viscosity, whose rate on a pair is 4 (alpha c + beta |nu|)/h for a spline:
 * 3.2 times that speed keeps twice that rate times the step below 1 at cfl 0.4. */
HD real pair_signal(real waves, real vr, real over_r, real viscous)
{
  real both = waves - (vr < 0 ? 3 * vr * over_r : 0);
  return both > (real)3.2 * viscous ? both : (real)3.2 * viscous;
}

/* pair_shear: (d_i + d_j) r; sums first, so that i and j may change places. */
HD PairVector pair_shear(const PairBody *i, const PairBody *j, PairVector r)
{
  PairVector o = {(i->dxx + j->dxx) * r.x + (i->dxy + j->dxy) * r.y + (i->dxz + j->dxz) * r.z,
                  (i->dyx + j->dyx) * r.x + (i->dyy + j->dyy) * r.y + (i->dyz + j->dyz) * r.z,
                  (i->dzx + j->dzx) * r.x + (i->dzy + j->dzy) * r.y + (i->dzz + j->dzz) * r.z};
  return o;
}

/* pair_shear_work: v d_i r. */
HD real pair_shear_work(const PairBody *i, PairVector r, PairVector v)
{
  return v.x * (i->dxx * r.x + i->dxy * r.y + i->dxz * r.z) +
         v.y * (i->dyx * r.x + i->dyy * r.y + i->dyz * r.z) +
         v.z * (i->dzx * r.x + i->dzy * r.y + i->dzz * r.z);
}

/* pair_force: F = m_i m_j T . grad W, heating -1/2 v_ij . F, r = r_i - r_j,
 *   T = -(p_i/rho_i^2 + p_j/rho_j^2 + Pi) 1 + (S_i C_i + S_j C_j)/(rho_i rho_j).
 * Corrects 001 eq. 30-35 (signs; heating by the viscosity). The pressure goes with the density by
 * continuity, the stress with the corrected gradient that drives it (docs/theory.md 2.4).
 * run->volumes: (p_i + p_j)/(rho_i rho_j), which has no force where p is the same and rho jumps.
 * miscible: the number-density form (004 eq. 2.51-2.54 with the mass that the viscosity lacks in
 * print): m_i/m_j p_i/rho_i^2 + m_j/m_i p_j/rho_j^2, and each particle's own stress does its work
 * (the variational form), which keeps the entropy across a jump of density. run->integrated: V_i^2
 * S_i C_i + V_j^2 S_j C_j, what goes with gradients of its own volumes. */
HD PairForce pair_force(PairVector r, const PairBody *i, const PairBody *j, int kern, int line,
                        int solid, int miscible, const PairRun *run)
{
  PairForce o;
  int inside;
  PairVector v = {i->vx - j->vx, i->vy - j->vy, i->vz - j->vz}, t;
  real r2 = pair_dot(r, r), vr = pair_dot(v, r), h = 0.5f * (i->h + j->h), own;
  real over_r, r1 = real_root(r2, &over_r);
  real f = pair_slope(kern, line, run, r1, h, &inside), mm = i->m * j->m;
  real nu = viscosity_nu(vr, r2, h), cs = 0.5f * (i->cs + j->cs);
  real pi = mm * viscosity_pi(nu, cs, 0.5f * (i->rho + j->rho), (real)run->alpha, (real)run->beta);
  real vv = mm * (i->inverse_rho * j->inverse_rho);
  real p = (miscible ? 1 : run->volumes ? vv : mm) * (i->p + j->p);
  t.x = -p * r.x, t.y = -p * r.y, t.z = -p * r.z, own = -2 * i->p * vr;
  if (solid) {
    PairVector d = pair_shear(i, j, r);
    real ws = miscible && run->integrated ? 1 : vv;
    t.x += ws * d.x, t.y += ws * d.y, t.z += ws * d.z;
    if (miscible) own += 2 * ws * pair_shear_work(i, r, v);
  }
  if (!miscible) own = pair_dot(v, t);
  o.fx = f * (t.x - pi * r.x), o.fy = f * (t.y - pi * r.y), o.fz = f * (t.z - pi * r.z);
  o.work = 0.5f * f * (pi * vr - own);
  o.signal = inside ? pair_signal(i->signal + j->signal, vr, over_r,
                                  (real)run->alpha * cs - (real)run->beta * nu)
                    : 0;
  o.near = inside ? 1 : 0;
  return o;
}

#endif
