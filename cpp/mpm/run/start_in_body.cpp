#include "mpm/run/start_in_body.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mpm/followers/find_followers.hpp"
#include "mpm/followers/follow.hpp"
#include "mpm/grid/halo.hpp"
#include "mpm/run/kept_spins.hpp"
#include "mpm/run/part_sums.hpp"
#include "mpm/schedule/choose.hpp"
#include "mpm/schedule/scatter.hpp"
#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/transfer/flip.hpp"
#include "mpm/step/transfer/mapping.hpp"
#include "mpm/surfaces/restitution.hpp"

namespace mpm {
namespace {

// What is left of the particles' velocities after a pass is given to the nodes in the next. Within
// a body the first pass is as good as the last; at its surface, where nodes have particles on one
// side only, each takes away a part of the error: of a shear less than .2 % of the largest velocity
// are left at a corner. Passes end at this change, over the largest of a pass.
constexpr int passes = 50;
constexpr double least_change = 1e-6;
constexpr int lanes_of_start = 4;

// What particles give to nodes stands in the second halves of their records until it is taken.
constexpr int given_mass = half_record + mass_at, given_velocity = half_record + velocity_at;

/// f(p) for the patches of bodies on nodes of their own that are meant.
template <int D, class F>
void for_each_meant(Domain<D>& domain, const std::vector<bool>& bodies, F&& f) {
  for_each_patch(domain, in_body, [&](std::size_t p) {
    const auto body = static_cast<std::size_t>(domain.grid.patches[p].body);
    if (bodies.empty() || bodies[body]) f(p);
  });
}

/// f(rows, sum N_ip of the vectors at a number of the records) for the particles of a patch.
template <int at, int D, class F>
void for_each_velocity(Domain<D>& domain, const Patch<D>& patch, F&& f) {
  const ParticlePool<D>& pool = domain.pool_of(patch);
  const NodeRecords records = domain.grid.block(patch).records;
  const NodeStrides<D> stride(patch.shape);
  const LocalPosition<D> local_position(domain.grid, pool);
  with_basis(domain.grid, domain.body_of(patch), [&]<BasisModel B>(const B& basis) {
    for_each_cell(domain.grid, pool, patch, [&](const CellRange<D>& cell) {
      const auto nodes = field_of<B>(records.from(cell.first_node), stride);
      for_each_group<lanes_of_start>(cell, [&](const auto& rows) {
        f(rows, nodes.template vector<at>(weights_at(basis, local_position(cell, rows))));
      });
    });
  });
}

/// Take from the particles' velocities what the nodes give them by those at a number of the
/// records.
template <int at, int D>
void take_from_particles(Domain<D>& domain, const std::vector<bool>& bodies) {
  for_each_meant(domain, bodies, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    ParticlePool<D>& pool = domain.pool_of(patch);
    for_each_velocity<at>(domain, patch, [&](const auto& rows, const auto& v) {
      for (int a = 0; a < D; ++a) store(pool.v(a), rows, load(pool.v(a), rows) - v[a]);
    });
  });
}

/// A block with the second halves of its records in the place of the first.
template <int D>
NodeBlock<D> second_halves(NodeBlock<D> block) {
  block.records.data += half_record;
  return block;
}

/// The mass that particles give to nodes, and the mean of their velocities there, m_i v_i = sum m_p
/// v_p N_ip.
template <int D>
void give_to_nodes(Domain<D>& domain, const std::vector<bool>& bodies) {
  for_each_meant(domain, bodies, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    const NodeBlock<D> block = domain.grid.block(p);
    for (int n = 0; n < block.count; ++n)
      std::fill_n(block.records[n] + half_record, half_record, 0.0);
    scatter<Mapping<Flip>, gives_mass | gives_momentum>(
        domain.grid, domain.body_of(patch), domain.pool_of(patch), patch,
        NodeRecords{block.records.data + half_record});
    fold_at_walls(domain.grid, patch, second_halves(block), momentum_at);
  });
  exchange_and_sum(domain.grid, domain.threads, half_record, record);
  give_to_leading(domain, given_velocity);
  for_each_meant(domain, bodies, [&](std::size_t p) {
    const NodeBlock<D> given = second_halves(domain.grid.block(p));
    if (domain.followers.exist)
      for (int n = 0; n < given.count; ++n)
        given.records[n][mass_at] = domain.grid.block(p).records[n][mass_at];
    momentum_to_velocity(domain.grid, domain.grid.patches[p], given, velocity_at);
    reflect_at_walls(domain.grid, domain.grid.patches[p], given, velocity_at);
  });
  take_from_leading(domain, given_velocity);
}

/// Let the nodes have those velocities as well; returns the largest of them.
template <int D>
double add_given(Domain<D>& domain, const std::vector<bool>& bodies) {
  std::vector<double> largest(domain.grid.patches.size(), 0.0);
  for_each_meant(domain, bodies, [&](std::size_t p) {
    const NodeBlock<D> block = domain.grid.block(p);
    for (int n = 0; n < block.count; ++n)
      for (int a = 0; a < D; ++a) {
        const double v = block.records[n][given_velocity + a];
        block.records[n][velocity_at + a] += v;
        // Of those of other ranks not all that gives to the nodes is known.
        if (!domain.grid.patches[p].foreign) largest[p] = std::max(largest[p], std::abs(v));
      }
  });
  const double here = largest.empty() ? 0.0 : *std::ranges::max_element(largest);
  return all_max(*domain.grid.partition.comm, here);
}

/// The part of the last increments by which velocities go on from the middle of a step to its end,
/// as they have from the one before.
template <int D>
double to_end_of_step(const Domain<D>& domain, const Patch<D>& patch) {
  const double acts = time_of_forces(domain, patch);
  return acts > 0.0 ? 0.5 * domain.time_step / acts : 0.0;
}

/// The nodes' velocities by the rigid motion that each body has by its particles.
template <int D>
void begin_with_rigid_motions(Domain<D>& domain, const std::vector<bool>& bodies) {
  const std::vector<PartSums> parts = sums_of_bodies(domain, SumsOf::particles);
  for_each_meant(domain, bodies, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    const NodeBlock<D> block = domain.grid.block(p);
    const PartSums& part = parts[static_cast<std::size_t>(patch.body)];
    const Vector3 velocity = velocity_of(part), spin = spin_of(part, D);
    for (int n = 0; n < block.count; ++n) {
      const double m = block.records[n][mass_at];
      const Vector3 arm = place_of_kept(domain.grid, patch, block, n) - part.centre;
      const Vector3 v = velocity + cross(spin, arm);
      for (int a = 0; a < D; ++a) block.records[n][velocity_at + a] = m > 0.0 ? v[a] : 0.0;
    }
    hold_kept_nodes(domain.grid, patch, block);
  });
  take_from_leading(domain, velocity_at);
}

void check_frame(bool holds, const char* sentence) {
  if (!holds)
    throw std::invalid_argument(std::string("frame = \"material\" does not go with ") + sentence);
}

}  // namespace

void check_in_body(const Material& material) {
  check_frame(!material.moves_as_one(), "a rigid body, which does not deform");
  check_frame(!material.is_loose(),
              "a material that flows or spalls: fluids, gases, explosives, loose soils and spall "
              "strengths need frame = \"updated\"");
  check_frame(!material.does(FailureAction::erode) && !material.does(FailureAction::no_shear),
              "failure that erodes or leaves a liquid: give it the action \"no_tension\"");
}

template <int D>
void check_in_body(const Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  if (!has_kept_nodes(domain)) return;
  const Settings& s = simulation.settings;
  check_frame(s.grid.basis != basis_id<Linear>,
              "grid.basis = \"linear\", whose gradients jump: give \"quadratic_bspline\"");
  check_frame(domain.bodies.size() == 1 || !s.contact.bonded,
              "contact.bonded: give bonded = true in [[contact.pair]], which holds what touches at "
              "the start");
  const bool box = s.grid.box_cells[0] > 0;
  check_frame(!box || std::ranges::find(s.grid.walls, Wall::absorbing) == s.grid.walls.end(),
              "walls of the box that absorb yet: leave them out, or give frame = \"updated\"");
  const bool holds =
      std::ranges::any_of(s.grid.walls, [](Wall wall) { return Walls<D>::holds(wall); });
  check_frame(!box || !holds || !restitution_takes(s.contact),
              "walls of the box that are slip or fixed and a restitution yet: leave one out");
  check_frame(!s.grid.outflow, "a region that particles leave: give frame = \"updated\"");
  check_frame(!s.grid.coarsening, "grid.coarsening: give frame = \"updated\"");
  for (const HeldBody& held_body : simulation.held)
    check_frame(!domain.body_at(held_body.body).keeps_nodes(),
                "a velocity at the start and run.settle yet: leave one of them away");
}

template <int D>
void lay_nodes(Domain<D>& domain, const std::vector<bool>& bodies) {
  std::fill_n(domain.grid.kept.numbers.data(), domain.grid.kept.needed, 0.0);
  domain.followers = {};
  give_to_nodes(domain, bodies);
  for_each_meant(domain, bodies, [&](std::size_t p) {
    const NodeBlock<D> block = domain.grid.block(p);
    for (int n = 0; n < block.count; ++n) {
      block.records[n][mass_at] = block.records[n][given_mass];
      std::fill_n(block.records[n] + half_record, half_record, 0.0);  // no increments
    }
  });
}

template <int D>
void start_in_body(Domain<D>& domain) {
  if (!has_kept_nodes(domain)) return;
  const std::vector<bool> all(domain.bodies.size(), true);
  lay_nodes(domain, all);
  find_followers(domain, all);
  list_kept_spins(domain);
  find_kept_velocities(domain);
  start_average_in_body(domain);
}

template <int D>
void find_kept_velocities(Domain<D>& domain, const std::vector<bool>& bodies) {
  if (!has_kept_nodes(domain)) return;
  // Velocities are given at the end of the last step, and nodes keep that of its middle.
  const double* const kept = domain.grid.kept.numbers.data();
  const std::vector<double> increments(kept, kept + domain.grid.kept.needed);
  begin_with_rigid_motions(domain, bodies);
  take_from_particles<velocity_at>(domain, bodies);
  double largest = 0.0;
  for (int k = 0; k < passes; ++k) {
    give_to_nodes(domain, bodies);
    const double given = add_given(domain, bodies);
    largest = std::max(largest, given);
    if (!(given > least_change * largest)) break;
    take_from_particles<given_velocity>(domain, bodies);
  }
  for_each_meant(domain, {}, [&](std::size_t p) {
    const NodeBlock<D> block = domain.grid.block(p);
    const double* const before = increments.data() + domain.grid.patches[p].memory;
    for (int n = 0; n < block.count; ++n)
      std::copy_n(before + std::ptrdiff_t{n} * record + half_record, half_record,
                  block.records[n] + half_record);
  });
  for_each_meant(domain, bodies, [&](std::size_t p) {
    const NodeBlock<D> block = domain.grid.block(p);
    const double further = to_end_of_step(domain, domain.grid.patches[p]);
    for (int n = 0; n < block.count; ++n)
      for (int a = 0; a < D; ++a)
        block.records[n][velocity_at + a] -= further * block.records[n][increment_at + a];
  });
  give_kept_velocities(domain);
  find_kept_spins(domain);
}

template <int D>
void stop_kept_nodes(Domain<D>& domain) {
  for_each_meant(domain, {}, [&](std::size_t p) {
    const NodeBlock<D> block = domain.grid.block(p);
    for (int n = 0; n < block.count; ++n) {
      std::fill_n(block.records[n] + velocity_at, D, 0.0);
      std::fill_n(block.records[n] + half_record, half_record, 0.0);
    }
  });
  find_kept_spins(domain);
}

template <int D>
void give_kept_velocities(Domain<D>& domain) {
  if (!has_kept_nodes(domain)) return;
  for_each_meant(domain, {}, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    ParticlePool<D>& pool = domain.pool_of(patch);
    const double further = to_end_of_step(domain, patch);
    for_each_velocity<velocity_at>(domain, patch, [&](const auto& rows, const auto& v) {
      for (int a = 0; a < D; ++a) store(pool.v(a), rows, v[a]);
    });
    for_each_velocity<increment_at>(domain, patch, [&](const auto& rows, const auto& dv) {
      using T = std::remove_cvref_t<decltype(dv[0])>;
      for (int a = 0; a < D; ++a)
        store(pool.v(a), rows, fma(T(further), dv[a], load(pool.v(a), rows)));
    });
  });
}

template void check_in_body<2>(const Simulation<2>&);
template void check_in_body<3>(const Simulation<3>&);
template void start_in_body<2>(Domain<2>&);
template void start_in_body<3>(Domain<3>&);
template void lay_nodes<2>(Domain<2>&, const std::vector<bool>&);
template void lay_nodes<3>(Domain<3>&, const std::vector<bool>&);
template void find_kept_velocities<2>(Domain<2>&, const std::vector<bool>&);
template void find_kept_velocities<3>(Domain<3>&, const std::vector<bool>&);
template void stop_kept_nodes<2>(Domain<2>&);
template void stop_kept_nodes<3>(Domain<3>&);
template void give_kept_velocities<2>(Domain<2>&);
template void give_kept_velocities<3>(Domain<3>&);

}  // namespace mpm
