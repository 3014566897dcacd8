/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of the particles: root cube, keys, sort, and everything into the new order. The sort
 * looks at as many digits of the keys as the last tree had levels, and two more; particles that
 * agree in these are put in order of key and id afterwards, so the order depends on nothing else.
 * Columns are written to spare memory, two halves in turn, and exchanged with it. */
#include <cub/cub.cuh>
#include "tree.cuh"
extern "C" {
#include "../../lib/rng.h"
}

enum { THREADS = 256, SPAN = 192, SPANS = 512, MOVES = 64, HALVES = 2 };
static __device__ const double FAR = 1e150; /* squares of coordinates must stay finite */

/* A box and the first bad coordinate of each direction, 3 i + d. */
struct Extent {
  double lo[3], hi[3];
  long long bad[3];
};

typedef struct {
  double at[3]; /* where the cube lies, see hilbert_cube */
} Draw;

/* Joins lo, hi and bad of all threads with the same number modulo 3; the first three have it. */
static __device__ void join_extents(double *lo, double *hi, long long *bad)
{
  __shared__ double a[SPAN], b[SPAN];
  __shared__ long long c[SPAN];
  const int t = (int)threadIdx.x;
  a[t] = *lo, b[t] = *hi, c[t] = *bad;
  for (int s = SPAN / 2; s >= 3; s /= 2) {
    __syncthreads();
    if (t < s) a[t] = fmin(a[t], a[t + s]), b[t] = fmax(b[t], b[t + s]), c[t] = min(c[t], c[t + s]);
  }
  __syncthreads();
  *lo = a[t % 3], *hi = b[t % 3], *bad = c[t % 3];
  __syncthreads();
}

/* The last block to finish joins what all have found, makes the root and begins the report. */
static __device__ void make_root(const Extent *part, const double *x, const int64_t *id, Draw draw,
                                 Root *root, Report *report)
{
  const int d = threadIdx.x % 3;
  __shared__ Extent all;
  double lo = FAR, hi = -FAR;
  long long bad = INT64_MAX;
  for (unsigned b = threadIdx.x / 3; b < gridDim.x; b += SPAN / 3) {
    lo = fmin(lo, __ldcg(&part[b].lo[d])), hi = fmax(hi, __ldcg(&part[b].hi[d]));
    bad = min(bad, __ldcg(&part[b].bad[d]));
  }
  join_extents(&lo, &hi, &bad);
  if (threadIdx.x < 3) all.lo[d] = lo, all.hi[d] = hi, all.bad[d] = bad;
  __syncthreads();
  if (threadIdx.x) return;
  hilbert_cube(all.lo, all.hi, draw.at, root->origin, &root->edge);
  bad = min(all.bad[0], min(all.bad[1], all.bad[2]));
  report->id = bad < INT64_MAX ? id[bad / 3] : INT64_MAX;
  report->value = bad < INT64_MAX ? x[bad] : 0;
  report->loose = INT64_MAX, report->rows = 0;
}

/* words: 3 n coordinates; as SPAN is a multiple of 3, a thread sees those of one direction. */
static __global__ void find_root(const double *x, long words, const int64_t *id, Draw draw,
                                 Extent *part, unsigned *ticket, Root *root, Report *report)
{
  __shared__ int last;
  const int d = threadIdx.x % 3;
  double lo = FAR, hi = -FAR;
  long long bad = INT64_MAX;
  for (long w = (long)blockIdx.x * SPAN + threadIdx.x; w < words; w += (long)gridDim.x * SPAN) {
    const double v = x[w];
    if (fabs(v) < FAR)
      lo = fmin(lo, v), hi = fmax(hi, v);
    else
      bad = min(bad, (long long)w);
  }
  join_extents(&lo, &hi, &bad);
  if (threadIdx.x < 3) {
    Extent *p = part + blockIdx.x;
    p->lo[d] = lo, p->hi[d] = hi, p->bad[d] = bad;
    __threadfence();
  }
  __syncthreads();
  if (threadIdx.x == 0) last = atomicInc(ticket, gridDim.x - 1) == gridDim.x - 1;
  __syncthreads();
  if (last) {
    __threadfence();
    make_root(part, x, id, draw, root, report);
  }
}

static __global__ void make_keys(const double *x, long n, const Root *root, uint64_t *key,
                                 uint32_t *from)
{
  const long i = (long)blockIdx.x * THREADS + threadIdx.x;
  const double scale = (1 << HILBERT_LEVELS) / root->edge;
  uint32_t c[3];
  if (i >= n) return;
#pragma unroll
  for (int d = 0; d < 3; d++) c[d] = hilbert_cell(x[3 * i + d], root->origin[d], scale);
#pragma unroll
  for (uint32_t bit = 1u << (HILBERT_LEVELS - 1); bit > 1; bit >>= 1)
#pragma unroll
    for (int d = 0; d < 3; d++) hilbert_turn(bit, d, &c[0], &c[d]);
  key[i] = hilbert_join(c[0], c[1], c[2]);
  from[i] = (uint32_t)i;
}

static __device__ bool comes_before(uint64_t a, uint32_t i, uint64_t b, uint32_t j,
                                    const int64_t *id)
{
  return a != b ? a < b : id[i] < id[j];
}

/* Runs of keys that agree in what was sorted by: each is sorted by key and id by the thread of its
 * first one. Runs are short, or (coincident particles) in order already: Shell's sort. */
static __global__ void sort_ties(uint64_t *key, uint32_t *from, long n, int dropped,
                                 const int64_t *id)
{
  const long i = (long)blockIdx.x * THREADS + threadIdx.x;
  if (i + 1 >= n) return;
  const uint64_t top = key[i] >> dropped;
  if (key[i + 1] >> dropped != top || (i > 0 && key[i - 1] >> dropped == top)) return;
  long e = i + 2, gap = 1;
  while (e < n && key[e] >> dropped == top) e++;
  while (gap < (e - i) / 3) gap = 3 * gap + 1;
  for (; gap > 0; gap /= 3)
    for (long a = i + gap; a < e; a++) {
      const uint64_t k = key[a];
      const uint32_t f = from[a];
      long b = a;
      for (; b - gap >= i && comes_before(k, f, key[b - gap], from[b - gap], id); b -= gap)
        key[b] = key[b - gap], from[b] = from[b - gap];
      key[b] = k, from[b] = f;
    }
}

/* Columns to be moved together; equal sizes stand together. */
typedef struct {
  struct {
    const void *from;
    void *to;
    int bytes;
  } move[MOVES];
  int moves;
} Moves;

/* BATCH columns of WORDS words each; at: where the block's particles come from. */
template <class T, int WORDS, int BATCH>
static __device__ __forceinline__ void gather(const Moves &m, int c, const uint32_t *at, long base,
                                              int count)
{
  T v[BATCH][WORDS] = {};
#pragma unroll
  for (int b = 0; b < BATCH; b++)
#pragma unroll
    for (int w = 0; w < WORDS; w++) {
      const int k = (int)threadIdx.x + w * THREADS;
      if (k < count * WORDS)
        v[b][w] = ((const T *)m.move[c + b].from)[(size_t)at[k / WORDS] * WORDS + k % WORDS];
    }
#pragma unroll
  for (int b = 0; b < BATCH; b++)
#pragma unroll
    for (int w = 0; w < WORDS; w++) {
      const int k = (int)threadIdx.x + w * THREADS;
      if (k < count * WORDS) ((T *)m.move[c + b].to)[base * WORDS + k] = v[b][w];
    }
}

/* Columns of any size, in words of 4 bytes. */
static __device__ void gather_words(const Moves &m, int c, const uint32_t *at, long base, int count)
{
  const int words = m.move[c].bytes / 4;
  for (int k = (int)threadIdx.x; k < count * words; k += THREADS)
    ((uint32_t *)m.move[c].to)[base * words + k] =
        ((const uint32_t *)m.move[c].from)[(size_t)at[k / words] * words + k % words];
}

static __global__ void __launch_bounds__(THREADS)
    permute(const __grid_constant__ Moves m, const uint32_t *from, long n)
{
  __shared__ uint32_t at[THREADS];
  const long base = (long)blockIdx.x * THREADS;
  const int count = (int)min((long)THREADS, n - base);
  if ((int)threadIdx.x < count) at[threadIdx.x] = from[base + threadIdx.x];
  __syncthreads();
  for (int c = 0; c < m.moves; c++) {
    const int bytes = m.move[c].bytes, more = m.moves - c;
    if (bytes == 8 && more > 3 && m.move[c + 3].bytes == 8)
      gather<double, 1, 4>(m, c, at, base, count), c += 3;
    else if (bytes == 8)
      gather<double, 1, 1>(m, c, at, base, count);
    else if (bytes == 24)
      gather<double, 3, 1>(m, c, at, base, count);
    else if (bytes == 48)
      gather<double2, 3, 1>(m, c, at, base, count);
    else
      gather_words(m, c, at, base, count);
  }
}

/* Points x: hi + lo in code units from the root's origin. */
static __global__ void make_points(const __grid_constant__ State s, const Root *root, Units unit,
                                   Points p)
{
  const long i = (long)blockIdx.x * THREADS + threadIdx.x;
  const double il = 1 / unit.length;
  double v[3];
  if (i >= s.n) return;
#pragma unroll
  for (int d = 0; d < 3; d++) v[d] = (s.x[3 * i + d] - root->origin[d]) * il;
  float hi[3], lo[3];
#pragma unroll
  for (int d = 0; d < 3; d++)
    hi[d] = __double2float_rn(v[d]), lo[d] = __double2float_rn(v[d] - (double)hi[d]);
  p.hi[i] = make_float4(hi[0], hi[1], hi[2], __double2float_rn(s.h[i] * il));
  p.lo[i] = make_float4(lo[0], lo[1], lo[2], __double2float_rn(s.m[i] / unit.mass));
}

/* Columns by size, in place: four 8-byte columns in a row move faster. */
static int columns_of(Sim *sim, CudaColumn column[CUDA_COLUMNS])
{
  int all;
  const int n = cuda_columns(sim, column, &all);
  for (int a = 1; a < n; a++) {
    const CudaColumn c = column[a];
    int b = a;
    for (; b > 0 && column[b - 1].width * column[b - 1].size > c.width * c.size; b--)
      column[b] = column[b - 1];
    column[b] = c;
  }
  return n;
}

/* Moves one half of the columns of each size: those that still find a spare. */
static void permute_half(Sim *sim, CudaColumn *column, int columns)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  struct CudaOrder *o = c->order;
  int used[ORDER_SPARES] = {0};
  Moves m;
  m.moves = 0;
  for (int k = 0; k < columns; k++) {
    const int bytes = column[k].width * column[k].size;
    int f = 0;
    while (f < o->spares && (used[f] || o->spare[f].bytes != bytes)) f++;
    if (f == o->spares || !column[k].array || m.moves == MOVES) continue;
    void *old = *column[k].array;
    m.move[m.moves].from = old, m.move[m.moves].to = o->spare[f].at;
    m.move[m.moves++].bytes = bytes;
    *column[k].array = o->spare[f].at, o->spare[f].at = old, used[f] = 1;
    column[k].array = NULL;
  }
  LAUNCH(permute, launch_blocks((size_t)sim->s.n, THREADS), THREADS, 0, c->stream, m, o->from[0],
         sim->s.n);
}

/* Sorts keys and where they come from; what is sorted is then key[0], from[0]. */
static void sort_keys(Cuda *c, long n, const int64_t *id)
{
  CudaError *error = &c->error;
  struct CudaOrder *o = c->order;
  const int dropped = 3 * (HILBERT_LEVELS - o->levels);
  cub::DoubleBuffer<uint64_t> key(o->key[0], o->key[1]);
  cub::DoubleBuffer<uint32_t> from(o->from[0], o->from[1]);
  if (!error->code)
    CHECK(cub::DeviceRadixSort::SortPairs(o->sort, o->sort_bytes, key, from, (int)n, dropped,
                                          3 * HILBERT_LEVELS, c->stream));
  o->key[0] = key.Current(), o->key[1] = key.Alternate();
  o->from[0] = from.Current(), o->from[1] = from.Alternate();
  c->scratch = o->key[1];
  LAUNCH(sort_ties, launch_blocks((size_t)n, THREADS), THREADS, 0, c->stream, o->key[0], o->from[0],
         n, dropped, id);
}

int cuda_order(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  struct CudaOrder *o = c->order;
  const long n = sim->s.n;
  const unsigned blocks = launch_blocks((size_t)n, THREADS);
  unsigned spans = launch_blocks(3 * (size_t)n, 4 * SPAN);
  CudaColumn column[CUDA_COLUMNS];
  const int columns = columns_of(sim, column);
  Draw draw;
  for (uint32_t d = 0; d < 3; d++) draw.at[d] = rng_uniform(hilbert_shift(sim->step), 0, d);
  if (spans > SPANS) spans = SPANS;
  LAUNCH(find_root, spans, SPAN, 0, c->stream, sim->s.x, 3 * n, sim->s.id, draw, o->part, o->ticket,
         c->root, o->report);
  LAUNCH(make_keys, blocks, THREADS, 0, c->stream, sim->s.x, n, c->root, o->key[0], o->from[0]);
  sort_keys(c, n, sim->s.id);
  for (int half = 0; half < HALVES; half++) permute_half(sim, column, columns);
  LAUNCH(make_points, blocks, THREADS, 0, c->stream, sim->s, c->root, c->unit, c->x);
  return launch_failed(error, err);
}

/* Spares: for half of the columns of each size. */
static int open_spares(Sim *sim, Err *err)
{
  struct CudaOrder *o = cuda_of(sim)->order;
  CudaColumn column[CUDA_COLUMNS];
  const int columns = columns_of(sim, column);
  for (int a = 0, b; a < columns; a = b) {
    const int bytes = column[a].width * column[a].size;
    for (b = a; b < columns && column[b].width * column[b].size == bytes;) b++;
    for (int k = 0; k < (b - a + HALVES - 1) / HALVES; k++) {
      Spare *s = o->spare + o->spares++;
      s->bytes = bytes;
      if (cuda_alloc(sim, &s->at, ((size_t)sim->s.n * bytes + 255) / 256 * 256, err)) return -1;
    }
  }
  return 0;
}

size_t cuda_order_bytes(const Sim *sim)
{
  size_t row = 0;
#define ORDER_ROW(TYPE, MEMBER, WIDTH, ...) row += sizeof(TYPE) * (WIDTH);
  ALL_FIELDS(ORDER_ROW)
  MOVED_FIELDS(ORDER_ROW)
#undef ORDER_ROW
  for (int k = 0; k < sim->slots; k++) {
#define ORDER_SLOT(MEMBER, WIDTH) row += sizeof(double) * (WIDTH);
    SAVED_FIELDS(ORDER_SLOT)
#undef ORDER_SLOT
  }
  return (size_t)sim->s.n * (row / HALVES + 2 * (8 + 4)) + (1 << 20);
}

int cuda_order_open(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const size_t n = (size_t)sim->s.n;
  struct CudaOrder *o = (struct CudaOrder *)calloc(1, sizeof *o);
  if (!o) return err_set(err, "not enough memory");
  c->order = o, o->levels = HILBERT_LEVELS;
  cub::DoubleBuffer<uint64_t> key(NULL, NULL);
  cub::DoubleBuffer<uint32_t> from(NULL, NULL);
  if (CHECK(cub::DeviceRadixSort::SortPairs(NULL, o->sort_bytes, key, from, (int)n, 0,
                                            3 * HILBERT_LEVELS, c->stream)) ||
      CHECK(cudaMallocHost((void **)&o->host, sizeof *o->host)))
    return launch_failed(error, err);
  for (int k = 0; k < 2; k++)
    if (cuda_alloc(sim, (void **)&o->key[k], n * 8, err) ||
        cuda_alloc(sim, (void **)&o->from[k], n * 4, err))
      return -1;
  if (cuda_alloc(sim, &o->sort, o->sort_bytes, err) ||
      cuda_alloc(sim, (void **)&o->part, SPANS * sizeof(Extent), err) ||
      cuda_alloc(sim, (void **)&o->ticket, sizeof *o->ticket, err) ||
      cuda_alloc(sim, (void **)&c->root, sizeof *c->root, err) ||
      cuda_alloc(sim, (void **)&o->report, sizeof *o->report, err))
    return -1;
  return open_spares(sim, err);
}

void cuda_order_close(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  struct CudaOrder *o = c->order;
  if (!o) return;
  for (int k = 0; k < 2; k++) cuda_free(o->key[k]), cuda_free(o->from[k]);
  for (int k = 0; k < o->spares; k++) cuda_free(o->spare[k].at);
  cuda_free(o->sort), cuda_free(o->part), cuda_free(o->ticket), cuda_free(o->report);
  cuda_free(c->root), c->root = NULL;
  cudaFreeHost(o->host);
  free(o);
  c->order = NULL;
}
