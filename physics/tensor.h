/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Symmetric 3x3 tensors as six numbers xx xy xz yy yz zz, full ones as nine, row-major:
 * g[3*a+b] = dv_a/dx_b. */
#ifndef TENSOR_H
#define TENSOR_H

#include "hd.h"

typedef struct {
  double xx, xy, xz, yy, yz, zz;
} Sym;

/* tensor_j2: second invariant 1/2 S:S of a deviatoric tensor (001 eq. 18); S_zz counts in 2D. */
HD double tensor_j2(Sym s)
{
  return 0.5 * (s.xx * s.xx + s.yy * s.yy + s.zz * s.zz) + s.xy * s.xy + s.xz * s.xz + s.yz * s.yz;
}

HD Sym tensor_scale(Sym s, double f)
{
  Sym t = {f * s.xx, f * s.xy, f * s.xz, f * s.yy, f * s.yz, f * s.zz};
  return t;
}

/* tensor_axpy: s + f t. */
HD Sym tensor_axpy(Sym s, double f, Sym t)
{
  Sym r = {s.xx + f * t.xx, s.xy + f * t.xy, s.xz + f * t.xz,
           s.yy + f * t.yy, s.yz + f * t.yz, s.zz + f * t.zz};
  return r;
}

/* tensor_dot: s:t, the full contraction. */
HD double tensor_dot(Sym s, Sym t)
{
  return s.xx * t.xx + s.yy * t.yy + s.zz * t.zz + 2 * (s.xy * t.xy + s.xz * t.xz + s.yz * t.yz);
}

/* tensor_largest: the largest eigenvalue, in closed form (Smith 1961, Comm. ACM 4, 168); to 1e-7 of
 * the norm where the two largest coincide, to rounding elsewhere. */
HD double tensor_largest(Sym s)
{
  double q = (s.xx + s.yy + s.zz) / 3, p, c, arg;
  Sym d = {s.xx - q, s.xy, s.xz, s.yy - q, s.yz, s.zz - q};
  double j2 = tensor_j2(d);
  if (j2 <= 0) return q;
  p = sqrt(j2 / 3);
  c = d.xx * (d.yy * d.zz - d.yz * d.yz) - d.xy * (d.xy * d.zz - d.yz * d.xz) +
      d.xz * (d.xy * d.yz - d.yy * d.xz);
  arg = c / (2 * p * p * p);
  arg = arg < -1 ? -1 : arg > 1 ? 1 : arg;
  return q + 2 * p * cos(acos(arg) / 3);
}

/* tensor_invert: c = inverse of m by cofactors. Returns the determinant; when it is 0, c is left
 * alone. */
HD double tensor_invert(const double m[9], double c[9])
{
  double a = m[4] * m[8] - m[5] * m[7];
  double b = m[5] * m[6] - m[3] * m[8];
  double d = m[3] * m[7] - m[4] * m[6];
  double det = m[0] * a + m[1] * b + m[2] * d;
  if (det == 0) return 0;
  c[0] = a / det;
  c[1] = (m[2] * m[7] - m[1] * m[8]) / det;
  c[2] = (m[1] * m[5] - m[2] * m[4]) / det;
  c[3] = b / det;
  c[4] = (m[0] * m[8] - m[2] * m[6]) / det;
  c[5] = (m[2] * m[3] - m[0] * m[5]) / det;
  c[6] = d / det;
  c[7] = (m[1] * m[6] - m[0] * m[7]) / det;
  c[8] = (m[0] * m[4] - m[1] * m[3]) / det;
  return det;
}

#endif
