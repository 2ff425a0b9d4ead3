#pragma once
// What a basis is: shape functions along one axis. In space they are products over the axes.
#include <concepts>
#include <string_view>

#include "mpm/math/scalar.hpp"

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
/// of N_i (x_i - x)^2 along the axis [cells^2], if it is the same at all places; else 0. One that
/// has `second_order()` and `second_derivative` gives what acts on faces to nodes by them, others
/// by linear functions (loads/load_surfaces.cpp).
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

}  // namespace mpm
