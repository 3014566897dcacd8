/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a kernel sees: qualifiers, its place in the grid, barriers, warp intrinsics, atomics, maths.
 * Each CUDA thread is a fiber of threads.cpp. Barriers and *_sync intrinsics are meetings of all
 * threads that they name and that have not exited; who does not come is reported, with the source
 * line, and the program aborts. Not there, because not to be used: __activemask, atomics on
 * floating point, shuffles without a mask. A lane that reads from one that is not at the meeting
 * gets bits that are all set (a NaN, a -1). */
#ifndef HOST_DEVICE_H
#define HOST_DEVICE_H

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <math.h>
#include <type_traits>
#include "vector.h"

#ifdef __SANITIZE_ADDRESS__
#define HOST_ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HOST_ASAN 1
#endif
#endif

/* As nvcc would have it; code that asks for __NVCC__ still sees who compiles. */
#define __CUDACC__ 1
#define __global__
#define __device__
#define __host__
#define __constant__
#define __grid_constant__
#define __forceinline__ inline __attribute__((always_inline))
#define __align__(n)    __attribute__((aligned(n)))
#define __launch_bounds__(...)
#define __builtin_assume(x) host::assume((x), #x, __FILE__, __LINE__)
#define __assume(x)         __builtin_assume(x)

/* Static shared memory: one copy, blocks run one after another. As thread-local it stands together
 * and is overwritten before each block; under the address sanitizer it has red zones instead. The
 * alignment, as gcc 12 vectorises for one that it does not ask the linker for. */
#ifdef HOST_ASAN
#define __shared__ static
#else
#define __shared__ alignas(64) static thread_local
#endif
#define SHARED_DYNAMIC(type, name) type *name = reinterpret_cast<type *>(host::grid.shared)

#define HOST_SITE const char *file = __builtin_FILE(), int line = __builtin_LINE()

namespace host
{

/* Lanes of a warp at one operation: who has come, with what. */
struct Meeting {
  const char *op, *file;
  int line;
  unsigned mask, came;
  int readers;
  uint64_t value[32];
};

struct Warp;
struct Thread {
  uint3 index; /* threadIdx */
  int rank;    /* in the block */
  int lane;
  Warp *warp;
  Meeting *meeting; /* the last one it went to */
};

struct Grid {
  const char *kernel;
  unsigned char *shared; /* dynamic shared memory of the block */
};

struct Count {
  int yes, all;
};

extern Thread *self; /* the thread that runs */
extern Grid grid;    /* the grid that runs */

/* meet: waits for the lanes of mask; the meeting stays readable until the caller's next one. */
const Meeting &meet(const char *op, unsigned mask, uint64_t value, const char *file, int line);
/* barrier: waits for the block; how many said yes. */
Count barrier(const char *op, int yes, const char *file, int line);
/* yield: lets others run. */
void yield();
/* wrong: says kernel, block, thread and what is wrong; aborts. */
[[noreturn]] void wrong(const char *file, int line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static inline void assume(bool holds, const char *what, const char *file, int line)
{
  if (!holds) wrong(file, line, "__builtin_assume(%s) does not hold", what);
}

template <class T> uint64_t bits(T value)
{
  static_assert(std::is_arithmetic<T>::value && (sizeof(T) == 4 || sizeof(T) == 8),
                "a warp intrinsic takes numbers of 4 or 8 bytes");
  uint64_t b = 0;
  memcpy(&b, &value, sizeof value);
  return b;
}

/* from: what a lane brought to the meeting. */
template <class T> T from(const Meeting &m, int lane)
{
  uint64_t b = m.came >> lane & 1 ? m.value[lane] : ~(uint64_t)0;
  T value;
  memcpy(&value, &b, sizeof value);
  return value;
}

/* shuffle: own value unless source lies within first..last. */
template <class T>
T shuffle(const char *op, unsigned mask, T value, int source, int width, bool up, const char *file,
          int line)
{
  int lane = self->lane, first = lane & ~(width - 1), last = first + width - 1;
  if (width < 1 || width > 32 || (width & (width - 1)))
    wrong(file, line, "%s: width %d", op, width);
  const Meeting &m = meet(op, mask, bits(value), file, line);
  return from<T>(m, (up ? source < first : source > last) ? lane : source);
}

template <class T, class F>
T reduce(const char *op, unsigned mask, T value, F f, const char *file, int line)
{
  const Meeting &m = meet(op, mask, bits(value), file, line);
  for (int lane = 0; lane < 32; lane++)
    if (lane != self->lane && m.came >> lane & 1) value = f(value, from<T>(m, lane));
  return value;
}

template <class T, class F> T update(T *p, F f)
{
  T old = *p;
  *p = f(old);
  return old;
}

/* rounded: x, which the compiler may not take into a fused multiply-add, nor take for the number
 * that it is the rounding of (gcc 12 does so with vectors). */
template <class T> T rounded(T x)
{
  __asm__ __volatile__("" : "+m"(x));
  return x;
}

} // namespace host

extern uint3 threadIdx, blockIdx;
extern dim3 blockDim, gridDim;
static const int warpSize = 32;

/* Barriers. */
static inline void __syncthreads(HOST_SITE) { host::barrier("__syncthreads", 0, file, line); }
static inline int __syncthreads_count(int p, HOST_SITE)
{
  return host::barrier("__syncthreads_count", p != 0, file, line).yes;
}
static inline int __syncthreads_or(int p, HOST_SITE)
{
  return host::barrier("__syncthreads_or", p != 0, file, line).yes > 0;
}
static inline int __syncthreads_and(int p, HOST_SITE)
{
  host::Count c = host::barrier("__syncthreads_and", p != 0, file, line);
  return c.yes == c.all;
}
static inline void __syncwarp(unsigned mask = ~0u, HOST_SITE)
{
  host::meet("__syncwarp", mask, 0, file, line);
}

/* Shuffles. */
template <class T> T __shfl_sync(unsigned mask, T v, int source, int width = 32, HOST_SITE)
{
  int s = (host::self->lane & ~(width - 1)) | (source & (width - 1));
  return host::shuffle("__shfl_sync", mask, v, s, width, false, file, line);
}
template <class T> T __shfl_up_sync(unsigned mask, T v, unsigned delta, int width = 32, HOST_SITE)
{
  int s = host::self->lane - (int)delta;
  return host::shuffle("__shfl_up_sync", mask, v, s, width, true, file, line);
}
template <class T> T __shfl_down_sync(unsigned mask, T v, unsigned delta, int width = 32, HOST_SITE)
{
  int s = host::self->lane + (int)delta;
  return host::shuffle("__shfl_down_sync", mask, v, s, width, false, file, line);
}
template <class T> T __shfl_xor_sync(unsigned mask, T v, int with, int width = 32, HOST_SITE)
{
  int s = host::self->lane ^ with;
  return host::shuffle("__shfl_xor_sync", mask, v, s, width, false, file, line);
}

/* Votes and matches. */
static inline unsigned __ballot_sync(unsigned mask, int p, HOST_SITE)
{
  const host::Meeting &m = host::meet("__ballot_sync", mask, p != 0, file, line);
  unsigned votes = 0;
  for (int lane = 0; lane < 32; lane++)
    if (m.came >> lane & 1) votes |= (unsigned)m.value[lane] << lane;
  return votes;
}
static inline int __any_sync(unsigned mask, int p, HOST_SITE)
{
  return host::reduce(
      "__any_sync", mask, (int)(p != 0), [](int a, int b) { return a | b; }, file, line);
}
static inline int __all_sync(unsigned mask, int p, HOST_SITE)
{
  return host::reduce(
      "__all_sync", mask, (int)(p != 0), [](int a, int b) { return a & b; }, file, line);
}
template <class T> unsigned __match_any_sync(unsigned mask, T v, HOST_SITE)
{
  uint64_t own = host::bits(v);
  const host::Meeting &m = host::meet("__match_any_sync", mask, own, file, line);
  unsigned same = 0;
  for (int lane = 0; lane < 32; lane++)
    if (m.came >> lane & 1 && m.value[lane] == own) same |= 1u << lane;
  return same;
}
template <class T> unsigned __match_all_sync(unsigned mask, T v, int *all, HOST_SITE)
{
  uint64_t own = host::bits(v);
  const host::Meeting &m = host::meet("__match_all_sync", mask, own, file, line);
  *all = 1;
  for (int lane = 0; lane < 32; lane++)
    if (m.came >> lane & 1 && m.value[lane] != own) *all = 0;
  return *all ? mask : 0;
}

/* Reductions over a warp: integers only, as in hardware. */
#define HOST_REDUCE(T, NAME, F)                                                                    \
  static inline T __reduce_##NAME##_sync(unsigned mask, T v, HOST_SITE)                            \
  {                                                                                                \
    return host::reduce(                                                                           \
        "__reduce_" #NAME "_sync", mask, v, [](T a, T b) -> T { return F; }, file, line);          \
  }
HOST_REDUCE(unsigned, add, a + b)
HOST_REDUCE(unsigned, min, a < b ? a : b)
HOST_REDUCE(unsigned, max, a > b ? a : b)
HOST_REDUCE(unsigned, and, a &b)
HOST_REDUCE(unsigned, or, a | b)
HOST_REDUCE(unsigned, xor, a ^ b)
HOST_REDUCE(int, add, (int)((unsigned)a + (unsigned)b))
HOST_REDUCE(int, min, a < b ? a : b)
HOST_REDUCE(int, max, a > b ? a : b)
#undef HOST_REDUCE

/* Atomics, of the types that nvcc takes. Only one fiber runs at a time. */
#define HOST_ATOMIC(T, NAME, F)                                                                    \
  static inline T atomic##NAME(T *p, T v)                                                          \
  {                                                                                                \
    return host::update(p, [v](T old) -> T { return F; });                                         \
  }
#define HOST_ATOMICS(T)                                                                            \
  HOST_ATOMIC(T, Min, v < old ? v : old)                                                           \
  HOST_ATOMIC(T, Max, v > old ? v : old)                                                           \
  HOST_ATOMIC(T, And, old &v)                                                                      \
  HOST_ATOMIC(T, Or, old | v)                                                                      \
  HOST_ATOMIC(T, Xor, old ^ v)
typedef unsigned long long host_ull;
HOST_ATOMICS(int)
HOST_ATOMICS(unsigned)
HOST_ATOMICS(long long)
HOST_ATOMICS(host_ull)
HOST_ATOMIC(int, Add, (int)((unsigned)old + (unsigned)v))
HOST_ATOMIC(int, Sub, (int)((unsigned)old - (unsigned)v))
HOST_ATOMIC(unsigned, Add, old + v)
HOST_ATOMIC(unsigned, Sub, old - v)
HOST_ATOMIC(unsigned, Inc, old >= v ? 0 : old + 1)
HOST_ATOMIC(unsigned, Dec, old == 0 || old > v ? v : old - 1)
HOST_ATOMIC(host_ull, Add, old + v)
#undef HOST_ATOMICS
#undef HOST_ATOMIC
#define HOST_EXCHANGE(T)                                                                           \
  static inline T atomicExch(T *p, T v)                                                            \
  {                                                                                                \
    return host::update(p, [v](T) { return v; });                                                  \
  }                                                                                                \
  static inline T atomicCAS(T *p, T compare, T v)                                                  \
  {                                                                                                \
    return host::update(p, [=](T old) { return old == compare ? v : old; });                       \
  }
HOST_EXCHANGE(int)
HOST_EXCHANGE(unsigned)
HOST_EXCHANGE(host_ull)
#undef HOST_EXCHANGE

/* Fences, clocks, traps. */
#define HOST_FENCE() __asm__ __volatile__("" ::: "memory")
static inline void __threadfence() { HOST_FENCE(); }
static inline void __threadfence_block() { HOST_FENCE(); }
static inline void __threadfence_system() { HOST_FENCE(); }
static inline void __nanosleep(unsigned) { host::yield(); }
static inline long long clock64()
{
  return std::chrono::steady_clock::now().time_since_epoch().count();
}
[[noreturn]] static inline void __trap(HOST_SITE) { host::wrong(file, line, "__trap"); }

/* Bits. */
static inline int __popc(unsigned x) { return __builtin_popcount(x); }
static inline int __popcll(unsigned long long x) { return __builtin_popcountll(x); }
static inline int __ffs(int x) { return __builtin_ffs(x); }
static inline int __ffsll(long long x) { return __builtin_ffsll(x); }
static inline int __clz(int x) { return x ? __builtin_clz((unsigned)x) : 32; }
static inline int __clzll(long long x) { return x ? __builtin_clzll((unsigned long long)x) : 64; }
static inline unsigned __brev(unsigned x)
{
  unsigned r = 0;
  for (int k = 0; k < 32; k++) r |= (x >> k & 1) << (31 - k);
  return r;
}
static inline unsigned long long __brevll(unsigned long long x)
{
  return (unsigned long long)__brev((unsigned)x) << 32 | __brev((unsigned)(x >> 32));
}
static inline unsigned __funnelshift_l(unsigned low, unsigned high, unsigned shift)
{
  return (unsigned)((((uint64_t)high << 32 | low) << (shift & 31)) >> 32);
}
static inline unsigned __funnelshift_r(unsigned low, unsigned high, unsigned shift)
{
  return (unsigned)(((uint64_t)high << 32 | low) >> (shift & 31));
}
static inline unsigned __umulhi(unsigned a, unsigned b)
{
  return (unsigned)((uint64_t)a * b >> 32);
}
static inline unsigned long long __umul64hi(unsigned long long a, unsigned long long b)
{
  return (unsigned long long)((__extension__(unsigned __int128) a * b) >> 64);
}

#define HOST_CAST(NAME, FROM, TO)                                                                  \
  static inline TO NAME(FROM x)                                                                    \
  {                                                                                                \
    TO y;                                                                                          \
    static_assert(sizeof x == sizeof y, "");                                                       \
    memcpy(&y, &x, sizeof y);                                                                      \
    return y;                                                                                      \
  }
HOST_CAST(__float_as_int, float, int)
HOST_CAST(__float_as_uint, float, unsigned)
HOST_CAST(__int_as_float, int, float)
HOST_CAST(__uint_as_float, unsigned, float)
HOST_CAST(__double_as_longlong, double, long long)
HOST_CAST(__longlong_as_double, long long, double)
#undef HOST_CAST
static inline int __double2hiint(double x) { return (int)(__double_as_longlong(x) >> 32); }
static inline int __double2loint(double x) { return (int)__double_as_longlong(x); }
static inline double __hiloint2double(int high, int low)
{
  return __longlong_as_double((long long)((uint64_t)(unsigned)high << 32 | (unsigned)low));
}
static inline int __float2int_rd(float x) { return (int)floorf(x); }
static inline int __float2int_rn(float x) { return (int)rintf(x); }
static inline int __float2int_rz(float x) { return (int)x; }
static inline unsigned __float2uint_rd(float x) { return (unsigned)floorf(x); }
static inline float __double2float_rn(double x) { return host::rounded((float)x); }
static inline float __double2float_rd(double x)
{
  float f = (float)x;
  return (double)f > x ? nextafterf(f, -INFINITY) : f;
}
static inline float __double2float_ru(double x)
{
  float f = (float)x;
  return (double)f < x ? nextafterf(f, INFINITY) : f;
}

/* Loads and stores with cache hints. */
#define HOST_LOAD(NAME)                                                                            \
  template <class T> T NAME(const T *p) { return *p; }
#define HOST_STORE(NAME)                                                                           \
  template <class T> void NAME(T *p, T v) { *p = v; }
HOST_LOAD(__ldg)
HOST_LOAD(__ldca)
HOST_LOAD(__ldcg)
HOST_LOAD(__ldcs)
HOST_LOAD(__ldcv)
HOST_LOAD(__ldlu)
HOST_STORE(__stcg)
HOST_STORE(__stcs)
HOST_STORE(__stwb)
HOST_STORE(__stwt)
#undef HOST_LOAD
#undef HOST_STORE

/* Maths: the approximate ones are exact here. glibc declares some of the names: macros then. */
#define __expf(x)    expf(x)
#define __exp10f(x)  exp10f(x)
#define __logf(x)    logf(x)
#define __log2f(x)   log2f(x)
#define __log10f(x)  log10f(x)
#define __powf(x, y) powf(x, y)
#define __sinf(x)    sinf(x)
#define __cosf(x)    cosf(x)
static inline float rsqrtf(float x) { return 1 / sqrtf(x); }
static inline double rsqrt(double x) { return 1 / sqrt(x); }
static inline float rsqrt(float x) { return rsqrtf(x); }
static inline float rcbrtf(float x) { return 1 / cbrtf(x); }
static inline double rcbrt(double x) { return 1 / cbrt(x); }
static inline float norm3df(float x, float y, float z) { return sqrtf(x * x + y * y + z * z); }
static inline double norm3d(double x, double y, double z) { return sqrt(x * x + y * y + z * z); }
static inline float __saturatef(float x) { return x > 0 ? (x < 1 ? x : 1) : 0; }
static inline float __fdividef(float x, float y) { return x / y; }
static inline float __frcp_rn(float x) { return 1 / x; }
static inline float __frsqrt_rn(float x) { return (float)(1 / sqrt((double)x)); }
static inline float __fsqrt_rn(float x) { return sqrtf(x); }
static inline float __fadd_rn(float x, float y) { return x + y; }
static inline float __fsub_rn(float x, float y) { return x - y; }
static inline float __fmul_rn(float x, float y) { return host::rounded(x * y); }
static inline float __fdiv_rn(float x, float y) { return x / y; }
static inline float __fmaf_rn(float x, float y, float z) { return fmaf(x, y, z); }
static inline double __drcp_rn(double x) { return 1 / x; }
static inline double __dsqrt_rn(double x) { return sqrt(x); }
static inline double __dadd_rn(double x, double y) { return x + y; }
static inline double __dsub_rn(double x, double y) { return x - y; }
static inline double __dmul_rn(double x, double y) { return host::rounded(x * y); }
static inline double __ddiv_rn(double x, double y) { return x / y; }
static inline double __fma_rn(double x, double y, double z) { return fma(x, y, z); }

#define HOST_EXTREMES(T, MIN, MAX)                                                                 \
  static inline T min(T a, T b) { return MIN; }                                                    \
  static inline T max(T a, T b) { return MAX; }
#define HOST_ORDERED(T) HOST_EXTREMES(T, a<b ? a : b, a> b ? a : b)
HOST_ORDERED(int)
HOST_ORDERED(unsigned)
HOST_ORDERED(long)
HOST_ORDERED(unsigned long)
HOST_ORDERED(long long)
HOST_ORDERED(unsigned long long)
HOST_EXTREMES(float, fminf(a, b), fmaxf(a, b))
HOST_EXTREMES(double, fmin(a, b), fmax(a, b))
#undef HOST_EXTREMES
#undef HOST_ORDERED

#endif
