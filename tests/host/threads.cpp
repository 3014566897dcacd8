/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fibers, their meetings and the order in which they run. A fiber lives on its own guarded stack
 * and is used again by each block: it runs the body once a turn. */
#include <cstdarg>
#include <cstdlib>
#include <deque>
#include <link.h>
#include <map>
#include <memory>
#include <string>
#include <sys/mman.h>
#include <tuple>
#include <unistd.h>
#include <vector>
#include "threads.h"

#ifdef HOST_ASAN
#include <sanitizer/common_interface_defs.h>
#endif

/* Where a fiber stands. On x86-64 the stack pointer says it all; elsewhere the C library does it.
 * */
#if defined(__x86_64__) && !defined(HOST_UCONTEXT)
struct Place {
  void *sp;
};

extern "C" void host_switch(void **from, void *to);
__asm__(".text\n.type host_switch,@function\nhost_switch:\n"
        "push %rbp\npush %rbx\npush %r12\npush %r13\npush %r14\npush %r15\n"
        "mov %rsp,(%rdi)\nmov %rsi,%rsp\n"
        "pop %r15\npop %r14\npop %r13\npop %r12\npop %rbx\npop %rbp\nret\n"
        ".size host_switch,.-host_switch\n");

static void place_new(Place *p, char *stack, size_t size, void (*entry)())
{
  void **top = reinterpret_cast<void **>(stack + size);
  *--top = nullptr; /* where entry would return to */
  *--top = reinterpret_cast<void *>(entry);
  for (int k = 0; k < 6; k++) *--top = nullptr;
  p->sp = top;
}

static void place_switch(Place *from, Place *to) { host_switch(&from->sp, to->sp); }
#else
#include <ucontext.h>
struct Place {
  ucontext_t context;
};

static void place_new(Place *p, char *stack, size_t size, void (*entry)())
{
  getcontext(&p->context);
  p->context.uc_stack.ss_sp = stack;
  p->context.uc_stack.ss_size = size;
  p->context.uc_link = nullptr;
  makecontext(&p->context, entry, 0);
}

static void place_switch(Place *from, Place *to) { swapcontext(&from->context, &to->context); }
#endif

uint3 threadIdx, blockIdx;
dim3 blockDim, gridDim;

namespace host
{

Thread *self;
Grid grid;

enum { STACK = 256 * 1024, LANES = 32 };

struct Fiber : Thread {
  Place place;
  char *stack;
  size_t size;
  void *fake; /* the address sanitizer's */
};

struct Warp {
  unsigned alive, runnable;
  std::deque<Meeting> all;
  std::vector<Meeting *> open, spare;
};

/* The block that runs. Counts are kept for two barriers: who left the first may be at the second.
 * */
struct Block {
  int alive, waiting, generation;
  Count count[2];
  const char *op, *file; /* of the barrier that fills */
  int line;
  std::vector<Warp> warps;
};

static std::vector<std::unique_ptr<Fiber>> fibers;
static Block block;
static Place scheduler;
static const std::function<void()> *body;
#ifdef HOST_ASAN
static void *scheduler_fake;
static const void *scheduler_stack;
static size_t scheduler_size;
#endif

static void say_place()
{
  fprintf(stderr, "kernel %s, block (%u,%u,%u)", grid.kernel, blockIdx.x, blockIdx.y, blockIdx.z);
}

void wrong(const char *file, int line, const char *format, ...)
{
  va_list args;
  fflush(stdout);
  say_place();
  if (self) fprintf(stderr, ", thread (%u,%u,%u)", self->index.x, self->index.y, self->index.z);
  fprintf(stderr, ": %s:%d: ", file, line);
  va_start(args, format);
  vfprintf(stderr, format, args);
  va_end(args);
  fputc('\n', stderr);
  abort();
}

/* Switching, with the address sanitizer told of it. */
static void resume(Fiber *f)
{
#ifdef HOST_ASAN
  __sanitizer_start_switch_fiber(&scheduler_fake, f->stack, f->size);
#endif
  self = f;
  threadIdx = f->index;
  place_switch(&scheduler, &f->place);
  self = nullptr;
#ifdef HOST_ASAN
  __sanitizer_finish_switch_fiber(scheduler_fake, nullptr, nullptr);
#endif
}

static void arrived(Fiber *f)
{
#ifdef HOST_ASAN
  __sanitizer_finish_switch_fiber(f->fake, &scheduler_stack, &scheduler_size);
#endif
  (void)f;
}

static void suspend()
{
  Fiber *f = static_cast<Fiber *>(self);
#ifdef HOST_ASAN
  __sanitizer_start_switch_fiber(&f->fake, scheduler_stack, scheduler_size);
#endif
  place_switch(&f->place, &scheduler);
  arrived(f);
}

/* A meeting ends when all of its mask that live have come; the lanes go on. */
static void meeting_try(Warp *w, size_t k)
{
  Meeting *m = w->open[k];
  if (m->came != (m->mask & w->alive)) return;
  w->runnable |= m->came;
  w->open.erase(w->open.begin() + (long)k);
}

static void meeting_leave(Thread *t)
{
  if (t->meeting && --t->meeting->readers == 0) t->warp->spare.push_back(t->meeting);
  t->meeting = nullptr;
}

/* Lanes meet at one line of the source; only __syncwarp joins branches. */
static bool meeting_is(const Meeting *m, const char *op, unsigned mask, const char *file, int line)
{
  if (m->mask != mask || strcmp(m->op, op) != 0) return false;
  return strcmp(op, "__syncwarp") == 0 || (m->line == line && strcmp(m->file, file) == 0);
}

static size_t meeting_find(Warp *w, const char *op, unsigned mask, const char *file, int line)
{
  for (size_t k = 0; k < w->open.size(); k++)
    if (meeting_is(w->open[k], op, mask, file, line)) return k;
  if (w->spare.empty()) w->all.emplace_back(), w->spare.push_back(&w->all.back());
  Meeting *m = w->spare.back();
  w->spare.pop_back();
  w->open.push_back(m);
  m->op = op, m->file = file, m->line = line, m->mask = mask, m->came = 0, m->readers = 0;
  return w->open.size() - 1;
}

const Meeting &meet(const char *op, unsigned mask, uint64_t value, const char *file, int line)
{
  Thread *t = self;
  Warp *w = t->warp;
  if (!(mask >> t->lane & 1))
    wrong(file, line, "%s: lane %d not in mask 0x%08x", op, t->lane, mask);
  meeting_leave(t);
  size_t k = meeting_find(w, op, mask, file, line);
  Meeting *m = t->meeting = w->open[k];
  m->value[t->lane] = value;
  m->came |= 1u << t->lane;
  m->readers++;
  w->runnable &= ~(1u << t->lane);
  meeting_try(w, k);
  if (!(w->runnable >> t->lane & 1)) suspend();
  return *m;
}

static void barrier_try()
{
  if (block.waiting == 0 || block.waiting < block.alive) return;
  block.waiting = 0;
  block.generation++;
  block.count[block.generation & 1] = {0, 0};
  for (Warp &w : block.warps) w.runnable = w.alive;
}

Count barrier(const char *op, int yes, const char *file, int line)
{
  Thread *t = self;
  Count *count = &block.count[block.generation & 1];
  meeting_leave(t);
  if (block.waiting++ == 0)
    block.op = op, block.file = file, block.line = line;
  else if (block.line != line || strcmp(block.file, file) != 0)
    wrong(file, line, "%s, while others are at %s at %s:%d", op, block.op, block.file, block.line);
  count->yes += yes, count->all++;
  t->warp->runnable &= ~(1u << t->lane);
  barrier_try();
  if (!(t->warp->runnable >> t->lane & 1)) suspend();
  return *count;
}

void yield() { suspend(); }

static void leave_block(Thread *t)
{
  Warp *w = t->warp;
  meeting_leave(t);
  w->alive &= ~(1u << t->lane), w->runnable &= ~(1u << t->lane);
  block.alive--;
  for (size_t k = w->open.size(); k-- > 0;) meeting_try(w, k);
  barrier_try();
}

static void fiber_main()
{
  Fiber *f = static_cast<Fiber *>(self);
  arrived(f);
  for (;;) {
    (*body)();
    leave_block(f);
    suspend();
  }
}

/* Stacks begin at different cache lines. */
static void fiber_new()
{
  auto f = std::make_unique<Fiber>();
  size_t page = (size_t)sysconf(_SC_PAGESIZE), skew = fibers.size() % 64 * 576;
  void *p = mmap(nullptr, STACK + page, PROT_READ | PROT_WRITE,
                 MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (p == MAP_FAILED || mprotect(p, page, PROT_NONE) != 0) {
    perror("stack of a fiber");
    abort();
  }
  f->stack = static_cast<char *>(p) + page;
  f->size = STACK - skew;
  f->fake = nullptr;
  place_new(&f->place, f->stack, f->size, fiber_main);
  fibers.push_back(std::move(f));
}

/* Order: a rule and a generator (xorshift64*) that shuffles. */
struct Order {
  enum { FORWARD, REVERSE, SHUFFLE } rule;
  uint64_t state;

  Order() : rule(FORWARD), state(0)
  {
    const char *e = getenv("HOST_CUDA_ORDER");
    if (!e || !*e || strcmp(e, "forward") == 0) return;
    rule = strcmp(e, "reverse") == 0 ? REVERSE : SHUFFLE;
    state = strtoull(e, nullptr, 10) * 0x9e3779b97f4a7c15u + 0x2545f4914f6cdd1du;
  }

  uint64_t draw()
  {
    state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
    return state * 0x2545f4914f6cdd1du >> 32;
  }

  /* The numbers 0..n-1 in the order in which they have their turn. */
  void turns(std::vector<unsigned> &t, unsigned n)
  {
    t.resize(n);
    for (unsigned k = 0; k < n; k++) t[k] = rule == REVERSE ? n - 1 - k : k;
    if (rule != SHUFFLE) return;
    for (unsigned k = n; k > 1; k--) std::swap(t[k - 1], t[draw() % k]);
  }
};

/* Some threads wait, none can go on. */
[[noreturn]] static void deadlock()
{
  std::map<std::tuple<std::string, int, std::string>, std::string> where;
  fflush(stdout);
  say_place();
  fprintf(stderr, ": deadlock\n");
  for (size_t k = 0; k < block.warps.size(); k++)
    for (int lane = 0; lane < LANES && k * LANES + (size_t)lane < fibers.size(); lane++) {
      const Fiber &f = *fibers[k * LANES + (size_t)lane];
      if (!(block.warps[k].alive >> lane & 1)) continue;
      char what[128];
      if (f.meeting)
        snprintf(what, sizeof what, "%s(0x%08x) of warp %zu", f.meeting->op, f.meeting->mask, k);
      else
        snprintf(what, sizeof what, "%s", block.op);
      where[{f.meeting ? f.meeting->file : block.file, f.meeting ? f.meeting->line : block.line,
             what}] += " " + std::to_string(f.rank);
    }
  for (const auto &w : where)
    fprintf(stderr, "  %s:%d: %s: threads%s\n", std::get<0>(w.first).c_str(), std::get<1>(w.first),
            std::get<2>(w.first).c_str(), w.second.c_str());
  fprintf(stderr, "  the other threads have exited\n");
  abort();
}

/* One turn of each lane that can; returns whether any could. */
static bool warp_pass(unsigned k, Order &order, std::vector<unsigned> &lanes)
{
  Warp *w = &block.warps[k];
  bool any = w->runnable != 0;
  if (order.rule == Order::SHUFFLE) order.turns(lanes, LANES);
  for (unsigned lane : lanes)
    if (w->runnable >> lane & 1) resume(fibers[k * LANES + lane].get());
  return any;
}

static void block_begin(unsigned n)
{
  unsigned warps = (n + LANES - 1) / LANES;
  while (fibers.size() < n) fiber_new();
  if (block.warps.size() != warps) block.warps = std::vector<Warp>(warps);
  block.alive = (int)n, block.waiting = 0, block.generation = 0;
  block.count[0] = block.count[1] = {0, 0};
  for (unsigned k = 0; k < warps; k++) {
    unsigned left = n - k * LANES;
    block.warps[k].alive = block.warps[k].runnable = left < LANES ? (1u << left) - 1 : ~0u;
  }
  for (unsigned k = 0; k < n; k++) {
    Fiber *f = fibers[k].get();
    f->index = {k % blockDim.x, k / blockDim.x % blockDim.y, k / blockDim.x / blockDim.y};
    f->rank = (int)k, f->lane = (int)(k % LANES), f->warp = &block.warps[k / LANES];
    f->meeting = nullptr;
  }
}

/* A warp goes on as far as it can, but not for ever: it may poll for what another does. */
static void block_run(unsigned n, Order &order)
{
  std::vector<unsigned> warps, lanes;
  int passes = order.rule == Order::SHUFFLE ? 1 : 1000;
  block_begin(n);
  order.turns(lanes, LANES);
  while (block.alive > 0) {
    bool any = false;
    order.turns(warps, (unsigned)block.warps.size());
    for (unsigned k : warps)
      for (int pass = 0; pass < passes && warp_pass(k, order, lanes); pass++) any = true;
    if (!any) deadlock();
  }
}

#ifndef HOST_ASAN
/* Thread-local variables of the program itself, without initialiser: static shared memory. */
static int spoil_program(struct dl_phdr_info *info, size_t, void *)
{
  for (int k = 0; k < info->dlpi_phnum && info->dlpi_tls_data; k++) {
    const ElfW(Phdr) *p = &info->dlpi_phdr[k];
    if (p->p_type == PT_TLS)
      memset(static_cast<char *>(info->dlpi_tls_data) + p->p_filesz, 0xff,
             p->p_memsz - p->p_filesz);
  }
  return 1; /* the first object is the program */
}
#endif

/* Shared memory begins undefined. */
static void spoil_shared(size_t dynamic)
{
  if (dynamic) memset(grid.shared, 0xff, dynamic);
#ifndef HOST_ASAN
  dl_iterate_phdr(spoil_program, nullptr);
#endif
}

void threads_run(const char *kernel, dim3 blocks, dim3 threads, size_t shared,
                 const std::function<void()> &f)
{
  Order order;
  std::vector<unsigned> turns;
  std::unique_ptr<unsigned char[]> dynamic(new unsigned char[shared]);
  grid = {kernel, dynamic.get()};
  gridDim = blocks, blockDim = threads;
  body = &f;
  order.turns(turns, blocks.x * blocks.y * blocks.z);
  for (unsigned k : turns) {
    blockIdx = {k % blocks.x, k / blocks.x % blocks.y, k / blocks.x / blocks.y};
    spoil_shared(shared);
    block_run(threads.x * threads.y * threads.z, order);
  }
}

} // namespace host
