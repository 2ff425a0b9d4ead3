#pragma once
// What the host makes of a step on a device, by its own stages: contact, bodies that do not deform,
// of which the device knows nothing, loads, body forces and absorbing walls. It has the places and
// volumes of the particles, and the nodes where any of that happens.
#include <chrono>

#include "mpm/device/node_traffic.hpp"

namespace mpm {

/// What the host has taken within a device's steps so far [s].
struct HostSeconds {
  double particles = 0.0;  // to be given their places
  double lists = 0.0;      // to update its lists by them, while the device maps particles
  double stages = 0.0;
};

/// Make the host's lists for the particles as they are: contact looks at them, and particles are
/// taken out by them. Their columns keep the order in which the device was given them.
template <int D>
void update_lists(Domain<D>& domain);

/// Of the sums of a step leave those of some patches, which are told of.
template <int D>
void leave_sums(Domain<D>& domain, const std::vector<std::uint32_t>& patches);

/// work(), and add the seconds that it takes.
template <class F>
void add_seconds(double& to, F&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  to += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <int D>
class HostPart : public HostStages {
 public:
  HostPart(DeviceRun<D>& run, Domain<D>& domain, HostSeconds& seconds, bool releases)
      : domain_(domain), seconds_(seconds), nodes_(run, domain), releases_(releases) {}

  /// Does a domain have anything for the host?
  static bool needed(const Domain<D>& domain) {
    return domain.has_contact() || has_loads(domain) || domain.has_rigid() ||
           domain.has_prescribed() || domain.grid.walls.absorb();
  }
  static bool has_loads(const Domain<D>& domain) {
    return domain.has_loads() || domain.has_body_forces();
  }

  /// Its lists and what follows from them alone are made when the device first comes to a stage of
  /// the host, so that it maps particles meanwhile.
  void expect_step() { begun_ = false; }
  bool wants(NodeMoment moment) const override;
  void with_nodes(NodeMoment moment) override;
  void end_step();

 private:
  void begin_step();
  void make_stages(NodeMoment moment);
  /// stage(domain), of the patches of bodies that do not deform alone.
  void of_rigid(void (*stage)(Domain<D>&));
  void start_dashpots();
  void make_velocities();
  void make_forces();
  void advance_rigid();
  /// The pieces of loads go along with the surface, by the vector at number `at` of the records.
  template <int at>
  void carry(double duration);
  void add_works();
  void add_work_of_dashpots(std::uint32_t patch);

  Domain<D>& domain_;
  HostSeconds& seconds_;
  NodeTraffic<D> nodes_;
  bool begun_ = false;  // the lists are those of the step
  bool releases_;       // particles take the velocity of the grid, without contact's correction
};

}  // namespace mpm
