#pragma once
// Gather by particles in lanes, for a basis of two nodes along an axis.
#include <algorithm>
#include <array>

#include "mpm/layout/node_records.hpp"
#include "mpm/schedule/weights.hpp"

namespace mpm {

/// The nodal fields on one cell as polynomials: two functions that sum to one and carry the
/// position are 1 - xi and xi, so f = sum over corners k of c_k xi^(bits of k). Particles in the
/// lanes evaluate them, and their gradients, by Horner's rule without touching the nodes again: 7
/// multiply-adds for a value in 3D. All fields of a record are made at once, those not asked for
/// too, as they come in the same registers: 8 loads and 12 subtractions of whole records (decision
/// 0016).
template <int D>
class MultilinearField {
 public:
  /// `own`: the records from the cell's own node on.
  MultilinearField(const NodeRecords& own, const NodeStrides<D>& stride) {
    unrolled<parts>([&](auto part) {
      auto& f = c_[part];
      unrolled<corners>([&](auto k) {
        f[k] = Part::load(own[stride.to(k & 1, k >> 1 & 1, k >> 2)] + part * Part::lanes);
      });
      // f_0 (1 - xi) + f_1 xi = f_0 + (f_1 - f_0) xi: along each axis in turn the corner before is
      // taken from the one behind, and after the last axis f[k] is c_k. In place, for an axis
      // changes only corners that it does not read.
      unrolled<D>([&](auto a) {
        unrolled<corners>([&](auto k) {
          if constexpr ((k >> a & 1) != 0) f[k] -= f[k ^ 1 << a];
        });
      });
    });
  }

  /// The vector at number `at` of the records.
  template <int at, class T>
  MPM_INLINE Vec<T, D> vector(const Weights<T, D, 2>& w) const {
    Vec<T, D> v;
    unrolled<D>([&](auto i) MPM_INLINE { v[i] = value<at + i>(w); });
    return v;
  }
  /// Derivatives of that vector with respect to xi (divide by the cell size for the gradient in
  /// space): [i][j] of component i along axis j.
  template <int at, class T>
  MPM_INLINE std::array<Vec<T, D>, D> gradients(const Weights<T, D, 2>& w) const {
    std::array<Vec<T, D>, D> g;
    unrolled<D>([&](auto i) MPM_INLINE { g[i] = gradient<at + i>(w); });
    return g;
  }

 private:
  using Part = Batch<std::min(native_lanes, record)>;  // of a record
  static constexpr int corners = 1 << D, parts = record / Part::lanes;

  /// c_k of number f, repeated in all lanes as it is loaded: the coefficients of a cell, 512 bytes
  /// in 3D, stay in the first cache and take no registers.
  template <int f, class T>
  MPM_INLINE T coefficient(int k) const {
    return T(c_[f / Part::lanes][k][f % Part::lanes]);
  }
  /// c_k + c_l x, of number f.
  template <int f, class T>
  MPM_INLINE T line(int k, int l, T x) const {
    return fma(coefficient<f, T>(l), x, coefficient<f, T>(k));
  }
  template <int f, class T>
  MPM_INLINE T value(const Weights<T, D, 2>& w) const {
    // x within y within z, each step rounded once: f = (c_0 + c_1 x + y (c_2 + c_3 x)) + z (the
    // same with c_4 to c_7). The order is written out and no compiler's (decision 0033).
    const auto bilinear = [&](int k) MPM_INLINE {
      return fma(w.xi[1], line<f>(k + 2, k + 3, w.xi[0]), line<f>(k, k + 1, w.xi[0]));
    };
    if constexpr (D == 2)
      return bilinear(0);
    else
      return fma(w.xi[2], bilinear(4), bilinear(0));
  }
  template <int f, class T>
  MPM_INLINE Vec<T, D> gradient(const Weights<T, D, 2>& w) const {
    if constexpr (D == 2) {
      // Of c_0 + c_1 x + c_2 y + c_3 x y: (c_1 + c_3 y, c_2 + c_3 x).
      return {line<f>(1, 3, w.xi[1]), line<f>(2, 3, w.xi[0])};
    } else {
      // Along x only the c_k with its bit are left, without it: c_1 + c_3 y + z (c_5 + c_7 y), and
      // so for the others. Nine multiply-adds for a gradient.
      const T x = fma(w.xi[2], line<f>(5, 7, w.xi[1]), line<f>(1, 3, w.xi[1]));
      const T y = fma(w.xi[2], line<f>(6, 7, w.xi[0]), line<f>(2, 3, w.xi[0]));
      const T z = fma(w.xi[1], line<f>(6, 7, w.xi[0]), line<f>(4, 5, w.xi[0]));
      return {x, y, z};
    }
  }

  Part c_[parts][corners];  // c_k of all numbers of a record
};

}  // namespace mpm
