/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CUDA itself, as the solver uses it: warp intrinsics, barriers, shared memory, streams, graphs and
 * CUB against plain loops. The same file runs on a device and on the host (tests/host); there it
 * shows as well that mistakes are found. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <algorithm>
#include <numeric>
#include <vector>
#include <cub/cub.cuh>
#include "solver/cuda/launch.h"
extern "C" {
#include <cmocka.h>
}

static CudaError first_error, *error = &first_error;

static void expect_success(void)
{
  if (error->code) fail_msg("%s", error->text);
}

/* A device array from a vector, and back. */
template <class T> static T *up(const std::vector<T> &v)
{
  T *p = nullptr;
  CHECK(cudaMalloc(&p, v.size() * sizeof(T)));
  CHECK(cudaMemcpy(p, v.data(), v.size() * sizeof(T), cudaMemcpyHostToDevice));
  expect_success();
  return p;
}

template <class T> static std::vector<T> down(T *p, size_t n)
{
  std::vector<T> v(n);
  CHECK(cudaMemcpy(v.data(), p, n * sizeof(T), cudaMemcpyDeviceToHost));
  CHECK(cudaFree(p));
  expect_success();
  return v;
}

static std::vector<uint64_t> noise(size_t n)
{
  std::vector<uint64_t> v(n);
  uint64_t x = 88172645463325252u;
  for (uint64_t &e : v) x ^= x << 13, x ^= x >> 7, x ^= x << 17, e = x;
  return v;
}

/* Sort in both forms, by all bits and by some, against std::stable_sort. */
static void sort_is_stable(void **)
{
  for (size_t n : {1, 1000, 5000})
    for (int end : {64, 9}) {
      std::vector<uint64_t> key = noise(n);
      std::vector<int> order(n);
      std::iota(order.begin(), order.end(), 0);
      uint64_t *a = up(key), *b = up(key);
      int *va = up(order), *vb = up(order);
      auto low = [&](int i) {
        return end < 64 ? key[i] >> 3 & ((1u << (end - 3)) - 1) : key[i] >> 3;
      };
      std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return low(i) < low(j); });
      cub::DoubleBuffer<uint64_t> k(a, b);
      cub::DoubleBuffer<int> v(va, vb);
      size_t bytes = 0;
      void *temp = nullptr;
      CHECK(cub::DeviceRadixSort::SortPairs(nullptr, bytes, k, v, n, 3, end));
      CHECK(cudaMalloc(&temp, bytes));
      CHECK(cub::DeviceRadixSort::SortPairs(temp, bytes, k, v, n, 3, end));
      uint64_t *spare = k.Alternate();
      int *vspare = v.Alternate();
      std::vector<int> got = down(v.Current(), n);
      std::vector<uint64_t> sorted = down(k.Current(), n);
      for (size_t i = 0; i < n; i++) {
        assert_int_equal(got[i], order[i]);
        assert_true(sorted[i] == key[order[i]]);
      }
      CHECK(cudaFree(spare)), CHECK(cudaFree(vspare)), CHECK(cudaFree(temp));
    }
  expect_success();
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(sort_is_stable)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
