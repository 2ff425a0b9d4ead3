// The masses with which bodies that do not deform meet others at a node.
#include "mpm/contact/rigid_masses.hpp"

#include <algorithm>
#include <limits>

namespace mpm {
namespace {

/// Give bodies whose motion is prescribed the masses with which they meet the others at a node:
/// infinite ones, so that the reduced mass is that of the others; but where such a body has less
/// than a tenth of the others' volume at the node, in proportion, so that a node which it has only
/// just reached, inside the others, is not held.
template <int D>
void harden(const std::vector<Body<D>>& bodies, std::span<BodyAtNode<D>> sides) {
  constexpr double full = 0.1;
  const auto density = [&](const BodyAtNode<D>& side) {
    return bodies[static_cast<std::size_t>(side.body)].initial_density;
  };
  double mass = 0.0, volume = 0.0;
  for (const BodyAtNode<D>& side : sides)
    if (!side.prescribed) {
      mass += side.mass;
      volume += side.mass / density(side);
    }
  for (BodyAtNode<D>& side : sides) {
    if (!side.prescribed) continue;
    const double share = side.mass / density(side) / (full * volume);
    // m' = m s / (1 - s) has with all others together, of mass m, the reduced mass m m' / (m + m')
    // = s m: the share s of what an infinite mass has, and no jump at s = 1.
    side.mass =
        share < 1.0 ? mass * share / (1.0 - share) : std::numeric_limits<double>::infinity();
  }
}

}  // namespace

template <int D>
void share_rigid_masses(Contact<D>& contact, const std::vector<Body<D>>& bodies, Comm& comm) {
  if (!contact.has_rigid) return;
  contact.rigid_share.clear();
  for (const Body<D>& body : bodies)
    if (body.is_free_rigid()) contact.rigid_share.resize(static_cast<std::size_t>(body.rigid) + 1);
  const auto rigid_of = [&](const BodyAtNode<D>& side) {
    return bodies[static_cast<std::size_t>(side.body)].rigid;
  };
  // By one thread, exactly: no share depends on threads or ranks.
  for (ContactPart<D>& part : contact.parts) {
    for (const ContactNode& node : part.nodes) harden(bodies, part.sides_of(node));
    for (const BodyAtNode<D>& side : part.sides)
      if (rigid_of(side) >= 0)
        contact.rigid_share[static_cast<std::size_t>(rigid_of(side))].add(side.mass);
  }
  all_sum(comm, contact.rigid_share);
  thread_local std::vector<double> shares;
  shares.clear();
  for (const ExactSum& sum : contact.rigid_share) shares.push_back(sum.value());
  for (ContactPart<D>& part : contact.parts)
    for (BodyAtNode<D>& side : part.sides)
      // m_i M / sum m_i: at all overlapped nodes together the body has its whole mass M, so a light
      // surface stops a heavy tool no more than it should.
      if (rigid_of(side) >= 0)
        side.mass /= shares[static_cast<std::size_t>(rigid_of(side))] /
                     bodies[static_cast<std::size_t>(side.body)].total_mass;
}

template void share_rigid_masses<2>(Contact<2>&, const std::vector<Body<2>>&, Comm&);
template void share_rigid_masses<3>(Contact<3>&, const std::vector<Body<3>>&, Comm&);

}  // namespace mpm
