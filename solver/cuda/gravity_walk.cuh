/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tree walk. Its targets are pieces: up to 32 consecutive particles, cut where the curve jumps.
 * Warps take one piece after another and walk the tree once for all of it; so where there are many
 * small ones, in debris, no warp is left with more than others. The stack holds ranges of brothers;
 * four are opened at once, each lane looks at one child. What is accepted or must be summed
 * particle by particle is collected and evaluated 32 at a time from shared memory.
 *
 * Each lane sums for two targets, and lanes with the same targets share the sources: of 8 targets,
 * eight lanes have the same two and take every eighth source each. So small pieces waste nothing,
 * and boxes can be tight.
 *
 * A node is taken as a multipole as in lib/gravity.h, but the opening angle is
 * theta/(1 + (M_node/M)^1/3): the largest nodes make most of the error and are few. Two touching
 * spheres of 1e6 particles at theta 0.7: median error 6e-4 instead of 1.5e-3, 99 % below 3e-3
 * instead of 12e-3, in a tenth more time.
 *
 * The stack is sorted by depth, as children are pushed in the order of their parents; so when
 * children of some depth are pushed, no older node of it is left, and there are at most 32. */
#ifndef GRAVITY_WALK_CUH
#define GRAVITY_WALK_CUH

#include "cuda.h"
#include "gravity_pair.cuh"

enum {
  WALK_OPEN = 4,                           /* ranges opened at a time */
  WALK_STACK = 32 * (CUDA_LEVELS + 1) + 1, /* ranges */
  WALK_NODE = (1 << 29) - 1,               /* first node of a range; above it: brothers - 1 */
  WALK_DIRECT = 2 /* leaves with no more are summed: cheaper than a multipole */
};
static const float WALK_JUMP = 4; /* a gap in the order over the one beside it */

/* Pieces, in no order; next: that which is to be walked next. */
typedef struct {
  int2 *piece; /* [n] x: first particle, y: particles */
  int *pieces, *next;
} WalkQueue;

typedef struct {
  DeviceTree tree;
  Points points;
  const Root *root;
  const double *x, *m, *h; /* State: double precision reads these, not the points */
  double *pull, *phi;      /* m/s^2, J/kg */
  double length, mass, G;  /* code units in SI; m^3/kg/s^2 */
  double il, im;           /* 1/length, 1/mass: exact */
  double soft;             /* SOFT_ONE: half the support; SOFT_PLUMMER: epsilon^2; code units */
  float over_theta;
  int n, chunk; /* chunk: the most particles of a piece, a power of two, at most 32 */
  WalkQueue queue;
} Walk;

/* Shared memory of the warp: lists of nodes and particles, and the 32 sources at hand. */
template <class Real> struct WalkShared {
  uint32_t stack[WALK_STACK];
  int node[64], body[64];
  Four<Real> a[32], b[32], c[32]; /* position from the centre, mass; quadrupole or (b.x) h/2 */
};

/* A piece: its box, its centre, this lane's two targets and what they feel. */
template <class Real> struct WalkGroup {
  float lo[3], hi[3], centre[3], h; /* h: half the largest support */
  int part, parts;                  /* this lane takes sources part, part + parts, ... */
  Four<Real> at[2];                 /* from the centre; w: half the support */
  Field<Real> sum[2];
};

/* walk_body: particle i from the centre; w: mass. */
INLINE Four<float> walk_body(const Walk &w, int i, const float c[3], float *half)
{
  const float4 hi = w.points.hi[i], lo = w.points.lo[i];
  *half = 0.5f * hi.w;
  return {hi.x - c[0] + lo.x, hi.y - c[1] + lo.y, hi.z - c[2] + lo.z, lo.w};
}

INLINE Four<double> walk_body(const Walk &w, int i, const float c[3], double *half)
{
  const double *x = w.x + 3 * (int64_t)i, *o = w.root->origin, il = w.il;
  *half = 0.5 * il * w.h[i];
  return {(x[0] - o[0]) * il - c[0], (x[1] - o[1]) * il - c[1], (x[2] - o[2]) * il - c[2],
          w.m[i] * w.im};
}

/* walk_pole: multipole k from the centre. */
INLINE void walk_pole(const Walk &w, int k, const float o[3], Four<float> *a, Four<float> *b,
                      Four<float> *c)
{
  const float4 *p = reinterpret_cast<const float4 *>(w.tree.pole + k);
  const float4 hi = p[0], lo = p[1], q = p[2], r = p[3];
  *a = {hi.x - o[0] + lo.x, hi.y - o[1] + lo.y, hi.z - o[2] + lo.z, hi.w};
  *b = {q.x, q.y, q.z, q.w}, *c = {r.x, r.y, 0, 0};
}

INLINE void walk_pole(const Walk &w, int k, const float o[3], Four<double> *a, Four<double> *b,
                      Four<double> *c)
{
  const double2 *p = reinterpret_cast<const double2 *>(w.tree.moment) + 5 * (int64_t)k;
  const double2 mx = p[0], yz = p[1], q0 = p[2], q2 = p[3], q4 = p[4];
  const double *origin = w.root->origin, il = w.il, iq = w.im * il * il;
  *a = {(mx.y - origin[0]) * il - o[0], (yz.x - origin[1]) * il - o[1],
        (yz.y - origin[2]) * il - o[2], mx.x * w.im};
  *b = {q0.x * iq, q0.y * iq, q2.x * iq, q2.y * iq}, *c = {q4.x * iq, q4.y * iq, 0, 0};
}

/* walk_pole_soft: the rest of multipole k with Plummer's softening. */
template <class Real> INLINE void walk_pole_soft(const Walk &w, int k, Four<Real> *c)
{
  c->z = (Real)w.soft * (Real)w.tree.pole[k].trace;
}

/* walk_support: of a pair, from both halves; pair_any's h. */
template <int Soft, class Real> INLINE Real walk_support(const Walk &w, Real a, Real b)
{
  return Soft == SOFT_PAIR ? a + b : Soft == SOFT_ONE ? (Real)(2 * w.soft) : (Real)w.soft;
}

/* Squared distance of two boxes. */
INLINE float walk_gap2(const float lo[3], const float hi[3], const float4 &a, const float4 &b)
{
  const float x = fmaxf(fmaxf(lo[0] - b.x, a.x - hi[0]), 0),
              y = fmaxf(fmaxf(lo[1] - b.y, a.y - hi[1]), 0),
              z = fmaxf(fmaxf(lo[2] - b.z, a.z - hi[2]), 0);
  return x * x + y * y + z * z;
}

/* Squared distance from particle i to the next. */
INLINE float walk_step2(const Walk &w, int i)
{
  if (i < 0 || i + 1 >= w.n) return INFINITY;
  const float4 a = w.points.hi[i], b = w.points.hi[i + 1];
  const float x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return x * x + y * y + z * z;
}

/* walk_jumps: whether a piece ends with particle i: the next is far away, and either much further
 * than the one before it, or the two after it from each other, or in another leaf. h floors what
 * counts as near. Debris, far apart everywhere, stays together in leaves: there is hardly anything
 * else in their boxes, whereas the box of any 32 in a row may hold a whole body. */
INLINE int walk_jumps(const Walk &w, int i)
{
  if (i + 1 >= w.n) return 0;
  const float ha = 0.4f * w.points.hi[i].w, hb = 0.4f * w.points.hi[i + 1].w;
  const float gap = walk_step2(w, i) / (WALK_JUMP * WALK_JUMP);
  const char2 next = w.tree.span[i + 1];
  if (!(gap > fminf(ha * ha, hb * hb))) return 0;
  const float before = fmaxf(walk_step2(w, i - 1), ha * ha),
              after = fmaxf(walk_step2(w, i + 1), hb * hb);
  return gap > fminf(before, after) || next.x < next.y;
}

INLINE float walk_min(float x)
{
  for (int k = 16; k; k /= 2) x = fminf(x, __shfl_xor_sync(~0u, x, k));
  return x;
}

/* walk_begin: the piece of count particles from first on; sums begin with what takes the particles'
 * own potential off. */
template <int Soft, class Real>
INLINE void walk_begin(const Walk &w, int first, int count, WalkGroup<Real> *g)
{
  const int lane = (int)threadIdx.x, half = (count + 1) / 2,
            pairs = half < 2 ? 1 : 1 << (32 - __clz(half - 1));
  const int i = first + min(lane & (pairs - 1), count - 1), j = min(i + pairs, first + count - 1);
  const float4 a = w.points.hi[i], b = w.points.hi[j];
  const float lo[3] = {fminf(a.x, b.x), fminf(a.y, b.y), fminf(a.z, b.z)},
              hi[3] = {fmaxf(a.x, b.x), fmaxf(a.y, b.y), fmaxf(a.z, b.z)};
  g->h = -0.5f * walk_min(-fmaxf(a.w, b.w));
  for (int d = 0; d < 3; d++) {
    const float u = walk_min(lo[d]), v = -walk_min(-hi[d]);
    g->lo[d] = u - 0x1p-23f * fabsf(u), g->hi[d] = v + 0x1p-23f * fabsf(v);
    g->centre[d] = 0.5f * (u + v);
  }
  g->part = lane / pairs, g->parts = 32 / pairs;
  for (int t = 0; t < 2; t++) {
    Real h;
    g->at[t] = walk_body(w, t ? j : i, g->centre, &h);
    g->sum[t] = {0, 0, 0,
                 lane < pairs ? pair_own<Soft>(g->at[t].w, walk_support<Soft>(w, h, h)) : 0};
    g->at[t].w = h;
  }
}

/* walk_open, walk_close: f is what 32 sources add up to. In single precision it joins the rest as a
 * sum of its own, to round less; in double that would only take registers. */
template <class Real> INLINE void walk_open(const WalkGroup<Real> *g, Field<Real> f[2])
{
  const int apart = sizeof(Real) == sizeof(float);
  for (int t = 0; t < 2; t++) f[t] = apart ? Field<Real>{0, 0, 0, 0} : g->sum[t];
}

template <class Real> INLINE void walk_close(WalkGroup<Real> *g, const Field<Real> f[2])
{
  const int apart = sizeof(Real) == sizeof(float);
  for (int t = 0; t < 2; t++) {
    Field<Real> *s = g->sum + t;
    *s = apart ? Field<Real>{s->x + f[t].x, s->y + f[t].y, s->z + f[t].z, s->p + f[t].p} : f[t];
  }
}

/* walk_nodes: the multipoles node[0 .. take-1]. */
template <int Soft, class Real>
INLINE void walk_nodes(const Walk &w, WalkShared<Real> *s, WalkGroup<Real> *g, int take)
{
  const int lane = (int)threadIdx.x;
  Field<Real> f[2];
  walk_open(g, f);
  if (lane < take) walk_pole(w, s->node[lane], g->centre, s->a + lane, s->b + lane, s->c + lane);
  if (lane < take && Soft == SOFT_PLUMMER) walk_pole_soft(w, s->node[lane], s->c + lane);
  __syncwarp();
#pragma unroll 1
  for (int k = g->part; k < take; k += g->parts) {
    const Four<Real> a = s->a[k], b = s->b[k], c = s->c[k];
    for (int t = 0; t < 2; t++)
      pair_pole<Soft>(a.x - g->at[t].x, a.y - g->at[t].y, a.z - g->at[t].z, a, b, c, (Real)w.soft,
                      f + t);
  }
  walk_close(g, f);
  __syncwarp();
}

/* walk_bodies: the particles body[0 .. take-1]; those within the softening of the box go first. */
template <int Soft, class Real>
INLINE void walk_bodies(const Walk &w, WalkShared<Real> *s, WalkGroup<Real> *g, int take)
{
  const int lane = (int)threadIdx.x;
  const unsigned below = (1u << lane) - 1;
  Field<Real> f[2];
  walk_open(g, f);
  Four<Real> a = {0, 0, 0, 0};
  Real half = 0;
  int near = 0;
  if (lane < take) {
    const float4 p = w.points.hi[s->body[lane]];
    const float reach = Soft == SOFT_PAIR ? g->h + 0.5f * p.w : (float)(2 * w.soft);
    near = Soft == SOFT_PLUMMER || walk_gap2(g->lo, g->hi, p, p) < 1.00001f * reach * reach;
    a = walk_body(w, s->body[lane], g->centre, &half);
  }
  const unsigned soft = __ballot_sync(~0u, near);
  const int softs = __popc(soft), to = near ? __popc(soft & below) : softs + __popc(~soft & below);
  s->a[to] = a, s->b[to].x = half;
  __syncwarp();
#pragma unroll 1
  for (int k = g->part; k < softs; k += g->parts) {
    const Four<Real> b = s->a[k];
    const Real h = s->b[k].x;
    for (int t = 0; t < 2; t++) {
      const Four<Real> *x = g->at + t;
      const Real dx = b.x - x->x, dy = b.y - x->y, dz = b.z - x->z;
      Real p;
      const Real c = pair_any<Soft>(dx, dy, dz, b.w, walk_support<Soft>(w, h, x->w), &p);
      f[t].x += c * dx, f[t].y += c * dy, f[t].z += c * dz, f[t].p += p;
    }
  }
#pragma unroll 1
  for (int k = softs + g->part; k < take; k += g->parts) {
    const Four<Real> b = s->a[k];
    for (int t = 0; t < 2; t++)
      pair_newton(b.x - g->at[t].x, b.y - g->at[t].y, b.z - g->at[t].z, b.w, f + t);
  }
  walk_close(g, f);
  __syncwarp();
}

/* walk_end: adds up what lanes with the same targets have, and writes. */
template <class Real> INLINE void walk_end(const Walk &w, WalkGroup<Real> *g, int first, int count)
{
  const int lane = (int)threadIdx.x, pairs = 32 / g->parts;
  const double scale = w.G * w.mass / w.length, pull = scale / w.length;
  for (int t = 0; t < 2; t++) {
    Field<Real> *f = g->sum + t;
    const int i = lane + t * pairs;
    for (int k = pairs; k < 32; k *= 2) {
      f->x += __shfl_xor_sync(~0u, f->x, k), f->y += __shfl_xor_sync(~0u, f->y, k);
      f->z += __shfl_xor_sync(~0u, f->z, k), f->p += __shfl_xor_sync(~0u, f->p, k);
    }
    if (lane >= pairs || i >= count) continue;
    double *to = w.pull + 3 * (int64_t)(first + i);
    to[0] = pull * f->x, to[1] = pull * f->y, to[2] = pull * f->z;
    w.phi[first + i] = scale * f->p;
  }
}

/* walk_full_nodes: evaluates node[0 .. nodes-1], 32 at a time; the rest, too, at the end. Returns
 * how many are left. */
template <int Soft, class Real>
INLINE int walk_full_nodes(const Walk &w, WalkShared<Real> *s, WalkGroup<Real> *g, int nodes,
                           int end)
{
  const int lane = (int)threadIdx.x;
  while (nodes >= 32 || (nodes && end)) {
    const int take = min(nodes, 32), rest = nodes - take;
    walk_nodes<Soft>(w, s, g, take);
    if (lane < rest) s->node[lane] = s->node[32 + lane];
    nodes = rest;
    __syncwarp();
  }
  return nodes;
}

/* walk_full_bodies: puts the particles of some lanes' leaves behind those that are in body, and
 * evaluates as above. */
template <int Soft, class Real>
INLINE int walk_full_bodies(const Walk &w, WalkShared<Real> *s, WalkGroup<Real> *g, int bodies,
                            int end, unsigned leaves, int4 link)
{
  const int lane = (int)threadIdx.x;
  while (leaves || (bodies && end)) {
    if (leaves) {
      const int from = __ffs((int)leaves) - 1, b = __shfl_sync(~0u, link.z, from),
                left = __shfl_sync(~0u, link.w, from), take = min(left, 32);
      if (lane < take) s->body[bodies + lane] = b + lane;
      if (lane == from) link.z += take, link.w -= take;
      if (left <= 32) leaves &= leaves - 1;
      bodies += take;
      __syncwarp();
    }
    if (bodies >= 32 || (!leaves && end)) {
      const int take = min(bodies, 32), rest = bodies - take;
      walk_bodies<Soft>(w, s, g, take);
      if (lane < rest) s->body[lane] = s->body[32 + lane];
      bodies = rest;
      __syncwarp();
    }
  }
  return bodies;
}

/* walk_soft: nodes closer than this are opened, h: of the node; Plummer's multipoles hold anywhere.
 * walk_far2: the squared distance that makes a node small. */
template <int Soft> INLINE float walk_soft(const Walk &w, float half, float h)
{
  return Soft == SOFT_PAIR ? half + 0.5f * h : Soft == SOFT_ONE ? (float)(2 * w.soft) : 0;
}

template <int Soft, class Real>
INLINE float walk_far2(const Walk &w, const WalkGroup<Real> &g, const float4 &com)
{
  const float gap2 = walk_gap2(g.lo, g.hi, com, com);
  return Soft == SOFT_PLUMMER ? gap2 + (float)w.soft : gap2;
}

/* walk_group: one piece. */
template <int Soft, class Real>
INLINE void walk_group(const Walk &w, WalkShared<Real> *s, int first, int count)
{
  const int lane = (int)threadIdx.x, brother = lane % 8;
  const unsigned below = (1u << lane) - 1;
  const float mass = w.tree.com[0].w, over_mass = mass > 0 ? 1 / mass : 0;
  int top = 1, nodes = 0, bodies = 0;
  WalkGroup<Real> g;
  walk_begin<Soft>(w, first, count, &g);
  if (lane == 0) s->stack[0] = 0;
  do {
    const int base = max(top - WALK_OPEN, 0), slot = base + lane / 8;
    int accept = 0, inner = 0, look;
    int4 link = {0, 0, 0, 0};
    __syncwarp();
    const uint32_t range = slot < top ? s->stack[slot] : 0;
    const int k = (int)(range & WALK_NODE) + brother;
    look = slot < top && brother <= (int)(range >> 29);
    if (look) {
      const float4 com = w.tree.com[k], lo = w.tree.lo[k], hi = w.tree.hi[k];
      const float far = lo.w * w.over_theta * (1 + __powf(com.w * over_mass, 1.f / 3)),
                  soft = walk_soft<Soft>(w, g.h, hi.w);
      link = w.tree.link[k], inner = link.y > 0;
      accept = link.w > WALK_DIRECT && walk_far2<Soft>(w, g, com) > far * far &&
               walk_gap2(g.lo, g.hi, lo, hi) > 1.00001f * soft * soft;
    }
    const unsigned accepts = __ballot_sync(~0u, accept),
                   opens = __ballot_sync(~0u, !accept && inner),
                   leaves = __ballot_sync(~0u, look && !accept && !inner);
    top = base;
    __syncwarp(); /* all have read their ranges */
    if (!accept && inner)
      s->stack[top + __popc(opens & below)] = (uint32_t)link.x | (uint32_t)(link.y - 1) << 29;
    if (accept) s->node[nodes + __popc(accepts & below)] = k;
    top += __popc(opens);
    __syncwarp();
    nodes = walk_full_nodes<Soft>(w, s, &g, nodes + __popc(accepts), !top);
    bodies = walk_full_bodies<Soft>(w, s, &g, bodies, !top, leaves, link);
  } while (top);
  walk_end(w, &g, first, count);
}

/* walk_cut: queues the pieces; a warp takes 32 particles, which are whole chunks. */
static __global__ void __launch_bounds__(128) walk_cut(const __grid_constant__ Walk w)
{
  const int i = (int)(blockIdx.x * blockDim.x + threadIdx.x), lane = (int)threadIdx.x % 32;
  const int ends = i < w.n && (i + 1 == w.n || (i + 1) % w.chunk == 0 || walk_jumps(w, i));
  const unsigned all = __ballot_sync(~0u, ends), below = all & ((1u << lane) - 1);
  int at = 0;
  if (lane == 0 && all) at = atomicAdd(w.queue.pieces, __popc(all));
  at = __shfl_sync(~0u, at, 0) + __popc(below);
  const int count = below ? lane - 31 + __clz((int)below) : lane + 1;
  if (ends) w.queue.piece[at] = make_int2(i + 1 - count, count);
}

/* walk_tree: one warp a block, as many as the card can have at work; 16 blocks or more share a
 * multiprocessor. */
template <class Real, int Soft>
__global__ void __launch_bounds__(32, sizeof(Real) == sizeof(float) ? 16 : 12)
    walk_tree(const __grid_constant__ Walk w)
{
  __shared__ WalkShared<Real> s;
  const int pieces = *w.queue.pieces;
  for (;;) {
    int k = threadIdx.x == 0 ? atomicAdd(w.queue.next, 1) : 0;
    k = __shfl_sync(~0u, k, 0);
    if (k >= pieces) return;
    const int2 piece = w.queue.piece[k];
    walk_group<Soft>(w, &s, piece.x, piece.y);
    __syncwarp(); /* the stack is free again */
  }
}

#endif
