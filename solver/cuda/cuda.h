/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The CUDA backend's own data, shared by its files. Everything stays on the device from open to
 * close; arrays of the state are in Hilbert order and permuted at every search.
 *
 * Precision. The state is double. Pair arithmetic is single (--precision mixed) on differences of
 * coordinates kept as two floats, hi + lo: exact to 2^-48 of the root cube, antisymmetric in the
 * pair, independent of where the group lies, and quick on every card. It runs in code units, powers
 * of two, so that scaling rounds nothing and no power of a length leaves the range of a float. */
#ifndef CUDA_H
#define CUDA_H

extern "C" {
#include "../backend.h"
}
#include "launch.h"
#include <stdlib.h>

enum {
  CUDA_GROUP = 32, /* particles that share a neighbour list block: i / 32, lane i % 32 */
  CUDA_LEVELS = 21
};

/* Code units in SI, powers of two: about an h, a particle's mass, a sound speed. */
typedef struct {
  double length, mass, speed; /* m, kg, m/s */
} Units;

/* The root cube of this search [m]; on the device, read by pointer. */
typedef struct {
  double origin[3], edge;
} Root;

/* Positions of all particles from the root's origin in code units: x = hi.xyz + lo.xyz. */
typedef struct {
  float4 *hi; /* [n] w: h */
  float4 *lo; /* [n] w: m */
} Points;

/* A node's moments in code units from the root's origin: com = hi + lo; q = sum m (3 r_a r_b - r^2
 * delta_ab), trace = sum m r^2 about com, the latter with Plummer's softening only. */
typedef struct {
  float hi[3], mass, lo[3], pad, q[6], trace, pad2;
} Pole;

/* The octree: nodes ordered by level, then along the curve; a node's children are consecutive; the
 * root is node 0. Leaves hold at most TREE_BUCKET particles unless these share a cell of the last
 * level. Boxes are tight, in code units from the root's origin, rounded outwards. */
typedef struct {
  int4 *link;  /* [nodes] x: first child, y: children (0: leaf), z: first particle, w: particles */
  float4 *lo;  /* [nodes] box; w: size, the longest edge of the smallest cell */
  float4 *hi;  /* [nodes] box; w: h_max */
  float4 *com; /* [nodes] centre of mass, rounded; w: mass; this and the next two: if gravity is due
                  and walks the tree */
  Pole *pole;  /* [nodes] */
  double *moment; /* [nodes][10] SI, for the upward pass */
  char2 *span;    /* [n] levels: x: common with the particle before, y: of its leaf */
  int *level; /* [CUDA_LEVELS + 2] first node of each level; level[CUDA_LEVELS + 1]: all nodes */
  int nodes, levels; /* as the host knows them after cuda_tree */
  long room;
} DeviceTree;

/* Neighbour lists: entry k of particle i is list[start[i / 32] + 32 k + i % 32], k < count[i]. A
 * pair is listed when it interacts at x or at y; now and then one more that does not, by rounding:
 * the loops test. Ascending in j. */
typedef struct {
  int64_t *start; /* [groups + 1] */
  int *count;     /* [n] */
  uint32_t *list;
  int64_t room;
} Lists;

typedef struct {
  CudaError error;
  cudaStream_t stream;
  Units unit;
  Root *root;
  Points x;
  void *scratch; /* 8 B a particle, for any pass after the sort */
  DeviceTree tree;
  Lists lists;
  PairRun run;
  struct CudaOrder *order;     /* private to order.cu */
  struct CudaTree *build;      /* private to tree.cu */
  struct CudaLoops *loops;     /* private to loops.cu */
  struct CudaGravity *gravity; /* private to gravity.cu */
  struct CudaReduce *reduce;   /* private to reduce.cu */
  struct CudaStore *store;     /* private to store.cu */
  struct CudaImages *images;   /* private to images.cu; NULL: no faces to be seen through */
  struct CudaClock *clock;     /* private to clock.cu */
  double *flaw;                /* all thresholds */
  Material *material;
  double **table; /* [materials] tables of equations of state; NULL: none */
  size_t bytes;   /* allocated at present */
  int ample;      /* memory is: whole orders and whole files find room to be copied at once */
} Cuda;

static inline Cuda *cuda_of(const Sim *sim) { return (Cuda *)sim->own; }

/* cuda_alloc: zeroed memory of the card; -1 with a message that says what is missing. cuda_free:
 * NULL is fine. cuda_give: frees what was allocated as bytes, in the middle of a run. */
int cuda_alloc(Sim *sim, void **at, size_t bytes, Err *err);
void cuda_free(void *at);
void cuda_give(Sim *sim, void **at, size_t bytes);

/* cuda_state_open: from parts: the arrays of the state, each an allocation of its own (so that
 * pointers may be exchanged with others as long), points, thresholds, materials, code units. Arrays
 * that no pass touches stay NULL. cuda_state_bytes: what that takes. */
int cuda_state_open(Sim *sim, const Parts *parts, Err *err);
size_t cuda_state_bytes(Sim *sim, const Parts *parts);
void cuda_state_close(Sim *sim);

/* cuda_columns: the arrays of the state that this run has, those that move with their particles
 * first; returns how many these are, *all: how many in all. What the others hold is lost in a
 * search. */
typedef struct {
  void **array;    /* where the State has its pointer */
  int width, size; /* elements a particle, bytes an element: 4 or 8 */
} CudaColumn;
enum { CUDA_COLUMNS = 128 };
int cuda_columns(Sim *sim, CudaColumn column[CUDA_COLUMNS], int *all);

/* cuda_store, cuda_fetch: see struct backend. cuda_copy: waits. */
size_t cuda_store_bytes(Sim *sim);
int cuda_store_open(Sim *sim, Err *err);
int cuda_store(Sim *sim, Parts *parts, Err *err);
int cuda_fetch(Sim *sim, Parts *parts, Err *err);
int cuda_copy(Sim *sim, void *to, const void *from, size_t bytes, Err *err);
void cuda_store_close(Sim *sim);

/* cuda_begin, cuda_end: bracket a pass when sim->profile; cuda_clock: adds up what has ended; call
 * it when the stream is idle. */
void cuda_begin(Sim *sim, int timer);
void cuda_end(Sim *sim);
void cuda_clock(Sim *sim);
void cuda_clock_close(Sim *sim);

/* Each part: bytes is what its open will take for sim->s.room rows; open allocates, close frees
 * (also after a failed open); steps return 0 or -1 with a message. Steps that return nothing leave
 * a failure in `error`, which the next step that returns something reports. No step but cuda_lists
 * and the reductions waits for the device. */
size_t cuda_order_bytes(Sim *sim);
int cuda_order_open(Sim *sim, Err *err);
int cuda_order(Sim *sim, Err *err); /* root, keys, sort, permutation; points if gravity is due */
int cuda_leaving(Sim *sim, const Leave *test, long *count, Err *err);
int cuda_keep(Sim *sim, const uint32_t *kept, long n, Err *err);
void cuda_order_close(Sim *sim);
/* cuda_images_find: behind the particles of the old order; cuda_images_order: of the new one.
 * cuda_images_room: rows to begin with. */
long cuda_images_room(const Sim *sim, const Parts *parts);
size_t cuda_images_bytes(Sim *sim);
int cuda_images_open(Sim *sim, Err *err);
int cuda_images_find(Sim *sim, Err *err);
void cuda_images_order(Sim *sim);
void cuda_images_close(Sim *sim);
size_t cuda_tree_bytes(Sim *sim);
int cuda_tree_open(Sim *sim, Err *err);
int cuda_tree(Sim *sim, Err *err); /* nodes, boxes; poles if gravity is due */
void cuda_tree_close(Sim *sim);
size_t cuda_lists_bytes(const Sim *sim, const Parts *parts);
int cuda_lists_open(Sim *sim, Err *err);
int cuda_lists(Sim *sim, Err *err); /* exact; grows them and repeats when they are too short */
void cuda_lists_close(Sim *sim);
size_t cuda_loops_bytes(const Sim *sim);
int cuda_loops_open(Sim *sim, Err *err);
void cuda_gradient(Sim *sim);
void cuda_density(Sim *sim);
void cuda_force(Sim *sim);
void cuda_loops_close(Sim *sim);
size_t cuda_gravity_bytes(const Sim *sim);
int cuda_gravity_open(Sim *sim, Err *err);
int cuda_gravity(Sim *sim, Err *err); /* tree or direct: pull and phi, added to acc */
void cuda_points(Sim *sim, const PointField *field); /* their pull, added to acc */
void cuda_gravity_close(Sim *sim);
size_t cuda_reduce_bytes(void);
int cuda_reduce_open(Sim *sim, Err *err);
int cuda_limits(Sim *sim, const Step *step, Limits *out, Err *err);
int cuda_sums(Sim *sim, Sums *out, Err *err);
int cuda_bodies(Sim *sim, Step *step, Err *err);
int cuda_reaction(Sim *sim, const PointField *field, PointReaction *reaction, Err *err);
int cuda_change(Sim *sim, double *relative, Err *err);
int cuda_error(Sim *sim, const Step *step, double *worst, Err *err);
void cuda_reduce_close(Sim *sim);

/* cuda_bytes: what a run of these particles takes of the card, by `ample` and the sum of all parts;
 * neighbour lists by the particles' h and density. */
size_t cuda_bytes(Sim *sim, const Parts *parts);

#endif
