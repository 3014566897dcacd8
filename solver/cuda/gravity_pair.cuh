/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What one source does to one target, in single or double precision, code units, G = 1: see
 * lib/gravity.h. d is from the target to the source. Soft, a literal: how pairs are softened. */
#ifndef GRAVITY_PAIR_CUH
#define GRAVITY_PAIR_CUH

#include <cuda_runtime.h>
#include "../../physics/softening.h"

/* Splines of the pair's h or of one, Plummer's. */
enum { SOFT_PAIR, SOFT_ONE, SOFT_PLUMMER };

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
  const Real q = r * i1, i2 = i1 * i1, mi = m * i1;
  *p = -mi * SOFTENING_POTENTIAL(q);
  return mi * i2 * SOFTENING_FORCE(q);
}

/* pair_plummer: the same; eps2 > 0: epsilon^2. */
template <class Real>
INLINE Real pair_plummer(Real dx, Real dy, Real dz, Real m, Real eps2, Real *p)
{
  const Real i1 = inverse_root(dz * dz + (dy * dy + (dx * dx + eps2))), mi = m * i1;
  *p = -mi;
  return mi * (i1 * i1);
}

/* pair_any: h: the pair's support, or eps2 of Plummer. */
template <int Soft, class Real>
INLINE Real pair_any(Real dx, Real dy, Real dz, Real m, Real h, Real *p)
{
  return Soft == SOFT_PLUMMER ? pair_plummer(dx, dy, dz, m, h, p) : pair_soft(dx, dy, dz, m, h, p);
}

/* pair_own: minus the potential of a particle at its own place. Sums start with it, as the walk and
 * the direct sum come across the particle itself. */
template <int Soft, class Real> INLINE Real pair_own(Real m, Real h)
{
  const Real zero = 0;
  Real p;
  pair_any<Soft>(zero, zero, zero, m, h, &p);
  return -p;
}

/* pair_pole: mass w of a, quadrupole xx xy xz yy of b, yz zz of c; with Plummer's softening z of c:
 * eps2 times the trace. */
template <int Soft, class Real>
INLINE void pair_pole(Real dx, Real dy, Real dz, const Four<Real> &a, const Four<Real> &b,
                      const Four<Real> &c, Real eps2, Field<Real> *f)
{
  const Real r2 = dx * dx + dy * dy + dz * dz, d2 = Soft == SOFT_PLUMMER ? r2 + eps2 : r2;
  const Real i1 = inverse_root(d2), i2 = i1 * i1, i5 = i2 * i2 * i1;
  const Real qx = b.x * dx + b.y * dy + b.z * dz, qy = b.y * dx + b.w * dy + c.x * dz,
             qz = b.z * dx + c.x * dy + c.y * dz;
  const Real qq = qx * dx + qy * dy + qz * dz, mi = a.w * i1,
             u = (Soft == SOFT_PLUMMER ? qq - c.z : qq) * i5;
  const Real k = (mi + (Real)2.5 * u) * i2;
  f->x += k * dx, f->y += k * dy, f->z += k * dz;
  f->x -= i5 * qx, f->y -= i5 * qy, f->z -= i5 * qz;
  f->p -= mi, f->p -= (Real)0.5 * u;
}

#endif
