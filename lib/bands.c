/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A counting sort: how many in each band, where each band begins, then the list. */
#include <math.h>
#include <stdlib.h>
#include "bands.h"

/* Bands of thing k; 0: none. */
static int within(const Bands *b, int rows, float first, float last, int *from, int *to)
{
  if (!(last >= 0 && first <= (float)(rows - 1) && first <= last)) return 0;
  *from = (int)fmaxf(0, first) / b->height;
  *to = (int)fminf((float)rows - 1, last) / b->height;
  return 1;
}

int bands_new(Bands *b, long n, int rows, int height,
              void (*span)(const void *things, long k, float *first, float *last),
              const void *things, Err *err)
{
  *b = (Bands){(rows + height - 1) / height, height, NULL, NULL};
  b->start = calloc((size_t)b->bands + 2, sizeof *b->start);
  for (int fill = 0; fill < 2 && b->start; fill++) {
    for (long k = 0; k < n; k++) {
      float first, last;
      int from, to;
      span(things, k, &first, &last);
      if (!within(b, rows, first, last, &from, &to)) continue;
      for (int j = from; j <= to; j++)
        if (fill)
          b->list[b->start[j + 1]++] = (uint32_t)k;
        else
          b->start[j + 2]++;
    }
    for (int j = 0; j < b->bands && !fill; j++) b->start[j + 2] += b->start[j + 1];
    if (!fill) b->list = malloc((size_t)(b->start[b->bands + 1] + 1) * sizeof *b->list);
    if (!b->list) break;
  }
  if (b->list) return 0;
  bands_free(b);
  return err_set(err, "out of memory for %ld particles", n);
}

void bands_free(Bands *b)
{
  free(b->start), free(b->list);
  b->start = NULL, b->list = NULL;
}
