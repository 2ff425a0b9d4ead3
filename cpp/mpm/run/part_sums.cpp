#include "mpm/run/part_sums.hpp"

#include <utility>

#include "mpm/math/exact_sum.hpp"

namespace mpm {
namespace {

/// The number of each body's group among the groups, and of the groups.
template <int D>
std::pair<std::vector<std::size_t>, std::size_t> number_groups(const Domain<D>& domain) {
  std::vector<std::size_t> numbers(domain.bodies.size());
  std::size_t count = 0;
  for (std::size_t b = 0; b < numbers.size(); ++b) {
    const auto first = static_cast<std::size_t>(domain.bodies[b].group);
    numbers[b] = first == b ? count++ : numbers[first];
  }
  return {std::move(numbers), count};
}

/// Exact sums of some numbers over the patches of each group, `numbers` of the bodies.
template <std::size_t count, int D, class F>
std::vector<std::array<double, count>> sum_groups(Domain<D>& domain,
                                                  const std::vector<std::size_t>& numbers,
                                                  std::size_t groups, F&& of_particle) {
  const auto group_of = [&](std::size_t p) {
    return numbers[static_cast<std::size_t>(domain.grid.patches[p].body)];
  };
  std::vector<std::array<double, count>> parts(domain.grid.patches.size());
  domain.threads.for_each(parts.size(), [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    parts[p].fill(0.0);
    for (const std::uint32_t row : domain.pool_of(patch).rows(patch)) {
      const std::array<double, count> each = of_particle(domain.pool_of(patch), row, group_of(p));
      for (std::size_t k = 0; k < count; ++k) parts[p][k] += each[k];
    }
  });
  std::vector<std::array<double, count>> sums(groups);
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<ExactSum> exact(groups);
    for (std::size_t p = 0; p < parts.size(); ++p) exact[group_of(p)].add(parts[p][k]);
    for (std::size_t g = 0; g < groups; ++g) sums[g][k] = exact[g].value();
  }
  return sums;
}

template <int D>
Vector3 velocity(const ParticlePool<D>& pool, std::uint32_t row) {
  Vec<double, D> v;
  for (int a = 0; a < D; ++a) v[a] = pool.v(a)[row];
  return in_space<D>(v);
}

/// The axial vector of the affine part, eps_kab C_ba [1/s].
template <int D>
Vector3 turning(const ParticlePool<D>& pool, std::uint32_t row) {
  Vector3 w = Vector3::zero();
  if (pool.affine < 0) return w;
  const auto C = [&](int i, int j) { return double{pool.affine_part(D * i + j)[row]}; };
  w[2] = C(1, 0) - C(0, 1);
  if constexpr (D == 3) {
    w[0] = C(2, 1) - C(1, 2);
    w[1] = C(0, 2) - C(2, 0);
  }
  return w;
}

}  // namespace

template <int D>
std::vector<double> part_sums(Domain<D>& domain) {
  const double moment = domain.grid.affine_moment();
  const auto [numbers, groups] = number_groups(domain);
  const auto linear = sum_groups<8>(
      domain, numbers, groups, [&](const ParticlePool<D>& pool, std::uint32_t row, std::size_t) {
        const double m = pool.mass()[row];
        const Vector3 x = m * in_space<D>(pool.position_of(row)), p = m * velocity(pool, row);
        return std::array{m, x[0], x[1], x[2], p[0], p[1], p[2], kinetic_energy(pool, row, moment)};
      });
  const auto centre_of = [&](std::size_t group) {
    const auto& s = linear[group];
    return (s[0] > 0.0 ? 1.0 / s[0] : 0.0) * Vector3{s[1], s[2], s[3]};
  };
  const auto angular = sum_groups<3>(
      domain, numbers, groups,
      [&](const ParticlePool<D>& pool, std::uint32_t row, std::size_t group) {
        const Vector3 arm = in_space<D>(pool.position_of(row)) - centre_of(group);
        const Vector3 L =
            pool.mass()[row] * (cross(arm, velocity(pool, row)) + moment * turning(pool, row));
        return std::array{L[0], L[1], L[2]};
      });
  std::vector<double> rows;
  for (std::size_t g = 0; g < groups; ++g) {
    const auto& s = linear[g];
    const Vector3 x = centre_of(g);
    const double per_mass = s[0] > 0.0 ? 1.0 / s[0] : 0.0;
    for (const double value :
         {s[0], x[0], x[1], x[2], per_mass * s[4], per_mass * s[5], per_mass * s[6], s[4], s[5],
          s[6], s[7], angular[g][0], angular[g][1], angular[g][2]})
      rows.push_back(value);
  }
  return rows;
}

template std::vector<double> part_sums<2>(Domain<2>&);
template std::vector<double> part_sums<3>(Domain<3>&);

}  // namespace mpm
