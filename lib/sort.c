/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many: a radix sort from the lowest digit up. Each thread counts the digits of its own stretch,
 * and puts them behind those of lower digits and of the same digit in earlier stretches. Digits
 * that all keys share are left out. Few: qsort. */
#include <stdlib.h>
#include <string.h>
#include <omp.h>
#include "sort.h"

enum { FEW = 4096, BITS = 11, DIGITS = 1 << BITS };

typedef struct {
  uint64_t key;
  long i;
} Item;

static int by_key(const void *a, const void *b)
{
  const Item *s = a, *t = b;
  if (s->key != t->key) return s->key < t->key ? -1 : 1;
  return s->i < t->i ? -1 : 1;
}

/* One digit: from -> to. count [threads][DIGITS]. */
static void pass(long n, const Item *from, Item *to, int shift, long *count, int threads)
{
#pragma omp parallel num_threads(threads)
  {
    const int me = omp_get_thread_num(), team = omp_get_num_threads();
    const long b = n * me / team, e = n * (me + 1) / team;
    long *own = count + (long)me * DIGITS;
    memset(own, 0, DIGITS * sizeof *own);
    for (long k = b; k < e; k++) own[from[k].key >> shift & (DIGITS - 1)]++;
#pragma omp barrier
#pragma omp single
    for (long d = 0, sum = 0; d < DIGITS; d++)
      for (int t = 0; t < team; t++) {
        const long c = count[(long)t * DIGITS + d];
        count[(long)t * DIGITS + d] = sum, sum += c;
      }
    for (long k = b; k < e; k++) to[own[from[k].key >> shift & (DIGITS - 1)]++] = from[k];
  }
}

/* Sorts item [n] with the help of as many more behind them; returns where the result is. */
static Item *radix(long n, Item *item, uint64_t differ, long *count, int threads)
{
  Item *from = item, *to = item + n;
  for (int shift = 0; shift < 64; shift += BITS) {
    if (!(differ >> shift & (DIGITS - 1))) continue;
    pass(n, from, to, shift, count, threads);
    Item *swap = from;
    from = to, to = swap;
  }
  return from;
}

/* key(k) = (value[k] ^ flip), and all bits turned where the sign is set and `real`. */
static uint64_t key_of(uint64_t value, uint64_t flip, int real)
{
  return real && value >> 63 ? ~value : value ^ flip;
}

static int sort(long n, const uint64_t *value, uint64_t flip, int real, long *order)
{
  const int threads = n > FEW ? omp_get_max_threads() : 1;
  uint64_t differ = 0, down = 0;
#pragma omp parallel for reduction(| : differ, down) num_threads(threads)
  for (long k = 0; k < n; k++) {
    const uint64_t key = key_of(value[k], flip, real);
    differ |= key ^ key_of(value[0], flip, real);
    down |= k > 0 && key < key_of(value[k - 1], flip, real);
    order[k] = k;
  }
  if (!down) return 0;
  Item *item = malloc((size_t)(n > FEW ? 2 * n : n) * sizeof *item), *sorted = item;
  long *count = malloc((size_t)threads * DIGITS * sizeof *count);
  if (item && count) {
#pragma omp parallel for num_threads(threads)
    for (long k = 0; k < n; k++) item[k] = (Item){key_of(value[k], flip, real), k};
    if (n > FEW)
      sorted = radix(n, item, differ, count, threads);
    else
      qsort(item, (size_t)n, sizeof *item, by_key);
#pragma omp parallel for num_threads(threads)
    for (long k = 0; k < n; k++) order[k] = sorted[k].i;
  }
  int failed = !item || !count;
  free(item), free(count);
  return failed ? -1 : 0;
}

int sort_keys(long n, const uint64_t *key, long *order) { return sort(n, key, 0, 0, order); }

int sort_ids(long n, const int64_t *id, long *order)
{
  return sort(n, (const uint64_t *)id, (uint64_t)1 << 63, 0, order);
}

int sort_reals(long n, const double *value, long *order)
{
  uint64_t *bits = malloc((size_t)n * sizeof *bits + 1);
  if (!bits) return -1;
  memcpy(bits, value, (size_t)n * sizeof *bits);
  int failed = sort(n, bits, (uint64_t)1 << 63, 1, order);
  free(bits);
  return failed;
}
