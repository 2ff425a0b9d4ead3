#include "mpm/surfaces/near_points.hpp"

#include <array>
#include <bit>
#include <span>

#include "mpm/surfaces/felt.hpp"
#include "mpm/surfaces/folds.hpp"

namespace mpm {
namespace {

// Lists hold what is nearer than a point is felt by this more, so that they last until points have
// moved by half of it.
constexpr double margin = 1.5;  // spacings

/// The box of space that a point is in, of edges of the reach of the lists.
using BoxIndex = std::array<std::int32_t, 3>;

/// The points in a box: a range of those that are sorted by box, and between which bodies they lie.
struct PointBox {
  BoxIndex index{};
  std::uint32_t first = 0, count = 0;
  std::int32_t least_body = 0, greatest_body = 0;
};

template <int D>
double reach_of_lists(const Surfaces<D>& surfaces) {
  return surfaces.spacing * (SurfacePoint<D>::reach + margin);
}

/// How far the farthest point has moved since lists were made [m].
template <int D>
double moved_since(Domain<D>& domain) {
  const Surfaces<D>& surfaces = domain.surfaces;
  std::vector<double> farthest(surfaces.parts.size(), 0.0);
  domain.threads.for_each(surfaces.parts.size(), [&](std::size_t k) {
    const SurfacePart<D>& part = surfaces.parts[k];
    for (std::uint32_t c = part.first_point; c < part.first_point + part.points; ++c) {
      const Vec<double, D> way = surfaces.places[c] - surfaces.places_of_lists[c];
      farthest[k] = std::max(farthest[k], dot(way, way));
    }
  });
  return std::sqrt(*std::ranges::max_element(farthest));
}

/// All points by their boxes, found by the box.
template <int D>
class PointBoxes {
 public:
  PointBoxes(const Domain<D>& domain, const std::vector<std::int32_t>& body_of)
      : origin_(domain.grid.origin), reach_(reach_of_lists(domain.surfaces)) {
    const std::vector<Vec<double, D>>& places = domain.surfaces.places;
    std::vector<std::pair<BoxIndex, std::uint32_t>> boxed;
    boxed.reserve(places.size());
    for (std::uint32_t c = 0; c < places.size(); ++c) boxed.push_back({index_of(places[c]), c});
    std::ranges::sort(boxed);
    points_.reserve(boxed.size());
    for (const auto& [index, point] : boxed) {
      if (boxes_.empty() || boxes_.back().index != index)
        boxes_.push_back(
            {index, static_cast<std::uint32_t>(points_.size()), 0, body_of[point], body_of[point]});
      PointBox& box = boxes_.back();
      ++box.count;
      box.least_body = std::min(box.least_body, body_of[point]);
      box.greatest_body = std::max(box.greatest_body, body_of[point]);
      points_.push_back(point);
    }
    table_.assign(std::bit_ceil(2 * boxes_.size() + 1), 0);
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
      std::size_t at = hash(boxes_[b].index);
      while (table_[at] != 0) at = (at + 1) % table_.size();
      table_[at] = static_cast<std::uint32_t>(b + 1);
    }
  }

  BoxIndex index_of(const Vec<double, D>& place) const {
    BoxIndex index{};
    for (int a = 0; a < D; ++a)
      index[static_cast<std::size_t>(a)] =
          static_cast<std::int32_t>(std::floor((place[a] - origin_[a]) / reach_));
    return index;
  }
  double reach() const { return reach_; }
  std::span<const std::uint32_t> points(const PointBox& box) const {
    return {points_.data() + box.first, box.count};
  }
  /// Null if nothing is there.
  const PointBox* find(const BoxIndex& index) const {
    for (std::size_t at = hash(index); table_[at] != 0; at = (at + 1) % table_.size())
      if (const PointBox& box = boxes_[table_[at] - 1]; box.index == index) return &box;
    return nullptr;
  }

 private:
  std::size_t hash(const BoxIndex& index) const {
    std::uint64_t h = 0;
    for (const std::int32_t i : index)
      h = (h ^ static_cast<std::uint32_t>(i)) * 0x9e3779b97f4a7c15ull;
    return (h >> 32) % table_.size();
  }

  Vec<double, D> origin_;
  double reach_;
  std::vector<PointBox> boxes_;
  std::vector<std::uint32_t> points_, table_;  // 1 + the number of a box, or 0
};

/// The boxes around one, and whether there are points of several bodies.
template <int D>
struct BoxesAround {
  std::array<const PointBox*, 27> box{};
  std::size_t count = 0;
  BoxIndex middle{};
  bool mixed = false;

  void find(const PointBoxes<D>& boxes, const BoxIndex& index) {
    if (count > 0 && index == middle) return;
    middle = index;
    count = 0;
    constexpr int layers = D == 3 ? 1 : 0;
    for (int z = -layers; z <= layers; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          if (const PointBox* const one = boxes.find({index[0] + x, index[1] + y, index[2] + z}))
            box[count++] = one;
    mixed = std::any_of(box.begin(), box.begin() + count, [&](const PointBox* one) {
      return one->least_body != box[0]->least_body || one->greatest_body != box[0]->least_body;
    });
  }
};

/// The points that those of a part may feel, by body.
template <int D>
void find_near(const Domain<D>& domain, const PointBoxes<D>& boxes, const FoldedBodies<D>& folded,
               const std::vector<std::int32_t>& body_of, SurfacePart<D>& part) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const double square = boxes.reach() * boxes.reach();
  const bool folds = folded.is_folded(part.body);
  BoxesAround<D> around;
  part.near.clear();
  part.near_of.clear();
  for (std::uint32_t c = part.first_point; c < part.first_point + part.points; ++c) {
    const Vec<double, D> here = surfaces.places[c];
    around.find(boxes, boxes.index_of(here));
    if (!around.mixed && !folds) continue;
    const auto first = static_cast<std::ptrdiff_t>(part.near.size());
    for (std::size_t b = 0; b < around.count; ++b) {
      const PointBox& box = *around.box[b];
      if (!folds && box.least_body == part.body && box.greatest_body == part.body) continue;
      for (const std::uint32_t q : boxes.points(box)) {
        const Vec<double, D> way = surfaces.places[q] - here;
        if (!(dot(way, way) < square)) continue;
        if (body_of[q] == part.body ? folds && folded.apart_in_body(c, q)
                                    : !part.as_one || !folded.as_one(body_of[q]))
          part.near.push_back(q);
      }
    }
    std::sort(part.near.begin() + first, part.near.end());  // by body as well
    int body = -1;
    double nearest = 0.0;
    for (auto k = static_cast<std::size_t>(first); k < part.near.size(); ++k) {
      if (const int other = body_of[part.near[k]]; other != body) {
        body = other;
        part.near_of.push_back({c, body, static_cast<std::uint32_t>(k), 0, 0.0});
        nearest = std::numeric_limits<double>::infinity();
      }
      const Vec<double, D> way = surfaces.places[part.near[k]] - here;
      nearest = std::min(nearest, dot(way, way));
      NearPoints& near = part.near_of.back();
      ++near.count;
      // Until both have moved by half of what lies between.
      near.sleeps_until = 0.5 * (std::sqrt(nearest) - SurfacePoint<D>::farthest * surfaces.spacing);
    }
  }
}

}  // namespace

template <int D>
void find_near_points(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  if (surfaces.places_of_lists.size() == surfaces.places.size()) {
    surfaces.moved = moved_since(domain);
    if (surfaces.moved < 0.5 * margin * surfaces.spacing) return;
  }
  std::vector<std::int32_t> body_of(surfaces.points.size());
  for (const SurfacePart<D>& part : surfaces.parts)
    std::fill_n(body_of.begin() + part.first_point, part.points, part.body);
  const PointBoxes<D> boxes(domain, body_of);
  const FoldedBodies<D> folded(domain, boxes.reach());
  domain.threads.for_each(surfaces.parts.size(), [&](std::size_t k) {
    find_near(domain, boxes, folded, body_of, surfaces.parts[k]);
  });
  surfaces.places_of_lists = surfaces.places;
  surfaces.moved = 0.0;
}

template void find_near_points<2>(Domain<2>&);
template void find_near_points<3>(Domain<3>&);

}  // namespace mpm
