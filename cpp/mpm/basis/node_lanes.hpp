#pragma once
// Lanes over nodes: values of the nodes that a particle reaches, x fastest, in as many registers as
// they take, so that what the particles of a cell give to them is summed in registers.
#include <array>

#include "mpm/math/batch.hpp"

namespace mpm {

template <int Count>
struct NodeLanes {
  static constexpr int count = Count;
  static constexpr int width = Count < native_lanes ? Count : native_lanes;
  static constexpr int parts = Count / width;
  using Part = Batch<width>;
  Part part[parts];

  static NodeLanes zero() {
    NodeLanes r;
    for (auto& p : r.part) p = Part(0.0);
    return r;
  }
  static NodeLanes load(const double* values) {
    NodeLanes r;
    for (int k = 0; k < parts; ++k) r.part[k] = Part::load(values + k * width);
    return r;
  }
  /// Four values, put together in registers: through memory they would stall.
  static NodeLanes of(double a, double b, double c, double d)
    requires(Count == 4)
  {
    NodeLanes r;
    if constexpr (parts == 1) {
      r.part[0] = Part(typename Part::Vector{a, b, c, d});
    } else {
      r.part[0] = Part(typename Part::Vector{a, b});
      r.part[1] = Part(typename Part::Vector{c, d});
    }
    return r;
  }
  void store(double* to) const {
    for (int k = 0; k < parts; ++k) part[k].store(to + k * width);
  }
  /// this += s * w
  void add(double s, const NodeLanes& w) {
    for (int k = 0; k < parts; ++k) part[k] += Part(s) * w.part[k];
  }
};

}  // namespace mpm
