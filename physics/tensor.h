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

/* tensor_det: the determinant. */
HD double tensor_det(Sym s)
{
  return s.xx * (s.yy * s.zz - s.yz * s.yz) - s.xy * (s.xy * s.zz - s.yz * s.xz) +
         s.xz * (s.xy * s.yz - s.yy * s.xz);
}

/* tensor_largest: the largest eigenvalue, in closed form (Smith 1961, Comm. ACM 4, 168); to 1e-7 of
 * the norm where the two largest coincide, to rounding elsewhere. */
HD double tensor_largest(Sym s)
{
  double q = (s.xx + s.yy + s.zz) / 3, p, arg;
  Sym d = {s.xx - q, s.xy, s.xz, s.yy - q, s.yz, s.zz - q};
  double j2 = tensor_j2(d);
  if (j2 <= 0) return q;
  p = sqrt(j2 / 3);
  arg = tensor_det(d) / (2 * p * p * p);
  arg = arg < -1 ? -1 : arg > 1 ? 1 : arg;
  return q + 2 * p * cos(acos(arg) / 3);
}

/* tensor_turn: one rotation of Jacobi's method that takes m[p][q] away; its columns into axes. */
HD void tensor_turn(double m[3][3], double axes[3][3], int p, int q)
{
  if (m[p][q] == 0) return;
  const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
  const double c = 1 / sqrt(t * t + 1), s = t * c;
  for (int k = 0; k < 3; k++) {
    const double a = m[k][p], b = m[k][q], u = axes[k][p], v = axes[k][q];
    m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
    axes[k][p] = c * u - s * v, axes[k][q] = s * u + c * v;
  }
  for (int k = 0; k < 3; k++) {
    const double a = m[p][k], b = m[q][k];
    m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
  }
}

/* tensor_tension: what is left of s when its negative eigenvalues are taken for 0 (Jacobi; five
 * sweeps, to rounding). */
HD_CALL Sym tensor_tension(Sym s)
{
  double m[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
  double n[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Sym o = {0, 0, 0, 0, 0, 0};
  for (int sweep = 0; sweep < 5; sweep++)
    tensor_turn(m, n, 0, 1), tensor_turn(m, n, 0, 2), tensor_turn(m, n, 1, 2);
  for (int k = 0; k < 3; k++) {
    const double l = m[k][k] > 0 ? m[k][k] : 0;
    o.xx += l * n[0][k] * n[0][k], o.xy += l * n[0][k] * n[1][k], o.xz += l * n[0][k] * n[2][k];
    o.yy += l * n[1][k] * n[1][k], o.yz += l * n[1][k] * n[2][k], o.zz += l * n[2][k] * n[2][k];
  }
  return o;
}

/* tensor_invert: the inverse by cofactors; det != 0 as tensor_det has it. */
HD Sym tensor_invert(Sym s, double det)
{
  Sym c = {s.yy * s.zz - s.yz * s.yz, s.xz * s.yz - s.xy * s.zz, s.xy * s.yz - s.xz * s.yy,
           s.xx * s.zz - s.xz * s.xz, s.xy * s.xz - s.xx * s.yz, s.xx * s.yy - s.xy * s.xy};
  return tensor_scale(c, 1 / det);
}

/* tensor_solve: x with s x = b; 0 where s is as good as singular (det below 1e-12 of the cube of
 * the mean eigenvalue). */
HD void tensor_solve(Sym s, const double b[3], double x[3])
{
  double mean = (s.xx + s.yy + s.zz) / 3, det = tensor_det(s);
  x[0] = x[1] = x[2] = 0;
  if (!(fabs(det) > 1e-12 * fabs(mean * mean * mean))) return;
  s = tensor_invert(s, det);
  x[0] = s.xx * b[0] + s.xy * b[1] + s.xz * b[2];
  x[1] = s.xy * b[0] + s.yy * b[1] + s.yz * b[2];
  x[2] = s.xz * b[0] + s.yz * b[1] + s.zz * b[2];
}

/* tensor_product: t = a b, not symmetric; row-major. */
HD void tensor_product(Sym a, Sym b, double t[9])
{
  t[0] = a.xx * b.xx + a.xy * b.xy + a.xz * b.xz;
  t[1] = a.xx * b.xy + a.xy * b.yy + a.xz * b.yz;
  t[2] = a.xx * b.xz + a.xy * b.yz + a.xz * b.zz;
  t[3] = a.xy * b.xx + a.yy * b.xy + a.yz * b.xz;
  t[4] = a.xy * b.xy + a.yy * b.yy + a.yz * b.yz;
  t[5] = a.xy * b.xz + a.yy * b.yz + a.yz * b.zz;
  t[6] = a.xz * b.xx + a.yz * b.xy + a.zz * b.xz;
  t[7] = a.xz * b.xy + a.yz * b.yy + a.zz * b.yz;
  t[8] = a.xz * b.xz + a.yz * b.yz + a.zz * b.zz;
}

#endif
