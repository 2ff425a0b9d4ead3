#pragma once
// Uniform GIMP (Bardenhagen & Kober 2004): the linear shape function averaged over the particle, a
// box of edges 2 l that stay as they are at the start, 2 l at most one cell. With u the distance
// from the nearest node, a = max(l - |u|, 0) and A = a^2 / (4 l), all lengths in cells, that node
// and its two neighbours get along an axis
//   1 - |u| - 2 A,  max(-u, 0) + A below,  max(u, 0) + A above:
// the linear function plus second differences where the box reaches over the node. (Their eqs. for
// S_ip.)
//
// Cells are centred at the nodes, so that all particles of a cell reach the same three nodes along
// an axis: -1, 0, 1 as counted from the cell's own. The lanes are the four numbers of a quad of a
// node's line, and the particles follow each other.
#include "mpm/basis/block_shape.hpp"
#include "mpm/basis/gifts.hpp"
#include "mpm/basis/node_lanes.hpp"
#include "mpm/basis/node_lines.hpp"
#include "mpm/math/scalar.hpp"
#include "mpm/math/vec.hpp"

namespace mpm {

/// One-axis factors of the three nodes in reach, and their derivatives with respect to xi.
template <class T>
struct GimpAxis {
  T N[3], dN[3];
  GimpAxis(T xi, double l) {
    const T u = xi - T(0.5);
    const auto above = u >= T(0.0);
    const T right = max(u, T(0.0)), left = max(-u, T(0.0));
    const T a = max(T(l) - (left + right), T(0.0)), A = T(0.25 / l) * a * a;
    N[0] = left + A;
    N[1] = T(1.0) - (left + right) - T(2.0) * A;
    N[2] = right + A;
    const T dA = select(above, T(-0.5 / l), T(0.5 / l)) * a;
    dN[0] = select(above, T(0.0), T(-1.0)) + dA;
    dN[2] = select(above, T(1.0), T(0.0)) + dA;
    dN[1] = -(dN[0] + dN[2]);
  }
};

/// One-axis factors of particles of a cell.
template <int D, int room>
struct GimpPlaces {
  double N[D][3][room], dN[D][3][room];

  template <class T>
  void put(int at, const Vec<T, D>& position, double l) {
    unrolled<D>([&](auto a) {
      const GimpAxis<T> axis(position[a], l);
      unrolled<3>([&](auto k) {
        store_lanes(N[a][k] + at, axis.N[k]);
        store_lanes(dN[a][k] + at, axis.dN[k]);
      });
    });
  }
};

/// The same of one particle, each in all lanes of a quad.
template <int D>
struct GimpFactors {
  Batch<quad> N[D][3], dN[D][3];
  template <int room>
  GimpFactors(const GimpPlaces<D, room>& of, int p) {
    unrolled<D>([&](auto a) {
      unrolled<3>([&](auto k) {
        N[a][k] = of.N[a][k][p];
        dN[a][k] = of.dN[a][k][p];
      });
    });
  }
  /// Of a row: the sum of its quads with factors along x.
  static Batch<quad> along(const NodeLines& row, const Batch<quad>* x) {
    return x[0] * Batch<quad>::load(row[0]) + x[1] * Batch<quad>::load(row[1]) +
           x[2] * Batch<quad>::load(row[2]);
  }
};

/// The nodal fields around one cell.
template <int D>
struct GimpField {
  NodeLines nodes;  // from the first that is in reach
  int row, layer;   // from node to node along y and z

  template <int W>
  struct Weights : GimpPlaces<D, W> {
    int count;
  };

  /// The vector at number `at` of the lines, zero in the lanes without a particle.
  template <int W>
  auto vector(int at, const Weights<W>& w) const {
    Batch<quad> found[W];
    const NodeLines first = nodes.at(at);
    for (int p = 0; p < w.count; ++p) {
      const GimpFactors<D> of(w, p);
      Batch<quad> total(0.0);
      for_each_plane([&](auto z) {
        Batch<quad> plane(0.0);
        unrolled<3>([&](auto y) { plane += of.N[1][y] * of.along(row_of(first, y, z), of.N[0]); });
        total += D == 3 ? of.N[D - 1][z] * plane : plane;
      });
      found[p] = total;
    }
    return turned(found, w.count);
  }

  /// Derivatives of that vector with respect to xi: [i][j] of component i along axis j.
  template <int W>
  auto gradients(int at, const Weights<W>& w) const {
    Batch<quad> found[D][W];
    const NodeLines first = nodes.at(at);
    for (int p = 0; p < w.count; ++p) {
      const GimpFactors<D> of(w, p);
      Batch<quad> total[D];
      for (auto& t : total) t = Batch<quad>(0.0);
      for_each_plane([&](auto z) {
        Batch<quad> value(0.0), dx(0.0), dy(0.0);
        unrolled<3>([&](auto y) {
          const NodeLines nodes_x = row_of(first, y, z);
          const auto row_value = of.along(nodes_x, of.N[0]);
          value += of.N[1][y] * row_value;
          dy += of.dN[1][y] * row_value;
          dx += of.N[1][y] * of.along(nodes_x, of.dN[0]);
        });
        if constexpr (D == 2) {
          total[0] = dx;
          total[1] = dy;
        } else {
          total[0] += of.N[2][z] * dx;
          total[1] += of.N[2][z] * dy;
          total[2] += of.dN[2][z] * value;
        }
      });
      for (int a = 0; a < D; ++a) found[a][p] = total[a];
    }
    using V = decltype(turned(found[0], 0));
    std::array<V, D> g;
    for (int j = 0; j < D; ++j) {
      const V along_j = turned(found[j], w.count);
      for (int i = 0; i < D; ++i) g[static_cast<std::size_t>(i)][j] = along_j[i];
    }
    return g;
  }

 private:
  /// f(z) for the layers of a particle's nodes: one in 2D.
  template <class F>
  static void for_each_plane(F&& f) {
    unrolled<D == 3 ? 3 : 1>(f);
  }
  NodeLines row_of(const NodeLines& first, int y, int z) const {
    return first.from(y * row + z * layer);
  }
  /// From a quad for each particle to lanes of particles for each component.
  template <int W>
  static auto turned(Batch<quad> (&found)[W], int count) {
    using T = std::conditional_t<W == 1, double, Batch<W>>;
    for (int p = count; p < W; ++p) found[p] = Batch<quad>(0.0);
    Vec<T, D> r;
    if constexpr (W < quad) {
      for (int a = 0; a < D; ++a)
        if constexpr (W == 1)
          r[a] = found[0].v[a];
        else
          r[a] = T(typename T::Vector{found[0].v[a], found[1].v[a]});
    } else {
      Batch<quad> parts[W / quad][quad];  // four particles' components
      unrolled<W / quad>([&](auto h) {
        const Batch<quad>* four = found + h * quad;
        for_each_quad(four[0], four[1], four[2], four[3],
                      [&](int a, Batch<quad> component) { parts[h][a] = component; });
      });
      unrolled<D>([&](auto a) {
        if constexpr (W == quad)
          r[a] = parts[0][a];
        else
          r[a] = joined(parts[0][a], parts[1][a]);
      });
    }
    return r;
  }
};

template <int D>
struct Gimp {
  const BlockShape<D>& shape;
  double half;  // l: half the particle's edge [cells], at most 1/2
  using Field = GimpField<D>;
  template <int room>
  using Particles = GimpPlaces<D, room>;

  /// What `Field` wants to know of `count` particles in the lanes.
  template <class T>
  auto weights(const Vec<T, D>& xi, int count) const {
    typename Field::template Weights<lanes_of<T>> w;
    put(w, 0, xi);
    w.count = count;
    return w;
  }
  /// `nodes` begin at the cell's own.
  Field field(const NodeLines& nodes) const { return {nodes.from(first()), row(), layer()}; }

  /// What `give` wants to know of a cell's particles, a few at a time.
  template <int room, class T>
  void put(Particles<room>& places, int at, const Vec<T, D>& position) const {
    places.put(at, position, half);
  }

  /// What the first `count` of these particles give to the nodes, whose lines begin at the cell's
  /// own: mass and momentum to the first quad, forces to the next; momentum alone to the first.
  /// Eqs. (2), (3) and f_i -= V_p (sigma_p - q_p 1) . grad N_ip, eq. (9), with the artificial
  /// viscosity's pressure q.
  template <unsigned what, int room>
  void give(const NodeLines& nodes, const Particles<room>& places, const Gifts<D, room>& gifts,
            int count) const {
    const NodeLines reached = nodes.from(first());
    if constexpr (what != gives_forces)
      give_sums(reached, count, [&](int p, auto z, auto&& to) {
        give_momentum<(what & gives_mass) != 0>(places, gifts, p, z, to);
      });
    if constexpr ((what & gives_forces) != 0)
      give_sums(reached.at(force_at), count,
                [&](int p, auto z, auto&& to) { give_forces(places, gifts, p, z, to); });
  }

  /// One-axis factor of the node at place e (-1, 0 or 1) of the cell, and its derivative.
  template <class T>
  T factor(int e, T xi) const {
    return GimpAxis<T>(xi, half).N[e + 1];
  }
  template <class T>
  T slope(int e, T xi) const {
    return GimpAxis<T>(xi, half).dN[e + 1];
  }

 private:
  int row() const { return shape.nodes[0]; }
  int layer() const { return shape.nodes[0] * shape.nodes[1]; }
  /// From a cell's own node to the first that is in reach.
  int first() const { return -(1 + row() + (D == 3 ? layer() : 0)); }

  /// Layer by layer, so that the sums of nine nodes stay in registers: give(p, z, to) calls
  /// to(y, f(x)) with what particle p gives to the node x of row y.
  template <class F>
  [[gnu::always_inline]] void give_sums(const NodeLines& nodes, int count, F&& give) const {
    unrolled<D == 3 ? 3 : 1>([&](auto z) {
      Batch<quad> sums[3][3];
      for (auto& row_sums : sums)
        for (auto& sum : row_sums) sum = Batch<quad>(0.0);
      for (int p = 0; p < count; ++p)
        give(p, z,
             [&](auto y, auto&& part) { unrolled<3>([&](auto x) { sums[y][x] += part(x); }); });
      unrolled<3>([&](auto y) {
        unrolled<3>([&](auto x) { add(nodes[x + y * row() + z * layer()], sums[y][x]); });
      });
    });
  }
  template <bool mass, int room, class F>
  [[gnu::always_inline]] static void give_momentum(const Particles<room>& of,
                                                   const Gifts<D, room>& gifts, int p, auto z,
                                                   F&& to) {
    const double m = D == 3 ? gifts.mass[p] * of.N[D - 1][z][p] : gifts.mass[p];
    const auto momentum = [&](int a) { return a < D ? m * gifts.velocity[a][p] : 0.0; };
    const auto gift = mass ? numbers(m, momentum(0), momentum(1), momentum(2))
                           : numbers(momentum(0), momentum(1), momentum(2), 0.0);
    unrolled<3>([&](auto y) {
      const Batch<quad> part = gift * of.N[1][y][p];
      to(y, [&](auto x) { return part * of.N[0][x][p]; });
    });
  }
  template <int room, class F>
  [[gnu::always_inline]] static void give_forces(const Particles<room>& of,
                                                 const Gifts<D, room>& gifts, int p, auto z,
                                                 F&& to) {
    Batch<quad> traction[D];
    unrolled<D>([&](auto b) {
      const auto part = [&](int a) {
        return a < D ? gifts.traction[Sym<double, D>::index(a, b)][p] : 0.0;
      };
      traction[b] = numbers(part(0), part(1), part(2), 0.0);
      if constexpr (D == 3) traction[b] *= b == 2 ? of.dN[2][z][p] : of.N[2][z][p];
    });
    unrolled<3>([&](auto y) {
      const Batch<quad> N(of.N[1][y][p]), along_x = traction[0] * N;
      Batch<quad> across = traction[1] * of.dN[1][y][p];
      if constexpr (D == 3) across += traction[2] * N;
      to(y, [&](auto x) { return along_x * of.dN[0][x][p] + across * of.N[0][x][p]; });
    });
  }
  static Batch<quad> numbers(double a, double b, double c, double d) {
    return Batch<quad>(Batch<quad>::Vector{a, b, c, d});
  }
  static void add(double* to, Batch<quad> part) { (Batch<quad>::load(to) + part).store(to); }
};

}  // namespace mpm
