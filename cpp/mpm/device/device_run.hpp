#pragma once
// What the core and the code for a device say to each other. Plain data and one abstract class: the
// device's code is a shared object of its own, compiled by another compiler that knows no vectors,
// so that nothing that both compile may be linked together (decision 0057).
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mpm/fields/columns.hpp"
#include "mpm/grid/geometry.hpp"
#include "mpm/materials/material.hpp"
#include "mpm/materials/material_block.hpp"

namespace mpm {

/// Raised whenever what follows changes.
inline constexpr int device_version = 2;

/// The transfer of a step (step/transfer/transfer.hpp).
enum class DeviceTransfer { flip, flip_pic, aflip };

/// The columns of one material's particles, in the host's memory.
struct DevicePool {
  const Material* material = nullptr;
  Columns* columns = nullptr;
  MaterialColumns at{};
  int position = 0, affine = -1;        // first components
  const std::uint32_t* id = nullptr;    // of each row, its number in its body
  const std::uint32_t* body = nullptr;  // of each row, the number of its body; `no_body`: of none
  static constexpr std::uint32_t no_body = ~std::uint32_t{0};
};

struct DeviceBody {
  int pool = 0;
  double edge = 0.0;  // of its particles at the start [cells]
};

/// A run, as it begins on a device.
template <int D>
struct DeviceProblem {
  GridGeometry<D> grid;
  bool stress_first = false;  // USF, else MUSL
  double disorder = 0.0;      // share of jumps in the order of rows at which columns are sorted
  std::vector<DevicePool> pools;
  std::vector<DeviceBody> bodies;  // by number
};

/// A step to be made.
template <int D>
struct DeviceStep {
  double time_step = 0.0, strain_time = 0.0;  // over which the velocities strain (USF) [s]
  double time_after = 0.0;                    // [s]
  Vec<double, D> gravity = Vec<double, D>::zero();
  DeviceTransfer transfer = DeviceTransfer::flip;
  bool takes_of_grid = false;  // do particles take the velocity of the grid anywhere?
  bool look = false;           // count particles that somebody should look at
  // Of each pool, the number that its transfer is made with, and the share of the grid's velocity
  // in that which its particles take.
  std::vector<double> share, grid_share;
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
    of_nodes = faces + 18,
    // Of particles.
    kinetic = of_nodes,
    second_order,
    transferred,
    momentum,  // 3
    internal = momentum + 3,
    plastic,
    viscous,
    damped,
    bounded,
    energy_floor,
    force_power,
    count
  };
};

/// What a step has done.
struct DeviceReport {
  std::vector<double> sums;     // [body][DeviceSum]
  std::vector<double> fastest;  // of each body, largest c + |v| [m/s]
  bool negative_volume = false;
  std::int64_t odd = 0;  // particles that somebody should look at: volume, place
  std::size_t patches = 0, node_tiles = 0;
};

/// How long a kernel took in the steps since the last time it was asked [ms].
struct DeviceTime {
  std::string name;
  double milliseconds = 0.0;
};

/// A run on a device. Errors are std::runtime_error in one sentence.
template <int D>
class DeviceRun {
 public:
  virtual ~DeviceRun() = default;
  /// Make a step.
  virtual void step(const DeviceStep<D>& step, DeviceReport& report) = 0;
  /// Give the particles' columns back to the host, rows as they were there.
  virtual void give_back(std::vector<DevicePool>& pools) = 0;
  virtual std::size_t bytes() const = 0;        // of the device's memory
  virtual std::vector<DeviceTime> times() = 0;  // by kernel; makes steps slower once asked
};

/// A device, as users see it.
struct DeviceInfo {
  std::string name;
  std::size_t bytes = 0, free_bytes = 0;
  double bandwidth = 0.0;       // [B/s]
  double fma_per_second = 0.0;  // of doubles
};

}  // namespace mpm

extern "C" {
/// Of the device's shared object; the version is that of these headers.
int mpm_device_version();
/// Empty name: there is none, and `why` says why.
void mpm_device_info(mpm::DeviceInfo& info, std::string& why);
mpm::DeviceRun<2>* mpm_device_run_2(const mpm::DeviceProblem<2>& problem);
mpm::DeviceRun<3>* mpm_device_run_3(const mpm::DeviceProblem<3>& problem);
}
