/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Neighbour lists. A warp searches for 32 consecutive particles, or piece by piece where the curve
 * jumps among them. It walks the tree depth first, up to 32 children at a time, so that what it
 * finds is in order and the stack is short. Particles of leaves within reach are tested against the
 * piece's box, 32 at a time; those that pass fill tiles of 32, and a tile is tested against all
 * targets: a thread does 4 targets and 8 candidates, which come from shared memory. The hits are
 * bits; when all tiles are there each thread knows how long its list is, the warp takes rows for
 * the longest, and the bits become numbers, row by row. What does not fit into the tiles is counted
 * only, and the walk is made once more. Groups in many pieces, debris, take the longest and are
 * searched first, so that none of them is alone at the end.
 *
 * The test is (s_i + s_j)^2 - |x_i - x_j|^2 > 0 as a sum of products, s as in tree.cuh, rounded
 * up by EPS, which is more than the sum can lose: four products and as many additions of terms
 * below x_i^2 + x_j^2 + s_i^2 + s_j^2, and the rounding of coordinates, are below 2^-20 of that.
 * Where neighbours move past each other by a good part of h, s is much larger than h/2: there the
 * hits are looked at once more, exactly. */
#include "tree.cuh"

enum {
  WARPS = 4,
  THREADS = 32 * WARPS,
  TILES = 20,
  CROWD = 64,   /* a longer stack grows by one node at a time, */
  STACK = 240,  /* so that it stays below CROWD + 28 + 7 for each of CUDA_LEVELS levels */
  RING = 2 * 36 /* two tiles; a gap of one after 8 candidates keeps the banks apart */
};
static const unsigned ALL = ~0u;
static __device__ const float EPS = 0x1p-19f, NEVER = -3e38f,
                              LOOSE = 0.53f; /* of h: 6 % more reach */

typedef struct {
  State s;
  Units unit;
  const Root *root;
  const int4 *link, *place;
  const float4 *lo, *hi, *drift;
  const int *nodes;
  long room;
  Report *report;
  Lists out;
  const int *first; /* groups that are searched before the others, at most `most` */
  const char *is_first;
  int most;
} Search;

/* Where a piece of the warp's particles lies. */
typedef struct {
  int centre[3];         /* place */
  float half[3];         /* of the box around it, code units */
  float lo[3], hi[3];    /* the box from the root's origin, rounded outwards */
  float drift[3], reach; /* mean y - x; the largest s */
  float cell;            /* code units a unit of place */
} Box;

/* A warp's memory. */
typedef struct {
  int2 stack[STACK]; /* x: first child, y: children; a leaf: x: node, y: 0. The next on top */
  int leaf[64];
  float4 ring[RING]; /* candidates: 2 x, 2 y, 2 z, 2 s */
  float rest[RING];  /* s^2 - x^2 */
  uint32_t j[(TILES + 1) * 32];
  uint32_t hit[TILES * 32]; /* of each tile and target, a bit a candidate */
  Box box;
  uint32_t first; /* the warp's first particle */
} Desk;

/* The piece's targets, and what the walk has collected for them. */
typedef struct {
  float x[4], y[4], z[4], s[4],
      least[4]; /* targets lane % 8 + 8 k; least: what the sum must pass */
  int stacked, leaves, filled, tiles;
  bool loose; /* neighbours move past each other: s is much more than h/2 */
} Piece;

static __device__ __forceinline__ int lane_of(void) { return (int)threadIdx.x % 32; }
static __device__ __forceinline__ int rank_in(unsigned mask)
{
  return __popc(mask & ((1u << lane_of()) - 1));
}
static __device__ __forceinline__ int slot_of(int k) /* in the ring, of candidate k */
{
  return (k & 32 ? RING / 2 : 0) + (k & 31) + ((k & 31) >> 3);
}

static __device__ __forceinline__ float max_all(float v)
{
#pragma unroll
  for (int k = 16; k; k /= 2) v = fmaxf(v, __shfl_xor_sync(ALL, v, k));
  return v;
}
static __device__ __forceinline__ int min_all(int v)
{
#pragma unroll
  for (int k = 16; k; k /= 2) v = min(v, __shfl_xor_sync(ALL, v, k));
  return v;
}
static __device__ __forceinline__ float add_all(float v)
{
#pragma unroll
  for (int k = 16; k; k /= 2) v += __shfl_xor_sync(ALL, v, k);
  return v;
}

static __device__ __forceinline__ float sq(float x) { return x * x; }
static __device__ __forceinline__ float size3(float x, float y, float z)
{
  return sqrtf(x * x + y * y + z * z);
}

/* Tests tile number p->tiles of the ring against the targets. */
static __device__ __forceinline__ void test_tile(Desk *w, Piece *p)
{
  const int lane = lane_of(), q = lane / 8, tile = p->tiles;
  const int at = slot_of((tile & 1) * 32 + 8 * q);
  unsigned byte[4] = {0, 0, 0, 0};
#pragma unroll
  for (int m = 0; m < 8; m++) {
    const float4 c = w->ring[at + m];
    const float rest = w->rest[at + m];
#pragma unroll
    for (int k = 0; k < 4; k++) {
      const float sum =
          fmaf(p->x[k], c.x, fmaf(p->y[k], c.y, fmaf(p->z[k], c.z, fmaf(p->s[k], c.w, rest))));
      if (sum > p->least[k]) byte[k] |= 1u << m;
    }
  }
  unsigned char *to = (unsigned char *)(w->hit + 32 * tile);
#pragma unroll
  for (int k = 0; k < 4; k++) to[4 * (lane % 8 + 8 * k) + q] = (unsigned char)byte[k];
  __syncwarp();
  const uint32_t self = w->j[32 * tile + lane] - w->first; /* nobody is a neighbour of itself */
  if (self < 32) w->hit[32 * tile + self] &= ~(1u << lane);
  __syncwarp();
}

/* Whether i and j interact at x or at y. */
static __device__ bool interact(const State &s, long i, long j)
{
  const double half = 0.5 * (1 + s.margin);
  const double *x = s.x + 3 * i, *u = s.x + 3 * j, h = half * (s.h[i] + s.h[j]);
  const double *y = s.y + 3 * i, *v = s.y + 3 * j, ha = half * (s.ha[i] + s.ha[j]);
  double x2 = 0, y2 = 0;
#pragma unroll
  for (int d = 0; d < 3; d++) {
    x2 += (x[d] - u[d]) * (x[d] - u[d]);
    y2 += (y[d] - v[d]) * (y[d] - v[d]);
  }
  return x2 < h * h || y2 < ha * ha;
}

/* Takes the hits of the last tile back that do not interact. */
static __device__ void verify_tile(const Search &a, Desk *w, const Piece *p)
{
  const int lane = lane_of(), at = 32 * p->tiles;
  const uint32_t hits = w->hit[at + lane];
  uint32_t good = hits;
  for (uint32_t left = hits; left; left &= left - 1) {
    const int k = __ffs((int)left) - 1;
    if (!interact(a.s, (long)w->first + lane, w->j[at + k])) good &= ~(1u << k);
  }
  w->hit[at + lane] = good;
  __syncwarp();
}

/* Writes the numbers of the hits into rows from *k on, or only counts them. */
static __device__ void empty_tiles(Desk *w, Piece *p, uint32_t *rows, int *k)
{
  const int lane = lane_of();
  int tile = 0;
  uint32_t word = p->tiles ? w->hit[lane] : 0;
  if (!rows) {
    for (int t = 0; t < p->tiles; t++) *k += __popc(w->hit[32 * t + lane]);
  } else {
    for (;;) {
      while (!word && tile + 1 < p->tiles) word = w->hit[32 * ++tile + lane];
      if (!__any_sync(ALL, word != 0)) break;
      if (!word) continue;
      rows[32 * (size_t)*k + lane] = w->j[32 * tile + __ffs((int)word) - 1];
      ++*k, word &= word - 1;
    }
  }
  __syncwarp();
  p->tiles = 0;
}

/* Where hits go: rows NULL: first pass, they stay in the tiles as long as they fit. */
typedef struct {
  uint32_t *rows;
  int k; /* this thread's hits that have left the tiles */
  bool again;
} Result;

static __device__ __forceinline__ void finish_tile(const Search &a, Desk *w, Piece *p, Result *r)
{
  test_tile(w, p);
  if (p->loose) verify_tile(a, w, p);
  p->filled -= 32;
  if (++p->tiles < TILES) return;
  /* The ring's other half and the numbers after the last tile begin the next round. */
  const int lane = lane_of();
  const uint32_t j = w->j[32 * TILES + lane];
  r->again = true;
  empty_tiles(w, p, r->rows, &r->k);
  w->j[lane] = j;
  __syncwarp();
}

/* Appends one candidate of each thread that has one within reach of the piece's box. */
static __device__ __forceinline__ void filter(const Search &a, Desk *w, Piece *p, bool have,
                                              uint32_t j, float extra)
{
  const Box &b = w->box;
  float x = 0, y = 0, z = 0, s = 0;
  bool near = have;
  if (have) {
    const int4 v = __ldg(a.place + j);
    x = (float)(v.x - b.centre[0]) * b.cell, y = (float)(v.y - b.centre[1]) * b.cell;
    z = (float)(v.z - b.centre[2]) * b.cell, s = __int_as_float(v.w) + extra;
    const float gap = sq(fmaxf(fabsf(x) - b.half[0], 0)) + sq(fmaxf(fabsf(y) - b.half[1], 0)) +
                      sq(fmaxf(fabsf(z) - b.half[2], 0));
    near = gap <= sq(b.reach + s) * (1 + EPS);
  }
  const unsigned found = __ballot_sync(ALL, near);
  if (near) {
    const int k = p->filled + rank_in(found), at = slot_of((p->tiles & 1) * 32 + k);
    w->ring[at] = make_float4(2 * x, 2 * y, 2 * z, 2 * s);
    w->rest[at] = s * s * (1 + EPS) - (x * x + y * y + z * z) * (1 - EPS);
    w->j[32 * p->tiles + k] = j;
  }
  p->filled += __popc(found);
  __syncwarp();
}

/* Nobody, to the end of the tile. */
static __device__ __forceinline__ void pad_tile(Desk *w, Piece *p)
{
  const int lane = lane_of(), at = slot_of((p->tiles & 1) * 32 + lane);
  if (lane >= p->filled) {
    w->ring[at] = make_float4(0, 0, 0, 0), w->rest[at] = NEVER;
    w->j[32 * p->tiles + lane] = ~0u;
  }
  p->filled = 32;
  __syncwarp();
}

/* Looks at the particles of the next 32 leaves or fewer, 32 at a time; the last leaves of a piece
 * also end its last tile. */
static __device__ __forceinline__ void open_leaves(const Search &a, Desk *w, Piece *p, Result *r,
                                                   bool last)
{
  const int lane = lane_of(), leaves = min(p->leaves, 32);
  int first = 0, count = 0, end;
  float extra = 0;
  bool loose = false;
  if (lane < leaves) {
    const int node = w->leaf[lane];
    const int4 link = __ldg(a.link + node);
    const float4 d = __ldg(a.drift + node);
    first = link.z, count = link.w;
    extra = size3(d.x - w->box.drift[0], d.y - w->box.drift[1], d.z - w->box.drift[2]) * (1 + EPS);
    loose = extra + d.w > LOOSE * (1 + (float)a.s.margin) * __ldg(&a.hi[node].w);
  }
  const int rest = w->leaf[32 + lane];
  p->loose |= __any_sync(ALL, loose) != 0;
  w->leaf[lane] = rest, p->leaves -= leaves;
  end = count;
#pragma unroll
  for (int k = 1; k < 32; k *= 2) {
    const int more = __shfl_up_sync(ALL, end, k);
    if (lane >= k) end += more;
  }
  const int all = __shfl_sync(ALL, end, 31);
  first -= end - count;
  int base = 0;
  do {
    const int at = base + lane;
    int own = 0; /* the leaf that holds it: the first that ends after it */
#pragma unroll
    for (int k = 16; k; k /= 2)
      if (__shfl_sync(ALL, end, own + k - 1) <= at) own += k;
    const uint32_t j = (uint32_t)(__shfl_sync(ALL, first, own) + at);
    filter(a, w, p, at < all, j, __shfl_sync(ALL, extra, own));
    base += 32;
    while (p->filled >= 32 || (last && base >= all && p->filled > 0)) {
      if (p->filled < 32) pad_tile(w, p);
      finish_tile(a, w, p, r);
    }
  } while (base < all);
}

/* Queues the leaves that the threads of mask have, in their order. */
static __device__ __forceinline__ void add_leaves(Desk *w, Piece *p, unsigned mask, int node)
{
  if (mask >> lane_of() & 1) w->leaf[p->leaves + rank_in(mask)] = node;
  p->leaves += __popc(mask);
}

/* Whether node k may hold a neighbour of the piece. */
static __device__ __forceinline__ bool reaches(const Search &a, const Box &b, int k)
{
  const float4 lo = __ldg(a.lo + k), hi = __ldg(a.hi + k), d = __ldg(a.drift + k);
  const float gx = fmaxf(fmaxf(lo.x - b.hi[0], b.lo[0] - hi.x), 0);
  const float gy = fmaxf(fmaxf(lo.y - b.hi[1], b.lo[1] - hi.y), 0);
  const float gz = fmaxf(fmaxf(lo.z - b.hi[2], b.lo[2] - hi.z), 0);
  const float reach = b.reach + d.w + size3(d.x - b.drift[0], d.y - b.drift[1], d.z - b.drift[2]);
  return gx * gx + gy * gy + gz * gz <= reach * reach * 1.00001f;
}

/* Takes leaves from the top of the stack, or opens up to four nodes there. */
static __device__ __forceinline__ void pop(const Search &a, Desk *w, Piece *p)
{
  const int lane = lane_of();
  int2 e = make_int2(0, 0);
  if (lane < p->stacked) e = w->stack[p->stacked - 1 - lane];
  const unsigned open = __ballot_sync(ALL, e.y > 0); /* no bit: a leaf, or nothing */
  const int leaves = open ? __ffs((int)open) - 1 : min(p->stacked, 32);
  if (leaves) {
    p->stacked -= leaves;
    add_leaves(w, p, ALL >> (32 - leaves), e.x);
    return;
  }
  const int opened = p->stacked > CROWD ? 1 : min(4, ~open ? __ffs((int)~open) - 1 : 32);
  const int first = __shfl_sync(ALL, e.x, lane / 8), kids = __shfl_sync(ALL, e.y, lane / 8);
  const int node = first + lane % 8;
  const bool near = lane / 8 < opened && lane % 8 < kids && reaches(a, w->box, node);
  int4 link = make_int4(0, 0, 0, 0);
  if (near) link = __ldg(a.link + node);
  const unsigned found = __ballot_sync(ALL, near), inner = __ballot_sync(ALL, near && link.y > 0);
  const unsigned lead = inner ? found & ((inner & (0u - inner)) - 1) : found;
  const unsigned push = found & ~lead;
  p->stacked += __popc(push) - opened;
  __syncwarp(); /* all have read the stack */
  if (push >> lane & 1)
    w->stack[p->stacked - 1 - rank_in(push)] =
        link.y ? make_int2(link.x, link.y) : make_int2(node, 0);
  add_leaves(w, p, lead, node);
}

static __device__ __forceinline__ void walk(const Search &a, Desk *w, Piece *p, Result *r)
{
  const int4 root = __ldg(a.link);
  bool last = false;
  p->leaves = p->filled = 0, p->stacked = 1;
  if (lane_of() == 0) w->stack[0] = root.y ? make_int2(root.x, root.y) : make_int2(0, 0);
  do {
    __syncwarp();
    last = !p->stacked && p->leaves <= 32;
    if (p->leaves >= 32 || !p->stacked)
      open_leaves(a, w, p, r, last);
    else
      pop(a, w, p);
  } while (!last);
}

/* Box, mean drift and targets of the threads `on`. */
static __device__ __forceinline__ void set_piece(const Search &a, Desk *w, Piece *p, bool on,
                                                 long i, int4 place)
{
  const double il = 1 / a.unit.length;
  const int c[3] = {place.x, place.y, place.z}, lane = lane_of();
  float d[3] = {0, 0, 0}, at[3], s = 0, h = 0;
  const float share = 1 / (float)__popc(__ballot_sync(ALL, on));
  const float cell = (float)(a.root->edge * PLACE_CELL * il);
  Box b;
#pragma unroll
  for (int k = 0; k < 3; k++) {
    if (on) d[k] = (float)((a.s.y[3 * i + k] - a.s.x[3 * i + k]) * il);
    const int lo = min_all(on ? c[k] : INT32_MAX), hi = -min_all(on ? -c[k] : 0);
    b.drift[k] = add_all(d[k]) * share;
    b.centre[k] = lo + (hi - lo) / 2;
    b.half[k] = (float)(hi - lo) * cell * 0.500001f + cell;
    b.lo[k] = (float)lo * cell * 0.9999996f, b.hi[k] = ((float)hi + 1) * cell * 1.0000004f;
    at[k] = (float)(c[k] - b.centre[k]) * cell;
  }
  if (on) {
    const float off = size3(d[0] - b.drift[0], d[1] - b.drift[1], d[2] - b.drift[2]);
    const double wide = (1 + a.s.margin) * il;
    h = (float)(a.s.h[i] * wide);
    s = fmaxf(0.5f * h, (float)(0.5 * a.s.ha[i] * wide) + off) * 1.000001f + cell;
  }
  b.reach = max_all(s), b.cell = cell, p->loose = b.reach > LOOSE * max_all(h);
  const float n = at[0] * at[0] + at[1] * at[1] + at[2] * at[2];
  const float least = on ? n * (1 - EPS) - s * s * (1 + EPS) : -NEVER;
#pragma unroll
  for (int k = 0; k < 4; k++) {
    const int from = lane % 8 + 8 * k;
    p->x[k] = __shfl_sync(ALL, at[0], from), p->y[k] = __shfl_sync(ALL, at[1], from);
    p->z[k] = __shfl_sync(ALL, at[2], from), p->s[k] = __shfl_sync(ALL, s, from);
    p->least[k] = __shfl_sync(ALL, least, from);
  }
  if (lane == 0) w->box = b;
  __syncwarp();
}

/* Threads whose particle lies further from the one before than both supports. */
static __device__ unsigned jumps(const Search &a, bool on, long i, int4 v)
{
  const float cell = (float)(a.root->edge * PLACE_CELL / a.unit.length);
  const float h = on ? (float)(a.s.h[i] / a.unit.length) : 0, before = __shfl_up_sync(ALL, h, 1);
  const float x = (float)(v.x - __shfl_up_sync(ALL, v.x, 1)) * cell,
              y = (float)(v.y - __shfl_up_sync(ALL, v.y, 1)) * cell,
              z = (float)(v.z - __shfl_up_sync(ALL, v.z, 1)) * cell;
  return __ballot_sync(ALL, on && (lane_of() == 0 || !(size3(x, y, z) <= h + before)));
}

/* All pieces, one after another. */
static __device__ __forceinline__ void search_pieces(const Search &a, Desk *w, Piece *p, Result *r)
{
  const long i = (long)w->first + lane_of();
  const bool on = i < a.s.n;
  const int4 place = on ? a.place[i] : make_int4(0, 0, 0, 0);
  unsigned begin = jumps(a, on, i, place);
  p->tiles = 0;
  while (begin) {
    const int from = __ffs((int)begin) - 1;
    begin &= begin - 1;
    const int end = begin ? __ffs((int)begin) - 1 : 32;
    set_piece(a, w, p, on && lane_of() >= from && lane_of() < end, i, place);
    walk(a, w, p, r);
  }
}

/* Rows for the warp's lists, of which this thread's is `mine` long; false: there is no room. */
static __device__ bool take_rows(const Search &a, uint32_t group, int mine, uint32_t **list)
{
  const int rows = -min_all(-mine);
  unsigned long long at = 0;
  if (lane_of() == 0) {
    at = atomicAdd(&a.report->rows, (unsigned long long)rows);
    a.out.start[group] = (int64_t)at * CUDA_GROUP;
  }
  at = __shfl_sync(ALL, at, 0);
  *list = a.out.list + at * CUDA_GROUP;
  return (int64_t)(at + rows) * CUDA_GROUP <= a.out.room;
}

/* What warp number `warp` searches for: those first that take longest, so that the last to end are
 * not among them; -1: nothing. */
static __device__ __forceinline__ int group_of(const Search &a, int warp)
{
  const int early = min(a.report->scattered, a.most);
  if (warp < early) return a.first[warp];
  const int group = warp - early;
  return (long)group * CUDA_GROUP < a.s.n && !a.is_first[group] ? group : -1;
}

static __global__ void __launch_bounds__(THREADS, 5) search_groups(const __grid_constant__ Search a)
{
  __shared__ Desk desk[WARPS];
  const int lane = lane_of();
  Desk *w = desk + threadIdx.x / 32;
  const int group = group_of(a, (int)blockIdx.x * WARPS + (int)threadIdx.x / 32);
  if (group < 0 || *a.nodes > a.room) return;
  if (lane == 0) w->first = (uint32_t)group * CUDA_GROUP;
  __syncwarp();
  Piece p;
  Result r = {NULL, 0, false};
#pragma unroll 1
  for (int pass = 0; pass == 0 || (pass == 1 && r.again); pass++) {
    search_pieces(a, w, &p, &r);
    if (pass > 0) continue;
    int mine = r.k;
    for (int t = 0; t < p.tiles; t++) mine += __popc(w->hit[32 * t + lane]);
    if ((long)w->first + lane < a.s.n) a.out.count[w->first + lane] = mine;
    if (!take_rows(a, w->first / CUDA_GROUP, mine, &r.rows)) return;
    r.k = 0;
  }
  empty_tiles(w, &p, r.rows, &r.k);
}

/* Room for that many rows and an eighth more, or for them alone where that is too much. */
static int grow_list(Sim *sim, int64_t rows, Err *err)
{
  Lists *l = &cuda_of(sim)->lists;
  const size_t row = CUDA_GROUP * sizeof *l->list, most = (size_t)(rows + rows / 8) + 64;
  cuda_give(sim, (void **)&l->list, (size_t)l->room * sizeof *l->list);
  l->room = 0;
  if (!cuda_alloc(sim, (void **)&l->list, most * row, err)) {
    l->room = (int64_t)most * CUDA_GROUP;
  } else {
    if (cuda_alloc(sim, (void **)&l->list, (size_t)rows * row, err)) return -1;
    l->room = rows * CUDA_GROUP;
  }
  return 0;
}

static int bad_particle(const Report *r, Err *err)
{
  if (r->id != INT64_MAX)
    return err_set(err, "particle %lld: coordinate %g is out of range", (long long)r->id, r->value);
  if (r->loose != INT64_MAX)
    return err_set(err, "particle %lld: its position or smoothing length is not finite", r->loose);
  return 0;
}

int cuda_lists(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaError *error = &c->error;
  struct CudaOrder *o = c->order;
  Report *r = o->host;
  const int most = order_first(sim->s.n);
  const unsigned blocks =
      launch_blocks((size_t)sim->s.n, THREADS) + launch_blocks((size_t)most, WARPS);
  for (;;) {
    Search a = {sim->s,       c->unit,         c->root,
                c->tree.link, c->build->place, c->tree.lo,
                c->tree.hi,   c->build->drift, c->tree.level + CUDA_LEVELS + 1,
                c->tree.room, o->report,       c->lists,
                o->first,     o->is_first,     most};
    CHECK(cudaMemsetAsync(&o->report->rows, 0, sizeof r->rows, c->stream));
    LAUNCH(search_groups, blocks, THREADS, 0, c->stream, a);
    CHECK(cudaMemcpyAsync(r, o->report, sizeof *r, cudaMemcpyDeviceToHost, c->stream));
    CHECK(cudaStreamSynchronize(c->stream));
    if (launch_failed(error, err) || bad_particle(r, err)) return -1;
    if (r->nodes > c->tree.room) {
      if (cuda_tree_grow(sim, r->nodes + r->nodes / 8L, err) || cuda_tree(sim, err)) return -1;
    } else if ((int64_t)r->rows * CUDA_GROUP > c->lists.room) {
      if (grow_list(sim, (int64_t)r->rows, err)) return -1;
    } else {
      break;
    }
  }
  c->tree.nodes = r->nodes, c->tree.levels = r->deepest + 1;
  o->levels = r->deepest;
  return 0;
}

/* What the lists will take: neighbours in the kernel's volume at the particles' own h and density
 * (of at most a million), and the eighth of grow_list. */
size_t cuda_lists_bytes(const Sim *sim, const Parts *p)
{
  static const double ball[] = {0, 2, 3.14159265358979, 4.18879020478639};
  const long stride = p->n / 1000000 + 1;
  const double most = (double)p->n - 1, d = p->dimension;
  const size_t n = (size_t)sim->s.n;
  double sum = 0, seen = 0;
  for (long i = 0; i < p->n; i += stride, seen++)
    sum += fmin(most, ball[p->dimension] * pow(p->h[i], d) * p->rho[i] / p->m[i]);
  return (size_t)(1.125 * sum / seen * (double)(n + CUDA_GROUP)) * sizeof(uint32_t) +
         n * sizeof(int) + (n / CUDA_GROUP + 2) * sizeof(int64_t);
}

/* The list itself begins with what the first search counts. */
int cuda_lists_open(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  const size_t n = (size_t)sim->s.n;
  return cuda_alloc(sim, (void **)&c->lists.start, (n / CUDA_GROUP + 2) * sizeof(int64_t), err) ||
                 cuda_alloc(sim, (void **)&c->lists.count, n * sizeof(int), err)
             ? -1
             : 0;
}

void cuda_lists_close(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  cuda_free(c->lists.start), cuda_free(c->lists.count), cuda_free(c->lists.list);
  memset(&c->lists, 0, sizeof c->lists);
}
