#include "mpm/run/save_kept_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mpm/run/gather.hpp"
#include "mpm/run/kept_spins.hpp"

namespace mpm {
namespace {

constexpr std::size_t most_at_once = std::size_t{1} << 16;  // numbers that pass at once

/// A block of a patch that keeps its nodes, of whatever rank.
template <int D>
struct KeptBlock {
  std::int32_t body = 0, rank = 0;
  Index<D> tile{};
  std::size_t count = 0, first = 0;  // numbers, and how many are before it
  std::size_t memory = 0;            // on its rank
};

/// All of them, by body and tile.
template <int D>
std::vector<KeptBlock<D>> kept_blocks(const TileGrid<D>& grid) {
  Comm& comm = *grid.partition.comm;
  std::vector<KeptBlock<D>> blocks;
  for (const Patch<D>& patch : grid.patches)
    if (patch.keeps && !patch.foreign)
      blocks.push_back({patch.body, comm.rank(), patch.tile,
                        grid.numbers_kept(patch.shape.node_count), 0, patch.memory});
  entries_of_all(comm, blocks);
  std::ranges::sort(blocks, [](const KeptBlock<D>& x, const KeptBlock<D>& y) {
    return patch_less<D>(x.body, x.tile, y.body, y.tile);
  });
  std::size_t first = 0;
  for (KeptBlock<D>& block : blocks) {
    block.first = first;
    first += block.count;
  }
  return blocks;
}

}  // namespace

template <int D>
void exchange_kept_nodes(Domain<D>& domain, StateStream& stream) {
  TileGrid<D>& grid = domain.grid;
  const std::vector<KeptBlock<D>> blocks = kept_blocks(grid);
  const std::size_t all = blocks.empty() ? 0 : blocks.back().first + blocks.back().count;
  stream.same(all, "it was made from another case");
  double* const kept = grid.kept.numbers.data();
  if (stream.restores()) std::fill_n(kept, grid.kept.needed, 0.0);
  bool finite = true;
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin < all; begin += most_at_once) {
    numbers.assign(std::min(most_at_once, all - begin), 0.0);
    // f(number in the file from `begin` on, number in the memory here)
    const auto for_each_here = [&](auto&& f) {
      for (const KeptBlock<D>& block : blocks) {
        if (block.rank != stream.comm().rank()) continue;
        const std::size_t low = std::max(begin, block.first),
                          high = std::min(begin + numbers.size(), block.first + block.count);
        for (std::size_t k = low; k < high; ++k) f(k - begin, block.memory + k - block.first);
      }
    };
    if (!stream.restores())
      gather(stream.comm(), Slices(numbers.size()), 1, std::array{0}, std::span(numbers),
             [&](auto&& f) {
               for_each_here([&](std::size_t place, std::size_t at) { f(place, 0, kept[at]); });
             });
    stream.array(std::span(numbers));
    if (!stream.restores()) continue;
    finite = finite && std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
    for_each_here([&](std::size_t place, std::size_t at) { kept[at] = numbers[place]; });
  }
  if (stream.restores()) stream.check_all(finite, "its nodes are damaged");
}

template <int D>
void exchange_kept_spins(Domain<D>& domain, StateStream& stream) {
  std::vector<KeptSpin> all = stream.restores() ? domain.kept_spins : gather_kept_spins(domain);
  stream.array(std::span(all));
  if (!stream.restores()) return;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const KeptSpin &found = all[k], &own = domain.kept_spins[k];
    bool fine = found.body == own.body && found.mass == own.mass && found.excess == own.excess;
    for (const Vector3& v : {found.momentum, found.of_nodes, found.spin, found.centre,
                             found.velocity, found.acceleration})
      fine = fine && std::isfinite(dot(v, v));
    StateStream::check(fine, "its nodes are damaged");
    StateStream::check_flag(found.begun);
  }
  domain.kept_spins = std::move(all);
  find_shared_bodies(domain);
}

template void exchange_kept_nodes<2>(Domain<2>&, StateStream&);
template void exchange_kept_nodes<3>(Domain<3>&, StateStream&);
template void exchange_kept_spins<2>(Domain<2>&, StateStream&);
template void exchange_kept_spins<3>(Domain<3>&, StateStream&);

}  // namespace mpm
