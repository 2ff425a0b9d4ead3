#pragma once
// Everything a step works on. Data, no behaviour.
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "mpm/contact/contact.hpp"
#include "mpm/followers/followers.hpp"
#include "mpm/grid/tile_grid.hpp"
#include "mpm/ledger/ledger.hpp"
#include "mpm/ledger/part_energies.hpp"
#include "mpm/loads/body_force.hpp"
#include "mpm/loads/damping.hpp"
#include "mpm/loads/surface_load.hpp"
#include "mpm/materials/material_block.hpp"
#include "mpm/parallel/threads.hpp"
#include "mpm/particles/cell_lists.hpp"
#include "mpm/particles/kept_spin.hpp"
#include "mpm/rigid/rigid_motion.hpp"
#include "mpm/surfaces/surfaces.hpp"
#include "mpm/walls/face_impulses.hpp"

namespace mpm {

/// Which transfer: its place in `Transfers` (step/transfer/transfer.hpp).
enum class TransferId : std::uint8_t {};

/// The time at which loads and motions are taken [s]: a run that settles does so before 0.
inline double load_time(double time) { return std::max(time, 0.0); }

template <int D>
struct Domain {
  TileGrid<D> grid;
  std::vector<Body<D>> bodies;
  std::vector<Material> materials;
  std::vector<ParticlePool<D>> pools;     // one per material
  std::vector<std::size_t> prescribed;    // numbers of the bodies of which the motion is
  std::vector<std::size_t> rigid_bodies;  // of those that are rigid and free to move
  std::vector<std::size_t> group_of;      // of each body, the number of its group among the groups
  ContactSettings contact_settings;
  Contact<D> contact;
  Surfaces<D> surfaces;
  std::array<TimeFunction, 3> gravity_of_time{};    // [m/s^2]
  Vec<double, D> gravity = Vec<double, D>::zero();  // mean over the step being made [m/s^2]
  Threads threads;

  double disorder = disorder_that_pays;  // share of a body's particles at which it is sorted
  std::int64_t balance_every = 20;       // steps after which costs of ranks are compared ...
  double imbalance_limit = 1.05;         // ... and evened out above this, the largest over the mean
  TransferId transfer{};
  // Of the velocity, in "flip" and "aflip"; the rest is the grid's.
  double flip_share = 1.0, flip_share_of_gases = 1.0;
  double pic_rate = 0.0;  // at which particles take over the velocity of the grid [1/s]

  int filter_order = 1;             // how often velocities are mapped to the grid and back ...
  double short_wave_damping = 0.0;  // of bodies on nodes of their own [c / h]
  std::int64_t filter_every = 1;    // ... in each step whose number this divides

  double time = 0.0;         // [s]
  double time_after = 0.0;   // of the step being made [s]
  double time_step = 0.0;    // of the step being made [s]
  double step_before = 0.0;  // the one before [s]; 0 in the first
  // By which nodes in bodies are shifted as steps change, (M5), in this one and the one before
  // [s^2].
  double shift = 0.0, shift_before = 0.0;
  std::int64_t step = 0;      // steps made
  std::int64_t renewals = 0;  // of nodes of all bodies (run/renew_reference.hpp)

  std::vector<PatchSums<D>> sums;  // one per patch; with a device those of its bodies, and others
  std::vector<NodeWork> work_of_nodes;  // scratch: of each patch
  std::vector<int> sums_of;             // with a device, of which body each is; else empty
  // What walls have done to rigid bodies as a whole in the step, alike on all ranks [N m s; N s].
  Vector3 rigid_at_walls = Vector3::zero();
  FaceImpulses<D> rigid_at_faces;
  std::vector<FaceImpulses<D>> face_parts;  // of the step, one per patch; without a box none
  FaceSums<D> faces_in_step, faces;         // of the last step, and so far; of this rank
  ContactSums contact_sums;                 // of the step
  Ledger ledger;
  std::vector<PartEnergies> part_energies;  // one per group
  ListScratch<D> list_scratch;
  Removed eroded, outflow;  // by failure; out of the region that is kept
  std::vector<SurfaceLoad<D>> loads;
  std::vector<BodyForce<D>> body_forces;
  std::vector<Damping> dampings;           // of bodies' motion
  std::vector<Vec<double, D>> load_parts;  // scratch: force by patch and load [N]
  Followers<D> followers;                  // of the nodes of bodies on nodes of their own
  std::vector<KeptSpin> kept_spins;        // of these bodies, by body
  std::vector<SharedBody> shared_bodies;   // of these, by body
  std::vector<RigidMotion> rigid;          // one per entry of rigid_bodies
  std::vector<RigidMotion> rigid_before;
  std::vector<RigidSums> rigid_parts, rigid_sums;  // scratch: per patch, per rigid body
  std::vector<Matrix3> rigid_turns;

  /// A body by the number that a user gave; throws std::out_of_range.
  Body<D>& body_at(int number) { return bodies.at(static_cast<std::size_t>(number)); }
  const Body<D>& body_at(int number) const { return bodies.at(static_cast<std::size_t>(number)); }
  Body<D>& body_of(const Patch<D>& patch) { return bodies[static_cast<std::size_t>(patch.body)]; }
  const Body<D>& body_of(const Patch<D>& patch) const {
    return bodies[static_cast<std::size_t>(patch.body)];
  }
  ParticlePool<D>& pool_of(const Body<D>& b) { return pools[static_cast<std::size_t>(b.material)]; }
  const ParticlePool<D>& pool_of(const Body<D>& b) const {
    return pools[static_cast<std::size_t>(b.material)];
  }
  ParticlePool<D>& pool_of(const Patch<D>& patch) { return pool_of(body_of(patch)); }
  const ParticlePool<D>& pool_of(const Patch<D>& patch) const { return pool_of(body_of(patch)); }
  const Material& material_of(const Patch<D>& patch) const {
    return materials[static_cast<std::size_t>(body_of(patch).material)];
  }
  bool averages_volume() const {
    return std::any_of(materials.begin(), materials.end(),
                       [](const Material& m) { return m.averages_volume; });
  }
  /// That of a patch's body in the step being made; none if it has none.
  StepDamping damping_of(const Patch<D>& patch) const {
    return dampings.empty() ? StepDamping{} : damping_in(dampings, body_of(patch).damping);
  }
  /// Does the run settle, under the loads of the time 0, before that?
  bool settles() const { return time < 0.0; }
  bool has_rigid() const { return !rigid_bodies.empty(); }
  bool has_prescribed() const { return !prescribed.empty(); }
  bool has_loads() const { return !loads.empty(); }
  bool has_body_forces() const { return !body_forces.empty(); }
  /// Do bodies meet at nodes?
  bool has_contact() const {
    return contact_settings.enabled && !contact_settings.bonded && bodies.size() > 1 &&
           !(surfaces.meet && surfaces.pressed_by < 2);
  }
  bool has_springs() const { return has_contact() && may_spring(contact_settings.response); }
  /// f(pool, row) for the particles that take part, in the order of the lists.
  template <class F>
  void for_each_particle(F&& f) const {
    for (const Patch<D>& patch : grid.patches) {
      const ParticlePool<D>& pool = pool_of(patch);
      for (const std::uint32_t row : pool.rows(patch)) f(pool, row);
    }
  }
};

/// Are there bodies on nodes of their own (step/kept_nodes.hpp)?
template <int D>
bool has_kept_nodes(const Domain<D>& domain) {
  return std::ranges::any_of(domain.bodies, &Body<D>::keeps_nodes);
}

/// The body that the sums with a number are of.
template <int D>
std::size_t body_of_sums(const Domain<D>& domain, std::size_t k) {
  return static_cast<std::size_t>(domain.sums_of.empty() ? domain.grid.patches[k].body
                                                         : domain.sums_of[k]);
}

/// List the bodies that do not deform, and number the groups in the order of their first bodies;
/// kinds and groups stay as they are from here on.
template <int D>
void list_kinds(Domain<D>& domain) {
  for (std::size_t b = 0; b < domain.bodies.size(); ++b) {
    Body<D>& body = domain.bodies[b];
    if (body.is_prescribed()) domain.prescribed.push_back(b);
    if (!body.is_free_rigid()) continue;
    body.rigid = static_cast<int>(domain.rigid_bodies.size());
    domain.rigid_bodies.push_back(b);
  }
  domain.rigid.resize(domain.rigid_bodies.size());
  domain.group_of.resize(domain.bodies.size());
  std::size_t count = 0;
  for (std::size_t b = 0; b < domain.bodies.size(); ++b) {
    const auto first = static_cast<std::size_t>(domain.bodies[b].group);
    domain.group_of[b] = first == b ? count++ : domain.group_of[first];
  }
  domain.part_energies.resize(count);
}

}  // namespace mpm
