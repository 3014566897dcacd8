/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The passes' times for --profile: pairs of events on the stream, read when it is idle anyway. */
#include "cuda.h"

enum { SPANS = 256 };

typedef struct {
  cudaEvent_t from, to;
  int timer;
} Span;

struct CudaClock {
  Span span[SPANS];
  int count;
};

/* The clock, once it is wanted; NULL without. */
static struct CudaClock *clock_of(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  if (!sim->profile || c->clock) return c->clock;
  c->clock = (struct CudaClock *)calloc(1, sizeof *c->clock);
  for (int k = 0; k < SPANS && c->clock; k++) {
    CHECK(cudaEventCreate(&c->clock->span[k].from));
    CHECK(cudaEventCreate(&c->clock->span[k].to));
  }
  return c->clock;
}

void cuda_begin(Sim *sim, int timer)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  if (!clock_of(sim)) return;
  if (c->clock->count == SPANS) {
    CHECK(cudaStreamSynchronize(c->stream));
    cuda_clock(sim);
  }
  c->clock->span[c->clock->count].timer = timer;
  CHECK(cudaEventRecord(c->clock->span[c->clock->count].from, c->stream));
}

void cuda_end(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  if (!c->clock) return;
  CHECK(cudaEventRecord(c->clock->span[c->clock->count++].to, c->stream));
}

void cuda_clock(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  if (!c->clock || c->clock->count == 0) return;
  CHECK(cudaEventSynchronize(c->clock->span[c->clock->count - 1].to));
  for (int k = 0; k < c->clock->count; k++) {
    const Span *span = &c->clock->span[k];
    float ms = 0;
    CHECK(cudaEventElapsedTime(&ms, span->from, span->to));
    sim->timer[span->timer].spent += 1e-3 * ms;
    sim->timer[span->timer].calls++;
  }
  c->clock->count = 0;
}

void cuda_clock_close(Sim *sim)
{
  struct CudaClock *clock = cuda_of(sim)->clock;
  if (!clock) return;
  for (int k = 0; k < SPANS; k++) {
    if (clock->span[k].from) cudaEventDestroy(clock->span[k].from);
    if (clock->span[k].to) cudaEventDestroy(clock->span[k].to);
  }
  free(clock);
}
