/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SPH kernels W(r, h) = sigma/h^D w(q), q = r/h, D = 1, 2, 3. h is the radius of the support: w = 0
 * for q >= 1 (001 eq. 25). grad_i W = sigma/h^(D+2) dwq(q) r_ij with dwq = (dw/dq)/q, which stays
 * finite at q = 0. A kernel is w, dwq and three sigma; a new one: two functions and one X. The
 * kernel is a literal argument of the pair loops, so that the switch folds away; the rest has no
 * branches, only selects, so that the loops vectorise. */
#ifndef KERNEL_H
#define KERNEL_H

#include "hd.h"

#define KERNEL_PI 3.14159265358979323846

/* X(CAPITAL, name, sigma in 1D, 2D, 3D). Splines: Schoenberg (1946), Monaghan & Lattanzio (1985),
 * Price (2012); Wendland (1995) with the norms of Dehnen & Aly (2012); spiky:
 * Desbrun & Gascuel (1996). */
/* clang-format off */
#define KERNELS(X) \
  X(CUBIC_SPLINE, cubic_spline, 4. / 3, 40 / (7 * KERNEL_PI), 8 / KERNEL_PI) \
  X(QUARTIC_SPLINE, quartic_spline, 3125. / 768, 46875 / (2398 * KERNEL_PI), \
    15625 / (512 * KERNEL_PI)) \
  X(QUINTIC_SPLINE, quintic_spline, 243. / 40, 15309 / (478 * KERNEL_PI), 2187 / (40 * KERNEL_PI)) \
  X(WENDLAND_C2, wendland_c2, 5. / 4, 7 / KERNEL_PI, 21 / (2 * KERNEL_PI)) \
  X(WENDLAND_C4, wendland_c4, 3. / 2, 9 / KERNEL_PI, 495 / (32 * KERNEL_PI)) \
  X(WENDLAND_C6, wendland_c6, 55. / 32, 78 / (7 * KERNEL_PI), 1365 / (64 * KERNEL_PI)) \
  X(SPIKY, spiky, 2, 10 / KERNEL_PI, 15 / KERNEL_PI)
/* clang-format on */

typedef enum {
#define KERNEL_ENUM(CAPITAL, ...) KERNEL_##CAPITAL,
  KERNELS(KERNEL_ENUM)
#undef KERNEL_ENUM
      KERNEL_COUNT
} Kernel;

/* KERNEL_WORDS: "cubic_spline|quartic_spline|..." in the order of the enum, for options and
 * configs. */
#define KERNEL_WORD(CAPITAL, NAME, ...) "|" #NAME
#define KERNEL_WORDS                    (&KERNELS(KERNEL_WORD)[1])

/* (x)_+^n, the truncated powers. Not fmax: its rules for NaN keep gcc from vectorising. */
HD real kernel_max(real a, real b) { return a > b ? a : b; }
HD real kernel_plus(real x) { return kernel_max(x, 0); }
HD real kernel_plus2(real x) { return kernel_plus(x) * kernel_plus(x); }
HD real kernel_plus3(real x) { return kernel_plus2(x) * kernel_plus(x); }
HD real kernel_plus4(real x) { return kernel_plus2(x) * kernel_plus2(x); }
HD real kernel_plus5(real x) { return kernel_plus4(x) * kernel_plus(x); }

/* Splines M4, M5, M6 in units of their support. Near q = 0 the truncated powers of dw/dq cancel to
 * a polynomial divisible by q. */
HD real kernel_cubic_spline(int dimension, real q)
{
  (void)dimension;
  return 2 * kernel_plus3(1 - q) - 8 * kernel_plus3(0.5f - q);
}

HD real kernel_cubic_spline_dwq(int dimension, real q)
{
  (void)dimension;
  return q < 0.5f ? 18 * q - 12 : -6 * kernel_plus2(1 - q) * real_inverse(kernel_max(q, 0.5f));
}

HD real kernel_quartic_spline(int dimension, real q)
{
  (void)dimension;
  return kernel_plus4(1 - q) - 5 * kernel_plus4((real)0.6 - q) + 10 * kernel_plus4((real)0.2 - q);
}

HD real kernel_quartic_spline_dwq(int dimension, real q)
{
  real outer = -4 * (kernel_plus3(1 - q) - 5 * kernel_plus3((real)0.6 - q)) *
               real_inverse(kernel_max(q, (real)0.2));
  (void)dimension;
  return q < (real)0.2 ? 24 * q * q - (real)4.8 : outer;
}

HD real kernel_quintic_spline(int dimension, real q)
{
  (void)dimension;
  return kernel_plus5(1 - q) - 6 * kernel_plus5((real)(2. / 3) - q) +
         15 * kernel_plus5((real)(1. / 3) - q);
}

HD real kernel_quintic_spline_dwq(int dimension, real q)
{
  real outer = -5 * (kernel_plus4(1 - q) - 6 * kernel_plus4((real)(2. / 3) - q)) *
               real_inverse(kernel_max(q, (real)(1. / 3)));
  (void)dimension;
  return q < (real)(1. / 3) ? (40 - 50 * q) * q * q - (real)(40. / 9) : outer;
}

/* Wendland functions: one polynomial for 1D, another for 2D and 3D. */
HD real kernel_wendland_c2(int dimension, real q)
{
  return dimension == 1 ? kernel_plus3(1 - q) * (1 + 3 * q) : kernel_plus4(1 - q) * (1 + 4 * q);
}

HD real kernel_wendland_c2_dwq(int dimension, real q)
{
  return dimension == 1 ? -12 * kernel_plus2(1 - q) : -20 * kernel_plus3(1 - q);
}

HD real kernel_wendland_c4(int dimension, real q)
{
  return dimension == 1
             ? kernel_plus5(1 - q) * (1 + q * (5 + 8 * q))
             : kernel_plus3(1 - q) * kernel_plus3(1 - q) * (1 + q * (6 + (real)(35. / 3) * q));
}

HD real kernel_wendland_c4_dwq(int dimension, real q)
{
  return dimension == 1 ? -14 * kernel_plus4(1 - q) * (1 + 4 * q)
                        : (real)(-56. / 3) * kernel_plus5(1 - q) * (1 + 5 * q);
}

HD real kernel_wendland_c6(int dimension, real q)
{
  return dimension == 1
             ? kernel_plus5(1 - q) * kernel_plus2(1 - q) * (1 + q * (7 + q * (19 + 21 * q)))
             : kernel_plus4(1 - q) * kernel_plus4(1 - q) * (1 + q * (8 + q * (25 + 32 * q)));
}

HD real kernel_wendland_c6_dwq(int dimension, real q)
{
  return dimension == 1 ? -6 * kernel_plus5(1 - q) * kernel_plus(1 - q) * (3 + q * (18 + 35 * q))
                        : -22 * kernel_plus5(1 - q) * kernel_plus2(1 - q) * (1 + q * (7 + 16 * q));
}

/* Spiky: slope -3 at q = 0, so dwq diverges; below q = 1e-10 grad W goes linearly to zero. */
HD real kernel_spiky(int dimension, real q)
{
  (void)dimension;
  return kernel_plus3(1 - q);
}

HD real kernel_spiky_dwq(int dimension, real q)
{
  (void)dimension;
  return -3 * kernel_plus2(1 - q) * real_inverse(kernel_max(q, (real)1e-10));
}

/* kernel_w: w(q), without sigma/h^D. kern is a Kernel, dimension 1, 2 or 3, q >= 0. */
HD real kernel_w(int kern, int dimension, real q)
{
  switch (kern) {
#define KERNEL_CASE(CAPITAL, NAME, ...)                                                            \
  case KERNEL_##CAPITAL: return kernel_##NAME(dimension, q);
    KERNELS(KERNEL_CASE)
#undef KERNEL_CASE
  default: return 0;
  }
}

/* kernel_dwq: (dw/dq)/q <= 0. */
HD real kernel_dwq(int kern, int dimension, real q)
{
  switch (kern) {
#define KERNEL_CASE(CAPITAL, NAME, ...)                                                            \
  case KERNEL_##CAPITAL: return kernel_##NAME##_dwq(dimension, q);
    KERNELS(KERNEL_CASE)
#undef KERNEL_CASE
  default: return 0;
  }
}

/* kernel_dw: dw/dq <= 0. */
HD real kernel_dw(int kern, int dimension, real q) { return kernel_dwq(kern, dimension, q) * q; }

/* kernel_sigma: the norm, such that W integrates to 1 over the line, the plane, space. */
HD double kernel_sigma(int kern, int dimension)
{
  switch (kern) {
#define KERNEL_CASE(CAPITAL, NAME, SIGMA1, SIGMA2, SIGMA3)                                         \
  case KERNEL_##CAPITAL: return dimension == 1 ? SIGMA1 : dimension == 2 ? SIGMA2 : SIGMA3;
    KERNELS(KERNEL_CASE)
#undef KERNEL_CASE
  default: return 0;
  }
}

#endif
