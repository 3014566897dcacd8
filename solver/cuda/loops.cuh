/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pair loops on the device, in one precision; loops_mixed.cu and loops_double.cu say which
 * (real), how four numbers are packed (Quad) and how a vector is kept such that differences of two
 * are exact enough (Place, place_*). One thread sums over the list of one particle. What it reads
 * of a neighbour is packed once per loop into 16-byte (32-byte) records, in code units.
 *
 * Kernel, solid and miscible are literals; a line (1D) has one general instance of each loop. */
#include "loops.h"

enum { THREADS = 128 };

/* One loop's records: two vectors and up to four quads. */
typedef struct {
  Places x, v;
  Quad *q[4];
} Records;

struct CudaLoops {
  Records r;
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
  double rho, push; /* unit of density [kg/m^D]; code units a unit of State.push */
  int kern;         /* for the general instances */
} Loop;

static __device__ long self_of(void) { return (long)blockIdx.x * blockDim.x + threadIdx.x; }

static __device__ uint32_t neighbour(const Loop &a, long i, int k)
{
  return __ldg(a.list + a.start[i / CUDA_GROUP] + (int64_t)k * CUDA_GROUP + i % CUDA_GROUP);
}

/* Records for loop A: y with ha, v with the volume. */
static __global__ void pack_flow(Loop a)
{
  long i = self_of();
  const State &s = a.s;
  const double il = 1 / a.unit.length, iv = 1 / a.unit.speed, *y = &s.y[3 * i], *v = &s.v[3 * i];
  if (i >= s.n) return;
  place_set(a.r.x, i, (y[0] - a.root->origin[0]) * il, (y[1] - a.root->origin[1]) * il,
            (y[2] - a.root->origin[2]) * il, (real)(s.ha[i] * il),
            (real)(s.m[i] / s.rhoa[i] * a.rho / a.unit.mass));
  place_set(a.r.v, i, v[0] * iv, v[1] * iv, v[2] * iv, 0, 0);
}

/* Records for loop B: x with h and m; v, rho | cs, signal, p, dxx | the rest of d. */
template <int solid> static __global__ void pack_body(Loop a)
{
  long i = self_of();
  const State &s = a.s;
  const double il = 1 / a.unit.length, iv = 1 / a.unit.speed, it = iv * iv / a.rho;
  const double *x = &s.x[3 * i], *v = &s.vp[3 * i], *t = &s.t[9 * i];
  if (i >= s.n) return;
  place_set(a.r.x, i, (x[0] - a.root->origin[0]) * il, (x[1] - a.root->origin[1]) * il,
            (x[2] - a.root->origin[2]) * il, (real)(s.h[i] * il), (real)(s.m[i] / a.unit.mass));
  a.r.q[0][i] = quad(v[0] * iv, v[1] * iv, v[2] * iv, s.rho[i] / a.rho);
  a.r.q[1][i] = quad(s.cs[i] * iv, s.cl[i] * iv, s.push[i] * a.push, t[0] * it);
  if (!solid) return;
  a.r.q[2][i] = quad(t[1] * it, t[2] * it, t[3] * it, t[4] * it);
  a.r.q[3][i] = quad(t[5] * it, t[6] * it, t[7] * it, t[8] * it);
}

template <int kern, int line, int solid> static __global__ void gradient_loop(Loop a)
{
  const long i = self_of();
  const State &s = a.s;
  if (i >= s.n) return;
  const int kernel = line ? a.kern : kern, n = a.count[i];
  real hi, hj, volume, none;
  const Place xi = place_get(a.r.x, i, &hi, &volume), vi = place_get(a.r.v, i, &none, &none);
  PairGradient g = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  for (int k = 0; k < n; k++) {
    const long j = neighbour(a, i, k);
    const Place xj = place_get(a.r.x, j, &hj, &volume), vj = place_get(a.r.v, j, &none, &none);
    const PairGradient o = pair_gradient(place_between(xi, xj), place_between(vi, vj),
                                         0.5f * (hi + hj), volume, kernel, line, solid, &a.run);
    g.gxx += o.gxx;
    if (!solid) continue;
    g.gxy += o.gxy, g.gxz += o.gxz, g.gyx += o.gyx, g.gyy += o.gyy, g.gyz += o.gyz;
    g.gzx += o.gzx, g.gzy += o.gzy, g.gzz += o.gzz;
    g.mxx += o.mxx, g.mxy += o.mxy, g.mxz += o.mxz, g.myy += o.myy, g.myz += o.myz, g.mzz += o.mzz;
  }
  const double rate = a.unit.speed / a.unit.length;
  if (!solid) {
    s.divv[i] = rate * g.gxx;
  } else {
    const double raw[9] = {rate * g.gxx, rate * g.gxy, rate * g.gxz, rate * g.gyx, rate * g.gyy,
                           rate * g.gyz, rate * g.gzx, rate * g.gzy, rate * g.gzz};
    const Sym m = {g.mxx, g.mxy, g.mxz, g.myy, g.myz, g.mzz};
    pass_correct(&s, i, raw, m);
  }
}

/* The record of particle i for loop B; *at and the mass come with its place. */
template <int solid> static __device__ PairBody body_get(const Records &r, long i, Place *at)
{
  PairBody b;
  *at = place_get(r.x, i, &b.h, &b.m);
  const Quad p = quad_get(r.q[0] + i), q = quad_get(r.q[1] + i);
  b.vx = p.x, b.vy = p.y, b.vz = p.z, b.rho = p.w;
  b.cs = q.x, b.signal = q.y, b.p = q.z, b.dxx = q.w;
  b.inverse_rho = solid ? 1 / b.rho : 0;
  if (solid) {
    const Quad u = quad_get(r.q[2] + i), w = quad_get(r.q[3] + i);
    b.dxy = u.x, b.dxz = u.y, b.dyx = u.z, b.dyy = u.w;
    b.dyz = w.x, b.dzx = w.y, b.dzy = w.z, b.dzz = w.w;
  } else {
    b.dxy = b.dxz = b.dyx = b.dyy = b.dyz = b.dzx = b.dzy = b.dzz = 0;
  }
  return b;
}

/* Forces on pairs are equal and opposite to the last bit, and their sums are double: the momentum
 * of all is kept to rounding of double. */
template <int kern, int line, int solid, int miscible> static __global__ void force_loop(Loop a)
{
  const long i = self_of();
  const State &s = a.s;
  if (i >= s.n) return;
  const int kernel = line ? a.kern : kern, n = a.count[i];
  Place xi, xj;
  const PairBody self = body_get<solid>(a.r, i, &xi);
  double fx = 0, fy = 0, fz = 0, work = 0;
  real signal = 2 * self.signal, near = 0;
  for (int k = 0; k < n; k++) {
    const PairBody other = body_get<solid>(a.r, neighbour(a, i, k), &xj);
    const PairForce o =
        pair_force(place_between(xi, xj), &self, &other, kernel, line, solid, miscible, &a.run);
    fx += o.fx, fy += o.fy, fz += o.fz, work += o.work, near += o.near;
    signal = o.signal > signal ? o.signal : signal;
  }
  const double pull = a.unit.mass * a.unit.speed * a.unit.speed / a.unit.length / s.m[i];
  s.acc[3 * i] = fx * pull, s.acc[3 * i + 1] = fy * pull, s.acc[3 * i + 2] = fz * pull;
  s.du[i] = work * pull * a.unit.speed;
  s.signal[i] = a.unit.speed * signal;
  s.nngb[i] = (int)near;
}

/* Kernel sums: rho, delta, and rhoa, the mean of rho before and after (cpu/loops.c). */
template <int kern, int line> static __global__ void density_loop(Loop a, int miscible)
{
  const long i = self_of();
  const State &s = a.s;
  if (i >= s.n) return;
  const int kernel = line ? a.kern : kern, n = a.count[i];
  real hi, mi, hj, mj;
  const Place xi = place_get(a.r.x, i, &hi, &mi);
  const real own = pair_weight(kernel, line, &a.run, 0, hi);
  double delta = own, rho = mi * own;
  const double before = s.rho[i];
  for (int k = 0; k < n; k++) {
    const PairVector r = place_between(xi, place_get(a.r.x, neighbour(a, i, k), &hj, &mj));
    const real w = pair_weight(kernel, line, &a.run, pair_dot(r, r), 0.5f * (hi + hj));
    delta += w, rho += mj * w;
  }
  s.delta[i] = delta * a.rho / a.unit.mass;
  s.rho[i] = miscible ? s.m[i] * s.delta[i] : rho * a.rho;
  s.rhoa[i] = sqrt(before * s.rho[i]);
}

/* Places for the density sums: x with h and m. */
static __global__ void pack_places(Loop a)
{
  long i = self_of();
  const State &s = a.s;
  const double il = 1 / a.unit.length, *x = &s.x[3 * i];
  if (i >= s.n) return;
  place_set(a.r.x, i, (x[0] - a.root->origin[0]) * il, (x[1] - a.root->origin[1]) * il,
            (x[2] - a.root->origin[2]) * il, (real)(s.h[i] * il), (real)(s.m[i] / a.unit.mass));
}

/* The stamps. */
/* clang-format off */
typedef void (*Kernel1)(Loop);
typedef void (*Kernel2)(Loop, int);
#define GRADIENT_ROW(CAPITAL, ...) \
  {gradient_loop<KERNEL_##CAPITAL, 0, 0>, gradient_loop<KERNEL_##CAPITAL, 0, 1>},
#define FORCE_ROW(CAPITAL, ...) \
  {force_loop<KERNEL_##CAPITAL, 0, 0, 0>, force_loop<KERNEL_##CAPITAL, 0, 1, 0>, \
   force_loop<KERNEL_##CAPITAL, 0, 0, 1>, force_loop<KERNEL_##CAPITAL, 0, 1, 1>},
#define DENSITY_ROW(CAPITAL, ...) density_loop<KERNEL_##CAPITAL, 0>,
static const Kernel1 gradient_stamps[KERNEL_COUNT][2] = {KERNELS(GRADIENT_ROW)};
static const Kernel1 force_stamps[KERNEL_COUNT][4] = {KERNELS(FORCE_ROW)};
static const Kernel2 density_stamps[KERNEL_COUNT] = {KERNELS(DENSITY_ROW)};
static const Kernel1 gradient_line = gradient_loop<0, 1, 1>;
static const Kernel1 force_line[2] = {force_loop<0, 1, 1, 0>, force_loop<0, 1, 1, 1>};
static const Kernel2 density_line = density_loop<0, 1>;
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
  a.push = (sim->miscible ? 1 / (volume * volume) : a.rho * a.rho) /
           (a.rho * c->unit.speed * c->unit.speed);
  a.kern = sim->par.kernel;
  return a;
}

static void gradient(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const Loop a = loop_of(sim);
  const unsigned blocks = launch_blocks((size_t)sim->s.n, THREADS);
  const Kernel1 loop =
      sim->s.dimension == 1 ? gradient_line : gradient_stamps[sim->par.kernel][!!sim->solid];
  LAUNCH(pack_flow, blocks, THREADS, 0, c->stream, a);
  LAUNCH(loop, blocks, THREADS, 0, c->stream, a);
}

static void density(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const Loop a = loop_of(sim);
  const unsigned blocks = launch_blocks((size_t)sim->s.n, THREADS);
  const Kernel2 loop = sim->s.dimension == 1 ? density_line : density_stamps[sim->par.kernel];
  LAUNCH(pack_places, blocks, THREADS, 0, c->stream, a);
  LAUNCH(loop, blocks, THREADS, 0, c->stream, a, !!sim->miscible);
}

static void force(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  const Loop a = loop_of(sim);
  const unsigned blocks = launch_blocks((size_t)sim->s.n, THREADS);
  const int solid = !!sim->solid, miscible = !!sim->miscible;
  const Kernel1 loop = sim->s.dimension == 1 ? force_line[miscible]
                                             : force_stamps[sim->par.kernel][solid + 2 * miscible];
  if (solid || sim->s.dimension == 1)
    LAUNCH(pack_body<1>, blocks, THREADS, 0, c->stream, a);
  else
    LAUNCH(pack_body<0>, blocks, THREADS, 0, c->stream, a);
  LAUNCH(loop, blocks, THREADS, 0, c->stream, a);
}

static size_t bytes(const Sim *sim)
{
  const size_t quads = sim->solid || sim->s.dimension == 1 ? 4 : 2;
  return (size_t)sim->s.n * (2 * PLACE_BYTES + quads * sizeof(Quad));
}

static int loops_open(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  const size_t n = (size_t)sim->s.n;
  const int quads = sim->solid || sim->s.dimension == 1 ? 4 : 2;
  c->loops = (struct CudaLoops *)calloc(1, sizeof *c->loops);
  if (!c->loops) return err_set(err, "not enough memory");
  if (places_alloc(sim, &c->loops->r.x, n, err) || places_alloc(sim, &c->loops->r.v, n, err))
    return -1;
  for (int k = 0; k < quads; k++)
    if (cuda_alloc(sim, (void **)&c->loops->r.q[k], n * sizeof(Quad), err)) return -1;
  return 0;
}

static void loops_close(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  if (!c->loops) return;
  places_free(&c->loops->r.x), places_free(&c->loops->r.v);
  for (int k = 0; k < 4; k++) cuda_free(c->loops->r.q[k]);
  free(c->loops);
  c->loops = NULL;
}
