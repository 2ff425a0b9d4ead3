#include "mpm/run/watch_contact.hpp"

#include "mpm/contact/crowd.hpp"

namespace mpm {
namespace {

// At a node: each meets each, 435 pairs. Equal spheres have twelve neighbours, grains of two cells
// ten.
constexpr int many_bodies = 30;

// Of their spacing e, twice the depth of contact points: from here on surfaces may go through each
// other.
constexpr double deep = 0.7;

/// Note the first node at which so many bodies meet that steps take long, and count such steps.
template <int D>
void watch_crowd(Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  if (domain.contact.counts.bodies_max <= many_bodies) return;
  const Crowd most = largest_crowd(domain.contact, domain.grid);
  if (most.bodies <= many_bodies) return;
  for (Note& known : simulation.watch.notes)
    if (known.kind == NoteKind::crowd) {
      ++known.count;
      return;
    }
  Note found{.kind = NoteKind::crowd, .body = most.body, .value = static_cast<double>(most.bodies)};
  std::copy(std::begin(most.position), std::end(most.position), found.position.begin());
  note(simulation, found);
}

/// Note where surfaces are so deep in each other that springs may not hold them.
template <int D>
void watch_surfaces(Simulation<D>& simulation) {
  const Surfaces<D>& surfaces = simulation.domain.surfaces;
  const DeepestPoint<D>& deepest = surfaces.deepest;
  if (!(deepest.overlap > deep * surfaces.spacing)) return;
  Note found{
      .kind = NoteKind::deep, .body = deepest.body, .value = deepest.overlap / surfaces.spacing};
  for (std::size_t a = 0; a < D; ++a) found.position[a] = deepest.place[static_cast<int>(a)];
  note(simulation, found);
}

}  // namespace

template <int D>
void watch_contact(Simulation<D>& simulation) {
  watch_crowd(simulation);
  watch_surfaces(simulation);
}

template void watch_contact<2>(Simulation<2>&);
template void watch_contact<3>(Simulation<3>&);

}  // namespace mpm
