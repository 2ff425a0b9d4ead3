#pragma once
// What ranks tell each other of the surfaces of bodies: each has the parts of which the particles
// are its own, and knows of all others where they were when lists were made. Of what may be felt by
// now it is told in each step where it is and how it moves; what it pushes there it tells who has
// it. All sums have the order of the parts, whoever has them.
#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

#include "mpm/comm/comm.hpp"
#include "mpm/surfaces/hosts.hpp"

namespace mpm {

/// A rank with points or hosts that are read here, or that reads those of this rank.
struct SurfacePartner {
  int rank = 0;
  std::vector<std::uint32_t> give_points{}, give_hosts{}, take_points{}, take_hosts{};
};

template <int D>
struct OtherRanks {
  std::vector<SurfacePartner> partners;
  std::vector<HostElsewhere<D>> hosts;          // that are felt here, by host
  std::vector<Vec<double, D>> places_at_start;  // of all points [m]; none where numbers tell
  Mail mail;
};

template <int D>
struct Surfaces;

/// The part of a host of another rank that is felt here.
template <int D>
const HostElsewhere<D>& host_elsewhere(const Surfaces<D>& surfaces, std::uint32_t host) {
  const auto& all = surfaces.others.hosts;
  const auto at = std::ranges::lower_bound(all, host, {}, &HostElsewhere<D>::host);
  assert(at != all.end() && at->host == host);
  return *at;
}

}  // namespace mpm
