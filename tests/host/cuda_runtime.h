/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CUDA on the host, for tests: with this folder first in the include path, g++ compiles the same
 * .cu files as nvcc and runs their kernels exactly and slowly (device.h: the kernel's side;
 * threads.h: how they run). This header has the runtime's calls that the solver uses, with the
 * toolkit's signatures. Kernels are launched by cudaLaunchKernelEx (LAUNCH of launch.h), not
 * <<<>>>.
 *
 * Streams are lazy: what is issued runs when somebody waits for it, so that a missing wait shows.
 * HOST_CUDA_STREAMS=eager runs it at once. HOST_CUDA_MEMORY: bytes of the device (default 4 GiB).
 * Copies and pointer arguments are checked against what was allocated; fresh memory is filled with
 * set bits. */
#ifndef HOST_CUDA_RUNTIME_H
#define HOST_CUDA_RUNTIME_H

#include <cstddef>
#include <cstdlib>
#include <functional>
#include <utility>
#include <tuple>
#include "device.h"

#define CUDART_VERSION 12040

/* X(name, number, text) */
/* clang-format off */
#define HOST_ERRORS(X) \
  X(cudaSuccess, 0, "no error") \
  X(cudaErrorInvalidValue, 1, "invalid argument") \
  X(cudaErrorMemoryAllocation, 2, "out of memory") \
  X(cudaErrorInvalidConfiguration, 9, "invalid configuration argument") \
  X(cudaErrorInvalidSymbol, 13, "invalid device symbol") \
  X(cudaErrorInvalidDevicePointer, 17, "invalid device pointer") \
  X(cudaErrorInvalidMemcpyDirection, 21, "invalid copy direction for memcpy") \
  X(cudaErrorInvalidDeviceFunction, 98, "invalid device function") \
  X(cudaErrorNoDevice, 100, "no CUDA-capable device is detected") \
  X(cudaErrorInvalidDevice, 101, "invalid device ordinal") \
  X(cudaErrorInvalidResourceHandle, 400, "invalid resource handle") \
  X(cudaErrorNotReady, 600, "device not ready") \
  X(cudaErrorIllegalAddress, 700, "an illegal memory access was encountered") \
  X(cudaErrorNotSupported, 801, "operation not supported") \
  X(cudaErrorStreamCaptureUnsupported, 900, "operation not permitted when stream is capturing") \
  X(cudaErrorStreamCaptureInvalidated, 901, "operation failed due to a previous error during capture") \
  X(cudaErrorStreamCaptureUnmatched, 903, "capture was not initiated in this stream") \
  X(cudaErrorStreamCaptureUnjoined, 904, "capturing stream has unjoined work") \
  X(cudaErrorGraphExecUpdateFailure, 910, "the graph update was not performed") \
  X(cudaErrorUnknown, 999, "unknown error")
/* clang-format on */

enum cudaError {
#define HOST_ERROR(NAME, NUMBER, TEXT) NAME = NUMBER,
  HOST_ERRORS(HOST_ERROR)
#undef HOST_ERROR
};
typedef enum cudaError cudaError_t;

enum cudaMemcpyKind {
  cudaMemcpyHostToHost,
  cudaMemcpyHostToDevice,
  cudaMemcpyDeviceToHost,
  cudaMemcpyDeviceToDevice,
  cudaMemcpyDefault
};
enum { cudaHostAllocDefault = 0, cudaHostAllocPortable = 1, cudaHostAllocMapped = 2 };
enum { cudaStreamDefault = 0, cudaStreamNonBlocking = 1 };
enum { cudaEventDefault = 0, cudaEventBlockingSync = 1, cudaEventDisableTiming = 2 };
enum cudaStreamCaptureMode {
  cudaStreamCaptureModeGlobal,
  cudaStreamCaptureModeThreadLocal,
  cudaStreamCaptureModeRelaxed
};
enum cudaStreamCaptureStatus {
  cudaStreamCaptureStatusNone,
  cudaStreamCaptureStatusActive,
  cudaStreamCaptureStatusInvalidated
};
enum cudaFuncAttribute {
  cudaFuncAttributeMaxDynamicSharedMemorySize = 8,
  cudaFuncAttributePreferredSharedMemoryCarveout = 9
};
enum cudaDeviceAttr {
  cudaDevAttrMaxThreadsPerBlock = 1,
  cudaDevAttrMaxSharedMemoryPerBlock = 8,
  cudaDevAttrWarpSize = 10,
  cudaDevAttrMultiProcessorCount = 16,
  cudaDevAttrL2CacheSize = 38,
  cudaDevAttrMaxThreadsPerMultiProcessor = 39,
  cudaDevAttrComputeCapabilityMajor = 75,
  cudaDevAttrComputeCapabilityMinor = 76,
  cudaDevAttrMaxSharedMemoryPerMultiprocessor = 81,
  cudaDevAttrMaxSharedMemoryPerBlockOptin = 97
};

typedef struct CUstream_st *cudaStream_t;
typedef struct CUevent_st *cudaEvent_t;
typedef struct CUgraph_st *cudaGraph_t;
typedef struct CUgraphExec_st *cudaGraphExec_t;
typedef void (*cudaHostFn_t)(void *);

struct cudaDeviceProp {
  char name[256];
  size_t totalGlobalMem, sharedMemPerBlock, sharedMemPerBlockOptin, sharedMemPerMultiprocessor;
  int major, minor, multiProcessorCount, warpSize, maxThreadsPerBlock, maxThreadsPerMultiProcessor;
  int maxThreadsDim[3], maxGridSize[3], regsPerBlock, regsPerMultiprocessor;
  int l2CacheSize, memoryBusWidth, pciBusID, pciDeviceID, pciDomainID, canMapHostMemory;
};
struct cudaFuncAttributes {
  size_t sharedSizeBytes, constSizeBytes, localSizeBytes;
  int maxThreadsPerBlock, numRegs, maxDynamicSharedSizeBytes;
};
struct cudaGraphExecUpdateResultInfo {
  int result;
};
struct cudaLaunchAttribute;
struct cudaLaunchConfig_t {
  dim3 gridDim, blockDim;
  size_t dynamicSmemBytes;
  cudaStream_t stream;
  cudaLaunchAttribute *attrs;
  unsigned numAttrs;
};

cudaError_t cudaGetLastError();
cudaError_t cudaPeekAtLastError();
const char *cudaGetErrorString(cudaError_t code);
const char *cudaGetErrorName(cudaError_t code);

cudaError_t cudaGetDeviceCount(int *count);
cudaError_t cudaGetDevice(int *device);
cudaError_t cudaSetDevice(int device);
cudaError_t cudaDeviceReset();
cudaError_t cudaDeviceSynchronize();
cudaError_t cudaGetDeviceProperties(cudaDeviceProp *p, int device);
cudaError_t cudaDeviceGetAttribute(int *value, cudaDeviceAttr attribute, int device);
cudaError_t cudaMemGetInfo(size_t *available, size_t *total);
cudaError_t cudaDriverGetVersion(int *version);
cudaError_t cudaRuntimeGetVersion(int *version);

cudaError_t cudaMalloc(void **p, size_t bytes);
cudaError_t cudaMallocAsync(void **p, size_t bytes, cudaStream_t stream);
cudaError_t cudaFree(void *p);
cudaError_t cudaFreeAsync(void *p, cudaStream_t stream);
cudaError_t cudaMallocHost(void **p, size_t bytes, unsigned flags = 0);
cudaError_t cudaHostAlloc(void **p, size_t bytes, unsigned flags);
cudaError_t cudaFreeHost(void *p);
cudaError_t cudaHostGetDevicePointer(void **device, void *p, unsigned flags);
cudaError_t cudaMemcpy(void *to, const void *from, size_t bytes, cudaMemcpyKind kind);
cudaError_t cudaMemcpyAsync(void *to, const void *from, size_t bytes, cudaMemcpyKind kind,
                            cudaStream_t stream = nullptr);
cudaError_t cudaMemset(void *p, int value, size_t bytes);
cudaError_t cudaMemsetAsync(void *p, int value, size_t bytes, cudaStream_t stream = nullptr);

cudaError_t cudaStreamCreate(cudaStream_t *stream);
cudaError_t cudaStreamCreateWithFlags(cudaStream_t *stream, unsigned flags);
cudaError_t cudaStreamCreateWithPriority(cudaStream_t *stream, unsigned flags, int priority);
cudaError_t cudaDeviceGetStreamPriorityRange(int *least, int *greatest);
cudaError_t cudaStreamDestroy(cudaStream_t stream);
cudaError_t cudaStreamSynchronize(cudaStream_t stream);
cudaError_t cudaStreamQuery(cudaStream_t stream);
cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned flags = 0);
cudaError_t cudaLaunchHostFunc(cudaStream_t stream, cudaHostFn_t f, void *data);
cudaError_t cudaEventCreate(cudaEvent_t *event);
cudaError_t cudaEventCreateWithFlags(cudaEvent_t *event, unsigned flags);
cudaError_t cudaEventDestroy(cudaEvent_t event);
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream = nullptr);
cudaError_t cudaEventSynchronize(cudaEvent_t event);
cudaError_t cudaEventQuery(cudaEvent_t event);
cudaError_t cudaEventElapsedTime(float *ms, cudaEvent_t start, cudaEvent_t end);

/* A graph is the list of what was issued between begin and end, arguments by value. */
cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode mode);
cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t *graph);
cudaError_t cudaStreamIsCapturing(cudaStream_t stream, cudaStreamCaptureStatus *status);
cudaError_t cudaGraphInstantiate(cudaGraphExec_t *exec, cudaGraph_t graph,
                                 unsigned long long flags = 0);
cudaError_t cudaGraphExecUpdate(cudaGraphExec_t exec, cudaGraph_t graph,
                                cudaGraphExecUpdateResultInfo *info);
cudaError_t cudaGraphUpload(cudaGraphExec_t exec, cudaStream_t stream);
cudaError_t cudaGraphLaunch(cudaGraphExec_t exec, cudaStream_t stream);
cudaError_t cudaGraphExecDestroy(cudaGraphExec_t exec);
cudaError_t cudaGraphDestroy(cudaGraph_t graph);

namespace host
{

enum { SHARED = 48 * 1024, SHARED_OPTIN = 227 * 1024, SHARED_ALL = 228 * 1024 }; /* bytes */

/* issue: f in the stream's order, or into the graph that the stream records. name, for a graph's
 * update: node by node these must be the same. */
cudaError_t issue(cudaStream_t stream, const char *name, std::function<void()> f);
/* launch_checks: whether the device would take this launch. */
cudaError_t launch_checks(const cudaLaunchConfig_t *c, const void *kernel);
cudaError_t launch_issue(const char *name, const cudaLaunchConfig_t *c, std::function<void()> body);
cudaError_t launch_attribute(const void *kernel, cudaFuncAttribute attribute, int value);
cudaError_t symbol(const void *p, size_t bytes); /* a __device__ variable is known from now on */
bool reachable(const volatile void *p); /* from the device: allocated there, or pinned here */
/* done: keeps code for cudaGetLastError; returns it. */
cudaError_t done(cudaError_t code);

template <class T> bool argument_ok(const T &) { return true; }
template <class T> bool argument_ok(T *const &p) { return !p || reachable(p); }

template <class... P, class... A>
cudaError_t launch(const char *name, const cudaLaunchConfig_t *c, void (*kernel)(P...), A &&...a)
{
  static_assert(sizeof...(P) == sizeof...(A), "arguments of a kernel");
  static_assert(((std::is_trivially_copyable<P>::value && !std::is_reference<P>::value) && ...),
                "a kernel takes plain values");
  static_assert((sizeof(P) + ... + 0) <= 4096, "a kernel takes 4 KB at most");
  std::tuple<P...> arguments(std::forward<A>(a)...);
  cudaError_t code = launch_checks(c, reinterpret_cast<const void *>(kernel));
  bool good = std::apply([](const P &...p) { return (argument_ok(p) && ...); }, arguments);
  if (code != cudaSuccess || !good) return done(code ? code : cudaErrorInvalidDevicePointer);
  return launch_issue(name, c, [=] { std::apply(kernel, arguments); });
}

} // namespace host

#define cudaLaunchKernelEx(CONFIG, KERNEL, ...) host::launch(#KERNEL, CONFIG, KERNEL, ##__VA_ARGS__)

template <class T> cudaError_t cudaMalloc(T **p, size_t bytes)
{
  return cudaMalloc(reinterpret_cast<void **>(p), bytes);
}
template <class T> cudaError_t cudaMallocAsync(T **p, size_t bytes, cudaStream_t stream)
{
  return cudaMallocAsync(reinterpret_cast<void **>(p), bytes, stream);
}
template <class T> cudaError_t cudaMallocHost(T **p, size_t bytes, unsigned flags = 0)
{
  return cudaMallocHost(reinterpret_cast<void **>(p), bytes, flags);
}
template <class T> cudaError_t cudaHostAlloc(T **p, size_t bytes, unsigned flags)
{
  return cudaHostAlloc(reinterpret_cast<void **>(p), bytes, flags);
}
template <class T> cudaError_t cudaHostGetDevicePointer(T **device, void *p, unsigned flags)
{
  return cudaHostGetDevicePointer(reinterpret_cast<void **>(device), p, flags);
}

/* Symbols: the variable itself. */
template <class T> cudaError_t cudaGetSymbolAddress(void **p, const T &s)
{
  *p = const_cast<void *>(static_cast<const void *>(&s));
  return host::symbol(&s, sizeof s);
}
template <class T>
cudaError_t cudaMemcpyToSymbolAsync(const T &s, const void *from, size_t bytes, size_t offset,
                                    cudaMemcpyKind kind, cudaStream_t stream = nullptr)
{
  host::symbol(&s, sizeof s);
  char *to = reinterpret_cast<char *>(const_cast<T *>(&s)) + offset;
  return cudaMemcpyAsync(to, from, bytes, kind, stream);
}
template <class T>
cudaError_t cudaMemcpyToSymbol(const T &s, const void *from, size_t bytes, size_t offset = 0,
                               cudaMemcpyKind kind = cudaMemcpyHostToDevice)
{
  host::symbol(&s, sizeof s);
  return cudaMemcpy(reinterpret_cast<char *>(const_cast<T *>(&s)) + offset, from, bytes, kind);
}
template <class T>
cudaError_t cudaMemcpyFromSymbol(void *to, const T &s, size_t bytes, size_t offset = 0,
                                 cudaMemcpyKind kind = cudaMemcpyDeviceToHost)
{
  host::symbol(&s, sizeof s);
  return cudaMemcpy(to, reinterpret_cast<const char *>(&s) + offset, bytes, kind);
}

/* Kernels: made-up properties, the true limits of launches. */
template <class K>
cudaError_t cudaFuncSetAttribute(K *kernel, cudaFuncAttribute attribute, int value)
{
  return host::launch_attribute(reinterpret_cast<const void *>(kernel), attribute, value);
}
template <class K> cudaError_t cudaFuncGetAttributes(cudaFuncAttributes *a, K *)
{
  *a = {0, 0, 0, 1024, 32, host::SHARED};
  return host::done(cudaSuccess);
}
template <class K>
cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessor(int *blocks, K *, int threads,
                                                          size_t shared)
{
  int by_shared = shared ? (int)(host::SHARED_ALL / (shared + 1024)) : 32;
  *blocks = min(min(2048 / threads, 32), by_shared);
  return host::done(cudaSuccess);
}

#endif
