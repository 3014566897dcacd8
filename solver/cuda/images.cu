/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Images of particles near periodic and mirror faces, behind the particles in the arrays that the
 * search reads. They are found before each search by the old order of their owners, sorted behind
 * all particles, and then filled from the new one. Runs without such faces do nothing here. */
#include <cub/cub.cuh>
#include "tree.cuh"
extern "C" {
#include "../image.h"
}

enum { THREADS = 256, SPARE = 1024 };

struct CudaImages {
  unsigned long long *reach; /* BoundsReach, as bits: not negative, so they are in order */
  Image *found;              /* [room], before the sort */
  void *scan;
  size_t scan_bytes;
};

static __device__ __forceinline__ double most_of(double v)
{
#pragma unroll
  for (int k = 16; k; k /= 2) v = fmax(v, __shfl_xor_sync(~0u, v, k));
  return v;
}

static __global__ void find_reach(const State s, unsigned long long *reach)
{
  const long i = (long)blockIdx.x * THREADS + threadIdx.x;
  BoundsReach r = {0, 0};
  if (i < s.n) image_reach(&s, i, &r);
  r.h = most_of(r.h), r.out = most_of(r.out);
  if (threadIdx.x % 32) return;
  atomicMax(reach, (unsigned long long)__double_as_longlong(r.h));
  atomicMax(reach + 1, (unsigned long long)__double_as_longlong(r.out));
}

/* count[n]: none, so that the sums before it end with all. */
static __global__ void count_images(const State s, const BoundsReach *reach, uint32_t *count)
{
  const long i = (long)blockIdx.x * THREADS + threadIdx.x;
  if (i < s.n) count[i] = (uint32_t)bounds_count(image_faces(&s, i, reach));
  if (i == s.n) count[i] = 0;
}

static __global__ void make_images(const State s, const BoundsReach *reach, const uint32_t *before)
{
  const long i = (long)blockIdx.x * THREADS + threadIdx.x;
  if (i >= s.n) return;
  const int faces = image_faces(&s, i, reach);
  long at = before[i];
  for (int code = 1; code < BOUNDS_CODES; code++) {
    if (!bounds_seen(faces, code)) continue;
    s.image[at] = {(uint32_t)i, (uint32_t)code};
    image_fill(&s, s.n + at++);
  }
}

/* now[i]: where the particle is that was at i. */
static __global__ void find_owners(long n, const uint32_t *from, uint32_t *now)
{
  const long i = (long)blockIdx.x * THREADS + threadIdx.x;
  if (i < n) now[from[i]] = (uint32_t)i;
}

static __global__ void order_images(const State s, const uint32_t *from, const uint32_t *now,
                                    const Image *found)
{
  const long i = s.n + (long)blockIdx.x * THREADS + threadIdx.x;
  if (i >= s.all) return;
  const Image m = found[from[i] - s.n];
  s.image[i - s.n] = {now[m.owner], m.code};
  image_fill(&s, i);
}

/* The same arrays with more rows. */
static int grow(Sim *sim, long room, Err *err)
{
  CudaColumn column[CUDA_COLUMNS];
  State *s = &sim->s;
  int all;
  cuda_order_close(sim), cuda_tree_close(sim), cuda_lists_close(sim), cuda_loops_close(sim);
  cuda_columns(sim, column, &all);
  for (int k = 0; k < all; k++) {
    const size_t row = (size_t)column[k].width * (size_t)column[k].size;
    void *old = *column[k].array;
    if (cuda_alloc(sim, column[k].array, (size_t)room * row, err) ||
        cuda_copy(sim, *column[k].array, old, (size_t)s->n * row, err))
      return -1;
    cuda_give(sim, &old, (size_t)s->room * row);
  }
  cuda_images_close(sim);
  s->room = room;
  return cuda_order_open(sim, err) || cuda_tree_open(sim, err) || cuda_lists_open(sim, err) ||
                 cuda_loops_open(sim, err) || cuda_images_open(sim, err)
             ? -1
             : 0;
}

static int find_faces(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  BoundsReach reach;
  CHECK(cudaMemsetAsync(c->images->reach, 0, sizeof reach, c->stream));
  LAUNCH(find_reach, launch_blocks((size_t)sim->s.n, THREADS), THREADS, 0, c->stream, sim->s,
         c->images->reach);
  return launch_failed(error, err) || cuda_copy(sim, &reach, c->images->reach, sizeof reach, err) ||
                 image_check(&sim->s, &reach, err)
             ? -1
             : 0;
}

/* How many images there are; where each particle's begin is in from[1]. */
static long count(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const long n = sim->s.n;
  uint32_t *each = c->order->from[0], *before = c->order->from[1], all = 0;
  LAUNCH(count_images, launch_blocks((size_t)n + 1, THREADS), THREADS, 0, c->stream, sim->s,
         (const BoundsReach *)c->images->reach, each);
  if (!error->code)
    CHECK(cub::DeviceScan::ExclusiveSum(c->images->scan, c->images->scan_bytes, each, before,
                                        (int)(n + 1), c->stream));
  if (launch_failed(error, err) || cuda_copy(sim, &all, before + n, sizeof all, err)) return -1;
  return (long)all;
}

int cuda_images_find(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const long n = sim->s.n;
  long images;
  sim->s.all = n;
  if (!sim->s.bounds.on) return 0;
  if (find_faces(sim, err) || (images = count(sim, err)) < 0) return -1;
  if (n + images > sim->s.room) {
    if (grow(sim, n + images + images / 4 + SPARE, err) || find_faces(sim, err) ||
        (images = count(sim, err)) < 0)
      return -1;
  }
  sim->s.all = n + images;
  State s = sim->s;
  s.image = c->images->found;
  LAUNCH(make_images, launch_blocks((size_t)n, THREADS), THREADS, 0, c->stream, s,
         (const BoundsReach *)c->images->reach, c->order->from[1]);
  return launch_failed(error, err);
}

void cuda_images_order(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const State *s = &sim->s;
  uint32_t *now = (uint32_t *)c->scratch;
  if (s->all == s->n) return;
  LAUNCH(find_owners, launch_blocks((size_t)s->n, THREADS), THREADS, 0, c->stream, s->n,
         c->order->from[0], now);
  LAUNCH(order_images, launch_blocks((size_t)(s->all - s->n), THREADS), THREADS, 0, c->stream, *s,
         c->order->from[0], now, c->images->found);
}

/* As the particles of the file lie, with some more for what is to come. */
long cuda_images_room(const Sim *sim, const Parts *p)
{
  BoundsReach r = {0, 0};
  long images = 0;
  if (!sim->bounds.on) return p->n;
  for (long i = 0; i < p->n; i++) r.h = fmax(r.h, p->h[i]);
  for (long i = 0; i < p->n; i++)
    images += bounds_count(bounds_faces(&sim->bounds, &p->x[3 * i], &p->x[3 * i], &r));
  return p->n + images + images / 4 + SPARE;
}

static size_t scan_bytes(Sim *sim)
{
  CudaError *error = &cuda_of(sim)->error;
  size_t bytes = 0;
  CHECK(cub::DeviceScan::ExclusiveSum(NULL, bytes, (uint32_t *)NULL, (uint32_t *)NULL,
                                      (int)(sim->s.n + 1), cuda_of(sim)->stream));
  return bytes;
}

size_t cuda_images_bytes(Sim *sim)
{
  const size_t images = (size_t)sim->s.room;
  return sim->s.bounds.on ? 2 * images * sizeof(Image) + scan_bytes(sim) + sizeof(BoundsReach) : 0;
}

int cuda_images_open(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  const size_t bytes = (size_t)sim->s.room * sizeof(Image);
  if (!sim->s.bounds.on) return 0;
  if (!(c->images = (struct CudaImages *)calloc(1, sizeof *c->images)))
    return err_set(err, "not enough memory");
  c->images->scan_bytes = scan_bytes(sim);
  return launch_failed(&c->error, err) ||
                 cuda_alloc(sim, (void **)&c->images->reach, sizeof(BoundsReach), err) ||
                 cuda_alloc(sim, (void **)&c->images->found, bytes, err) ||
                 cuda_alloc(sim, (void **)&sim->s.image, bytes, err) ||
                 cuda_alloc(sim, &c->images->scan, c->images->scan_bytes, err)
             ? -1
             : 0;
}

void cuda_images_close(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  if (!c->images) return;
  cuda_free(c->images->reach), cuda_free(c->images->found), cuda_free(sim->s.image);
  cuda_free(c->images->scan);
  free(c->images);
  c->images = NULL, sim->s.image = NULL;
}
