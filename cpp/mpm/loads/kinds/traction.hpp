#pragma once
#include <string_view>

#include "mpm/math/vec.hpp"

namespace mpm {

/// In a direction of its own: f = t |a|.
struct Traction {
  static constexpr std::string_view name = "traction";
  static constexpr std::string_view doc =
      "force per present area in a fixed direction [Pa], D numbers or functions of time";
  static constexpr std::string_view unit = "Pa";
  static constexpr bool is_vector = true;

  // By the size: over an edge tractions of one direction add up, where area vectors cancel in part.
  template <int D>
  static Vec<double, D> force(const Vec<double, D>& value, const Vec<double, D>&, double size) {
    return size * value;
  }
};

}  // namespace mpm
