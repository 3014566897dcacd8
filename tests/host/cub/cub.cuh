/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of CUB that the solver uses, on the host. Device-wide calls: a first one without
 * temporary storage says how much is needed, a second one is issued to the stream like a kernel.
 * Block- and warp-wide classes meet like CUB's: storage that is used again needs a barrier in
 * between. Results that CUB leaves undefined have all bits set. */
#ifndef HOST_CUB_CUH
#define HOST_CUB_CUH

#include <algorithm>
#include <iterator>
#include <vector>
#include <cuda_runtime.h>

namespace cub
{

template <class T> struct DoubleBuffer {
  T *d_buffers[2];
  int selector;
  DoubleBuffer() : d_buffers{nullptr, nullptr}, selector(0) {}
  DoubleBuffer(T *current, T *alternate) : d_buffers{current, alternate}, selector(0) {}
  T *Current() { return d_buffers[selector]; }
  T *Alternate() { return d_buffers[selector ^ 1]; }
};

struct NullType {
};

namespace host_side
{

template <class N> size_t items(N n)
{
  static_assert(std::is_integral<N>::value, "a number of items is an integer, not an enum");
  return (size_t)n;
}

template <class It> using value_of = typename std::iterator_traits<It>::value_type;

struct Add {
  template <class T> T operator()(T a, T b) const { return (T)(a + b); }
};
struct Least {
  template <class T> T operator()(T a, T b) const { return b < a ? b : a; }
};
struct Most {
  template <class T> T operator()(T a, T b) const { return a < b ? b : a; }
};
struct Same {
  template <class T> bool operator()(T a, T b) const { return a == b; }
};

/* two_phase: the protocol of all device-wide calls; the storage is overwritten, as it may be. */
template <class F>
cudaError_t two_phase(const char *name, void *storage, size_t &bytes, size_t n, cudaStream_t stream,
                      F f)
{
  size_t need = 512 + 16 * n;
  if (!storage) {
    bytes = need;
    return host::done(cudaSuccess);
  }
  if (bytes < need || !host::reachable(storage)) return host::done(cudaErrorInvalidValue);
  return host::issue(stream, name, [=]() mutable {
    memset(storage, 0xff, need);
    f();
  });
}

/* radix: the bits begin..end-1 of a key in the order that CUB sorts by. */
template <class K> uint64_t radix(K key, int begin, int end, bool down)
{
  typedef typename std::conditional<
      sizeof(K) == 8, uint64_t,
      typename std::conditional<
          sizeof(K) == 4, uint32_t,
          typename std::conditional<sizeof(K) == 2, uint16_t, uint8_t>::type>::type>::type U;
  const U top = (U)((U)1 << (8 * sizeof(K) - 1));
  U u;
  if (std::is_floating_point<K>::value && key == 0) key = 0; /* -0 is 0 */
  memcpy(&u, &key, sizeof u);
  if (std::is_floating_point<K>::value)
    u = (U)(u & top ? ~u : u | top);
  else if (std::is_signed<K>::value)
    u = (U)(u ^ top);
  if (down) u = (U)~u;
  uint64_t wide = (uint64_t)u >> begin;
  return end - begin >= 64 ? wide : wide & (((uint64_t)1 << (end - begin)) - 1);
}

template <class K, class V>
void sort(const K *keys, K *keys_out, const V *values, V *values_out, size_t n, int begin, int end,
          bool down)
{
  std::vector<std::pair<uint64_t, size_t>> by(n);
  std::vector<K> k(keys, keys + n);
  std::vector<V> v;
  if (values) v.assign(values, values + n);
  for (size_t i = 0; i < n; i++) by[i] = {radix(k[i], begin, end, down), i};
  std::sort(by.begin(), by.end()); /* stable: the place decides last */
  for (size_t i = 0; i < n; i++) {
    keys_out[i] = k[by[i].second];
    if (values) values_out[i] = v[by[i].second];
  }
}

template <class K, class V>
cudaError_t sort_call(const char *name, void *storage, size_t &bytes, const K *keys, K *keys_out,
                      const V *values, V *values_out, size_t n, int begin, int end, bool down,
                      cudaStream_t stream)
{
  if (begin < 0 || end > (int)(8 * sizeof(K)) || begin > end)
    return host::done(cudaErrorInvalidValue);
  if (n && keys == keys_out) return host::done(cudaErrorInvalidValue); /* use a DoubleBuffer */
  return two_phase(name, storage, bytes, n, stream,
                   [=] { sort(keys, keys_out, values, values_out, n, begin, end, down); });
}

/* In which of two buffers the result ends depends on the passes of 8 bits; what the other one holds
 * is undefined. */
template <class K, class V>
cudaError_t sort_buffers(const char *name, void *storage, size_t &bytes, DoubleBuffer<K> &keys,
                         DoubleBuffer<V> *values, size_t n, int begin, int end, bool down,
                         cudaStream_t stream)
{
  K *from = keys.Current(), *to = keys.Alternate();
  V *values_from = values ? values->Current() : nullptr;
  V *values_to = values ? values->Alternate() : nullptr;
  bool flips = (end - begin + 7) / 8 % 2;
  if (begin < 0 || end > (int)(8 * sizeof(K)) || begin > end)
    return host::done(cudaErrorInvalidValue);
  cudaError_t code = two_phase(name, storage, bytes, n, stream, [=] {
    K *k = flips ? to : from;
    V *v = flips ? values_to : values_from;
    sort(from, k, values_from, v, n, begin, end, down);
    memset(static_cast<void *>(flips ? from : to), 0xff, n * sizeof(K));
    if (v) memset(static_cast<void *>(flips ? values_from : values_to), 0xff, n * sizeof(V));
  });
  if (storage && code == cudaSuccess && flips) {
    keys.selector ^= 1;
    if (values) values->selector ^= 1;
  }
  return code;
}

template <class In, class Out, class Op, class T>
void scan(In in, Out out, Op op, T sum, bool first, bool inclusive, size_t n)
{
  for (size_t i = 0; i < n; i++) {
    T v = (T)in[i], next = first && i == 0 ? v : op(sum, v);
    out[i] = inclusive ? next : sum;
    sum = next;
  }
}

} // namespace host_side

struct DeviceRadixSort {
#define CUB_SORT(NAME, DOWN)                                                                       \
  template <class K, class V, class N>                                                             \
  static cudaError_t SortPairs##NAME(void *storage, size_t &bytes, const K *keys, K *keys_out,     \
                                     const V *values, V *values_out, N n, int begin = 0,           \
                                     int end = 8 * sizeof(K), cudaStream_t stream = nullptr)       \
  {                                                                                                \
    return host_side::sort_call("SortPairs" #NAME, storage, bytes, keys, keys_out, values,         \
                                values_out, host_side::items(n), begin, end, DOWN, stream);        \
  }                                                                                                \
  template <class K, class V, class N>                                                             \
  static cudaError_t SortPairs##NAME(void *storage, size_t &bytes, DoubleBuffer<K> &keys,          \
                                     DoubleBuffer<V> &values, N n, int begin = 0,                  \
                                     int end = 8 * sizeof(K), cudaStream_t stream = nullptr)       \
  {                                                                                                \
    return host_side::sort_buffers("SortPairs" #NAME, storage, bytes, keys, &values,               \
                                   host_side::items(n), begin, end, DOWN, stream);                 \
  }                                                                                                \
  template <class K, class N>                                                                      \
  static cudaError_t SortKeys##NAME(void *storage, size_t &bytes, const K *keys, K *keys_out, N n, \
                                    int begin = 0, int end = 8 * sizeof(K),                        \
                                    cudaStream_t stream = nullptr)                                 \
  {                                                                                                \
    const char *none = nullptr;                                                                    \
    return host_side::sort_call("SortKeys" #NAME, storage, bytes, keys, keys_out, none,            \
                                (char *)nullptr, host_side::items(n), begin, end, DOWN, stream);   \
  }                                                                                                \
  template <class K, class N>                                                                      \
  static cudaError_t SortKeys##NAME(void *storage, size_t &bytes, DoubleBuffer<K> &keys, N n,      \
                                    int begin = 0, int end = 8 * sizeof(K),                        \
                                    cudaStream_t stream = nullptr)                                 \
  {                                                                                                \
    return host_side::sort_buffers("SortKeys" #NAME, storage, bytes, keys,                         \
                                   (DoubleBuffer<char> *)nullptr, host_side::items(n), begin, end, \
                                   DOWN, stream);                                                  \
  }
  CUB_SORT(, false)
  CUB_SORT(Descending, true)
#undef CUB_SORT
};

struct DeviceScan {
  template <class In, class Out, class Op, class T, class N>
  static cudaError_t ExclusiveScan(void *storage, size_t &bytes, In in, Out out, Op op, T init, N n,
                                   cudaStream_t stream = nullptr)
  {
    return host_side::two_phase("ExclusiveScan", storage, bytes, host_side::items(n), stream, [=] {
      host_side::scan(in, out, op, init, false, false, host_side::items(n));
    });
  }
  template <class In, class Out, class Op, class N>
  static cudaError_t InclusiveScan(void *storage, size_t &bytes, In in, Out out, Op op, N n,
                                   cudaStream_t stream = nullptr)
  {
    return host_side::two_phase("InclusiveScan", storage, bytes, host_side::items(n), stream, [=] {
      host_side::scan(in, out, op, host_side::value_of<In>(), true, true, host_side::items(n));
    });
  }
  template <class In, class Out, class N>
  static cudaError_t ExclusiveSum(void *storage, size_t &bytes, In in, Out out, N n,
                                  cudaStream_t stream = nullptr)
  {
    return ExclusiveScan(storage, bytes, in, out, host_side::Add(), host_side::value_of<In>(), n,
                         stream);
  }
  template <class In, class Out, class N>
  static cudaError_t InclusiveSum(void *storage, size_t &bytes, In in, Out out, N n,
                                  cudaStream_t stream = nullptr)
  {
    return InclusiveScan(storage, bytes, in, out, host_side::Add(), n, stream);
  }
};

struct DeviceReduce {
  template <class In, class Out, class N, class Op, class F, class T>
  static cudaError_t TransformReduce(void *storage, size_t &bytes, In in, Out out, N n, Op op, F f,
                                     T init, cudaStream_t stream = nullptr)
  {
    return host_side::two_phase("Reduce", storage, bytes, host_side::items(n), stream, [=] {
      T sum = init;
      for (size_t i = 0; i < host_side::items(n); i++) sum = op(sum, f(in[i]));
      *out = sum;
    });
  }
  template <class In, class Out, class N, class Op, class T>
  static cudaError_t Reduce(void *storage, size_t &bytes, In in, Out out, N n, Op op, T init,
                            cudaStream_t stream = nullptr)
  {
    auto same = [](host_side::value_of<In> v) { return v; };
    return TransformReduce(storage, bytes, in, out, n, op, same, init, stream);
  }
  template <class In, class Out, class N>
  static cudaError_t Sum(void *storage, size_t &bytes, In in, Out out, N n,
                         cudaStream_t stream = nullptr)
  {
    return Reduce(storage, bytes, in, out, n, host_side::Add(), host_side::value_of<In>(), stream);
  }
  /* Of nothing: the largest (smallest) value of the type. */
  template <class In, class Out, class N>
  static cudaError_t Min(void *storage, size_t &bytes, In in, Out out, N n,
                         cudaStream_t stream = nullptr)
  {
    auto init = std::numeric_limits<host_side::value_of<In>>::max();
    return Reduce(storage, bytes, in, out, n, host_side::Least(), init, stream);
  }
  template <class In, class Out, class N>
  static cudaError_t Max(void *storage, size_t &bytes, In in, Out out, N n,
                         cudaStream_t stream = nullptr)
  {
    auto init = std::numeric_limits<host_side::value_of<In>>::lowest();
    return Reduce(storage, bytes, in, out, n, host_side::Most(), init, stream);
  }
};

struct DeviceSelect {
  template <class In, class Flag, class Out, class Count>
  static cudaError_t Flagged(void *storage, size_t &bytes, In in, Flag flags, Out out, Count count,
                             int64_t n, cudaStream_t stream = nullptr)
  {
    return host_side::two_phase("Flagged", storage, bytes, host_side::items(n), stream, [=] {
      int64_t kept = 0;
      for (int64_t i = 0; i < n; i++)
        if (flags[i]) out[kept++] = in[i];
      *count = (host_side::value_of<Count>)kept;
    });
  }
  template <class In, class Out, class Count, class F>
  static cudaError_t If(void *storage, size_t &bytes, In in, Out out, Count count, int64_t n, F f,
                        cudaStream_t stream = nullptr)
  {
    return host_side::two_phase("If", storage, bytes, host_side::items(n), stream, [=] {
      int64_t kept = 0;
      for (int64_t i = 0; i < n; i++)
        if (f(in[i])) out[kept++] = in[i];
      *count = (host_side::value_of<Count>)kept;
    });
  }
  template <class In, class Out, class Count>
  static cudaError_t Unique(void *storage, size_t &bytes, In in, Out out, Count count, int64_t n,
                            cudaStream_t stream = nullptr)
  {
    return host_side::two_phase("Unique", storage, bytes, host_side::items(n), stream, [=] {
      int64_t kept = 0;
      for (int64_t i = 0; i < n; i++)
        if (i == 0 || !(in[i] == in[i - 1])) out[kept++] = in[i];
      *count = (host_side::value_of<Count>)kept;
    });
  }
};

struct DeviceRunLengthEncode {
  template <class In, class Out, class Length, class Count>
  static cudaError_t Encode(void *storage, size_t &bytes, In in, Out out, Length length,
                            Count count, int64_t n, cudaStream_t stream = nullptr)
  {
    return host_side::two_phase("Encode", storage, bytes, host_side::items(n), stream, [=] {
      int64_t runs = 0;
      for (int64_t i = 0; i < n; i++) {
        if (i == 0 || !(in[i] == in[i - 1])) out[runs] = in[i], length[runs++] = 0;
        length[runs - 1]++;
      }
      *count = (host_side::value_of<Count>)runs;
    });
  }
};

namespace host_side
{

template <class T> T undefined()
{
  T v;
  memset(static_cast<void *>(&v), 0xff, sizeof v);
  return v;
}

static inline int place_in_block()
{
  return (int)(threadIdx.x + blockDim.x * (threadIdx.y + blockDim.y * threadIdx.z));
}

/* What a block or a (part of a) warp shares: the values, in the order of the threads. */
template <class T, int N> struct Storage {
  T value[N];
};

} // namespace host_side

template <class T, int THREADS, int ALGORITHM = 0, int Y = 1, int Z = 1> class BlockReduce
{
public:
  typedef host_side::Storage<T, THREADS * Y * Z> TempStorage;
  explicit BlockReduce(TempStorage &s) : storage(s) {}

  template <class Op> T Reduce(T value, Op op, int valid = THREADS * Y * Z, HOST_SITE)
  {
    int place = host_side::place_in_block();
    storage.value[place] = value;
    host::barrier("BlockReduce", 0, file, line);
    if (place != 0) return host_side::undefined<T>();
    for (int k = 1; k < valid; k++) value = op(value, storage.value[k]);
    return value;
  }
  T Sum(T value, HOST_SITE) { return Reduce(value, host_side::Add(), THREADS * Y * Z, file, line); }

private:
  TempStorage &storage;
};

template <class T, int THREADS, int ALGORITHM = 0, int Y = 1, int Z = 1> class BlockScan
{
public:
  typedef host_side::Storage<T, THREADS * Y * Z> TempStorage;
  explicit BlockScan(TempStorage &s) : storage(s) {}

  void ExclusiveSum(T value, T &out, T &total, HOST_SITE)
  {
    scan(value, out, total, false, file, line);
  }
  void ExclusiveSum(T value, T &out, HOST_SITE)
  {
    T total;
    scan(value, out, total, false, file, line);
  }
  void InclusiveSum(T value, T &out, T &total, HOST_SITE)
  {
    scan(value, out, total, true, file, line);
  }
  void InclusiveSum(T value, T &out, HOST_SITE)
  {
    T total;
    scan(value, out, total, true, file, line);
  }

private:
  void scan(T value, T &out, T &total, bool inclusive, const char *file, int line)
  {
    int place = host_side::place_in_block();
    T sum = out = T();
    storage.value[place] = value;
    host::barrier("BlockScan", 0, file, line);
    for (int k = 0; k < THREADS * Y * Z; k++) {
      if (k == place) out = inclusive ? (T)(sum + value) : sum;
      sum = (T)(sum + storage.value[k]);
    }
    total = sum;
  }
  TempStorage &storage;
};

/* Within LANES lanes of a warp; all of them have to come. */
template <class T, int LANES = 32> class WarpReduce
{
public:
  typedef host_side::Storage<T, LANES> TempStorage;
  explicit WarpReduce(TempStorage &s) : storage(s) {}

  template <class Op> T Reduce(T value, Op op, HOST_SITE)
  {
    int lane = host::self->lane % LANES, first = host::self->lane - lane;
    storage.value[lane] = value;
    host::meet("WarpReduce", (LANES == 32 ? ~0u : (1u << LANES % 32) - 1) << first, 0, file, line);
    if (lane != 0) return host_side::undefined<T>();
    for (int k = 1; k < LANES; k++) value = op(value, storage.value[k]);
    return value;
  }
  T Sum(T value, HOST_SITE) { return Reduce(value, host_side::Add(), file, line); }

private:
  TempStorage &storage;
};

template <class T, int LANES = 32> class WarpScan
{
public:
  typedef host_side::Storage<T, LANES> TempStorage;
  explicit WarpScan(TempStorage &s) : storage(s) {}

  void ExclusiveSum(T value, T &out, T &total, HOST_SITE)
  {
    int lane = host::self->lane % LANES, first = host::self->lane - lane;
    T sum = out = T();
    storage.value[lane] = value;
    host::meet("WarpScan", (LANES == 32 ? ~0u : (1u << LANES % 32) - 1) << first, 0, file, line);
    for (int k = 0; k < LANES; k++) {
      if (k == lane) out = sum;
      sum = (T)(sum + storage.value[k]);
    }
    total = sum;
  }
  void ExclusiveSum(T value, T &out, HOST_SITE)
  {
    T total;
    ExclusiveSum(value, out, total, file, line);
  }
  void InclusiveSum(T value, T &out, HOST_SITE)
  {
    T total, before;
    ExclusiveSum(value, before, total, file, line);
    out = (T)(before + value);
  }

private:
  TempStorage &storage;
};

} // namespace cub

#endif
