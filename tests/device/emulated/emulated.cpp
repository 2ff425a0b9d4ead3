// The threads of a block as fibers of one thread of the processor.
#include <algorithm>
#include <cstdio>
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

constexpr std::size_t stack_bytes = std::size_t{256} << 10;

enum class State { ready, at_block, at_warp, ended };

struct Fiber {
  void* context = nullptr;  // its stack's top while it does not run
  std::unique_ptr<char[]> stack{new char[stack_bytes]};
  State state = State::ended;
  bool vote = false;
  unsigned mask = 0;  // of the warp, that it waits for
  union {
    double number;
    std::uint32_t integer;
  } given;
};

std::vector<Fiber> fibers;
std::size_t now = 0, count = 0;  // the one that runs; of the block
int votes = 0;
void* scheduler = nullptr;
const std::function<void()>* body = nullptr;

void give_way(State state) {
  fibers[now].state = state;
  emulated_switch(&fibers[now].context, scheduler);
}

void enter() {
  (*body)();
  give_way(State::ended);
}

/// A fiber that begins with enter().
void prepare(Fiber& fiber) {
  // The top as a call leaves it: 8 bytes beside a multiple of 16.
  auto top =
      reinterpret_cast<std::uintptr_t>(fiber.stack.get() + stack_bytes) & ~std::uintptr_t{15};
  auto* to = reinterpret_cast<void**>(top) - 2;
  *to = reinterpret_cast<void*>(&enter);
  constexpr int kept = 6;  // registers
  std::fill(to - kept, to, nullptr);
  fiber.context = to - kept;
  fiber.state = State::ready;
}

/// Let those go on for whom all have come; has any?
bool release() {
  bool any = false, block_waits = true;
  for (std::size_t k = 0; k < count; ++k)
    block_waits =
        block_waits && (fibers[k].state == State::at_block || fibers[k].state == State::ended);
  if (block_waits) {
    votes = 0;
    for (std::size_t k = 0; k < count; ++k)
      if (fibers[k].state == State::at_block) {
        votes += fibers[k].vote;
        fibers[k].state = State::ready;
        any = true;
      }
    return any;
  }
  for (std::size_t warp = 0; warp < count; warp += 32) {
    const std::size_t end = std::min(warp + 32, count);
    for (std::size_t k = warp; k < end; ++k) {
      if (fibers[k].state != State::at_warp) continue;
      const unsigned mask = fibers[k].mask;
      bool all = true;
      for (std::size_t j = warp; j < end; ++j)
        if (mask >> (j - warp) & 1u)
          all = all && (fibers[j].state == State::ended ||
                        (fibers[j].state == State::at_warp && fibers[j].mask == mask));
      if (!all) continue;
      for (std::size_t j = warp; j < end; ++j)
        if ((mask >> (j - warp) & 1u) && fibers[j].state == State::at_warp)
          fibers[j].state = State::ready;
      any = true;
    }
  }
  return any;
}

void run_block() {
  for (std::size_t k = 0; k < count; ++k) prepare(fibers[k]);
  while (true) {
    bool all_ended = true;
    for (now = 0; now < count; ++now) {
      if (fibers[now].state == State::ready) {
        thread = dim3(static_cast<unsigned>(now), 0, 0);
        emulated_switch(&scheduler, fibers[now].context);
      }
      all_ended = all_ended && fibers[now].state == State::ended;
    }
    if (all_ended) return;
    if (!release()) {
      std::fprintf(stderr, "threads of a block wait for each other at different barriers\n");
      std::abort();
    }
  }
}

}  // namespace

void run(dim3 blocks, unsigned threads, const std::function<void()>& kernel) {
  if (fibers.size() < threads) fibers.resize(threads);
  count = threads;
  body = &kernel;
  block_size = dim3(threads);
  grid_size = blocks;
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

double exchange(double value, int lane) {
  fibers[now].given.number = value;
  wait_for_warp(~0u);
  const double found = fibers[now / 32 * 32 + static_cast<std::size_t>(lane)].given.number;
  wait_for_warp(~0u);
  return found;
}

std::uint32_t exchange(std::uint32_t value, int lane) {
  fibers[now].given.integer = value;
  wait_for_warp(~0u);
  const std::uint32_t found = fibers[now / 32 * 32 + static_cast<std::size_t>(lane)].given.integer;
  wait_for_warp(~0u);
  return found;
}

}  // namespace emulated
