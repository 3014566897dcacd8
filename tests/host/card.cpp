/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the made-up device says of itself, and what its errors mean. */
#include "cuda_runtime.h"

using host::done;

const char *cudaGetErrorString(cudaError_t code)
{
  switch (code) {
#define HOST_ERROR(NAME, NUMBER, TEXT)                                                             \
  case NAME: return TEXT;
    HOST_ERRORS(HOST_ERROR)
#undef HOST_ERROR
  }
  return "unrecognized error code";
}

const char *cudaGetErrorName(cudaError_t code)
{
  switch (code) {
#define HOST_ERROR(NAME, NUMBER, TEXT)                                                             \
  case NAME: return #NAME;
    HOST_ERRORS(HOST_ERROR)
#undef HOST_ERROR
  }
  return "unrecognized error code";
}

cudaError_t cudaGetDeviceCount(int *count)
{
  *count = 1;
  return done(cudaSuccess);
}

cudaError_t cudaGetDevice(int *device)
{
  *device = 0;
  return done(cudaSuccess);
}

cudaError_t cudaSetDevice(int device)
{
  return done(device ? cudaErrorInvalidDevice : cudaSuccess);
}

cudaError_t cudaGetDeviceProperties(cudaDeviceProp *p, int device)
{
  if (device != 0) return done(cudaErrorInvalidDevice);
  size_t free_bytes;
  memset(p, 0, sizeof *p);
  snprintf(p->name, sizeof p->name, "CUDA on the host");
  cudaMemGetInfo(&free_bytes, &p->totalGlobalMem);
  p->sharedMemPerBlock = host::SHARED, p->sharedMemPerBlockOptin = host::SHARED_OPTIN;
  p->sharedMemPerMultiprocessor = host::SHARED_ALL;
  p->major = 9, p->minor = 0, p->multiProcessorCount = 4, p->warpSize = 32;
  p->maxThreadsPerBlock = 1024, p->maxThreadsPerMultiProcessor = 2048;
  p->maxThreadsDim[0] = p->maxThreadsDim[1] = 1024, p->maxThreadsDim[2] = 64;
  p->maxGridSize[0] = 0x7fffffff, p->maxGridSize[1] = p->maxGridSize[2] = 65535;
  p->regsPerBlock = p->regsPerMultiprocessor = 65536;
  p->l2CacheSize = 1 << 20, p->memoryBusWidth = 64, p->canMapHostMemory = 1;
  return done(cudaSuccess);
}

cudaError_t cudaDeviceGetAttribute(int *value, cudaDeviceAttr attribute, int device)
{
  cudaDeviceProp p;
  if (cudaGetDeviceProperties(&p, device) != cudaSuccess) return cudaErrorInvalidDevice;
  switch (attribute) {
  case cudaDevAttrMaxThreadsPerBlock: *value = p.maxThreadsPerBlock; break;
  case cudaDevAttrMaxSharedMemoryPerBlock: *value = (int)p.sharedMemPerBlock; break;
  case cudaDevAttrWarpSize: *value = p.warpSize; break;
  case cudaDevAttrMultiProcessorCount: *value = p.multiProcessorCount; break;
  case cudaDevAttrL2CacheSize: *value = p.l2CacheSize; break;
  case cudaDevAttrMaxThreadsPerMultiProcessor: *value = p.maxThreadsPerMultiProcessor; break;
  case cudaDevAttrComputeCapabilityMajor: *value = p.major; break;
  case cudaDevAttrComputeCapabilityMinor: *value = p.minor; break;
  case cudaDevAttrMaxSharedMemoryPerMultiprocessor:
    *value = (int)p.sharedMemPerMultiprocessor;
    break;
  case cudaDevAttrMaxSharedMemoryPerBlockOptin: *value = (int)p.sharedMemPerBlockOptin; break;
  default: return done(cudaErrorInvalidValue);
  }
  return done(cudaSuccess);
}

cudaError_t cudaDriverGetVersion(int *version)
{
  *version = CUDART_VERSION;
  return done(cudaSuccess);
}

cudaError_t cudaRuntimeGetVersion(int *version) { return cudaDriverGetVersion(version); }
