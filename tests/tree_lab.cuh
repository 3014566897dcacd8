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

extern "C" const struct backend backend_cuda;

typedef struct {
  long n;
  Sim sim;
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

/* A backend that holds the cloud's particles, x, y, m, h (ha is h too), in the order of `row`. */
static inline TreeLab *tree_lab_open(const Cloud *c, const long *row)
{
  TreeLab *l = new TreeLab();
  Err err;
  Parts *p = part_new(c->n);
  if (!p || part_add(p, "id x v m rho u h mat body", &err) ||
      part_add_material(p, "gas", "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };",
                        &err))
    tree_lab_die(&err);
  std::vector<double> y(3 * (size_t)c->n);
  for (long k = 0; k < c->n; k++) {
    const long i = row ? row[k] : k;
    p->id[k] = c->id[i], p->m[k] = c->m[i], p->h[k] = c->h[i], p->rho[k] = p->u[k] = 1;
    memcpy(p->x + 3 * k, c->x + 3 * i, 24), memcpy(&y[3 * (size_t)k], c->y + 3 * i, 24);
  }
  p->dimension = 3;
  l->n = c->n, l->parts = p, l->sim.b = &backend_cuda;
  param_defaults(&l->sim.par);
  l->sim.materials = p->materials, l->sim.slots = 1;
  if (!(l->sim.material = material_load(p, &err)) || backend_cuda.open(&l->sim, p, &err))
    tree_lab_die(&err);
  Step step = {};
  backend_cuda.pass(&l->sim, PASS_STILL, &step);
  tree_lab_put(l, l->sim.s.y, y.data(), y.size());
  return l;
}

static inline void tree_lab_search(TreeLab *l)
{
  Err err;
  if (backend_cuda.search(&l->sim, &err)) tree_lab_die(&err);
}

static inline void tree_lab_close(TreeLab *l)
{
  backend_cuda.close(&l->sim);
  part_free(l->parts);
  free(l->sim.material);
  delete l;
}

#endif
