// A patch's cells with the ranges of their particles, and the places of a node's fields.
#include <set>

#include "check.hpp"
#include "mpm/grid/patch.hpp"

namespace {

using namespace mpm;

template <int D>
void check_cells(mpm::testing::Report& report) {
  Patch<D> patch;
  patch.begin = 100;
  for (int c = 0; c < Tile<D>::cell_count; ++c) {
    const std::uint32_t here = c % 3 == 1 ? static_cast<std::uint32_t>(c) : 0;  // some are empty
    patch.count += here;
    patch.cell_begin[static_cast<std::size_t>(c) + 1] = patch.count;
    if (here > 0) patch.occupied |= std::uint64_t{1} << c;
  }
  int last_cell = -1;
  std::uint32_t next = 100;
  patch.for_each_cell([&](int c, std::uint32_t first, std::uint32_t end) {
    CHECK(c > last_cell && c % 3 == 1, c);
    CHECK(first == next && end - first == static_cast<std::uint32_t>(c), c, first, end);
    last_cell = c;
    next = end;
  });
  CHECK_EQUAL(next, 100 + patch.count);
}

/// Every field of every node has a place of its own, but for those whose times do not meet.
template <int D>
void check_fields(mpm::testing::Report& report) {
  constexpr int count = 3;
  alignas(64) double memory[count * (record + half_record)];
  const NodeBlock<D> block{{memory}, count};
  std::set<const double*> places;
  const auto place = [&](const double& field) { return places.insert(&field).second; };
  for (int n = 0; n < count; ++n) {
    CHECK(place(block.mass()[n]), n);
    for (int a = 0; a < D; ++a) {
      CHECK(place(block.velocity(a)[n]) && place(block.force(a)[n]), n, a);
      CHECK(place(block.dashpot_factor(a)[n]), n, a);
      CHECK(&block.momentum(a)[n] == &block.velocity(a)[n], n, a);
      CHECK(&block.increment(a)[n] == &block.force(a)[n], n, a);
      CHECK(&block.remapped(a)[n] == &block.force(a)[n], n, a);
      CHECK(&block.ghost_weight(a)[n] == &block.force(a)[n], n, a);
      CHECK(&block.dashpot_force(a)[n] == &block.dashpot_factor(a)[n], n, a);
      CHECK(&block.velocity(a)[n] == block.records[n] + velocity_at + a, n, a);
      CHECK(&block.force(a)[n] == block.records.from(n).at(force_at)[0] + a, n, a);
    }
  }
  CHECK(*places.begin() >= memory && *places.rbegin() < std::end(memory));
}

}  // namespace

void test_patch(mpm::testing::Report& report) {
  check_cells<2>(report);
  check_cells<3>(report);
  check_fields<2>(report);
  check_fields<3>(report);
}
