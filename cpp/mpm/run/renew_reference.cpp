#include "mpm/run/renew_reference.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>
#include <utility>

#include "mpm/comm/all_sums.hpp"
#include "mpm/contact/candidates.hpp"
#include "mpm/followers/find_followers.hpp"
#include "mpm/followers/follow.hpp"
#include "mpm/grid/blocks.hpp"
#include "mpm/math/inverse.hpp"
#include "mpm/run/kept_spins.hpp"
#include "mpm/run/part_sums.hpp"
#include "mpm/run/particles_that_flow.hpp"
#include "mpm/run/start_in_body.hpp"
#include "mpm/run/watch_contact.hpp"
#include "mpm/step/kept_nodes.hpp"
#include "mpm/surfaces/renew_points.hpp"

namespace mpm {
namespace {

// Particles farther apart, in cells, hardly hold together by new nodes, and contact points between
// them let others through; no more than a few may be.
constexpr double most_cells_apart = 1.5;
// By how much, over 1, cells are narrower where that counts.
constexpr double least_squeezed = 1.3;
// Few bodies are seen to in this many steps only: all lists are made anew.
constexpr std::int64_t few_every = 100;
constexpr std::size_t few = 20;  // one in so many, or less

template <int D>
Mat<double, D> deformation_of_row(const ParticlePool<D>& pool, std::uint32_t row) {
  Mat<double, D> F;
  for (int k = 0; k < D * D; ++k) F[k / D][k % D] = pool.deformation_part(k)[row];
  return F;
}

/// By how much cells are narrower about a particle, at most.
template <int D>
double narrowed(const ParticlePool<D>& pool, std::uint32_t row) {
  return std::sqrt(largest_stretch_squared(inverse_of(deformation_of_row(pool, row))));
}

/// By how much a particle and its neighbours are farther apart than they were at the start, at
/// most.
template <int D>
double stretched(const ParticlePool<D>& pool, std::uint32_t row) {
  return pool.columns.component(pool.stretched_before)[row] *
         std::sqrt(largest_stretch_squared(deformation_of_row(pool, row)));
}

/// How many particles of each body would be too far apart for new nodes; of all ranks.
template <int D>
std::vector<std::int64_t> count_parted(const Domain<D>& domain) {
  std::vector<std::int64_t> counts;
  const double most = most_cells_apart * domain.grid.cell_size;
  const auto is_far = [&](const Body<D>& body, const ParticlePool<D>& pool, std::uint32_t row) {
    const double edge = std::pow(pool.mass()[row] / body.initial_density, 1.0 / D);
    return edge * stretched(pool, row) > most;
  };
  count_that_flow(domain, counts, is_far);
  return counts;
}

/// The numbers of nodes, by body and tile.
template <int D>
using NumbersOfNodes = std::map<std::pair<int, Index<D>>, std::vector<double>>;

/// Of the bodies that are not meant.
template <int D>
NumbersOfNodes<D> numbers_of_others(const Domain<D>& domain, const std::vector<bool>& renewed) {
  NumbersOfNodes<D> numbers;
  for (const Patch<D>& patch : domain.grid.patches) {
    if (!patch.keeps || renewed[static_cast<std::size_t>(patch.body)]) continue;
    const double* const first = domain.grid.kept.numbers.data() + patch.memory;
    numbers[{patch.body, patch.tile}] = {first,
                                         first + domain.grid.numbers_kept(patch.shape.node_count)};
  }
  return numbers;
}
template <int D>
void restore_numbers(Domain<D>& domain, const std::type_identity_t<NumbersOfNodes<D>>& numbers) {
  for (const Patch<D>& patch : domain.grid.patches)
    if (const auto at = numbers.find({patch.body, patch.tile}); at != numbers.end())
      std::ranges::copy(at->second, domain.grid.kept.numbers.data() + patch.memory);
}

/// f(p, block) for the patches of these bodies.
template <int D, class F>
void for_each_block(Domain<D>& domain, const std::vector<bool>& bodies, F&& f) {
  for (std::size_t p = 0; p < domain.grid.patches.size(); ++p) {
    const Patch<D>& patch = domain.grid.patches[p];
    if (patch.keeps && bodies[static_cast<std::size_t>(patch.body)]) f(patch, domain.grid.block(p));
  }
}

/// Places in the body are those in space, where nothing is deformed.
template <int D>
void count_from_now(Domain<D>& domain, const std::vector<bool>& renewed) {
  for (const Patch<D>& patch : domain.grid.patches) {
    if (!patch.keeps || patch.foreign || !renewed[static_cast<std::size_t>(patch.body)]) continue;
    ParticlePool<D>& pool = domain.pool_of(patch);
    for (const std::uint32_t row : pool.rows(patch)) {
      pool.columns.component(pool.stretched_before)[row] = stretched(pool, row);
      const Mat<double, D> F = deformation_of_row(pool, row);
      for (int k = 0; k < D * D; ++k) pool.deformation_part(k)[row] = k / D == k % D ? 1.0 : 0.0;
      for_each_piece_of(pool, row, [&](SurfacePiece<D>& piece) { piece.deform(F); });
      for (int a = 0; a < D; ++a) pool.columns.component(pool.reference + a)[row] = pool.x(a)[row];
      pool.columns.component(pool.flowed_before)[row] = pool.columns.component(pool.flowed)[row];
    }
  }
}

/// As the nodes move, whatever the inertia that is told of their bodies.
template <int D>
std::vector<PartSums> sums_of_nodes(Domain<D>& domain) {
  std::vector<KeptSpin> spins = std::exchange(domain.kept_spins, {});
  std::vector<PartSums> sums = sums_of_bodies(domain, SumsOf::kept_nodes);
  domain.kept_spins = std::move(spins);
  return sums;
}

/// The axes about which a body turns freely that walls may hold, a bit each.
template <int D>
unsigned free_axes(const Walls<D>& walls) {
  unsigned axes = D == 2 ? 4u : 7u;
  for (int a = 0; walls.exist && a < D; ++a)
    for (const Wall wall : walls.face[a])
      if (Walls<D>::holds(wall)) axes &= wall == Wall::slip ? 1u << a : 0u;
  return axes;
}

/// A rotation for what passes between particles and nodes has taken of the angular momentum.
template <int D>
void keep_angular_momentum(Domain<D>& domain, const std::vector<bool>& renewed,
                           const std::vector<PartSums>& before) {
  const std::vector<PartSums> after = sums_of_nodes(domain);
  for_each_block(domain, renewed, [&](const Patch<D>& patch, const NodeBlock<D>& block) {
    const auto body = static_cast<std::size_t>(patch.body);
    const Vector3 lacks = before[body].angular_momentum - after[body].angular_momentum;
    const Vector3 spin =
        spin_of(after[body].inertia, lacks, free_axes(domain.grid.walls_of(patch.body)));
    for (int n = 0; n < block.count; ++n) {
      if (!(block.records[n][mass_at] > 0.0)) continue;
      const Vector3 arm = place_of_kept(domain.grid, patch, block, n) - after[body].centre;
      const Vector3 v = cross(spin, arm);
      for (int a = 0; a < D; ++a) block.records[n][velocity_at + a] += v[a];
    }
  });
  take_from_leading(domain, velocity_at);
}

/// Lists, patches and blocks anew, by where particles are in their bodies.
template <int D>
void make_lists(Domain<D>& domain) {
  TileGrid<D>& grid = domain.grid;
  std::optional<Owners<D>> owners = grid.partition.owners;
  release_nodes(grid);
  build_cell_lists(grid, domain.bodies, domain.pools, domain.threads, domain.list_scratch,
                   std::move(owners));
  for (Patch<D>& patch : grid.patches) patch.left_cell = !patch.foreign && !patch.keeps;
  domain.sums.assign(grid.patches.size(), {});
  if (grid.walls.exist) domain.face_parts.assign(grid.patches.size(), {});
  // Of those whose nodes lie in space.
  if (domain.has_contact())
    connect_tiles(domain.contact, grid, domain.bodies, domain.contact_settings.response);
}

/// Bodies turn as they did, whatever of it their nodes have by now; what those have not of the
/// kinetic energy is lost.
template <int D>
void count_renewal(Domain<D>& domain, const std::vector<bool>& renewed,
                   const std::vector<PartSums>& before, std::vector<KeptSpin> spins) {
  const std::vector<PartSums> after = sums_of_nodes(domain);
  domain.kept_spins = std::move(spins);
  for (KeptSpin& turning : domain.kept_spins)
    if (const auto b = static_cast<std::size_t>(turning.body); renewed[b])
      turning.of_nodes = after[b].angular_momentum;
  find_shared_bodies(domain);
  for (std::size_t b = 0; b < renewed.size(); ++b) {
    if (!renewed[b]) continue;
    const double change = after[b].kinetic - before[b].kinetic;
    domain.ledger.kinetic += change;
    domain.ledger.transferred -= change;
    ++domain.bodies[b].renewals;
    ++domain.renewals;
  }
}

/// All that is known of points and nodes comes first: it goes with the lists.
template <int D>
void renew(Domain<D>& domain, const std::vector<bool>& renewed) {
  const std::vector<PartSums> before = sums_of_nodes(domain);
  std::vector<KeptSpin> spins = gather_kept_spins(domain);
  // Nodes have velocities of the middle of the last step, and so shall the new ones.
  for_each_block(domain, renewed, [&](const Patch<D>&, const NodeBlock<D>& block) {
    for (int n = 0; n < block.count; ++n)
      std::fill_n(block.records[n] + half_record, half_record, 0.0);
  });
  give_kept_velocities(domain);
  const NumbersOfNodes<D> others = numbers_of_others(domain, renewed);
  RenewedPoints<D> points(domain, renewed);
  count_from_now(domain, renewed);
  make_lists(domain);
  lay_nodes(domain, renewed);
  restore_numbers(domain, others);
  find_followers(domain, renewed);
  find_kept_velocities(domain, renewed);
  keep_angular_momentum(domain, renewed, before);
  count_renewal(domain, renewed, before, std::move(spins));
  start_average_in_body(domain);
  points.lay(domain);
}

}  // namespace

template <int D>
void renew_references(Simulation<D>& simulation) {
  Domain<D>& domain = simulation.domain;
  const double strain = simulation.settings.run.renewal_strain;
  if (domain.step % renewal_every != 0 || !(strain > 0.0) ||
      std::ranges::none_of(domain.pools,
                           [](const ParticlePool<D>& pool) { return pool.flowed_before >= 0; }))
    return;
  // What has flowed to and fro is as it was.
  const auto has_flowed = [&](const Body<D>&, const ParticlePool<D>& pool, std::uint32_t row) {
    return flowed_since(pool, row) >= strain && narrowed(pool, row) >= least_squeezed;
  };
  std::vector<std::int64_t>& flowed = simulation.flowed;
  count_that_flow(domain, flowed, has_flowed);
  const auto is_due = [&](std::size_t b) {
    const Body<D>& body = domain.bodies[b];
    return !body.nodes_are_final && are_many(body, flowed[b]);
  };
  std::size_t due = 0;
  for (std::size_t b = 0; b < flowed.size(); ++b) due += is_due(b);
  if (due == 0 || (few * due < flowed.size() && domain.step % few_every != 0)) return;
  std::vector<bool> renewed(flowed.size());
  for (std::size_t b = 0; b < renewed.size(); ++b) renewed[b] = is_due(b);
  const std::vector<bool> folded = near_themselves(domain, renewed);
  const std::vector<std::int64_t> parted = count_parted(domain);
  for (std::size_t b = 0; b < renewed.size(); ++b) {
    if (!renewed[b]) continue;
    Body<D>& body = domain.bodies[b];
    const double share = static_cast<double>(parted[b]) / static_cast<double>(body.count);
    const auto why = body.failed > 0             ? WhyNodesStay::failed
                     : are_many(body, parted[b]) ? WhyNodesStay::parted
                     : folded[b]                 ? WhyNodesStay::folded
                                                 : WhyNodesStay::no;
    if (why == WhyNodesStay::no) continue;
    renewed[b] = false;
    body.nodes_are_final = true;
    note(simulation, {.kind = NoteKind::nodes_kept,
                      .body = static_cast<int>(b),
                      .value = static_cast<double>(why),
                      .share = share});
  }
  if (std::ranges::find(renewed, true) != renewed.end()) renew(domain, renewed);
}

template void renew_references<2>(Simulation<2>&);
template void renew_references<3>(Simulation<3>&);

}  // namespace mpm
