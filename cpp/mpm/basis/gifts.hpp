#pragma once
// What particles give to the nodes around them.
#include "mpm/math/tensor.hpp"

namespace mpm {

/// What is scattered: a sum of these. Forces come with neither or with both of the others.
enum Gives : unsigned { gives_mass = 1, gives_momentum = 2, gives_forces = 4 };

/// Of some particles of a cell, one after another; as far as it is scattered.
template <int D, int room>
struct Gifts {
  double mass[room];                            // [kg]
  double velocity[D][room];                     // [m/s]
  double traction[Sym<double, D>::size][room];  // components of -V_p (sigma_p - q_p 1) / h [N]
};

}  // namespace mpm
