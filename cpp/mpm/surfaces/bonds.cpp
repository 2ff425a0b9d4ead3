#include "mpm/surfaces/bonds.hpp"

#include <ranges>
#include <set>
#include <span>
#include <tuple>

#include "mpm/surfaces/law.hpp"
#include "mpm/surfaces/near_points.hpp"
#include "mpm/surfaces/overlaps.hpp"
#include "mpm/surfaces/parts.hpp"

namespace mpm {
namespace {

// Surfaces touch where the gap between them is less than this [spacings]. Beyond the edge of a face
// the sum of its weights is less than half of that on it: there is none.
constexpr double widest_gap = 0.25;

// Points within so much of the square of the nearest one's distance are as near: no order chooses.
constexpr double as_near = 1.0 + 1e-6;

/// A bond before its second point has a number.
struct Found {
  std::uint32_t first = 0, nearest = 0;  // points
  int from = 0, to = 0;                  // bodies
  double share = 0.0;                    // where several points are as near
};

template <int D>
bool shall_be_bonded(const Domain<D>& domain, int a, int b) {
  return a != b &&
         law_of(domain.contact_settings, domain.body_at(a).group, domain.body_at(b).group).bonded;
}

/// What touches where bonded bodies lie at the start, by point and body.
template <int D>
std::vector<Found> find_touching(const Domain<D>& domain) {
  const Surfaces<D>& surfaces = domain.surfaces;
  std::vector<Found> found;
  for (const SurfacePart<D>& part : surfaces.parts) {
    if (part.foreign) continue;
    for_each_near_surface(domain, part, [&](const NearPoints& near, double height) {
      if (!shall_be_bonded(domain, part.body, near.body) || height > 1.0 + widest_gap) return;
      const Vec<double, D> here = surfaces.places[near.point];
      const auto square_to = [&](std::uint32_t q) {
        const Vec<double, D> way = surfaces.places[q] - here;
        return dot(way, way);
      };
      const std::span all(part.awake.data() + near.first, near.count);
      const double nearest = std::ranges::min(all | std::views::transform(square_to));
      const std::size_t begin = found.size();
      for (const std::uint32_t q : all)
        if (square_to(q) <= as_near * nearest)
          found.push_back({near.point, q, part.body, near.body, 1.0});
      for (std::size_t k = begin; k < found.size(); ++k)
        found[k].share = 1.0 / static_cast<double>(found.size() - begin);
    });
  }
  // As one rank finds them.
  entries_of_all(*domain.grid.partition.comm, found);
  std::ranges::sort(found, [](const Found& x, const Found& y) {
    return std::tuple(x.first, x.to, x.nearest) < std::tuple(y.first, y.to, y.nearest);
  });
  return found;
}

}  // namespace

template <int D>
void add_bonds(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  find_near_points(domain);
  const std::vector<Found> found = find_touching(domain);
  const std::size_t count = surfaces.given.size();
  for (std::uint32_t k = 0; k < count; ++k) surfaces.given[k].number = k;
  std::vector<std::uint32_t> first;  // of each bond the number of its first point as it was given
  for (const Found& bond : found) {
    GivenPoint<D> place = surfaces.given[surfaces.given_of[bond.nearest]];
    // Half a spacing behind the surface of the other is so far before that of its own.
    const Vec<double, D>& normal = surfaces.points[bond.first].normal;
    place.offset += surfaces.places[bond.first] - surfaces.places[bond.nearest] +
                    (0.5 * surfaces.spacing) * (normal - place.normal);
    place.normal = normal;
    place.area = place.felt_area = 0.0;
    place.number = static_cast<std::uint32_t>(count + first.size());
    first.push_back(surfaces.given_of[bond.first]);
    surfaces.given.push_back(place);
  }
  start_parts(domain);
  surfaces.places_of_lists.clear();
  std::vector<std::uint32_t> point_of(surfaces.given.size());
  for (std::uint32_t c = 0; c < surfaces.points.size(); ++c)
    point_of[surfaces.given[surfaces.given_of[c]].number] = c;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const auto compliance = [&](int body) { return 1.0 / domain.body_at(body).stiffness; };
    Bond<D> bond;
    bond.first = point_of[first[k]];
    bond.second = point_of[count + k];
    bond.from = found[k].from;
    bond.body = found[k].to;
    bond.stiffness =
        found[k].share * stiffness_of_point(surfaces.points[bond.first].area, domain.grid.cell_size,
                                            compliance(bond.from), compliance(bond.body));
    surfaces.bonds.push_back(bond);
  }
  std::ranges::stable_sort(surfaces.bonds, {}, &Bond<D>::first);
}

template <int D>
void pull_bonds(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  domain.threads.for_each(surfaces.bonds.size(), [&](std::size_t k) {
    Bond<D>& bond = surfaces.bonds[k];
    if (part_of_point(surfaces, bond.first).foreign) return;
    bond.pull = bond.stiffness * (surfaces.places[bond.second] - surfaces.places[bond.first]);
  });
}

template void add_bonds<2>(Domain<2>&);
template void add_bonds<3>(Domain<3>&);
template <int D>
std::vector<std::pair<int, int>> bonded_groups(const Domain<D>& domain) {
  std::set<std::pair<int, int>> found;
  for (const Bond<D>& bond : domain.surfaces.bonds)
    found.insert(std::minmax(domain.body_at(bond.from).group, domain.body_at(bond.body).group));
  return {found.begin(), found.end()};
}

template std::vector<std::pair<int, int>> bonded_groups<2>(const Domain<2>&);
template std::vector<std::pair<int, int>> bonded_groups<3>(const Domain<3>&);
template void pull_bonds<2>(Domain<2>&);
template void pull_bonds<3>(Domain<3>&);

}  // namespace mpm
