#include "mpm/followers/follow.hpp"

#include <algorithm>

#include "mpm/step/kept_nodes.hpp"

namespace mpm {
namespace {

/// The vectors at a number of the records.
struct VectorAt {
  int at;
  template <int D>
  static constexpr int width = D;
  template <int D>
  double* operator()(const NodeBlock<D>& block, int node) const {
    return block.records[node] + at;
  }
  double turned(double x, unsigned axes, int axis) const { return axes >> axis & 1u ? -x : x; }
};
/// A number beside the displacements.
struct NumberAt {
  int at;
  template <int D>
  static constexpr int width = 1;
  template <int D>
  double* operator()(const NodeBlock<D>& block, int node) const {
    return block.displacements[node] + at;
  }
  double turned(double x, unsigned, int) const { return x; }
};

/// f(place in Followers::patches, patch, its block).
template <int D, class F>
void for_each_kept_patch(Domain<D>& domain, F&& f) {
  const Followers<D>& followers = domain.followers;
  domain.threads.for_each(followers.patches.all.size(), [&](std::size_t k) {
    const std::size_t p = followers.patches.all[k].patch;
    f(k, p, domain.grid.block(p));
  });
}

/// The sums of what nodes give now. All ranks together.
template <int D, class Of>
void sum_up(Domain<D>& domain, SumsOfNodes<D>& of, const Of& numbers) {
  constexpr std::size_t at_once = 256;
  constexpr int width = Of::template width<D>;
  find_again(domain.followers.patches, domain.grid);
  gather<width>(of.from, domain.followers.patches, domain.grid, domain.threads, numbers);
  const std::size_t count = of.shares.size();
  of.sums.resize(count);
  domain.threads.for_each((count + at_once - 1) / at_once, [&](std::size_t part) {
    for (std::size_t k = part * at_once; k < std::min(count, (part + 1) * at_once); ++k) {
      Vec<double, D> sum = Vec<double, D>::zero();
      for (const NodeShare& one : of.shares[k])
        for (int a = 0; a < width; ++a)
          sum[a] += one.share * numbers.turned(of.from.values[one.from][a], one.turned, a);
      of.sums[k] = sum;
    }
  });
}

template <int D, class Of>
void give(Domain<D>& domain, const Of& of) {
  Followers<D>& followers = domain.followers;
  if (!followers.exist) return;
  constexpr int width = Of::template width<D>;
  sum_up(domain, followers.given, of);
  for_each_kept_patch(domain, [&](std::size_t k, std::size_t, const NodeBlock<D>& block) {
    for (const SumAtNode& leading : followers.given.nodes[k]) {
      double* const to = of(block, leading.node);
      for (int a = 0; a < width; ++a) to[a] += followers.given.sums[leading.sum][a];
    }
    for (const SumAtNode& following : followers.taken.nodes[k])
      std::fill_n(of(block, following.node), width, 0.0);
  });
}

template <int D, class Of, class Reflect>
void take(Domain<D>& domain, const Of& of, Reflect&& reflect) {
  Followers<D>& followers = domain.followers;
  if (!followers.exist) return;
  sum_up(domain, followers.taken, of);
  for_each_kept_patch(domain, [&](std::size_t k, std::size_t p, const NodeBlock<D>& block) {
    if (followers.taken.nodes[k].empty()) return;
    for (const SumAtNode& following : followers.taken.nodes[k])
      std::copy_n(&followers.taken.sums[following.sum][0], Of::template width<D>,
                  of(block, following.node));
    reflect(domain.grid.patches[p], block);
  });
}

/// What walls give where a follower's force acts in the place of a node beyond them, as in
/// add_folding() of walls/reactions.hpp.
template <int D>
void add_reaction(Domain<D>& domain, std::size_t p, const ForceBeyond<D>& one) {
  const TileGrid<D>& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  const Reaction<D> to = reaction_of(domain, p, &AngularImpulses::walls);
  const Vec<double, D> s = (time_of_forces(domain, patch) * one.of.share) *
                           domain.followers.given.from.values[one.of.from];
  Vec<double, D> before;
  for (int a = 0; a < D; ++a) before[a] = one.of.turned >> a & 1u ? -s[a] : s[a];
  to.moment += cross(place_of(grid, patch, one.node), in_space<D>(before)) -
               cross(in_space<D>(grid.position_of(one.beyond)), in_space<D>(s));
  for (int a = 0; a < D; ++a)
    if (before[a] != s[a])
      to.faces.add(grid.walls_of(patch.body).faces_turning(one.beyond, a), a, before[a] - s[a]);
}

}  // namespace

template <int D>
void give_forces_to_leading(Domain<D>& domain) {
  give(domain, VectorAt{force_at});
  for_each_kept_patch(domain, [&](std::size_t k, std::size_t p, const NodeBlock<D>&) {
    for (const ForceBeyond<D>& one : domain.followers.beyond[k]) add_reaction(domain, p, one);
  });
}
template <int D>
void give_to_leading(Domain<D>& domain, int at) {
  give(domain, VectorAt{at});
}
template <int D>
void take_from_leading(Domain<D>& domain, int at) {
  take(domain, VectorAt{at}, [&](const Patch<D>& patch, const NodeBlock<D>& block) {
    reflect_at_walls(domain.grid, patch, block, at);
  });
}

template <int D>
const std::vector<std::uint8_t>& patches_that_follow(Domain<D>& domain) {
  Followers<D>& followers = domain.followers;
  std::vector<std::uint8_t>& follow = followers.follow;
  follow.assign(domain.grid.patches.size(), 0);
  find_again(followers.patches, domain.grid);
  for (std::size_t k = 0; k < followers.patches.all.size(); ++k)
    follow[followers.patches.all[k].patch] = followers.taken.nodes[k].empty() ? 0 : 1;
  return follow;
}

template <int D>
void give_number_to_leading(Domain<D>& domain, int at) {
  give(domain, NumberAt{at});
}
template <int D>
void take_number_from_leading(Domain<D>& domain, int at) {
  take(domain, NumberAt{at}, [](const Patch<D>&, const NodeBlock<D>&) {});
}

template void give_forces_to_leading<2>(Domain<2>&);
template void give_forces_to_leading<3>(Domain<3>&);
template void give_to_leading<2>(Domain<2>&, int);
template void give_to_leading<3>(Domain<3>&, int);
template void take_from_leading<2>(Domain<2>&, int);
template void take_from_leading<3>(Domain<3>&, int);
template const std::vector<std::uint8_t>& patches_that_follow<2>(Domain<2>&);
template const std::vector<std::uint8_t>& patches_that_follow<3>(Domain<3>&);
template void give_number_to_leading<2>(Domain<2>&, int);
template void give_number_to_leading<3>(Domain<3>&, int);
template void take_number_from_leading<2>(Domain<2>&, int);
template void take_number_from_leading<3>(Domain<3>&, int);

}  // namespace mpm
