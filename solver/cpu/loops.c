/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pair loops on the host. For each particle the neighbours' records are packed into short
 * arrays, one a member, over which the shared pair function is vectorised. Kernel, dimension class,
 * solid and miscible are literals of the stamped loops. */
#include <stdlib.h>
#include "../image.h"
#include "cpu.h"

enum { ROOM = 64 }; /* neighbours that a pack holds at first; it grows */

/* Columns of doubles, one per member of a pair record. */
typedef struct {
  double *column; /* [columns][room] */
  long room;
} Pack;

static double *pack_reserve(Pack *p, long n, int columns)
{
  if (n > p->room) {
    p->room = n + ROOM;
    free(p->column);
    p->column = malloc(sizeof(double) * (size_t)p->room * (size_t)columns);
    if (!p->column) abort(); /* a few kB */
  }
  return p->column;
}

/* What loop A reads of a particle, and loop B. */
typedef struct {
  double x, y, z, vx, vy, vz, h, volume;
} Flow;
typedef struct {
  double x, y, z;
  PairBody b;
} Body;
typedef struct {
  Body b;
  PairExtra e;
} Whole;
enum { WHOLE = sizeof(Whole) / sizeof(double) };
enum { FLOW = sizeof(Flow) / sizeof(double), BODY = sizeof(Body) / sizeof(double) };

/* Row i: a particle or an image. */
static Flow flow_of(const State *s, long i)
{
  const long o = image_owner(s, i);
  const double *y = &s->y[3 * i], *v = &s->v[3 * o];
  double w[3];
  image_signs(s, i, w);
  Flow f = {y[0], y[1], y[2], w[0] * v[0], w[1] * v[1], w[2] * v[2], s->ha[o], passes_volume(s, o)};
  return f;
}

/* Inline: as a call it costs a tenth of the step. */
static inline __attribute__((always_inline)) Body body_of(const State *s, long i)
{
  const double *x = &s->x[3 * i];
  double w[3];
  Body b = {x[0], x[1], x[2], passes_body(s, image_owner(s, i))};
  if (i < s->n) return b;
  image_signs(s, i, w);
  passes_turn_body(&b.b, w);
  return b;
}

static Whole whole_of(const State *s, long i)
{
  const double *e = &s->extra[PAIR_EXTRA * image_owner(s, i)];
  double w[3];
  image_signs(s, i, w);
  Whole o = {
      body_of(s, i),
      {e[0], e[1], e[2], w[0] * w[1] * e[3], w[0] * w[2] * e[4], e[5], w[1] * w[2] * e[6], e[7]}};
  return o;
}

/* The records of all particles, once per loop. */
static void records(Sim *sim, int body)
{
  Cpu *c = sim->own;
  const State *s = &sim->s;
#pragma omp parallel for schedule(static)
  for (long i = 0; i < s->all; i++) {
    if (body && sim->rich)
      ((Whole *)c->record)[i] = whole_of(s, i);
    else if (body)
      ((Body *)c->record)[i] = body_of(s, i);
    else
      ((Flow *)c->record)[i] = flow_of(s, i);
  }
}

/* Packs the records of the neighbours list[n] into columns. */
static inline __attribute__((always_inline)) void
pack(const double *record, int columns, const uint32_t *list, long n, double *to, long room)
{
  for (long k = 0; k < n; k++) {
    const double *from = record + (size_t)list[k] * (size_t)columns;
    for (int c = 0; c < columns; c++) to[c * room + k] = from[c];
  }
}

/* Column c of a pack at k. */
#define AT(C) p[(C)*room + k]

static inline __attribute__((always_inline)) void gradient_of(const State *s, long i,
                                                              const Flow *me, const double *p,
                                                              long room, long n, int kern, int line,
                                                              int solid, const PairRun *run)
{
  double gxx = 0, gxy = 0, gxz = 0, gyx = 0, gyy = 0, gyz = 0, gzx = 0, gzy = 0, gzz = 0;
  double mxx = 0, mxy = 0, mxz = 0, myy = 0, myz = 0, mzz = 0, spread = 0;
  Flow self = *me;
#pragma omp simd reduction(+ : gxx, gxy, gxz, gyx, gyy, gyz, gzx, gzy, gzz)                        \
    reduction(+ : mxx, mxy, mxz, myy, myz, mzz, spread)
  for (long k = 0; k < n; k++) {
    PairVector r = {self.x - AT(0), self.y - AT(1), self.z - AT(2)};
    PairVector v = {self.vx - AT(3), self.vy - AT(4), self.vz - AT(5)};
    PairGradient o = pair_gradient(r, v, 0.5 * (self.h + AT(6)), AT(7), kern, line, solid, run);
    gxx += o.gxx, gxy += o.gxy, gxz += o.gxz, gyx += o.gyx, gyy += o.gyy, gyz += o.gyz,
        gzx += o.gzx, gzy += o.gzy, gzz += o.gzz;
    mxx += o.mxx, mxy += o.mxy, mxz += o.mxz, myy += o.myy, myz += o.myz, mzz += o.mzz;
    spread += o.spread;
  }
  const double w = passes_share(s, i);
  if (!solid) {
    s->divv[i] = w * gxx;
  } else {
    const double wm = w * pair_wide(spread);
    const double raw[9] = {w * gxx, w * gxy, w * gxz, w * gyx, w * gyy,
                           w * gyz, w * gzx, w * gzy, w * gzz};
    const Sym m = {wm * mxx, wm * mxy, wm * mxz, wm * myy, wm * myz, wm * mzz};
    pass_correct(s, i, raw, m);
  }
}

/* Loop A over a range of particles, with literals. */
static inline __attribute__((always_inline)) void gradients(const Sim *sim, Pack *b, long from,
                                                            long to, int kern, int line, int solid)
{
  const Cpu *c = sim->own;
  const Flow *record = (const Flow *)c->record;
  for (long i = from; i < to; i++) {
    long n = (long)(c->ngb.start[i + 1] - c->ngb.start[i]);
    double *p = pack_reserve(b, n, FLOW);
    pack((const double *)record, FLOW, c->ngb.list + c->ngb.start[i], n, p, b->room);
    gradient_of(&sim->s, i, &record[i], p, b->room, n, kern, line, solid, &c->run);
  }
}

static inline __attribute__((always_inline)) void force_of(const State *s, long i, const Body *me,
                                                           const double *p, long room, long n,
                                                           int kern, int line, int solid,
                                                           int miscible, const PairRun *run)
{
  double fx = 0, fy = 0, fz = 0, work = 0, near = 0, signal = 2 * me->b.signal, w;
  Body self = *me;
#pragma omp simd reduction(+ : fx, fy, fz, work, near) reduction(max : signal)
  for (long k = 0; k < n; k++) {
    PairVector r = {self.x - AT(0), self.y - AT(1), self.z - AT(2)};
    PairBody j = {AT(3),  AT(4),  AT(5),  AT(6),  AT(7),  AT(8),  AT(9),  AT(10), AT(11), AT(12),
                  AT(13), AT(14), AT(15), AT(16), AT(17), AT(18), AT(19), AT(20), AT(21)};
    PairForce o = pair_force(r, &self.b, &j, kern, line, solid, miscible, run);
    fx += o.fx, fy += o.fy, fz += o.fz, work += o.work, near += o.near;
    signal = o.signal > signal ? o.signal : signal;
  }
  w = 1 / s->m[i];
  s->acc[3 * i] = fx * w, s->acc[3 * i + 1] = fy * w, s->acc[3 * i + 2] = fz * w;
  s->du[i] = work * w, s->signal[i] = signal, s->nngb[i] = (int32_t)near;
}

/* Loop B over a range. */
static inline __attribute__((always_inline)) void
forces(const Sim *sim, Pack *b, long from, long to, int kern, int line, int solid, int miscible)
{
  const Cpu *c = sim->own;
  const Body *record = (const Body *)c->record;
  for (long i = from; i < to; i++) {
    long n = (long)(c->ngb.start[i + 1] - c->ngb.start[i]);
    double *p = pack_reserve(b, n, BODY);
    pack((const double *)record, BODY, c->ngb.list + c->ngb.start[i], n, p, b->room);
    force_of(&sim->s, i, &record[i], p, b->room, n, kern, line, solid, miscible, &c->run);
  }
}

/* What pair_rich adds to the results of i: sums w, sense and rate. */
static void keep_rich(const Sim *sim, long i, const double w[3], double sense, double rate)
{
  const State *s = &sim->s;
  const Cpu *c = sim->own;
  const double part = passes_part(s, i);
  if (s->wander)
    for (int d = 0; d < 3; d++) s->wander[3 * i + d] = sim->par.xsph * w[d] / s->m[i];
  if (s->drho) s->drho[i] = sim->par.diffusion * part * rate;
  if (s->sense) {
    const double self =
        passes_mass(s, i) * pair_weight(sim->par.kernel, s->dimension == 1, &c->run, 0, s->h[i]);
    s->sense[i] = (sense + (s->divv[i] < 0 ? -self : self)) * part / s->rho[i];
  }
}

static inline __attribute__((always_inline)) void rich_of(const Sim *sim, long i, const Whole *me,
                                                          const double *p, long room, long n,
                                                          int kern, int line, int grad)
{
  const Cpu *c = sim->own;
  const State *s = &sim->s;
  double fx = 0, fy = 0, fz = 0, work = 0, near = 0, signal = 2 * me->b.b.signal;
  double wx = 0, wy = 0, wz = 0, sense = 0, rate = 0;
  const Whole self = *me;
  const PairRun run = c->run;
  const PairMore more = sim->more;
#pragma omp simd reduction(+ : fx, fy, fz, work, near, wx, wy, wz, sense, rate)                    \
    reduction(max : signal)
  for (long k = 0; k < n; k++) {
    PairVector r = {self.b.x - AT(0), self.b.y - AT(1), self.b.z - AT(2)};
    PairBody j = {AT(3),  AT(4),  AT(5),  AT(6),  AT(7),  AT(8),  AT(9),  AT(10), AT(11), AT(12),
                  AT(13), AT(14), AT(15), AT(16), AT(17), AT(18), AT(19), AT(20), AT(21)};
    PairExtra e = {AT(22), AT(23), AT(24), AT(25), AT(26), AT(27), AT(28), AT(29)};
    PairRich o = pair_rich(r, &self.b.b, &j, &self.e, &e, kern, line, grad, &run, &more);
    fx += o.f.fx, fy += o.f.fy, fz += o.f.fz, work += o.f.work, near += o.f.near;
    wx += o.wx, wy += o.wy, wz += o.wz, sense += o.sense, rate += o.rate;
    signal = o.f.signal > signal ? o.f.signal : signal;
  }
  const double w = 1 / s->m[i], moved[3] = {wx, wy, wz};
  s->acc[3 * i] = fx * w, s->acc[3 * i + 1] = fy * w, s->acc[3 * i + 2] = fz * w;
  s->du[i] = work * w, s->signal[i] = signal, s->nngb[i] = (int32_t)near;
  keep_rich(sim, i, moved, sense, rate);
}

/* Loop B of runs with more pair terms over a range. */
static inline __attribute__((always_inline)) void riches(const Sim *sim, Pack *b, long from,
                                                         long to, int kern, int line, int grad)
{
  const Cpu *c = sim->own;
  const Whole *record = (const Whole *)c->record;
  for (long i = from; i < to; i++) {
    long n = (long)(c->ngb.start[i + 1] - c->ngb.start[i]);
    double *p = pack_reserve(b, n, WHOLE);
    pack((const double *)record, WHOLE, c->ngb.list + c->ngb.start[i], n, p, b->room);
    rich_of(sim, i, &record[i], p, b->room, n, kern, line, grad);
  }
}

/* Kernel sums at x over a range: rho = sum m W and delta = sum W, the particle itself included
 * (001 eq. 28, 004 eq. 2.48-2.49); for loop A the mean of the density before and this one. */
static inline __attribute__((always_inline)) void densities(const Sim *sim, long from, long to,
                                                            int kern, int line)
{
  const Cpu *c = sim->own;
  const State *s = &sim->s;
  for (long i = from; i < to; i++) {
    double w = pair_weight(kern, line, &c->run, 0, s->h[i]), delta = w, rho = s->m[i] * w,
           before = s->rho[i];
    for (int64_t k = c->ngb.start[i]; k < c->ngb.start[i + 1]; k++) {
      long j = c->ngb.list[k];
      const double *a = &s->x[3 * i], *x = &s->x[3 * j];
      double r2 = (a[0] - x[0]) * (a[0] - x[0]) + (a[1] - x[1]) * (a[1] - x[1]) +
                  (a[2] - x[2]) * (a[2] - x[2]);
      w = pair_weight(kern, line, &c->run, r2, 0.5 * (s->h[i] + s->h[j]));
      delta += w, rho += s->m[j] * w;
    }
    s->delta[i] = delta;
    s->rho[i] = sim->miscible ? s->m[i] * delta : rho;
    s->rhoa[i] = sqrt(before * s->rho[i]);
  }
}

/* Kernel sums of i at x with its own h, as grad_keep takes them. */
static inline __attribute__((always_inline)) void grad_of(const Sim *sim, const Grad *g, long i,
                                                          int newton, int kern, int line)
{
  const Cpu *c = sim->own;
  const State *s = &sim->s;
  const double h = s->h[i], *a = &s->x[3 * i];
  double delta = pair_weight(kern, line, &c->run, 0, h), rate, mass = s->m[i] * delta;
  rate = s->m[i] * pair_weight_rate(kern, line, &c->run, 0, h);
  for (int64_t k = c->ngb.start[i]; k < c->ngb.start[i + 1]; k++) {
    const long j = c->ngb.list[k];
    const double *x = &s->x[3 * j], m = g->miscible ? s->m[i] : s->m[j];
    const PairVector r = {a[0] - x[0], a[1] - x[1], a[2] - x[2]};
    const double r2 = pair_dot(r, r), w = pair_weight(kern, line, &c->run, r2, h);
    delta += w, mass += s->m[j] * w, rate += m * pair_weight_rate(kern, line, &c->run, r2, h);
  }
  grad_keep(s, g, i, delta, mass, rate, newton);
}

static inline __attribute__((always_inline)) void grads(const Sim *sim, long from, long to,
                                                        int kern, int line)
{
  const Grad g = backend_grad(sim);
  for (long i = from; i < to; i++)
    for (int sum = 1; sum <= GRAD_SUMS; sum++) grad_of(sim, &g, i, sum < GRAD_SUMS, kern, line);
}

/* theta at y over a range: sum V_j W_ij, the particle itself included. */
static inline __attribute__((always_inline)) void thetas(const Sim *sim, long from, long to,
                                                         int kern, int line)
{
  const Cpu *c = sim->own;
  const State *s = &sim->s;
  const double *record = c->record;
  for (long i = from; i < to; i++) {
    const double *a = record + FLOW * i;
    double theta = a[7] * pair_weight(kern, line, &c->run, 0, a[6]);
    for (int64_t k = c->ngb.start[i]; k < c->ngb.start[i + 1]; k++) {
      const double *b = record + (size_t)FLOW * c->ngb.list[k];
      const PairVector r = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
      theta += b[7] * pair_weight(kern, line, &c->run, pair_dot(r, r), 0.5 * (a[6] + b[6]));
    }
    s->theta[i] = theta;
  }
}

/* The stamps: a loop over a range is a function of its own, made with the literals it needs before
 * OpenMP comes in (an outlined loop would carry them as variables). A line (1D) has one instance of
 * each loop, the most general. */
/* clang-format off */
typedef void Range(const Sim *sim, Pack *b, long from, long to);
#define STAMP(NAME, CALL) \
  static void NAME(const Sim *sim, Pack *b, long from, long to) { (void)b, CALL; }
#define STAMPS(CAPITAL, NAME, ...) \
  STAMP(gradient_line_##NAME, gradients(sim, b, from, to, KERNEL_##CAPITAL, 1, sim->tensor)) \
  STAMP(gradient_fluid_##NAME, gradients(sim, b, from, to, KERNEL_##CAPITAL, 0, 0)) \
  STAMP(gradient_solid_##NAME, gradients(sim, b, from, to, KERNEL_##CAPITAL, 0, 1)) \
  STAMP(force_line_##NAME, forces(sim, b, from, to, KERNEL_##CAPITAL, 1, 1, sim->miscible)) \
  STAMP(force_fluid_##NAME, forces(sim, b, from, to, KERNEL_##CAPITAL, 0, 0, 0)) \
  STAMP(force_solid_##NAME, forces(sim, b, from, to, KERNEL_##CAPITAL, 0, 1, 0)) \
  STAMP(force_fluid_miscible_##NAME, forces(sim, b, from, to, KERNEL_##CAPITAL, 0, 0, 1)) \
  STAMP(force_solid_miscible_##NAME, forces(sim, b, from, to, KERNEL_##CAPITAL, 0, 1, 1)) \
  STAMP(rich_line_##NAME, riches(sim, b, from, to, KERNEL_##CAPITAL, 1, sim->more.grad)) \
  STAMP(rich_space_##NAME, riches(sim, b, from, to, KERNEL_##CAPITAL, 0, 0)) \
  STAMP(rich_grad_##NAME, riches(sim, b, from, to, KERNEL_##CAPITAL, 0, 1)) \
  STAMP(grad_line_##NAME, grads(sim, from, to, KERNEL_##CAPITAL, 1)) \
  STAMP(grad_space_##NAME, grads(sim, from, to, KERNEL_##CAPITAL, 0)) \
  STAMP(theta_line_##NAME, thetas(sim, from, to, KERNEL_##CAPITAL, 1)) \
  STAMP(theta_space_##NAME, thetas(sim, from, to, KERNEL_##CAPITAL, 0)) \
  STAMP(density_line_##NAME, densities(sim, from, to, KERNEL_##CAPITAL, 1)) \
  STAMP(density_space_##NAME, densities(sim, from, to, KERNEL_##CAPITAL, 0))
KERNELS(STAMPS)

#define GRADIENT_ROW(CAPITAL, NAME, ...) \
  {gradient_line_##NAME, gradient_fluid_##NAME, gradient_solid_##NAME},
#define FORCE_ROW(CAPITAL, NAME, ...) \
  {force_line_##NAME, force_fluid_##NAME, force_solid_##NAME, force_fluid_miscible_##NAME, \
   force_solid_miscible_##NAME},
#define RICH_ROW(CAPITAL, NAME, ...) {rich_line_##NAME, rich_space_##NAME, rich_grad_##NAME},
#define GRAD_ROW(CAPITAL, NAME, ...) {grad_line_##NAME, grad_space_##NAME},
#define THETA_ROW(CAPITAL, NAME, ...) {theta_line_##NAME, theta_space_##NAME},
#define DENSITY_ROW(CAPITAL, NAME, ...) {density_line_##NAME, density_space_##NAME},
static Range *const gradient_stamps[KERNEL_COUNT][3] = {KERNELS(GRADIENT_ROW)};
static Range *const force_stamps[KERNEL_COUNT][5] = {KERNELS(FORCE_ROW)};
static Range *const rich_stamps[KERNEL_COUNT][3] = {KERNELS(RICH_ROW)};
static Range *const grad_stamps[KERNEL_COUNT][2] = {KERNELS(GRAD_ROW)};
static Range *const theta_stamps[KERNEL_COUNT][2] = {KERNELS(THETA_ROW)};
static Range *const density_stamps[KERNEL_COUNT][2] = {KERNELS(DENSITY_ROW)};
/* clang-format on */

enum { CHUNK = 128 };

/* A stamped loop over all particles. */
static void over(Sim *sim, Range *range)
{
  long n = sim->s.n;
#pragma omp parallel
  {
    Pack b = {NULL, 0};
#pragma omp for schedule(dynamic, 1)
    for (long from = 0; from < n; from += CHUNK)
      range(sim, &b, from, from + CHUNK < n ? from + CHUNK : n);
    free(b.column);
  }
}

void cpu_gradient(Sim *sim)
{
  int which = sim->s.dimension == 1 ? 0 : sim->tensor ? 2 : 1;
  backend_begin(sim, TIMER_A);
  if (sim->s.theta) {
    for (long i = 0; i < sim->s.n; i++) sim->s.theta[i] = 1;
    records(sim, 0);
    over(sim, theta_stamps[sim->par.kernel][sim->s.dimension != 1]);
  }
  records(sim, 0);
  over(sim, gradient_stamps[sim->par.kernel][which]);
  backend_end(sim, TIMER_A);
}

void cpu_force(Sim *sim)
{
  int which = sim->s.dimension == 1 ? 0 : 1 + !!sim->tensor + 2 * !!sim->miscible;
  backend_begin(sim, TIMER_B);
  records(sim, 1);
  over(sim, sim->rich ? rich_stamps[sim->par.kernel][sim->s.dimension == 1 ? 0 : 1 + sim->more.grad]
                      : force_stamps[sim->par.kernel][which]);
  backend_end(sim, TIMER_B);
}

void cpu_density(Sim *sim)
{
  backend_begin(sim, TIMER_DENSITY);
  over(sim, (sim->s.omega ? grad_stamps : density_stamps)[sim->par.kernel][sim->s.dimension != 1]);
  backend_end(sim, TIMER_DENSITY);
}
