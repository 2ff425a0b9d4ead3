#pragma once
#include "mpm/surfaces/mirrored.hpp"

namespace mpm {

/// What passes from the image of a felt point to what touches it `from` a place is given by the
/// walls: to a part, or a patch of particles, that tells it with what else walls give.
template <int D, class Touch, class Part>
void add_across_walls(const Domain<D>& domain, const Vec<double, D>& from, const Touch& touch,
                      const FeltPoint<D>& felt, Part& part) {
  const Vec<double, D> place = from + touch.arm,
                       there = mirrored_place(domain.grid, felt.mirrors, place);
  const Vec<double, D> push = touch.stiffness * touch.pressed_in * felt.slope,
                       rub = felt.share * touch.rub;
  const Vec<double, D> on_point = mirrored(felt.mirrors, push);
  const Vec<double, D> back = mirrored(felt.mirrors, rub);
  part.at_walls = true;
  for (int a = 0; a < D; ++a) {
    if (!is_mirrored(felt.mirrors, a, D)) continue;
    const int side = felt.mirrors >> a & 1u ? 0 : 1;
    part.by_walls.add(1u << (2 * a + side), a, on_point[a] - push[a] + rub[a] - back[a]);
  }
  part.moment_by_walls +=
      cross(in_space<D>(from), in_space<D>(on_point)) -
      cross(in_space<D>(domain.surfaces.places[felt.point]), in_space<D>(push)) +
      cross(in_space<D>(place), in_space<D>(rub)) - cross(in_space<D>(there), in_space<D>(back));
}

}  // namespace mpm
