/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What one source does to one target, in single or double precision, code units, G = 1: see
 * lib/gravity.h. d is from the target to the source. */
#ifndef GRAVITY_PAIR_CUH
#define GRAVITY_PAIR_CUH

#include <cuda_runtime.h>
#include "../../physics/hd.h"

#define INLINE static __device__ __forceinline__

template <class Real> struct alignas(16) Four {
  Real x, y, z, w;
};

/* Acceleration and potential. */
template <class Real> struct Field {
  Real x, y, z, p;
};

INLINE float larger(float a, float b) { return fmaxf(a, b); }
INLINE double larger(double a, double b) { return a > b ? a : b; }
INLINE float inverse(float x) { return 1 / x; }
INLINE double inverse(double x) { return hd_inverse(x); }
INLINE float inverse_root(float x) { return rsqrtf(x); }
INLINE double inverse_root(double x) { return hd_inverse_root(x); }

/* Squares of distances are at least this, so that coincident particles make no NaN: a distance of
 * 1e-12 of the unit. */
template <class Real> INLINE Real pair_square(Real dx, Real dy, Real dz)
{
  return dz * dz + (dy * dy + (dx * dx + (Real)1e-24));
}

/* pair_newton: a mass beyond the softening. */
template <class Real> INLINE void pair_newton(Real dx, Real dy, Real dz, Real m, Field<Real> *f)
{
  const Real i1 = inverse_root(dx * dx + dy * dy + dz * dz), mi = m * i1, c = mi * (i1 * i1);
  f->x += c * dx, f->y += c * dy, f->z += c * dz, f->p -= mi;
}

/* pair_soft: any; h: the pair's support, the sum of both halves. F(q) and P(q) are one beyond it.
 * The acceleration over d; *p: the potential. */
template <class Real> INLINE Real pair_soft(Real dx, Real dy, Real dz, Real m, Real h, Real *p)
{
  const Real r2 = pair_square(dx, dy, dz), r = r2 * inverse_root(r2), i1 = inverse(larger(r, h));
  const Real q = r * i1, q2 = q * q, i2 = i1 * i1, mi = m * i1;
  const Real force = 14 + q2 * (-84 + q * (140 + q * (-90 + q * 21)));
  const Real potential = 3 + q2 * (-7 + q2 * (21 + q * (-28 + q * (15 - q * 3))));
  *p = -mi * potential;
  return mi * i2 * force;
}

/* pair_own: minus the potential of a particle at its own place. Sums start with it, as the walk and
 * the direct sum come across the particle itself. */
template <class Real> INLINE Real pair_own(Real m, Real h)
{
  const Real zero = 0;
  Real p;
  pair_soft(zero, zero, zero, m, h, &p);
  return -p;
}

/* pair_pole: mass w of a, quadrupole xx xy xz yy of b, yz zz of c. */
template <class Real>
INLINE void pair_pole(Real dx, Real dy, Real dz, const Four<Real> &a, const Four<Real> &b,
                      const Four<Real> &c, Field<Real> *f)
{
  const Real i1 = inverse_root(dx * dx + dy * dy + dz * dz), i2 = i1 * i1, i5 = i2 * i2 * i1;
  const Real qx = b.x * dx + b.y * dy + b.z * dz, qy = b.y * dx + b.w * dy + c.x * dz,
             qz = b.z * dx + c.x * dy + c.y * dz;
  const Real u = (qx * dx + qy * dy + qz * dz) * i5, mi = a.w * i1;
  const Real k = (mi + (Real)2.5 * u) * i2;
  f->x += k * dx, f->y += k * dy, f->z += k * dz;
  f->x -= i5 * qx, f->y -= i5 * qy, f->z -= i5 * qz;
  f->p -= mi, f->p -= (Real)0.5 * u;
}

#endif
