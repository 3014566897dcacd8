/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pair loops in double precision. */
#include "loops.h"

typedef struct __align__(16) { double x, y, z, w; }
Quad; /* double4 is deprecated in CUDA 13 and its heirs are missing in 12 */
typedef struct {
  Quad *at; /* w: h */
  double *w;
} Places;
typedef PairVector Place;
enum { PLACE_BYTES = sizeof(Quad) + sizeof(double) };

/* A gather costs what it touches of lines of 128 bytes. So one line has the first halves of eight
 * quads, the next their second halves: a load of 16 bytes from each of the lanes then touches a
 * quarter fewer than in an array of quads. */
static __device__ long quad_half(long i) { return i + (i & ~7L); }

static __device__ void quad_set(Quad *q, long i, double x, double y, double z, double w)
{
  double2 *to = (double2 *)q + quad_half(i);
  to[0] = make_double2(x, y), to[8] = make_double2(z, w);
}

static __device__ Quad quad_get(const Quad *q, long i)
{
  const double2 *at = (const double2 *)q + quad_half(i), a = __ldg(at), b = __ldg(at + 8);
  const Quad o = {a.x, a.y, b.x, b.y};
  return o;
}

static __device__ void place_set(Places p, long i, double x, double y, double z, double h, double w)
{
  quad_set(p.at, i, x, y, z, h);
  p.w[i] = w;
}

static __device__ Place place_get(Places p, long i, double *h, double *w)
{
  const Quad a = quad_get(p.at, i);
  const Place o = {a.x, a.y, a.z};
  *h = a.w, *w = __ldg(p.w + i);
  return o;
}

static __device__ PairVector place_between(Place a, Place b)
{
  const PairVector r = {a.x - b.x, a.y - b.y, a.z - b.z};
  return r;
}

static Places places_at(void *room, size_t n)
{
  const Places p = {(Quad *)room, (double *)((Quad *)room + n)};
  return p;
}

#include "loops.cuh"

const LoopsOf loops_double = {bytes, loops_open, loops_close, gradient, density, force};
