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
#include "mpm/basis/node_lines.hpp"
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

/// The nodal fields around one cell, read by particles in the lanes.
template <int D>
struct GimpField {
  NodeLines nodes;  // from node (-1, -1, ...) of the cell on
  int row, layer;   // from node to node along y and z

  template <class T>
  using Weights = std::array<GimpAxis<T>, D>;

  /// Of one field of the lines.
  template <class T>
  T value(int field, const Weights<T>& w) const {
    T total(0.0);
    for (int z = 0; z < (D == 3 ? 4 : 1); ++z) {
      T plane(0.0);
      for (int y = 0; y < 4; ++y) plane += w[1].N[y] * along_x(field, w[0].N, y, z);
      if constexpr (D == 3) {
        total += w[2].N[z] * plane;
      } else {
        total = plane;
      }
    }
    return total;
  }

  template <class T>
  Vec<T, D> gradient(int field, const Weights<T>& w) const {
    Vec<T, D> g = Vec<T, D>::zero();
    for (int z = 0; z < (D == 3 ? 4 : 1); ++z) {
      T value(0.0), dx(0.0), dy(0.0);
      for (int y = 0; y < 4; ++y) {
        const T f = along_x(field, w[0].N, y, z);
        value += w[1].N[y] * f;
        dy += w[1].dN[y] * f;
        dx += w[1].N[y] * along_x(field, w[0].dN, y, z);
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
  T along_x(int field, const T* factor, int y, int z) const {
    const NodeField f{nodes[y * row + z * layer] + field, nodes.width};
    return (factor[0] * T(f[0]) + factor[1] * T(f[1])) +
           (factor[2] * T(f[2]) + factor[3] * T(f[3]));
  }
};

/// Lanes over the 4^D nodes in reach of a cell, row by row along x.
template <int D>
struct GimpNodes {
  static constexpr int rows = power(4, D - 1);
  using Row = NodeLanes<4>;
  static constexpr int parts = rows * Row::parts;
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
  /// `nodes` begin at the cell's first.
  Field field(const NodeLines& nodes) const {
    return {nodes.from(-reach()), shape.nodes[0], shape.nodes[0] * shape.nodes[1]};
  }

  /// What `functions` and `gradients` want to know of a cell's particles: the factors along x node
  /// by node, those along the other axes particle by particle.
  template <int room>
  struct Particles {
    double x[room][4], dx[room][4];
    double N[D - 1][4][room], dN[D - 1][4][room];
    template <int W>
    void put(const Gimp& basis, int at, const Vec<Batch<W>, D>& position) {
      const auto w = basis.weights(position);
      const auto across = [&](double (*to)[4], const Batch<W>* of) {
        for_each_quad(of[0], of[1], of[2], of[3],
                      [&](int k, Batch<4> factors) { factors.store(to[at + k]); });
      };
      across(x, w[0].N);
      across(dx, w[0].dN);
      for (std::size_t a = 1; a < D; ++a)
        for (int k = 0; k < 4; ++k) {
          w[a].N[k].store(N[a - 1][k] + at);
          w[a].dN[k].store(dN[a - 1][k] + at);
        }
    }
  };

  /// scale N_ip over the nodes in reach, for particle p of those.
  template <int room>
  static Nodes functions(const Particles<room>& of, int p, double scale) {
    return product(of.x[p], of.N[0], of.N[D - 2], p, scale);
  }
  /// dN_ip / d xi over the nodes in reach, along each axis.
  template <int room>
  static void gradients(const Particles<room>& of, int p, Nodes* G) {
    G[0] = product(of.dx[p], of.N[0], of.N[D - 2], p, 1.0);
    G[1] = product(of.x[p], of.dN[0], of.N[D - 2], p, 1.0);
    if constexpr (D == 3) G[2] = product(of.x[p], of.N[0], of.dN[1], p, 1.0);
  }
  /// To a quad of the nodes' lines, which begin at the cell's first: the values of four fields.
  void add_to_nodes(const NodeLines& nodes, const Nodes& a, const Nodes& b, const Nodes& c,
                    const Nodes& d) const {
    const NodeLines first = nodes.from(-reach());
    const int row = shape.nodes[0], layer = row * shape.nodes[1];
    for (int k = 0; k < Nodes::rows; ++k) {
      const NodeLines to = first.from((k % 4) * row + (k / 4) * layer);
      for (int part = 0; part < Nodes::Row::parts; ++part)
        for_each_quad(a.row[k].part[part], b.row[k].part[part], c.row[k].part[part],
                      d.row[k].part[part], [&](int n, Batch<4> q) {
                        double* node = to[part * Nodes::Row::width + n];
                        (Batch<4>::load(node) + q).store(node);
                      });
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
  /// Products over the nodes for particle p; `z` counts in 3D only.
  template <int room>
  static Nodes product(const double* x, const double (*y)[room], const double (*z)[room], int p,
                       double scale) {
    const auto along_x = Nodes::Row::load(x);
    Nodes r;
    for (int k = 0; k < Nodes::rows; ++k)
      r.row[k] = along_x.times(scale * (D == 3 ? y[k % 4][p] * z[k / 4][p] : y[k][p]));
    return r;
  }
};

}  // namespace mpm
