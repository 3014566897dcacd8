/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state on its way to the host. Kernels put the arrays into row order in a staging buffer on
 * the card; from there a second stream brings them over in pinned pieces while the run goes on.
 * Where memory is not ample the buffer takes 8 bytes a particle at a time, some rows of an array,
 * and the run waits for all but the last of it. */
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

/* Element k of particle i to its place among rows first .. first + rows - 1 of the file. */
template <class T>
static __global__ void store_rows(long n, int width, const int64_t *row, const T *from, long first,
                                  long rows, T *to)
{
  const long e = (long)blockIdx.x * blockDim.x + threadIdx.x, i = e / width;
  const long at = i < n ? row[i] - first : -1;
  if (at >= 0 && at < rows) to[at * width + e % width] = from[e];
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

/* Rows of an array into the staging buffer: `rows` from `first` on. */
static void stage_rows(Sim *sim, void *to, const void *from, int width, int size, long first,
                       long rows)
{
  Cuda *c = cuda_of(sim);
  struct CudaStore *st = c->store;
  CudaError *error = &c->error;
  const long n = sim->s.n;
  const unsigned blocks = launch_blocks((size_t)n * (size_t)width, 256);
  const size_t row = (size_t)width * (size_t)size, bytes = (size_t)rows * row;
  char *place = st->stage + st->used;
  if (size == 8)
    LAUNCH(store_rows<uint64_t>, blocks, 256, 0, c->stream, n, width, sim->s.row,
           (const uint64_t *)from, first, rows, (uint64_t *)place);
  else
    LAUNCH(store_rows<uint32_t>, blocks, 256, 0, c->stream, n, width, sim->s.row,
           (const uint32_t *)from, first, rows, (uint32_t *)place);
  st->staged[st->count++] = {(char *)to + (size_t)first * row, st->used, bytes};
  st->used += (bytes + 255) / 256 * 256;
}

/* One array into the staging buffer, which is emptied whenever it is full. */
static int stage(Sim *sim, Parts *p, void *to, const void *from, int width, int size, Err *err)
{
  Cuda *c = cuda_of(sim);
  struct CudaStore *st = c->store;
  CudaError *error = &c->error;
  const size_t row = (size_t)width * (size_t)size;
  for (long first = 0, rows; first < sim->s.n; first += rows) {
    const long left = sim->s.n - first;
    if (st->used + (size_t)left * row > st->room && st->used) {
      CHECK(cudaEventRecord(st->ready, c->stream));
      if (cuda_fetch(sim, p, err)) return -1;
    }
    const long fit = (long)((st->room - st->used) / row);
    rows = left < fit ? left : fit;
    stage_rows(sim, to, from, width, size, first, rows);
  }
  return launch_failed(error, err);
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

/* The staging buffer holds all that files have, or 8 bytes a particle. */
size_t cuda_store_bytes(Sim *sim)
{
  const size_t n = (size_t)sim->s.n;
  size_t all = 0;
#define STORE_SIZE(TYPE, MEMBER, WIDTH, ...)                                                       \
  if (!backend_idle(sim, #MEMBER)) all += n * (WIDTH) * sizeof(TYPE) + 256;
  ALL_FIELDS(STORE_SIZE)
#undef STORE_SIZE
  return cuda_of(sim)->ample ? all : n * 8 + 256;
}

int cuda_store_open(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  if (!(c->store = (struct CudaStore *)calloc(1, sizeof *c->store)))
    return err_set(err, "not enough memory");
  c->store->room = cuda_store_bytes(sim);
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
