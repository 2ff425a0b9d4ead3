#include <algorithm>
#include <cmath>
#include <limits>

#include "mpm/particles/cell_lists.hpp"

namespace mpm {
namespace {

/// What the stages of a step cost for a patch, in quarters of a particle.
template <int D>
std::int64_t cost_of(const Patch<D>& patch, const std::vector<Body<D>>& bodies) {
  // Those whose motion is prescribed cost their nodes only.
  const bool moves_alone = bodies[static_cast<std::size_t>(patch.body)].is_prescribed();
  return patch.count == 0 ? 0 : (moves_alone ? 0 : 4 * patch.count) + Tile<D>::cell_count;
}

/// The least box around the tiles with particles, of all ranks.
template <int D>
void set_box(Comm& comm, std::span<const Patch<D>> patches, Owners<D>& owners) {
  double ends[2 * D];
  std::ranges::fill(ends, -std::numeric_limits<double>::infinity());
  for (const Patch<D>& patch : patches)
    for (std::size_t a = 0; patch.count > 0 && a < D; ++a) {
      ends[a] = std::max(ends[a], -1.0 * patch.tile[a]);
      ends[D + a] = std::max(ends[D + a], 1.0 * patch.tile[a]);
    }
  comm.all_max(ends);
  if (!std::isfinite(ends[0])) return;
  Index<D> low, high;
  for (std::size_t a = 0; a < D; ++a) {
    low[a] = static_cast<std::int32_t>(-ends[a]);
    high[a] = static_cast<std::int32_t>(ends[D + a]);
  }
  owners.set_box(low, high);
}

/// The largest cost of a rank with these owners. By all ranks at once.
template <int D>
std::int64_t largest_cost(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                          std::span<const TileCost<D>> more, const Owners<D>& owners) {
  std::vector<std::int64_t> costs(owners.first.size(), 0);
  const auto add = [&](const Index<D>& tile, std::int64_t cost) {
    costs[static_cast<std::size_t>(owners.rank_of(tile))] += cost;
  };
  for (const Patch<D>& patch : grid.patches) add(patch.tile, cost_of(patch, bodies));
  for (const TileCost<D>& of : more) add(of.tile, of.cost);
  grid.partition.comm->all_sum(costs);
  return std::ranges::max(costs);
}

/// Where ranges of tiles begin whose costs are alike: sums over all ranks, bit by bit of the place.
template <int D>
Owners<D> owners_of(Comm& comm, std::span<const Patch<D>> patches,
                    const std::vector<Body<D>>& bodies, std::span<const TileCost<D>> more) {
  struct Cost {
    std::uint64_t place;
    std::int64_t until;  // of all up to this one
  };
  Owners<D> owners;
  set_box(comm, patches, owners);
  std::vector<Cost> costs;
  for (const Patch<D>& patch : patches)
    if (patch.count > 0) costs.push_back({owners.place(patch.tile), cost_of(patch, bodies)});
  for (const TileCost<D>& of : more) costs.push_back({owners.place(of.tile), of.cost});
  std::ranges::sort(costs, {}, &Cost::place);
  std::int64_t here = 0;
  for (Cost& cost : costs) cost.until = here += cost.until;
  const auto before = [&](std::uint64_t place) {
    const auto next = std::ranges::lower_bound(costs, place, {}, &Cost::place);
    return next == costs.begin() ? 0 : std::prev(next)->until;
  };
  const auto ranks = static_cast<std::size_t>(comm.size());
  const std::int64_t total = all_sum(comm, here);
  owners.first.assign(ranks, 0);
  std::vector<std::int64_t> sums(ranks), below(ranks, 0);
  std::vector<bool> found(ranks, false);
  // A range may be so much larger or smaller, so that it begins where a large part of the curve
  // does: the surface of what it holds is less then.
  const std::int64_t off = total / comm.size() / 100;
  constexpr int bits = Owners<D>::bits * D;
  for (std::uint64_t bit = std::uint64_t{1} << (bits - 1); bit > 0; bit >>= 1) {
    for (std::size_t r = 0; r < ranks; ++r) sums[r] = before(owners.first[r] + bit);
    comm.all_sum(sums);
    // Rank r's begins at the last place before which there is no more than its share.
    for (std::size_t r = 1; r < ranks; ++r) {
      const std::int64_t share = total * static_cast<std::int64_t>(r) / comm.size();
      if (found[r] || sums[r] > share + off) continue;
      owners.first[r] += bit;
      below[r] = sums[r];
      found[r] = below[r] >= share - off;
    }
  }
  return owners;
}

}  // namespace

template <int D>
Owners<D> choose_owners(const TileGrid<D>& grid, std::span<const Patch<D>> patches,
                        const std::vector<Body<D>>& bodies) {
  return owners_of<D>(*grid.partition.comm, patches, bodies, {});
}

template <int D>
void divide(TileGrid<D>& grid, std::vector<Body<D>>& bodies, std::vector<ParticlePool<D>>& pools,
            Threads& threads, ListScratch<D>& scratch, std::optional<Owners<D>> owners) {
  take_owners(grid, owners ? std::move(*owners) : choose_owners<D>(grid, grid.patches, bodies));
  update_cell_lists<D>(grid, bodies, pools, threads, scratch, nullptr, nullptr);
  // Those that have come lie wherever there was room.
  repack(grid.patches, bodies, pools);
  scratch.own.release_and_allocate(0);
  scratch.own_lists.release_and_allocate(0);
}

template <int D>
bool share_out_anew(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                    std::span<const TileCost<D>> more, double bound) {
  Comm& comm = *grid.partition.comm;
  std::int64_t here = 0;
  for (const Patch<D>& patch : grid.patches) here += cost_of(patch, bodies);
  for (const TileCost<D>& of : more) here += of.cost;
  const double largest = all_max(comm, static_cast<double>(here));
  const double mean = static_cast<double>(all_sum(comm, here)) / comm.size();
  if (largest <= bound * mean) return false;
  Owners<D> owners = owners_of<D>(comm, grid.patches, bodies, more);
  // Where tiles are few, others may be no better.
  if (static_cast<double>(largest_cost(grid, bodies, more, owners)) >= largest) return false;
  take_owners(grid, std::move(owners));
  return true;
}

template <int D>
void take_owners(TileGrid<D>& grid, Owners<D> owners) {
  Partition<D>& partition = grid.partition;
  partition.owners = std::move(owners);
  partition.divided = true;
  partition.readers.resize(1);
  partition.reader_numbers = {{{}, 0}};
  for (Patch<D>& patch : grid.patches) {
    patch.readers = -1;
    if (partition.leaves(patch)) {
      patch.left_cell = !patch.foreign;
    } else if (patch.foreign) {
      // Its particles come, and get a range of the lists then.
      patch.foreign = false;
      patch.foreign_cells = 0;
      patch.begin = patch.room = 0;
      patch.cell_begin.fill(0);
    }
  }
}

template Owners<2> choose_owners<2>(const TileGrid<2>&, std::span<const Patch<2>>,
                                    const std::vector<Body<2>>&);
template void divide<2>(TileGrid<2>&, std::vector<Body<2>>&, std::vector<ParticlePool<2>>&,
                        Threads&, ListScratch<2>&, std::optional<Owners<2>>);
template Owners<3> choose_owners<3>(const TileGrid<3>&, std::span<const Patch<3>>,
                                    const std::vector<Body<3>>&);
template void divide<3>(TileGrid<3>&, std::vector<Body<3>>&, std::vector<ParticlePool<3>>&,
                        Threads&, ListScratch<3>&, std::optional<Owners<3>>);
template bool share_out_anew<2>(TileGrid<2>&, const std::vector<Body<2>>&,
                                std::span<const TileCost<2>>, double);
template bool share_out_anew<3>(TileGrid<3>&, const std::vector<Body<3>>&,
                                std::span<const TileCost<3>>, double);
template void take_owners<2>(TileGrid<2>&, Owners<2>);
template void take_owners<3>(TileGrid<3>&, Owners<3>);

}  // namespace mpm
