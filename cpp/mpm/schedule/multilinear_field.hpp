#pragma once
// Gather by particles in lanes, for a basis of two nodes along an axis.
#include <algorithm>
#include <array>

#include "mpm/layout/node_records.hpp"
#include "mpm/schedule/weights.hpp"

namespace mpm {

/// The nodal fields on one cell as polynomials: two functions that sum to one and carry the
/// position are 1 - xi and xi, so f = sum over corners k of c_k xi^(bits of k). Particles in the
/// lanes evaluate them, and their gradients, by Horner's rule without touching the nodes again. All
/// fields of a record are made at once.
template <int D>
class MultilinearField {
 public:
  /// `own`: the records from the cell's own node on.
  MultilinearField(const NodeRecords& own, const NodeStrides<D>& stride) {
    constexpr int W = std::min(native_lanes, record);
    for (int at = 0; at < record; at += W) {
      Batch<W> f[corners];
      unrolled<corners>(
          [&](auto k) { f[k] = Batch<W>::load(own[stride.to(k & 1, k >> 1 & 1, k >> 2)] + at); });
      unrolled<D>([&](auto a) {
        unrolled<corners>([&](auto k) {
          if constexpr ((k >> a & 1) != 0) f[k] -= f[k ^ 1 << a];
        });
      });
      unrolled<corners>([&](auto k) { f[k].store(c[k] + at); });
    }
  }

  /// The vector at number `at` of the records.
  template <class T>
  Vec<T, D> vector(int at, const Weights<T, D, 2>& w) const {
    Vec<T, D> v;
    for (int i = 0; i < D; ++i) v[i] = value(at + i, w);
    return v;
  }
  /// Derivatives of that vector with respect to xi (divide by the cell size for the gradient in
  /// space): [i][j] of component i along axis j.
  template <class T>
  std::array<Vec<T, D>, D> gradients(int at, const Weights<T, D, 2>& w) const {
    std::array<Vec<T, D>, D> g;
    for (int i = 0; i < D; ++i) g[static_cast<std::size_t>(i)] = gradient(at + i, w);
    return g;
  }

 private:
  static constexpr int corners = 1 << D;

  /// c_k + c_l x, of number f.
  template <class T>
  T line(int f, int k, int l, T x) const {
    return fma(T(c[l][f]), x, T(c[k][f]));
  }
  template <class T>
  T value(int f, const Weights<T, D, 2>& w) const {
    const auto bilinear = [&](int k) {
      return fma(w.xi[1], line(f, k + 2, k + 3, w.xi[0]), line(f, k, k + 1, w.xi[0]));
    };
    if constexpr (D == 2)
      return bilinear(0);
    else
      return fma(w.xi[2], bilinear(4), bilinear(0));
  }
  template <class T>
  Vec<T, D> gradient(int f, const Weights<T, D, 2>& w) const {
    if constexpr (D == 2) {
      return {line(f, 1, 3, w.xi[1]), line(f, 2, 3, w.xi[0])};
    } else {
      const T x = fma(w.xi[2], line(f, 5, 7, w.xi[1]), line(f, 1, 3, w.xi[1]));
      const T y = fma(w.xi[2], line(f, 6, 7, w.xi[0]), line(f, 2, 3, w.xi[0]));
      const T z = fma(w.xi[1], line(f, 6, 7, w.xi[0]), line(f, 4, 5, w.xi[0]));
      return {x, y, z};
    }
  }

  alignas(record * sizeof(double)) double c[corners][record];
};

}  // namespace mpm
