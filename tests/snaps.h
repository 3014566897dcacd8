/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles for the tests of snapshots. */
#ifndef SNAPS_H
#define SNAPS_H

#include <stdint.h>
#include "folder.h"
#include "lib/snap.h"

/* snaps_fill: any bits, but no NaN: they are compared as bytes, and by others as numbers. */
static inline void snaps_fill(void *array, size_t size, uint64_t *seed)
{
  unsigned char *byte = array;
  for (size_t i = 0; i < size; i++) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u; /* Knuth, MMIX */
    byte[i] = i % 8 == 7 ? 0x3f : (unsigned char)(*seed >> 56);
  }
}

/* snaps_bare: n particles of mass 1, ids from 0, all else zero. */
static inline Parts *snaps_bare(long n)
{
  Err err;
  Parts *p = part_new(n);
  part_add(p, "id x v m rho u", &err);
  for (long i = 0; i < n; i++) p->id[i] = i, p->m[i] = 1;
  return p;
}

#endif
