#pragma once
// Multilinear shape functions on a cell: N_ip = product over the axes of (1 - xi) or xi, with xi in [0, 1].
#include "mpm/grid/tile.hpp"
#include "mpm/math/vec.hpp"

namespace mpm {

/// Lanes over the 2^D nodes of a cell (x fastest), in as many registers as that takes.
template <int D>
struct CellNodes {
  static constexpr int count = 1 << D;
  static constexpr int width = count < native_lanes ? count : native_lanes;
  static constexpr int parts = count / width;
  using Part = Batch<width>;
  Part part[parts];

  static CellNodes zero() {
    CellNodes r;
    for (auto& p : r.part) p = Part(0.0);
    return r;
  }
  static CellNodes load(const std::array<double, count>& values) {
    CellNodes r;
    for (int k = 0; k < parts; ++k) r.part[k] = Part::load(values.data() + k * width);
    return r;
  }
  /// this += s * w
  void add(double s, const CellNodes& w) {
    for (int k = 0; k < parts; ++k) part[k] += Part(s) * w.part[k];
  }
};

namespace linear_detail {
/// 1 - bit, or 2 bit - 1, of axis a over the nodes: N along the axis is base + slope xi.
template <int D>
constexpr std::array<double, 1 << D> pattern(int axis, bool slope) {
  std::array<double, 1 << D> r{};
  for (int k = 0; k < 1 << D; ++k) {
    const double bit = (k >> axis) & 1;
    r[static_cast<std::size_t>(k)] = slope ? 2.0 * bit - 1.0 : 1.0 - bit;
  }
  return r;
}
}  // namespace linear_detail

template <int D>
struct Linear {
  // A particle exactly on a cell's face would give force to nodes to which it gives no mass; it is held this far away.
  static constexpr double margin = 1e-12;

  /// Position within the cell, in [margin, 1 - margin], from the position in cells and the cell's coordinate.
  template <class T>
  static T local(T cells, double cell) {
    return min(max(cells - T(cell), T(margin)), T(1.0 - margin));
  }

  /// The one-axis factors of the shape function over the cell's nodes.
  static CellNodes<D> factor(int axis, double xi) {
    static constexpr std::array<std::array<double, 1 << D>, 3> base = {
        linear_detail::pattern<D>(0, false), linear_detail::pattern<D>(1, false), linear_detail::pattern<D>(2, false)};
    static constexpr std::array<std::array<double, 1 << D>, 3> slope = {
        linear_detail::pattern<D>(0, true), linear_detail::pattern<D>(1, true), linear_detail::pattern<D>(2, true)};
    const auto a = static_cast<std::size_t>(axis);
    CellNodes<D> r = CellNodes<D>::load(base[a]);
    r.add(xi, CellNodes<D>::load(slope[a]));
    return r;
  }
  /// d factor / d xi, which does not depend on xi.
  static CellNodes<D> slope(int axis) {
    static constexpr std::array<std::array<double, 1 << D>, 3> slope = {
        linear_detail::pattern<D>(0, true), linear_detail::pattern<D>(1, true), linear_detail::pattern<D>(2, true)};
    return CellNodes<D>::load(slope[static_cast<std::size_t>(axis)]);
  }
};

template <int D>
CellNodes<D> operator*(const CellNodes<D>& x, const CellNodes<D>& y) {
  CellNodes<D> r;
  for (int k = 0; k < CellNodes<D>::parts; ++k) r.part[k] = x.part[k] * y.part[k];
  return r;
}

/// A nodal field on one cell as a polynomial: f = sum over corners k of c_k xi^(bits of k), so that particles in the
/// lanes evaluate it, and its gradient, by Horner's rule without touching the nodes again.
template <int D>
struct CellField {
  double c[1 << D];

  /// `first` is the cell's first node in the field of a block.
  explicit CellField(const double* first) {
    static constexpr auto offset = Tile<D>::corner_offsets();
    for (int k = 0; k < 1 << D; ++k) c[k] = first[offset[static_cast<std::size_t>(k)]];
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

}  // namespace mpm
