#include "mpm/surfaces/near_points.hpp"

#include <array>
#include <atomic>

#include "mpm/surfaces/felt.hpp"

namespace mpm {
namespace {

// Lists hold what is nearer than a point is felt by this more, so that they last until points have
// moved by half of it.
constexpr double margin = 1.0;  // spacings
// A body feels itself where it is folded: points of its own that are farther off in the body than
// this are those of another [cells].
constexpr double apart_in_body = 4.0;

/// A point by the box that it is in, of edges of the reach of the lists.
struct Boxed {
  std::array<std::int32_t, 3> box;
  std::uint32_t point;

  friend bool operator<(const Boxed& x, const Boxed& y) {
    for (std::size_t a = 3; a-- > 0;)  // the first axis fastest
      if (x.box[a] != y.box[a]) return x.box[a] < y.box[a];
    return x.point < y.point;
  }
};

template <int D>
double reach_of_lists(const Surfaces<D>& surfaces) {
  return surfaces.spacing * (SurfacePoint<D>::reach + margin);
}

/// Have some points moved so far that lists may lack what they feel?
template <int D>
bool lists_are_old(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  if (surfaces.places_of_lists.size() != surfaces.places.size()) return true;
  const double most = 0.5 * margin * surfaces.spacing;
  std::atomic<bool> moved = false;
  domain.threads.for_each(surfaces.parts.size(), [&](std::size_t k) {
    const SurfacePart<D>& part = surfaces.parts[k];
    double farthest = 0.0;
    for (std::uint32_t c = part.first_point; c < part.first_point + part.points; ++c) {
      const Vec<double, D> way = surfaces.places[c] - surfaces.places_of_lists[c];
      farthest = std::max(farthest, dot(way, way));
    }
    if (farthest > most * most) moved = true;
  });
  return moved;
}

/// Where a point is in its body at the start.
template <int D>
Vec<double, D> place_in_body(const Domain<D>& domain, int body, const ContactPoint<D>& point) {
  const Host<D>& host = domain.surfaces.hosts[point.host];
  return listed_place(domain.pool_of(domain.body_at(body)), host.row) + point.offset;
}

template <int D>
class NearSearch {
 public:
  explicit NearSearch(const Domain<D>& domain)
      : domain_(domain), surfaces_(domain.surfaces), reach_(reach_of_lists(domain.surfaces)) {
    body_of_.resize(surfaces_.points.size());
    as_one_.resize(surfaces_.points.size());
    for (const SurfacePart<D>& part : surfaces_.parts)
      for (std::uint32_t c = part.first_point; c < part.first_point + part.points; ++c) {
        body_of_[c] = part.body;
        as_one_[c] = part.as_one;
      }
    boxed_.reserve(surfaces_.points.size());
    for (std::uint32_t c = 0; c < surfaces_.points.size(); ++c)
      boxed_.push_back({box_of(surfaces_.places[c]), c});
    std::ranges::sort(boxed_, std::less<>{});
  }

  /// The points that those of a part may feel, by body.
  void find(SurfacePart<D>& part) const {
    part.near.clear();
    part.near_of.clear();
    for (std::uint32_t c = part.first_point; c < part.first_point + part.points; ++c) {
      const auto first = static_cast<std::ptrdiff_t>(part.near.size());
      find(part, c);
      std::sort(part.near.begin() + first, part.near.end());  // by body as well
      int body = -1;
      for (auto k = static_cast<std::size_t>(first); k < part.near.size(); ++k) {
        if (const int other = body_of_[part.near[k]]; other != body) {
          body = other;
          part.near_of.push_back({c, body, static_cast<std::uint32_t>(k), 0});
        }
        ++part.near_of.back().count;
      }
    }
  }

 private:
  std::array<std::int32_t, 3> box_of(const Vec<double, D>& place) const {
    std::array<std::int32_t, 3> box{};
    for (int a = 0; a < D; ++a)
      box[static_cast<std::size_t>(a)] =
          static_cast<std::int32_t>(std::floor((place[a] - domain_.grid.origin[a]) / reach_));
    return box;
  }

  void find(SurfacePart<D>& part, std::uint32_t c) const {
    const Vec<double, D> here = surfaces_.places[c];
    const auto middle = box_of(here);
    const int layers = D == 3 ? 1 : 0;
    for (int z = -layers; z <= layers; ++z)
      for (int y = -1; y <= 1; ++y) {
        // The boxes of a row follow one another.
        const Boxed low{{middle[0] - 1, middle[1] + y, middle[2] + z}, 0};
        const std::array<std::int32_t, 3> last{middle[0] + 1, low.box[1], low.box[2]};
        for (auto at = std::ranges::lower_bound(boxed_, low, std::less<>{});
             at != boxed_.end() && at->box[0] <= last[0] && at->box[1] == last[1] &&
             at->box[2] == last[2];
             ++at) {
          const Vec<double, D> way = surfaces_.places[at->point] - here;
          if (dot(way, way) < reach_ * reach_ && may_feel(part, c, at->point))
            part.near.push_back(at->point);
        }
      }
  }

  bool may_feel(const SurfacePart<D>& part, std::uint32_t c, std::uint32_t other) const {
    if (part.as_one && as_one_[other]) return false;
    if (body_of_[other] != part.body) return true;
    const Vec<double, D> way = place_in_body(domain_, part.body, surfaces_.points[c]) -
                               place_in_body(domain_, part.body, surfaces_.points[other]);
    const double far = apart_in_body * domain_.grid.cell_size;
    return dot(way, way) > far * far;
  }

  const Domain<D>& domain_;
  const Surfaces<D>& surfaces_;
  double reach_;
  std::vector<std::int32_t> body_of_;
  std::vector<bool> as_one_;  // of each point, is it of a body that does not deform?
  std::vector<Boxed> boxed_;
};

}  // namespace

template <int D>
void find_near_points(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  if (!lists_are_old(domain)) return;
  const NearSearch<D> search(domain);
  domain.threads.for_each(surfaces.parts.size(),
                          [&](std::size_t k) { search.find(surfaces.parts[k]); });
  surfaces.places_of_lists = surfaces.places;
}

template void find_near_points<2>(Domain<2>&);
template void find_near_points<3>(Domain<3>&);

}  // namespace mpm
