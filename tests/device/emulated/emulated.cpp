// The threads of a block as fibers of one thread of the processor.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "cuda_runtime.h"

namespace emulated {

dim3 thread, block, block_size, grid_size;

namespace {

// Keep the registers that functions keep on the stack, and go on where another has left off: some
// nanoseconds, where swapcontext() takes two calls of the system.
#if defined(__x86_64__)
extern "C" void emulated_switch(void** from, void* to);
asm(R"(
.text
emulated_switch:
  pushq %rbp
  pushq %rbx
  pushq %r12
  pushq %r13
  pushq %r14
  pushq %r15
  movq %rsp, (%rdi)
  movq %rsi, %rsp
  popq %r15
  popq %r14
  popq %r13
  popq %r12
  popq %rbx
  popq %rbp
  ret
)");
#else
#error "the emulation switches fibers by hand, on x86-64 only"
#endif

// Not a multiple of a page: the tops of all stacks would share few lines of the cache.
constexpr std::size_t stack_bytes = (std::size_t{256} << 10) + 448, warp_size = 32;

enum class State { ready, at_block, at_warp, ended };

struct Fiber {
  void* context = nullptr;  // its stack's top while it does not run
  State state = State::ended;
  bool vote = false;
  unsigned mask = 0;       // of the warp, that it waits for
  unsigned exchanges = 0;  // of values, so far
  // By turns: who is ahead by one must not write over what others have not read yet.
  std::uint64_t given[2];
};

std::vector<Fiber> fibers;
std::unique_ptr<char[]> stacks;
std::size_t now = 0, count = 0, warp_end = 0;  // the one that runs; of the block; of its warp
int votes = 0;
void* scheduler = nullptr;
const std::function<void()>* body = nullptr;

/// Go on with the next of the warp that can, from `first`, or leave it to the scheduler.
void go_on(void** from, std::size_t first) {
  for (now = first; now < warp_end; ++now)
    if (fibers[now].state == State::ready) {
      thread.x = static_cast<unsigned>(now);
      return emulated_switch(from, fibers[now].context);
    }
  emulated_switch(from, scheduler);
}

void give_way(State state) {
  Fiber& fiber = fibers[now];
  fiber.state = state;
  go_on(&fiber.context, now + 1);
}

void enter() {
  (*body)();
  give_way(State::ended);
}

/// A fiber that begins with enter().
void prepare(std::size_t k) {
  // The top as a call leaves it: 8 bytes beside a multiple of 16.
  auto top = reinterpret_cast<std::uintptr_t>(&stacks[(k + 1) * stack_bytes]) & ~std::uintptr_t{15};
  auto* to = reinterpret_cast<void**>(top) - 2;
  *to = reinterpret_cast<void*>(&enter);
  constexpr int kept = 6;  // registers
  std::fill(to - kept, to, nullptr);
  fibers[k].context = to - kept;
  fibers[k].state = State::ready;
  fibers[k].exchanges = 0;
}

/// Let those of a warp go on for whom all have come; has any?
bool release_warp(std::size_t begin, std::size_t end) {
  bool any = false;
  for (std::size_t k = begin; k < end; ++k) {
    if (fibers[k].state != State::at_warp) continue;
    const unsigned mask = fibers[k].mask;
    bool all = true;
    for (std::size_t j = begin; j < end; ++j)
      if (mask >> (j - begin) & 1u)
        all = all && (fibers[j].state == State::ended ||
                      (fibers[j].state == State::at_warp && fibers[j].mask == mask));
    if (!all) continue;
    for (std::size_t j = begin; j < end; ++j)
      if ((mask >> (j - begin) & 1u) && fibers[j].state == State::at_warp)
        fibers[j].state = State::ready;
    any = true;
  }
  return any;
}

/// Let a warp run until all of it have ended or wait for the block.
void run_warp(std::size_t begin) {
  const std::size_t end = std::min(begin + warp_size, count);
  do {
    warp_end = end;
    go_on(&scheduler, begin);
  } while (release_warp(begin, end));
}

/// Let all go on that wait for the block, if all have come; has any?
bool release_block() {
  votes = 0;
  bool any = false;
  for (std::size_t k = 0; k < count; ++k) {
    Fiber& fiber = fibers[k];
    if (fiber.state == State::at_warp) {
      std::fprintf(stderr, "threads of a block wait for each other at different barriers\n");
      std::abort();
    }
    if (fiber.state != State::at_block) continue;
    votes += fiber.vote;
    fiber.state = State::ready;
    any = true;
  }
  return any;
}

void run_block() {
  for (std::size_t k = 0; k < count; ++k) prepare(k);
  do {
    for (std::size_t begin = 0; begin < count; begin += warp_size) run_warp(begin);
  } while (release_block());
}

/// The value that the thread at a lane of the warp has given, of up to eight bytes.
template <class T>
T exchange_any(T value, int lane) {
  const unsigned turn = fibers[now].exchanges++ % 2u;
  std::memcpy(&fibers[now].given[turn], &value, sizeof(T));
  wait_for_warp(~0u);
  const std::size_t from = now / warp_size * warp_size + static_cast<std::size_t>(lane);
  std::memcpy(&value, &fibers[from].given[turn], sizeof(T));
  return value;
}

}  // namespace

void run(dim3 blocks, unsigned threads, const std::function<void()>& kernel) {
  if (fibers.size() < threads) {
    fibers.resize(threads);
    stacks.reset(new char[threads * stack_bytes]);
  }
  count = threads;
  body = &kernel;
  block_size = dim3(threads);
  grid_size = blocks;
  thread = dim3(0, 0, 0);
  for (block.y = 0; block.y < blocks.y; ++block.y)
    for (block.x = 0; block.x < blocks.x; ++block.x) run_block();
}

int wait_for_block(bool vote) {
  fibers[now].vote = vote;
  give_way(State::at_block);
  return votes;
}

void wait_for_warp(unsigned mask) {
  fibers[now].mask = mask;
  give_way(State::at_warp);
}

double exchange(double value, int lane) { return exchange_any(value, lane); }
std::uint32_t exchange(std::uint32_t value, int lane) { return exchange_any(value, lane); }

}  // namespace emulated
