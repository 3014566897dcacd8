/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pair loops in single precision. A vector is kept as two floats a component, hi + lo: the
 * difference of two is exact to 2^-48 of what they are, as if taken in double, and changes sign
 * exactly with the pair. */
#define REAL float
#include "loops.h"

typedef float4 Quad;
typedef Points Places;
typedef struct {
  float x, y, z, lx, ly, lz;
} Place;
enum { PLACE_BYTES = 2 * sizeof(float4) };

static __device__ void quad_set(float4 *q, long i, double x, double y, double z, double w)
{
  q[i] = make_float4((float)x, (float)y, (float)z, (float)w);
}

static __device__ float4 quad_get(const float4 *q, long i) { return __ldg(q + i); }

static __device__ void place_set(Points p, long i, double x, double y, double z, float h, float w)
{
  const float hx = __double2float_rn(x), hy = __double2float_rn(y), hz = __double2float_rn(z);
  p.hi[i] = make_float4(hx, hy, hz, h);
  p.lo[i] = make_float4((float)(x - hx), (float)(y - hy), (float)(z - hz), w);
}

static __device__ Place place_get(Points p, long i, float *h, float *w)
{
  const float4 a = __ldg(p.hi + i), b = __ldg(p.lo + i);
  const Place o = {a.x, a.y, a.z, b.x, b.y, b.z};
  *h = a.w, *w = b.w;
  return o;
}

static __device__ PairVector place_between(Place a, Place b)
{
  const PairVector r = {(a.x - b.x) + (a.lx - b.lx), (a.y - b.y) + (a.ly - b.ly),
                        (a.z - b.z) + (a.lz - b.lz)};
  return r;
}

static Points places_at(void *room, size_t n)
{
  const Points p = {(float4 *)room, (float4 *)room + n};
  return p;
}

#include "loops.cuh"

const LoopsOf loops_mixed = {bytes, loops_open, loops_close, gradient, density, force};
