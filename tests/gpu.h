/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For tests of CUDA code, on a device or on the host (tests/host): arrays up and down, failures.
 * Include it last: cmocka has a macro `fail`. */
#ifndef TESTS_GPU_H
#define TESTS_GPU_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <vector>
#include "solver/cuda/launch.h"
extern "C" {
#include <cmocka.h>
}

enum : unsigned { FULL = ~0u }; /* all lanes */

static CudaError first_error, *error = &first_error;

static inline void expect_success(void)
{
  if (error->code) fail_msg("%s", error->text);
}

/* The failure so far is this one; forgotten then. */
static inline void expect_error(cudaError_t code)
{
  assert_int_equal(error->code, code);
  cudaGetLastError();
  *error = CudaError();
}

template <class T> static inline T *room(size_t n)
{
  T *p = nullptr;
  CHECK(cudaMalloc(&p, n * sizeof(T)));
  expect_success();
  return p;
}

/* A device array from a vector, and back (then freed). */
template <class T> static inline T *up(const std::vector<T> &v)
{
  T *p = room<T>(v.size());
  CHECK(cudaMemcpy(p, v.data(), v.size() * sizeof(T), cudaMemcpyHostToDevice));
  expect_success();
  return p;
}

template <class T> static inline std::vector<T> down(T *p, size_t n)
{
  std::vector<T> v(n);
  CHECK(cudaMemcpy(v.data(), p, n * sizeof(T), cudaMemcpyDeviceToHost));
  CHECK(cudaFree(p));
  expect_success();
  return v;
}

template <class T> static inline std::vector<T> noise(size_t n)
{
  std::vector<T> v(n);
  uint64_t x = 88172645463325252u;
  for (T &e : v) {
    x ^= x << 13, x ^= x >> 7, x ^= x << 17;
    e = (T)x;
  }
  return v;
}

#endif
