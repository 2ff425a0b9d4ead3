#pragma once
// Uniform GIMP (Bardenhagen & Kober 2004): the linear shape function averaged over the particle, a
// box of edges 2 l that stay as they are at the start. With xi the position in the cell and a =
// max(l - xi, 0), b = max(l - (1 - xi), 0), all lengths in cells, the four nodes -1, 0, 1, 2 of an
// axis get
//   A, 1 - xi - 2 A + B, xi + A - 2 B, B    with A = a^2 / (4 l), B = b^2 / (4 l):
// the linear function plus second differences where the box reaches over a face of the cell. (Their
// eqs. for S_ip.)
#include "mpm/basis/block_shape.hpp"
#include "mpm/basis/node_lanes.hpp"
#include "mpm/math/vec.hpp"

namespace mpm {

/// One-axis factors of the four nodes and their derivatives with respect to xi.
template <class T>
struct GimpAxis {
  T N[4], dN[4];
  GimpAxis() = default;
  GimpAxis(T xi, double l) {
    const T a = max(T(l) - xi, T(0.0)), b = max(T(l - 1.0) + xi, T(0.0));
    const T A = T(0.25 / l) * a * a, B = T(0.25 / l) * b * b;
    const T dA = T(-0.5 / l) * a, dB = T(0.5 / l) * b;
    N[0] = A;
    N[1] = T(1.0) - xi - T(2.0) * A + B;
    N[2] = xi + A - T(2.0) * B;
    N[3] = B;
    dN[0] = dA;
    dN[1] = dB - T(2.0) * dA - T(1.0);
    dN[2] = T(1.0) + dA - T(2.0) * dB;
    dN[3] = dB;
  }
};

/// A nodal field around one cell, read by particles in the lanes.
template <int D>
struct GimpField {
  const double* first;  // node (-1, -1, ...) of the cell
  int row, layer;       // from node to node along y and z

  template <class T>
  using Weights = std::array<GimpAxis<T>, D>;

  template <class T>
  T value(const Weights<T>& w) const {
    T total(0.0);
    for (int z = 0; z < (D == 3 ? 4 : 1); ++z) {
      T plane(0.0);
      for (int y = 0; y < 4; ++y) plane += w[1].N[y] * along_x(w[0].N, y, z);
      if constexpr (D == 3) {
        total += w[2].N[z] * plane;
      } else {
        total = plane;
      }
    }
    return total;
  }

  template <class T>
  Vec<T, D> gradient(const Weights<T>& w) const {
    Vec<T, D> g = Vec<T, D>::zero();
    for (int z = 0; z < (D == 3 ? 4 : 1); ++z) {
      T value(0.0), dx(0.0), dy(0.0);
      for (int y = 0; y < 4; ++y) {
        const T f = along_x(w[0].N, y, z);
        value += w[1].N[y] * f;
        dy += w[1].dN[y] * f;
        dx += w[1].N[y] * along_x(w[0].dN, y, z);
      }
      if constexpr (D == 3) {
        g[0] += w[2].N[z] * dx;
        g[1] += w[2].N[z] * dy;
        g[2] += w[2].dN[z] * value;
      } else {
        g = {dx, dy};
      }
    }
    return g;
  }

 private:
  template <class T>
  T along_x(const T* factor, int y, int z) const {
    const double* f = first + y * row + z * layer;
    return (factor[0] * T(f[0]) + factor[1] * T(f[1])) +
           (factor[2] * T(f[2]) + factor[3] * T(f[3]));
  }
};

/// Lanes over the 4^D nodes in reach of a cell, row by row along x.
template <int D>
struct GimpNodes {
  static constexpr int rows = power(4, D - 1);
  using Row = NodeLanes<4>;
  Row row[rows];

  static GimpNodes zero() {
    GimpNodes r;
    for (auto& x : r.row) x = Row::zero();
    return r;
  }
  /// this += s * w
  void add(double s, const GimpNodes& w) {
    for (int k = 0; k < rows; ++k) row[k].add(s, w.row[k]);
  }
};

template <int D>
struct Gimp {
  const BlockShape<D>& shape;
  double half;  // l: half the particle's edge [cells], at most 1/2
  using Nodes = GimpNodes<D>;
  using Field = GimpField<D>;

  template <class T>
  std::array<GimpAxis<T>, D> weights(const Vec<T, D>& xi) const {
    std::array<GimpAxis<T>, D> w;
    for (std::size_t a = 0; a < D; ++a) w[a] = GimpAxis<T>(xi[static_cast<int>(a)], half);
    return w;
  }
  Field field(const double* first_node) const {
    return {first_node - reach(), shape.nodes[0], shape.nodes[0] * shape.nodes[1]};
  }

  /// scale N_ip over the nodes in reach; xi[a * stride] is the position in the cell along axis a.
  Nodes functions(const double* xi, int stride, double scale) const {
    const auto w = axes(xi, stride);
    return product(w[0].N, w[1].N, w[D - 1].N, scale);
  }
  /// dN_ip / d xi over the nodes in reach, along each axis.
  void gradients(const double* xi, int stride, Nodes* G) const {
    const auto w = axes(xi, stride);
    G[0] = product(w[0].dN, w[1].N, w[D - 1].N, 1.0);
    G[1] = product(w[0].N, w[1].dN, w[D - 1].N, 1.0);
    if constexpr (D == 3) G[2] = product(w[0].N, w[1].N, w[2].dN, 1.0);
  }
  void add_to_nodes(double* first_node, const Nodes& value) const {
    double* first = first_node - reach();
    const int row = shape.nodes[0], layer = row * shape.nodes[1];
    for (int k = 0; k < Nodes::rows; ++k) {
      double* to = first + (k % 4) * row + (k / 4) * layer;
      typename Nodes::Row sum = Nodes::Row::load(to);
      sum.add(1.0, value.row[k]);
      sum.store(to);
    }
  }

  /// One-axis factor of the node at place e (-1, 0, 1 or 2) of the cell, and its derivative.
  template <class T>
  T factor(int e, T xi) const {
    return GimpAxis<T>(xi, half).N[e + 1];
  }
  template <class T>
  T slope(int e, T xi) const {
    return GimpAxis<T>(xi, half).dN[e + 1];
  }

 private:
  /// From the cell's first node back to node (-1, -1, ...).
  int reach() const {
    Index<D> one;
    one.fill(1);
    return shape.distance(one);
  }
  std::array<GimpAxis<double>, D> axes(const double* xi, int stride) const {
    std::array<GimpAxis<double>, D> w;
    for (int a = 0; a < D; ++a)
      w[static_cast<std::size_t>(a)] = GimpAxis<double>(xi[a * stride], half);
    return w;
  }
  /// Products over the nodes; `z` counts in 3D only.
  static Nodes product(const double* x, const double* y, const double* z, double scale) {
    const auto along_x = Nodes::Row::of(scale * x[0], scale * x[1], scale * x[2], scale * x[3]);
    Nodes r = Nodes::zero();
    for (int k = 0; k < Nodes::rows; ++k)
      r.row[k].add(D == 3 ? y[k % 4] * z[k / 4] : y[k], along_x);
    return r;
  }
};

}  // namespace mpm
