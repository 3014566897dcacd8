/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The deviatoric stress in a velocity field: its rate, its rotation, Hooke's law. Parts of the
 * passes; g is dv_a/dx_b. */
#ifndef ELASTIC_H
#define ELASTIC_H

#include "matter.h"

/* passes_jaumann: dS/dt = 2 mu (e - tr e/3) + R S - S R, R = (g - g^T)/2. Corrects the sign of 001
 * eq. 9 (docs/theory.md 9). */
HD Sym passes_jaumann(Sym s, const double *g, double mu)
{
  double rxy = 0.5 * (g[1] - g[3]), rxz = 0.5 * (g[2] - g[6]), ryz = 0.5 * (g[5] - g[7]);
  double tr = (g[0] + g[4] + g[8]) / 3;
  Sym d;
  d.xx = 2 * mu * (g[0] - tr) + 2 * (rxy * s.xy + rxz * s.xz);
  d.yy = 2 * mu * (g[4] - tr) + 2 * (ryz * s.yz - rxy * s.xy);
  d.zz = 2 * mu * (g[8] - tr) - 2 * (rxz * s.xz + ryz * s.yz);
  d.xy = mu * (g[1] + g[3]) + rxy * (s.yy - s.xx) + rxz * s.yz + ryz * s.xz;
  d.xz = mu * (g[2] + g[6]) + rxz * (s.zz - s.xx) + rxy * s.yz - ryz * s.xy;
  d.yz = mu * (g[5] + g[7]) + ryz * (s.zz - s.yy) - rxy * s.xz - rxz * s.xy;
  return d;
}

/* passes_rotate: Q S Q^T with Q = exp(R dt), R the spin of the velocity gradient g: exact for
 * rigid rotation (Rodrigues). */
HD Sym passes_rotate(Sym s, const double *g, double dt)
{
  double w[3] = {0.5 * (g[7] - g[5]), 0.5 * (g[2] - g[6]), 0.5 * (g[3] - g[1])}, q[9], t[9];
  double rate = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]), c = cos(rate * dt), f, v;
  const double m[9] = {s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz};
  if (rate == 0) return s;
  f = sin(rate * dt) / rate, v = (1 - c) / (rate * rate);
  q[0] = c + v * w[0] * w[0], q[1] = v * w[0] * w[1] - f * w[2], q[2] = v * w[0] * w[2] + f * w[1];
  q[3] = v * w[0] * w[1] + f * w[2], q[4] = c + v * w[1] * w[1], q[5] = v * w[1] * w[2] - f * w[0];
  q[6] = v * w[0] * w[2] - f * w[1], q[7] = v * w[1] * w[2] + f * w[0], q[8] = c + v * w[2] * w[2];
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      t[3 * a + b] = q[3 * a] * m[b] + q[3 * a + 1] * m[3 + b] + q[3 * a + 2] * m[6 + b];
  s.xx = t[0] * q[0] + t[1] * q[1] + t[2] * q[2], s.xy = t[0] * q[3] + t[1] * q[4] + t[2] * q[5];
  s.xz = t[0] * q[6] + t[1] * q[7] + t[2] * q[8], s.yy = t[3] * q[3] + t[4] * q[4] + t[5] * q[5];
  s.yz = t[3] * q[6] + t[4] * q[7] + t[5] * q[8], s.zz = t[6] * q[6] + t[7] * q[7] + t[8] * q[8];
  return s;
}

/* passes_elastic: S after dt: half the rotation, Hooke's law for the deviatoric strain, the
 * other half. Second order; a pure rotation is exact. */
HD Sym passes_elastic(Sym s, const double *g, double mu, double dt)
{
  Sym e = passes_strain_rate(g);
  double third = (e.xx + e.yy + e.zz) / 3;
  e.xx -= third, e.yy -= third, e.zz -= third;
  return passes_rotate(tensor_axpy(passes_rotate(s, g, 0.5 * dt), 2 * mu * dt, e), g, 0.5 * dt);
}

#endif
