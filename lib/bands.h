/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Things that cover rows of a picture or grid, sorted into bands of rows, so that threads work on
 * bands of their own and each looks only at what is there. */
#ifndef BANDS_H
#define BANDS_H

#include <stdint.h>
#include "err.h"

typedef struct {
  int bands, height; /* rows a band */
  int64_t *start;    /* [bands + 1] */
  uint32_t *list;    /* things of band b, ascending: list[start[b] .. start[b+1]-1] */
} Bands;

/* bands_new: span says the first and last row of thing k, k < n, which may lie outside of
 * 0..rows-1. Returns 0, or -1 without memory. bands_free releases it. */
int bands_new(Bands *b, long n, int rows, int height,
              void (*span)(const void *things, long k, float *first, float *last),
              const void *things, Err *err);
void bands_free(Bands *b);

#endif
