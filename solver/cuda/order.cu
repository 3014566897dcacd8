/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of the particles: root cube, keys, sort, and everything into the new order. The sort
 * looks at as many digits of the keys as the last tree had levels, at one more, and at what its
 * last pass takes besides; particles that agree in these are put in order of key and id afterwards,
 * so the order depends on nothing else. Columns are written to spare memory and exchanged with it.
 * Arrays whose content nobody needs any more are spare; there are others for what these cannot take
 * in one turn or, where memory is not ample, in two. What is known of the new order is noted:
 * points, and groups that the search should take first. */
#include <cub/cub.cuh>
#include "tree.cuh"
extern "C" {
#include "../../lib/rng.h"
}

enum {
  THREADS = 256,
  SPAN = 192,
  SPANS = 512,
  MOVES = 64,
  SORT_BITS = 8 /* a pass */,
  SCATTERED = 6 /* jumps */
};
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
  report->loose = INT64_MAX, report->rows = 0, report->scattered = 0;
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

/* split: the first image, which come after all particles; 0: none. */
static __global__ void make_keys(const double *x, long n, long split, const Root *root,
                                 uint64_t *key, uint32_t *from)
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
  const uint64_t k = hilbert_join(c[0], c[1], c[2]);
  key[i] = split ? k >> 3 | (uint64_t)(i >= split) << 3 * (HILBERT_LEVELS - 1) : k;
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

/* What is looked at once all has been moved, and what comes of it. */
typedef struct {
  const double *x, *h, *m; /* x NULL: there is more to move */
  const Root *root;
  Units unit;
  Points to; /* hi NULL: nobody needs them */
  Report *report;
  int *first;
  char *is_first;
  int most;
} Moved;

/* The point of particle i: hi + lo in code units from the root's origin. */
static __device__ __forceinline__ void make_point(const Moved &p, long i)
{
  const double il = 1 / p.unit.length;
  float hi[3], lo[3];
#pragma unroll
  for (int d = 0; d < 3; d++) {
    const double v = (p.x[3 * i + d] - p.root->origin[d]) * il;
    hi[d] = __double2float_rn(v), lo[d] = __double2float_rn(v - (double)hi[d]);
  }
  p.to.hi[i] = make_float4(hi[0], hi[1], hi[2], __double2float_rn(p.h[i] * il));
  p.to.lo[i] = make_float4(lo[0], lo[1], lo[2], __double2float_rn(p.m[i] / p.unit.mass));
}

/* Puts groups whose particles lie in many places, as debris does, on the list of those to be
 * searched first. */
static __device__ __forceinline__ void find_scattered(const Moved &p, long i, bool on)
{
  const int lane = (int)threadIdx.x % 32;
  const double h = on ? p.h[i] : 0, reach = h + __shfl_up_sync(~0u, h, 1);
  double r2 = 0;
#pragma unroll
  for (int d = 0; d < 3; d++) {
    const double x = on ? p.x[3 * i + d] : 0, r = x - __shfl_up_sync(~0u, x, 1);
    r2 += r * r;
  }
  const unsigned jumps = __ballot_sync(~0u, on && lane > 0 && r2 > reach * reach);
  if (lane > 0 || !on) return;
  const long group = i / CUDA_GROUP;
  const int at = __popc(jumps) < SCATTERED ? p.most : atomicAdd(&p.report->scattered, 1);
  p.is_first[group] = at < p.most;
  if (at < p.most) p.first[at] = (int)group;
}

static __global__ void __launch_bounds__(THREADS)
    permute(const __grid_constant__ Moves m, const __grid_constant__ Moved p, const uint32_t *from,
            long n)
{
  __shared__ uint32_t at[THREADS];
  const long base = (long)blockIdx.x * THREADS;
  const int count = (int)min((long)THREADS, n - base), t = (int)threadIdx.x;
  if (t < count) at[t] = from[base + t];
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
  if (!p.x) return;
  __syncthreads();
  find_scattered(p, base + t, t < count);
  if (p.to.hi && t < count) make_point(p, base + t);
}

static int bytes_of(const CudaColumn *c) { return c->width * c->size; }

/* Columns by size, in place: four 8-byte columns in a row move faster. */
static int columns_of(Sim *sim, CudaColumn column[CUDA_COLUMNS], int *all)
{
  const int n = cuda_columns(sim, column, all);
  for (int a = 1; a < n; a++) {
    const CudaColumn c = column[a];
    int b = a;
    for (; b > 0 && bytes_of(column + b - 1) > bytes_of(&c); b--) column[b] = column[b - 1];
    column[b] = c;
  }
  return n;
}

/* Where memory of that many bytes a particle has its pointer: an array that is free or a spare that
 * has not been used in this turn; NULL: nowhere. */
static void **spare_of(struct CudaOrder *o, const CudaColumn *idle, int idles, char *used,
                       int bytes)
{
  for (int k = 0; k < idles + o->spares; k++) {
    const int size = k < idles ? bytes_of(idle + k) : o->spare[k - idles].bytes;
    if (used[k] || size != bytes) continue;
    used[k] = 1;
    return k < idles ? idle[k].array : &o->spare[k - idles].at;
  }
  return NULL;
}

/* Moves the columns that find a spare and takes them off the list; returns how many are left. The
 * last turn makes points. */
static int permute_some(Sim *sim, CudaColumn *column, int columns, const CudaColumn *idle,
                        int idles)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  char used[2 * CUDA_COLUMNS] = {0};
  struct CudaOrder *o = c->order;
  Moved p = {NULL,         NULL,      NULL,     c->root,     c->unit,
             {NULL, NULL}, o->report, o->first, o->is_first, order_first(sim->s.n)};
  Moves m;
  int left = 0;
  m.moves = 0;
  for (int k = 0; k < columns; k++) {
    const int bytes = bytes_of(column + k);
    void **spare = m.moves < MOVES ? spare_of(o, idle, idles, used, bytes) : NULL;
    if (!spare) {
      column[left++] = column[k];
      continue;
    }
    void *old = *column[k].array;
    m.move[m.moves].from = old, m.move[m.moves].to = *spare;
    m.move[m.moves++].bytes = bytes;
    *column[k].array = *spare, *spare = old;
  }
  if (!left) p.x = sim->s.x, p.h = sim->s.h, p.m = sim->s.m;
  if (!left && sim->pull_due) p.to = c->x;
  LAUNCH(permute, launch_blocks((size_t)sim->s.n, THREADS), THREADS, 0, c->stream, m, p, o->from[0],
         sim->s.n);
  return left;
}

/* Sorts keys and where they come from; what is sorted is then key[0], from[0]. */
static void sort_keys(Cuda *c, long n, const int64_t *id)
{
  CudaError *error = &c->error;
  struct CudaOrder *o = c->order;
  const int bits = (3 * (o->levels + 1) + SORT_BITS - 1) / SORT_BITS * SORT_BITS,
            dropped = 3 * HILBERT_LEVELS - min(bits, 3 * (int)HILBERT_LEVELS);
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
  if (cuda_images_find(sim, err)) return -1;
  struct CudaOrder *o = c->order; /* more images than before may have made another one */
  const long n = sim->s.all;
  const unsigned blocks = launch_blocks((size_t)n, THREADS);
  unsigned spans = launch_blocks(3 * (size_t)n, 4 * SPAN);
  CudaColumn column[CUDA_COLUMNS];
  int all, columns = columns_of(sim, column, &all);
  const int moved = columns;
  Draw draw;
  for (uint32_t d = 0; d < 3; d++) draw.at[d] = rng_uniform(hilbert_shift(sim->step), 0, d);
  if (spans > SPANS) spans = SPANS;
  LAUNCH(find_root, spans, SPAN, 0, c->stream, sim->s.x, 3 * n, sim->s.id, draw, o->part, o->ticket,
         c->root, o->report);
  LAUNCH(make_keys, blocks, THREADS, 0, c->stream, sim->s.x, n, n > sim->s.n ? sim->s.n : 0,
         c->root, o->key[0], o->from[0]);
  sort_keys(c, n, sim->s.id);
  while (columns > 0) columns = permute_some(sim, column, columns, column + moved, all - moved);
  cuda_images_order(sim);
  return launch_failed(error, err);
}

static __global__ void count_leaving(const State s, const __grid_constant__ Leave test, int *count)
{
  const long i = (long)blockIdx.x * THREADS + threadIdx.x;
  if (i < s.n && leave_where(&test, &s, i) != LEAVE_STAYS) atomicAdd(count, 1);
}

int cuda_leaving(Sim *sim, const Leave *test, long *count, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  int *leaving = (int *)c->scratch, host = 0;
  CHECK(cudaMemsetAsync(leaving, 0, sizeof *leaving, c->stream));
  LAUNCH(count_leaving, launch_blocks((size_t)sim->s.n, THREADS), THREADS, 0, c->stream, sim->s,
         *test, leaving);
  if (cuda_copy(sim, &host, leaving, sizeof host, err)) return -1;
  *count = host;
  return 0;
}

/* As into a new order, that of the particles kept. */
int cuda_keep(Sim *sim, const uint32_t *kept, long n, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaColumn column[CUDA_COLUMNS];
  int all, columns = columns_of(sim, column, &all);
  const int moved = columns;
  if (cuda_copy(sim, c->order->from[0], kept, (size_t)n * sizeof *kept, err)) return -1;
  sim->s.n = sim->s.all = n;
  while (columns > 0) columns = permute_some(sim, column, columns, column + moved, all - moved);
  return launch_failed(&c->error, err);
}

/* The spares of this run by their sizes: what arrays that are free cannot take. */
static int spares_of(Sim *sim, int bytes[CUDA_COLUMNS])
{
  CudaColumn column[CUDA_COLUMNS];
  int all, spares = 0;
  const int columns = columns_of(sim, column, &all), turns = cuda_of(sim)->ample ? 1 : 2;
  for (int a = 0, b; a < columns; a = b) {
    const int size = bytes_of(column + a);
    for (b = a; b < columns && bytes_of(column + b) == size;) b++;
    int lack = (b - a + turns - 1) / turns;
    for (int k = columns; k < all; k++) lack -= bytes_of(column + k) == size;
    for (; lack > 0; lack--) bytes[spares++] = size;
  }
  return spares;
}

static size_t sort_bytes(Sim *sim)
{
  cub::DoubleBuffer<uint64_t> key(NULL, NULL);
  cub::DoubleBuffer<uint32_t> from(NULL, NULL);
  CudaError *error = &cuda_of(sim)->error;
  size_t bytes = 0;
  CHECK(cub::DeviceRadixSort::SortPairs(NULL, bytes, key, from, (int)sim->s.room, 0,
                                        3 * HILBERT_LEVELS, cuda_of(sim)->stream));
  return bytes;
}

size_t cuda_order_bytes(Sim *sim)
{
  int bytes[CUDA_COLUMNS];
  size_t row = 2 * (sizeof(uint64_t) + sizeof(uint32_t));
  for (int k = spares_of(sim, bytes); k-- > 0;) row += (size_t)bytes[k];
  return (size_t)sim->s.room * row + sort_bytes(sim) + SPANS * sizeof(Extent) +
         (size_t)order_first(sim->s.n) * sizeof(int) + (size_t)sim->s.n / CUDA_GROUP;
}

int cuda_order_open(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const size_t n = (size_t)sim->s.room;
  struct CudaOrder *o = (struct CudaOrder *)calloc(1, sizeof *o);
  int bytes[CUDA_COLUMNS];
  if (!o) return err_set(err, "not enough memory");
  c->order = o, o->levels = HILBERT_LEVELS, o->sort_bytes = sort_bytes(sim);
  CHECK(cudaMallocHost((void **)&o->host, sizeof *o->host));
  if (launch_failed(error, err)) return -1;
  for (int k = 0; k < 2; k++)
    if (cuda_alloc(sim, (void **)&o->key[k], n * 8, err) ||
        cuda_alloc(sim, (void **)&o->from[k], n * 4, err))
      return -1;
  if (cuda_alloc(sim, &o->sort, o->sort_bytes, err) ||
      cuda_alloc(sim, (void **)&o->part, SPANS * sizeof(Extent), err) ||
      cuda_alloc(sim, (void **)&o->ticket, sizeof *o->ticket, err) ||
      cuda_alloc(sim, (void **)&c->root, sizeof *c->root, err) ||
      cuda_alloc(sim, (void **)&o->report, sizeof *o->report, err) ||
      cuda_alloc(sim, (void **)&o->first, (size_t)order_first(sim->s.n) * sizeof *o->first, err) ||
      cuda_alloc(sim, (void **)&o->is_first, n / CUDA_GROUP + 1, err))
    return -1;
  const int spares = spares_of(sim, bytes);
  for (; o->spares < spares; o->spares++) {
    Spare *s = o->spare + o->spares;
    s->bytes = bytes[o->spares];
    if (cuda_alloc(sim, &s->at, n * (size_t)s->bytes, err)) return -1;
  }
  return 0;
}

void cuda_order_close(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  struct CudaOrder *o = c->order;
  if (!o) return;
  for (int k = 0; k < 2; k++) cuda_free(o->key[k]), cuda_free(o->from[k]);
  for (int k = 0; k < o->spares; k++) cuda_free(o->spare[k].at);
  cuda_free(o->sort), cuda_free(o->part), cuda_free(o->ticket), cuda_free(o->report);
  cuda_free(o->first), cuda_free(o->is_first);
  cuda_free(c->root), c->root = NULL;
  cudaFreeHost(o->host);
  free(o);
  c->order = NULL;
}
