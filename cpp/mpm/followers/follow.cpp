#include "mpm/followers/follow.hpp"

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

/// f(place in Followers::patches, patch, its block) for the patches that have any.
template <int D, class F>
void for_each_linked_patch(Domain<D>& domain, F&& f) {
  const Followers<D>& followers = domain.followers;
  domain.threads.for_each(followers.patches.all.size(), [&](std::size_t k) {
    const std::size_t p = followers.patches.all[k].patch;
    f(k, p, domain.grid.block(p));
  });
}

/// What walls give where a follower's force acts in the place of a node beyond them, as in
/// add_folding() of walls/reactions.hpp.
template <int D>
void add_reaction(Domain<D>& domain, std::size_t p, int node, const NodeLink<D>& link,
                  const Vec<double, D>& force) {
  const TileGrid<D>& grid = domain.grid;
  const Patch<D>& patch = grid.patches[p];
  const Reaction<D> to = reaction_of(domain, p, &AngularImpulses::walls);
  const Vec<double, D> s = (time_of_forces(domain, patch) * link.share) * force;
  Vec<double, D> before;
  for (int a = 0; a < D; ++a) before[a] = link.turned >> a & 1u ? -s[a] : s[a];
  to.moment += cross(place_of(grid, patch, node), in_space<D>(before)) -
               cross(in_space<D>(grid.position_of(link.beyond)), in_space<D>(s));
  for (int a = 0; a < D; ++a)
    if (before[a] != s[a])
      to.faces.add(grid.walls.faces_turning(link.beyond, a), a, before[a] - s[a]);
}

template <int D, class Of>
void give(Domain<D>& domain, const Of& of, bool reactions) {
  Followers<D>& followers = domain.followers;
  if (!followers.exist) return;
  constexpr int width = Of::template width<D>;
  find_again(followers.patches, domain.grid);
  gather<width>(followers.following, followers.patches, domain.grid, domain.threads, of);
  for_each_linked_patch(domain, [&](std::size_t k, std::size_t p, const NodeBlock<D>& block) {
    for (const NodeLinks& node : followers.leads[k]) {
      double* const to = of(block, node.node);
      for (std::uint32_t j = node.first; j < node.first + node.count; ++j) {
        const NodeLink<D>& link = followers.to_leading[k][j];
        const Vec<double, D>& given = followers.following.values[link.from];
        for (int a = 0; a < width; ++a) to[a] += link.share * of.turned(given[a], link.turned, a);
        if (reactions && link.turned != 0 && domain.grid.patches[p].counts(node.node))
          add_reaction(domain, p, node.node, link, given);
      }
    }
    for (const NodeLinks& node : followers.follows[k])
      std::fill_n(of(block, node.node), width, 0.0);
  });
}

template <int D, class Of, class Reflect>
void take(Domain<D>& domain, const Of& of, Reflect&& reflect) {
  Followers<D>& followers = domain.followers;
  if (!followers.exist) return;
  constexpr int width = Of::template width<D>;
  find_again(followers.patches, domain.grid);
  gather<width>(followers.leading, followers.patches, domain.grid, domain.threads, of);
  for_each_linked_patch(domain, [&](std::size_t k, std::size_t p, const NodeBlock<D>& block) {
    for (const NodeLinks& node : followers.follows[k]) {
      double* const to = of(block, node.node);
      std::fill_n(to, width, 0.0);
      for (std::uint32_t j = node.first; j < node.first + node.count; ++j) {
        const NodeLink<D>& link = followers.to_following[k][j];
        const Vec<double, D>& taken = followers.leading.values[link.from];
        for (int a = 0; a < width; ++a) to[a] += link.share * of.turned(taken[a], link.turned, a);
      }
    }
    reflect(domain.grid.patches[p], block);
  });
}

}  // namespace

template <int D>
void give_forces_to_leading(Domain<D>& domain) {
  give(domain, VectorAt{force_at}, true);
}
template <int D>
void give_to_leading(Domain<D>& domain, int at) {
  give(domain, VectorAt{at}, false);
}
template <int D>
void take_from_leading(Domain<D>& domain, int at) {
  take(domain, VectorAt{at}, [&](const Patch<D>& patch, const NodeBlock<D>& block) {
    reflect_at_walls(domain.grid, patch, block, at);
  });
}

template <int D>
std::vector<std::uint8_t> patches_that_follow(Domain<D>& domain) {
  Followers<D>& followers = domain.followers;
  std::vector<std::uint8_t> follow(domain.grid.patches.size(), 0);
  find_again(followers.patches, domain.grid);
  for (std::size_t k = 0; k < followers.patches.all.size(); ++k)
    follow[followers.patches.all[k].patch] = followers.follows[k].empty() ? 0 : 1;
  return follow;
}

template <int D>
void give_number_to_leading(Domain<D>& domain, int at) {
  give(domain, NumberAt{at}, false);
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
template std::vector<std::uint8_t> patches_that_follow<2>(Domain<2>&);
template std::vector<std::uint8_t> patches_that_follow<3>(Domain<3>&);
template void give_number_to_leading<2>(Domain<2>&, int);
template void give_number_to_leading<3>(Domain<3>&, int);
template void take_number_from_leading<2>(Domain<2>&, int);
template void take_number_from_leading<3>(Domain<3>&, int);

}  // namespace mpm
