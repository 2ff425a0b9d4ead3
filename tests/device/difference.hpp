#pragma once
// By how much two simulations of the same problem differ.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "mpm/run/simulation.hpp"

namespace mpm::testing {

/// A particle that takes part, by its body and its number there.
struct Particle {
  std::size_t pool;
  std::uint32_t row;
};

/// Those of all bodies, in the order of the bodies and of their numbers.
template <int D>
std::vector<Particle> particles_of(const Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  std::map<std::pair<int, std::uint32_t>, Particle> by_number;
  for (const Patch<D>& patch : domain.grid.patches) {
    const std::size_t pool = pool_number(domain.bodies, patch.body);
    for (const std::uint32_t row : domain.pools[pool].rows(patch))
      by_number[{patch.body, domain.pools[pool].id[row]}] = {pool, row};
  }
  std::vector<Particle> particles;
  for (const auto& [number, particle] : by_number) particles.push_back(particle);
  return particles;
}

struct Difference {
  std::size_t numbers = 0, other = 0;  // of the particles; that are not the same to the bit
  double largest = 0.0;                // over the largest of the column
  double ledger = 0.0;                 // of the largest term
  std::string column;
};

template <int D>
Difference difference(const Simulation<D>& x, const Simulation<D>& y) {
  Difference found;
  const std::vector<Particle> of_x = particles_of(x), of_y = particles_of(y);
  if (of_x.size() != of_y.size()) throw std::runtime_error("there are other particles");
  // By material, as each has its own columns.
  std::map<std::pair<std::size_t, int>, std::pair<double, double>> columns;  // most, scale
  for (std::size_t k = 0; k < of_x.size(); ++k) {
    const Columns& first = x.domain.pools[of_x[k].pool].columns;
    const Columns& second = y.domain.pools[of_y[k].pool].columns;
    for (int c = 0; c < first.component_count(); ++c) {
      const double p = first.value(c, of_x[k].row), q = second.value(c, of_y[k].row);
      auto& [most, scale] = columns[{of_x[k].pool, c}];
      ++found.numbers;
      if (p != q) ++found.other;
      scale = std::max(scale, std::abs(p));
      most = std::max(most, p == q ? 0.0 : std::abs(p - q));
      if (!std::isfinite(q)) most = std::numeric_limits<double>::infinity();
    }
  }
  for (const auto& [column, largest] : columns) {
    const double relative =
        largest.first / std::max(largest.second, std::numeric_limits<double>::min());
    if (!(relative > found.largest)) continue;
    found.largest = relative;
    for (const ColumnInfo& info : x.domain.pools[column.first].columns.infos())
      if (column.second >= info.first && column.second < info.first + info.components)
        found.column = info.name;
  }
  const Ledger &a = x.domain.ledger, &b = y.domain.ledger;
  const double scale = std::max({a.kinetic, std::abs(a.internal), a.start});
  for (const auto& [p, q] : {std::pair{a.kinetic, b.kinetic},
                             {a.internal, b.internal},
                             {a.plastic, b.plastic},
                             {a.viscous, b.viscous},
                             {a.external, b.external},
                             {a.friction, b.friction},
                             {a.contact, b.contact},
                             {a.eroded, b.eroded},
                             {a.numerical(), b.numerical()},
                             {a.residual(), b.residual()}})
    found.ledger = std::max(found.ledger, std::abs(p - q) / scale);
  const auto vector = [&](const Vector3& p, const Vector3& q, double of) {
    found.ledger = std::max(found.ledger, norm(p - q) / std::max(of, 1e-300));
  };
  const AngularImpulses &p = a.angular.impulses, &q = b.angular.impulses;
  const double moments = norm(p.walls) + norm(p.gravity) + norm(p.mapped);
  vector(p.walls, q.walls, moments);
  vector(p.gravity, q.gravity, moments);
  vector(p.mapped, q.mapped, moments);
  for (std::size_t k = 0; k < x.domain.faces.size(); ++k) {
    const double m = x.domain.faces[k].value(), n = y.domain.faces[k].value();
    double all = 0.0;
    for (const ExactSum& sum : x.domain.faces) all = std::max(all, std::abs(sum.value()));
    if (all > 0.0) found.ledger = std::max(found.ledger, std::abs(m - n) / all);
  }
  return found;
}

}  // namespace mpm::testing
