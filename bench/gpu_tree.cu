/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Order, tree and lists of the CUDA backend: bench/gpu_tree [N ...]. A sphere of N particles on a
 * jittered lattice, 57 neighbours each, moving by a hundredth of a spacing a step. Checks lists of
 * sampled particles against all pairs, then prints the table of the parts, medians of many steps. */
#include <algorithm>
#include "tests/tree_lab.cuh"
extern "C" {
#include "cost.h"
}

enum { SAMPLES = 100, STEPS = 40 };

static Cloud sphere(long n)
{
  const double pi = acos(-1.), radius = 6.4e6, d = radius * cbrt(4 * pi / (3 * (double)n));
  const long w = (long)(radius / d) + 2;
  std::vector<double> x;
  for (long i = 0; i < 8 * w * w * w; i++) {
    const long cell[3] = {i % (2 * w) - w, i / (2 * w) % (2 * w) - w, i / (4 * w * w) - w};
    double p[3], r2 = 0;
    for (int e = 0; e < 3; e++) {
      p[e] = d * ((double)cell[e] + 0.5 * rng_uniform(1, (uint64_t)i, (uint32_t)e)),
      r2 += p[e] * p[e];
    }
    if (r2 < radius * radius) x.insert(x.end(), p, p + 3);
  }
  Cloud c = {};
  c.n = (long)x.size() / 3;
  c.x = (double *)malloc(x.size() * 8), c.y = (double *)malloc(x.size() * 8);
  c.m = (double *)malloc(x.size() * 8), c.h = (double *)malloc(x.size() * 8);
  c.id = (int64_t *)malloc(x.size() * 8);
  for (long i = 0; i < c.n; i++) {
    c.m[i] = 6e24 / (double)c.n, c.h[i] = d * cbrt(57 * 3 / (4 * pi)), c.id[i] = i;
    for (long e = 3 * i; e < 3 * i + 3; e++)
      c.x[e] = x[(size_t)e],
      c.y[e] = x[(size_t)e] + d * (2 + 0.01 * rng_uniform(2, (uint64_t)e, 0));
  }
  return c;
}

static double gap2(const double *x, size_t i, size_t j)
{
  double s = 0;
  for (int d = 0; d < 3; d++) s += (x[3 * i + d] - x[3 * j + d]) * (x[3 * i + d] - x[3 * j + d]);
  return s;
}

static void check(TreeLab *l)
{
  const State &s = l->sim.s;
  const Lists &g = l->cuda.lists;
  const size_t n = (size_t)l->n;
  const std::vector<double> x = tree_lab_get(l, s.x, 3 * n), y = tree_lab_get(l, s.y, 3 * n),
                            h = tree_lab_get(l, s.h, n);
  const std::vector<int> count = tree_lab_get(l, g.count, n);
  const std::vector<int64_t> start = tree_lab_get(l, g.start, (n + 31) / 32);
  long listed = 0, near = 0, all = 0;
  for (int k : count) all += k;
#pragma omp parallel for reduction(+ : listed, near)
  for (int q = 0; q < SAMPLES; q++) {
    const size_t i = (size_t)q * (n / SAMPLES);
    std::vector<uint32_t> row((size_t)count[i]);
#pragma omp critical
    for (size_t k = 0; k < row.size(); k++)
      row[k] = tree_lab_get(l, g.list + start[i / 32] + 32 * (int64_t)k + (int64_t)i % 32, 1)[0];
    size_t at = 0;
    for (size_t j = 0; j < n; j++) {
      const double l2 = 0.25 * (h[i] + h[j]) * (h[i] + h[j]);
      const bool in = at < row.size() && row[at] == j,
                 is = gap2(x.data(), i, j) < l2 || gap2(y.data(), i, j) < l2;
      at += in, listed += in;
      if (i == j) continue;
      near += is;
      if (is && !in) fprintf(stderr, "particle %zu lacks %zu\n", i, j), abort();
    }
    if (at != row.size()) fprintf(stderr, "particle %zu: not ascending\n", i), abort();
  }
  printf("# %.2f neighbours, %.2f listed; mean list %.2f, rows %.2f; nodes %.3f a particle, %d "
         "levels\n",
         (double)near / SAMPLES, (double)listed / SAMPLES, (double)all / (double)n,
         (double)l->cuda.order->host->rows * 32 / (double)n, (double)l->cuda.tree.nodes / (double)n,
         l->cuda.tree.levels);
}

static void need(int failed, const Err *err)
{
  if (failed) tree_lab_die(err);
}

static void bench(long wanted)
{
  Cloud c = sphere(wanted);
  TreeLab *l = tree_lab_open(&c, NULL);
  Sim *sim = &l->sim;
  cudaEvent_t e[4];
  std::vector<float> t[3];
  Err err;
  for (int k = 0; k < 4; k++) cudaEventCreate(&e[k]);
  for (sim->step = 0; sim->step < 3; sim->step++) tree_lab_search(l);
  check(l);
  for (; sim->step < STEPS; sim->step++) {
    cudaEventRecord(e[0], l->cuda.stream), need(cuda_order(sim, &err), &err);
    cudaEventRecord(e[1], l->cuda.stream), need(cuda_tree(sim, &err), &err);
    cudaEventRecord(e[2], l->cuda.stream), need(cuda_lists(sim, &err), &err);
    cudaEventRecord(e[3], l->cuda.stream), cudaEventSynchronize(e[3]);
    for (int k = 0; k < 3; k++) {
      float ms;
      cudaEventElapsedTime(&ms, e[k], e[k + 1]), t[k].push_back(ms);
    }
  }
  const char *name[] = {"order", "tree", "lists"};
  const Cost cost[] = {cost_order(sim), cost_tree(), cost_of(sim, TIMER_SEARCH)};
  cost_head("sphere", l->n);
  for (int k = 0; k < 3; k++) {
    std::sort(t[k].begin(), t[k].end());
    cost_row(name[k], cost + k, 1e6 * t[k][t[k].size() / 2] / (double)l->n);
  }
  free(c.x), free(c.y), free(c.m), free(c.h), free(c.id);
  tree_lab_close(l);
}

int main(int argc, char **argv)
{
  const long standard[] = {200000, 1000000, 10000000};
  for (int k = 1; k < argc; k++) bench(atol(argv[k]));
  for (long n : standard)
    if (argc < 2) bench(n);
  return 0;
}
