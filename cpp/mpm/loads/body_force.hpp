#pragma once
// A force per mass on all of a body, a formula of place and time; beside gravity.
#include <algorithm>
#include <array>
#include <cmath>

#include "mpm/math/expression.hpp"

namespace mpm {

/// [m/s^2], along each axis: of the present place x, y, z, of the place at the start X, Y, Z and of
/// the time t, which in a step is that of its middle. Or what the program has given each particle.
template <int D>
struct BodyForce {
  std::array<Expression, D> value;
  bool given = false;  // in the column of the particles

  bool is_of_start() const {
    return std::ranges::any_of(value, [](const Expression& one) {
      return one.is_of("X") || one.is_of("Y") || one.is_of("Z");
    });
  }
};

/// Does a force per mass [m/s^2] move a particle at rest by less than a cell in a step? One that is
/// not a number does not.
inline bool moves_within_cell(double force, double time_step, double cell_size) {
  return std::abs(force) * time_step * time_step < cell_size;
}

}  // namespace mpm
