#pragma once
// Multilinear shape functions on a cell: N_ip = product over the axes of (1 - xi) or xi, with xi in
// [0, 1].
#include "mpm/basis/block_shape.hpp"
#include "mpm/basis/node_lanes.hpp"
#include "mpm/math/vec.hpp"

namespace mpm {

namespace linear_detail {
/// 1 - bit, or 2 bit - 1, of an axis over the nodes: N along the axis is base + slope xi.
template <int D>
constexpr auto pattern(bool slope) {
  std::array<std::array<double, 1 << D>, D> r{};
  for (std::size_t a = 0; a < D; ++a)
    for (std::size_t k = 0; k < 1 << D; ++k) {
      const double bit = static_cast<double>((k >> a) & 1);
      r[a][k] = slope ? 2.0 * bit - 1.0 : 1.0 - bit;
    }
  return r;
}
template <int D>
inline constexpr auto base = pattern<D>(false);
template <int D>
inline constexpr auto slope = pattern<D>(true);
}  // namespace linear_detail

/// A nodal field on one cell as a polynomial: f = sum over corners k of c_k xi^(bits of k), so that
/// particles in the lanes evaluate it, and its gradient, by Horner's rule without touching the
/// nodes again.
template <int D>
struct LinearField {
  double c[1 << D];

  /// `first` is the cell's first node in the field of a block.
  LinearField(const double* first, const BlockShape<D>& shape) {
    for (int k = 0; k < 1 << D; ++k) c[k] = first[shape.corner_offset[static_cast<std::size_t>(k)]];
    for (int axis = 0; axis < D; ++axis)
      for (int k = 0; k < 1 << D; ++k)
        if ((k >> axis) & 1) c[k] -= c[k ^ (1 << axis)];
  }

  template <class T>
  T value(const Vec<T, D>& xi) const {
    if constexpr (D == 2) {
      return (T(c[0]) + T(c[1]) * xi[0]) + xi[1] * (T(c[2]) + T(c[3]) * xi[0]);
    } else {
      const T low = (T(c[0]) + T(c[1]) * xi[0]) + xi[1] * (T(c[2]) + T(c[3]) * xi[0]);
      const T high = (T(c[4]) + T(c[5]) * xi[0]) + xi[1] * (T(c[6]) + T(c[7]) * xi[0]);
      return low + xi[2] * high;
    }
  }

  /// Derivatives with respect to xi (divide by the cell size for the gradient in space).
  template <class T>
  Vec<T, D> gradient(const Vec<T, D>& xi) const {
    if constexpr (D == 2) {
      return {T(c[1]) + T(c[3]) * xi[1], T(c[2]) + T(c[3]) * xi[0]};
    } else {
      const T x = (T(c[1]) + T(c[3]) * xi[1]) + xi[2] * (T(c[5]) + T(c[7]) * xi[1]);
      const T y = (T(c[2]) + T(c[3]) * xi[0]) + xi[2] * (T(c[6]) + T(c[7]) * xi[0]);
      const T z = (T(c[4]) + T(c[5]) * xi[0]) + xi[1] * (T(c[6]) + T(c[7]) * xi[0]);
      return {x, y, z};
    }
  }
};

template <int D>
struct Linear {
  const BlockShape<D>& shape;
  using Nodes = NodeLanes<(1 << D)>;
  using Field = LinearField<D>;

  /// What `Field` wants to know of the particles in the lanes: their position in the cell.
  template <class T>
  static const Vec<T, D>& weights(const Vec<T, D>& xi) {
    return xi;
  }
  Field field(const double* first_node) const { return Field(first_node, shape); }

  /// N_ip over the cell's nodes; xi[a * stride] is the position in the cell along axis a.
  static Nodes functions(const double* xi, int stride) {
    Nodes N = axis(0, xi[0]);
    for (int a = 1; a < D; ++a) N = N * axis(a, xi[a * stride]);
    return N;
  }
  /// dN_ip / d xi over the cell's nodes, along each axis.
  static void gradients(const double* xi, int stride, Nodes* G) {
    Nodes N[D];
    for (int a = 0; a < D; ++a) N[a] = axis(a, xi[a * stride]);
    for (int a = 0; a < D; ++a) {
      G[a] = Nodes::load(linear_detail::slope<D>[static_cast<std::size_t>(a)].data());
      for (int b = 0; b < D; ++b)
        if (b != a) G[a] = G[a] * N[b];
    }
  }
  void add_to_nodes(double* first_node, const Nodes& value) const {
    double v[Nodes::count];
    value.store(v);
    for (int k = 0; k < Nodes::count; ++k)
      first_node[shape.corner_offset[static_cast<std::size_t>(k)]] += v[k];
  }

  /// One-axis factor of the node at place e (0 or 1) of the cell, and its derivative.
  template <class T>
  static T factor(int e, T xi) {
    return e ? xi : T(1.0) - xi;
  }
  template <class T>
  static T slope(int e, T) {
    return T(e ? 1.0 : -1.0);
  }

 private:
  static Nodes axis(int a, double xi) {
    Nodes N = Nodes::load(linear_detail::base<D>[static_cast<std::size_t>(a)].data());
    N.add(xi, Nodes::load(linear_detail::slope<D>[static_cast<std::size_t>(a)].data()));
    return N;
  }
};

}  // namespace mpm
