/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the solver uses of CUB, on a device or on the host (tests/host), against the standard
 * library. */
#include <algorithm>
#include <numeric>
#include <cub/cub.cuh>
#include "gpu.h"

/* The first call without storage says how much, the second works. */
#define CUB(CALL, ...)                                                                             \
  do {                                                                                             \
    size_t bytes = 0;                                                                              \
    void *temp = nullptr;                                                                          \
    CHECK(CALL(nullptr, bytes, __VA_ARGS__));                                                      \
    CHECK(cudaMalloc(&temp, bytes));                                                               \
    CHECK(CALL(temp, bytes, __VA_ARGS__));                                                         \
    CHECK(cudaDeviceSynchronize());                                                                \
    CHECK(cudaFree(temp));                                                                         \
    expect_success();                                                                              \
  } while (0)

/* Sort by bits 3..end-1 through buffers and through pointers. */
static void sort_is_stable(void **)
{
  for (size_t n : {1, 1000, 5000})
    for (int end : {64, 9}) {
      std::vector<uint64_t> key = noise<uint64_t>(n);
      std::vector<int> order(n);
      std::iota(order.begin(), order.end(), 0);
      cub::DoubleBuffer<uint64_t> k(up(key), room<uint64_t>(n));
      cub::DoubleBuffer<int> v(up(order), room<int>(n));
      uint64_t *in = up(key), *out = room<uint64_t>(n);
      int *vin = up(order), *vout = room<int>(n);
      auto part = [&](int i) {
        return end < 64 ? key[i] >> 3 & ((1u << (end - 3)) - 1) : key[i] >> 3;
      };
      std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return part(i) < part(j); });
      CUB(cub::DeviceRadixSort::SortPairs, in, out, vin, vout, n, 3, end);
      CUB(cub::DeviceRadixSort::SortPairs, k, v, n, 3, end);
      uint64_t *spare = k.Alternate();
      int *vspare = v.Alternate();
      std::vector<int> got = down(v.Current(), n), again = down(vout, n);
      std::vector<uint64_t> sorted = down(k.Current(), n), kept = down(in, n);
      for (size_t i = 0; i < n; i++) {
        assert_int_equal(got[i], order[i]);
        assert_int_equal(again[i], order[i]);
        assert_true(sorted[i] == key[order[i]] && kept[i] == key[i]);
      }
      down(spare, n), down(vspare, n), down(vin, n), down(out, n);
    }
}

template <class T> static void sort_keys(std::vector<T> v)
{
  T *in = up(v), *out = room<T>(v.size());
  CUB(cub::DeviceRadixSort::SortKeys, in, out, (int)v.size());
  down(in, v.size());
  std::sort(v.begin(), v.end());
  assert_true(down(out, v.size()) == v);
}

static void keys_of_any_type_sort(void **)
{
  sort_keys(noise<int>(777));
  sort_keys(noise<uint32_t>(777));
  sort_keys(noise<long long>(777));
  sort_keys(noise<unsigned char>(777));
  std::vector<double> d;
  for (int64_t v : noise<int64_t>(777)) d.push_back((double)v * 1e-9);
  sort_keys(d);
  sort_keys(std::vector<float>(d.begin(), d.end()));
}

struct Odd {
  __host__ __device__ bool operator()(int v) const { return v & 1; }
};
struct Larger {
  __host__ __device__ int operator()(int a, int b) const { return a > b ? a : b; }
};

static void scans_and_reductions(void **)
{
  const int N = 3333;
  std::vector<int> in = noise<int>(N), sum(N), odd, run, length;
  for (int &v : in) v &= 0xff;
  int *a = up(in), *b = room<int>(N), *c = room<int>(N), *one = room<int>(1);
  std::partial_sum(in.begin(), in.end(), sum.begin());
  CUB(cub::DeviceScan::InclusiveSum, a, b, N);
  assert_true(down(b, N) == sum);
  CUB(cub::DeviceScan::ExclusiveSum, a, c, N);
  for (int i = 0; i < N; i++) sum[i] -= in[i];
  assert_true(down(c, N) == sum);
  CUB(cub::DeviceReduce::Sum, a, one, N);
  assert_int_equal(down(one, 1)[0], std::accumulate(in.begin(), in.end(), 0));
  one = room<int>(1);
  CUB(cub::DeviceReduce::Reduce, a, one, N, Larger(), 17);
  assert_int_equal(down(one, 1)[0], *std::max_element(in.begin(), in.end()));
  one = room<int>(1);
  CUB(cub::DeviceReduce::Min, a, one, N);
  assert_int_equal(down(one, 1)[0], *std::min_element(in.begin(), in.end()));
  down(a, N);
}

static void selections(void **)
{
  const int N = 3333;
  std::vector<int> in = noise<int>(N), odd, value, length;
  for (int &v : in) v &= 3;
  for (int v : in) {
    if (v & 1) odd.push_back(v);
    if (value.empty() || value.back() != v) value.push_back(v), length.push_back(0);
    length.back()++;
  }
  int *a = up(in), *flag = up(in), *b = room<int>(N), *c = room<int>(N), *one = room<int>(1);
  CUB(cub::DeviceSelect::If, a, b, one, N, Odd());
  assert_int_equal(down(one, 1)[0], odd.size());
  assert_true(down(b, odd.size()) == odd);
  b = room<int>(N), one = room<int>(1);
  CUB(cub::DeviceSelect::Flagged, a, flag, b, one, N);
  odd.clear();
  for (int v : in)
    if (v) odd.push_back(v);
  assert_int_equal(down(one, 1)[0], odd.size());
  assert_true(down(b, odd.size()) == odd);
  b = room<int>(N), one = room<int>(1);
  CUB(cub::DeviceRunLengthEncode::Encode, a, b, c, one, N);
  assert_int_equal(down(one, 1)[0], value.size());
  assert_true(down(b, value.size()) == value);
  assert_true(down(c, length.size()) == length);
  down(a, N), down(flag, N);
}

static __global__ void collectives(int *out)
{
  typedef cub::BlockReduce<int, 96> Reduce;
  typedef cub::BlockScan<int, 96> Scan;
  typedef cub::WarpReduce<int, 16> Part;
  __shared__ union {
    Reduce::TempStorage reduce;
    Scan::TempStorage scan;
    Part::TempStorage part[6];
  } s;
  int t = threadIdx.x, sum = Reduce(s.reduce).Sum(t), most, before, part;
  __syncthreads();
  most = Reduce(s.reduce).Reduce(t, Larger());
  __syncthreads();
  Scan(s.scan).ExclusiveSum(t, before);
  __syncthreads();
  part = Part(s.part[t / 16]).Sum(t);
  if (t == 0) out[96] = sum, out[97] = most;
  if (t % 16 == 0) out[98 + t / 16] = part;
  out[t] = before;
}

static void blocks_work_together(void **)
{
  int *p = room<int>(104);
  LAUNCH(collectives, 1, 96, 0, nullptr, p);
  std::vector<int> got = down(p, 104);
  for (int t = 0; t < 96; t++) assert_int_equal(got[t], t * (t - 1) / 2);
  assert_int_equal(got[96], 95 * 96 / 2);
  assert_int_equal(got[97], 95);
  for (int k = 0; k < 6; k++) assert_int_equal(got[98 + k], 16 * 16 * k + 15 * 16 / 2);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sort_is_stable),       cmocka_unit_test(keys_of_any_type_sort),
      cmocka_unit_test(scans_and_reductions), cmocka_unit_test(selections),
      cmocka_unit_test(blocks_work_together),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
