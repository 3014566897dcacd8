/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CUDA as the solver uses it: warp intrinsics, barriers, shared memory, streams, graphs and CUB
 * against plain loops. The same file runs on a device and on the host (tests/host); there it shows
 * as well that mistakes in a kernel are found. */
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>
#include <string>
#include <cub/cub.cuh>
#include "gpu.h"

/* Each lane says what it got from each kind of shuffle in sections of `width` lanes. */
static __global__ void shuffles(int *out, int width)
{
  int lane = threadIdx.x, *o = out + 4 * lane;
  o[0] = __shfl_sync(FULL, lane, lane + 3, width);
  o[1] = __shfl_up_sync(FULL, lane, 3, width);
  o[2] = __shfl_down_sync(FULL, lane, 3, width);
  o[3] = __shfl_xor_sync(FULL, lane, 5, width);
}

static void shuffles_stay_in_their_section(void **)
{
  for (int width : {32, 16, 8}) {
    int *p = room<int>(128);
    LAUNCH(shuffles, 1, 32, 0, nullptr, p, width);
    std::vector<int> got = down(p, 128);
    for (int lane = 0; lane < 32; lane++) {
      int first = lane / width * width, last = first + width - 1, *o = &got[4 * lane];
      assert_int_equal(o[0], first + (lane + 3) % width);
      assert_int_equal(o[1], lane - 3 < first ? lane : lane - 3);
      assert_int_equal(o[2], lane + 3 > last ? lane : lane + 3);
      assert_int_equal(o[3], lane ^ 5);
    }
  }
}

/* Numbers of 4 and 8 bytes; three branches, each with its own mask, the last of one lane. */
static __global__ void branches(double *sum, unsigned *vote, long long *broadcast)
{
  int lane = threadIdx.x;
  double v = 1.25 * lane;
  unsigned mask = __match_any_sync(FULL, lane < 20 ? lane % 3 : lane < 31 ? 1 : 3);
  for (int k = 0; k < lane % 3; k++) __syncwarp(1u << lane);
  if (lane == 31) {
    sum[lane] = __shfl_sync(mask, v, 31);
    vote[lane] = __ballot_sync(mask, 1);
    broadcast[lane] = __shfl_sync(mask, (long long)lane << 40, 31);
  } else if (lane % 3 == 0 && lane < 20) {
    unsigned total = __reduce_add_sync(mask, (unsigned)lane);
    sum[lane] = 1.25 * total;
    vote[lane] = __ballot_sync(mask, lane > 9);
    broadcast[lane] = __shfl_sync(mask, (long long)lane << 40, 18);
  } else {
    double s = 0;
    for (unsigned left = mask; left; left &= left - 1) s += __shfl_sync(mask, v, __ffs(left) - 1);
    sum[lane] = s;
    vote[lane] = __ballot_sync(mask, lane > 9);
    broadcast[lane] = __shfl_sync(mask, (long long)lane << 40, __ffs(mask) - 1);
  }
}

static void branches_meet_apart(void **)
{
  double *s = room<double>(32);
  unsigned *v = room<unsigned>(32);
  long long *b = room<long long>(32);
  LAUNCH(branches, 1, 32, 0, nullptr, s, v, b);
  std::vector<double> sum = down(s, 32);
  std::vector<unsigned> vote = down(v, 32);
  std::vector<long long> cast = down(b, 32);
  for (int lane = 0; lane < 32; lane++) {
    auto team = [](int k) { return k == 31 ? 3 : k < 20 ? k % 3 : 1; };
    double s_want = 0;
    unsigned v_want = 0;
    int first = -1;
    for (int k = 0; k < 32; k++) {
      if (team(k) != team(lane)) continue;
      s_want += 1.25 * k, v_want |= (unsigned)(k > 9) << k;
      if (first < 0) first = k;
    }
    if (lane % 3 == 0 && lane < 20) first = 18;
    assert_true(sum[lane] == s_want);
    assert_int_equal(vote[lane], v_want);
    assert_true(cast[lane] == (long long)first << 40);
  }
}

/* Votes and reductions in a block that ends within a warp, some threads gone before. */
static __global__ void votes(int *out)
{
  int i = threadIdx.x;
  if (i % 4 == 3) return;
  out[6 * i] = (int)__ballot_sync(FULL, i % 2);
  out[6 * i + 1] = __any_sync(FULL, i == 33);
  out[6 * i + 2] = __all_sync(FULL, i != 33);
  out[6 * i + 3] = __reduce_min_sync(FULL, -i);
  out[6 * i + 4] = (int)__reduce_max_sync(FULL, (unsigned)i);
  out[6 * i + 5] = __syncthreads_count(i > 10);
}

static void votes_count_who_is_there(void **)
{
  enum { N = 50 };
  int *p = up(std::vector<int>(6 * N, 7));
  LAUNCH(votes, 1, N, 0, nullptr, p);
  std::vector<int> got = down(p, 6 * N);
  for (int i = 0; i < N; i++) {
    int first = i / 32 * 32, top = first ? 49 : 30, *o = &got[6 * i];
    unsigned odd = 0;
    if (i % 4 == 3) {
      assert_int_equal(o[0], 7);
      continue;
    }
    for (int k = first; k <= top; k++) odd |= (unsigned)(k % 4 == 1) << (k - first);
    assert_int_equal((unsigned)o[0], odd);
    assert_int_equal(o[1], first > 0);
    assert_int_equal(o[2], first == 0);
    assert_int_equal(o[3], -top);
    assert_int_equal(o[4], top);
    assert_int_equal(o[5], 29); /* of 11..49 ten are 3 mod 4 */
  }
}

/* Inclusive scan of each block in shared memory, doubling; threads in two dimensions. */
static __global__ void scan_block(const int *in, int *out, int n)
{
  __shared__ int s[2][1024];
  int t = threadIdx.x + blockDim.x * threadIdx.y, size = blockDim.x * blockDim.y, now = 0;
  int i = blockIdx.x * size + t;
  s[0][t] = i < n ? in[i] : 0;
  for (int d = 1; d < size; d *= 2, now ^= 1) {
    __syncthreads();
    s[now ^ 1][t] = s[now][t] + (t >= d ? s[now][t - d] : 0);
  }
  if (i < n) out[i] = s[now][t];
}

static void blocks_scan(void **)
{
  for (dim3 block : {dim3(1024), dim3(10, 7), dim3(33, 3)}) {
    int n = 2500, size = (int)(block.x * block.y), sum = 0;
    std::vector<int> in = noise<int>(n);
    for (int &v : in) v &= 0xffff;
    int *a = up(in), *b = room<int>(n);
    LAUNCH(scan_block, launch_blocks(n, size), block, 0, nullptr, a, b, n);
    std::vector<int> out = down(b, n);
    down(a, n);
    for (int i = 0; i < n; i++) {
      sum = (i % size ? sum : 0) + in[i];
      assert_int_equal(out[i], sum);
    }
  }
}

/* Dynamic shared memory, as large as the device allows. */
template <int STEP, bool ADD> static __global__ void reverse(float4 *out)
{
  SHARED_DYNAMIC(float4, s);
  int n = blockDim.x;
  for (int k = threadIdx.x; k < STEP * n; k += n) s[k] = make_float4(k, 0, 0, ADD ? 1 : 0);
  __syncthreads();
  for (int k = threadIdx.x; k < STEP * n; k += n) out[k] = s[STEP * n - 1 - k];
}

static void shared_memory_is_as_asked(void **)
{
  enum { N = 4 * 1024 };
  float4 *p = room<float4>(N);
  LAUNCH((reverse<4, true>), 1, 1024, N * sizeof(float4), nullptr, p);
  expect_error(cudaErrorInvalidValue);
  CHECK(cudaFuncSetAttribute(reverse<4, true>, cudaFuncAttributeMaxDynamicSharedMemorySize,
                             N * sizeof(float4)));
  LAUNCH((reverse<4, true>), 1, 1024, N * sizeof(float4), nullptr, p);
  std::vector<float4> got = down(p, N);
  for (int k = 0; k < N; k++) {
    assert_true(got[k].x == (float)(N - 1 - k));
    assert_true(got[k].w == 1);
  }
}

/* Atomics, a __device__ and a __constant__ variable, bits and casts. */
static __device__ unsigned long long ticket;
static __constant__ double factor[2];

static __global__ void tickets(unsigned *seen, unsigned long long *least, int *bits)
{
  unsigned long long t = atomicAdd(&ticket, 1ull);
  double v = factor[1] * (double)(t + 1);
  atomicOr(&seen[t / 32], 1u << t % 32);
  atomicMin(least, (unsigned long long)__double_as_longlong(v));
  if (t) return;
  bits[0] = __popc(0xf0f0u), bits[1] = __ffs(0), bits[2] = __clz(1), bits[3] = (int)__brev(1u);
  bits[4] = __clzll(1ll << 40), bits[5] = __popcll(~0ull), bits[6] = __float_as_int(1.f);
  bits[7] = (int)(1e6f * rsqrtf(4.f) + 0.5f), bits[8] = atomicCAS(&bits[9], 3, 4);
}

static void atomics_lose_nothing(void **)
{
  double f[2] = {1, 0.125};
  unsigned long long zero = 0, count;
  unsigned *seen = up(std::vector<unsigned>(32, 0));
  unsigned long long *least = up(std::vector<unsigned long long>(1, ~0ull));
  int *b = up(std::vector<int>(10, 3));
  CHECK(cudaMemcpyToSymbol(factor, f, sizeof f));
  CHECK(cudaMemcpyToSymbol(ticket, &zero, sizeof zero));
  LAUNCH(tickets, 8, 128, 0, nullptr, seen, least, b);
  CHECK(cudaMemcpyFromSymbol(&count, ticket, sizeof count));
  assert_int_equal(count, 1024);
  for (unsigned v : down(seen, 32)) assert_int_equal(v, ~0u);
  unsigned long long l = down(least, 1)[0];
  double v;
  memcpy(&v, &l, sizeof v);
  assert_true(v == 0.125);
  const int want[] = {8, 0, 31, (int)0x80000000, 23, 64, 0x3f800000, 500000, 3, 4};
  std::vector<int> got = down(b, 10);
  for (int k = 0; k < 10; k++) assert_int_equal(got[k], want[k]);
}

/* Streams and graphs. */
static __global__ void step(int *x, int factor_, int add)
{
  x[threadIdx.x] = factor_ * x[threadIdx.x] + add;
}

static void graphs_replay_what_was_recorded(void **)
{
  cudaStream_t main_stream, side;
  cudaEvent_t fork, join;
  cudaGraph_t graph;
  cudaGraphExec_t exec;
  int *x = up(std::vector<int>(64, 1)), *kept = room<int>(64), *sorted = room<int>(64), add = 2;
  size_t bytes = 0;
  void *temp = nullptr;
  CHECK(cub::DeviceScan::InclusiveSum(nullptr, bytes, x, sorted, 64));
  CHECK(cudaMalloc(&temp, bytes));
  CHECK(cudaStreamCreateWithFlags(&main_stream, cudaStreamNonBlocking));
  CHECK(cudaStreamCreateWithFlags(&side, cudaStreamNonBlocking));
  CHECK(cudaEventCreateWithFlags(&fork, cudaEventDisableTiming));
  CHECK(cudaEventCreateWithFlags(&join, cudaEventDisableTiming));
  CHECK(cudaStreamBeginCapture(main_stream, cudaStreamCaptureModeGlobal));
  LAUNCH(step, 1, 64, 0, main_stream, x, 3, add);
  add = 100;
  CHECK(cudaEventRecord(fork, main_stream));
  CHECK(cudaStreamWaitEvent(side, fork, 0));
  CHECK(cudaMemcpyAsync(kept, x, 64 * sizeof *x, cudaMemcpyDeviceToDevice, side));
  CHECK(cub::DeviceScan::InclusiveSum(temp, bytes, x, sorted, 64, main_stream));
  CHECK(cudaEventRecord(join, side));
  CHECK(cudaStreamWaitEvent(main_stream, join, 0));
  CHECK(cudaMemsetAsync(x, 0, 32 * sizeof *x, main_stream));
  CHECK(cudaStreamEndCapture(main_stream, &graph));
  CHECK(cudaGraphInstantiate(&exec, graph, 0));
  CHECK(cudaGraphDestroy(graph));
  for (int k = 0; k < 3; k++) CHECK(cudaGraphLaunch(exec, main_stream));
  CHECK(cudaStreamSynchronize(main_stream));
  std::vector<int> now = down(x, 64), before = down(kept, 64), sum = down(sorted, 64);
  for (int k = 0; k < 64; k++) {
    assert_int_equal(now[k], k < 32 ? 0 : 53); /* 1 -> 5 -> 17 -> 53 */
    assert_int_equal(before[k], k < 32 ? 2 : 53);
    assert_int_equal(sum[k], k < 32 ? 2 * (k + 1) : 64 + 53 * (k - 31));
  }
  CHECK(cudaGraphExecDestroy(exec));
  CHECK(cudaEventDestroy(fork)), CHECK(cudaEventDestroy(join));
  CHECK(cudaStreamDestroy(side)), CHECK(cudaStreamDestroy(main_stream));
  CHECK(cudaFree(temp));
  expect_success();
}

static void waiting_breaks_a_recording(void **)
{
  cudaStream_t stream;
  cudaGraph_t graph;
  CHECK(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
  CHECK(cudaStreamBeginCapture(stream, cudaStreamCaptureModeGlobal));
  CHECK(cudaStreamSynchronize(stream));
  expect_error(cudaErrorStreamCaptureUnsupported);
  CHECK(cudaStreamEndCapture(stream, &graph));
  expect_error(cudaErrorStreamCaptureInvalidated);
  CHECK(cudaStreamDestroy(stream));
  expect_success();
}

/* One stream waits for the other; elapsed time is not negative. */
static void events_order_streams(void **)
{
  cudaStream_t a, b;
  cudaEvent_t begin, end;
  int *x = up(std::vector<int>(32, 1)), *host;
  float ms;
  CHECK(cudaMallocHost(&host, 32 * sizeof *host));
  CHECK(cudaStreamCreateWithFlags(&a, cudaStreamNonBlocking));
  CHECK(cudaStreamCreateWithFlags(&b, cudaStreamNonBlocking));
  CHECK(cudaEventCreate(&begin)), CHECK(cudaEventCreate(&end));
  CHECK(cudaEventRecord(begin, a));
  for (int k = 0; k < 10; k++) LAUNCH(step, 1, 32, 0, a, x, 2, 0);
  CHECK(cudaEventRecord(end, a));
  CHECK(cudaStreamWaitEvent(b, end, 0));
  CHECK(cudaMemcpyAsync(host, x, 32 * sizeof *x, cudaMemcpyDeviceToHost, b));
  CHECK(cudaStreamSynchronize(b));
  for (int k = 0; k < 32; k++) assert_int_equal(host[k], 1024);
  CHECK(cudaEventElapsedTime(&ms, begin, end));
  assert_true(ms >= 0);
  CHECK(cudaEventDestroy(begin)), CHECK(cudaEventDestroy(end));
  CHECK(cudaStreamDestroy(a)), CHECK(cudaStreamDestroy(b));
  CHECK(cudaFreeHost(host));
  down(x, 32);
}

/* The first failure stays and names its place; nothing is launched after it. */
static void the_first_failure_stays(void **)
{
  Err err;
  int *x = up(std::vector<int>(32, 1));
  assert_int_equal(LAUNCH(step, 0, 32, 0, nullptr, x, 2, 0), -1);
  assert_int_equal(LAUNCH(step, 1, 32, 0, nullptr, x, 2, 0), -1);
  assert_int_equal(CHECK(cudaMemcpy(x, x + 1, 4, cudaMemcpyKind(9))), -1);
  assert_int_equal(launch_failed(error, &err), -1);
  assert_non_null(strstr(err.text, "cuda: test_host_cuda.cu:"));
  assert_non_null(strstr(err.text, ": step: invalid configuration argument"));
  expect_error(cudaErrorInvalidConfiguration);
  assert_int_equal(launch_failed(error, &err), 0);
  assert_int_equal(down(x, 1)[0], 1);
}

static void memory_ends(void **)
{
  size_t before, total, after;
  char *p;
  CHECK(cudaMemGetInfo(&before, &total));
  assert_true(before <= total);
  CHECK(cudaMalloc(&p, 2 * total));
  expect_error(cudaErrorMemoryAllocation);
  CHECK(cudaMalloc(&p, 1 << 28));
  CHECK(cudaMemGetInfo(&after, &total));
  assert_true(after + (1 << 28) <= before);
  CHECK(cudaFree(p));
  expect_success();
}

static void vectors_are_aligned(void **)
{
  assert_int_equal(alignof(float2), 8);
  assert_int_equal(alignof(float3), 4);
  assert_int_equal(alignof(float4), 16);
  assert_int_equal(alignof(double2), 16);
  assert_int_equal(alignof(int2), 8);
  assert_int_equal(alignof(uint4), 16);
  assert_int_equal(sizeof(double3), 24);
}

/* What only the host can show: mistakes. */
#ifndef __NVCC__

/* What f says on stderr when it is aborted, in a process of its own; "" when it is not. */
template <class F> static std::string death(F f)
{
  int pipes[2], status;
  std::string text;
  char c;
  assert_int_equal(pipe(pipes), 0);
  fflush(stdout);
  pid_t pid = fork();
  if (pid == 0) {
    signal(SIGABRT, SIG_DFL);
    dup2(pipes[1], 2);
    close(pipes[0]);
    f();
    _exit(0);
  }
  close(pipes[1]);
  while (read(pipes[0], &c, 1) == 1) text += c;
  close(pipes[0]);
  waitpid(pid, &status, 0);
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT ? text : "";
}

static __global__ void one_lane_stays_away(int *x)
{
  if (threadIdx.x == 5) {
    __syncthreads();
    x[0] = 1;
    return;
  }
  x[threadIdx.x] = __shfl_xor_sync(FULL, x[threadIdx.x], 1);
  __syncthreads();
}
static __global__ void barrier_in_branches(int *x)
{
  if (threadIdx.x < 7) {
    __syncthreads();
  } else {
    x[threadIdx.x] = 1;
    __syncthreads();
  }
}
static __global__ void shuffle_in_branches(int *x)
{
  if (threadIdx.x < 7)
    x[threadIdx.x] = __shfl_sync(FULL, x[threadIdx.x], 9);
  else
    x[threadIdx.x] = __shfl_sync(FULL, x[threadIdx.x], 3);
}
static __global__ void not_in_mask(int *x)
{
  if (threadIdx.x <= 8) x[threadIdx.x] = __any_sync(0xff, 1);
}
static __global__ void false_promise(int *x)
{
  int i = threadIdx.x;
  __builtin_assume(i < 31);
  x[i] = i;
}
static void mistakes_are_found(void **)
{
  int *x = up(std::vector<int>(64, 1));
  auto said = [&](void (*kernel)(int *), const char *what) {
    std::string text = death([&] { LAUNCH(kernel, 1, 32, 0, nullptr, x); });
    if (text.find(what) == std::string::npos) fail_msg("'%s' is not in: %s", what, text.c_str());
    assert_true(text.find("kernel kernel, block (0,0,0)") != std::string::npos);
    assert_true(text.find("test_host_cuda.cu:") != std::string::npos);
  };
  said(one_lane_stays_away, "deadlock");
  said(one_lane_stays_away, "__syncthreads: threads 5\n");
  said(one_lane_stays_away, "__shfl_xor_sync(0xffffffff) of warp 0: threads 0 1 2 3 4 6 7");
  said(barrier_in_branches, "__syncthreads, while others are at __syncthreads at");
  said(shuffle_in_branches, "__shfl_sync(0xffffffff) of warp 0: threads 0 1 2 3 4 5 6\n");
  said(not_in_mask, "thread (8,0,0)");
  said(not_in_mask, "__any_sync: lane 8 not in mask 0x000000ff");
  said(false_promise, "__builtin_assume(i < 31) does not hold");
  down(x, 64);
}

/* Reads the neighbour's value without a barrier (racy), or with. */
static __global__ void neighbour(int *x, int base, int racy)
{
  __shared__ int s[64];
  int t = threadIdx.x;
  s[t] = base + t;
  if (!racy) __syncthreads();
  x[t] = s[(t + 1) % 64] + s[(t + 63) % 64] - 2 * base;
}

static std::vector<int> in_order(const char *order, int racy)
{
  static int base; /* never what an earlier launch left */
  int *x = room<int>(64);
  setenv("HOST_CUDA_ORDER", order, 1);
  LAUNCH(neighbour, 1, 64, 0, nullptr, x, base += 1000, racy);
  unsetenv("HOST_CUDA_ORDER");
  return down(x, 64);
}

static void races_show_in_another_order(void **)
{
  for (int racy = 0; racy < 2; racy++) {
    std::vector<int> forward = in_order("forward", racy);
    for (const char *order : {"reverse", "1", "2", "3"})
      assert_int_equal(in_order(order, racy) == forward, !racy);
  }
}

static __global__ void leaves_undefined(float *x, int one)
{
  __shared__ float s[32];
  SHARED_DYNAMIC(float, d);
  int lane = threadIdx.x;
  x[lane] = d[lane] + (lane < 16 ? __shfl_down_sync(0xffff, 1.f, 1) : 0.f);
  if (lane == 31) s[one - 1] = 1, x[lane] = s[one];
}

#ifdef HOST_ASAN
enum { ZEROED = 1 }; /* static shared memory */
#else
enum { ZEROED = 0 };
#endif

static void what_nobody_wrote_is_nan(void **)
{
  float *x = up(std::vector<float>(32, 1)), *y = room<float>(32);
  LAUNCH(leaves_undefined, 2, 32, 128, nullptr, x, 1);
  std::vector<float> got = down(x, 32);
  for (int lane = 0; lane < 31; lane++) assert_true(isnan(got[lane]));
  assert_true(ZEROED || isnan(got[31]));
  for (float v : down(y, 32)) assert_true(isnan(v));
}

/* A copy has arrived when somebody has waited for it; bounds and directions are checked. */
static void copies_are_watched(void **)
{
  cudaStream_t stream;
  int *x = up(std::vector<int>(32, 1)), *host, here[33] = {0};
  setenv("HOST_CUDA_STREAMS", "lazy", 1);
  CHECK(cudaMallocHost(&host, 32 * sizeof *host));
  CHECK(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
  CHECK(cudaMemcpyAsync(host, x, 32 * sizeof *x, cudaMemcpyDeviceToHost, stream));
  assert_int_equal(host[0], -1);
  CHECK(cudaStreamSynchronize(stream));
  assert_int_equal(host[0], 1);
  unsetenv("HOST_CUDA_STREAMS");
  CHECK(cudaStreamDestroy(stream));
  CHECK(cudaFreeHost(host));
  expect_success();
  CHECK(cudaMemcpy(here, x, sizeof here, cudaMemcpyDeviceToHost));
  expect_error(cudaErrorInvalidValue);
  CHECK(cudaMemcpy(here, x, 32 * sizeof *x, cudaMemcpyHostToDevice));
  expect_error(cudaErrorInvalidValue);
  LAUNCH(step, 1, 32, 0, nullptr, here, 1, 1);
  expect_error(cudaErrorInvalidDevicePointer);
  down(x, 32);
}

/* A polls what B sets. */
static __global__ void poll(volatile int *flag)
{
  if (threadIdx.x >= 32) *flag = 1;
  while (threadIdx.x < 32 && !*flag) __nanosleep(100);
}

static void polling_ends(void **)
{
  for (const char *order : {"forward", "reverse", "5"}) {
    int *flag = up(std::vector<int>(1, 0));
    setenv("HOST_CUDA_ORDER", order, 1);
    LAUNCH(poll, 1, 64, 0, nullptr, flag);
    unsetenv("HOST_CUDA_ORDER");
    assert_int_equal(down(flag, 1)[0], 1);
  }
}

#define HOST_TESTS                                                                                 \
  , cmocka_unit_test(mistakes_are_found), cmocka_unit_test(races_show_in_another_order),           \
      cmocka_unit_test(what_nobody_wrote_is_nan), cmocka_unit_test(copies_are_watched),            \
      cmocka_unit_test(polling_ends)
#else
#define HOST_TESTS
#endif

/* Many meetings: 5120 threads, 2000 each. */
static __global__ void talk(float *x)
{
  float v = threadIdx.x;
  for (int k = 0; k < 2000; k++) v = 0.5f * (v + __shfl_xor_sync(FULL, v, 1 << k % 5));
  x[blockIdx.x * blockDim.x + threadIdx.x] = v;
}

static void meetings_average(void **)
{
  float *x = room<float>(5120);
  LAUNCH(talk, 40, 128, 0, nullptr, x);
  std::vector<float> got = down(x, 5120);
  for (int i = 0; i < 5120; i++) assert_true(got[i] == i % 128 / 32 * 32 + 15.5f);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shuffles_stay_in_their_section),
      cmocka_unit_test(branches_meet_apart),
      cmocka_unit_test(votes_count_who_is_there),
      cmocka_unit_test(blocks_scan),
      cmocka_unit_test(shared_memory_is_as_asked),
      cmocka_unit_test(atomics_lose_nothing),
      cmocka_unit_test(graphs_replay_what_was_recorded),
      cmocka_unit_test(waiting_breaks_a_recording),
      cmocka_unit_test(events_order_streams),
      cmocka_unit_test(the_first_failure_stays),
      cmocka_unit_test(memory_ends),
      cmocka_unit_test(vectors_are_aligned),
      cmocka_unit_test(meetings_average) HOST_TESTS,
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
