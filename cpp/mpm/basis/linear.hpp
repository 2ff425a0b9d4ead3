#pragma once
// Multilinear shape functions on a cell: N_ip = product over the axes of (1 - xi) or xi, with xi in
// [0, 1].
#include <algorithm>

#include "mpm/basis/block_shape.hpp"
#include "mpm/basis/gifts.hpp"
#include "mpm/basis/node_lanes.hpp"
#include "mpm/basis/node_lines.hpp"
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

/// The nodal fields on one cell as polynomials: f = sum over corners k of c_k xi^(bits of k), so
/// that particles in the lanes evaluate them, and their gradients, by Horner's rule without
/// touching the nodes again. All fields of a line are made at once.
template <int D>
struct LinearField {
  static constexpr int corners = 1 << D;

  /// `nodes` are whole lines and begin at the cell's first.
  LinearField(const NodeLines& nodes, int row, int layer) {
    constexpr int W = std::min(native_lanes, line);
    for (int at = 0; at < line; at += W) {
      Batch<W> f[corners];
      unrolled<corners>([&](auto k) {
        f[k] = Batch<W>::load(nodes[(k & 1) + (k & 2 ? row : 0) + (k & 4 ? layer : 0)] + at);
      });
      unrolled<D>([&](auto a) {
        unrolled<corners>([&](auto k) {
          if constexpr ((k >> a & 1) != 0) f[k] -= f[k ^ 1 << a];
        });
      });
      unrolled<corners>([&](auto k) { f[k].store(c[k] + at); });
    }
  }

  /// The vector at number `at` of the lines.
  template <class T>
  Vec<T, D> vector(int at, const Vec<T, D>& xi) const {
    Vec<T, D> v;
    for (int i = 0; i < D; ++i) v[i] = value(at + i, xi);
    return v;
  }
  /// Derivatives of that vector with respect to xi (divide by the cell size for the gradient in
  /// space): [i][j] of component i along axis j.
  template <class T>
  std::array<Vec<T, D>, D> gradients(int at, const Vec<T, D>& xi) const {
    std::array<Vec<T, D>, D> g;
    for (int i = 0; i < D; ++i) g[static_cast<std::size_t>(i)] = gradient(at + i, xi);
    return g;
  }

 private:
  /// Of field f of the lines.
  template <class T>
  T value(int f, const Vec<T, D>& xi) const {
    const auto bilinear = [&](int k) {
      return fma(xi[1], fma(T(c[k + 3][f]), xi[0], T(c[k + 2][f])),
                 fma(T(c[k + 1][f]), xi[0], T(c[k][f])));
    };
    if constexpr (D == 2)
      return bilinear(0);
    else
      return fma(xi[2], bilinear(4), bilinear(0));
  }

  template <class T>
  Vec<T, D> gradient(int f, const Vec<T, D>& xi) const {
    const auto linear = [&](int k, int l, T x) { return fma(T(c[l][f]), x, T(c[k][f])); };
    if constexpr (D == 2) {
      return {linear(1, 3, xi[1]), linear(2, 3, xi[0])};
    } else {
      const T x = fma(xi[2], linear(5, 7, xi[1]), linear(1, 3, xi[1]));
      const T y = fma(xi[2], linear(6, 7, xi[0]), linear(2, 3, xi[0]));
      const T z = fma(xi[1], linear(6, 7, xi[0]), linear(4, 5, xi[0]));
      return {x, y, z};
    }
  }

  alignas(line * sizeof(double)) double c[corners][line];
};

template <int D>
struct Linear {
  explicit Linear(const BlockShape<D>& shape)
      : row_(shape.nodes[0]), layer_(shape.nodes[0] * shape.nodes[1]) {}
  using Field = LinearField<D>;

  /// What `Field` wants to know of particles in the lanes: their position in the cell.
  template <class T>
  static const Vec<T, D>& weights(const Vec<T, D>& xi) {
    return xi;
  }
  /// `nodes` begin at the cell's first.
  Field field(const NodeLines& nodes) const { return Field(nodes, row_, layer_); }

  template <int room>
  using Gifts = GiftColumns<D, room>;
  /// What `give` wants to know of a cell's particles: their position in the cell.
  template <int room>
  struct Particles {
    double xi[D][room];
  };
  template <unsigned /*what*/, int room, class T>
  static void put(Particles<room>& places, int at, const Vec<T, D>& position) {
    unrolled<D>([&](auto a) { store_lanes(places.xi[a] + at, position[a]); });
  }

  /// What the first `count` of these particles give to the nodes, whose lines begin at the cell's
  /// first: mass and momentum to the first quad, forces to the next; momentum alone to the first.
  /// The cell's nodes are the lanes, so that sums stay in registers for all its particles.
  template <unsigned what, int width, int room>
  void give(const Nodes<width>& nodes, const Particles<room>& places, const Gifts<room>& gifts,
            int count) const {
    constexpr bool forces = (what & gives_forces) != 0, momentum = what != gives_forces;
    static_assert(!(forces && momentum) || (what & gives_mass), "mass comes before the momentum");
    // All sums at once where the machine's registers hold them and a quarter is left for the rest.
    constexpr int all = native_lanes == 8 ? 32 : 16;
    if constexpr (!forces || !momentum || Sums::parts * (1 + 2 * D) <= all - all / 4) {
      give_sums<what>(nodes, places, gifts, count);
    } else {
      give_sums<what & ~gives_forces>(nodes, places, gifts, count);
      give_sums<gives_forces>(nodes, places, gifts, count);
    }
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
  using Sums = NodeLanes<(1 << D)>;
  using Part = typename Sums::Part;

  /// Eqs. (2), (3) and f_i -= V_p (sigma_p - q_p 1) . grad N_ip, eq. (9), with the artificial
  /// viscosity's pressure q.
  template <unsigned what, int width, int room>
  void give_sums(const Nodes<width>& nodes, const Particles<room>& places, const Gifts<room>& gifts,
                 int count) const {
    Sums m = Sums::zero(), p[3] = {m, m, m}, f[3] = {m, m, m};
    for (int k = 0; k < count; ++k) {
      if constexpr (what != gives_forces) {
        const Sums m_ip = functions(places, k, gifts.mass[k]);
        if constexpr ((what & gives_mass) != 0) m.add(1.0, m_ip);
        unrolled<D>([&](auto a) { p[a].add(gifts.velocity[a][k], m_ip); });
      }
      if constexpr ((what & gives_forces) != 0) {
        Sums G[D];
        gradients(places, k, G);
        unrolled<D>([&](auto a) {
          unrolled<D>(
              [&](auto b) { f[a].add(gifts.traction[Sym<double, D>::index(a, b)][k], G[b]); });
        });
      }
    }
    if constexpr ((what & gives_mass) != 0)
      add_to_nodes(nodes, m, p[0], p[1], p[2]);
    else if constexpr (what != gives_forces)
      add_to_nodes(nodes, p[0], p[1], p[2], m);
    if constexpr ((what & gives_forces) != 0)
      add_to_nodes(nodes.at(force_at), f[0], f[1], f[2], Sums::zero());
  }

  /// scale N_ip over the cell's nodes, for particle p of those.
  template <int room>
  static Sums functions(const Particles<room>& particles, int p, double scale) {
    Part inner = lanes(0, particles.xi[0][p]);
    for (int a = 1; a < inner_axes; ++a) inner = inner * lanes(a, particles.xi[a][p]);
    // The axes in their order and the scale last: the same bits for every width.
    Sums N;
    for (int k = 0; k < Sums::parts; ++k) {
      N.part[k] = inner;
      for (int a = inner_axes; a < D; ++a) N.part[k] = N.part[k] * along(a, k, particles.xi[a][p]);
    }
    return N.times(scale);
  }
  /// dN_ip / d xi over the cell's nodes, along each axis.
  template <int room>
  static void gradients(const Particles<room>& particles, int p, Sums* G) {
    Part N[D];
    for (int a = 0; a < inner_axes; ++a) N[a] = lanes(a, particles.xi[a][p]);
    for (int a = 0; a < D; ++a)
      for (int k = 0; k < Sums::parts; ++k) {
        Part g = a < inner_axes ? Part::load(slopes(a)) : Part(place(a, k) ? 1.0 : -1.0);
        for (int b = 0; b < inner_axes; ++b)
          if (b != a) g = g * N[b];
        for (int b = inner_axes; b < D; ++b)
          if (b != a) g = g * along(b, k, particles.xi[b][p]);
        G[a].part[k] = g;
      }
  }
  /// To a quad of the nodes' lines, which begin at the cell's first: the values of four fields.
  template <int width>
  void add_to_nodes(const Nodes<width>& nodes, const Sums& a, const Sums& b, const Sums& c,
                    const Sums& d) const {
    unrolled<Sums::parts>([&](auto part) {
      for_each_quad(a.part[part], b.part[part], c.part[part], d.part[part], [&](int k, Batch<4> q) {
        k += part * Sums::width;
        double* to = nodes[(k & 1) + (k & 2 ? row_ : 0) + (k & 4 ? layer_ : 0)];
        (Batch<4>::load(to) + q).store(to);
      });
    });
  }

  int row_, layer_;  // from a node to the next along y, and along z
  // The nodes of one register differ in the place along these axes; along the others they share it.
  static constexpr int inner_axes = Sums::width == 8 ? 3 : Sums::width == 4 ? 2 : 1;

  static const double* slopes(int a) {
    return linear_detail::slope<D>[static_cast<std::size_t>(a)].data();
  }
  /// Place along an outer axis of the nodes in register k.
  static constexpr int place(int a, int k) { return k * Sums::width >> a & 1; }
  /// One-axis factor of an inner axis, and of an outer one in register k.
  static Part lanes(int a, double xi) {
    return fma(Part(xi), Part::load(slopes(a)),
               Part::load(linear_detail::base<D>[static_cast<std::size_t>(a)].data()));
  }
  static Part along(int a, int k, double xi) {
    return place(a, k) ? Part(xi) : Part(1.0) - Part(xi);
  }
};

}  // namespace mpm
