#pragma once
// The particles of a body around a node: what normals and gaps are made of.
#include <limits>
#include <vector>

#include "mpm/contact/surface.hpp"

namespace mpm {

/// The particles of a body from which a node is in reach, in lanes. Empty places in the lanes
/// repeat a particle of the body and have no weight.
template <int D>
struct NearParticles {
  using T = Batch<native_lanes>;
  struct Lanes {
    Vec<T, D> x;   // position from the node [cells]
    T half;        // half the particle's edge [cells]; -infinity for one out of reach
    T weight;      // mass [kg]; 0 for one out of reach
    T lack, gain;  // working values of separating_normal
  };
  std::vector<Lanes> lanes;

  /// Room for 8 lanes in each cell from which a node is in reach, so that steps seldom allocate.
  void reserve(int margin) {
    lanes.reserve(8 * static_cast<std::size_t>(power(2 + 2 * margin, D)));
  }

  /// How far the body reaches from the node along a unit vector: max of x . n + l [cells], eq. (5),
  /// with l half the edge of a cube of the particle's present volume; -infinity if there are no
  /// particles. Those within half a cell of the line through the node count; if there are none, all
  /// do: at a node beside the place where round bodies touch, the bodies have not met yet.
  double reach(const Vec<double, D>& normal) const {
    constexpr double radius = 0.5;
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

/// Add the particles of a patch from which one of its nodes is in reach.
template <int D>
void collect_near(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch, int node,
                  NearParticles<D>& to) {
  using T = Batch<native_lanes>;
  // Over this length [cells] a particle's weight falls to 0 where its reach ends: particles on a
  // lattice lie there in whole rows, and rounding must not choose among them.
  constexpr double rim = 1e-3;
  const double edge = body.mean_edge / grid.cell_size;
  const double reach = 1.0 + (grid.basis == Basis::gimp ? gimp_half(edge) : 0.0);
  for_particles_around(
      grid, body, patch, node, [&](const Index<D>& place, const Vec<T, D>& xi, const auto& rows) {
        typename NearParticles<D>::Lanes p;
        p.weight = select(first_lanes<native_lanes>(rows.count), load(body.mass(), rows), T(0.0));
        auto near = T(0.0) < T(1.0);
        for (int a = 0; a < D; ++a) {
          p.x[a] = xi[a] - T(place[a]);
          const T inside = T(reach) - max(p.x[a], -p.x[a]);
          near = near & (inside > T(0.0));
          p.weight *= min(max(T(1.0 / rim) * inside, T(0.0)), T(1.0));
        }
        if (!any(near)) return;
        const T edge_now = particle_edge<D>(load(body.volume(), rows), body.mean_edge);
        p.half = select(near, T(0.5 / grid.cell_size) * edge_now,
                        T(-std::numeric_limits<double>::infinity()));
        p.lack = p.gain = T(0.0);
        to.lanes.push_back(p);
      });
}

}  // namespace mpm
