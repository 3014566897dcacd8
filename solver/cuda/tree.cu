/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The octree of sorted keys, without locks: the leaf of a particle is one level below the deepest
 * cell that holds it and TREE_BUCKET others, which are neighbours in the order; so each particle
 * knows by itself which nodes begin with it. Their numbers, counted by level and block and added
 * up, give every node its place. Moments go up from the leaves, above these by eight threads a
 * node: whoever finishes the last child does the parent, and adds the children in their order.
 * Masses and what follows from them (poles) are for gravity: there only when it walks the tree. */
#include <cub/cub.cuh>
#include "tree.cuh"

enum { THREADS = 256, WARPS = THREADS / 32, FAMILY = 8, HANDS = 4, ROWS = CUDA_LEVELS + 1 };
static const unsigned ALL = ~0u;
static __device__ const float NOWHERE = 1e38f;

/* Everything that the kernels read and write. */
typedef struct {
  State s;
  double length, il, im; /* code unit [m]; 1/length, 1/mass */
  const Root *root;
  const uint64_t *key;
  DeviceTree t;
  struct CudaTree b;
  Report *report;
  int blocks;
} Build;

/* How many digits each particle shares with the one before it (-1: the first particle), and the
 * level of its leaf; a node of level l begins with it when x < l <= y. */
static __device__ char2 span_of(const uint64_t *key, long n, long base)
{
  enum { HALO = TREE_BUCKET };
  __shared__ uint64_t k[THREADS + 2 * HALO];
  __shared__ signed char c[THREADS + HALO];
  for (int t = (int)threadIdx.x; t < THREADS + 2 * HALO; t += THREADS) {
    const long i = base - HALO + t;
    k[t] = i >= 0 && i < n ? key[i] : 0;
  }
  __syncthreads();
  for (int t = (int)threadIdx.x; t < THREADS + HALO; t += THREADS) {
    const long i = base - HALO + t; /* the particles i .. i + TREE_BUCKET */
    c[t] = i >= 0 && i + TREE_BUCKET < n ? tree_common(k[t], k[t + HALO]) : -1;
  }
  __syncthreads();
  const int t = (int)threadIdx.x;
  int level = -1, before = t + base ? tree_common(k[t + HALO - 1], k[t + HALO]) : -1;
#pragma unroll
  for (int w = 0; w <= HALO; w++) level = max(level, (int)c[t + w]);
  if (base + t >= n) return make_char2(CUDA_LEVELS, 0);
  return make_char2((signed char)before, (signed char)min(level + 1, (int)CUDA_LEVELS));
}

static __global__ void __launch_bounds__(THREADS) count_nodes(const __grid_constant__ Build a)
{
  __shared__ int sum[WARPS][ROWS];
  const long base = (long)blockIdx.x * THREADS, i = base + threadIdx.x;
  const char2 span = span_of(a.key, a.s.n, base);
  const int lane = threadIdx.x % 32, warp = threadIdx.x / 32;
  if (i < a.s.n) a.t.span[i] = span;
  int mine = 0;
  for (int l = 0; l < ROWS; l++) {
    const unsigned begin = __ballot_sync(ALL, span.x < l && l <= span.y);
    if (l == lane) mine = __popc(begin);
  }
  if (lane < ROWS) sum[warp][lane] = mine;
  __syncthreads();
  if (threadIdx.x >= ROWS) return;
  int all = 0;
  for (int w = 0; w < WARPS; w++) all += sum[w][threadIdx.x];
  a.b.count[threadIdx.x * a.blocks + blockIdx.x] = all;
  if (blockIdx.x == 0 && threadIdx.x == 0) a.b.count[ROWS * a.blocks] = 0;
}

/* One past the last particle that shares `level` digits with particle i. */
static __device__ long end_of(const uint64_t *key, long n, long i, int level)
{
  const uint64_t top = key[i] | (((uint64_t)1 << 3 * (CUDA_LEVELS - level)) - 1);
  long step = 1;
  for (; i + step < n && key[i + step] <= top; step *= 2) i += step;
  for (; step; step /= 2)
    if (i + step < n && key[i + step] <= top) i += step;
  return i + 1;
}

static __device__ void report_nodes(const Build &a)
{
  int deepest = 0;
  for (int l = 0; l <= ROWS; l++) {
    a.t.level[l] = a.b.base[l * a.blocks];
    if (l && a.t.level[l] > a.t.level[l - 1]) deepest = l - 1;
  }
  a.report->nodes = a.t.level[ROWS], a.report->deepest = deepest;
}

/* Writes the nodes that begin with each particle, with their parents. */
static __global__ void __launch_bounds__(THREADS) make_nodes(const __grid_constant__ Build a)
{
  __shared__ int place[WARPS][ROWS];
  const long i = (long)blockIdx.x * THREADS + threadIdx.x;
  const int lane = threadIdx.x % 32, warp = threadIdx.x / 32;
  const char2 span = i < a.s.n ? a.t.span[i] : make_char2(CUDA_LEVELS, 0);
  int mine = 0, parent = -1;
  for (int l = 0; l < ROWS; l++) {
    const unsigned begin = __ballot_sync(ALL, span.x < l && l <= span.y);
    if (l == lane) mine = __popc(begin);
  }
  if (lane < ROWS) place[warp][lane] = mine;
  __syncthreads();
  if (threadIdx.x < ROWS) {
    int at = a.b.base[threadIdx.x * a.blocks + blockIdx.x];
    for (int w = 0; w < WARPS; w++) {
      const int more = place[w][threadIdx.x];
      place[w][threadIdx.x] = at, at += more;
    }
  }
  __syncthreads();
  for (int l = 0; l < ROWS; l++) {
    const int begins = span.x < l && l <= span.y;
    const unsigned begin = __ballot_sync(ALL, begins);
    const int me = place[warp][l] + __popc(begin & ((1u << lane) - 1));
    if (l == span.x) parent = me - 1; /* the node of this level that began before and goes on */
    if (!begins || me >= a.t.room) continue;
    a.b.parent[me] = parent, a.b.arrived[me] = 0;
    if (l > span.x + 1) a.t.link[parent] = make_int4(me, -1, (int)i, 0);
    if (l == span.y) a.t.link[me] = make_int4(0, 0, (int)i, (int)(end_of(a.key, a.s.n, i, l) - i));
    parent = me;
  }
  if (i == 0) report_nodes(a);
}

/* Over the LANES threads of a node; all get the same bits. */
template <int LANES, class T> static __device__ __forceinline__ T add(T v)
{
#pragma unroll
  for (int k = LANES / 2; k; k /= 2) v += __shfl_xor_sync(ALL, v, k);
  return v;
}
template <int LANES> static __device__ __forceinline__ float least(float v)
{
#pragma unroll
  for (int k = LANES / 2; k; k /= 2) v = fminf(v, __shfl_xor_sync(ALL, v, k));
  return v;
}
template <int LANES> static __device__ __forceinline__ float most(float v)
{
  return -least<LANES>(-v);
}

/* What goes up. */
typedef struct {
  double m, com[3], q[6], trace; /* SI */
  float lo[3], hi[3], h;         /* code units; h_max */
  float drift[3], reach;
  int count;
} Up;

/* POLES, a literal: whether masses count, and whether traces do. */
enum { POLES_NONE, POLES_NEWTON, POLES_PLUMMER };

static __device__ __forceinline__ double square3(double x, double y, double z)
{
  return x * x + y * y + z * z;
}

/* Adds m (3 r r - r^2 1). */
static __device__ __forceinline__ void add_quadrupole(double q[6], double m, double x, double y,
                                                      double z)
{
  const double r2 = square3(x, y, z);
  q[0] += m * (3 * x * x - r2), q[1] += m * 3 * x * y, q[2] += m * 3 * x * z;
  q[3] += m * (3 * y * y - r2), q[4] += m * 3 * y * z, q[5] += m * (3 * z * z - r2);
}

/* Mass, centre and box of all from those of the threads; sum: of m x. */
template <int LANES, int POLES>
static __device__ __forceinline__ void join(const Build &a, Up *u, double sum[3])
{
  u->h = most<LANES>(u->h), u->count = add<LANES>(u->count);
  if (POLES) u->m = add<LANES>(u->m);
#pragma unroll
  for (int d = 0; d < 3; d++) {
    u->lo[d] = least<LANES>(u->lo[d]), u->hi[d] = most<LANES>(u->hi[d]);
    if (!POLES) continue;
    sum[d] = add<LANES>(sum[d]);
    u->com[d] = u->m > 0 ? sum[d] / u->m
                         : a.root->origin[d] + 0.5 * ((double)u->lo[d] + u->hi[d]) * a.length;
  }
}

static __device__ __forceinline__ float size3(float x, float y, float z)
{
  return sqrtf(x * x + y * y + z * z);
}

/* y - x of particle i in code units. */
static __device__ __forceinline__ void drift_of(const Build &a, long i, float out[3])
{
#pragma unroll
  for (int d = 0; d < 3; d++) out[d] = (float)((a.s.y[3 * i + d] - a.s.x[3 * i + d]) * a.il);
}

static __device__ __forceinline__ int fixed(double x, double origin, double cells)
{
  const double v = (x - origin) * cells, last = 1 / PLACE_CELL - 1;
  return (int)(v < last ? (v > 0 ? v : 0) : last);
}

/* What the search reads of particle i: its place and s, rounded up by more than both lose; cells:
 * places per metre. */
static __device__ __forceinline__ float keep_place(const Build &a, long i, const float drift[3],
                                                   double cells)
{
  const double il = a.il, *x = a.s.x + 3 * i;
  float e[3];
  drift_of(a, i, e);
  const float off = size3(e[0] - drift[0], e[1] - drift[1], e[2] - drift[2]);
  const double wide = 1 + a.s.margin, h = wide * a.s.h[i], ha = wide * a.s.ha[i];
  float s = fmaxf((float)(0.5 * h * il), (float)(0.5 * ha * il) + off);
  if (!(h >= 0 && ha >= 0 && fmax(h, ha) * il < NOWHERE && size3(e[0], e[1], e[2]) < NOWHERE)) {
    atomicMin(&a.report->loose, (long long)a.s.id[i]);
    s = 0;
  }
  s = s * 1.000001f + (float)(a.root->edge * PLACE_CELL * il);
  a.b.place[i] =
      make_int4(fixed(x[0], a.root->origin[0], cells), fixed(x[1], a.root->origin[1], cells),
                fixed(x[2], a.root->origin[2], cells), __float_as_int(s));
  return s;
}

static __device__ __forceinline__ void start(Up *u)
{
  u->m = u->trace = 0, u->h = u->reach = 0, u->count = 0;
#pragma unroll
  for (int k = 0; k < 6; k++) u->q[k] = 0;
#pragma unroll
  for (int d = 0; d < 3; d++) u->lo[d] = NOWHERE, u->hi[d] = -NOWHERE, u->drift[d] = 0;
}

/* Particles first .. end-1, none: the thread's node is no leaf. */
template <int LANES, int POLES>
static __device__ __forceinline__ void sum_leaf(const Build &a, long first, long end, int rank,
                                                Up *u)
{
  const double il = a.il, *o = a.root->origin;
  const double cells = 1 / (a.root->edge * PLACE_CELL);
  double sum[3] = {0, 0, 0};
  start(u);
  for (long i = first + rank; i < end; i += LANES) {
    const double *x = a.s.x + 3 * i, m = POLES ? a.s.m[i] : 0;
    float e[3];
    drift_of(a, i, e);
    u->m += m, u->h = fmaxf(u->h, __double2float_ru(a.s.h[i] * il)), u->count++;
#pragma unroll
    for (int d = 0; d < 3; d++) {
      const double v = (x[d] - o[d]) * il;
      sum[d] += m * x[d], u->drift[d] += e[d];
      u->lo[d] = fminf(u->lo[d], __double2float_rd(v));
      u->hi[d] = fmaxf(u->hi[d], __double2float_ru(v));
    }
  }
  join<LANES, POLES>(a, u, sum);
#pragma unroll
  for (int d = 0; d < 3; d++) u->drift[d] = add<LANES>(u->drift[d]) / (float)max(u->count, 1);
  for (long i = first + rank; i < end; i += LANES) {
    const double *x = a.s.x + 3 * i;
    if (POLES) add_quadrupole(u->q, a.s.m[i], x[0] - u->com[0], x[1] - u->com[1], x[2] - u->com[2]);
    if (POLES == POLES_PLUMMER)
      u->trace += a.s.m[i] * square3(x[0] - u->com[0], x[1] - u->com[1], x[2] - u->com[2]);
    u->reach = fmaxf(u->reach, keep_place(a, i, u->drift, cells));
  }
#pragma unroll
  for (int k = 0; k < 6 && POLES; k++) u->q[k] = add<LANES>(u->q[k]);
  if (POLES == POLES_PLUMMER) u->trace = add<LANES>(u->trace);
  u->reach = most<LANES>(u->reach);
}

/* Mass, centre and second moments of a child. */
static __device__ __forceinline__ void read_moments(const Build &a, int child, double c[4], Up *u)
{
  const double2 *m = (const double2 *)(a.t.moment + 10 * (size_t)child);
  double2 v[5];
#pragma unroll
  for (int k = 0; k < 5; k++) v[k] = __ldcg(m + k);
  c[0] = v[0].x, c[1] = v[0].y, c[2] = v[1].x, c[3] = v[1].y;
#pragma unroll
  for (int k = 0; k < 6; k++) u->q[k] = k % 2 ? v[2 + k / 2].y : v[2 + k / 2].x;
}

/* From child `child` of each thread, -1: none. Others have written it: past the first cache. */
template <int POLES>
static __device__ __forceinline__ void sum_children(const Build &a, int child, int children, Up *u)
{
  double c[4] = {0, 0, 0, 0}, sum[3];
  float4 drift = make_float4(0, 0, 0, 0);
  start(u);
  if (child >= 0) {
    const float4 lo = __ldcg(a.t.lo + child), hi = __ldcg(a.t.hi + child);
    drift = __ldcg(a.b.drift + child);
    u->lo[0] = lo.x, u->lo[1] = lo.y, u->lo[2] = lo.z;
    u->hi[0] = hi.x, u->hi[1] = hi.y, u->hi[2] = hi.z, u->h = hi.w;
    u->count = __ldcg(&a.t.link[child].w);
    if (POLES) read_moments(a, child, c, u);
  }
  u->m = c[0];
#pragma unroll
  for (int d = 0; d < 3; d++) sum[d] = c[0] * c[1 + d];
  join<FAMILY, POLES>(a, u, sum);
  if (POLES) {
    add_quadrupole(u->q, c[0], c[1] - u->com[0], c[2] - u->com[1], c[3] - u->com[2]);
#pragma unroll
    for (int k = 0; k < 6; k++) u->q[k] = add<FAMILY>(u->q[k]);
  }
  if (POLES == POLES_PLUMMER) {
    if (child >= 0) u->trace = __ldcg(&a.t.pole[child].trace) / (a.im * a.il * a.il);
    u->trace += c[0] * square3(c[1] - u->com[0], c[2] - u->com[1], c[3] - u->com[2]);
    u->trace = add<FAMILY>(u->trace);
  }
  const float share = 1 / (float)max(children, 1);
  u->drift[0] = add<FAMILY>(drift.x) * share, u->drift[1] = add<FAMILY>(drift.y) * share;
  u->drift[2] = add<FAMILY>(drift.z) * share;
  if (child >= 0)
    u->reach = 1.000001f * (drift.w + size3(drift.x - u->drift[0], drift.y - u->drift[1],
                                            drift.z - u->drift[2]));
  u->reach = most<FAMILY>(u->reach);
}

template <int POLES> static __device__ void keep_pole(const Build &a, int node, const Up &u)
{
  double2 *m = (double2 *)(a.t.moment + 10 * (size_t)node);
  const double iq = a.im * a.il * a.il;
  float hi[3], lo[3], q[6];
#pragma unroll
  for (int d = 0; d < 3; d++) {
    const double c = (u.com[d] - a.root->origin[d]) * a.il;
    hi[d] = __double2float_rn(c), lo[d] = __double2float_rn(c - (double)hi[d]);
  }
#pragma unroll
  for (int k = 0; k < 6; k++) q[k] = __double2float_rn(u.q[k] * iq);
  const float trace = POLES == POLES_PLUMMER ? __double2float_rn(u.trace * iq) : 0;
  float4 *to = (float4 *)(a.t.pole + node);
  to[0] = a.t.com[node] = make_float4(hi[0], hi[1], hi[2], __double2float_rn(u.m * a.im));
  to[1] = make_float4(lo[0], lo[1], lo[2], 0);
  to[2] = make_float4(q[0], q[1], q[2], q[3]), to[3] = make_float4(q[4], q[5], trace, 0);
  m[0] = make_double2(u.m, u.com[0]), m[1] = make_double2(u.com[1], u.com[2]);
  m[2] = make_double2(u.q[0], u.q[1]), m[3] = make_double2(u.q[2], u.q[3]);
  m[4] = make_double2(u.q[4], u.q[5]);
}

template <int POLES> static __device__ void keep(const Build &a, int node, int first, const Up &u)
{
  const int level = tree_common(a.key[first], a.key[first + u.count - 1]);
  const double size = a.root->edge / (double)(1 << level) * a.il;
  a.t.lo[node] = make_float4(u.lo[0], u.lo[1], u.lo[2], __double2float_ru(size));
  a.t.hi[node] = make_float4(u.hi[0], u.hi[1], u.hi[2], u.h);
  a.b.drift[node] = make_float4(u.drift[0], u.drift[1], u.drift[2], u.reach);
  if (POLES) keep_pole<POLES>(a, node, u);
}

/* Leaves: HANDS threads each, as most hold three or four particles. */
template <int POLES>
static __global__ void __launch_bounds__(THREADS, 3) sum_leaves(const __grid_constant__ Build a)
{
  const int nodes = a.t.level[ROWS], stride = (int)gridDim.x * THREADS / HANDS;
  const int lane = threadIdx.x % 32, rank = lane % HANDS;
  if (nodes > a.t.room) return;
  for (int b = ((int)blockIdx.x * THREADS + (int)threadIdx.x - lane) / HANDS; b < nodes;
       b += stride) {
    const int node = b + lane / HANDS;
    const int4 link = node < nodes ? a.t.link[node] : make_int4(0, -1, 0, 0);
    Up u;
    sum_leaf<HANDS, POLES>(a, link.z, link.y == 0 ? (long)link.z + link.w : 0, rank, &u);
    if (link.y == 0 && rank == 0) keep<POLES>(a, node, link.z, u);
  }
}

/* From the nodes `node` of a warp's four families as far up as they are the last to come; a node
 * that has inner children waits for these. */
template <int POLES>
static __device__ __forceinline__ void climb(const Build &a, int nodes, int node)
{
  const int lane = threadIdx.x % 32, rank = lane % FAMILY, head = lane - rank;
  bool on = node >= 0, bottom = true;
  while (__any_sync(ALL, on)) {
    const int first = on ? a.t.link[node].x : 0, child = first + rank;
    const bool kin = on && child < nodes && a.b.parent[child] == node;
    const int kids = __popc(__ballot_sync(ALL, kin) >> head & 255);
    const bool inner = kin && __ldcg(&a.t.link[child].y) != 0;
    const int inners = __popc(__ballot_sync(ALL, inner) >> head & 255);
    int came = -1;
    if (on && !bottom && rank == 0) came = atomicAdd(a.b.arrived + node, 1);
    came = __shfl_sync(ALL, came, head);
    on = on && came == inners - 1, bottom = false;
    __threadfence();
    Up u;
    sum_children<POLES>(a, on && kin ? child : -1, kids, &u);
    if (on && rank == 0) {
      int4 link = a.t.link[node];
      link.y = kids, link.w = u.count;
      a.t.link[node] = link;
      keep<POLES>(a, node, link.z, u);
    }
    __threadfence();
    __syncwarp();
    node = on ? a.b.parent[node] : -1, on = node >= 0;
  }
}

/* All others, from those with leaves only; a warp looks for these among 32 nodes at a time. */
template <int POLES>
static __global__ void __launch_bounds__(THREADS, 3) sum_up(const __grid_constant__ Build a)
{
  const int nodes = a.t.level[ROWS], stride = (int)gridDim.x * THREADS;
  const int lane = threadIdx.x % 32;
  if (nodes > a.t.room) return;
  for (int b = (int)blockIdx.x * THREADS + (int)threadIdx.x - lane; b < nodes; b += stride) {
    unsigned inner = __ballot_sync(ALL, b + lane < nodes && __ldcg(&a.t.link[b + lane].y) != 0);
    for (int took = 0; inner; took = 0) {
      int node = -1;
      for (; inner && took < 32 / FAMILY; inner &= inner - 1, took++)
        if (took == lane / FAMILY) node = b + __ffs((int)inner) - 1;
      climb<POLES>(a, nodes, node);
    }
  }
}

static int blocks_of(long n) { return (int)launch_blocks((size_t)n, THREADS); }

/* Whether gravity needs the tree. */
static int walked(const Sim *sim) { return sim->par.gravity == PARAM_TREE; }

static int poles_of(const Sim *sim)
{
  if (!walked(sim) || !sim->pull_due) return POLES_NONE;
  return sim->par.softening == SOFTENING_PLUMMER ? POLES_PLUMMER : POLES_NEWTON;
}

typedef void (*Summer)(const Build);
static const Summer leaves[] = {sum_leaves<POLES_NONE>, sum_leaves<POLES_NEWTON>,
                                sum_leaves<POLES_PLUMMER>};
static const Summer ups[] = {sum_up<POLES_NONE>, sum_up<POLES_NEWTON>, sum_up<POLES_PLUMMER>};

int cuda_tree(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  struct CudaTree *b = c->build;
  const int blocks = blocks_of(sim->s.all), few = min(blocks, 8 * 132), poles = poles_of(sim);
  Build a = {sim->s,
             c->unit.length,
             1 / c->unit.length,
             1 / c->unit.mass,
             c->root,
             c->order->key[0],
             c->tree,
             *b,
             c->order->report,
             blocks};
  a.s.n = sim->s.all;
  LAUNCH(count_nodes, blocks, THREADS, 0, c->stream, a);
  if (!error->code)
    CHECK(cub::DeviceScan::ExclusiveSum(b->scan, b->scan_bytes, b->count, b->base,
                                        ROWS * blocks + 1, c->stream));
  LAUNCH(make_nodes, blocks, THREADS, 0, c->stream, a);
  LAUNCH(leaves[poles], few, THREADS, 0, c->stream, a);
  LAUNCH(ups[poles], few, THREADS, 0, c->stream, a);
  return launch_failed(error, err);
}

/* An array by nodes: where its pointer is, bytes a node. */
typedef struct {
  void **at;
  size_t bytes;
} NodeArray;
enum { NODE_ARRAYS = 9 };

static int node_arrays(const Sim *sim, Cuda *c, NodeArray out[NODE_ARRAYS])
{
  DeviceTree *t = &c->tree;
  struct CudaTree *b = c->build;
  const NodeArray all[NODE_ARRAYS] = {{(void **)&t->link, sizeof *t->link},
                                      {(void **)&t->lo, sizeof *t->lo},
                                      {(void **)&t->hi, sizeof *t->hi},
                                      {(void **)&b->parent, sizeof *b->parent},
                                      {(void **)&b->arrived, sizeof *b->arrived},
                                      {(void **)&b->drift, sizeof *b->drift},
                                      {(void **)&t->com, sizeof *t->com},
                                      {(void **)&t->pole, sizeof *t->pole},
                                      {(void **)&t->moment, 10 * sizeof *t->moment}};
  memcpy(out, all, sizeof all);
  return walked(sim) ? NODE_ARRAYS : NODE_ARRAYS - 3;
}

int cuda_tree_grow(Sim *sim, long nodes, Err *err)
{
  Cuda *c = cuda_of(sim);
  NodeArray a[NODE_ARRAYS];
  const int arrays = node_arrays(sim, c, a);
  for (int k = 0; k < arrays; k++) cuda_give(sim, a[k].at, (size_t)c->tree.room * a[k].bytes);
  c->tree.room = 0;
  for (int k = 0; k < arrays; k++)
    if (cuda_alloc(sim, a[k].at, (size_t)nodes * a[k].bytes, err)) return -1;
  c->tree.room = nodes;
  return 0;
}

/* Uniform density: 0.3 n, at times 0.5. */
static long first_room(long n) { return 3 * n / 8 + 1024; }
static size_t counts_of(long n) { return (size_t)blocks_of(n) * ROWS + 1; }

static size_t scan_bytes(Sim *sim)
{
  CudaError *error = &cuda_of(sim)->error;
  size_t bytes = 0;
  CHECK(cub::DeviceScan::ExclusiveSum(NULL, bytes, (int *)NULL, (int *)NULL,
                                      (int)counts_of(sim->s.room), cuda_of(sim)->stream));
  return bytes;
}

size_t cuda_tree_bytes(Sim *sim)
{
  struct CudaTree none;
  Cuda nothing;
  NodeArray a[NODE_ARRAYS];
  size_t node = 0;
  nothing.build = &none;
  for (int k = node_arrays(sim, &nothing, a); k-- > 0;) node += a[k].bytes;
  return (size_t)first_room(sim->s.room) * node +
         (size_t)sim->s.room * (sizeof *none.place + sizeof *nothing.tree.span) +
         counts_of(sim->s.room) * 2 * sizeof *none.count + scan_bytes(sim);
}

int cuda_tree_open(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  const size_t n = (size_t)sim->s.room, counts = counts_of(sim->s.room);
  struct CudaTree *b = (struct CudaTree *)calloc(1, sizeof *b);
  if (!b) return err_set(err, "not enough memory");
  c->build = b, b->scan_bytes = scan_bytes(sim);
  if (launch_failed(&c->error, err) ||
      cuda_alloc(sim, (void **)&b->place, n * sizeof *b->place, err) ||
      cuda_alloc(sim, (void **)&c->tree.span, n * sizeof *c->tree.span, err) ||
      cuda_alloc(sim, (void **)&b->count, counts * sizeof *b->count, err) ||
      cuda_alloc(sim, (void **)&b->base, counts * sizeof *b->base, err) ||
      cuda_alloc(sim, &b->scan, b->scan_bytes, err) ||
      cuda_alloc(sim, (void **)&c->tree.level, (ROWS + 1) * sizeof(int), err))
    return -1;
  return cuda_tree_grow(sim, first_room(sim->s.room), err);
}

void cuda_tree_close(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  struct CudaTree *b = c->build;
  NodeArray a[NODE_ARRAYS];
  if (!b) return;
  for (int k = node_arrays(sim, c, a); k-- > 0;) cuda_free(*a[k].at), *a[k].at = NULL;
  c->tree.room = 0;
  cuda_free(c->tree.level), c->tree.level = NULL;
  cuda_free(b->place), cuda_free(c->tree.span), cuda_free(b->count), cuda_free(b->base);
  cuda_free(b->scan);
  free(b);
  c->build = NULL;
}
