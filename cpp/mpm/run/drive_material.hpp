#pragma once
// One material point driven through given velocity gradients: to check a model by itself.
#include <map>
#include <span>
#include <string>
#include <vector>

namespace mpm {

/// Cauchy stress [Pa] (steps + 1, 6) row by row, order xx yy zz yz xz xy, of a material point that
/// starts unstressed and undergoes `increments` (steps, 3, 3): velocity gradient x time step. With
/// `lanes` the SIMD instance computes it, else the scalar one. Throws std::invalid_argument as
/// make_material does.
std::vector<double> drive_material(double density, const std::string& strength,
                                   const std::map<std::string, double>& parameters,
                                   std::span<const double> increments, bool lanes);

}  // namespace mpm
