#pragma once
// What a basis is: shape functions along one axis. In space they are products over the axes.
#include <algorithm>
#include <cmath>
#include <concepts>
#include <string_view>

#include "mpm/math/scalar.hpp"
#include "mpm/math/vec.hpp"

namespace mpm {

/// N and dN/dxi of the nodes that a particle reaches along an axis, the lowest first. xi is in
/// cells: divide by the cell size for the gradient in space, eq. (20).
template <class T, int count>
struct AxisWeights {
  static constexpr int nodes = count;
  T N[count], dN[count];
};

/// A basis is made for particles whose edge at the start is a number of cells. `nodes`: how many a
/// particle reaches along an axis, whatever its place xi in its cell, in [0, 1]; `before` of them
/// lie before the cell's own, which is at `own_node` in the cell: 0, its corner, or 0.5, its
/// middle. `half_width()`: of the box over which the function is the mean of the hat [cells].
/// `odd_at_fixed_walls`: beyond a fixed wall the nodes move the other way than their images before
/// it, so that nothing moves at the wall; else they are held. `second_moment`: sum over the nodes
/// of N_i (x_i - x)^2 along the axis [cells^2], if it is the same at all places; else 0.
///
/// What acts on a face, d from a particle, acts on its nodes by N + d . grad N + sum_k b_k
/// d2N/dx_k^2 (decision 0071), with `second_derivative` along an axis and, for a face across it
/// `away` cells from a particle, b = `second_order()`, of a normal with that part of its square
/// along the axis. A basis without these gives it by linear functions (loads/carried_piece.hpp).
template <class B>
concept BasisModel = requires(const B basis, double xi) {
  { B::name } -> std::convertible_to<std::string_view>;
  { B::doc } -> std::convertible_to<std::string_view>;
  { B::source } -> std::convertible_to<std::string_view>;
  { B::nodes } -> std::convertible_to<int>;
  { B::before } -> std::convertible_to<int>;
  { B::own_node } -> std::convertible_to<double>;
  { B::odd_at_fixed_walls } -> std::convertible_to<bool>;
  { B::second_moment } -> std::convertible_to<double>;
  B(0.5);
  { basis.half_width() } -> std::convertible_to<double>;
  { basis.along(xi) } -> std::same_as<AxisWeights<double, B::nodes>>;
};

template <class B>
concept ActsOnFaces = BasisModel<B> && requires(const B basis) {
  { B::second_derivative[0] } -> std::convertible_to<double>;
  { basis.second_order(0.5, 0.25, 1.0) } -> std::convertible_to<double>;
};

/// b_k of a face that lies so far from a particle, along its normal [cells]. Where particles do not
/// divide cells b may be large where one of the nodes has next to no mass, as beyond an edge: it is
/// no more than what a face of particles that do divide them takes there, |d| (N / l)^1/2.
template <ActsOnFaces B, int D>
Vec<double, D> second_order_of(const B& basis, const Vec<double, D>& xi,
                               const Vec<double, D>& away) {
  const double square = dot(away, away);
  Vec<double, D> b = Vec<double, D>::zero();
  for (int a = 0; a < D; ++a) {
    if (std::abs(away[a]) < 1e-4) continue;  // b is of the order of its square
    const auto w = basis.along(xi[a]);
    const double least = std::max(std::min(w.N[0], w.N[B::nodes - 1]), 0.0),
                 most = std::abs(away[a]) * std::sqrt(least / basis.half_width());
    b[a] = basis.second_order(xi[a], away[a], away[a] * away[a] / square);
    b[a] = std::clamp(b[a], -most, most);
  }
  return b;
}

}  // namespace mpm
