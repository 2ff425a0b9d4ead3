#pragma once
// What kernels know of bodies, and what they add up of them for the ledger.

namespace mpm {

struct DeviceBody {
  int pool = 0;
  double edge = 0.0;  // of its particles at the start [cells]
};

/// Sums over the particles or nodes of a body in a step, by place in DeviceReport::sums.
struct DeviceSum {
  enum Place {
    // Of nodes.
    work,
    gravity_first,
    gravity_second,
    mass_moment,              // 3
    walls = mass_moment + 3,  // 3
    mapped = walls + 3,       // 3
    faces = mapped + 3,       // 2 x 3 x 3: [axis][side][component]
    damping_first = faces + 18,
    damping_second,
    damping_moment,  // 3
    of_nodes = damping_moment + 3,
    // Of particles.
    kinetic = of_nodes,
    second_order,
    transferred,
    carried,
    momentum,  // 3
    internal = momentum + 3,
    plastic,
    viscous,
    damped,
    bounded,
    energy_floor,
    fracture,
    force_power,
    count
  };
};

}  // namespace mpm
