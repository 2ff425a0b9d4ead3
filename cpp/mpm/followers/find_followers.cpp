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
std::vector<Follower<D>> all_followers(Domain<D>& domain, bool at_start) {
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
    add_followers<D>(grid.walls, filled, nodes, at_start, all);
    begin += nodes.size();
  }
  return all;
}

/// The pairs of who leads and who follows, in the order of either.
template <int D>
struct Lists {
  struct Of {
    NodeOfBody<D> node, other;
    Led<D> led;
  };
  std::vector<Of> by_leading, by_following;  // by `node`, then by the other

  explicit Lists(const std::vector<Follower<D>>& all) {
    for (const Follower<D>& one : all)
      for (const Led<D>& led : one.led) {
        const NodeOfBody<D> leading{one.node.body, led.by};
        by_leading.push_back({leading, one.node, led});
        by_following.push_back({one.node, leading, led});
      }
    for (std::vector<Of>* list : {&by_leading, &by_following})
      std::ranges::sort(*list, [](const Of& x, const Of& y) {
        return std::tie(x.node, x.other, x.led.beyond) < std::tie(y.node, y.other, y.led.beyond);
      });
  }
};

template <class T>
void keep_once(std::vector<T>& all) {
  std::ranges::sort(all);
  const auto again = std::ranges::unique(all);
  all.erase(again.begin(), again.end());
}

/// The links of the nodes of a patch, by who gives in a table.
template <int D>
void add_links(const TileGrid<D>& grid, const Patch<D>& patch,
               const std::vector<typename Lists<D>::Of>& list,
               const std::vector<NodeOfBody<D>>& givers, std::vector<NodeLinks>& nodes,
               std::vector<NodeLink<D>>& links) {
  for (int n = 0; n < patch.shape.node_count; ++n) {
    const auto of = std::ranges::equal_range(
        list, NodeOfBody<D>{patch.body, index_of(grid, patch, n)}, {}, &Lists<D>::Of::node);
    if (of.empty()) continue;
    nodes.push_back(
        {n, static_cast<std::uint32_t>(links.size()), static_cast<std::uint32_t>(of.size())});
    for (const auto& one : of) {
      const auto at = std::ranges::lower_bound(givers, one.other) - givers.begin();
      links.push_back({static_cast<std::uint32_t>(at), one.led.share,
                       static_cast<std::uint8_t>(one.led.turned), one.led.beyond});
    }
  }
}

/// The nodes of own and foreign patches that a list is of, and who gives to them.
template <int D>
void add_nodes_here(const TileGrid<D>& grid, const std::vector<typename Lists<D>::Of>& list,
                    std::vector<NodeOfBody<D>>& here, std::vector<NodeOfBody<D>>& givers) {
  for (const Patch<D>& patch : grid.patches) {
    if (!patch.keeps) continue;
    for (int n = 0; n < patch.shape.node_count; ++n) {
      const NodeOfBody<D> node{patch.body, index_of(grid, patch, n)};
      const auto of = std::ranges::equal_range(list, node, {}, &Lists<D>::Of::node);
      if (!of.empty()) here.push_back(node);
      for (const auto& one : of) givers.push_back(one.other);
    }
  }
}

template <int D>
void make_lists(const TileGrid<D>& grid, const Lists<D>& lists, Followers<D>& made) {
  std::vector<NodeOfBody<D>>&following = made.following.nodes, &leading = made.leading.nodes;
  add_nodes_here(grid, lists.by_leading, leading, following);
  add_nodes_here(grid, lists.by_following, following, leading);
  keep_once(following);
  keep_once(leading);
  for (std::uint32_t p = 0; p < grid.patches.size(); ++p) {
    const Patch<D>& patch = grid.patches[p];
    if (!patch.keeps) continue;
    std::vector<NodeLinks> leads, follows;
    std::vector<NodeLink<D>> to_leading, to_following;
    add_links(grid, patch, lists.by_leading, following, leads, to_leading);
    add_links(grid, patch, lists.by_following, leading, follows, to_following);
    if (leads.empty() && follows.empty()) continue;
    made.patches.all.push_back({patch.body, patch.tile, p});
    made.leads.push_back(std::move(leads));
    made.follows.push_back(std::move(follows));
    made.to_leading.push_back(std::move(to_leading));
    made.to_following.push_back(std::move(to_following));
  }
  plan(made.following, made.patches, grid);
  plan(made.leading, made.patches, grid);
}

/// Masses of those who follow go to those who lead, (E2).
template <int D>
void give_masses(TileGrid<D>& grid, const std::vector<Follower<D>>& all) {
  std::vector<OfNode<D>> given;
  for (const Follower<D>& one : all) {
    given.push_back({one.node, -one.mass});
    for (const Led<D>& led : one.led)
      given.push_back({{one.node.body, led.by}, led.share * one.mass});
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
void find_followers(Domain<D>& domain, bool at_start) {
  domain.followers = {};
  const std::vector<Follower<D>> all = all_followers(domain, at_start);
  if (all.empty()) return;  // alike on all ranks
  domain.followers.exist = true;
  make_lists(domain.grid, Lists<D>(all), domain.followers);
  if (at_start) give_masses(domain.grid, all);
}

template void find_followers<2>(Domain<2>&, bool);
template void find_followers<3>(Domain<3>&, bool);

}  // namespace mpm
