/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pair terms of SPH: what a neighbour j adds to particle i. Sums over j are the backend's.
 * Kernel, dimension class (line: 1D), solid and miscible are literals of the pair loops. v_ij = v_i
 * - v_j, r_ij = r_i - r_j, h_ij = (h_i + h_j)/2, grad_i W = sigma_D/h^(D+2) (w'(q)/q) r_ij. Terms
 * exchanged between i and j are antisymmetric to rounding. */
#ifndef PAIR_H
#define PAIR_H

#include "kernel.h"
#include "viscosity.h"

/* What is the same for all pairs of a run. */
typedef struct {
  double sigma;       /* kernel_sigma(kern, dimension) */
  double alpha, beta; /* artificial viscosity */
  int dimension;
} PairRun;

/* pair_slope: f of grad_i W = f r_ij [m^-(D+2)]; *inside: whether the pair interacts. */
HD double pair_slope(int kern, int line, const PairRun *run, double r2, double h, int *inside)
{
  double ih = 1 / h, q = sqrt(r2) * ih, power = ih * ih * ih;
  if (!line) power *= run->dimension == 3 ? ih * ih : ih;
  *inside = q < 1;
  return run->sigma * power * kernel_dwq(kern, line ? 1 : 3, q);
}

/* pair_weight: W_ij [m^-D]. */
HD double pair_weight(int kern, int line, const PairRun *run, double r2, double h)
{
  double ih = 1 / h, power = ih;
  if (!line) power *= run->dimension == 3 ? ih * ih : ih;
  return run->sigma * power * kernel_w(kern, line ? 1 : 3, sqrt(r2) * ih);
}

/* Loop A: what it reads of a particle. */
typedef struct {
  double x, y, z, vx, vy, vz; /* m, m/s */
  double h, volume;           /* m, m^D: mass over density */
} PairFlow;

/* Loop A: contributions to the raw velocity gradient g_ab = sum V_j (v_j - v_i)_a dW_b [1/s] and to
 * the moment matrix M_ab = sum V_j (x_j - x_i)_a dW_b, symmetric (001 eq. 41-44 with the errata of
 * docs/theory.md 9). */
typedef struct {
  double gxx, gxy, gxz, gyx, gyy, gyz, gzx, gzy, gzz;
  double mxx, mxy, mxz, myy, myz, mzz;
} PairGradient;

/* pair_gradient: for a fluid only gxx is set, and holds the divergence. */
HD PairGradient pair_gradient(const PairFlow *i, const PairFlow *j, int kern, int line, int solid,
                              const PairRun *run)
{
  PairGradient o = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  int inside;
  double x = i->x - j->x, y = i->y - j->y, z = i->z - j->z;
  double vx = j->vx - i->vx, vy = j->vy - i->vy, vz = j->vz - i->vz;
  double f =
      j->volume * pair_slope(kern, line, run, x * x + y * y + z * z, 0.5 * (i->h + j->h), &inside);
  double wx = f * x, wy = f * y, wz = f * z;
  if (!solid) {
    o.gxx = vx * wx + vy * wy + vz * wz;
    return o;
  }
  o.gxx = vx * wx, o.gxy = vx * wy, o.gxz = vx * wz;
  o.gyx = vy * wx, o.gyy = vy * wy, o.gyz = vy * wz;
  o.gzx = vz * wx, o.gzy = vz * wy, o.gzz = vz * wz;
  o.mxx = -x * wx, o.mxy = -x * wy, o.mxz = -x * wz;
  o.myy = -y * wy, o.myz = -y * wz, o.mzz = -z * wz;
  return o;
}

/* Loop B: what it reads of a particle. t is sigma/rho^2 [Pa m^6/kg^2] with damage (001 eq. 20-21);
 * a fluid has only txx = -p/rho^2. */
typedef struct {
  double x, y, z, vx, vy, vz;      /* m, m/s */
  double h, m, inverse_m, rho, cs; /* m, kg, 1/kg, kg/m^3, m/s (bulk) */
  double signal;                   /* m/s: longitudinal wave speed */
  double txx, txy, txz, tyy, tyz, tzz;
} PairBody;

typedef struct {
  double ax, ay, az; /* m/s^2 */
  double du, dq;     /* W/kg: all work, and its viscous part */
  double signal; /* m/s: c_i + c_j - 3 min(v_ij . r_ij/r, 0); 0 for a pair that does not interact */
  double near;   /* 1 when the pair interacts */
} PairForce;

/* pair_signal: what limits the step [m/s]: waves from both sides and approach, c_i + c_j - 3
 * v_ij.r_ij/r; or the viscosity, whose rate on a pair is 4 (alpha c + beta |nu|)/h for a spline:
 * 3.2 times that speed keeps twice that rate times the step below 1 at cfl 0.4. */
HD double pair_signal(double waves, double vr, double r2, double viscous)
{
  double both = waves - (vr < 0 ? 3 * vr / sqrt(r2) : 0);
  return both > 3.2 * viscous ? both : 3.2 * viscous;
}

/* pair_force: dv_i/dt += m_j T_ij . grad W, du_i/dt -= 1/2 m_j v_ij . T_ij . grad W, T_ij =
 * sigma_i/rho_i^2 + sigma_j/rho_j^2 - Pi. Corrects 001 eq. 30-35 (signs; heating by the viscosity).
 * miscible: the number-density form (004 eq. 2.51-2.54 with the mass that the viscosity lacks in
 * print): T_ij = m_i/m_j sigma_i/rho_i^2 + m_j/m_i sigma_j/rho_j^2 - Pi, and each particle's own
 * stress does its work (the variational form), which keeps the entropy across a jump of density. */
HD PairForce pair_force(const PairBody *i, const PairBody *j, int kern, int line, int solid,
                        int miscible, const PairRun *run)
{
  PairForce o;
  int inside;
  double x = i->x - j->x, y = i->y - j->y, z = i->z - j->z;
  double vx = i->vx - j->vx, vy = i->vy - j->vy, vz = i->vz - j->vz;
  double r2 = x * x + y * y + z * z, vr = vx * x + vy * y + vz * z, h = 0.5 * (i->h + j->h);
  double f = j->m * pair_slope(kern, line, run, r2, h, &inside);
  double nu = viscosity_nu(vr, r2, h), cs = 0.5 * (i->cs + j->cs);
  double pi = viscosity_pi(nu, cs, 0.5 * (i->rho + j->rho), run->alpha, run->beta);
  double ki = miscible ? i->m * j->inverse_m : 1, kj = miscible ? j->m * i->inverse_m : 1;
  double txx = ki * i->txx + kj * j->txx, fx, fy, fz, own;
  if (solid) {
    double txy = ki * i->txy + kj * j->txy, txz = ki * i->txz + kj * j->txz,
           tyy = ki * i->tyy + kj * j->tyy;
    double tyz = ki * i->tyz + kj * j->tyz, tzz = ki * i->tzz + kj * j->tzz;
    fx = txx * x + txy * y + txz * z;
    fy = txy * x + tyy * y + tyz * z;
    fz = txz * x + tyz * y + tzz * z;
  } else {
    fx = txx * x, fy = txx * y, fz = txx * z;
  }
  if (miscible && solid) {
    own =
        2 * ki *
        (vx * (i->txx * x + i->txy * y + i->txz * z) + vy * (i->txy * x + i->tyy * y + i->tyz * z) +
         vz * (i->txz * x + i->tyz * y + i->tzz * z));
  } else if (miscible) {
    own = 2 * ki * i->txx * vr;
  } else {
    own = vx * fx + vy * fy + vz * fz;
  }
  o.ax = f * (fx - pi * x), o.ay = f * (fy - pi * y), o.az = f * (fz - pi * z);
  o.dq = 0.5 * f * pi * vr;
  o.du = o.dq - 0.5 * f * own;
  o.signal =
      inside ? pair_signal(i->signal + j->signal, vr, r2, run->alpha * cs - run->beta * nu) : 0;
  o.near = inside ? 1 : 0;
  return o;
}

#endif
