/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The language of physics/: one source for gcc, clang and nvcc. The only file that knows the
 * compiler. HD marks a function that runs on host and device; everything in physics/ is HD, without
 * globals, I/O or malloc. */
#ifndef HD_H
#define HD_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __CUDACC__
#define HD       static __host__ __device__ __forceinline__
#define RESTRICT __restrict__
#else
#define HD       static inline __attribute__((always_inline, unused))
#define RESTRICT restrict
#endif

/* The type of pair arithmetic (kernel.h, viscosity.h, pair.h): double, unless the including file
 * says otherwise. Literals there are exact as floats or cast, so that nothing widens by itself. */
#ifndef REAL
#define REAL double
#endif
typedef REAL real;

#endif
