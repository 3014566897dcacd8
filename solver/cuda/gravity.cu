/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Self-gravity on the device: the tree walk (gravity_walk.cuh) or direct sums, then what
 * force and torque the tree's errors leave over is taken off (recoil.h) and the pull is added to
 * acc. Nothing waits. */
#include "cuda.h"
extern "C" {
#include "../recoil.h"
}
#include "gravity_walk.cuh"

enum {
  DIRECT_BLOCK = 128, /* targets a block, sources a tile */
  RECOIL_BLOCKS = 512,
  RECOIL_THREADS = 128,
  FEW_WARPS = 5000, /* a card wants more than these at work */
  WALKERS = 4096    /* blocks; those that find no room on the card come when no piece is left */
};

struct CudaGravity {
  Recoil *recoil;
  RecoilForce *force; /* [RECOIL_BLOCKS] */
  RecoilTorque *torque;
  int *queue; /* [2] of WalkQueue: pieces, next */
};

size_t cuda_gravity_bytes(const Sim *sim)
{
  const size_t part = sizeof(RecoilForce) + sizeof(RecoilTorque);
  return sim->par.gravity == PARAM_TREE ? RECOIL_BLOCKS * part + sizeof(Recoil) + 2 * sizeof(int)
                                        : 0;
}

/* A sum of floats to twice their precision (Knuth's two-sum): fast on every card. */
struct Wide {
  float sum, rest;
};

INLINE void add(Wide *a, float x)
{
  const float s = a->sum + x, b = s - a->sum;
  a->rest += (a->sum - (s - b)) + (x - b), a->sum = s;
}

INLINE void add(double *a, double x) { *a += x; }
/* A product that is rounded before anything is added: what add() needs. */
INLINE float product(float a, float b) { return __fmul_rn(a, b); }
INLINE double product(double a, double b) { return __dmul_rn(a, b); }
INLINE double whole(Wide a) { return (double)a.sum + a.rest; }
INLINE double whole(double a) { return a; }
template <class Real> struct DirectSum;
template <> struct DirectSum<float> {
  typedef Wide type;
};
template <> struct DirectSum<double> {
  typedef double type;
};

/* A particle of a direct sum: x = a + b, exactly. */
template <class Real> struct DirectBody {
  Four<Real> a, b; /* w of a: half the support; of b: mass */
};

INLINE DirectBody<float> direct_body(const Walk &w, int i, float)
{
  const float4 hi = w.points.hi[i], lo = w.points.lo[i];
  return {{hi.x, hi.y, hi.z, 0.5f * hi.w}, {lo.x, lo.y, lo.z, lo.w}};
}

INLINE DirectBody<double> direct_body(const Walk &w, int i, double)
{
  const double *x = w.x + 3 * (int64_t)i, *o = w.root->origin, il = w.il;
  return {{x[0] * il, x[1] * il, x[2] * il, 0.5 * il * w.h[i]},
          {-o[0] * il, -o[1] * il, -o[2] * il, w.m[i] * w.im}};
}

/* All pairs. The force on the pair is m_i m_j (...), its sum is as precise as a double, and what is
 * divided by is the mass: so momentum is conserved to the rounding of a double. */
template <class Real, int Soft>
static __global__ void __launch_bounds__(DIRECT_BLOCK) direct_sum(const __grid_constant__ Walk w)
{
  __shared__ DirectBody<Real> tile[DIRECT_BLOCK];
  const int i = (int)(blockIdx.x * DIRECT_BLOCK + threadIdx.x);
  const DirectBody<Real> me = direct_body(w, min(i, w.n - 1), Real());
  double total[3] = {0, 0, 0},
         phi = pair_own<Soft>(me.b.w * me.b.w, walk_support<Soft>(w, me.a.w, me.a.w));
  for (int from = 0; from < w.n; from += DIRECT_BLOCK) {
    const int j = from + (int)threadIdx.x, end = min(DIRECT_BLOCK, w.n - from);
    typename DirectSum<Real>::type sum[3] = {};
    Real potential = 0;
    __syncthreads();
    if (j < w.n) tile[threadIdx.x] = direct_body(w, j, Real());
    __syncthreads();
#pragma unroll 4
    for (int k = 0; k < end; k++) {
      const Four<Real> a = tile[k].a, b = tile[k].b;
      const Real dx = a.x - me.a.x + (b.x - me.b.x), dy = a.y - me.a.y + (b.y - me.b.y),
                 dz = a.z - me.a.z + (b.z - me.b.z);
      Real p;
      const Real f =
          pair_any<Soft>(dx, dy, dz, me.b.w * b.w, walk_support<Soft>(w, me.a.w, a.w), &p);
      add(sum, product(f, dx)), add(sum + 1, product(f, dy)), add(sum + 2, product(f, dz));
      potential += p;
    }
    for (int d = 0; d < 3; d++) total[d] += whole(sum[d]);
    phi += potential;
  }
  if (i >= w.n) return;
  const double scale = w.G * w.mass / w.length, over = me.b.w > 0 ? w.mass / w.m[i] : 0;
  for (int d = 0; d < 3; d++) w.pull[3 * (int64_t)i + d] = scale / w.length * over * total[d];
  w.phi[i] = scale * over * phi;
}

/* What the tree's errors leave over (recoil.h): blocks take the particles in turns, a binary tree
 * joins the threads of a block, one block more joins the blocks: the same bits on every card. */
INLINE void recoil_add(RecoilForce *o, const Walk &w, const Recoil *, int64_t i)
{
  recoil_add_force(o, w.m[i], w.x + 3 * i, w.pull + 3 * i);
}

INLINE void recoil_add(RecoilTorque *o, const Walk &w, const Recoil *k, int64_t i)
{
  recoil_add_torque(o, k, w.m[i], w.x + 3 * i, w.pull + 3 * i);
}

INLINE void recoil_merge(RecoilForce *a, const RecoilForce *b) { recoil_merge_force(a, b); }
INLINE void recoil_merge(RecoilTorque *a, const RecoilTorque *b) { recoil_merge_torque(a, b); }
INLINE void recoil_keep(Recoil *k, const RecoilForce *o) { *k = recoil_mean(o); }
INLINE void recoil_keep(Recoil *k, const RecoilTorque *o) { recoil_turn(k, o); }

template <class Sum> INLINE void recoil_join(Sum *mine)
{
  __shared__ Sum all[RECOIL_THREADS];
  const unsigned t = threadIdx.x;
  all[t] = *mine;
  for (unsigned half = RECOIL_THREADS / 2; half; half /= 2) {
    __syncthreads();
    if (t < half) recoil_merge(all + t, all + t + half);
  }
  if (t == 0) *mine = all[0];
}

template <class Sum>
static __global__ void recoil_parts(const __grid_constant__ Walk w, const Recoil *k, Sum *part)
{
  Sum o = {};
  for (int64_t i = (int64_t)blockIdx.x * RECOIL_THREADS + threadIdx.x; i < w.n;
       i += gridDim.x * RECOIL_THREADS)
    recoil_add(&o, w, k, i);
  recoil_join(&o);
  if (threadIdx.x == 0) part[blockIdx.x] = o;
}

template <class Sum> static __global__ void recoil_all(const Sum *part, int parts, Recoil *k)
{
  Sum o = {};
  for (int b = (int)threadIdx.x; b < parts; b += RECOIL_THREADS) recoil_merge(&o, part + b);
  recoil_join(&o);
  if (threadIdx.x == 0) recoil_keep(k, &o);
}

/* Held dimensions feel nothing. */
static __global__ void add_pull(const __grid_constant__ Walk w, const Recoil *k, double *acc,
                                int dimension)
{
  const int64_t i = (int64_t)blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= w.n) return;
  double *a = w.pull + 3 * i;
  if (k) recoil_take(k, w.x + 3 * i, a);
  for (int d = dimension; d < 3; d++) a[d] = 0;
  for (int d = 0; d < 3; d++) acc[3 * i + d] += a[d];
}

static __global__ void pull_points(const State s, const __grid_constant__ PointField field)
{
  const int64_t i = (int64_t)blockIdx.x * blockDim.x + threadIdx.x;
  if (i < s.n) points_pull(&field, s.x + 3 * i, s.acc + 3 * i);
}

void cuda_points(Sim *sim, const PointField *field)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  LAUNCH(pull_points, launch_blocks((size_t)sim->s.n, DIRECT_BLOCK), DIRECT_BLOCK, 0, c->stream,
         sim->s, *field);
}

int cuda_gravity_open(Sim *sim, Err *err)
{
  CudaGravity *g = (CudaGravity *)calloc(1, sizeof *g);
  cuda_of(sim)->gravity = g;
  if (!g) return err_set(err, "not enough memory");
  if (sim->par.gravity != PARAM_TREE) return 0;
  if (cuda_alloc(sim, (void **)&g->recoil, sizeof *g->recoil, err) ||
      cuda_alloc(sim, (void **)&g->force, RECOIL_BLOCKS * sizeof *g->force, err) ||
      cuda_alloc(sim, (void **)&g->torque, RECOIL_BLOCKS * sizeof *g->torque, err) ||
      cuda_alloc(sim, (void **)&g->queue, 2 * sizeof *g->queue, err))
    return -1;
  return 0;
}

void cuda_gravity_close(Sim *sim)
{
  CudaGravity *g = cuda_of(sim)->gravity;
  if (!g) return;
  cuda_free(g->recoil), cuda_free(g->force), cuda_free(g->torque), cuda_free(g->queue);
  free(g);
  cuda_of(sim)->gravity = NULL;
}

/* Particles a piece: 32 share a walk best, fewer when there would not be work for the card. */
static int chunk_of(long n)
{
  int chunk = 32;
  while (chunk > 8 && n / chunk < FEW_WARPS) chunk /= 2;
  return chunk;
}

static int soft_of(const Param *p)
{
  return p->softening == SOFTENING_PLUMMER ? SOFT_PLUMMER : p->epsilon > 0 ? SOFT_ONE : SOFT_PAIR;
}

/* As pair_square, coincident particles make no NaN. */
static double soft_length(const Param *p, double il)
{
  const double e = p->epsilon * il;
  return p->softening == SOFTENING_PLUMMER ? fmax(e * e, 1e-24) : 0.5 * SOFTENING_SUPPORT * e;
}

static Walk walk_of(const Sim *sim)
{
  const Cuda *c = cuda_of(sim);
  const State *s = &sim->s;
  int *queue = c->gravity->queue;
  Walk w = {};
  w.tree = c->tree, w.points = c->x, w.root = c->root;
  w.x = s->x, w.m = s->m, w.h = s->h, w.pull = s->pull, w.phi = s->phi;
  w.length = c->unit.length, w.mass = c->unit.mass, w.G = sim->par.G;
  w.il = 1 / w.length, w.im = 1 / w.mass;
  w.soft = soft_length(&sim->par, w.il);
  w.over_theta = sim->par.theta > 0 ? (float)(1 / sim->par.theta) : INFINITY;
  w.n = (int)s->n, w.chunk = chunk_of(s->n);
  w.queue = {(int2 *)c->scratch, queue, queue + 1};
  return w;
}

/* The kernels by precision and softening. */
typedef void (*Walker)(const Walk);
#define BY_SOFTENING(KERNEL, REAL)                                                                 \
  {                                                                                                \
    KERNEL<REAL, SOFT_PAIR>, KERNEL<REAL, SOFT_ONE>, KERNEL<REAL, SOFT_PLUMMER>                    \
  }
static const Walker walks[2][3] = {BY_SOFTENING(walk_tree, double), BY_SOFTENING(walk_tree, float)};
static const Walker sums[2][3] = {BY_SOFTENING(direct_sum, double),
                                  BY_SOFTENING(direct_sum, float)};

static void tree(Sim *sim, const Walk &w, int single)
{
  Cuda *c = cuda_of(sim);
  CudaGravity *g = c->gravity;
  CudaError *error = &c->error;
  const unsigned all = launch_blocks((size_t)w.n, RECOIL_THREADS),
                 parts = all < (unsigned)RECOIL_BLOCKS ? all : (unsigned)RECOIL_BLOCKS;
  CHECK(cudaMemsetAsync(g->queue, 0, 2 * sizeof *g->queue, c->stream));
  LAUNCH(walk_cut, launch_blocks((size_t)w.n, 128), 128, 0, c->stream, w);
  LAUNCH(walks[single][soft_of(&sim->par)], w.n < WALKERS ? w.n : WALKERS, 32, 0, c->stream, w);
  LAUNCH(recoil_parts<RecoilForce>, parts, RECOIL_THREADS, 0, c->stream, w, g->recoil, g->force);
  LAUNCH(recoil_all<RecoilForce>, 1, RECOIL_THREADS, 0, c->stream, g->force, (int)parts, g->recoil);
  LAUNCH(recoil_parts<RecoilTorque>, parts, RECOIL_THREADS, 0, c->stream, w, g->recoil, g->torque);
  LAUNCH(recoil_all<RecoilTorque>, 1, RECOIL_THREADS, 0, c->stream, g->torque, (int)parts,
         g->recoil);
}

int cuda_gravity(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const int single = sim->par.precision == PARAM_MIXED, method = sim->par.gravity,
            by_tree = sim->pull_due && method == PARAM_TREE;
  const Walk w = walk_of(sim);
  const unsigned blocks = launch_blocks((size_t)w.n, DIRECT_BLOCK);
  if (method == PARAM_NONE) return 0;
  if (sim->pull_due && sim->s.pull0)
    CHECK(cudaMemcpyAsync(sim->s.pull0, sim->s.pull, 3 * (size_t)w.n * sizeof *sim->s.pull,
                          cudaMemcpyDeviceToDevice, c->stream));
  if (by_tree) tree(sim, w, single);
  if (sim->pull_due && method == PARAM_DIRECT)
    LAUNCH(sums[single][soft_of(&sim->par)], blocks, DIRECT_BLOCK, 0, c->stream, w);
  LAUNCH(add_pull, blocks, DIRECT_BLOCK, 0, c->stream, w, by_tree ? c->gravity->recoil : NULL,
         sim->s.acc, sim->s.dimension);
  return launch_failed(error, err);
}
