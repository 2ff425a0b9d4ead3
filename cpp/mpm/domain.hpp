#pragma once
// Everything a step works on. Data, no behaviour.
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "mpm/contact/contact.hpp"
#include "mpm/grid/tile_grid.hpp"
#include "mpm/ledger/ledger.hpp"
#include "mpm/loads/surface_load.hpp"
#include "mpm/materials/material_block.hpp"
#include "mpm/parallel/threads.hpp"
#include "mpm/particles/lists.hpp"
#include "mpm/rigid/rigid_motion.hpp"

namespace mpm {

template <int D>
struct Domain {
  TileGrid<D> grid;
  std::vector<Body<D>> bodies;
  std::vector<Material> materials;
  ContactSettings contact_settings;
  Contact<D> contact;
  std::array<TimeFunction, 3> gravity_of_time{};    // [m/s^2]
  Vec<double, D> gravity = Vec<double, D>::zero();  // mean over the step being made [m/s^2]
  Threads threads;

  double disorder = disorder_that_pays;  // share of a body's particles at which it is sorted
  double pic_damping = 0.0;  // rate at which particles take over the velocity of the grid [1/s]

  double time = 0.0;        // [s]
  double time_after = 0.0;  // of the step being made [s]
  double time_step = 0.0;   // of the step being made [s]
  std::int64_t step = 0;    // steps made

  std::vector<PatchSums<D>> sums;  // one per patch
  ContactSums contact_sums;        // of the step
  Ledger ledger;
  ListScratch<D> list_scratch;
  Gone<D> eroded, left;  // by failure; out of the region that is kept
  std::vector<SurfaceLoad<D>> loads;
  std::vector<Vec<double, D>> load_parts;  // scratch: force by patch and load [N]
  std::vector<RigidMotion> rigid;  // one per body if any rigid one is free to move, else none
  std::vector<RigidMotion> rigid_before;
  std::vector<RigidSums> rigid_parts, rigid_sums;  // scratch: per patch, per body
  std::vector<Matrix3> rigid_turns;

  Body<D>& body_of(const Patch<D>& patch) { return bodies[static_cast<std::size_t>(patch.body)]; }
  bool has_rigid() const { return !rigid.empty(); }
  bool has_prescribed() const { return std::ranges::any_of(bodies, &Body<D>::is_prescribed); }
  bool has_loads() const { return !loads.empty(); }
  bool has_contact() const {
    return contact_settings.enabled && !contact_settings.bonded && bodies.size() > 1;
  }
};

}  // namespace mpm
