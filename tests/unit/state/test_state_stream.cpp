// What is saved comes back in the same order, and what must be the same is compared.
#include <algorithm>

#include "check.hpp"
#include "mpm/state/state_stream.hpp"

namespace {

struct State {
  double time = 0.0;
  int step = 0;
  std::vector<int> list;
  std::array<double, 2> fixed{};

  void exchange(mpm::StateStream& stream, int kind) {
    stream.same(kind, "another kind");
    stream(time, step);
    stream.vector(list);
    stream.array(std::span<double>(fixed));
  }
};

}  // namespace

void test_state_stream(mpm::testing::Report& report) {
  using mpm::StateStream;
  std::vector<std::byte> file;
  const StateStream::Transfer write = [&](std::span<std::byte> bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
    return bytes.size();
  };
  State saved{0.5, 3, {4, 5, 6}, {7.0, 8.0}}, restored{0.0, 0, {1}, {}};
  mpm::NoOthers nobody;
  StateStream out(StateStream::Way::save, write, nobody);
  CHECK(!out.restores());
  saved.exchange(out, 2);

  std::size_t at = 0;
  const StateStream::Transfer read = [&](std::span<std::byte> bytes) {
    const std::size_t n = std::min(bytes.size(), file.size() - at);
    std::copy_n(file.begin() + static_cast<std::ptrdiff_t>(at), n, bytes.begin());
    at += n;
    return n;
  };
  StateStream in(StateStream::Way::restore, read, nobody);
  restored.exchange(in, 2);
  CHECK_EQUAL(at, file.size());
  CHECK(restored.time == 0.5 && restored.step == 3, restored.time, restored.step);
  CHECK(restored.list == saved.list, restored.list.size());
  CHECK(restored.fixed == saved.fixed, restored.fixed[0], restored.fixed[1]);

  at = 0;
  CHECK_THROWS(restored.exchange(in, 3), "another kind");

  at = 0;
  file.pop_back();
  CHECK_THROWS(restored.exchange(in, 2), "it ends too early");

  // A length that the bytes cannot have is refused before there is room for it.
  at = 0;
  StateStream few(StateStream::Way::restore, read, nobody, file.size());
  std::ranges::fill(std::span(file).subspan(sizeof(int) + sizeof(double) + sizeof(int), 7),
                    std::byte{0x7f});
  CHECK_THROWS(restored.exchange(few, 2), "it ends too early");
  CHECK(restored.list.size() < 4, restored.list.size());

  // Neither is there a bool of a byte that is none, nor may anything be left.
  file = {std::byte{2}, std::byte{1}};
  at = 0;
  bool flag = false;
  StateStream flags(StateStream::Way::restore, read, nobody, file.size());
  CHECK_THROWS(flags(flag), "it is damaged");
  CHECK_THROWS(flags.end(), "it is too long");
  flags(flag);
  flags.end();
  CHECK(flag);
  CHECK_THROWS(flags(flag), "it ends too early");
}
