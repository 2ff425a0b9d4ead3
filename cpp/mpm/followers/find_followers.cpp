#include "mpm/followers/find_followers.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "mpm/comm/all_sums.hpp"
#include "mpm/followers/who_follows.hpp"
#include "mpm/walls/reactions.hpp"

namespace mpm {
namespace {

/// Those of all ranks in order; what several give is summed, in one order.
template <int D>
void join(Comm& comm, std::vector<OfNode<D>>& all) {
  entries_of_all(comm, all);
  std::ranges::sort(all, [](const OfNode<D>& x, const OfNode<D>& y) {
    return std::tie(x.node, x.value) < std::tie(y.node, y.value);
  });
  std::size_t kept = 0;
  for (const OfNode<D>& one : all) {
    if (kept > 0 && all[kept - 1].node == one.node)
      all[kept - 1].value += one.value;
    else
      all[kept++] = one;
  }
  all.resize(kept);
}

/// How much of the cells around a patch its particles fill, as boxes of their volumes.
template <int D>
void add_filled(const Domain<D>& domain, const Patch<D>& patch, std::vector<OfNode<D>>& all) {
  const TileGrid<D>& grid = domain.grid;
  const ParticlePool<D>& pool = domain.pool_of(patch);
  const double whole = domain.body_of(patch).initial_density * std::pow(grid.cell_size, D);
  Index<D> low = grid.first_cell(patch.tile), high = low;
  for (std::size_t a = 0; a < D; ++a) {
    low[a] -= 1;
    high[a] += Tile<D>::cells;
  }
  const BlockShape<D> box(low, high);
  std::vector<double> filled(static_cast<std::size_t>(box.node_count), 0.0);
  for (const std::uint32_t row : pool.rows(patch)) {
    const double half = 0.5 * std::pow(pool.mass()[row] / whole, 1.0 / D);
    Vec<double, D> x;
    Index<D> first, last;
    for (int a = 0; a < D; ++a) {
      const auto k = static_cast<std::size_t>(a);
      x[a] = grid.in_cells(pool.listed(a)[row], a);  // where it lies in the body
      first[k] = std::max(static_cast<int>(std::floor(x[a] - half)), low[k]);
      last[k] = std::min(static_cast<int>(std::floor(x[a] + half)), high[k]);
    }
    for_each_index<D>(first, last, [&](const Index<D>& cell) {
      double share = 1.0;
      for (int a = 0; a < D; ++a) {
        const double begin = cell[static_cast<std::size_t>(a)];
        share *= std::max(std::min(x[a] + half, begin + 1.0) - std::max(x[a] - half, begin), 0.0);
      }
      filled[static_cast<std::size_t>(box.node(cell))] += share;
    });
  }
  for (int n = 0; n < box.node_count; ++n)
    if (const double share = filled[static_cast<std::size_t>(n)]; share > 0.0)
      all.push_back({{patch.body, box.index(n)}, share});
}

/// Of all bodies of all ranks, by node.
template <int D>
std::vector<Follower<D>> all_followers(Domain<D>& domain, const std::vector<bool>& laid) {
  TileGrid<D>& grid = domain.grid;
  std::vector<OfNode<D>> cells, masses;
  for (const Patch<D>& patch : grid.patches) {
    if (!patch.keeps || patch.foreign) continue;
    add_filled(domain, patch, cells);
    const NodeBlock<D> block = grid.block(patch);
    for (int n = 0; n < block.count; ++n)
      if (patch.counts(n))
        masses.push_back({{patch.body, index_of(grid, patch, n)}, block.records[n][mass_at]});
  }
  Comm& comm = *grid.partition.comm;
  join(comm, cells);
  join(comm, masses);
  std::vector<Follower<D>> all;
  const auto body_of = [](const OfNode<D>& one) { return one.node.body; };
  for (std::size_t begin = 0; begin < masses.size();) {
    const int number = masses[begin].node.body;
    const auto nodes = std::ranges::equal_range(masses, number, {}, body_of);
    const auto filled = std::ranges::equal_range(cells, number, {}, body_of);
    add_followers<D>(grid.walls_of(number), filled, nodes, laid[static_cast<std::size_t>(number)],
                     all);
    begin += nodes.size();
  }
  return all;
}

/// One node's part in the sum for another of its body.
template <int D>
struct Part {
  NodeOfBody<D> of;
  Index<D> from{}, beyond{};
  double share = 0.0;
  unsigned turned = 0;
};
/// In the order of whom they are for: of what is given to those who lead, or taken from them.
template <int D>
std::vector<Part<D>> parts_of(const std::vector<Follower<D>>& all, bool given) {
  std::vector<Part<D>> parts;
  for (const Follower<D>& one : all)
    for (const Leader<D>& leader : one.leaders) {
      const NodeOfBody<D> leading{one.node.body, leader.node};
      parts.push_back({given ? leading : one.node, given ? one.node.node : leader.node,
                       leader.beyond, leader.share, leader.turned});
    }
  std::ranges::sort(parts, [](const Part<D>& x, const Part<D>& y) {
    return std::tie(x.of, x.from, x.beyond) < std::tie(y.of, y.from, y.beyond);
  });
  return parts;
}

/// The parts of one sum, and its number once some patch here has its node.
template <int D>
struct PartsOfSum {
  NodeOfBody<D> of;
  std::span<const Part<D>> parts{};
  std::int32_t number = -1;
};
template <int D>
std::vector<PartsOfSum<D>> by_sum(const std::vector<Part<D>>& parts) {
  std::vector<PartsOfSum<D>> sums;
  for (std::size_t begin = 0, end = 0; begin < parts.size(); begin = end) {
    while (end < parts.size() && parts[end].of == parts[begin].of) ++end;
    sums.push_back({parts[begin].of, std::span(parts).subspan(begin, end - begin)});
  }
  return sums;
}

/// The sums that patches here need, and where forces act in the place of nodes beyond walls.
template <int D>
void make_sums(const TileGrid<D>& grid, const PatchesOfNodes<D>& patches,
               const std::vector<Part<D>>& parts, SumsOfNodes<D>& made,
               Lists<ForceBeyond<D>>* beyond) {
  std::vector<PartsOfSum<D>> sums = by_sum(parts);
  const auto body_of = [](const PartsOfSum<D>& sum) { return sum.of.body; };
  std::vector<const PartsOfSum<D>*> here;
  for (const auto& kept : patches.all) {
    const Patch<D>& patch = grid.patches[kept.patch];
    const auto own = std::ranges::equal_range(sums, patch.body, {}, body_of);
    for (int n = 0; n < patch.shape.node_count; ++n) {
      const NodeOfBody<D> node{patch.body, index_of(grid, patch, n)};
      const auto at = std::ranges::lower_bound(own, node, {}, &PartsOfSum<D>::of);
      if (at == own.end() || at->of != node) continue;
      if (at->number < 0) {
        at->number = static_cast<std::int32_t>(here.size());
        here.push_back(&*at);
      }
      made.nodes.all.push_back({n, static_cast<std::uint32_t>(at->number)});
    }
    made.nodes.end_list();
  }
  std::vector<NodeOfBody<D>>& givers = made.from.nodes;
  for (const PartsOfSum<D>* sum : here)
    for (const Part<D>& part : sum->parts) givers.push_back({part.of.body, part.from});
  std::ranges::sort(givers);
  const auto again = std::ranges::unique(givers);
  givers.erase(again.begin(), again.end());
  givers.shrink_to_fit();
  for (const PartsOfSum<D>* sum : here) {
    for (const Part<D>& part : sum->parts) {
      const NodeOfBody<D> from{part.of.body, part.from};
      const auto at = std::ranges::lower_bound(givers, from) - givers.begin();
      made.shares.all.push_back({part.share, static_cast<std::uint32_t>(at), part.turned});
    }
    made.shares.end_list();
  }
  made.nodes.shrink();
  made.shares.shrink();
  plan(made.from, patches, grid);
  if (beyond == nullptr) return;
  for (std::size_t k = 0; k < patches.all.size(); ++k) {
    for (const SumAtNode& at : made.nodes[k]) {
      if (!grid.patches[patches.all[k].patch].counts(at.node)) continue;
      const std::span<const NodeShare> shares = made.shares[at.sum];
      for (std::size_t j = 0; j < shares.size(); ++j)
        if (shares[j].turned != 0)
          beyond->all.push_back({at.node, shares[j], here[at.sum]->parts[j].beyond});
    }
    beyond->end_list();
  }
}

/// Masses of those who follow go to those who lead, (E2).
template <int D>
void give_masses(TileGrid<D>& grid, const std::vector<Follower<D>>& all,
                 const std::vector<bool>& laid) {
  std::vector<OfNode<D>> given;
  for (const Follower<D>& one : all) {
    if (!laid[static_cast<std::size_t>(one.node.body)]) continue;
    given.push_back({one.node, -one.mass});
    for (const Leader<D>& leader : one.leaders)
      given.push_back({{one.node.body, leader.node}, leader.share * one.mass});
  }
  const auto node_of = [](const OfNode<D>& one) { return one.node; };
  std::ranges::stable_sort(given, {}, node_of);
  for (const Patch<D>& patch : grid.patches) {
    if (!patch.keeps) continue;
    const NodeBlock<D> block = grid.block(patch);
    for (int n = 0; n < block.count; ++n) {
      const NodeOfBody<D> node{patch.body, index_of(grid, patch, n)};
      for (const OfNode<D>& one : std::ranges::equal_range(given, node, {}, node_of))
        block.records[n][mass_at] += one.value;
    }
  }
}

}  // namespace

template <int D>
void find_followers(Domain<D>& domain, const std::vector<bool>& laid) {
  domain.followers = {};
  const std::vector<Follower<D>> all = all_followers(domain, laid);
  if (all.empty()) return;  // alike on all ranks
  domain.followers.exist = true;
  Followers<D>& made = domain.followers;
  for (std::uint32_t p = 0; p < domain.grid.patches.size(); ++p)
    if (const Patch<D>& patch = domain.grid.patches[p]; patch.keeps)
      made.patches.all.push_back({patch.body, patch.tile, p});
  make_sums(domain.grid, made.patches, parts_of(all, true), made.given, &made.beyond);
  make_sums<D>(domain.grid, made.patches, parts_of(all, false), made.taken, nullptr);
  give_masses(domain.grid, all, laid);
}

template void find_followers<2>(Domain<2>&, const std::vector<bool>&);
template void find_followers<3>(Domain<3>&, const std::vector<bool>&);

}  // namespace mpm
