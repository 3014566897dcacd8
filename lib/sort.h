/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sorted orders of many numbers: particle ids, distances, keys along a curve. Stable and parallel;
 * the result does not depend on the number of threads. What is sorted already costs one pass. */
#ifndef SORT_H
#define SORT_H

#include <stdint.h>

/* sort_keys: order [n] such that key[order[k]] ascends; equal keys stay in their order. Returns 0,
 * or -1 without memory. */
int sort_keys(long n, const uint64_t *key, long *order);

/* sort_ids, sort_reals: the same for signed numbers, and for real ones (no NaN; -0 before 0). */
int sort_ids(long n, const int64_t *id, long *order);
int sort_reals(long n, const double *value, long *order);

#endif
