#pragma once
#include <string_view>

#include "mpm/math/vec.hpp"

namespace mpm {

/// Against the surface, wherever that turns: f = -p a.
struct Pressure {
  static constexpr std::string_view name = "pressure";
  static constexpr std::string_view doc =
      "against the surface, whose normals turn and whose area changes with the body [Pa]; a number "
      "or a function of time";
  static constexpr std::string_view unit = "Pa";
  static constexpr bool is_vector = false;

  // By the vector, as pressures add as vectors: those on a closed surface cancel.
  template <int D>
  static Vec<double, D> force(const Vec<double, D>& value, const Vec<double, D>& area, double) {
    return -value[0] * area;
  }
};

}  // namespace mpm
