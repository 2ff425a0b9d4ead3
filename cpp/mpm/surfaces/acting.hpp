#pragma once
// What contact between surfaces comes to for hosts and for bodies as wholes, in the order of the
// parts and their touches, whichever ranks have these.
#include "mpm/comm/letters.hpp"
#include "mpm/surfaces/as_one.hpp"
#include "mpm/surfaces/press.hpp"

namespace mpm {

/// What a point gets by a touch or a bond of another's: a push, and a rub at a place if it rubs.
template <int D>
struct GivenToPoint {
  std::uint64_t order = 0;  // the part's number; of a bond, that of all parts + its own
  std::uint32_t point = 0;
  bool rubs = false;
  Vec<double, D> push, rub, place;
};

template <int D>
class Acting {
 public:
  explicit Acting(Domain<D>& domain) : domain_(domain), surfaces_(domain.surfaces) {
    for (const ActingOnHost<D>& one : surfaces_.on_hosts) surfaces_.place_on_hosts[one.host] = 0;
    surfaces_.on_hosts.clear();
    surfaces_.F_on_hosts.clear();
    surfaces_.on_bodies.clear();
    surfaces_.on_bodies_by_part.clear();
  }
  /// To a point of an own part, or of a body that does not deform.
  void push(std::uint64_t order, std::uint32_t point, const Vec<double, D>& force) {
    const ContactPoint<D>& at = surfaces_.points[point];
    if (ActingOnBody* const body = body_of(order, at)) {
      body->push.add(in_space<D>(force), in_space<D>(surfaces_.places[point]));
      return;
    }
    ActingOnHost<D>& host = on(at.host);
    host.push.add(force, at.surface);
    const Mat<double, D>& F = surfaces_.F_on_hosts[surfaces_.place_on_hosts[at.host] - 1];
    host.push.add_moment(force, Fibre<D>(F, at.normal, behind_surface(surfaces_, at)));
  }
  void rub(std::uint64_t order, std::uint32_t point, const Vec<double, D>& force,
           const PlaceAtHost<D>& reach, const Vec<double, D>& place) {
    const ContactPoint<D>& at = surfaces_.points[point];
    if (ActingOnBody* const body = body_of(order, at)) {
      body->rub.add(in_space<D>(force), in_space<D>(place));
      return;
    }
    on(at.host).rub.add(force, reach);
  }
  /// To whatever point.
  void give(const GivenToPoint<D>& given) {
    push(given.order, given.point, given.push);
    if (given.rubs)
      rub(given.order, given.point, given.rub, reach_of(domain_, given.point, given.place),
          given.place);
  }
  /// Is a point that of another rank, whose hosts it alone knows?
  bool is_elsewhere(std::uint32_t point) const {
    const SurfacePart<D>& part = part_of_point(surfaces_, point);
    return part.foreign && !part.as_one;
  }
  void finish() {
    std::ranges::sort(surfaces_.on_hosts, {}, &ActingOnHost<D>::host);
    for (std::size_t k = 0; k < surfaces_.on_hosts.size(); ++k)
      surfaces_.place_on_hosts[surfaces_.on_hosts[k].host] = static_cast<std::uint32_t>(k + 1);
    // On bodies as wholes first by part, then all.
    std::vector<OnBodyByPart>& parts = surfaces_.on_bodies_by_part;
    entries_of_all(*domain_.grid.partition.comm, parts);
    std::ranges::sort(parts, [](const OnBodyByPart& x, const OnBodyByPart& y) {
      return x.on.body != y.on.body ? x.on.body < y.on.body : x.place < y.place;
    });
    for (const OnBodyByPart& one : parts) {
      ActingOnBody& all = acting_on_body(surfaces_.on_bodies, one.on.body);
      all.push += one.on.push;
      all.rub += one.on.rub;
    }
  }

 private:
  ActingOnHost<D>& on(std::uint32_t host) {
    std::uint32_t& place = surfaces_.place_on_hosts[host];
    if (place == 0) {
      surfaces_.on_hosts.push_back({host, {}, {}});
      surfaces_.F_on_hosts.push_back(deformation_at(domain_, host).F);
      place = static_cast<std::uint32_t>(surfaces_.on_hosts.size());
    }
    return surfaces_.on_hosts[place - 1];
  }
  /// None if the point's body deforms.
  ActingOnBody* body_of(std::uint64_t order, const ContactPoint<D>& point) {
    const SurfacePart<D>& part = surfaces_.parts[surfaces_.hosts[point.host].part];
    if (!part.as_one) return nullptr;
    // Those of one part follow one another; few bodies are among them.
    std::vector<OnBodyByPart>& parts = surfaces_.on_bodies_by_part;
    for (auto one = parts.rbegin(); one != parts.rend() && one->place == order; ++one)
      if (one->on.body == part.body) return &one->on;
    OnBodyByPart& made = parts.emplace_back();
    made.place = order;
    made.on.body = part.body;
    return &made.on;
  }

  Domain<D>& domain_;
  Surfaces<D>& surfaces_;
};

}  // namespace mpm
