/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What order.cu, tree.cu and search.cu share: the sorted keys, what a search adds to the tree, and
 * the report that the host reads once a search. */
#ifndef TREE_CUH
#define TREE_CUH

#include "cuda.h"
#include "../../lib/hilbert.h"
extern "C" {
#include "../../lib/tree.h"
}

/* What went wrong, and sizes. */
typedef struct {
  int64_t id;      /* of the first particle out of range, or INT64_MAX */
  double value;    /* its coordinate [m] */
  long long loose; /* smallest id with a y, h or ha that is not finite, or INT64_MAX */
  int nodes, deepest;
  int scattered;           /* groups that would be searched first, were there room for all */
  unsigned long long rows; /* taken in the lists: 32 entries each */
} Report;

/* Memory that a column's next order is written to; then the two are exchanged. */
typedef struct {
  void *at;
  int bytes; /* a particle */
} Spare;

struct CudaOrder {
  uint64_t *key[2]; /* [n] key[0]: sorted */
  uint32_t *from[2];
  int levels; /* of the last tree; CUDA_LEVELS: there was none */
  void *sort;
  size_t sort_bytes;
  struct Extent *part;
  unsigned *ticket;
  Report *report, *host; /* on the device, in pinned memory */
  Spare spare[CUDA_COLUMNS];
  int spares;
  int *first; /* [order_first] groups whose particles lie scattered: they take longest to search */
  char *is_first; /* [groups] */
};

/* order_first: how many groups may be searched before the others. */
static inline int order_first(long n) { return (int)(n / CUDA_GROUP / 8 + 1); }

/* A pair can interact at x or at y only when |x_i - x_j| < s_i + s_j + |D_i - D_j|, with s the
 * larger of h/2 and ha/2 + |y - x - D|, and D the mean of y - x in the leaf. */
struct CudaTree {
  int *parent, *arrived; /* [room] */
  float4 *drift;         /* [room] D; w: the largest s + |D_leaf - D| below */
  int4 *place;           /* [n] x in units of edge/2^31; w: s as a float, code units */
  int *count, *base;     /* [levels x blocks] nodes that begin in a block */
  void *scan;
  size_t scan_bytes;
};

enum { PLACE_BITS = 31 };
#define PLACE_CELL (1. / ((int64_t)1 << PLACE_BITS))

/* tree_common: digits that two keys share from the left. */
static __device__ __forceinline__ int tree_common(uint64_t a, uint64_t b)
{
  return a == b ? (int)CUDA_LEVELS : (__clzll((long long)(a ^ b)) - 1) / 3;
}

/* cuda_tree_grow: room for that many nodes. */
int cuda_tree_grow(Sim *sim, long nodes, Err *err);

#endif
