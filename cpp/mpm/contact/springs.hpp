#pragma once
// Springs between particles and the bodies that they overlap, what they come to at a node
// (decisions 0051 and 0054): a force at the place where the surfaces touch, and none where they are
// apart.
#include <algorithm>
#include <cmath>
#include <limits>

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

/// What a point gives to a node of all that it has to give: N_i, and that of the nodes beyond walls
/// whose image the node is.
template <int D>
class NodeShares {
 public:
  /// `node` in the grid's coordinates, `edge` of the particles at the start [cells].
  NodeShares(BasisId basis, double edge, const Walls<D>& walls, const Index<D>& node)
      : basis_(basis), edge_(edge) {
    for (std::size_t a = 0; walls.exist && a < D; ++a)
      for (const int side : {0, 1}) {
        const Wall wall = walls.face[a][side];
        const int depth = side == 0 ? node[a] : walls.cells[a] - node[a];
        // The node itself is its own image.
        if (depth <= 0 || !(wall == Wall::slip || (wall == Wall::fixed && walls.odd_at_fixed)))
          continue;
        images_[a][++last_[a]] = {(side == 0 ? 2.0 : -2.0) * depth, wall == Wall::fixed};
      }
  }
  /// f(share, signs) of a point at x from the node [cells], for each of these nodes; `signs` are
  /// what the components of a vector are turned by.
  template <class F>
  void of(const Vec<double, D>& x, F&& f) const {
    Bases::with(basis_, edge_, [&]<BasisModel B>(const B& basis) {
      for_each_index<D>(Index<D>{}, last_, [&](const Index<D>& chosen) {
        double share = 1.0;
        Vec<double, D> signs;
        for (int a = 0; a < D; ++a) {
          const auto k = static_cast<std::size_t>(a);
          const Image& image = images_[k][chosen[k]];
          share *= shape_along(basis, x[a] + image.away);
          if (image.fixed) share = -share;
          signs[a] = chosen[k] > 0 && !image.fixed ? -1.0 : 1.0;
        }
        if (share != 0.0) f(share, signs);
      });
    });
  }

 private:
  struct Image {
    double away = 0.0;  // where the node lies as seen from that which it is the image of [cells]
    bool fixed = false;
  };
  BasisId basis_;
  double edge_;
  Image images_[D][3];  // along each axis, the first the node itself
  Index<D> last_{};
};

/// Stiffness of a particle that overlaps another body [Pa cells^(D - 2)], by the compliances of its
/// own and of the other body [1/Pa].
template <int D>
double stiffness_of(const Touch<D>& touch, double own, double other) {
  double face = 1.0;
  for (int a = 0; a + 1 < D; ++a) face *= 2.0 * touch.half;
  // Blocks of an edge each, one behind the other, that are shortened by the overlap; half of it,
  // as the other body's particles do the same.
  return 0.5 * face / (2.0 * (touch.half * own + touch.half_of_other * other));
}

/// Body r or s of a pair at a node.
template <int D>
struct SpringSide {
  std::int32_t body;
  double compliance;  // 1 / (rho c^2) [1/Pa]; 0 if it is rigid
  NodeShares<D> shares;
};

/// The springs between two bodies r and s at a node, each along the normal of its touch. Lengths in
/// cells.
template <int D>
class Springs {
 public:
  /// Add what a particle of r or s has there.
  void add(const Touch<D>& touch, const Vec<double, D>& node, const SpringSide<D>& r,
           const SpringSide<D>& s) {
    const bool of_r = touch.body == r.body;
    const SpringSide<D>&own = of_r ? r : s, &other = of_r ? s : r;
    const double of_all = stiffness_of(touch, own.compliance, other.compliance);
    const double to_s = of_r ? 1.0 : -1.0;
    Sum& sum = of_side_[of_r ? 0 : 1];
    own.shares.of(touch.place() - node, [&](double share, const Vec<double, D>& signs) {
      const double stiffness = share * of_all;
      Vec<double, D> n;  // from r to s
      for (int a = 0; a < D; ++a) n[a] = to_s * signs[a] * touch.normal[a];
      sum.force += (stiffness * touch.overlap) * n;
      for (int a = 0; a < D; ++a)
        for (int b = 0; b <= a; ++b) sum.stiffness[a][b] += stiffness * n[a] * n[b];
      sum.energy += 0.5 * stiffness * touch.overlap * touch.overlap;
      deepest_ = std::max(deepest_, touch.overlap);
    });
  }

  /// Of the force, from r to s; zero if there is none. Axes in `constrained` have no part.
  Vec<double, D> normal(unsigned constrained) const {
    Vec<double, D> n = of_side_[0].force + of_side_[1].force;
    for (int a = 0; a < D; ++a)
      if (constrained >> a & 1u) n[a] = 0.0;
    return normalised(n);
  }
  /// Along a normal, of a cell size [m].
  ContactSpring along(const Vec<double, D>& n, double cell_size) const {
    // Stiffness is a modulus times an area over a length.
    const double face = std::pow(cell_size, D - 1);
    const auto& [r, s] = of_side_;
    double stiffness = 0.0;
    for (int a = 0; a < D; ++a) {
      stiffness += n[a] * (r.stiffness[a][a] + s.stiffness[a][a]) * n[a];
      for (int b = 0; b < a; ++b)
        stiffness += 2.0 * n[a] * (r.stiffness[a][b] + s.stiffness[a][b]) * n[b];
    }
    return {face * dot(r.force + s.force, n), face / cell_size * stiffness,
            face * cell_size * (r.energy + s.energy)};
  }
  /// The least distance of the bodies [m]; infinite if nothing was added.
  double gap(double distance, double cell_size) const { return cell_size * (distance - deepest_); }

 private:
  struct Sum {
    Vec<double, D> force = Vec<double, D>::zero();  // [Pa cells^(D - 1)]
    double stiffness[D][D] = {};                    // [Pa cells^(D - 2)], the lower triangle
    double energy = 0.0;                            // [Pa cells^D]
  };
  Sum of_side_[2];  // of the particles of r and of s: which body is which changes no bit
  double deepest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace mpm
