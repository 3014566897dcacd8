/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The CUDA backend: opening a card, the stamps of the per-particle passes, the order of the parts.
 * Work is queued on one stream; the host waits for the list's length and for the step's limits. */
#include "cuda.h"

/* Whether a step asks for none of the terms that few runs have; without: one that does not. */
static int plain(const Step *k)
{
  return !k->rich && !k->viscous && k->deposit.rate == 0 && !k->more.viscosity;
}

static __device__ __forceinline__ Step without(Step k)
{
  k.rich = k.viscous = k.more.viscosity = 0, k.deposit.rate = 0;
  return k;
}

/* A kernel a pass; and, for runs without rare laws and such terms, one without their code, which
 * takes half as many registers again. Parameters stay where they are: what is called, not inlined,
 * would need a copy of them for each thread, 2 kB to write and read. */
#define CUDA_PASS(CAPITAL, NAME)                                                                   \
  static __global__ void pass_##NAME##_all(const __grid_constant__ State s,                        \
                                           const __grid_constant__ Step k)                         \
  {                                                                                                \
    long i = (long)blockIdx.x * blockDim.x + threadIdx.x;                                          \
    if (i < s.n) pass_##NAME(&s, &k, i);                                                           \
  }
PASSES(CUDA_PASS)
#undef CUDA_PASS
#define CUDA_PASS(CAPITAL, NAME)                                                                   \
  static __global__ void pass_##NAME##_common(State s, const Step given)                           \
  {                                                                                                \
    long i = (long)blockIdx.x * blockDim.x + threadIdx.x;                                          \
    const Step k = without(given);                                                                 \
    s.rare = 0;                                                                                    \
    if (i < s.n) pass_##NAME(&s, &k, i);                                                           \
  }
PASSES_EOS(CUDA_PASS)
#undef CUDA_PASS

static void cuda_pass(Sim *sim, int pass, const Step *step)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const unsigned block = 128, grid = launch_blocks((size_t)sim->s.n, block);
  points_pass(sim, pass, step);
  cuda_begin(sim, TIMER_LOCAL);
  switch (pass + (pass >= PASS_EOS_FIRST && !sim->rare && plain(step) ? PASS_COUNT : 0)) {
#define CUDA_PASS(CAPITAL, NAME)                                                                   \
  case PASS_##CAPITAL: LAUNCH(pass_##NAME##_all, grid, block, 0, c->stream, sim->s, *step); break;
    PASSES(CUDA_PASS)
#undef CUDA_PASS
#define CUDA_PASS(CAPITAL, NAME)                                                                   \
  case PASS_##CAPITAL + PASS_COUNT:                                                                \
    LAUNCH(pass_##NAME##_common, grid, block, 0, c->stream, sim->s, *step);                        \
    break;
    PASSES_EOS(CUDA_PASS)
#undef CUDA_PASS
  default: break;
  }
  cuda_end(sim);
}

static int cuda_cards(void)
{
  int n = 0;
  return cudaGetDeviceCount(&n) == cudaSuccess ? n : 0;
}

size_t cuda_bytes(Sim *sim, const Parts *p)
{
  return cuda_state_bytes(sim, p) + cuda_store_bytes(sim) + cuda_order_bytes(sim) +
         cuda_images_bytes(sim) + cuda_tree_bytes(sim) + cuda_lists_bytes(sim, p) +
         cuda_loops_bytes(sim) + cuda_gravity_bytes(sim) + cuda_reduce_bytes();
}

/* The card by name, and whether the particles fit; a little is left for what is not counted. */
static int look_at_card(Sim *sim, const Parts *p, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const size_t rest = (size_t)1 << 27;
  cudaDeviceProp card;
  size_t available = 0, total = 0, need, each;
  int driver = 0;
  memset(&card, 0, sizeof card);
  CHECK(cudaGetDeviceProperties(&card, sim->card));
  CHECK(cudaDriverGetVersion(&driver));
  CHECK(cudaMemGetInfo(&available, &total));
  c->ample = 1, need = cuda_bytes(sim, p);
  if (need > available / 2) c->ample = 0, need = cuda_bytes(sim, p);
  if (launch_failed(error, err)) return -1;
  each = need / (size_t)p->n + 1;
  snprintf(sim->about, sizeof sim->about,
           "cuda:%d, %.100s (compute %d.%d, driver %d.%d), %.4g of %.4g GB, %zu B a particle",
           sim->card, card.name, card.major, card.minor, driver / 1000, driver % 1000 / 10,
           1e-9 * (double)need, 1e-9 * (double)total, each);
  available = available > rest ? available - rest : 0;
  if (need <= available) return 0;
  return err_set(err,
                 "%ld particles do not fit on card %d: they need %.4g GB (%zu B each), %.4g GB are "
                 "free, enough for %zu",
                 p->n, sim->card, 1e-9 * (double)need, each, 1e-9 * (double)available,
                 available / each);
}

static void cuda_close(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  if (!c) return;
  if (c->stream) cudaStreamSynchronize(c->stream);
  cuda_reduce_close(sim), cuda_gravity_close(sim), cuda_loops_close(sim), cuda_lists_close(sim);
  cuda_tree_close(sim), cuda_images_close(sim), cuda_order_close(sim), cuda_clock_close(sim),
      cuda_store_close(sim);
  cuda_state_close(sim);
  if (c->stream) cudaStreamDestroy(c->stream);
  free(c);
  sim->own = NULL;
  memset(&sim->s, 0, sizeof sim->s);
}

static int cuda_open(Sim *sim, const Parts *p, Err *err)
{
  Cuda *c = (Cuda *)calloc(1, sizeof *c);
  if (!c) return err_set(err, "not enough memory");
  CudaError *error = &c->error;
  sim->own = c;
  memset(&sim->s, 0, sizeof sim->s);
  sim->s.n = sim->s.all = p->n, sim->s.room = cuda_images_room(sim, p);
  sim->s.bounds = sim->bounds, sim->s.dimension = p->dimension, sim->s.rare = sim->rare;
  backend_range(sim);
  CHECK(cudaSetDevice(sim->card));
  CHECK(cudaStreamCreateWithFlags(&c->stream, cudaStreamNonBlocking));
  if (!launch_failed(error, err) && !look_at_card(sim, p, err) && !cuda_state_open(sim, p, err) &&
      !cuda_order_open(sim, err) && !cuda_images_open(sim, err) && !cuda_tree_open(sim, err) &&
      !cuda_lists_open(sim, err) && !cuda_loops_open(sim, err) && !cuda_gravity_open(sim, err) &&
      !cuda_reduce_open(sim, err) && !cuda_store_open(sim, err))
    return 0;
  cuda_close(sim);
  return -1;
}

static int cuda_search(Sim *sim, Err *err)
{
  int bad;
  cuda_begin(sim, TIMER_ORDER);
  bad = cuda_order(sim, err) || cuda_tree(sim, err);
  cuda_end(sim);
  if (bad) return -1;
  cuda_begin(sim, TIMER_SEARCH);
  bad = cuda_lists(sim, err);
  cuda_end(sim);
  return bad;
}

static void timed_gradient(Sim *sim)
{
  cuda_begin(sim, TIMER_A), cuda_gradient(sim), cuda_end(sim);
}

static void timed_density(Sim *sim)
{
  cuda_begin(sim, TIMER_DENSITY), cuda_density(sim), cuda_end(sim);
}

static void timed_force(Sim *sim) { cuda_begin(sim, TIMER_B), cuda_force(sim), cuda_end(sim); }

static int timed_gravity(Sim *sim, Err *err)
{
  int bad = 0;
  if (sim->par.gravity == PARAM_NONE && !sim->points.n) return 0;
  cuda_begin(sim, TIMER_GRAVITY);
  if (sim->par.gravity != PARAM_NONE) bad = cuda_gravity(sim, err);
  bad = bad || points_exchange(sim, err);
  cuda_end(sim);
  return bad ? -1 : 0;
}

static int pull_and_reaction(Sim *sim, const PointField *field, PointReaction *reaction, Err *err)
{
  cuda_points(sim, field);
  return cuda_reaction(sim, field, reaction, err);
}

static int timed_limits(Sim *sim, const Step *step, Limits *out, Err *err)
{
  int bad;
  cuda_begin(sim, TIMER_REDUCE), bad = cuda_limits(sim, step, out, err), cuda_end(sim);
  cuda_clock(sim);
  return bad;
}

/* clang-format off */
extern "C" const struct backend backend_cuda = {
  "cuda", cuda_cards, cuda_open, cuda_close, cuda_store, cuda_fetch, cuda_copy, cuda_search, cuda_pass,
  timed_gradient, timed_density, timed_force, timed_gravity, cuda_leaving, cuda_keep, pull_and_reaction,
  timed_limits, cuda_sums, cuda_bodies, cuda_change, cuda_error};
/* clang-format on */
