#include "mpm/surfaces/between.hpp"

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

/// The last of the pairs so far if it is that of these bodies, or a new one.
template <int D>
ActingBetween<D>& last_of(std::vector<ActingBetween<D>>& all, int a, int b) {
  if (all.empty() || all.back().a != a || all.back().b != b) {
    all.emplace_back();
    all.back().a = a;
    all.back().b = b;
  }
  return all.back();
}

}  // namespace

template <int D>
void sum_between(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  const bool faces = restitution_takes(domain.contact_settings);
  std::vector<ActingBetween<D>>& all = surfaces.between;
  all.clear();
  for (const SurfacePart<D>& part : surfaces.parts)
    for (const SurfaceTouch<D>& touch : part.touches) {
      if (!(touch.pushed > 0.0) || touch.opposite == part.body) continue;
      if (is_face(touch.opposite) && !faces) continue;
      const bool first = is_face(touch.opposite) || part.body < touch.opposite;
      ActingBetween<D>& pair =
          first ? last_of(all, part.body, touch.opposite) : last_of(all, touch.opposite, part.body);
      const double sign = first ? 1.0 : -1.0, size = norm(touch.push);
      const Vec<double, D> place = surfaces.places[touch.point] + touch.arm;
      pair.on_first += sign * (touch.push + touch.rub);
      pair.rubbed += touch.rubbed;
      pair.push += sign * touch.push;
      pair.middle += size * place;
      pair.size += size;
      pair.stiffness += touch.stiffness;
      keep_deepest(pair, touch.overlap, -sign * normalised(touch.push), place);
    }
  for (const Bond<D>& bond : surfaces.bonds) {
    const bool first = bond.from < bond.body;
    ActingBetween<D>& pair =
        first ? last_of(all, bond.from, bond.body) : last_of(all, bond.body, bond.from);
    pair.on_first += (first ? 1.0 : -1.0) * bond.pull;
    // They touch along no plane.
    keep_deepest(pair, 0.0, Vec<double, D>::zero(), surfaces.places[bond.first]);
  }
  std::ranges::stable_sort(all, [](const ActingBetween<D>& x, const ActingBetween<D>& y) {
    return x.a != y.a ? x.a < y.a : x.b < y.b;
  });
  std::size_t last = 0;
  for (std::size_t k = 1; k < all.size(); ++k) {
    ActingBetween<D>& pair = all[last];
    if (pair.a != all[k].a || pair.b != all[k].b) {
      all[++last] = all[k];
      continue;
    }
    pair.on_first += all[k].on_first;
    pair.rubbed += all[k].rubbed;
    pair.push += all[k].push;
    pair.middle += all[k].middle;
    pair.size += all[k].size;
    pair.stiffness += all[k].stiffness;
    keep_deepest(pair, all[k].overlap, all[k].normal, all[k].place);
  }
  if (!all.empty()) all.resize(last + 1);
}

template <int D>
void record_between(Domain<D>& domain) {
  PairRecords& records = domain.contact.records;
  const std::int64_t step = domain.step + 1;
  // For as long as they have acted on the bodies.
  const double acts = 0.5 * (domain.time_step + domain.step_before);
  records.begin_step();
  for (const ActingBetween<D>& pair : domain.surfaces.between) {
    if (is_face(pair.b)) continue;
    PairShare share{pair.a, pair.b, records.known(pair.a, pair.b, step)};
    double impulse[3] = {};
    for (int a = 0; a < D; ++a) {
      impulse[a] = acts * pair.on_first[a];
      share.normal[a] = pair.normal[a];
      share.node[a] = pair.place[a];
    }
    records.add_to(share, impulse, pair.rubbed);
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
