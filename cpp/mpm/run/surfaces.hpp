#pragma once
// Contact points of surfaces, as a case gives them, at the start and in a checkpoint.
#include <span>
#include <vector>

#include "mpm/run/simulation.hpp"
#include "mpm/state/state_stream.hpp"

namespace mpm {

/// Contact points of a body, each carried by a particle.
struct ContactPointsGiven {
  std::vector<std::uint32_t> particles;  // (n,) their numbers in the body
  std::span<const double> offsets;       // (n, D) from the particle to the surface [m]
  std::span<const double> normals;       // (n, D) out of the body, of unit length
  std::span<const double> areas;         // (n,) that they push for [m^2; in 2D m times 1 m]; or 0
  std::span<const double> felt_areas;    // (n,) by which others feel them; or 0
  std::vector<std::int32_t> faces;       // (n,) numbers of the faces of the body
  double spacing;                        // of the points of all bodies [m]
  unsigned held_by = ~0u;                // of the faces of the box (Body::held_by)
};

/// Give a body the contact points of its surface; before prepare(). Throws std::invalid_argument
/// for what does not fit.
template <int D>
void add_surface(Simulation<D>& simulation, int body, const ContactPointsGiven& given);

/// Find the hosts of the points; what overlaps at the start does not push.
template <int D>
void start_surfaces(Domain<D>& domain);

/// What contact points keep from step to step, saved or restored.
template <int D>
void exchange_surfaces(Domain<D>& domain, StateStream& stream);

}  // namespace mpm
