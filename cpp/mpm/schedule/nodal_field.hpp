#pragma once
// Gather by particles in lanes, for any basis: sums over the nodes.
#include <array>

#include "mpm/layout/node_records.hpp"
#include "mpm/math/tensor.hpp"
#include "mpm/schedule/weights.hpp"

namespace mpm {

/// The nodal fields around one cell, whose particles reach `count` nodes along an axis: the same
/// nodes for all of them, as cells are centred at the nodes (decision 0022). So particles can be
/// the lanes, and each number of a node is loaded once for all of them and repeated (decision
/// 0024).
template <int D, int count, int width = record>
class NodalField {
 public:
  /// `first`: the records from the first node in reach on, or halves of them.
  MPM_HD NodalField(const Nodes<width>& first, const NodeStrides<D>& stride)
      : first_(first), stride_(stride) {}

  /// The vector at number `at` of the records.
  template <int at, class T>
  MPM_HD Vec<T, D> vector(const Weights<T, D, count>& w) const {
    Vec<T, D> total = Vec<T, D>::zero();
    for_each_row([&](auto y, auto z, const Nodes<width>& row) MPM_INLINE {
      // Along x first: N_y N_z is then multiplied in once a row, not at every node. Rows come y
      // within z in all instances, so that the sum has one order.
      T share = w.axis[1].N[y];
      if constexpr (D == 3) share *= w.axis[D - 1].N[z];
      unrolled<D>([&](auto i) MPM_INLINE {
        total[i] = fma(share, along(row.at(at + i), w.axis[0].N), total[i]);
      });
    });
    return total;
  }

  /// The number at place `at` of the records.
  template <int at, class T>
  MPM_HD T value(const Weights<T, D, count>& w) const {
    return sum_of<T>(w, [](const double* record) { return record[at]; });
  }
  /// Half the square of the vector at `after` less that of itself without its change, the vector at
  /// `change`: what a node's kinetic energy over its mass has gained.
  template <int after, int change, class T>
  MPM_HD T gain(const Weights<T, D, count>& w) const {
    return sum_of<T>(w, [](const double* record) {
      double gained = 0.0;
      for (int a = 0; a < D; ++a)
        gained = fma(record[change + a], fma(-0.5, record[change + a], record[after + a]), gained);
      return gained;
    });
  }
  /// The square of the vector at number `at`.
  template <int at, class T>
  MPM_HD T square(const Weights<T, D, count>& w) const {
    return sum_of<T>(w, [](const double* record) {
      double square = 0.0;
      for (int a = 0; a < D; ++a) square = fma(record[at + a], record[at + a], square);
      return square;
    });
  }

  /// Derivatives of that vector with respect to xi: [i][j] of component i along axis j.
  template <int at, class T>
  MPM_HD std::array<Vec<T, D>, D> gradients(const Weights<T, D, count>& w) const {
    std::array<Vec<T, D>, D> g;
    sum_gradients<at>(w, g, [](auto, const T&, const T&) MPM_INLINE {});
    return g;
  }
  /// The vector as well.
  template <int at, class T>
  MPM_HD std::array<Vec<T, D>, D> value_and_gradients(const Weights<T, D, count>& w,
                                                      Vec<T, D>& total) const {
    std::array<Vec<T, D>, D> g;
    total = Vec<T, D>::zero();
    sum_gradients<at>(w, g, [&](auto i, const T& N, const T& value) MPM_INLINE {
      total[i] = fma(N, value, total[i]);
    });
    return g;
  }

  /// The vector at number `at` of the records, and its first moments sum N_i f_i (x_i - x) [cells]:
  /// [i][j] of component i along axis j.
  template <int at, class T>
  MPM_HD void value_and_moments(const Weights<T, D, count>& w, const Moments<T, D, count>& M,
                                Vec<T, D>& total, Mat<T, D>& moments) const {
    total = Vec<T, D>::zero();
    for (auto& row : moments.c)
      for (T& each : row) each = T(0.0);
    // As gradients, with M in place of dN; the sums along x with N serve the value too.
    for_each_row([&](auto y, auto z, const Nodes<width>& row) MPM_INLINE {
      T N = w.axis[1].N[y], My = M.axis[1][y], Mz(0.0);
      if constexpr (D == 3) {
        Mz = N * M.axis[D - 1][z];
        N *= w.axis[D - 1].N[z];
        My *= w.axis[D - 1].N[z];
      }
      unrolled<D>([&](auto i) MPM_INLINE {
        const T value = along(row.at(at + i), w.axis[0].N);
        total[i] = fma(N, value, total[i]);
        moments[i][0] = fma(N, along(row.at(at + i), M.axis[0]), moments[i][0]);
        moments[i][1] = fma(My, value, moments[i][1]);
        if constexpr (D == 3) moments[i][2] = fma(Mz, value, moments[i][2]);
      });
    });
  }

 private:
  /// Derivatives along the axes, and f(i, N, sum along x of component i) for each row of nodes.
  template <int at, class T, class F>
  MPM_HD MPM_INLINE void sum_gradients(const Weights<T, D, count>& w, std::array<Vec<T, D>, D>& g,
                                       F&& f) const {
    g.fill(Vec<T, D>::zero());
    for_each_row([&](auto y, auto z, const Nodes<width>& row) MPM_INLINE {
      // d/dx, d/dy, d/dz of N_x N_y N_z: of each row two sums along x are enough, with N and with
      // dN, as the other factors are one for the row. 270 operations in 3D and 48 in 2D for all
      // particles in the lanes (decision 0024).
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
        f(i, N, value);
        if constexpr (D == 3) g[i][2] = fma(dz, value, g[i][2]);
      });
    });
  }
  /// sum N_i f(record of the node).
  template <class T, class F>
  MPM_HD T sum_of(const Weights<T, D, count>& w, F&& f) const {
    T total(0.0);
    for_each_row([&](auto y, auto z, const Nodes<width>& row) MPM_INLINE {
      T share = w.axis[1].N[y];
      if constexpr (D == 3) share *= w.axis[D - 1].N[z];
      T along_x = w.axis[0].N[0] * T(f(row[0]));
      unrolled<count - 1>(
          [&](auto k) MPM_INLINE { along_x = fma(w.axis[0].N[k + 1], T(f(row[k + 1])), along_x); });
      total = fma(share, along_x, total);
    });
    return total;
  }
  /// f(y, z, records) for the rows of nodes along x; one layer in 2D.
  template <class F>
  MPM_HD MPM_INLINE void for_each_row(F&& f) const {
    unrolled<D == 3 ? count : 1>([&](auto z) MPM_INLINE {
      unrolled<count>([&](auto y) MPM_INLINE { f(y, z, first_.from(stride_.to(0, y, z))); });
    });
  }
  /// Of a row, whose records begin at the number that is wanted: the sum with factors along x. It
  /// begins with a product: 0 + a b would be an addition that the compiler must keep.
  template <class T>
  MPM_HD MPM_INLINE static T along(const Nodes<width>& row, const T* x) {
    T sum = x[0] * T(*row[0]);
    unrolled<count - 1>([&](auto k) MPM_INLINE { sum = fma(x[k + 1], T(*row[k + 1]), sum); });
    return sum;
  }

  Nodes<width> first_;
  NodeStrides<D> stride_;
};

}  // namespace mpm
