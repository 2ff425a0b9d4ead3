#include "mpm/run/kept_spins.hpp"

#include <array>
#include <map>
#include <span>

#include "mpm/math/eigen.hpp"
#include "mpm/run/gather.hpp"
#include "mpm/run/part_sums.hpp"
#include "mpm/step/node_loops.hpp"
#include "mpm/step/sum_over_bodies.hpp"

namespace mpm {
namespace {

// A body whose particles have less inertia about some axis than this share of D has none that could
// be told from that of its nodes, and one with more than that share needs nothing.
constexpr double least_inertia = 3.0, most_inertia = 200.0;

/// The least principal moment of inertia [kg m^2]; in 2D that about z.
template <int D>
double least_moment(const Matrix3& inertia) {
  if constexpr (D == 2) return inertia[2][2];
  Sym<double, 3> tensor;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) tensor(i, j) = inertia[i][j];
  const Eigen<double, 3> principal = eigen(tensor);
  return std::min({principal.value[0], principal.value[1], principal.value[2]});
}

/// The axes along which walls hold nodes of each body, a bit each. What turns then are mirrored
/// bodies, of which it is a part: such a one keeps the inertia of its nodes, also about the normal
/// of a slip wall.
template <int D>
std::vector<unsigned> held_axes(const Domain<D>& domain) {
  std::vector<std::int64_t> nodes(D * domain.bodies.size());
  for (const Patch<D>& patch : domain.grid.patches)
    for_each_constrained_node(domain.grid, patch, [&](int, unsigned constrained) {
      for (std::size_t a = 0; a < D; ++a)
        nodes[D * static_cast<std::size_t>(patch.body) + a] += constrained >> a & 1u;
    });
  domain.grid.partition.comm->all_sum(nodes);
  std::vector<unsigned> held(domain.bodies.size());
  for (std::size_t k = 0; k < nodes.size(); ++k)
    if (nodes[k] > 0) held[k / D] |= 1u << k % D;
  return held;
}

/// Of a body the first tile that a rank has of it.
template <int D>
struct FirstTile {
  std::int32_t spin = 0, rank = 0;
  Index<D> tile{};
};

}  // namespace

template <int D>
void list_kept_spins(Domain<D>& domain) {
  const std::vector<PartSums> parts = sums_of_bodies(domain, SumsOf::particles);
  const std::vector<unsigned> held = held_axes(domain);
  for (std::size_t b = 0; b < parts.size(); ++b) {
    if (!domain.bodies[b].keeps_nodes()) continue;
    KeptSpin turning;
    turning.held = held[b];
    turning.body = static_cast<int>(b);
    turning.mass = parts[b].mass;
    turning.excess = 0.5 * turning.mass * std::pow(domain.grid.cell_size, 2);
    const double least = least_moment<D>(parts[b].inertia) / turning.excess;
    const bool turns = held[b] == 0 && least >= least_inertia && least <= most_inertia;
    if (!turns) turning.excess = 0.0;
    domain.kept_spins.push_back(turning);
  }
  find_shared_bodies(domain);
}

template <int D>
void find_shared_bodies(Domain<D>& domain) {
  Comm& comm = *domain.grid.partition.comm;
  domain.shared_bodies.clear();
  if (comm.alone()) return;
  std::vector<FirstTile<D>> first;  // here, then of the others
  for (std::size_t k = 0; k < domain.kept_spins.size(); ++k) {
    const auto patches = patches_of<D>(domain.grid.patches, domain.kept_spins[k].body);
    const auto own = std::ranges::find(patches, false, &Patch<D>::foreign);
    if (own != patches.end())
      first.push_back({static_cast<std::int32_t>(k), comm.rank(), own->tile});
  }
  const auto here = static_cast<std::ptrdiff_t>(first.size());
  entries_of_all(comm, first);
  const std::span own(first.begin(), first.begin() + here);
  std::map<std::int32_t, SharedBody> shared;
  for (const FirstTile<D>& other : std::span(first).subspan(own.size())) {
    const auto mine = std::ranges::lower_bound(own, other.spin, {}, &FirstTile<D>::spin);
    if (mine == own.end() || mine->spin != other.spin) continue;
    SharedBody& body =
        shared.try_emplace(other.spin, SharedBody{other.spin, true, {}}).first->second;
    body.first = body.first && tile_less<D>(mine->tile, other.tile);
    body.others.push_back(other.rank);
  }
  for (auto& [k, body] : shared) domain.shared_bodies.push_back(std::move(body));
}

template <int D>
std::vector<KeptSpin> gather_kept_spins(const Domain<D>& domain) {
  std::vector<KeptSpin> all = domain.kept_spins;
  gather(*domain.grid.partition.comm, Slices(all.size()), 1, std::array{0}, std::span(all),
         [&](auto&& f) {
           for (std::size_t k = 0; k < all.size(); ++k)
             if (has_first(domain, k)) f(k, 0, domain.kept_spins[k]);
         });
  return all;
}

template <int D>
void find_kept_spins(Domain<D>& domain) {
  domain.shift = 0.0;  // What it has taken of the angular momentum is not known any more.
  for (KeptSpin& turning : domain.kept_spins) turning.begun = false;
  const std::vector<PartSums> nodes = sums_of_bodies(domain, SumsOf::kept_nodes);
  for (KeptSpin& turning : domain.kept_spins) {
    const PartSums& part = nodes[static_cast<std::size_t>(turning.body)];
    turning.begun = true;
    turning.centre = part.centre;
    turning.velocity = velocity_of(part);
    turning.spin = spin_of(part, D);
    turning.of_nodes = part.angular_momentum;
    turning.momentum = turning.of_nodes - turning.excess * turning.spin;
  }
}

template void list_kept_spins<2>(Domain<2>&);
template void list_kept_spins<3>(Domain<3>&);
template void find_shared_bodies<2>(Domain<2>&);
template void find_shared_bodies<3>(Domain<3>&);
template std::vector<KeptSpin> gather_kept_spins<2>(const Domain<2>&);
template std::vector<KeptSpin> gather_kept_spins<3>(const Domain<3>&);
template void find_kept_spins<2>(Domain<2>&);
template void find_kept_spins<3>(Domain<3>&);

}  // namespace mpm
