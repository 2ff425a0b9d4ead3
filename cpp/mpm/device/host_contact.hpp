#pragma once
// Contact, which the host makes in the midst of a device's steps, by the stages of its own: it has
// the positions and volumes of the particles, and the nodes around the tiles where bodies may meet.
#include "mpm/device/device_run.hpp"
#include "mpm/domain.hpp"

namespace mpm {

template <int D>
class HostContact : public HostStages {
 public:
  HostContact(DeviceRun<D>& run, Domain<D>& domain) : run_(run), domain_(domain) {}

  /// Before a step: which nodes, once the lists are those of the step.
  void begin_step();
  void with_nodes(NodeMoment moment) override;

 private:
  void read(int half);
  void write(int half);

  DeviceRun<D>& run_;
  Domain<D>& domain_;
  std::vector<std::uint32_t> patches_;  // those of which the nodes are wanted
  std::vector<NodeBlockPlace<D>> places_;
};

}  // namespace mpm
