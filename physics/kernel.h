/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SPH kernels W(r, h) = sigma_D/h^D w(q), q = r/h, w = 0 at q >= 1: h is the radius of the support. D = 1, 2, 3.
 * A kernel is w(q), its slope dw/dq, and three normalisations; a new one: those and one X. The kernel is a literal argument of
 * the pair loops, so that the switch folds away. Normalisations: validation.md B23; each integrates to 1. */
#ifndef KERNEL_H
#define KERNEL_H

#include "hd.h"

#define KERNEL_PI 3.14159265358979323846

/* X(CAPITAL, name, sigma 1D, 2D, 3D) */
/* clang-format off */
#define KERNELS(X) \
  X(CUBIC_SPLINE,   cubic_spline,   4. / 3,   40 / (7 * KERNEL_PI),  8 / KERNEL_PI) \
  X(QUARTIC_SPLINE, quartic_spline, 3125. / 768, 46875 / (2398 * KERNEL_PI), 15625 / (512 * KERNEL_PI)) \
  X(QUINTIC_SPLINE, quintic_spline, 243. / 40, 15309 / (478 * KERNEL_PI), 2187 / (40 * KERNEL_PI)) \
  X(WENDLAND_C2,    wendland_c2,    5. / 4,   7 / KERNEL_PI,         21 / (2 * KERNEL_PI)) \
  X(WENDLAND_C4,    wendland_c4,    3. / 2,   9 / KERNEL_PI,         495 / (32 * KERNEL_PI)) \
  X(WENDLAND_C6,    wendland_c6,    55. / 32, 78 / (7 * KERNEL_PI),  1365 / (64 * KERNEL_PI)) \
  X(SPIKY,          spiky,          2,        10 / KERNEL_PI,        15 / KERNEL_PI)
/* clang-format on */

typedef enum {
#define KERNEL_ENUM(CAPITAL, ...) KERNEL_##CAPITAL,
  KERNELS(KERNEL_ENUM)
#undef KERNEL_ENUM
  KERNEL_COUNT
} Kernel;

/* TO DO by kernel.h's author: kernel_w(kern, q), kernel_dw(kern, q) [w' with respect to q, <= 0], kernel_sigma(kern, dimension) */

#endif
