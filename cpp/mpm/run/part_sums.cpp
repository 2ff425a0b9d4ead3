#include "mpm/run/part_sums.hpp"

#include <numeric>

#include "mpm/comm/all_sums.hpp"
#include "mpm/step/kept_nodes.hpp"

namespace mpm {
namespace {

/// A mass with its motion: of a particle, with what its affine part adds, or of a node.
struct MovingMass {
  double mass, kinetic;  // [kg]; [J]
  Vector3 place, velocity;
  Vector3 own_momentum = Vector3::zero();  // angular, about its place [N m s]
  double own_inertia = 0.0;                // about each axis [kg m^2]
};

/// f(moving) for what a patch has.
template <int D, class F>
void for_each_mass(Domain<D>& domain, const Patch<D>& patch, SumsOf of, F&& f) {
  if (patch.keeps && of == SumsOf::kept_nodes) {
    // As the body turns, not its nodes.
    const OfTurning less = of_turning(domain.kept_spins, patch.body);
    for_each_kept_node(domain.grid, patch, [&](double m, const Vector3& x, const Vector3& v) {
      f(MovingMass{m, m * (0.5 * dot(v, v) - less.kinetic), x, v, -m * less.momentum,
                   -m * less.inertia});
    });
    return;
  }
  const double moment = domain.grid.affine_moment();
  const ParticlePool<D>& pool = domain.pool_of(patch);
  // The affine part of a rigid motion is its spin, of which the momentum is `moment` times the
  // curl. Bodies that do not deform have none, whatever others of their material have.
  const bool affine = pool.affine >= 0 && domain.body_of(patch).deforms();
  for (const std::uint32_t row : pool.rows(patch)) {
    const double m = pool.mass()[row];
    f(MovingMass{m, kinetic_energy(pool, row, moment), in_space<D>(pool.position_of(row)),
                 velocity_in_space(pool, row), (m * moment) * turning(pool, row),
                 affine ? 2.0 * m * moment : 0.0});
  }
}

/// Exact sums of some numbers over the patches of each group.
template <std::size_t count, int D, class F>
std::vector<std::array<double, count>> sum_groups(Domain<D>& domain, const Grouping& grouping,
                                                  SumsOf of, F&& numbers_of) {
  const std::size_t groups = grouping.count;
  const auto group_of = [&](std::size_t p) {
    return grouping.number[static_cast<std::size_t>(domain.grid.patches[p].body)];
  };
  std::vector<std::array<double, count>> parts(domain.grid.patches.size());
  domain.threads.for_each(parts.size(), [&](std::size_t p) {
    parts[p].fill(0.0);
    for_each_mass(domain, domain.grid.patches[p], of, [&](const MovingMass& moving) {
      const std::array<double, count> each = numbers_of(moving, group_of(p));
      for (std::size_t k = 0; k < count; ++k) parts[p][k] += each[k];
    });
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
std::vector<PartSums> part_sums(Domain<D>& domain, const Grouping& grouping, SumsOf of) {
  const auto linear = sum_groups<8>(domain, grouping, of, [](const MovingMass& each, std::size_t) {
    const Vector3 x = each.mass * each.place, p = each.mass * each.velocity;
    return std::array{each.mass, x[0], x[1], x[2], p[0], p[1], p[2], each.kinetic};
  });
  std::vector<PartSums> parts(linear.size());
  for (std::size_t g = 0; g < parts.size(); ++g) {
    const auto& s = linear[g];
    parts[g].mass = s[0];
    parts[g].centre = (s[0] > 0.0 ? 1.0 / s[0] : 0.0) * Vector3{s[1], s[2], s[3]};
    parts[g].momentum = {s[4], s[5], s[6]};
    parts[g].kinetic = s[7];
  }
  const auto turning =
      sum_groups<9>(domain, grouping, of, [&](const MovingMass& each, std::size_t group) {
        const Vector3 arm = each.place - parts[group].centre;
        const Vector3 L = each.mass * cross(arm, each.velocity) + each.own_momentum;
        RigidSums sums;
        sums.add(each.mass, arm, Vector3::zero());
        const Matrix3& I = sums.inertia;
        const double own = each.own_inertia;
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

template <int D>
std::vector<PartSums> sums_of_bodies(Domain<D>& domain, SumsOf of) {
  std::vector<std::size_t> numbers(domain.bodies.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return part_sums(domain, Grouping{numbers, numbers.size()}, of);
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

template std::vector<PartSums> part_sums<2>(Domain<2>&, const Grouping&, SumsOf);
template std::vector<PartSums> part_sums<3>(Domain<3>&, const Grouping&, SumsOf);
template std::vector<PartSums> sums_of_bodies<2>(Domain<2>&, SumsOf);
template std::vector<PartSums> sums_of_bodies<3>(Domain<3>&, SumsOf);

}  // namespace mpm
