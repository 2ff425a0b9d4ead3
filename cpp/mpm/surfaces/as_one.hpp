#pragma once
// Contact points of bodies that do not deform: they go with their body, and what acts on them acts
// on it as a whole.
#include "mpm/domain.hpp"

namespace mpm {

/// How such a body moves, at the end of a step; of one on nodes of its own, whose turning is known,
/// the rigid part.
template <int D>
RigidMotion motion_as_one(const Domain<D>& domain, int number) {
  const Body<D>& body = domain.body_at(number);
  if (body.is_prescribed()) return body.motion->now;
  if (!body.keeps_nodes()) return domain.rigid[static_cast<std::size_t>(body.rigid)];
  const KeptSpin& turning =
      *std::ranges::lower_bound(domain.kept_spins, number, {}, &KeptSpin::body);
  RigidMotion motion;
  motion.centre = turning.centre + domain.time_step * turning.velocity;
  motion.velocity = turning.velocity;
  motion.spin = turning.spin;
  return motion;
}

/// What acts on a body; of those that are sorted by body.
inline ActingOnBody& acting_on_body(std::vector<ActingOnBody>& all, int body) {
  auto at = std::ranges::lower_bound(all, body, {}, &ActingOnBody::body);
  if (at == all.end() || at->body != body) {
    ActingOnBody none;
    none.body = body;
    at = all.insert(at, none);
  }
  return *at;
}

/// Where what acts on bodies as wholes is counted, by who has the first part that lies in a patch:
/// nowhere on other ranks.
template <int D>
PatchSums<D>* sums_as_one(Domain<D>& domain) {
  const auto& parts = domain.surfaces.parts;
  const auto first = std::ranges::find(parts, false, &SurfacePart<D>::as_one);
  return first == parts.end() || first->foreign ? nullptr : &domain.sums[first->patch];
}

/// Take the points along with their bodies, which have moved.
template <int D>
void move_points_as_one(Domain<D>& domain);

/// The work of contact in the step, half by what acted from its start on, and half by what acts at
/// its end.
template <int D>
void add_work_as_one(Domain<D>& domain, bool at_end);

}  // namespace mpm
