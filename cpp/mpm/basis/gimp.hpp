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
// an axis: -1, 0, 1 as counted from the cell's own. Where fields are read the lanes are particles;
// where they are summed, the four numbers of a quad of a node's line, and the particles follow each
// other.
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
    N[1] = fma(T(-2.0), A, T(1.0) - (left + right));
    N[2] = right + A;
    const T dA = select(above, T(-0.5 / l), T(0.5 / l)) * a;
    dN[0] = select(above, T(0.0), T(-1.0)) + dA;
    dN[2] = select(above, T(1.0), T(0.0)) + dA;
    dN[1] = -(dN[0] + dN[2]);
  }
};

/// One-axis factors of particles of a cell, one after another; derivatives for forces only.
template <int D, int room>
struct GimpPlaces {
  double N[D][3][room], dN[D][3][room];
};

/// The nodal fields around one cell.
template <int D>
struct GimpField {
  NodeLines nodes;  // from the first that is in reach
  int row, layer;   // from node to node along y and z

  /// One-axis factors of particles, which are in the lanes.
  template <class T>
  struct Weights {
    GimpAxis<T> axis[D];
  };

  /// The vector at number `at` of the lines.
  template <class T>
  Vec<T, D> vector(int at, const Weights<T>& w) const {
    Vec<T, D> total = Vec<T, D>::zero();
    for_each_row([&](auto y, auto z, const NodeLines& row) MPM_INLINE {
      T share = w.axis[1].N[y];
      if constexpr (D == 3) share *= w.axis[D - 1].N[z];
      unrolled<D>([&](auto i) MPM_INLINE {
        total[i] = fma(share, along(row.at(at + i), w.axis[0].N), total[i]);
      });
    });
    return total;
  }

  /// Derivatives of that vector with respect to xi: [i][j] of component i along axis j.
  template <class T>
  std::array<Vec<T, D>, D> gradients(int at, const Weights<T>& w) const {
    std::array<Vec<T, D>, D> g;
    g.fill(Vec<T, D>::zero());
    for_each_row([&](auto y, auto z, const NodeLines& row) MPM_INLINE {
      T N = w.axis[1].N[y], dy = w.axis[1].dN[y], dz(0.0);
      if constexpr (D == 3) {
        dz = N * w.axis[D - 1].dN[z];
        N *= w.axis[D - 1].N[z];
        dy *= w.axis[D - 1].N[z];
      }
      unrolled<D>([&](auto i) MPM_INLINE {
        const T value = along(row.at(at + i), w.axis[0].N);
        g[i][0] = fma(N, along(row.at(at + i), w.axis[0].dN), g[i][0]);
        g[i][1] = fma(dy, value, g[i][1]);
        if constexpr (D == 3) g[i][2] = fma(dz, value, g[i][2]);
      });
    });
    return g;
  }

 private:
  /// f(y, z, lines) for the rows of nodes along x; one layer in 2D.
  template <class F>
  [[gnu::always_inline]] void for_each_row(F&& f) const {
    unrolled<D == 3 ? 3 : 1>([&](auto z) MPM_INLINE {
      unrolled<3>([&](auto y) MPM_INLINE { f(y, z, nodes.from(y * row + z * layer)); });
    });
  }
  /// Of a row, whose lines begin at the number that is wanted: the sum with factors along x.
  template <class T>
  [[gnu::always_inline]] static T along(const NodeLines& row, const T* x) {
    return fma(x[2], T(*row[2]), fma(x[1], T(*row[1]), x[0] * T(*row[0])));
  }
};

template <int D>
struct Gimp {
  const BlockShape<D>& shape;
  double half;  // l: half the particle's edge [cells], at most 1/2
  using Field = GimpField<D>;
  template <int room>
  using Particles = GimpPlaces<D, room>;
  template <int room>
  using Gifts = GiftQuads<D, room>;

  /// What `Field` wants to know of particles in the lanes.
  template <class T>
  typename Field::template Weights<T> weights(const Vec<T, D>& xi) const {
    return of_axes(xi, std::make_integer_sequence<int, D>{});
  }
  /// `nodes` begin at the cell's own.
  Field field(const NodeLines& nodes) const { return {nodes.from(first()), row(), layer()}; }

  /// What `give` wants to know of a cell's particles, a few at a time, by their weights.
  template <unsigned what, int room, class Weights>
  static void put(Particles<room>& places, int at, const Weights& w) {
    unrolled<D>([&](auto a) {
      unrolled<3>([&](auto k) {
        store_lanes(places.N[a][k] + at, w.axis[a].N[k]);
        if constexpr ((what & gives_forces) != 0)
          store_lanes(places.dN[a][k] + at, w.axis[a].dN[k]);
      });
    });
  }

  /// What the first `count` of these particles give to the nodes, whose lines begin at the cell's
  /// own: mass and momentum to the first quad, forces to the next; momentum alone to the first.
  /// Eqs. (2), (3) and f_i -= V_p (sigma_p - q_p 1) . grad N_ip, eq. (9), with the artificial
  /// viscosity's pressure q.
  template <unsigned what, int width, int room>
  void give(const Nodes<width>& nodes, const Particles<room>& places, const Gifts<room>& gifts,
            int count) const {
    const Nodes<width> reached = nodes.from(first());
    if constexpr (what != gives_forces)
      give_sums(reached, count, [&](int p, auto z, auto&& to) MPM_INLINE {
        give_momentum(places, gifts, p, z, to);
      });
    if constexpr ((what & gives_forces) != 0)
      give_sums(reached.at(force_at), count,
                [&](int p, auto z, auto&& to) MPM_INLINE { give_forces(places, gifts, p, z, to); });
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
  template <class T, int... a>
  auto of_axes(const Vec<T, D>& xi, std::integer_sequence<int, a...>) const {
    return typename Field::template Weights<T>{{GimpAxis<T>(xi[a], half)...}};
  }
  int row() const { return shape.nodes[0]; }
  int layer() const { return shape.nodes[0] * shape.nodes[1]; }
  /// From a cell's own node to the first that is in reach.
  int first() const { return -(1 + row() + (D == 3 ? layer() : 0)); }

  /// Layer by layer, so that the sums of nine nodes stay in registers: give(p, z, to) calls
  /// to(y, f(sum, x)), which adds to the sum of node x of row y what particle p gives.
  template <int width, class F>
  [[gnu::always_inline]] void give_sums(const Nodes<width>& nodes, int count, F&& give) const {
    unrolled<D == 3 ? 3 : 1>([&](auto z) MPM_INLINE {
      Batch<quad> sums[3][3];
      for (auto& row_sums : sums)
        for (auto& sum : row_sums) sum = Batch<quad>(0.0);
      for (int p = 0; p < count; ++p)
        give(p, z, [&](auto y, auto&& add_part) MPM_INLINE {
          unrolled<3>([&](auto x) MPM_INLINE { add_part(sums[y][x], x); });
        });
      unrolled<3>([&](auto y) MPM_INLINE {
        unrolled<3>([&](auto x)
                        MPM_INLINE { add(nodes[x + y * row() + z * layer()], sums[y][x]); });
      });
    });
  }
  template <int room, class F>
  [[gnu::always_inline]] static void give_momentum(const Particles<room>& of,
                                                   const Gifts<room>& gifts, int p, auto z,
                                                   F&& to) {
    const double m = D == 3 ? gifts.mass[p] * of.N[D - 1][z][p] : gifts.mass[p];
    const auto gift = m * Batch<quad>::load(gifts.velocity[p]);
    unrolled<3>([&](auto y) MPM_INLINE {
      const Batch<quad> part = gift * of.N[1][y][p];
      to(y, [&](Batch<quad>& sum, auto x)
                MPM_INLINE { sum = fma(part, Batch<quad>(of.N[0][x][p]), sum); });
    });
  }
  template <int room, class F>
  [[gnu::always_inline]] static void give_forces(const Particles<room>& of,
                                                 const Gifts<room>& gifts, int p, auto z, F&& to) {
    Batch<quad> traction[D];
    unrolled<D>([&](auto b) MPM_INLINE {
      traction[b] = Batch<quad>::load(gifts.traction[b][p]);
      if constexpr (D == 3) traction[b] *= b == 2 ? of.dN[2][z][p] : of.N[2][z][p];
    });
    unrolled<3>([&](auto y) MPM_INLINE {
      const Batch<quad> N(of.N[1][y][p]), along_x = traction[0] * N;
      Batch<quad> across = traction[1] * of.dN[1][y][p];
      if constexpr (D == 3) across = fma(traction[2], N, across);
      to(y, [&](Batch<quad>& sum, auto x) MPM_INLINE {
        sum = fma(along_x, Batch<quad>(of.dN[0][x][p]), sum);
        sum = fma(across, Batch<quad>(of.N[0][x][p]), sum);
      });
    });
  }
  static void add(double* to, Batch<quad> part) { (Batch<quad>::load(to) + part).store(to); }
};

}  // namespace mpm
