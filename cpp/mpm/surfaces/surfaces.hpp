#pragma once
// Contact between the surfaces of bodies: plain data. Each body has contact points half a spacing e
// behind the surface that its shape has, each carried by the particle nearest to it, its host:
//   x_s = x_p + F_p d + sum_k b_k d2u/dX_k^2,   x_c = x_s - (e / 2) F_p N / |F_p N|.          (S0)
// A step ends with
//   parts.hpp           where they are, (S0); as_one.hpp: of what does not deform
//   near_points.hpp     which may feel each other: lists
//   approaches.hpp      how far off springs may begin
//   overlaps.hpp        which overlap a face of the box or another body, and how deep (felt.hpp)
//   bonds.hpp           what is bonded pulls
//   press.hpp           springs of an energy, and Coulomb friction that remembers (law.hpp)
//   pressing.hpp        particles of what flows, whose nodes lie in space, likewise
//   between.hpp         what pairs of bodies come to; restitution.hpp: what these do not get back
//   touch_surfaces.cpp  (read it second) what comes to hosts, and to their nodes in the next step
// Beside these levelled.hpp lets faces lie flat that are drawn touching, mirrored.hpp has images
// behind walls, tell_others.hpp is for ranks; and between steps points are made anew:
//   renew_points.hpp    where nodes are laid anew; uncover.hpp: where particles have failed
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "mpm/layout/tile.hpp"
#include "mpm/math/tensor.hpp"
#include "mpm/surfaces/acting_on_bodies.hpp"
#include "mpm/surfaces/other_ranks.hpp"
#include "mpm/surfaces/pressing_touches.hpp"

namespace mpm {

/// The face of points whose hosts have failed (uncover.hpp): these are no surface of the body, and
/// only walls stop them.
constexpr std::int32_t no_face = -1;

/// A contact point as it is given, before its host has a row.
template <int D>
struct GivenPoint {
  int body = 0;
  std::uint32_t particle = 0;  // number of its host in the body
  Vec<double, D> offset;       // from the host to its place on the surface, at the start [m]
  Vec<double, D> normal;       // out of the body, of unit length
  double area = 0.0;           // that it pushes for [m^2; in 2D m times 1 m]
  double felt_area = 0.0;      // by which others feel it: of its share of its face [the same]
  std::int32_t face = 0;       // of its body, or no_face
  std::uint32_t number = 0;    // as it was given, while bonds are made
};

template <int D>
struct ContactPoint {
  std::uint32_t host = 0;
  std::int32_t face = 0;   // of its body, or no_face
  PlaceAtHost<D> surface;  // its place on the surface
  Vec<double, D> normal;   // out of the body at the start
  double area = 0.0;       // that it pushes for [m^2; in 2D m times 1 m]
  double felt_area = 0.0;  // by which others feel it [the same]
};

/// What a contact point keeps of its contact with an opposite.
template <class Value>
struct KeptOfContact {
  std::uint32_t point = 0;
  Opposite opposite = 0;
  Value value{};

  friend bool operator<(const KeptOfContact& x, const KeptOfContact& y) {
    return x.point != y.point ? x.point < y.point : x.opposite < y.opposite;
  }
};

/// What is kept of a point and an opposite; null if nothing is.
template <class Kept>
auto* find_kept(Kept& all, std::uint32_t point, Opposite opposite) {
  const typename Kept::value_type wanted{point, opposite, {}};
  const auto at = std::ranges::lower_bound(all, wanted, std::less<>{});
  return at != all.end() && !(wanted < *at) ? &at->value : nullptr;
}

/// What a touch remembers of the steps before, until the point parts.
template <int D>
struct MemoryOfTouch {
  Vec<double, D> slip = Vec<double, D>::zero();  // of the spring of friction [m]
  double onset = 0.0;                            // way over which the other one begins [m]
};

/// Of a point that is drawn touching a face where that sinks beside an edge (levelled.hpp) [m].
template <int D>
struct Levelled {
  double by = 0.0, first = 0.0;                  // how much deeper the point counts, now and first
  double gap = 0.0;                              // scratch: what lies between now
  Vec<double, D> slid = Vec<double, D>::zero();  // since the start
};

/// How fast two bodies, or one and a face, have approached each other at a touch, at most.
struct Approach {
  int a = 0;
  Opposite b = 0;
  double speed = 0.0;  // [m/s]

  friend bool operator<(const Approach& x, const Approach& y) {
    return x.a != y.a ? x.a < y.a : x.b < y.b;
  }
};

/// A point that overlaps or may begin to an opposite.
template <int D>
struct SurfaceTouch {
  std::uint32_t point = 0;
  Opposite opposite = 0;
  double overlap = 0.0;     // [m]
  double stiffness = 0.0;   // [N/m]
  double pressed_in = 0.0;  // of the overlap, what the spring is pressed in by [m]
  Vec<double, D> slope;     // of the overlap with the point's place, backwards: where it is pushed
  Vec<double, D> push;      // on the point, by the spring [N]
  Vec<double, D> rub;       // at the place of contact, by friction [N]
  Vec<double, D> arm;       // from the point to that place [m]
  PlaceAtHost<D> reach;     // that place in the body at the start
  double rub_work = 0.0;    // taken by friction in the step [J]
  // The points of the other body that it feels, of SurfacePart::felt.
  std::uint32_t first_felt = 0, felt_count = 0;
};

/// Points of a face of another body that may be near to a point.
struct NearPoints {
  std::uint32_t point = 0;
  std::int32_t body = 0;
  std::uint32_t first = 0, count = 0;  // of SurfacePart::near, or awake
  // They cannot be felt until some point has moved by so much since the lists were made [m].
  double sleeps_until = 0.0;
};

/// A contact point that is held to a place of another body (bonds.hpp).
template <int D>
struct Bond {
  std::uint32_t first = 0, second = 0;  // the point; that of the place
  int from = 0, body = 0;               // whose they are
  double stiffness = 0.0;               // [N/m]
  Vec<double, D> pull;                  // on the first, after the last step [N]
};

/// The points whose hosts lie in one tile of a body, which one thread takes; of a body that does
/// not deform all of them, which go with it.
template <int D>
struct SurfacePart {
  int body = 0;
  Index<D> tile{};
  bool as_one = false;   // of a body that does not deform
  bool foreign = false;  // another rank's
  int rank = 0;          // whose it is
  // Of that body and tile, as long as patches stay what they are; none of a body that does not
  // deform.
  std::uint32_t patch = 0;
  std::uint32_t first_host = 0, host_count = 0, first_point = 0, point_count = 0;
  // Of the farthest way of its points in the last step, of own ones, where it is known [m^2].
  double square_of_step = std::numeric_limits<double>::infinity();

  std::vector<SurfaceTouch<D>> touches;                          // by point
  std::vector<KeptOfContact<MemoryOfTouch<D>>> kept, kept_next;  // by point and opposite
  std::vector<KeptOfContact<Levelled<D>>> levelled;              // by point and opposite
  std::vector<std::pair<Opposite, double>> begun;                // touches of the step, how fast
  double stored_push = 0.0, stored_rub = 0.0;                    // in the springs [J]
  std::vector<NearPoints> near_of;                               // by point, body and face
  std::vector<std::uint32_t> near;                               // points
  std::vector<NearPoints> awake_of;                              // of these what may be felt by now
  std::vector<std::uint32_t> awake;
  std::vector<FeltPoint<D>> felt;  // by touches
  std::vector<double> face_sums;   // scratch: of the faces of a body that a point feels
  // By the walls of the box in the coming step, with the moment about the origin [N, N m].
  FaceImpulses<D> by_walls;
  Vector3 moment_by_walls = Vector3::zero();
  bool at_walls = false;  // is there any?
};

/// The point that is deepest in the surface of another body after a step.
template <int D>
struct DeepestPoint {
  int body = -1;
  double overlap = 0.0;  // [m]
  Vec<double, D> place = Vec<double, D>::zero();
};
/// That of a rank, with the number of its part.
template <int D>
struct DeepestOfRank {
  std::uint64_t part = 0;
  DeepestPoint<D> point;
};

template <int D>
struct Surfaces {
  std::vector<GivenPoint<D>> given;     // until the bodies have rows
  std::vector<std::uint32_t> given_of;  // of each point its place among these, until then
  double spacing = 0.0;  // e: the points of all bodies lie half of it behind their surfaces [m]
  bool meet = false;     // do bodies touch each other by them?
  int pressed_by = 0;    // bodies that deform and whose nodes lie in space

  std::vector<SurfacePart<D>> parts;  // by body, then by tile
  OtherRanks<D> others;
  std::vector<std::int32_t> part_of;    // of each patch; -1: it has none
  std::vector<Host<D>> hosts;           // by part
  std::vector<ContactPoint<D>> points;  // by host
  std::vector<Vec<double, D>> places;   // of the points, after the last step [m]
  // Of each point its number at the start, once numbers have changed (renew_points.hpp).
  std::vector<std::uint32_t> first_numbers;
  std::vector<KeptOfContact<double>> set_back;  // by how much they overlapped at the start [m]
  std::vector<Bond<D>> bonds;                   // by their first points

  std::vector<Vec<double, D>> places_of_lists;  // where points were when NearPoints were found
  double age_of_lists = 0.0;                    // for how long it is [s]
  double moved = 0.0;                           // by the farthest of them since [m]
  double closing = 0.0;      // by how fast points near each other have moved since, at most [m/s]
  double awake_until = 0.0;  // by so much, SurfacePart::awake serves [m]
  std::vector<HostInTouch<D>> in_touch;        // hosts
  std::vector<std::uint32_t> moving;           // the numbers of these
  std::vector<std::uint32_t> place_of_motion;  // of each host, 1 + where that is, or 0
  std::vector<Approach> approaches;            // so far, by pair
  double longest_onset = 0.0;  // over which springs begin in this step, at most, (S4) [m]
  std::vector<ActingBetween<D>> between;         // bodies, by pair
  std::vector<BetweenByPart<D>> between_parts;   // scratch
  std::vector<OnBodyByPart> on_bodies_by_part;   // scratch
  std::vector<ActingOnBody> on_bodies;           // that do not deform, by body
  std::vector<ActingOnHost<D>> on_hosts;         // by host; in the coming step
  std::vector<std::uint32_t> place_on_hosts;     // scratch: of each host, 1 + where it is, or 0
  std::vector<Mat<double, D>> F_on_hosts;        // scratch: of those
  std::vector<DeepestOfRank<D>> deepest_of_all;  // scratch: of the ranks
  std::vector<double> farthest;                  // scratch: of each part, the square of a way [m^2]
  double stored_push = 0.0, stored_rub = 0.0;    // in the springs after the last step [J]

  std::vector<PointInTile<D>> by_tile;     // points that may be felt, where lists were made
  std::vector<PressingPatch<D>> pressing;  // particles in touch, after the last step
  PressedWalls<D> pressed_walls;

  DeepestPoint<D> deepest;
  std::size_t touching = 0, touching_max = 0;  // points that are pushed, now and since the start

  bool exist() const { return !points.empty(); }
};

/// The part that a point belongs to.
template <int D>
const SurfacePart<D>& part_of_point(const Surfaces<D>& surfaces, std::uint32_t point) {
  return surfaces.parts[surfaces.hosts[surfaces.points[point].host].part];
}

/// A point of a part goes on to a place.
template <int D>
void move_point(Surfaces<D>& surfaces, SurfacePart<D>& part, std::uint32_t point,
                const Vec<double, D>& to) {
  const Vec<double, D> way = to - surfaces.places[point];
  part.square_of_step = std::max(part.square_of_step, dot(way, way));
  surfaces.places[point] = to;
}

/// By how much the surface of a point is set back towards an opposite [m].
template <int D>
double set_back_of(const Surfaces<D>& surfaces, std::uint32_t point, Opposite opposite) {
  const double* const found = find_kept(surfaces.set_back, point, opposite);
  return found ? *found : 0.0;
}

}  // namespace mpm
