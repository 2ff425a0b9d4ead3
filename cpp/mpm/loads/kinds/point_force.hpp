#pragma once
#include <string_view>

#include "mpm/math/vec.hpp"

namespace mpm {

/// At a point of the body: f = F times the share that the piece has, its size.
struct PointForce {
  static constexpr std::string_view name = "force";
  static constexpr std::string_view doc =
      "at a point, in a fixed direction, D numbers or functions of time [N; in 2D per metre of "
      "thickness]";
  static constexpr std::string_view unit = "N";
  static constexpr bool is_vector = true;
  static constexpr bool is_at_point = true;  // sizes of pieces are shares, and it has no area

  template <int D>
  static Vec<double, D> force(const Vec<double, D>& value, const Vec<double, D>&, double share) {
    return share * value;
  }
};

}  // namespace mpm
