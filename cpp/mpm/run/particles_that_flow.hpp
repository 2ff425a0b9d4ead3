#pragma once
// Particles of bodies on nodes of their own that may flow plastically, counted by body.
#include <vector>

#include "mpm/comm/all_sums.hpp"
#include "mpm/domain.hpp"

namespace mpm {

/// f(patch, pool) for own patches of such bodies.
template <int D, class F>
void for_each_that_flows(const Domain<D>& domain, F&& f) {
  for (const Patch<D>& patch : domain.grid.patches) {
    if (!patch.keeps || patch.foreign) continue;
    const ParticlePool<D>& pool = domain.pool_of(patch);
    if (pool.flowed_before >= 0) f(patch, pool);
  }
}

/// How many particles of each body is_meant(body, pool, row), of all ranks.
template <int D, class F>
void count_that_flow(const Domain<D>& domain, std::vector<std::int64_t>& counts, F&& is_meant) {
  counts.assign(domain.bodies.size(), 0);
  for_each_that_flows(domain, [&](const Patch<D>& patch, const ParticlePool<D>& pool) {
    const Body<D>& body = domain.body_of(patch);
    std::int64_t& count = counts[static_cast<std::size_t>(patch.body)];
    for (const std::uint32_t row : pool.rows(patch)) count += is_meant(body, pool, row);
  });
  domain.grid.partition.comm->all_sum(counts);
}

/// Plastic strain of a particle since nodes were laid into its body.
template <int D>
double flowed_since(const ParticlePool<D>& pool, std::uint32_t row) {
  return pool.columns.component(pool.flowed)[row] - pool.columns.component(pool.flowed_before)[row];
}

/// Are so many particles of a body more than a few, one in a hundred?
template <int D>
bool are_many(const Body<D>& body, std::int64_t count) {
  constexpr double few = 0.01;
  return count > 0 && static_cast<double>(count) >= few * static_cast<double>(body.count);
}

}  // namespace mpm
