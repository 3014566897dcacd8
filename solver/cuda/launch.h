/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Launches and checked calls. Both macros expect a `CudaError *error` in scope, in which the first
 * failure stays; they give 0, or -1 when this call failed. After a failure calls are still made (so
 * that memory is freed), kernels are no longer started.
 *
 *   LAUNCH(walk, launch_blocks(n, 128), 128, 0, stream, nodes, n);
 *   CHECK(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream));
 *   return launch_failed(error, err);
 *
 * A template with commas goes in parentheses: LAUNCH((walk<1, 2>), ...). */
#ifndef LAUNCH_H
#define LAUNCH_H

#include <cuda_runtime.h>
#include <stdio.h>
#include <string.h>
extern "C" {
#include "../../lib/err.h"
}

/* Starts as {}. */
typedef struct {
  cudaError_t code;
  char text[512]; /* file:line: call: reason */
} CudaError;

#define CHECK(...) launch_check(error, (__VA_ARGS__), #__VA_ARGS__, __FILE__, __LINE__)

#define LAUNCH(kernel, grid, block, shared_bytes, stream, ...)                                     \
  launch_check(error,                                                                              \
               error->code ? error->code                                                           \
                           : cudaLaunchKernelEx(LaunchShape(grid, block, shared_bytes, stream),    \
                                                kernel, ##__VA_ARGS__),                            \
               #kernel, __FILE__, __LINE__)

/* SHARED_DYNAMIC: `type *name`, the shared memory that the launch asked for, aligned to 16. */
#ifndef SHARED_DYNAMIC /* lint: kernels that run on the host in tests have their own */
#define SHARED_DYNAMIC(type, name)                                                                 \
  extern __shared__ uint4 launch_shared[];                                                         \
  type *name = reinterpret_cast<type *>(launch_shared)
#endif

/* launch_blocks: how many blocks of size threads cover n > 0. */
static inline unsigned launch_blocks(size_t n, unsigned size)
{
  return (unsigned)((n + size - 1) / size);
}

/* launch_check: notes code when it is the first failure. */
static inline int launch_check(CudaError *error, cudaError_t code, const char *call,
                               const char *file, int line)
{
  const char *base = strrchr(file, '/');
  if (code == cudaSuccess) return 0;
  if (error->code) return -1;
  error->code = code;
  snprintf(error->text, sizeof error->text, "%s:%d: %s: %s", base ? base + 1 : file, line, call,
           cudaGetErrorString(code));
  return -1;
}

/* launch_failed: -1 with the message in err when anything has failed so far, else 0. */
static inline int launch_failed(const CudaError *error, Err *err)
{
  return error->code ? err_set(err, "cuda: %s", error->text) : 0;
}

/* What is between <<< and >>>. */
struct LaunchShape {
  cudaLaunchConfig_t config;
  LaunchShape(dim3 grid, dim3 block, size_t shared_bytes, cudaStream_t stream) : config()
  {
    config.gridDim = grid, config.blockDim = block;
    config.dynamicSmemBytes = shared_bytes, config.stream = stream;
  }
  operator const cudaLaunchConfig_t *() const { return &config; }
};

#endif
