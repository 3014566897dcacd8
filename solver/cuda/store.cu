/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state on its way to the host. Kernels put the arrays into row order in a staging buffer on
 * the card; from there a second stream brings them over in pinned pieces while the run goes on.
 * When the buffer is too small for all, the run waits for all but the last of it. */
#include "cuda.h"

enum { PIECE = 1 << 24 }; /* bytes of pinned memory */

/* What waits in the staging buffer. */
typedef struct {
  void *to;
  size_t from, bytes;
} Staged;

struct CudaStore {
  cudaStream_t stream;
  cudaEvent_t ready; /* the staging buffer is filled */
  CudaError error;   /* of the second stream, whose thread is another */
  char *stage, *piece;
  size_t room, used;
  Staged staged[CUDA_COLUMNS];
  int count;
};

int cuda_copy(Sim *sim, void *to, const void *from, size_t bytes, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  CHECK(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, c->stream));
  CHECK(cudaStreamSynchronize(c->stream));
  return launch_failed(error, err);
}

/* Element k of particle i to its place in the file. */
template <class T>
static __global__ void store_rows(long n, int width, const int64_t *row, const T *from, T *to)
{
  long e = (long)blockIdx.x * blockDim.x + threadIdx.x, i = e / width;
  if (i < n) to[row[i] * width + e % width] = from[e];
}

int cuda_fetch(Sim *sim, Parts *parts, Err *err)
{
  struct CudaStore *st = cuda_of(sim)->store;
  CudaError *error = &st->error;
  (void)parts;
  CHECK(cudaSetDevice(sim->card));
  CHECK(cudaStreamWaitEvent(st->stream, st->ready, 0));
  for (int k = 0; k < st->count; k++)
    for (size_t at = 0; at < st->staged[k].bytes; at += PIECE) {
      size_t left = st->staged[k].bytes - at, size = left < (size_t)PIECE ? left : (size_t)PIECE;
      CHECK(cudaMemcpyAsync(st->piece, st->stage + st->staged[k].from + at, size,
                            cudaMemcpyDeviceToHost, st->stream));
      CHECK(cudaStreamSynchronize(st->stream));
      memcpy((char *)st->staged[k].to + at, st->piece, size);
    }
  st->count = 0, st->used = 0;
  return launch_failed(error, err);
}

/* One array into the staging buffer, which is emptied before when it is full. */
static int stage(Sim *sim, Parts *p, void *to, const void *from, int width, int size, Err *err)
{
  Cuda *c = cuda_of(sim);
  struct CudaStore *st = c->store;
  CudaError *error = &c->error;
  long n = sim->s.n;
  size_t elements = (size_t)n * (size_t)width, bytes = elements * (size_t)size;
  char *place;
  if (st->used + bytes > st->room) {
    CHECK(cudaEventRecord(st->ready, c->stream));
    if (cuda_fetch(sim, p, err)) return -1;
  }
  place = st->stage + st->used;
  if (size == 8)
    LAUNCH(store_rows<uint64_t>, launch_blocks(elements, 256), 256, 0, c->stream, n, width,
           sim->s.row, (const uint64_t *)from, (uint64_t *)place);
  else
    LAUNCH(store_rows<uint32_t>, launch_blocks(elements, 256), 256, 0, c->stream, n, width,
           sim->s.row, (const uint32_t *)from, (uint32_t *)place);
  st->staged[st->count++] = {to, st->used, bytes};
  st->used += (bytes + 255) / 256 * 256;
  return 0;
}

int cuda_store(Sim *sim, Parts *p, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const State *s = &sim->s;
  c->store->count = 0, c->store->used = 0;
#define STORE(TYPE, MEMBER, WIDTH, ...)                                                            \
  if (p->MEMBER && s->MEMBER &&                                                                    \
      stage(sim, p, p->MEMBER, s->MEMBER, WIDTH, (int)sizeof(TYPE), err))                          \
    return -1;
  ALL_FIELDS(STORE)
#undef STORE
  CHECK(cudaEventRecord(c->store->ready, c->stream));
  return launch_failed(error, err);
}

/* The widest array. */
size_t cuda_store_bytes(const Sim *sim)
{
  size_t widest = 0;
#define STORE_WIDEST(TYPE, MEMBER, WIDTH, ...)                                                     \
  widest = widest > (WIDTH) * sizeof(TYPE) ? widest : (WIDTH) * sizeof(TYPE);
  ALL_FIELDS(STORE_WIDEST)
#undef STORE_WIDEST
  return (size_t)sim->s.n * widest;
}

/* The staging buffer holds all that files have, or when memory is short the widest array. */
int cuda_store_open(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  size_t n = (size_t)sim->s.n, available = 0, total = 0, all = 0;
  if (!(c->store = (struct CudaStore *)calloc(1, sizeof *c->store)))
    return err_set(err, "not enough memory");
#define STORE_SIZE(TYPE, MEMBER, WIDTH, ...) all += n * (WIDTH) * sizeof(TYPE) + 256;
  ALL_FIELDS(STORE_SIZE)
#undef STORE_SIZE
  CHECK(cudaMemGetInfo(&available, &total));
  c->store->room = all < available / 4 ? all : cuda_store_bytes(sim);
  CHECK(cudaStreamCreateWithFlags(&c->store->stream, cudaStreamNonBlocking));
  CHECK(cudaEventCreateWithFlags(&c->store->ready, cudaEventDisableTiming));
  CHECK(cudaMallocHost((void **)&c->store->piece, PIECE));
  if (launch_failed(error, err)) return -1;
  return cuda_alloc(sim, (void **)&c->store->stage, c->store->room, err);
}

void cuda_store_close(Sim *sim)
{
  struct CudaStore *st = cuda_of(sim)->store;
  if (!st) return;
  cuda_free(st->stage);
  if (st->piece) cudaFreeHost(st->piece);
  if (st->ready) cudaEventDestroy(st->ready);
  if (st->stream) cudaStreamDestroy(st->stream);
  free(st);
}
