/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pair loops on the device, in one precision; loops_mixed.cu and loops_double.cu say which
 * (real), how four numbers are packed (Quad) and how a vector is kept such that differences of two
 * are exact enough (Place, place_*). One thread sums over the list of one particle; lists of more
 * than CROWD entries are left to a second kernel in which a warp shares them, so that a few very
 * long ones do not hold up all others. What is read of a neighbour is packed once per loop into
 * 16-byte (32-byte) records, in code units.
 *
 * Kernel, solid and miscible are literals; a line (1D) has one general instance of each loop.
 * Loop B of runs with more pair terms (pair_rich.h) is one of its own, with six quads. */
#include "loops.h"

enum { THREADS = 128, CROWD = 128 };

/* The records: loop A's are x and v, loop B's x and up to six quads, where v is otherwise. */
typedef struct {
  Places x, v;
  Quad *q[6];
} Records;

struct CudaLoops {
  Records r;
  char *room; /* all of them */
};

/* What every kernel of a loop needs. */
typedef struct {
  State s;
  Records r;
  const int64_t *start;
  const int *count;
  const uint32_t *list;
  PairRun run;
  const Root *root;
  Units unit;
  double rho;           /* unit of density [kg/m^D] */
  double push, shear;   /* code units a unit of State.push, of State.t */
  double volume, share; /* code units a unit of passes_volume; of passes_share, in that unit */
  int kern, miscible;   /* for the general instances; the form of the density */
  PairMore more;
  double xsph, diffusion;
  Grad grad;
  int newton; /* h goes on after these sums (grad.h) */
} Loop;

static __device__ long self_of(void) { return (long)blockIdx.x * blockDim.x + threadIdx.x; }

/* The list of particle i; its entry k. */
static __device__ const uint32_t *list_of(const Loop &a, long i)
{
  return a.list + a.start[i / CUDA_GROUP] + i % CUDA_GROUP;
}

static __device__ long neighbour(const uint32_t *list, int k)
{
  return __ldg(list + (int64_t)k * CUDA_GROUP);
}

/* A vector of the owner of row i, as it is seen there. */
static __device__ __forceinline__ void seen(const State &s, long i, const double *v, double w[3])
{
  image_signs(&s, i, w);
#pragma unroll
  for (int d = 0; d < 3; d++) w[d] *= v[d];
}

#include "pack.cuh"

template <class T> static __device__ __forceinline__ T from_lane(T x, int k)
{
  return __shfl_xor_sync(~0u, x, k);
}

static __device__ __forceinline__ PairGradient add_two(PairGradient a, PairGradient b)
{
  a.gxx += b.gxx, a.gxy += b.gxy, a.gxz += b.gxz, a.gyx += b.gyx, a.gyy += b.gyy, a.gyz += b.gyz;
  a.gzx += b.gzx, a.gzy += b.gzy, a.gzz += b.gzz;
  a.mxx += b.mxx, a.mxy += b.mxy, a.mxz += b.mxz, a.myy += b.myy, a.myz += b.myz, a.mzz += b.mzz;
  a.spread += b.spread;
  return a;
}

static __device__ __forceinline__ void scale(PairGradient *a, real w)
{
  a->gxx *= w, a->gxy *= w, a->gxz *= w, a->gyx *= w, a->gyy *= w, a->gyz *= w;
  a->gzx *= w, a->gzy *= w, a->gzz *= w;
  a->mxx *= w, a->mxy *= w, a->mxz *= w, a->myy *= w, a->myz *= w, a->mzz *= w;
}

/* Each lane adds what the lane with the other bit k has. */
static __device__ __forceinline__ void add_from(PairGradient *a, int k)
{
  const PairGradient b = {
      from_lane(a->gxx, k), from_lane(a->gxy, k), from_lane(a->gxz, k), from_lane(a->gyx, k),
      from_lane(a->gyy, k), from_lane(a->gyz, k), from_lane(a->gzx, k), from_lane(a->gzy, k),
      from_lane(a->gzz, k), from_lane(a->mxx, k), from_lane(a->mxy, k), from_lane(a->mxz, k),
      from_lane(a->myy, k), from_lane(a->myz, k), from_lane(a->mzz, k), from_lane(a->spread, k)};
  *a = add_two(*a, b);
}

/* A loop is a struct with two functions: sum, over entries from, from + step, ... of the list of i,
 * and keep, which makes of the whole sum what the loop is for. */
/* weighted: passes_share is not 1. */
template <int kern, int line, int solid, int weighted> struct Gradient {
  typedef PairGradient Sum;

  static __device__ __forceinline__ PairGradient sum(const Loop &a, long i, int from, int step)
  {
    const int n = a.count[i];
    const uint32_t *list = list_of(a, i);
    real hi, hj, volume, none;
    const Place xi = place_get(a.r.x, i, &hi, &none), vi = place_get(a.r.v, i, &volume, &none);
    PairGradient g = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    for (int k = from; k < n; k += step) {
      const long j = neighbour(list, k);
      const Place xj = place_get(a.r.x, j, &hj, &none), vj = place_get(a.r.v, j, &volume, &none);
      const PairGradient o =
          pair_gradient(place_between(xi, xj), place_between(vi, vj), 0.5f * (hi + hj), volume,
                        line ? a.kern : kern, line, solid, &a.run);
      if (solid)
        g = add_two(g, o);
      else
        g.gxx += o.gxx;
    }
    return g;
  }

  static __device__ __forceinline__ void keep(const Loop &a, long i, PairGradient g)
  {
    const double rate = a.unit.speed / a.unit.length;
    if (weighted) scale(&g, (real)(passes_share(&a.s, i) * a.share));
    if (!solid) {
      a.s.divv[i] = rate * g.gxx;
    } else {
      const double raw[9] = {rate * g.gxx, rate * g.gxy, rate * g.gxz, rate * g.gyx, rate * g.gyy,
                             rate * g.gyz, rate * g.gzx, rate * g.gzy, rate * g.gzz};
      const real w = pair_wide(g.spread);
      const Sym m = {w * g.mxx, w * g.mxy, w * g.mxz, w * g.myy, w * g.myz, w * g.mzz};
      pass_correct(&a.s, i, raw, m);
    }
  }
};

/* The record of particle i for loop B; *at and the mass come with its place. */
template <int solid> static __device__ PairBody body_get(const Records &r, long i, Place *at)
{
  PairBody b;
  *at = place_get(r.x, i, &b.h, &b.m);
  const Quad p = quad_get(r.q[0], i), q = quad_get(r.q[1], i);
  b.vx = p.x, b.vy = p.y, b.vz = p.z, b.rho = p.w;
  b.cs = q.x, b.signal = q.y, b.p = q.z, b.dxx = solid ? q.w : 0;
  b.inverse_rho = solid ? real_inverse(b.rho) : q.w;
  if (solid) {
    const Quad u = quad_get(r.q[2], i), w = quad_get(r.q[3], i);
    b.dxy = u.x, b.dxz = u.y, b.dyx = u.z, b.dyy = u.w;
    b.dyz = w.x, b.dzx = w.y, b.dzy = w.z, b.dzz = w.w;
  } else {
    b.dxy = b.dxz = b.dyx = b.dyy = b.dyz = b.dzx = b.dzy = b.dzz = 0;
  }
  return b;
}

/* Forces on pairs are equal and opposite to the last bit, and their sums are double: the momentum
 * of all is kept to rounding of double. */
typedef struct {
  double fx, fy, fz, work;
  real signal, near;
} Forces;

static __device__ __forceinline__ Forces add_two(Forces a, Forces b)
{
  a.fx += b.fx, a.fy += b.fy, a.fz += b.fz, a.work += b.work, a.near += b.near;
  a.signal = b.signal > a.signal ? b.signal : a.signal;
  return a;
}

static __device__ __forceinline__ void add_from(Forces *a, int k)
{
  const Forces b = {from_lane(a->fx, k),   from_lane(a->fy, k),     from_lane(a->fz, k),
                    from_lane(a->work, k), from_lane(a->signal, k), from_lane(a->near, k)};
  *a = add_two(*a, b);
}

template <int kern, int line, int solid, int miscible> struct Force {
  typedef Forces Sum;

  static __device__ __forceinline__ Forces sum(const Loop &a, long i, int from, int step)
  {
    const int n = a.count[i];
    const uint32_t *list = list_of(a, i);
    Place xi, xj;
    const PairBody self = body_get<solid>(a.r, i, &xi);
    Forces f = {0, 0, 0, 0, 2 * self.signal, 0};
    for (int k = from; k < n; k += step) {
      const PairBody other = body_get<solid>(a.r, neighbour(list, k), &xj);
      const PairForce o = pair_force(place_between(xi, xj), &self, &other, line ? a.kern : kern,
                                     line, solid, miscible, &a.run);
      const Forces one = {o.fx, o.fy, o.fz, o.work, o.signal, o.near};
      f = add_two(f, one);
    }
    return f;
  }

  static __device__ __forceinline__ void keep(const Loop &a, long i, Forces f)
  {
    const State &s = a.s;
    const double pull = a.unit.mass * a.unit.speed * a.unit.speed / a.unit.length / s.m[i];
    s.acc[3 * i] = f.fx * pull, s.acc[3 * i + 1] = f.fy * pull, s.acc[3 * i + 2] = f.fz * pull;
    s.du[i] = f.work * pull * a.unit.speed;
    s.signal[i] = a.unit.speed * f.signal;
    s.nngb[i] = (int)f.near;
  }
};

typedef struct {
  Forces f;
  double wx, wy, wz, sense, rate;
} Riches;

static __device__ __forceinline__ Riches add_two(Riches a, Riches b)
{
  a.f = add_two(a.f, b.f), a.wx += b.wx, a.wy += b.wy, a.wz += b.wz;
  a.sense += b.sense, a.rate += b.rate;
  return a;
}

static __device__ __forceinline__ void add_from(Riches *a, int k)
{
  add_from(&a->f, k);
  a->wx += from_lane(a->wx, k), a->wy += from_lane(a->wy, k), a->wz += from_lane(a->wz, k);
  a->sense += from_lane(a->sense, k), a->rate += from_lane(a->rate, k);
}

static __device__ PairExtra extra_get(const Records &r, long i)
{
  const Quad p = quad_get(r.q[4], i), q = quad_get(r.q[5], i);
  const PairExtra e = {p.x, p.y, p.z, p.w, q.x, q.y, q.z, q.w};
  return e;
}

template <int kern, int line, int grad> struct Richly {
  typedef Riches Sum;

  static __device__ __forceinline__ Riches sum(const Loop &a, long i, int from, int step)
  {
    const int n = a.count[i];
    const uint32_t *list = list_of(a, i);
    Place xi, xj;
    const PairBody self = body_get<1>(a.r, i, &xi);
    const PairExtra mine = extra_get(a.r, i);
    Riches f = {{0, 0, 0, 0, 2 * self.signal, 0}, 0, 0, 0, 0, 0};
    for (int k = from; k < n; k += step) {
      const long j = neighbour(list, k);
      const PairBody other = body_get<1>(a.r, j, &xj);
      const PairExtra its = extra_get(a.r, j);
      const PairRich o =
          pair_rich(place_between(xi, xj), &self, &other, &mine, &its, line ? a.kern : kern, line,
                    line ? a.more.grad : grad, &a.run, &a.more);
      const Riches one = {{o.f.fx, o.f.fy, o.f.fz, o.f.work, o.f.signal, o.f.near},
                          o.wx,
                          o.wy,
                          o.wz,
                          o.sense,
                          o.rate};
      f = add_two(f, one);
    }
    return f;
  }

  static __device__ __forceinline__ void keep(const Loop &a, long i, Riches f)
  {
    const State &s = a.s;
    const double moved = a.xsph * a.unit.mass * a.unit.speed / s.m[i], part = passes_part(&s, i);
    real h, m;
    Force<kern, line, 1, 0>::keep(a, i, f.f);
    if (s.wander)
      s.wander[3 * i] = moved * f.wx, s.wander[3 * i + 1] = moved * f.wy,
                   s.wander[3 * i + 2] = moved * f.wz;
    if (s.drho) s.drho[i] = a.diffusion * part * f.rate * a.rho * a.unit.speed / a.unit.length;
    if (!s.sense) return;
    place_get(a.r.x, i, &h, &m);
    const real own = m * pair_weight(line ? a.kern : kern, line, &a.run, 0, h);
    s.sense[i] = (f.sense + (s.divv[i] < 0 ? -own : own)) * part * a.rho / s.rho[i];
  }
};

#include "sums.cuh"

/* A thread a particle. */
template <class Of> static __global__ void each(Loop a)
{
  const long i = self_of();
  if (i < a.s.n && a.count[i] <= CROWD) Of::keep(a, i, Of::sum(a, i, 0, 1));
}

/* A warp a particle, where lists are long. */
template <class Of> static __global__ void crowded(Loop a)
{
  const long i = self_of(), first = i - i % 32;
  const int lane = (int)(i % 32);
  unsigned left = __ballot_sync(~0u, i < a.s.n && a.count[i] > CROWD);
  for (; left; left &= left - 1) {
    const int owner = __ffs((int)left) - 1;
    typename Of::Sum sum = Of::sum(a, first + owner, lane, 32);
    for (int k = 16; k > 0; k /= 2) add_from(&sum, k);
    if (lane == owner) Of::keep(a, i, sum);
  }
}

/* The stamps: the kernel for most particles, and that for the crowded. */
/* clang-format off */
typedef void (*Run)(Loop);
typedef struct {
  Run each, crowded;
} Stamp;
#define STAMP(...) {each<__VA_ARGS__>, crowded<__VA_ARGS__>}
#define GRADIENT_ROW(CAPITAL, ...) \
  {STAMP(Gradient<KERNEL_##CAPITAL, 0, 0, 0>), STAMP(Gradient<KERNEL_##CAPITAL, 0, 1, 0>), \
   STAMP(Gradient<KERNEL_##CAPITAL, 0, 0, 1>), STAMP(Gradient<KERNEL_##CAPITAL, 0, 1, 1>)},
#define FORCE_ROW(CAPITAL, ...) \
  {STAMP(Force<KERNEL_##CAPITAL, 0, 0, 0>), STAMP(Force<KERNEL_##CAPITAL, 0, 1, 0>), \
   STAMP(Force<KERNEL_##CAPITAL, 0, 0, 1>), STAMP(Force<KERNEL_##CAPITAL, 0, 1, 1>)},
#define RICH_ROW(CAPITAL, ...) \
  {STAMP(Richly<KERNEL_##CAPITAL, 0, 0>), STAMP(Richly<KERNEL_##CAPITAL, 0, 1>)},
#define GRAD_ROW(CAPITAL, ...)    STAMP(Graduals<KERNEL_##CAPITAL, 0>),
#define DENSITY_ROW(CAPITAL, ...) STAMP(Densities<KERNEL_##CAPITAL, 0>),
#define THETA_ROW(CAPITAL, ...)   STAMP(Thetas<KERNEL_##CAPITAL, 0>),
static const Stamp gradient_stamps[KERNEL_COUNT][4] = {KERNELS(GRADIENT_ROW)};
static const Stamp force_stamps[KERNEL_COUNT][4] = {KERNELS(FORCE_ROW)};
static const Stamp rich_stamps[KERNEL_COUNT][2] = {KERNELS(RICH_ROW)};
static const Stamp density_stamps[KERNEL_COUNT] = {KERNELS(DENSITY_ROW)};
static const Stamp theta_stamps[KERNEL_COUNT] = {KERNELS(THETA_ROW)};
static const Stamp gradient_line = STAMP(Gradient<0, 1, 1, 1>);
static const Stamp force_line[2] = {STAMP(Force<0, 1, 1, 0>), STAMP(Force<0, 1, 1, 1>)};
static const Stamp rich_line = STAMP(Richly<0, 1, 0>);
static const Stamp density_line = STAMP(Densities<0, 1>);
static const Stamp grad_stamps[KERNEL_COUNT] = {KERNELS(GRAD_ROW)};
static const Stamp grad_line = STAMP(Graduals<0, 1>);
static const Stamp theta_line = STAMP(Thetas<0, 1>);
/* clang-format on */

static Loop loop_of(const Sim *sim)
{
  const Cuda *c = cuda_of(sim);
  const int d = sim->s.dimension;
  const double volume = d == 3   ? c->unit.length * c->unit.length * c->unit.length
                        : d == 2 ? c->unit.length * c->unit.length
                                 : c->unit.length;
  Loop a;
  memset(&a, 0, sizeof a);
  a.s = sim->s, a.r = c->loops->r, a.run = c->run, a.root = c->root, a.unit = c->unit;
  a.start = c->lists.start, a.count = c->lists.count, a.list = c->lists.list;
  a.rho = c->unit.mass / volume;
  a.push = (sim->miscible   ? 1 / (volume * volume)
            : a.run.volumes ? 1
                            : a.rho * a.rho) /
           (a.rho * c->unit.speed * c->unit.speed);
  a.shear = (sim->more.squares  ? a.rho * a.rho
             : a.run.integrated ? 1 / (volume * volume)
                                : 1) /
            (a.rho * c->unit.speed * c->unit.speed);
  a.volume = a.run.integrated ? 1 : 1 / volume, a.share = a.run.integrated ? 1 / volume : 1;
  a.more = sim->more, a.xsph = sim->par.xsph, a.diffusion = sim->par.diffusion;
  for (int k = 0; k < 3; k++) a.more.g[k] *= c->unit.length / (c->unit.speed * c->unit.speed);
  a.grad = backend_grad(sim);
  a.kern = sim->par.kernel, a.miscible = !!sim->miscible;
  return a;
}

static void run_as(Sim *sim, const Loop a, Run pack, const Stamp *loop)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const unsigned blocks = launch_blocks((size_t)sim->s.n, THREADS);
  LAUNCH(pack, launch_blocks((size_t)sim->s.all, THREADS), THREADS, 0, c->stream, a);
  LAUNCH(loop->each, blocks, THREADS, 0, c->stream, a);
  LAUNCH(loop->crowded, blocks, THREADS, 0, c->stream, a);
}

static void run_loop(Sim *sim, Run pack, const Stamp *loop)
{
  run_as(sim, loop_of(sim), pack, loop);
}

static void gradient(Sim *sim)
{
  const int weighted = sim->s.integrated || sim->s.theta;
  if (sim->s.theta)
    run_loop(sim, pack_volumes,
             sim->s.dimension == 1 ? &theta_line : &theta_stamps[sim->par.kernel]);
  run_loop(sim, pack_flow,
           sim->s.dimension == 1 ? &gradient_line
                                 : &gradient_stamps[sim->par.kernel][!!sim->tensor + 2 * weighted]);
}

static void density(Sim *sim)
{
  const int line = sim->s.dimension == 1, kern = sim->par.kernel;
  Loop a = loop_of(sim);
  if (!sim->s.omega)
    return run_as(sim, a, pack_places, line ? &density_line : &density_stamps[kern]);
  for (int sum = 1; sum <= GRAD_SUMS; sum++) {
    a.newton = sum < GRAD_SUMS;
    run_as(sim, a, pack_places, line ? &grad_line : &grad_stamps[kern]);
  }
}

static void force(Sim *sim)
{
  const int line = sim->s.dimension == 1, solid = !!sim->tensor, miscible = !!sim->miscible;
  if (sim->rich)
    return run_loop(sim, pack_rich,
                    line ? &rich_line : &rich_stamps[sim->par.kernel][sim->more.grad]);
  run_loop(sim, solid || line ? pack_body<1> : pack_body<0>,
           line ? &force_line[miscible] : &force_stamps[sim->par.kernel][solid + 2 * miscible]);
}

/* Where arrays of one quad a particle may begin. */
static size_t rows_of(const Sim *sim) { return ((size_t)sim->s.room + 31) / 32 * 32; }

static size_t bytes(const Sim *sim)
{
  const int line = sim->s.dimension == 1;
  const size_t quads = (sim->rich             ? 6
                        : sim->tensor || line ? 4
                                              : 2) *
                       sizeof(Quad),
               place = PLACE_BYTES;
  return rows_of(sim) * (place + (quads > place ? quads : place));
}

static int loops_open(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  const size_t n = rows_of(sim);
  c->loops = (struct CudaLoops *)calloc(1, sizeof *c->loops);
  if (!c->loops) return err_set(err, "not enough memory");
  if (cuda_alloc(sim, (void **)&c->loops->room, bytes(sim), err)) return -1;
  Records *r = &c->loops->r;
  char *second = c->loops->room + n * PLACE_BYTES;
  r->x = places_at(c->loops->room, n), r->v = places_at(second, n);
  for (int k = 0; k < 6; k++) r->q[k] = (Quad *)second + (size_t)k * n;
  return 0;
}

static void loops_close(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  if (!c->loops) return;
  cuda_free(c->loops->room);
  free(c->loops);
  c->loops = NULL;
}
