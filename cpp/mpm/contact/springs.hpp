#pragma once
// Springs between particles that overlap, what they come to at a node (decision 0051): a force at
// the place where the surfaces touch, and none where they are still apart.
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "mpm/basis/basis.hpp"
#include "mpm/contact/contact_node.hpp"
#include "mpm/contact/near_particles.hpp"
#include "mpm/walls/walls.hpp"

namespace mpm {

/// The shape function of a node along an axis, at a distance x from it [cells].
template <BasisModel B>
double shape_along(const B& basis, double x) {
  const double from_cell = x + B::own_node, cell = std::floor(from_cell);
  const int node = B::before - static_cast<int>(cell);
  return node < 0 || node >= B::nodes ? 0.0 : basis.along(from_cell - cell).N[node];
}

/// What a point gives to a node of all that it has to give: N_i, and that of the node beyond a wall
/// whose image the node is.
template <int D>
class NodeShare {
 public:
  /// `node` in the grid's coordinates, `edge` of the particles at the start [cells].
  NodeShare(BasisId basis, double edge, const Walls<D>& walls, const Index<D>& node)
      : basis_(basis), edge_(edge) {
    for (std::size_t a = 0; walls.exist && a < D; ++a)
      for (const int side : {0, 1}) {
        const Wall wall = walls.face[a][side];
        const int depth = side == 0 ? node[a] : walls.cells[a] - node[a];
        // The node itself is its own image.
        if (depth <= 0 || !(wall == Wall::slip || (wall == Wall::fixed && walls.odd_at_fixed)))
          continue;
        sign_[a][side] = wall == Wall::slip ? 1.0 : -1.0;
        to_image_[a][side] = (side == 0 ? 2.0 : -2.0) * depth;
      }
  }
  /// Of a point at x from the node [cells].
  double at(const Vec<double, D>& x) const {
    double share = 1.0;
    Bases::with(basis_, edge_, [&]<BasisModel B>(const B& basis) {
      for (int a = 0; a < D; ++a) {
        const auto k = static_cast<std::size_t>(a);
        double N = shape_along(basis, x[a]);
        for (const int side : {0, 1})
          if (sign_[k][side] != 0.0)
            N += sign_[k][side] * shape_along(basis, x[a] + to_image_[k][side]);
        share *= N;
      }
    });
    return share;
  }

 private:
  BasisId basis_;
  double edge_;
  double sign_[D][2] = {}, to_image_[D][2] = {};
};

/// How far a particle reaches along n beyond the cap of another [cells]: the surface of a body is
/// what lies below the caps of its particles, spheres of eight edges in radius, so that flat rows
/// have dents of a sixty-fourth of an edge, and round bodies are hardly wider.
template <int D>
double overlap_of(double half, double half_of_other, const Vec<double, D>& to_other,
                  const Vec<double, D>& n, double distance) {
  constexpr double cap = 8.0;
  const double along = dot(to_other, n), beside = dot(to_other, to_other) - along * along;
  return half + half_of_other + distance - along - beside / (2.0 * cap * 2.0 * half_of_other);
}

/// One of two bodies whose particles may overlap at a node.
template <int D>
struct SpringSide {
  const NearParticles<D>& particles;
  double compliance;  // 1 / (rho c^2) [1/Pa]; 0 if it is rigid
  NodeShare<D> share;
};

/// Springs between the particles of two bodies around a node; n points from r to s. Lengths in
/// cells.
template <int D>
class Springs {
 public:
  /// Bodies closer than `distance` touch.
  Springs(const SpringSide<D>& r, const SpringSide<D>& s, const Vec<double, D>& n,
          double distance) {
    thread_local std::vector<Particle> of_r, of_s;
    const double far_r = furthest(r.particles, n), far_s = furthest(s.particles, -1.0 * n);
    // Only particles that reach beyond the other body's first can overlap one of it.
    collect(r.particles, n, -far_s - distance, of_r);
    collect(s.particles, -1.0 * n, -far_r - distance, of_s);
    // Each in turn as the one whose surface is sampled, half of both: so that neither the order nor
    // the size of the particles of the two matters.
    press(of_r, r, of_s, s, n, distance);
    press(of_s, s, of_r, r, -1.0 * n, distance);
  }

  /// At the node, of a cell size [m].
  ContactSpring at(double cell_size) const {
    // Stiffness is a modulus times an area over a length.
    const double face = std::pow(cell_size, D - 1);
    return {face * force_, face / cell_size * stiffness_, face * cell_size * energy_};
  }

 private:
  using T = Batch<contact_lanes>;
  struct Particle {
    Vec<double, D> x;  // from the node
    double half;       // half its edge, less what its surface is set back
  };

  static double furthest(const NearParticles<D>& body, const Vec<double, D>& n) {
    T most(-std::numeric_limits<double>::infinity());
    body.for_each([&](const Vec<T, D>& x, T half, T) {
      T along = half;
      for (int a = 0; a < D; ++a) along = fma(T(n[a]), x[a], along);
      most = max(most, along);
    });
    return largest(most);
  }
  /// Those that reach further along n than `from`.
  static void collect(const NearParticles<D>& body, const Vec<double, D>& n, double from,
                      std::vector<Particle>& to) {
    to.clear();
    // Scratch that every node of a thread uses again: it only grows.
    if (to.capacity() < body.count()) to.reserve(2 * body.count());
    body.for_each([&](const Vec<T, D>& x, T half, T) {
      T along = half;
      for (int a = 0; a < D; ++a) along = fma(T(n[a]), x[a], along);
      std::uint64_t lanes = lane_bits(along > T(from));
      if (lanes == 0) return;
      // What is empty in the last lanes has an extent of minus infinity, and is in no slab.
      for (; lanes != 0; lanes &= lanes - 1) {
        const int k = std::countr_zero(lanes);
        Particle& p = to.emplace_back();
        for (int a = 0; a < D; ++a) p.x[a] = x[a][k];
        p.half = half[k];
      }
    });
  }
  /// Add what the particles of a body p get that overlap those of q; n points from p to q.
  void press(const std::vector<Particle>& ps, const SpringSide<D>& p_side,
             const std::vector<Particle>& qs, const SpringSide<D>& q_side, const Vec<double, D>& n,
             double distance) {
    for (const Particle& p : ps) {
      double overlap = 0.0, half = 0.0;
      for (const Particle& q : qs) {
        const double here = overlap_of<D>(p.half, q.half, q.x - p.x, n, distance);
        if (here > overlap) overlap = here, half = q.half;
      }
      if (!(overlap > 0.0)) continue;
      double face = 1.0;
      for (int a = 0; a + 1 < D; ++a) face *= 2.0 * p.half;
      // In the middle between the surfaces: both bodies get the force there, at the same nodes.
      const double share = p_side.share.at(p.x + (p.half + 0.5 * (distance - overlap)) * n);
      // Blocks of an edge each, one behind the other, that are shortened by the overlap; half of
      // it, as the other body's particles do the same.
      const double stiffness =
          0.5 * share * face / (2.0 * (p.half * p_side.compliance + half * q_side.compliance));
      force_ += stiffness * overlap;
      stiffness_ += stiffness;
      energy_ += 0.5 * stiffness * overlap * overlap;
    }
  }

  double force_ = 0.0, stiffness_ = 0.0;  // [Pa cells^(D - 1)], [Pa cells^(D - 2)]
  double energy_ = 0.0;                   // [Pa cells^D]
};

}  // namespace mpm
