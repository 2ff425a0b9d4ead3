#pragma once
// The particles of a body around a node: what normals and gaps are made of.
#include <limits>
#include <vector>

#include "mpm/contact/tile_particles.hpp"

namespace mpm {

/// The particles of a body from which a node is in reach, in lanes. Empty places in the lanes
/// repeat a particle of the body and have no weight.
template <int D>
struct NearParticles {
  using T = Batch<contact_lanes<D>>;
  struct Lanes {
    Vec<T, D> x;  // position from the node [cells]
    T half;       // half the particle's edge [cells]; -infinity for one out of reach
    T weight;     // mass [kg]; 0 for one out of reach
  };
  std::vector<Lanes> lanes;
  T mass = T(0.0);                       // of all, by lane [kg]
  Vec<T, D> moment = Vec<T, D>::zero();  // the same times x

  /// Mass in reach [kg] and its centre from the node [cells]; zero without mass.
  double total() const { return sum(mass); }
  Vec<double, D> centre() const {
    const double all = total();
    Vec<double, D> c = Vec<double, D>::zero();
    if (!(all > 0.0)) return c;
    for (int a = 0; a < D; ++a) c[a] = sum(moment[a]) / all;
    return c;
  }

  /// How far the body extends from the node along a unit vector: max of x . n + l [cells], eq. (5),
  /// with l half the edge of a cube of the particle's present volume; -infinity if there are no
  /// particles. Those within a cell of the line through the node along n count: beside the
  /// place where round bodies touch, their surfaces are still apart. If the line misses the body,
  /// as beside an edge, all count.
  double extent_along(const Vec<double, D>& normal) const {
    constexpr double radius = 1.0;
    T on_line(-std::numeric_limits<double>::infinity()), anywhere = on_line;
    for (const Lanes& p : lanes) {
      T along(0.0), square(0.0);
      for (int a = 0; a < D; ++a) {
        along += T(normal[a]) * p.x[a];
        square += p.x[a] * p.x[a];
      }
      const T distance = along + p.half;
      anywhere = max(anywhere, distance);
      on_line =
          select(square - along * along < T(radius * radius), max(on_line, distance), on_line);
    }
    const double there = largest(on_line);
    return there > -std::numeric_limits<double>::infinity() ? there : largest(anywhere);
  }
};

/// Collect the particles of a body from which a node, counted from the tile's first, is in reach,
/// in place of those that were there.
template <int D>
void collect_near(const TileParticles<D>& particles, const Index<D>& node, double reach,
                  NearParticles<D>& to) {
  using T = Batch<contact_lanes<D>>;
  // Over this length [cells] a particle's weight falls to 0 where its reach ends: particles on a
  // lattice lie there in whole rows, and rounding must not choose among them.
  constexpr double rim = 1e-3;
  to.lanes.clear();
  to.lanes.reserve(8 * static_cast<std::size_t>(particles.cells_around()));  // seldom allocates
  T mass(0.0);
  Vec<T, D> moment = Vec<T, D>::zero();
  particles.around(node, [&](const Index<D>& place, const auto& lanes) {
    typename NearParticles<D>::Lanes p;
    p.weight = lanes.mass;
    auto near = T(0.0) < T(1.0);
    for (int a = 0; a < D; ++a) {
      p.x[a] = lanes.xi[a] - T(place[a] + particles.own_node());
      const T to_rim = T(reach) - max(p.x[a], -p.x[a]);
      near = near & (to_rim > T(0.0));
      p.weight *= min(max(T(1.0 / rim) * to_rim, T(0.0)), T(1.0));
    }
    if (!any(near)) return;
    p.half = select(near, lanes.half, T(-std::numeric_limits<double>::infinity()));
    mass += p.weight;
    for (int a = 0; a < D; ++a) moment[a] += p.weight * p.x[a];
    to.lanes.push_back(p);
  });
  to.mass = mass;
  to.moment = moment;
}

}  // namespace mpm
