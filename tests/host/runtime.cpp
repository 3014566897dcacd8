/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runtime's calls: one made-up device, its memory, streams, events and graphs. Everything that
 * a stream does is a closure; it waits in the stream's queue or stands in a graph. Any thread may
 * call; one call at a time. */
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>
#include "threads.h"

typedef std::chrono::steady_clock Clock;

struct Node {
  std::string name;
  std::function<void()> run;
};

struct CUgraph_st {
  std::vector<Node> nodes;
};
struct CUgraphExec_st {
  std::shared_ptr<std::vector<Node>> nodes;
};

/* A recording: the stream that began it, those that joined by an event, and what was issued. */
struct Capture {
  cudaStream_t origin;
  cudaStreamCaptureMode mode;
  bool broken;
  std::vector<Node> nodes;
};

struct CUstream_st {
  unsigned flags;
  std::deque<std::function<void()>> queue;
  std::shared_ptr<Capture> capture;
};

/* What a queue may outlive of an event: how often it was recorded, and how often that has run. */
struct Mark {
  cudaStream_t stream;
  long issued, reached;
  Clock::time_point time;
};
struct CUevent_st {
  unsigned flags;
  std::shared_ptr<Mark> mark;
  std::shared_ptr<Capture> capture;
};

struct Piece {
  size_t bytes;
  enum { DEVICE, PINNED, SYMBOL } kind;
};

static std::recursive_mutex mutex;
static std::map<uintptr_t, Piece> pieces; /* by address */
static std::map<const void *, int> shared_limit;
static CUstream_st null_stream = {};
static std::set<cudaStream_t> streams;
static size_t used; /* bytes of device memory */
static cudaError_t last_error;

enum { QUEUE = 1024 };

#define LOCK() std::lock_guard<std::recursive_mutex> lock(mutex)

cudaError_t host::done(cudaError_t code)
{
  if (code != cudaSuccess && code != cudaErrorNotReady) last_error = code;
  return code;
}
using host::done;

/* Memory. */
static size_t memory_size()
{
  const char *e = getenv("HOST_CUDA_MEMORY");
  return e && *e ? strtoull(e, nullptr, 10) : (size_t)4 << 30;
}

/* The piece that holds bytes bytes at p, or NULL. */
static const Piece *piece_at(const void *p, size_t bytes)
{
  uintptr_t a = reinterpret_cast<uintptr_t>(p);
  auto it = pieces.upper_bound(a);
  if (it == pieces.begin()) return nullptr;
  --it;
  return a - it->first <= it->second.bytes && bytes <= it->second.bytes - (a - it->first)
             ? &it->second
             : nullptr;
}

bool host::reachable(const volatile void *p)
{
  LOCK();
  return piece_at(const_cast<const void *>(p), 0) != nullptr;
}

cudaError_t host::symbol(const void *p, size_t bytes)
{
  LOCK();
  pieces[reinterpret_cast<uintptr_t>(p)] = {bytes, Piece::SYMBOL};
  return cudaSuccess;
}

static bool capturing(bool relaxed_too)
{
  for (cudaStream_t s : streams)
    if (s->capture && (relaxed_too || s->capture->mode != cudaStreamCaptureModeRelaxed))
      return true;
  return false;
}

static cudaError_t break_captures()
{
  for (cudaStream_t s : streams)
    if (s->capture) s->capture->broken = true;
  return done(cudaErrorStreamCaptureUnsupported);
}

static cudaError_t piece_new(void **p, size_t bytes, decltype(Piece::kind) kind)
{
  LOCK();
  *p = nullptr;
  if (capturing(false)) return break_captures();
  if (bytes == 0) return done(cudaSuccess);
  if (kind == Piece::DEVICE && used + bytes > memory_size()) return done(cudaErrorMemoryAllocation);
  if (!(*p = aligned_alloc(256, (bytes + 255) / 256 * 256))) return done(cudaErrorMemoryAllocation);
  memset(*p, 0xff, bytes);
  pieces[reinterpret_cast<uintptr_t>(*p)] = {bytes, kind};
  if (kind == Piece::DEVICE) used += bytes;
  return done(cudaSuccess);
}

static void run_front(cudaStream_t s)
{
  std::function<void()> f = std::move(s->queue.front());
  s->queue.pop_front();
  f();
}

static void drain(cudaStream_t s)
{
  while (!s->queue.empty()) run_front(s);
}

static void drain_all(bool unblocking_too)
{
  for (cudaStream_t s : streams)
    if (unblocking_too || !(s->flags & cudaStreamNonBlocking)) drain(s);
}

static cudaError_t piece_free(void *p, bool pinned)
{
  LOCK();
  if (capturing(false)) return break_captures();
  if (!p) return done(cudaSuccess);
  auto it = pieces.find(reinterpret_cast<uintptr_t>(p));
  if (it == pieces.end() || it->second.kind != (pinned ? Piece::PINNED : Piece::DEVICE))
    return done(cudaErrorInvalidValue);
  drain_all(true);
  if (!pinned) used -= it->second.bytes;
  pieces.erase(it);
  free(p);
  return done(cudaSuccess);
}

cudaError_t cudaMalloc(void **p, size_t bytes) { return piece_new(p, bytes, Piece::DEVICE); }
cudaError_t cudaFree(void *p) { return piece_free(p, false); }
cudaError_t cudaHostAlloc(void **p, size_t n, unsigned) { return piece_new(p, n, Piece::PINNED); }
cudaError_t cudaMallocHost(void **p, size_t n, unsigned) { return piece_new(p, n, Piece::PINNED); }
cudaError_t cudaFreeHost(void *p) { return piece_free(p, true); }
cudaError_t cudaMallocAsync(void **p, size_t bytes, cudaStream_t) { return cudaMalloc(p, bytes); }
cudaError_t cudaFreeAsync(void *p, cudaStream_t) { return cudaFree(p); }

cudaError_t cudaHostGetDevicePointer(void **device, void *p, unsigned)
{
  LOCK();
  const Piece *at = piece_at(p, 0);
  *device = p;
  return done(at && at->kind == Piece::PINNED ? cudaSuccess : cudaErrorInvalidValue);
}

cudaError_t cudaMemGetInfo(size_t *available, size_t *total)
{
  LOCK();
  *total = memory_size();
  *available = *total > used ? *total - used : 0;
  return done(cudaSuccess);
}

/* Streams. */
static cudaStream_t stream_of(cudaStream_t s)
{
  if (!s) s = &null_stream;
  streams.insert(&null_stream);
  return streams.count(s) ? s : nullptr;
}

static bool lazy()
{
  const char *e = getenv("HOST_CUDA_STREAMS");
  return !e || strcmp(e, "eager") != 0;
}

/* What is issued to the null stream waits for the other blocking streams and runs at once; they
 * have nothing to wait for then. */
cudaError_t host::issue(cudaStream_t stream, const char *name, std::function<void()> f)
{
  LOCK();
  cudaStream_t s = stream_of(stream);
  if (!s) return done(cudaErrorInvalidResourceHandle);
  if (s == &null_stream && capturing(false)) return break_captures();
  if (s->capture) {
    s->capture->nodes.push_back({name, std::move(f)});
    return done(s->capture->broken ? cudaErrorStreamCaptureInvalidated : cudaSuccess);
  }
  if (s == &null_stream) drain_all(false);
  s->queue.push_back(std::move(f));
  if (s == &null_stream || !lazy()) drain(s);
  while (s->queue.size() > QUEUE) run_front(s);
  return done(cudaSuccess);
}

cudaError_t cudaStreamCreateWithPriority(cudaStream_t *stream, unsigned flags, int)
{
  LOCK();
  *stream = new CUstream_st{flags, {}, nullptr};
  streams.insert(*stream);
  return done(cudaSuccess);
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t *stream, unsigned flags)
{
  return cudaStreamCreateWithPriority(stream, flags, 0);
}

cudaError_t cudaStreamCreate(cudaStream_t *stream) { return cudaStreamCreateWithFlags(stream, 0); }

cudaError_t cudaDeviceGetStreamPriorityRange(int *least, int *greatest)
{
  *least = 0, *greatest = -5;
  return done(cudaSuccess);
}

cudaError_t cudaStreamDestroy(cudaStream_t stream)
{
  LOCK();
  if (!stream || !stream_of(stream)) return done(cudaErrorInvalidResourceHandle);
  drain(stream);
  streams.erase(stream);
  delete stream;
  return done(cudaSuccess);
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream)
{
  LOCK();
  cudaStream_t s = stream_of(stream);
  if (!s) return done(cudaErrorInvalidResourceHandle);
  if (s->capture) return break_captures();
  drain(s);
  if (s == &null_stream) drain_all(false);
  return done(cudaSuccess);
}

cudaError_t cudaStreamQuery(cudaStream_t stream)
{
  LOCK();
  cudaStream_t s = stream_of(stream);
  if (!s) return done(cudaErrorInvalidResourceHandle);
  if (s->capture) return break_captures();
  if (s->queue.empty()) return done(cudaSuccess);
  run_front(s); /* time goes on */
  return done(cudaErrorNotReady);
}

cudaError_t cudaDeviceSynchronize()
{
  LOCK();
  if (capturing(true)) return break_captures();
  drain_all(true);
  return done(cudaSuccess);
}

cudaError_t cudaDeviceReset() { return cudaDeviceSynchronize(); }

cudaError_t cudaLaunchHostFunc(cudaStream_t stream, cudaHostFn_t f, void *data)
{
  return host::issue(stream, "host function", [=] { f(data); });
}

/* Copies. */
static bool copy_side_ok(const void *p, size_t bytes, bool device)
{
  const Piece *at = piece_at(p, bytes);
  if (device) return at != nullptr;
  return at ? at->kind == Piece::PINNED : !piece_at(p, 0);
}

static cudaError_t copy_checks(const void *to, const void *from, size_t n, cudaMemcpyKind kind)
{
  bool to_device = kind == cudaMemcpyHostToDevice || kind == cudaMemcpyDeviceToDevice;
  bool from_device = kind == cudaMemcpyDeviceToHost || kind == cudaMemcpyDeviceToDevice;
  if (n == 0) return cudaSuccess;
  if (!to || !from || kind > cudaMemcpyDefault) return cudaErrorInvalidValue;
  if (kind == cudaMemcpyDefault) to_device = piece_at(to, 0), from_device = piece_at(from, 0);
  return copy_side_ok(to, n, to_device) && copy_side_ok(from, n, from_device)
             ? cudaSuccess
             : cudaErrorInvalidValue;
}

/* From pageable memory the bytes are taken at once, to it the call waits, as on a device. */
cudaError_t cudaMemcpyAsync(void *to, const void *from, size_t n, cudaMemcpyKind kind,
                            cudaStream_t stream)
{
  LOCK();
  cudaError_t code = copy_checks(to, from, n, kind);
  cudaStream_t s = stream_of(stream);
  if (code != cudaSuccess || !s) return done(code ? code : cudaErrorInvalidResourceHandle);
  if (n == 0) return done(cudaSuccess);
  if (s->capture || piece_at(from, n)) {
    code = host::issue(stream, "copy", [=] { memmove(to, from, n); });
  } else {
    const char *p = static_cast<const char *>(from);
    auto bytes = std::make_shared<std::vector<char>>(p, p + n);
    code = host::issue(stream, "copy", [=] { memcpy(to, bytes->data(), n); });
  }
  if (!s->capture && !piece_at(to, n)) drain(s);
  return code;
}

cudaError_t cudaMemcpy(void *to, const void *from, size_t bytes, cudaMemcpyKind kind)
{
  return cudaMemcpyAsync(to, from, bytes, kind, nullptr);
}

cudaError_t cudaMemsetAsync(void *p, int value, size_t bytes, cudaStream_t stream)
{
  LOCK();
  if (bytes == 0) return done(cudaSuccess);
  if (!piece_at(p, bytes)) return done(cudaErrorInvalidValue);
  return host::issue(stream, "memset", [=] { memset(p, value, bytes); });
}

cudaError_t cudaMemset(void *p, int value, size_t bytes)
{
  return cudaMemsetAsync(p, value, bytes, nullptr);
}

/* Events. */
cudaError_t cudaEventCreateWithFlags(cudaEvent_t *event, unsigned flags)
{
  LOCK();
  *event = new CUevent_st{flags, std::make_shared<Mark>(), nullptr};
  return done(cudaSuccess);
}

cudaError_t cudaEventCreate(cudaEvent_t *event) { return cudaEventCreateWithFlags(event, 0); }

cudaError_t cudaEventDestroy(cudaEvent_t event)
{
  LOCK();
  delete event;
  return done(cudaSuccess);
}

cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream)
{
  LOCK();
  cudaStream_t s = stream_of(stream);
  if (!s || !event) return done(cudaErrorInvalidResourceHandle);
  event->capture = s->capture;
  if (s->capture) return done(cudaSuccess);
  std::shared_ptr<Mark> m = event->mark;
  long number = ++m->issued;
  m->stream = s;
  return host::issue(stream, "event", [=] { m->reached = number, m->time = Clock::now(); });
}

static void reach(Mark *m, long number)
{
  while (m->reached < number) run_front(m->stream);
}

cudaError_t cudaEventSynchronize(cudaEvent_t event)
{
  LOCK();
  if (event->capture) return break_captures();
  reach(event->mark.get(), event->mark->issued);
  return done(cudaSuccess);
}

cudaError_t cudaEventQuery(cudaEvent_t event)
{
  LOCK();
  Mark *m = event->mark.get();
  if (event->capture) return break_captures();
  if (m->reached == m->issued) return done(cudaSuccess);
  run_front(m->stream); /* time goes on */
  return done(cudaErrorNotReady);
}

cudaError_t cudaEventElapsedTime(float *ms, cudaEvent_t start, cudaEvent_t end)
{
  LOCK();
  const Mark *a = start->mark.get(), *b = end->mark.get();
  if ((start->flags | end->flags) & cudaEventDisableTiming || !a->issued || !b->issued)
    return done(cudaErrorInvalidResourceHandle);
  if (a->reached < a->issued || b->reached < b->issued) return done(cudaErrorNotReady);
  *ms = std::chrono::duration<float, std::milli>(b->time - a->time).count();
  return done(cudaSuccess);
}

cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned)
{
  LOCK();
  cudaStream_t s = stream_of(stream);
  if (!s || !event) return done(cudaErrorInvalidResourceHandle);
  if (event->capture) { /* joins */
    if (s->capture && s->capture != event->capture) return break_captures();
    s->capture = event->capture;
    return done(cudaSuccess);
  }
  std::shared_ptr<Mark> m = event->mark;
  long number = m->issued;
  return host::issue(stream, "wait", [=] { reach(m.get(), number); });
}

/* Graphs. */
cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode mode)
{
  LOCK();
  cudaStream_t s = stream_of(stream);
  if (!s) return done(cudaErrorInvalidResourceHandle);
  if (s == &null_stream || s->capture) return done(cudaErrorStreamCaptureUnsupported);
  s->capture = std::make_shared<Capture>(Capture{s, mode, false, {}});
  return done(cudaSuccess);
}

cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t *graph)
{
  LOCK();
  cudaStream_t s = stream_of(stream);
  if (!s) return done(cudaErrorInvalidResourceHandle);
  std::shared_ptr<Capture> c = s->capture;
  *graph = nullptr;
  if (!c || c->origin != s) return done(cudaErrorStreamCaptureUnmatched);
  for (cudaStream_t other : streams)
    if (other->capture == c) other->capture = nullptr;
  if (c->broken) return done(cudaErrorStreamCaptureInvalidated);
  *graph = new CUgraph_st{c->nodes};
  return done(cudaSuccess);
}

cudaError_t cudaStreamIsCapturing(cudaStream_t stream, cudaStreamCaptureStatus *status)
{
  LOCK();
  cudaStream_t s = stream_of(stream);
  if (!s) return done(cudaErrorInvalidResourceHandle);
  *status = !s->capture          ? cudaStreamCaptureStatusNone
            : s->capture->broken ? cudaStreamCaptureStatusInvalidated
                                 : cudaStreamCaptureStatusActive;
  return done(cudaSuccess);
}

cudaError_t cudaGraphInstantiate(cudaGraphExec_t *exec, cudaGraph_t graph, unsigned long long)
{
  LOCK();
  if (!graph) return done(cudaErrorInvalidValue);
  *exec = new CUgraphExec_st{std::make_shared<std::vector<Node>>(graph->nodes)};
  return done(cudaSuccess);
}

cudaError_t cudaGraphExecUpdate(cudaGraphExec_t exec, cudaGraph_t graph,
                                cudaGraphExecUpdateResultInfo *info)
{
  LOCK();
  bool same = exec->nodes->size() == graph->nodes.size();
  for (size_t k = 0; same && k < graph->nodes.size(); k++)
    same = (*exec->nodes)[k].name == graph->nodes[k].name;
  if (info) info->result = !same;
  if (!same) return done(cudaErrorGraphExecUpdateFailure);
  exec->nodes = std::make_shared<std::vector<Node>>(graph->nodes);
  return done(cudaSuccess);
}

cudaError_t cudaGraphUpload(cudaGraphExec_t, cudaStream_t) { return done(cudaSuccess); }

cudaError_t cudaGraphLaunch(cudaGraphExec_t exec, cudaStream_t stream)
{
  auto nodes = exec->nodes;
  return host::issue(stream, "graph", [=] {
    for (const Node &n : *nodes) n.run();
  });
}

cudaError_t cudaGraphExecDestroy(cudaGraphExec_t exec)
{
  delete exec;
  return done(cudaSuccess);
}

cudaError_t cudaGraphDestroy(cudaGraph_t graph)
{
  delete graph;
  return done(cudaSuccess);
}

/* Launches. */
cudaError_t host::launch_attribute(const void *kernel, cudaFuncAttribute attribute, int value)
{
  LOCK();
  if (attribute != cudaFuncAttributeMaxDynamicSharedMemorySize) return done(cudaSuccess);
  if (value < 0 || value > host::SHARED_OPTIN) return done(cudaErrorInvalidValue);
  shared_limit[kernel] = value;
  return done(cudaSuccess);
}

cudaError_t host::launch_checks(const cudaLaunchConfig_t *c, const void *kernel)
{
  LOCK();
  dim3 g = c->gridDim, b = c->blockDim;
  auto it = shared_limit.find(kernel);
  size_t limit = it == shared_limit.end() ? (size_t)host::SHARED : (size_t)it->second;
  bool good = g.x && g.y && g.z && b.x && b.y && b.z;
  good = good && g.x <= 0x7fffffff && g.y <= 65535 && g.z <= 65535;
  good = good && b.x <= 1024 && b.y <= 1024 && b.z <= 64 && b.x * b.y * b.z <= 1024;
  if (c->dynamicSmemBytes > limit) return cudaErrorInvalidValue;
  return good ? cudaSuccess : cudaErrorInvalidConfiguration;
}

cudaError_t host::launch_issue(const char *name, const cudaLaunchConfig_t *c,
                               std::function<void()> body)
{
  dim3 g = c->gridDim, b = c->blockDim;
  size_t shared = c->dynamicSmemBytes;
  return issue(c->stream, name, [=] { threads_run(name, g, b, shared, body); });
}

/* Failures. */
cudaError_t cudaGetLastError()
{
  LOCK();
  cudaError_t code = last_error;
  last_error = cudaSuccess;
  return code;
}

cudaError_t cudaPeekAtLastError()
{
  LOCK();
  return last_error;
}
