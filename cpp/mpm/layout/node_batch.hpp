#pragma once
// Lanes over nodes: values of the nodes that a particle reaches, x fastest, in as many registers as
// they take, so that what the particles of a cell give to them is summed in registers.
#include "mpm/math/batch.hpp"

namespace mpm {

template <int Count>
struct NodeBatch {
  static constexpr int width = Count < native_lanes ? Count : native_lanes;
  static constexpr int parts = Count / width;
  using Part = Batch<width>;
  Part part[parts];

  static NodeBatch zero() {
    NodeBatch r;
    for (auto& p : r.part) p = Part(0.0);
    return r;
  }
  friend NodeBatch operator*(double s, const NodeBatch& w) {
    NodeBatch r;
    for (int k = 0; k < parts; ++k) r.part[k] = Part(s) * w.part[k];
    return r;
  }
  NodeBatch& operator+=(const NodeBatch& w) {
    for (int k = 0; k < parts; ++k) part[k] += w.part[k];
    return *this;
  }
  /// this += s w
  void add(double s, const NodeBatch& w) {
    for (int k = 0; k < parts; ++k) part[k] = fma(Part(s), w.part[k], part[k]);
  }
};

/// f(k, half): of four values for each of W nodes, in a register each; `half`: the four of node k.
template <int W, class F>
[[gnu::always_inline]] inline void transpose_to_nodes(Batch<W> a, Batch<W> b, Batch<W> c,
                                                      Batch<W> d, F&& f) {
  const auto pairs = [](Batch<W> x, Batch<W> y, auto first) {
    return [&]<int... k>(std::integer_sequence<int, k...>) {
      return __builtin_shufflevector(x.v, y.v, ((k & ~1) + first + (k & 1 ? W : 0))...);
    }(std::make_integer_sequence<int, W>{});
  };
  const std::integral_constant<int, 0> even;
  const std::integral_constant<int, 1> odd;
  const auto ab_even = pairs(a, b, even), cd_even = pairs(c, d, even);
  const auto ab_odd = pairs(a, b, odd), cd_odd = pairs(c, d, odd);
  unrolled<W / 2>([&](auto k) {
    constexpr int i = 2 * k;
    f(i, Batch<4>(__builtin_shufflevector(ab_even, cd_even, i, i + 1, W + i, W + i + 1)));
    f(i + 1, Batch<4>(__builtin_shufflevector(ab_odd, cd_odd, i, i + 1, W + i, W + i + 1)));
  });
}

}  // namespace mpm
