/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Self-gravity of the CUDA backend: bench/gpu_gravity [N ...]. Two touching close-packed spheres of N
 * particles in all, and a sphere in debris out to 1000 radii; theta 0.7; the tree is the host's.
 * Checks sampled particles against direct sums, then prints the table, medians of many. */
#include <algorithm>
#include "solver/cuda/gravity.cu"
#include "tests/gravity_lab.cuh"
extern "C" {
#include "cost.h"
}

enum { SAMPLES = 300, TIMES = 20 };

static void direct_at(const Cloud *c, long i, double a[3])
{
  a[0] = a[1] = a[2] = 0;
  for (long j = 0; j < c->n; j++) {
    double d[3], r2 = 0;
    for (int k = 0; k < 3; k++) d[k] = c->x[3 * j + k] - c->x[3 * i + k], r2 += d[k] * d[k];
    const double r = sqrt(r2), h = 0.5 * (c->h[i] + c->h[j]), s = fmax(r, h);
    const double f = LAB_G * c->m[j] / (s * s * s) * (r < h ? softening_force(r / h) : 1);
    for (int k = 0; k < 3; k++) a[k] += f * d[k];
  }
}

/* Relative errors of sampled accelerations: median and 99 %. */
static void check(const GravityLab *l, double *median, double *p99)
{
  std::vector<double> e(SAMPLES);
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < SAMPLES; k++) {
    const long i = (long)(cloud_random(5, k, 0) * (double)l->c.n);
    double a[3], off = 0, size = 0;
    direct_at(&l->c, i, a);
    for (int d = 0; d < 3; d++) off += pow(l->a[3 * i + d] - a[d], 2), size += a[d] * a[d];
    e[(size_t)k] = sqrt(off / size);
  }
  std::sort(e.begin(), e.end());
  *median = e[SAMPLES / 2], *p99 = e[SAMPLES * 99 / 100];
}

/* Milliseconds of one evaluation. */
static double measure(GravityLab *l)
{
  CudaError *error = &l->cuda.error;
  cudaEvent_t from, to;
  std::vector<float> t;
  Err err;
  CHECK(cudaEventCreate(&from)), CHECK(cudaEventCreate(&to));
  for (int k = 0; k < TIMES + 2; k++) {
    float ms = 0;
    CHECK(cudaEventRecord(from));
    if (cuda_gravity(&l->sim, &err)) lab_die(err.text);
    CHECK(cudaEventRecord(to)), CHECK(cudaEventSynchronize(to));
    CHECK(cudaEventElapsedTime(&ms, from, to));
    if (k >= 2) t.push_back(ms);
  }
  CHECK(cudaEventDestroy(from)), CHECK(cudaEventDestroy(to));
  std::sort(t.begin(), t.end());
  return t[t.size() / 2];
}

static void row(GravityLab *l, int gravity, int precision)
{
  double median, p99;
  char name[64];
  lab_run(l, 0.7, gravity, precision);
  check(l, &median, &p99);
  const Cost cost = cost_of(&l->sim, TIMER_GRAVITY);
  snprintf(name, sizeof name, "%s %s", gravity == PARAM_TREE ? "tree" : "direct",
           precision == PARAM_MIXED ? "mixed" : "double");
  cost_row(name, &cost, 1e6 * measure(l) / (double)l->c.n);
  printf("# error %.1e, 99%% below %.1e\n", median, p99);
}

int main(int argc, char **argv)
{
  const char *sizes[] = {"200000", "1000000"};
  for (int k = 0; k < (argc > 1 ? argc - 1 : 2); k++)
    for (int debris = 0; debris < 2; debris++) {
      const long n = atol(argc > 1 ? argv[k + 1] : sizes[k]);
      if (debris && n > 2000000) continue; /* the host's part takes long */
      const char *what = debris ? "debris" : "spheres";
      GravityLab *l = lab_new(lab_spheres(n, debris));
      cost_head(what, l->c.n);
      row(l, PARAM_TREE, PARAM_MIXED), row(l, PARAM_TREE, PARAM_DOUBLE);
      if (n <= 200000 && !debris)
        row(l, PARAM_DIRECT, PARAM_MIXED), row(l, PARAM_DIRECT, PARAM_DOUBLE);
      lab_free(l);
    }
  return 0;
}
