#pragma once
// What the core and the code for a device say to each other. Plain data and one abstract class: the
// device's code is a shared object of its own, compiled by another compiler that knows no vectors,
// so that nothing that both compile may be linked together (decision 0057).
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mpm/device/device_sums.hpp"
#include "mpm/fields/columns.hpp"
#include "mpm/grid/geometry.hpp"
#include "mpm/grid/outflow_box.hpp"
#include "mpm/loads/damped_node.hpp"
#include "mpm/materials/material.hpp"
#include "mpm/materials/material_block.hpp"

namespace mpm {

/// Raised whenever what follows changes.
inline constexpr int device_version = 3;

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
  bool is_there = true;                 // else the device needs none of its particles
  static constexpr std::uint32_t no_body = ~std::uint32_t{0};
};

/// A run, as it begins on a device.
template <int D>
struct DeviceProblem {
  GridGeometry<D> grid;
  OutflowBox<D> outflow_box;
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
  std::vector<StepDamping> damping;  // of each body's motion; empty: of none
  DeviceTransfer transfer = DeviceTransfer::flip;
  bool takes_of_grid = false;  // do particles take the velocity of the grid anywhere?
  bool look = false;           // count particles that somebody should look at
  // Of each pool, the number that its transfer is made with, and the share of the grid's velocity
  // in that which its particles take.
  std::vector<double> share, grid_share;
};

/// What a step has done.
struct DeviceReport {
  std::vector<double> sums;     // [body][DeviceSum]
  std::vector<double> fastest;  // of each body, largest c + |v| [m/s]
  bool negative_volume = false;
  std::int64_t odd = 0;  // particles that somebody should look at: volume, place
  bool gone = false;     // some particles take no part from the next step on
  std::size_t patches = 0, node_tiles = 0;
};

/// How long a kernel took in the steps since the last time it was asked [ms].
struct DeviceTime {
  std::string name;
  double milliseconds = 0.0;
};

/// When the host is called in the midst of a step, and what has been found of the nodes by then.
enum class NodeMoment {
  velocities,             // before the stress is updated (USF)
  mapped,                 // forces of each patch's particles, before they are summed
  forces,                 // before nodes are advanced (USF)
  velocities_and_forces,  // likewise (MUSL)
  advanced,               // velocities and increments
  released,  // they have been advanced: particles shall be with the velocities without contact's
             // correction (DeviceStep::takes_of_grid) ...
  restored,  // ... and move with the others
  remapped   // MUSL's velocities
};

/// The stages of a step that the host makes.
class HostStages {
 public:
  virtual ~HostStages() = default;
  virtual bool wants(NodeMoment moment) const = 0;
  virtual void with_nodes(NodeMoment moment) = 0;
};

/// A block of nodes of a patch, which the host wants: as many as `nodes` says along each axis, from
/// the `low`-th on, counted from the tile's first.
template <int D>
struct NodeBlockPlace {
  std::int32_t body;
  Index<D> tile, low, nodes;
  std::uint32_t first;  // of its nodes among those of all blocks
};

/// A run on a device. Errors are std::runtime_error in one sentence.
template <int D>
class DeviceRun {
 public:
  virtual ~DeviceRun() = default;
  /// Make a step, with stages of the host unless `host` is null.
  virtual void step(const DeviceStep<D>& step, HostStages* host, DeviceReport& report) = 0;
  /// A column of a pool's particles, rows as the host has them; until called again.
  virtual const double* read_column(std::size_t pool, int component) = 0;
  /// The nodes that are read and written from now on.
  virtual void choose_nodes(const std::vector<NodeBlockPlace<D>>& blocks) = 0;
  /// The first or second half of their records (layout/node_records.hpp), one behind another, as
  /// they are on the device, and memory for what is written back; null without nodes.
  virtual const double* read_nodes(int half) = 0;
  virtual double* nodes_of_host(int half) = 0;
  virtual void write_nodes(int half) = 0;
  /// Likewise the forces that the particles of some patches have given to the nodes of their own
  /// blocks.
  virtual void choose_mapped(const std::vector<NodeBlockPlace<D>>& blocks) = 0;
  virtual const double* read_mapped() = 0;
  virtual double* mapped_of_host() = 0;
  virtual void write_mapped() = 0;
  virtual void wait() = 0;                      // for all that has been started
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
