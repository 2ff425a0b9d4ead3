#pragma once
// Contact points of bodies into which nodes are laid anew (run/renew_reference.hpp). They stay
// where they are and remember what they did; their ways from their hosts, (S0), are those of by
// now: d' = F d + sum_k b_k d2u/dX_k^2, N' = F N / |F N|. Parts and hosts are made anew, so that
// points are told by the numbers that they had at the start.
#include <vector>

#include "mpm/domain.hpp"

namespace mpm {

/// A contact point with what goes along with it.
template <int D>
struct LaidPoint {
  GivenPoint<D> given;  // with its number, at the start or as it came
  Vec<double, D> place, at_start;
  bool failed = false;  // its host has
};

/// What a part gets from walls in the coming step.
template <int D>
struct FromWalls {
  std::uint64_t part = 0;
  std::int64_t body = 0;
  FaceImpulses<D> forces;
  Vector3 moment = Vector3::zero();
};

template <int D>
class RenewedPoints {
 public:
  /// What is known of them; bodies are `renewed` by what deforms them now. All ranks together.
  RenewedPoints(Domain<D>& domain, const std::vector<bool>& renewed);
  /// Points of hosts that have failed are no surface any more, and others come: all ranks give the
  /// same.
  void uncover(Domain<D>& domain, const std::vector<LaidPoint<D>>& more);
  /// Parts anew, once lists and nodes are. All ranks together.
  void lay(Domain<D>& domain);

 private:
  void keep_memory(Domain<D>& domain, const std::vector<bool>& renewed);
  void give_memory(Domain<D>& domain, const std::vector<std::uint32_t>& point_of) const;

  std::vector<LaidPoint<D>> points_;
  // What points keep, by their numbers at the start in place of those of by now.
  std::vector<KeptOfContact<double>> set_back_;
  std::vector<KeptOfContact<MemoryOfTouch<D>>> kept_;
  std::vector<KeptOfContact<Levelled<D>>> levelled_;
  std::vector<ActingOnHost<D>> on_hosts_;  // a host by its first point
  std::vector<FromWalls<D>> from_walls_;
};

/// All points by their numbers at the start; those of bodies that are `renewed` by what deforms
/// them now. All ranks together.
template <int D>
std::vector<LaidPoint<D>> laid_points(Domain<D>& domain, const std::vector<bool>& renewed);

/// What holds points whose hosts have failed holds no more. By numbers at the start.
template <int D>
void drop_bonds_of_failed(Surfaces<D>& surfaces, const std::vector<LaidPoint<D>>& points);

/// Points by their numbers at the start: of each where it is by now. Parts, hosts and bonds of the
/// bodies are made of them.
template <int D>
std::vector<std::uint32_t> lay_points(Domain<D>& domain, const std::vector<LaidPoint<D>>& points);

/// The number at the start of a point.
template <int D>
std::uint32_t first_number(const Surfaces<D>& surfaces, std::uint32_t point) {
  return surfaces.first_numbers.empty() ? point : surfaces.first_numbers[point];
}

/// Which of some bodies have faces that look at each other from as near as nodes reach, and are far
/// from each other in the body: nodes that were laid anew would weld them. All ranks together.
template <int D>
std::vector<bool> near_themselves(Domain<D>& domain, const std::vector<bool>& bodies);

}  // namespace mpm
