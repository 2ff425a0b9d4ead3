#pragma once
// One material point driven through given velocity gradients: to check a material by itself.
#include <span>
#include <string>
#include <vector>

#include "mpm/materials/material.hpp"

namespace mpm {

/// What a driven point went through, (steps + 1) rows of `names.size()` values: Cauchy stress [Pa]
/// xx yy zz yz xz xy, relative volume, the work per initial volume dissipated by flow and done in
/// all [J/m^3], the speed of sound [m/s], and the columns of its material's state.
struct DrivenPoint {
  std::vector<std::string> names;
  std::vector<double> values;
};

/// A point that starts at rest and undergoes `increments` (steps, 3, 3): velocity gradient x time
/// step. With `lanes` the SIMD instance computes it, else the scalar one. Throws
/// std::invalid_argument as make_material does.
DrivenPoint drive_material(const MaterialChoice& choice, std::span<const double> increments,
                           double time_step, bool lanes);

}  // namespace mpm
