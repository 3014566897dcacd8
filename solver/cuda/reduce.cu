/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reductions over all particles: at most BLOCKS blocks of THREADS threads take the particles in
 * turns, a binary tree in shared memory joins the threads of a block, and one block more joins the
 * blocks. Grid and trees depend on the number of particles alone, so sums have the same bits. The
 * results of a step are one small struct on the device, copied to the host at once. */
#include "cuda.h"
extern "C" {
#include "../reduce.h"
}

enum : unsigned { THREADS = 128, BLOCKS = 1024 };

typedef struct {
  double worst;
} Worst;

/* With the limits that may be off: a kernel of its own, as they take registers. */
typedef struct {
  Limits limits;
} LimitsAsked;

/* The results, on the device and in pinned memory. */
typedef struct {
  LimitsAsked limits;
  ReduceSums sums;
  ReduceMotion motion[BODIES];
  ReduceSpin spin[BODIES];
  Worst worst;
  PointReaction reaction[POINTS];
  ReduceChange change;
} Results;

struct CudaReduce {
  void *part; /* [BLOCKS][BODIES], the largest of the partial results */
  Results *device, *host;
};

/* What a reduction reads besides its particle. */
typedef struct {
  State s;
  Step k;
  const ReduceMotion *motion; /* of the spins: [BODIES] */
  PointSource point;          /* of the reaction */
} Context;

/* Each reduction by the type of its result: none of any particle, one more, two joined. */
static __device__ void start(Limits *o) { *o = reduce_no_limits(); }
static __device__ void start(LimitsAsked *o) { o->limits = reduce_no_limits(); }
template <class T> static __device__ void start(T *o) { memset(o, 0, sizeof *o); }

static __device__ void add(Limits *o, const Context &c, int, long i)
{
  reduce_add_limits(o, &c.s, &c.k, i, 0);
}
static __device__ void add(LimitsAsked *o, const Context &c, int, long i)
{
  reduce_add_limits(&o->limits, &c.s, &c.k, i, 1);
}
static __device__ void add(ReduceSums *o, const Context &c, int, long i)
{
  reduce_add_sums(o, &c.s, i);
}
static __device__ void add(ReduceMotion *o, const Context &c, int body, long i)
{
  if (reduce_body(&c.s, i) == body) reduce_add_motion(o, &c.s, i);
}
static __device__ void add(ReduceSpin *o, const Context &c, int body, long i)
{
  double centre[3], velocity[3];
  if (reduce_body(&c.s, i) != body) return;
  reduce_motion(&c.motion[body], centre, velocity);
  reduce_add_spin(o, &c.s, centre, velocity, i);
}
static __device__ void add(PointReaction *o, const Context &c, int, long i)
{
  points_react(o, &c.point, c.s.m[i], c.s.x + 3 * i);
}
static __device__ void add(ReduceChange *o, const Context &c, int, long i)
{
  reduce_add_change(o, &c.s, i);
}
static __device__ void add(Worst *o, const Context &c, int, long i)
{
  double e = reduce_error(&c.s, &c.k, i);
  o->worst = e > o->worst ? e : o->worst;
}

static __device__ void merge(Limits *a, const Limits *b) { reduce_merge_limits(a, b); }
static __device__ void merge(LimitsAsked *a, const LimitsAsked *b)
{
  reduce_merge_limits(&a->limits, &b->limits);
}
static __device__ void merge(ReduceSums *a, const ReduceSums *b) { reduce_merge_sums(a, b); }
static __device__ void merge(ReduceMotion *a, const ReduceMotion *b) { reduce_merge_motion(a, b); }
static __device__ void merge(ReduceSpin *a, const ReduceSpin *b) { reduce_merge_spin(a, b); }
static __device__ void merge(PointReaction *a, const PointReaction *b) { points_merge(a, b); }
static __device__ void merge(ReduceChange *a, const ReduceChange *b) { reduce_merge_change(a, b); }
static __device__ void merge(Worst *a, const Worst *b)
{
  a->worst = b->worst > a->worst ? b->worst : a->worst;
}

/* The threads of a block into thread 0's. */
template <class T> static __device__ void join(T *mine)
{
  __shared__ T all[THREADS];
  const unsigned t = threadIdx.x;
  all[t] = *mine;
  for (unsigned half = THREADS / 2; half > 0; half /= 2) {
    __syncthreads();
    if (t < half) merge(&all[t], &all[t + half]);
  }
  *mine = all[t]; /* its own: what others still write is not read */
}

/* A block's share; blockIdx.y: body. */
template <class T> static __global__ void reduce_parts(const __grid_constant__ Context c, T *part)
{
  T o;
  start(&o);
  for (long i = (long)blockIdx.x * THREADS + threadIdx.x; i < c.s.n; i += (long)gridDim.x * THREADS)
    add(&o, c, (int)blockIdx.y, i);
  join(&o);
  if (threadIdx.x == 0) part[blockIdx.y * gridDim.x + blockIdx.x] = o;
}

/* All shares; blockIdx.x: body. */
template <class T> static __global__ void reduce_all(const T *part, unsigned parts, T *out)
{
  T o;
  start(&o);
  for (unsigned b = threadIdx.x; b < parts; b += THREADS) merge(&o, &part[blockIdx.x * parts + b]);
  join(&o);
  if (threadIdx.x == 0) out[blockIdx.x] = o;
}

template <class T>
static void reduce(Sim *sim, const Step *step, int bodies, T *out, const PointSource *point = NULL)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  T *part = (T *)c->reduce->part;
  Context x = {sim->s, {}, c->reduce->device->motion, {}};
  const unsigned all = launch_blocks((size_t)sim->s.n, THREADS),
                 parts = all < BLOCKS ? all : BLOCKS;
  if (step) x.k = *step;
  if (point) x.point = *point;
  LAUNCH(reduce_parts<T>, dim3(parts, (unsigned)bodies), THREADS, 0, c->stream, x, part);
  LAUNCH(reduce_all<T>, (unsigned)bodies, THREADS, 0, c->stream, (const T *)part, parts, out);
}

/* The results to the host. */
static int fetch(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  CHECK(cudaMemcpyAsync(c->reduce->host, c->reduce->device, sizeof(Results), cudaMemcpyDeviceToHost,
                        c->stream));
  CHECK(cudaStreamSynchronize(c->stream));
  return launch_failed(error, err);
}

int cuda_limits(Sim *sim, const Step *step, Limits *out, Err *err)
{
  struct CudaReduce *r = cuda_of(sim)->reduce;
  if (step->limited)
    reduce(sim, step, 1, &r->device->limits);
  else
    reduce(sim, step, 1, &r->device->limits.limits);
  if (fetch(sim, err)) return -1;
  *out = r->host->limits.limits;
  return 0;
}

int cuda_sums(Sim *sim, Sums *out, Err *err)
{
  struct CudaReduce *r = cuda_of(sim)->reduce;
  reduce(sim, NULL, 1, &r->device->sums);
  if (fetch(sim, err)) return -1;
  reduce_sums(&r->host->sums, out);
  return 0;
}

int cuda_bodies(Sim *sim, Step *step, Err *err)
{
  struct CudaReduce *r = cuda_of(sim)->reduce;
  reduce(sim, NULL, BODIES, r->device->motion);
  reduce(sim, NULL, BODIES, r->device->spin);
  if (fetch(sim, err)) return -1;
  for (int b = 0; b < BODIES; b++) {
    reduce_motion(&r->host->motion[b], step->centre[b], step->velocity[b]);
    reduce_spin(&r->host->spin[b], step->omega[b]);
  }
  return 0;
}

int cuda_change(Sim *sim, double *relative, Err *err)
{
  struct CudaReduce *r = cuda_of(sim)->reduce;
  reduce(sim, NULL, 1, &r->device->change);
  if (fetch(sim, err)) return -1;
  *relative = reduce_change(&r->host->change);
  return 0;
}

int cuda_error(Sim *sim, const Step *step, double *worst, Err *err)
{
  struct CudaReduce *r = cuda_of(sim)->reduce;
  reduce(sim, step, 1, &r->device->worst);
  if (fetch(sim, err)) return -1;
  *worst = r->host->worst.worst;
  return 0;
}

int cuda_reaction(Sim *sim, const PointField *field, PointReaction *reaction, Err *err)
{
  struct CudaReduce *r = cuda_of(sim)->reduce;
  for (int k = 0; k < field->n; k++) reduce(sim, NULL, 1, &r->device->reaction[k], &field->at[k]);
  if (fetch(sim, err)) return -1;
  memcpy(reaction, r->host->reaction, (size_t)field->n * sizeof *reaction);
  return 0;
}

static size_t part_bytes(void)
{
  const size_t one = sizeof(ReduceSums), all = BODIES * sizeof(ReduceSpin);
  return BLOCKS * (one > all ? one : all);
}

size_t cuda_reduce_bytes(void) { return part_bytes() + sizeof(Results); }

int cuda_reduce_open(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  if (!(c->reduce = (struct CudaReduce *)calloc(1, sizeof *c->reduce)))
    return err_set(err, "not enough memory");
  if (cuda_alloc(sim, &c->reduce->part, part_bytes(), err)) return -1;
  if (cuda_alloc(sim, (void **)&c->reduce->device, sizeof(Results), err)) return -1;
  CHECK(cudaMallocHost((void **)&c->reduce->host, sizeof(Results)));
  return launch_failed(error, err);
}

void cuda_reduce_close(Sim *sim)
{
  struct CudaReduce *r = cuda_of(sim)->reduce;
  if (!r) return;
  cuda_free(r->part), cuda_free(r->device);
  if (r->host) cudaFreeHost(r->host);
  free(r);
}
