#pragma once
// Fields at a place, of a particle or of bodies, at one time.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mpm/domain.hpp"

namespace mpm {

/// What a probe looks at: the particles of some bodies that take part.
enum class ProbeKind {
  point,     // those less than a cell from a place along each axis, by mass and nearness
  region,    // those in a box
  bodies,    // all of them
  particle,  // one of the only body
};
template <>
inline constexpr auto words<ProbeKind> = std::to_array<Word<ProbeKind>>(
    {{"point", ProbeKind::point, "particles around a place"},
     {"region", ProbeKind::region, "particles in a box"},
     {"bodies", ProbeKind::bodies, "all particles of bodies"},
     {"particle", ProbeKind::particle, "a particle, wherever it goes"}});

struct Probe {
  ProbeKind kind = ProbeKind::point;
  std::vector<int> bodies;
  std::array<double, 3> lower{}, upper{};  // of a box; of a place `lower` [m]
  std::int64_t particle = 0;               // in the order in which the user gave them
  std::vector<std::string> fields;         // columns, or of derived_fields
};

/// What it sees: how many particles, their mass [kg], and of each component of each field the mean
/// by mass, at a place by nearness too, the least and the largest; of no particle no number. Stress
/// has six components, xx yy zz yz xz xy. Of bodies without a field nothing is seen. By all ranks
/// at once. Throws std::invalid_argument if no material has a field.
template <int D>
std::vector<double> look(Domain<D>& domain, const Probe& probe);

/// The body and number of the particle of some bodies that is nearest to a place [m]; of equally
/// near ones the first. None if there is no particle. By all ranks at once.
template <int D>
std::optional<std::array<std::int64_t, 2>> nearest_particle(const Domain<D>& domain,
                                                            const std::vector<int>& bodies,
                                                            const std::array<double, 3>& place);

}  // namespace mpm
