#pragma once
// Bodies that are bonded: where their surfaces touch at the start a spring holds each contact point
// to the place of the other body that it lies at then, in all directions,
//   E = k |x_c - x_d|^2 / 2,                                                                  (S5)
// x_d being (S0) of the place and the normal of c, carried by the host of the nearest point there,
// and k the stiffness of a contact, (S1). So two bodies are held
// by the springs of both, that bear as a quarter of a cell of each; the forces are along what lies
// between, and turn nothing. The place d is a contact point without an area of its own, that
// nothing else touches.
#include "mpm/domain.hpp"

namespace mpm {

/// Bond what shall be; the parts are made anew, with the points that it takes, and lists of near
/// points have to be.
template <int D>
void add_bonds(Domain<D>& domain);

/// The pairs of groups of bodies that some bond holds, each with the lower one first.
template <int D>
std::vector<std::pair<int, int>> bonded_groups(const Domain<D>& domain);

/// What bonds pull by now.
template <int D>
void pull_bonds(Domain<D>& domain);

/// Is a point bonded to a body?
template <int D>
bool is_bonded(const Surfaces<D>& surfaces, std::uint32_t point, int body) {
  if (surfaces.bonds.empty()) return false;
  const auto all = std::ranges::equal_range(surfaces.bonds, point, {}, &Bond<D>::first);
  return std::ranges::any_of(all, [&](const Bond<D>& bond) { return bond.body == body; });
}

}  // namespace mpm
