#include "mpm/run/part_sums.hpp"

#include "mpm/comm/all_sums.hpp"

namespace mpm {
namespace {

/// Exact sums of some numbers over the patches of each group.
template <std::size_t count, int D, class F>
std::vector<std::array<double, count>> sum_groups(Domain<D>& domain, const Grouping& grouping,
                                                  F&& of_particle) {
  const std::size_t groups = grouping.count;
  const auto group_of = [&](std::size_t p) {
    return grouping.number[static_cast<std::size_t>(domain.grid.patches[p].body)];
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
    all_sum(*domain.grid.partition.comm, exact);
    for (std::size_t g = 0; g < groups; ++g) sums[g][k] = exact[g].value();
  }
  return sums;
}

}  // namespace

template <int D>
std::vector<PartSums> part_sums(Domain<D>& domain, const Grouping& grouping) {
  const double moment = domain.grid.affine_moment();
  const auto linear = sum_groups<8>(
      domain, grouping, [&](const ParticlePool<D>& pool, std::uint32_t row, std::size_t) {
        const double m = pool.mass()[row];
        const Vector3 x = m * in_space<D>(pool.position_of(row)),
                      p = m * velocity_in_space(pool, row);
        return std::array{m, x[0], x[1], x[2], p[0], p[1], p[2], kinetic_energy(pool, row, moment)};
      });
  std::vector<PartSums> parts(linear.size());
  for (std::size_t g = 0; g < parts.size(); ++g) {
    const auto& s = linear[g];
    parts[g].mass = s[0];
    parts[g].centre = (s[0] > 0.0 ? 1.0 / s[0] : 0.0) * Vector3{s[1], s[2], s[3]};
    parts[g].momentum = {s[4], s[5], s[6]};
    parts[g].kinetic = s[7];
  }
  std::vector<bool> deforms(parts.size());
  for (std::size_t b = 0; b < domain.bodies.size(); ++b)
    deforms[grouping.number[b]] = domain.bodies[b].deforms();
  const auto turning = sum_groups<9>(
      domain, grouping, [&](const ParticlePool<D>& pool, std::uint32_t row, std::size_t group) {
        const Vector3 centre = parts[group].centre;
        const Vector3 L = angular_momentum(pool, row, moment, centre);
        RigidSums of;
        const double m = pool.mass()[row];
        of.add(m, in_space<D>(pool.position_of(row)) - centre, Vector3::zero());
        // The affine part of a rigid motion is its spin, of which the momentum is `moment` times
        // the curl. Bodies that do not deform have none, whatever others of their material have.
        const Matrix3& I = of.inertia;
        const double own = pool.affine < 0 || !deforms[group] ? 0.0 : 2.0 * m * moment;
        return std::array{L[0],          L[1],    L[2],    I[0][0] + own, I[1][1] + own,
                          I[2][2] + own, I[1][2], I[0][2], I[0][1]};
      });
  for (std::size_t g = 0; g < parts.size(); ++g) {
    const auto& s = turning[g];
    parts[g].angular_momentum = {s[0], s[1], s[2]};
    parts[g].inertia = {{{s[3], s[8], s[7]}, {s[8], s[4], s[6]}, {s[7], s[6], s[5]}}};
  }
  for (std::size_t b = 0; b < domain.bodies.size(); ++b)
    parts[grouping.number[b]].prescribed = domain.bodies[b].is_prescribed();
  return parts;
}

AngularTotals angular_totals(const std::vector<PartSums>& parts) {
  AngularTotals totals;
  for (const PartSums& part : parts) {
    const Vector3 about_origin = part.angular_momentum + cross(part.centre, part.momentum);
    totals.all += about_origin;
    if (part.prescribed) totals.prescribed += about_origin;
  }
  return totals;
}

std::vector<double> balance_row(const AngularLedger& ledger, const AngularTotals& totals) {
  const AngularBalance b = balance_of(ledger, totals.all, totals.prescribed);
  std::vector<double> row;
  row.reserve(total_columns.size());
  for (const Vector3& term :
       {b.momentum, b.gravity, b.loads, b.walls, b.damping, b.motion, b.removed, b.numerical})
    for (int a = 0; a < 3; ++a) row.push_back(term[a]);
  return row;
}

template std::vector<PartSums> part_sums<2>(Domain<2>&, const Grouping&);
template std::vector<PartSums> part_sums<3>(Domain<3>&, const Grouping&);

}  // namespace mpm
