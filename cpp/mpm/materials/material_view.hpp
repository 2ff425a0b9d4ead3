#pragma once
// What the parts of a particle's way through its material know of it beside its models: plain
// numbers, which a host also hands to a device.
#include <type_traits>

#include "mpm/materials/material.hpp"

namespace mpm {

struct MaterialView {
  double density;  // initial [kg/m^3]
  BulkViscosity viscosity;
  StiffnessDamping damping;
  EosBounds bounds;
  bool has_eos;
  bool judged;        // by failure models
  bool burns, damps;  // as its strength model does
};
static_assert(std::is_trivially_copyable_v<MaterialView>);

inline MaterialView view_of(const Material& material) {
  return {material.density,         material.viscosity,         material.damping, material.bounds,
          material.eos.has_value(), !material.failures.empty(), material.burns(), material.damps()};
}

}  // namespace mpm
