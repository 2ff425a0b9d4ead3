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
  alignas(32) double c[1 << D];

  /// `first` is the cell's first node in the field of a block. Two nodes that are neighbours along
  /// x are read at once.
  LinearField(const double* first, int row, int layer) {
    const auto low = differences(first, row);
    low.store(c);
    if constexpr (D == 3) (differences(first + layer, row) - low).store(c + 4);
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

 private:
  /// Of the four nodes of a cell in a plane, along x and y.
  static Batch<4> differences(const double* first, int row) {
    const auto f = joined(Batch<2>::load(first), Batch<2>::load(first + row));
    const auto along_x = f - shuffled<4, 0, 4, 2>(f);
    return along_x - shuffled<4, 4, 0, 1>(along_x);
  }
};

template <int D>
struct Linear {
  explicit Linear(const BlockShape<D>& shape)
      : row_(shape.nodes[0]), layer_(shape.nodes[0] * shape.nodes[1]) {}
  using Nodes = NodeLanes<(1 << D)>;
  using Field = LinearField<D>;

  /// What `Field` wants to know of the particles in the lanes: their position in the cell.
  template <class T>
  static const Vec<T, D>& weights(const Vec<T, D>& xi) {
    return xi;
  }
  Field field(const double* first_node) const { return Field(first_node, row_, layer_); }

  /// scale N_ip over the cell's nodes; xi[a * stride] is the position in the cell along axis a.
  static Nodes functions(const double* xi, int stride, double scale) {
    Part inner = lanes(0, xi[0]);
    for (int a = 1; a < inner_axes; ++a) inner = inner * lanes(a, xi[a * stride]);
    Nodes N;
    for (int k = 0; k < Nodes::parts; ++k) {
      Part factor(scale);
      for (int a = inner_axes; a < D; ++a) factor = factor * along(a, k, xi[a * stride]);
      N.part[k] = factor * inner;
    }
    return N;
  }
  /// dN_ip / d xi over the cell's nodes, along each axis.
  static void gradients(const double* xi, int stride, Nodes* G) {
    Part N[D];
    for (int a = 0; a < inner_axes; ++a) N[a] = lanes(a, xi[a * stride]);
    for (int a = 0; a < D; ++a)
      for (int k = 0; k < Nodes::parts; ++k) {
        Part g = a < inner_axes ? Part::load(slopes(a)) : Part(place(a, k) ? 1.0 : -1.0);
        for (int b = 0; b < inner_axes; ++b)
          if (b != a) g = g * N[b];
        for (int b = inner_axes; b < D; ++b)
          if (b != a) g = g * along(b, k, xi[b * stride]);
        G[a].part[k] = g;
      }
  }
  /// Two nodes that are neighbours along x at a time.
  void add_to_nodes(double* first_node, const Nodes& value) const {
    double v[Nodes::count];
    value.store(v);
    unrolled<Nodes::count / 2>([&](auto half) {
      constexpr int k = 2 * half;
      double* pair = first_node + (k & 2 ? row_ : 0) + (k & 4 ? layer_ : 0);
      (Batch<2>::load(pair) + Batch<2>::load(v + k)).store(pair);
    });
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
  int row_, layer_;  // from a node to the next along y, and along z
  using Part = typename Nodes::Part;
  // The nodes of one register differ in the place along these axes; along the others they share it.
  static constexpr int inner_axes = Nodes::width == 8 ? 3 : Nodes::width == 4 ? 2 : 1;

  static const double* slopes(int a) {
    return linear_detail::slope<D>[static_cast<std::size_t>(a)].data();
  }
  /// Place along an outer axis of the nodes in register k.
  static constexpr int place(int a, int k) { return k * Nodes::width >> a & 1; }
  /// One-axis factor of an inner axis, and of an outer one in register k.
  static Part lanes(int a, double xi) {
    return Part::load(linear_detail::base<D>[static_cast<std::size_t>(a)].data()) +
           Part(xi) * Part::load(slopes(a));
  }
  static Part along(int a, int k, double xi) {
    return place(a, k) ? Part(xi) : Part(1.0) - Part(xi);
  }
};

}  // namespace mpm
