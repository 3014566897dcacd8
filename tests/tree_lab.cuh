/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Order, tree and lists of the CUDA backend from plain arrays, and copies of what they make, for
 * tests and benches. Failures abort. */
#ifndef TREE_LAB_CUH
#define TREE_LAB_CUH

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <omp.h>
#include <vector>
#include "solver/cuda/tree.cuh"
extern "C" {
#include "cloud.h"
#include "lib/material.h"
#include "solver/sim.h"
}

typedef struct {
  long n;
  Sim sim;
  Cuda cuda;
  Parts *parts;
} TreeLab;

static inline void tree_lab_die(const Err *err)
{
  fprintf(stderr, "%s\n", err->text);
  abort();
}

/* Device to host, any array of n. */
template <class T> static std::vector<T> tree_lab_get(TreeLab *l, const T *from, size_t n)
{
  Err err;
  std::vector<T> to(n);
  if (cuda_copy(&l->sim, to.data(), from, n * sizeof(T), &err)) tree_lab_die(&err);
  return to;
}

template <class T> static void tree_lab_put(TreeLab *l, T *to, const T *from, size_t n)
{
  Err err;
  if (cuda_copy(&l->sim, to, from, n * sizeof(T), &err)) tree_lab_die(&err);
}

/* The cloud's particles: x, y, m, h (ha is h too), in the order of `row`, and what order, tree and
 * lists need. */
static inline TreeLab *tree_lab_open(const Cloud *c, const long *row)
{
  TreeLab *l = new TreeLab();
  Sim *sim = &l->sim;
  CudaError *error = &l->cuda.error;
  Err err;
  const size_t n = (size_t)c->n;
  Parts *p = part_new(c->n);
  if (!p || part_add(p, "id x v m rho u h mat body", &err) ||
      part_add_material(p, "gas", "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };",
                        &err))
    tree_lab_die(&err);
  std::vector<double> y(3 * n);
  for (size_t k = 0; k < n; k++) {
    const size_t i = row ? (size_t)row[k] : k;
    p->id[k] = c->id[i], p->m[k] = c->m[i], p->h[k] = c->h[i], p->rho[k] = p->u[k] = 1;
    memcpy(p->x + 3 * k, c->x + 3 * i, 24), memcpy(&y[3 * k], c->y + 3 * i, 24);
  }
  p->dimension = 3;
  l->n = c->n, l->parts = p;
  param_defaults(&sim->par);
  sim->materials = p->materials, sim->slots = 1, sim->own = &l->cuda, sim->pull_due = 1;
  sim->s.n = sim->s.all = sim->s.room = c->n, sim->s.dimension = 3;
  CHECK(cudaStreamCreateWithFlags(&l->cuda.stream, cudaStreamNonBlocking));
  if (launch_failed(error, &err) || !(sim->material = material_load(p, &err)) ||
      cuda_state_open(sim, p, &err) || cuda_order_open(sim, &err) || cuda_tree_open(sim, &err) ||
      cuda_lists_open(sim, &err))
    tree_lab_die(&err);
  tree_lab_put(l, sim->s.y, y.data(), 3 * n), tree_lab_put(l, sim->s.ha, p->h, n);
  return l;
}

static inline int tree_lab_try(TreeLab *l, Err *err)
{
  return cuda_order(&l->sim, err) || cuda_tree(&l->sim, err) || cuda_lists(&l->sim, err) ? -1 : 0;
}

static inline void tree_lab_search(TreeLab *l)
{
  Err err;
  if (tree_lab_try(l, &err)) tree_lab_die(&err);
}

static inline void tree_lab_close(TreeLab *l)
{
  cuda_lists_close(&l->sim), cuda_tree_close(&l->sim), cuda_order_close(&l->sim);
  cuda_state_close(&l->sim);
  cudaStreamDestroy(l->cuda.stream);
  part_free(l->parts);
  free(l->sim.material);
  delete l;
}

#endif
