/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of particles, one rule for host and device: the root cube, and 63-bit keys along a
 * Hilbert curve through its 2^21 cells an edge, by Skilling (2004), AIP Conf. Proc. 707, 381. */
#ifndef HILBERT_H
#define HILBERT_H

#include "../physics/hd.h"

enum { HILBERT_LEVELS = 21 };

/* hilbert_cube: the smallest cube from the lowest corner on that holds the box lo .. hi [m], or one
 * half as long again whose corner is drawn: three numbers in (0, 1), NULL: the smallest. The same
 * bits on every machine. */
HD void hilbert_cube(const double lo[3], const double hi[3], const double draw[3], double origin[3],
                     double *edge)
{
  double e = fmax(fmax(hi[0] - lo[0], hi[1] - lo[1]), hi[2] - lo[2]);
  if (e < 1e-290) e = 1; /* coincident as far as arithmetic goes */
  for (int d = 0; d < 3; d++) origin[d] = draw ? fma(-0.5 * e, draw[d], lo[d]) : lo[d];
  *edge = draw ? 1.5 * e : e;
}

/* hilbert_shift: which cube a run takes at a step. Errors of the tree that stay the same from step
 * to step pull a body as a whole: another cube every few steps keeps them from adding up. */
HD uint64_t hilbert_shift(long step) { return (uint64_t)(step / 4) + 1; }

/* hilbert_cell: the cell of coordinate x along one edge; scale: 2^21 over the edge. */
HD uint32_t hilbert_cell(double x, double origin, double scale)
{
  const double last = (1 << HILBERT_LEVELS) - 1, s = (x - origin) * scale;
  return (uint32_t)(int32_t)(s < last ? (s > 0 ? s : 0) : last);
}

/* hilbert_turn: undoes, for one bit of coordinate d, the turns of the curve below it; first:
 * coordinate 0, own: coordinate d, the same when d is 0. */
HD void hilbert_turn(uint32_t bit, int d, uint32_t *first, uint32_t *own)
{
  uint32_t set = *own & bit ? bit - 1 : 0, t = (*first ^ *own) & (bit - 1) & ~set;
  *own ^= t;
  *first ^= (d ? t : 0) | set;
}

HD uint64_t hilbert_spread(uint64_t v) /* puts two zeros between the 21 bits */
{
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

/* hilbert_join: the key of three cells after all turns, from bit 20 down to bit 1, 0, 1, 2 each. */
HD uint64_t hilbert_join(uint32_t a, uint32_t b, uint32_t c)
{
  uint32_t t;
  b ^= a, c ^= b, t = c;
  for (int s = 1; s < 32; s *= 2) t ^= t >> s;
  t >>= 1;
  return hilbert_spread(a ^ t) << 2 | hilbert_spread(b ^ t) << 1 | hilbert_spread(c ^ t);
}

#endif
