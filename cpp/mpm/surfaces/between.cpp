#include "mpm/surfaces/between.hpp"

#include <tuple>

#include "mpm/step/kept_nodes.hpp"
#include "mpm/surfaces/restitution.hpp"

namespace mpm {
namespace {

/// Take the other's place where a pair is deepest, if it is deeper.
template <int D>
void keep_deepest(ActingBetween<D>& pair, double overlap, const Vec<double, D>& normal,
                  const Vec<double, D>& place) {
  if (overlap <= pair.overlap) return;
  pair.overlap = overlap;
  pair.normal = normal;
  pair.place = place;
}

/// The last of the pairs so far if it is that of these bodies at this place, or a new one.
template <int D>
ActingBetween<D>& last_of(std::vector<BetweenByPart<D>>& all, std::uint64_t place, int a, int b) {
  if (all.empty() || all.back().place != place || all.back().pair.a != a ||
      all.back().pair.b != b) {
    const std::uint64_t entry = all.size();
    all.emplace_back();
    all.back().place = place;
    all.back().entry = entry;
    all.back().pair.a = a;
    all.back().pair.b = b;
  }
  return all.back().pair;
}

/// What passes by a touch of a body at a place.
template <int D, class Touch>
void add_touch(const Touch& touch, int body, const Vec<double, D>& place, std::uint64_t order,
               std::vector<BetweenByPart<D>>& all) {
  const bool first = is_wall(touch.opposite) || body < touch.opposite;
  const int a = first ? body : touch.opposite, b = first ? touch.opposite : body;
  ActingBetween<D>& pair = last_of(all, order, a, b);
  const double sign = first ? 1.0 : -1.0, size = norm(touch.push);
  pair.on_first += sign * (touch.push + touch.rub);
  pair.rub_work += touch.rub_work;
  pair.push += sign * touch.push;
  pair.middle += size * place;
  pair.size += size;
  pair.stiffness += touch.stiffness;
  keep_deepest(pair, touch.overlap, -sign * normalised(touch.push), place);
}

/// What passes by the touches of a part.
template <int D>
void add_part(const Domain<D>& domain, std::size_t number, std::vector<BetweenByPart<D>>& all) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const SurfacePart<D>& part = surfaces.parts[number];
  const bool faces = restitution_takes(domain.contact_settings);
  for (const SurfaceTouch<D>& touch : part.touches) {
    if (!(touch.pressed_in > 0.0) || touch.opposite == part.body) continue;
    if (is_wall(touch.opposite) && !faces) continue;
    add_touch(touch, part.body, surfaces.places[touch.point] + touch.arm, number, all);
  }
}

/// What particles and surfaces pass on to each other.
template <int D>
void add_of_particles(const Domain<D>& domain, std::vector<BetweenByPart<D>>& all) {
  for (const PressingPatch<D>& of : domain.surfaces.pressing) {
    const Patch<D>& patch = domain.grid.patches[of.patch];
    const ParticlePool<D>& pool = domain.pool_of(patch);
    for (const PressingTouch<D>& touch : of.touches)
      if (touch.pressed_in > 0.0)
        add_touch(touch, patch.body, pool.position_of(touch.row) + touch.arm, of.order, all);
  }
}

/// What bonds of own points pull with, behind all parts.
template <int D>
void add_own_bonds(const Surfaces<D>& surfaces, std::vector<BetweenByPart<D>>& all) {
  for (const Bond<D>& bond : surfaces.bonds) {
    const SurfacePart<D>& part = part_of_point(surfaces, bond.first);
    if (part.foreign) continue;
    const auto number = static_cast<std::size_t>(&part - surfaces.parts.data());
    const bool first = bond.from < bond.body;
    const int a = first ? bond.from : bond.body, b = first ? bond.body : bond.from;
    ActingBetween<D>& pair = last_of(all, surfaces.parts.size() + number, a, b);
    pair.on_first += (first ? 1.0 : -1.0) * bond.pull;
    // They touch along no plane.
    keep_deepest(pair, 0.0, Vec<double, D>::zero(), surfaces.places[bond.first]);
  }
}

}  // namespace

template <int D>
void sum_between(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  std::vector<BetweenByPart<D>>& parts = surfaces.between_parts;
  parts.clear();
  for (std::size_t k = 0; k < surfaces.parts.size(); ++k)
    if (!surfaces.parts[k].foreign) add_part(domain, k, parts);
  add_own_bonds(surfaces, parts);
  add_of_particles(domain, parts);
  entries_of_all(*domain.grid.partition.comm, parts);
  std::ranges::sort(parts, {}, [](const BetweenByPart<D>& one) {
    return std::tuple(one.pair.a, one.pair.b, one.place, one.entry);
  });
  std::vector<ActingBetween<D>>& all = surfaces.between;
  all.clear();
  for (const BetweenByPart<D>& by_part : parts) {
    const ActingBetween<D>& one = by_part.pair;
    if (all.empty() || all.back().a != one.a || all.back().b != one.b) {
      all.push_back(one);
      continue;
    }
    ActingBetween<D>& pair = all.back();
    pair.on_first += one.on_first;
    pair.rub_work += one.rub_work;
    pair.push += one.push;
    pair.middle += one.middle;
    pair.size += one.size;
    pair.stiffness += one.stiffness;
    keep_deepest(pair, one.overlap, one.normal, one.place);
  }
}

template <int D>
void record_between(Domain<D>& domain) {
  PairRecords& records = domain.contact.records;
  const std::int64_t step = domain.step + 1;
  // For as long as they have acted on the bodies.
  const double acts = time_of_forces(domain, true);
  records.begin_step();
  // All ranks know them, and one records them.
  const bool is_first = domain.grid.partition.comm->rank() == 0;
  for (const ActingBetween<D>& pair : domain.surfaces.between) {
    if (is_wall(pair.b) || !is_first) continue;
    PairShare share{pair.a, pair.b, records.known(pair.a, pair.b, step)};
    double impulse[3] = {};
    for (int a = 0; a < D; ++a) {
      impulse[a] = acts * pair.on_first[a];
      share.normal[a] = pair.normal[a];
      share.node[a] = pair.place[a];
    }
    records.add_to(share, impulse, pair.rub_work);
    share.share = 1.0;  // There is one place for each pair.
    share.gap = -pair.overlap;
    records.add(share, step, domain.time_after);
  }
  records.end_step(acts);
}

template void sum_between<2>(Domain<2>&);
template void sum_between<3>(Domain<3>&);
template void record_between<2>(Domain<2>&);
template void record_between<3>(Domain<3>&);

}  // namespace mpm
