#pragma once
// The nodes that a device and the host exchange in the midst of a step.
#include <vector>

#include "mpm/device/device_run.hpp"
#include "mpm/domain.hpp"

namespace mpm {

/// Halves of a node's record: mass and velocity; force, increment, or remapped velocity.
inline constexpr int first_half = 0, second_half = 1;

/// How bodies share a step: the device has those that deform.
template <int D>
bool is_on_device(const Body<D>& body) {
  return body.deforms();
}

/// Do loads or a body force act on a patch's body?
template <int D>
bool is_loaded(const Domain<D>& domain, const Patch<D>& patch);

template <int D>
class NodeTraffic {
 public:
  NodeTraffic(DeviceRun<D>& run, Domain<D>& domain) : run_(run), domain_(domain) {}

  /// Those where bodies may meet, at walls that absorb, and of bodies that are loaded; once the
  /// lists are those of the step.
  void choose();
  const std::vector<std::uint32_t>& wanted() const { return wanted_.patches; }
  const std::vector<std::uint32_t>& loaded() const { return loaded_.patches; }

  /// A half of the records of all wanted nodes, from the device to the blocks of their patches, and
  /// back.
  void read(int half) { take(wanted_, run_.read_nodes(half), half); }
  void wait() { run_.wait(); }
  void write(int half) {
    give(wanted_, run_.nodes_of_host(half), half);
    run_.write_nodes(half);
  }
  /// The same of the forces of loaded bodies before they are summed.
  void read_mapped() { take(loaded_, run_.read_mapped(), second_half); }
  void write_mapped() {
    give(loaded_, run_.mapped_of_host(), second_half);
    run_.write_mapped();
  }

 private:
  struct Nodes {
    std::vector<std::uint32_t> patches;
    std::vector<NodeBlockPlace<D>> places;
    std::uint32_t count = 0;
  };
  void add(Nodes& nodes, std::uint32_t patch);
  /// f(a half of a node's record, its place among those that are exchanged).
  template <class F>
  void for_each(const Nodes& nodes, int half, F&& f);
  void take(const Nodes& nodes, const double* from, int half);
  void give(const Nodes& nodes, double* to, int half);

  DeviceRun<D>& run_;
  Domain<D>& domain_;
  Nodes wanted_, loaded_;
};

}  // namespace mpm
