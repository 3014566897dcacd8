/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The language of physics/: one source for gcc, clang and nvcc. The only file that knows the
 * compiler. HD marks a function that runs on host and device; everything in physics/ is HD, without
 * globals, I/O or malloc. */
#ifndef HD_H
#define HD_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* HD_CALL: a function that is called, not inlined: laws that few runs use and that would cost the
 * others registers. */
#ifdef __CUDACC__
#define HD       static __host__ __device__ __forceinline__
#define HD_CALL  static __host__ __device__ __attribute__((noinline, unused))
#define RESTRICT __restrict__
#else
#define HD       static inline __attribute__((always_inline, unused))
#define HD_CALL  static __attribute__((noinline, unused))
#define RESTRICT restrict
#endif

/* The type of pair arithmetic (kernel.h, viscosity.h, pair.h): double, unless the including file
 * says otherwise. Literals there are exact as floats or cast, so that nothing widens by itself. */
#ifndef REAL
#define REAL double
#endif
typedef REAL real;

/* hd_inverse: 1/x; hd_inverse_root: 1/sqrt(x); hd_root: sqrt(x), *inverse: one over it. Within 2
 * ulp for |x| in 1e-300 .. 1e300, hd_root for x in 1e-280 .. 1e300 and 0 (*inverse is then large or
 * infinite). A GPU has no such instructions in double precision, and what the compiler puts in
 * their place branches for rare arguments, which keeps it from mixing independent pairs. These do
 * not branch: one step of third order (hd_refine_*) from what the hardware estimates from the upper
 * half of x to 2^-19, as the upper half of a double. */
HD double hd_refine_inverse(double x, double y)
{
  const double e = fma(-x, y, 1.0);
  return fma(fma(e, e, e), y, y);
}

HD double hd_refine_inverse_root(double x, double y)
{
  const double e = fma(-x, y * y, 1.0);
  return fma(fma(0.375, e, 0.5), y * e, y);
}

#ifdef __CUDA_ARCH__
HD double hd_inverse(double x)
{
  double y;
  asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
  return hd_refine_inverse(x, y);
}

HD double hd_inverse_root(double x)
{
  double y;
  asm("rsqrt.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
  return hd_refine_inverse_root(x, y);
}

HD double hd_root(double x, double *inverse)
{
  *inverse = hd_inverse_root(x + 1e-300);
  return x * *inverse;
}
#else
HD double hd_inverse(double x) { return 1 / x; }
HD double hd_inverse_root(double x) { return 1 / sqrt(x); }
HD double hd_root(double x, double *inverse)
{
  *inverse = hd_inverse_root(x);
  return sqrt(x);
}
#endif

/* The same for the type of pair arithmetic. In single precision the compiler knows best. */
HD real real_inverse(real x) { return sizeof x == sizeof(float) ? 1 / x : (real)hd_inverse(x); }
HD real real_root(real x, real *inverse)
{
  double over = 0;
  const real root = sizeof x == sizeof(float) ? (real)sqrt(x) : (real)hd_root(x, &over);
  *inverse = sizeof x == sizeof(float) ? 1 / root : (real)over;
  return root;
}

#endif
