#pragma once
// One material point driven through given velocity gradients: to check a material by itself.
#include <map>
#include <span>
#include <string>
#include <vector>

#include "mpm/materials/material_block.hpp"

namespace mpm {

/// What is done with a point.
struct Drive {
  std::span<const double> increments;  // (steps, 3, 3): velocity gradient x time step
  double time_step = 0.0;              // [s]; the first step begins at the time 0
  double cell_size = 0.0;  // [m], of detonation fronts, viscous fluids and artificial viscosity
  /// Values at the start by the names of a driven point's columns: stress, volume and its
  /// material's state. The others are those of a point at rest.
  std::map<std::string, double> state{};
  bool lanes = false;  // the SIMD instance computes it, else the scalar one
};

/// What a driven point went through, (steps + 1) rows of `names.size()` values: Cauchy stress [Pa]
/// xx yy zz yz xz xy, relative volume, the columns of its material's state, the speed of sound
/// [m/s], and since the start, per initial volume [J/m^3], the work of the stress, the part of it
/// that flow has dissipated, and with viscosity its work, `viscous`.
struct DrivenPoint {
  std::vector<std::string> names, units;
  std::vector<double> values;
};

/// Throws std::invalid_argument, in one sentence, as make_material does, and for a number of
/// `drive` that makes no sense.
DrivenPoint drive_material(const MaterialChoice& choice, const Drive& drive);

}  // namespace mpm
