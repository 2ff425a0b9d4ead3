#include "mpm/surfaces/near_points.hpp"

#include "mpm/surfaces/bonds.hpp"
#include "mpm/surfaces/felt.hpp"
#include "mpm/surfaces/folds.hpp"
#include "mpm/surfaces/parts.hpp"
#include "mpm/surfaces/point_boxes.hpp"
#include "mpm/surfaces/pressing.hpp"
#include "mpm/surfaces/tell_others.hpp"

namespace mpm {
namespace {

// Lists hold what is nearer than a point is felt by this more, so that they last until points have
// moved by half of it. From them those that are read in each step are taken, with a margin of their
// own.
constexpr double margin = 1.2, margin_of_awake = 0.3;  // spacings
constexpr double pressed_from = 0.1;                   // spacings
constexpr std::int64_t steps_between_speeds = 10;      // at most
constexpr std::int32_t unfelt = -1;  // the face of points that only push, and of bonds

template <int D>
double reach_of_lists(const Surfaces<D>& surfaces) {
  return surfaces.spacing * (SurfacePoint<D>::reach + margin);
}

/// The largest of some numbers of all ranks; 0 if there are none.
template <int D>
double largest_of_all(const Domain<D>& domain, const std::vector<double>& numbers) {
  const double here = numbers.empty() ? 0.0 : *std::ranges::max_element(numbers);
  return all_max(*domain.grid.partition.comm, here);
}

/// How far the farthest point has moved since lists were made [m].
template <int D>
double moved_since(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  std::vector<double>& farthest = surfaces.farthest;
  farthest.assign(surfaces.parts.size(), 0.0);
  domain.threads.for_each(surfaces.parts.size(), [&](std::size_t k) {
    const SurfacePart<D>& part = surfaces.parts[k];
    for (std::uint32_t c = part.first_point;
         !part.foreign && c < part.first_point + part.point_count; ++c) {
      const Vec<double, D> way = surfaces.places[c] - surfaces.places_of_lists[c];
      farthest[k] = std::max(farthest[k], dot(way, way));
    }
  });
  return std::sqrt(largest_of_all(domain, farthest));
}

/// The fastest that points near each other have moved against each other since lists were made
/// [m/s]. Of each point and face one stands for all.
template <int D>
double closing_speed(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  if (!(surfaces.age_of_lists > 0.0)) return surfaces.closing;
  const auto way = [&](std::uint32_t c) {
    return surfaces.places[c] - surfaces.places_of_lists[c];
  };
  std::vector<double>& farthest = surfaces.farthest;
  farthest.assign(surfaces.parts.size(), 0.0);
  domain.threads.for_each(surfaces.parts.size(), [&](std::size_t k) {
    const SurfacePart<D>& part = surfaces.parts[k];
    for (const NearPoints& near : part.near_of) {
      const Vec<double, D> apart = way(near.point) - way(part.near[near.first]);
      farthest[k] = std::max(farthest[k], dot(apart, apart));
    }
  });
  return std::sqrt(largest_of_all(domain, farthest)) / surfaces.age_of_lists;
}

/// The least boxes, in their bodies, around the points of boxes in space: what is near in both
/// has no point that may touch one of the other.
template <int D>
class BoxesInBodies {
 public:
  BoxesInBodies(const PointBoxes<D>& boxes, const FoldedBodies<D>& folded,
                const std::vector<FaceOfBody>& face_of)
      : least_(boxes.size()), square_(folded.square_apart()) {
    for (std::uint32_t c = 0; c < face_of.size(); ++c) {
      if (!folded.is_folded(face_of[c].body)) continue;
      Least& least = least_[boxes.box_of(c)];
      for (int a = 0; a < D; ++a) {
        least.low[a] = std::min(least.low[a], folded.in_body(c)[a]);
        least.high[a] = std::max(least.high[a], folded.in_body(c)[a]);
      }
    }
  }

  /// May points of two boxes of a folded body touch?
  bool may_touch(std::uint32_t one, std::uint32_t other) const {
    const Least &p = least_[one], &q = least_[other];
    double sum = 0.0;
    for (int a = 0; a < D; ++a) {
      const double most = std::max(p.high[a] - q.low[a], q.high[a] - p.low[a]);
      sum += most * most;
    }
    return sum > square_;
  }

 private:
  struct Least {
    Least() {
      for (int a = 0; a < D; ++a) low[a] = std::numeric_limits<double>::infinity();
      high = -1.0 * low;
    }
    Vec<double, D> low, high;  // [m]
  };
  std::vector<Least> least_;
  double square_;
};

/// The boxes that points of one may feel: of other bodies, one after another, and of their own if
/// that is folded.
template <int D>
class BoxesAround {
 public:
  BoxesAround(const PointBoxes<D>& boxes, const BoxesInBodies<D>& in_bodies, double reach)
      : boxes_(boxes), in_bodies_(in_bodies), square_(reach * reach) {}

  const std::vector<const PointBox<D>*>& of(std::uint32_t number, bool folds) {
    Known& known = known_[number % known_.size()];
    std::vector<const PointBox<D>*>& found = known.around;
    if (known.box == number) return found;
    known.box = number;
    found.clear();
    const PointBox<D>& middle = boxes_[number];
    constexpr int layers = D == 3 ? 1 : 0;
    for (int z = -layers; z <= layers; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          boxes_.for_each_at(
              {middle.index[0] + x, middle.index[1] + y, middle.index[2] + z},
              [&](const PointBox<D>& box) {
                if (box.face != unfelt &&
                    (box.body != middle.body ||
                     (folds && in_bodies_.may_touch(number, boxes_.number_of(box)))) &&
                    box.square_to(middle.low, middle.high) < square_)
                  found.push_back(&box);
              });
    std::ranges::sort(found, [](const PointBox<D>* p, const PointBox<D>* q) {
      return std::tie(p->body, p->face, p->first) < std::tie(q->body, q->face, q->first);
    });
    return found;
  }

 private:
  const PointBoxes<D>& boxes_;
  const BoxesInBodies<D>& in_bodies_;
  double square_;
  // Of the last few, as points go to and fro between them.
  struct Known {
    std::uint32_t box = std::numeric_limits<std::uint32_t>::max();
    std::vector<const PointBox<D>*> around;
  };
  std::array<Known, 32> known_;
};

/// The points that those of a part may feel, by body and face.
template <int D>
void find_near(const Domain<D>& domain, const PointBoxes<D>& boxes, const FoldedBodies<D>& folded,
               const BoxesInBodies<D>& in_bodies, SurfacePart<D>& part) {
  const Surfaces<D>& surfaces = domain.surfaces;
  const double reach = reach_of_lists(surfaces), square = reach * reach;
  const bool folds = folded.is_folded(part.body);
  BoxesAround<D> around(boxes, in_bodies, reach);
  part.near.clear();
  part.near_of.clear();
  for (std::uint32_t c = part.first_point; c < part.first_point + part.point_count; ++c) {
    if (!(surfaces.points[c].area > 0.0) || surfaces.points[c].face == no_face) continue;
    const Vec<double, D> here = surfaces.places[c];
    NearPoints near{c, -1, 0, 0, 0.0};
    std::int32_t face = 0;
    double nearest = 0.0;
    std::size_t first_of_body = part.near_of.size();
    const auto close_list = [&] {
      near.count = static_cast<std::uint32_t>(part.near.size()) - near.first;
      // Until both have moved by half of what lies between.
      near.sleeps_until = 0.5 * (std::sqrt(nearest) - SurfacePoint<D>::farthest * surfaces.spacing);
      if (near.count == 0) return;
      // All faces of a body wake together.
      if (first_of_body < part.near_of.size() && part.near_of[first_of_body].body != near.body)
        first_of_body = part.near_of.size();
      part.near_of.push_back(near);
      const auto of_body = std::span(part.near_of).subspan(first_of_body);
      const double wakes = std::ranges::min(of_body, {}, &NearPoints::sleeps_until).sleeps_until;
      for (NearPoints& one : of_body) one.sleeps_until = wakes;
    };
    for (const PointBox<D>* const box : around.of(boxes.box_of(c), folds)) {
      if (part.as_one && folded.as_one(box->body)) continue;
      if (is_bonded(surfaces, c, box->body)) continue;
      if (!(box->square_to(here, here) < square)) continue;
      if (box->body != near.body || box->face != face) {
        if (near.body >= 0) close_list();
        near.body = box->body;
        face = box->face;
        near.first = static_cast<std::uint32_t>(part.near.size());
        nearest = std::numeric_limits<double>::infinity();
      }
      boxes.for_each_near(*box, here, square, [&](std::uint32_t q, double apart) {
        if (box->body == part.body && !folded.apart_in_body(c, q)) return;
        part.near.push_back(q);
        nearest = std::min(nearest, apart);
      });
    }
    if (near.body >= 0) close_list();
  }
}

/// Of the lists of a part what may be felt until points have moved by `until` since these were
/// made.
template <int D>
void find_awake(const Surfaces<D>& surfaces, double until, SurfacePart<D>& part) {
  const std::vector<Vec<double, D>>& places = surfaces.places_of_lists;
  const double reach = SurfacePoint<D>::reach * surfaces.spacing + 2.0 * until;
  part.awake.clear();
  part.awake_of.clear();
  for (NearPoints near : part.near_of) {
    if (until < near.sleeps_until) continue;
    const std::uint32_t end = near.first + near.count;
    const Vec<double, D> there = places[near.point];
    const auto first = static_cast<std::uint32_t>(part.awake.size());
    for (std::uint32_t k = near.first; k < end; ++k) {
      const Vec<double, D> way = places[part.near[k]] - there;
      if (dot(way, way) < reach * reach) part.awake.push_back(part.near[k]);
    }
    near.first = first;
    near.count = static_cast<std::uint32_t>(part.awake.size()) - first;
    part.awake_of.push_back(near);
  }
}

}  // namespace

template <int D>
void make_near_lists(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  std::vector<FaceOfBody> face_of(surfaces.points.size());
  for (const SurfacePart<D>& part : surfaces.parts)
    for (std::uint32_t c = part.first_point; c < part.first_point + part.point_count; ++c)
      face_of[c] = {part.body,
                    surfaces.points[c].felt_area > 0.0 ? surfaces.points[c].face : unfelt};
  const double reach = reach_of_lists(surfaces);
  const PointBoxes<D> boxes(domain.grid.origin, reach, surfaces.places, face_of);
  const FoldedBodies<D> folded(domain, reach);
  const BoxesInBodies<D> in_bodies(boxes, folded, face_of);
  for_each_own_part(
      domain, [&](SurfacePart<D>& part) { find_near(domain, boxes, folded, in_bodies, part); });
  surfaces.awake_until = 0.0;
  if (particles_press(domain)) list_points_by_tile(domain);
}

template <int D>
void find_near_points(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  const double e = surfaces.spacing;
  const bool known = surfaces.places_of_lists.size() == surfaces.places.size();
  if (known) surfaces.moved = moved_since(domain);
  surfaces.age_of_lists += domain.time_step;
  const bool anew = !known || !(surfaces.moved < 0.5 * margin * e);
  const bool measures = known && (anew || domain.step % steps_between_speeds == 0);
  if (anew || measures || particles_press(domain)) tell_all_places(domain);
  // What is pressed slows down, and longer steps at the largest forces would make energy: the step
  // of a hit lasts until it is over.
  const bool pressed = surfaces.deepest.overlap > pressed_from * e;
  if (measures)
    surfaces.closing = std::max(closing_speed(domain), pressed ? surfaces.closing : 0.0);
  if (anew) {
    make_near_lists(domain);
    surfaces.places_of_lists = surfaces.places;
    surfaces.age_of_lists = surfaces.moved = 0.0;
  }
  if (!(surfaces.moved < surfaces.awake_until)) {
    surfaces.awake_until = surfaces.moved + 0.5 * margin_of_awake * e;
    for_each_own_part(
        domain, [&](SurfacePart<D>& part) { find_awake(surfaces, surfaces.awake_until, part); });
    ask_for_awake(domain);
  }
  tell_awake(domain);
}

template void make_near_lists<2>(Domain<2>&);
template void make_near_lists<3>(Domain<3>&);
template void find_near_points<2>(Domain<2>&);
template void find_near_points<3>(Domain<3>&);

}  // namespace mpm
