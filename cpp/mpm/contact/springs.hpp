#pragma once
// Springs between particles and the bodies that they overlap, what they come to at a node (decisions
// 0051 and 0054): a force at the place where the surfaces touch, and none where they are apart.
#include <algorithm>
#include <cmath>

#include "mpm/basis/basis.hpp"
#include "mpm/contact/contact_node.hpp"
#include "mpm/contact/touch.hpp"
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

/// Body r or s of a pair at a node.
template <int D>
struct SpringSide {
  std::int32_t body;
  double compliance;  // 1 / (rho c^2) [1/Pa]; 0 if it is rigid
  NodeShare<D> share;
};

/// The springs between two bodies r and s at a node, each along the normal of its touch. Lengths in
/// cells.
template <int D>
class Springs {
 public:
  /// Add what a particle of r or s has there. Bodies closer than `distance` touch.
  void add(const Touch<D>& touch, const Vec<double, D>& node, const SpringSide<D>& r,
           const SpringSide<D>& s, double distance) {
    const bool of_r = touch.body == r.body;
    const SpringSide<D>&own = of_r ? r : s, &other = of_r ? s : r;
    // In the middle between the surfaces: both bodies get the force there, at the same nodes.
    const double to_middle = touch.surface + 0.5 * (distance - touch.overlap);
    const double share = own.share.at(touch.x + to_middle * touch.normal - node);
    double face = 1.0;
    for (int a = 0; a + 1 < D; ++a) face *= 2.0 * touch.half;
    // Blocks of an edge each, one behind the other, that are shortened by the overlap; half of it,
    // as the other body's particles do the same.
    const double stiffness =
        0.5 * share * face /
        (2.0 * (touch.half * own.compliance + touch.half_of_other * other.compliance));
    const Vec<double, D> n = (of_r ? 1.0 : -1.0) * touch.normal;  // from r to s
    force_ += (stiffness * touch.overlap) * n;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b <= a; ++b) stiffness_[a][b] += stiffness * n[a] * n[b];
    energy_ += 0.5 * stiffness * touch.overlap * touch.overlap;
    deepest_ = std::max(deepest_, touch.overlap);
  }

  /// Of the force, from r to s; zero if there is none. Axes in `constrained` have no part.
  Vec<double, D> normal(unsigned constrained) const {
    Vec<double, D> n = force_;
    for (int a = 0; a < D; ++a)
      if (constrained >> a & 1u) n[a] = 0.0;
    return normalised(n);
  }
  /// Along a normal, of a cell size [m].
  ContactSpring along(const Vec<double, D>& n, double cell_size) const {
    // Stiffness is a modulus times an area over a length.
    const double face = std::pow(cell_size, D - 1);
    double stiffness = 0.0;
    for (int a = 0; a < D; ++a) {
      stiffness += n[a] * stiffness_[a][a] * n[a];
      for (int b = 0; b < a; ++b) stiffness += 2.0 * n[a] * stiffness_[a][b] * n[b];
    }
    return {face * dot(force_, n), face / cell_size * stiffness, face * cell_size * energy_};
  }
  /// The least distance of the bodies [m].
  double gap(double distance, double cell_size) const { return cell_size * (distance - deepest_); }

 private:
  Vec<double, D> force_ = Vec<double, D>::zero();  // [Pa cells^(D - 1)]
  double stiffness_[D][D] = {};                    // [Pa cells^(D - 2)], the lower triangle
  double energy_ = 0.0;                            // [Pa cells^D]
  double deepest_ = 0.0;
};

}  // namespace mpm
