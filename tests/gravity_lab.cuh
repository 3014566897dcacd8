/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gravity on the device by itself, for its test and its bench: particles in Hilbert order, the tree
 * of lib/tree in the form of cuda.h, and a Sim that holds just that. */
#ifndef GRAVITY_LAB_CUH
#define GRAVITY_LAB_CUH

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <omp.h>
#include <vector>
#include "solver/cuda/cuda.h"
extern "C" {
#include "lib/gravity.h"
#include "lib/lattice.h"
#include "cloud.h"
}

static const double LAB_G = 6.67430e-11;

typedef struct {
  Cloud c;
  Tree host;
  Sim sim;
  Cuda cuda;
  double *a, *phi; /* from the device */
  double *acc;     /* pull added to what was there before: x, say */
} GravityLab;

static void lab_die(const char *what)
{
  fprintf(stderr, "%s\n", what);
  abort();
}

/* A device copy of a vector. */
template <class T> static T *lab_up(GravityLab *l, const T *from, size_t n)
{
  CudaError *error = &l->cuda.error;
  void *p = NULL;
  CHECK(cudaMalloc(&p, (n ? n : 1) * sizeof(T)));
  CHECK(cudaMemcpy(p, from, n * sizeof(T), cudaMemcpyHostToDevice));
  if (error->code) lab_die(error->text);
  return (T *)p;
}

template <class T> static void lab_down(GravityLab *l, T *to, const T *from, size_t n)
{
  CudaError *error = &l->cuda.error;
  CHECK(cudaMemcpy(to, from, n * sizeof(T), cudaMemcpyDeviceToHost));
  if (error->code) lab_die(error->text);
}

static inline float lab_down_to(double x) { return nextafterf((float)x, -INFINITY); }
static inline float lab_up_to(double x) { return nextafterf((float)x, INFINITY); }

static void lab_points(GravityLab *l)
{
  const Cloud *c = &l->c;
  const double *o = l->host.origin, il = 1 / l->cuda.unit.length;
  std::vector<float4> hi((size_t)c->n), lo((size_t)c->n);
  for (long i = 0; i < c->n; i++) {
    double x[3];
    float h[3];
    for (int d = 0; d < 3; d++) x[d] = (c->x[3 * i + d] - o[d]) * il, h[d] = (float)x[d];
    hi[i] = {h[0], h[1], h[2], (float)(c->h[i] * il)};
    lo[i] = {(float)(x[0] - h[0]), (float)(x[1] - h[1]), (float)(x[2] - h[2]),
             (float)(c->m[i] / l->cuda.unit.mass)};
  }
  l->cuda.x.hi = lab_up(l, hi.data(), hi.size()), l->cuda.x.lo = lab_up(l, lo.data(), lo.size());
}

/* The host's nodes by level, children consecutive. */
static void lab_tree(GravityLab *l)
{
  const Tree *t = &l->host;
  const size_t n = (size_t)t->nodes;
  const double *o = t->origin, il = 1 / l->cuda.unit.length, im = 1 / l->cuda.unit.mass;
  std::vector<int> from = {0}, children(n, 0), first(n, 0);
  for (size_t k = 0; k < from.size(); k++) {
    const TreeNode *p = t->node + from[k];
    first[k] = (int)from.size();
    for (int32_t c = from[k] + 1; c < p->skip; c = t->node[c].skip)
      from.push_back(c), children[k]++;
  }
  std::vector<int4> link(n);
  std::vector<float4> lo(n), hi(n), com(n);
  std::vector<Pole> pole(n);
  std::vector<double> moment(10 * n);
  for (size_t k = 0; k < n; k++) {
    const TreeNode *p = t->node + from[k];
    double x[3];
    Pole q = {};
    for (int d = 0; d < 3; d++) {
      x[d] = (p->com[d] - o[d]) * il;
      q.hi[d] = (float)x[d], q.lo[d] = (float)(x[d] - q.hi[d]);
      moment[10 * k + 1 + d] = p->com[d];
    }
    moment[10 * k] = p->mass, q.mass = (float)(p->mass * im);
    for (int d = 0; d < 6; d++)
      moment[10 * k + 4 + d] = p->q[d], q.q[d] = (float)(p->q[d] * im * il * il);
    for (long i = p->first; i < p->first + (long)p->count; i++)
      for (int d = 0; d < 3; d++)
        q.trace += (float)(l->c.m[i] * pow(l->c.x[3 * i + d] - p->com[d], 2) * im * il * il);
    pole[k] = q;
    com[k] = {q.hi[0], q.hi[1], q.hi[2], q.mass};
    link[k] = {first[k], children[k], p->first, p->count};
    lo[k] = {lab_down_to((p->lo[0] - o[0]) * il), lab_down_to((p->lo[1] - o[1]) * il),
             lab_down_to((p->lo[2] - o[2]) * il), lab_up_to(p->size * il)};
    hi[k] = {lab_up_to((p->hi[0] - o[0]) * il), lab_up_to((p->hi[1] - o[1]) * il),
             lab_up_to((p->hi[2] - o[2]) * il), lab_up_to(p->hmax * il)};
  }
  std::vector<char2> span((size_t)l->c.n, make_char2(1, 1)); /* x < y: a leaf begins */
  for (size_t k = 0; k < n; k++)
    if (!children[k]) span[(size_t)link[k].z].x = 0;
  DeviceTree *d = &l->cuda.tree;
  d->span = lab_up(l, span.data(), span.size());
  d->link = lab_up(l, link.data(), n), d->lo = lab_up(l, lo.data(), n),
  d->hi = lab_up(l, hi.data(), n);
  d->com = lab_up(l, com.data(), n), d->pole = lab_up(l, pole.data(), n);
  d->moment = lab_up(l, moment.data(), 10 * n), d->nodes = t->nodes;
}

/* lab_new: takes c over. The unit of length is about the h of the first particle, that of mass its
 * mass. */
static GravityLab *lab_new(Cloud c)
{
  GravityLab *l = (GravityLab *)calloc(1, sizeof *l);
  Err err;
  int e;
  l->c = c;
  if (tree_build(&l->host, c.n, c.x, c.m, c.h, &err)) lab_die(err.text);
  frexp(c.h[0], &e), l->cuda.unit.length = ldexp(1, e);
  frexp(c.m[0], &e), l->cuda.unit.mass = ldexp(1, e);
  l->sim.own = &l->cuda, l->sim.pull_due = 1;
  l->sim.s.n = l->sim.s.all = l->sim.s.room = c.n, l->sim.s.dimension = 3;
  l->sim.par.G = LAB_G, l->sim.par.gravity = PARAM_TREE, l->sim.par.theta = 0.7;
  Root root = {{l->host.origin[0], l->host.origin[1], l->host.origin[2]}, l->host.edge};
  l->cuda.root = lab_up(l, &root, 1);
  lab_points(l), lab_tree(l);
  l->cuda.scratch = lab_up(l, c.x, (size_t)c.n);
  State *s = &l->sim.s;
  const size_t n = (size_t)c.n;
  s->x = lab_up(l, c.x, 3 * n), s->m = lab_up(l, c.m, n), s->h = lab_up(l, c.h, n);
  s->acc = lab_up(l, c.x, 3 * n), s->phi = lab_up(l, c.m, n);
  s->pull = lab_up(l, c.x, 3 * n);
  l->a = (double *)calloc(n, 24), l->phi = (double *)calloc(n, 8), l->acc = (double *)calloc(n, 24);
  if (cuda_gravity_open(&l->sim, &err)) lab_die(err.text);
  return l;
}

static void lab_run(GravityLab *l, double theta, int gravity, int precision)
{
  CudaError *error = &l->cuda.error;
  Err err;
  const size_t n = (size_t)l->c.n;
  l->sim.par.theta = theta, l->sim.par.gravity = gravity, l->sim.par.precision = precision;
  CHECK(cudaMemcpy(l->sim.s.acc, l->c.x, 24 * n, cudaMemcpyHostToDevice));
  if (cuda_gravity(&l->sim, &err)) lab_die(err.text);
  CHECK(cudaDeviceSynchronize());
  lab_down(l, l->a, l->sim.s.pull, 3 * n), lab_down(l, l->phi, l->sim.s.phi, n);
  lab_down(l, l->acc, l->sim.s.acc, 3 * n);
}

static void lab_free(GravityLab *l)
{
  DeviceTree *t = &l->cuda.tree;
  State *s = &l->sim.s;
  void *all[] = {t->link,      t->lo,        t->hi,        t->com,        t->pole,        t->moment,
                 l->cuda.x.hi, l->cuda.x.lo, l->cuda.root, l->sim.s.pull, s->x,           s->m,
                 s->h,         s->acc,       s->phi,       t->span,       l->cuda.scratch};
  cuda_gravity_close(&l->sim);
  for (void *p : all) cudaFree(p);
  tree_free(&l->host), cloud_free(&l->c);
  free(l->a), free(l->phi), free(l->acc), free(l);
}

/* lab_cloud: from places [n][3] (freed), equal masses, one h. */
static Cloud lab_cloud(long n, double *raw, double h)
{
  Cloud c = cloud_room(n);
  long *order = (long *)calloc((size_t)n, sizeof *order);
  Err err;
  if (tree_order(n, raw, NULL, 0, order, &err)) lab_die(err.text);
  for (long k = 0; k < n; k++) {
    memcpy(c.x + 3 * k, raw + 3 * order[k], 24);
    c.id[k] = order[k], c.m[k] = 1e20 / (double)n, c.h[k] = h;
  }
  free(raw), free(order);
  return c;
}

/* lab_spheres: two that touch, close-packed, n particles in all; debris: instead of the second, as
 * many particles around the first, as many between any r and 2 r, out to 1000 radii. */
static Cloud lab_spheres(long n, int debris)
{
  LatticeBall ball;
  Err err;
  if (lattice_ball(&ball, LATTICE_HCP, 3, n / 2, &err)) lab_die(err.text);
  const double pi = acos(-1), radius = 2e5,
               a = radius * cbrt(4 * pi / (3 * (double)ball.n * ball.volume)),
               h = a * cbrt(57 * 3 / (4 * pi) * ball.volume);
  double *x = (double *)calloc((size_t)ball.n, 48), p[3];
  for (long i = 0; i < ball.n; i++) {
    const double *site = ball.x + 3 * i, z = 2 * cloud_random(77, i, 0) - 1,
                 f = 2 * pi * cloud_random(77, i, 1),
                 r = 1.01 * radius * pow(1000, cloud_random(77, i, 2));
    p[0] = r * sqrt(1 - z * z) * cos(f), p[1] = r * sqrt(1 - z * z) * sin(f), p[2] = r * z;
    for (int d = 0; d < 3; d++) {
      x[3 * i + d] = a * site[d];
      x[3 * (ball.n + i) + d] = debris ? p[d] : a * site[d] + (d == 0 ? 2 * radius : 0);
    }
  }
  n = 2 * ball.n;
  lattice_free(&ball);
  return lab_cloud(n, x, h);
}

#endif
