#pragma once
// What the faces of the box give to the bodies, each by itself.
#include <array>
#include <bit>

#include "mpm/math/exact_sum.hpp"
#include "mpm/math/host_device.hpp"

namespace mpm {

template <int D>
struct FaceImpulses {
  double of[D][2][D] = {};  // [axis][lower, upper][component] [N s]

  /// A component of an impulse that faces give together, as bits 2 axis + side: at an edge of the
  /// box each gives the same, so that none comes before another.
  MPM_HD void add(unsigned faces, int component, double impulse) {
    const int count = std::popcount(faces);
    for (int face = 0; face < 2 * D; ++face)
      if (faces >> face & 1u) of[face / 2][face % 2][component] += impulse / count;
  }
  /// Those of other forces over a time.
  void add(const FaceImpulses& forces, double time) {
    for (int axis = 0; axis < D; ++axis)
      for (int side = 0; side < 2; ++side)
        for (int a = 0; a < D; ++a) of[axis][side][a] += time * forces.of[axis][side][a];
  }
  /// f(number) for all, in one order: 2 D D.
  template <class F>
  MPM_HD void for_each(F&& f) {
    for (auto& axis : of)
      for (auto& face : axis)
        for (double& component : face) f(component);
  }
  static constexpr std::size_t numbers = std::size_t{2} * D * D;
};

/// Sums of them, in the same order, which may be added up over ranks at any time.
template <int D>
using FaceSums = std::array<ExactSum, FaceImpulses<D>::numbers>;

}  // namespace mpm
