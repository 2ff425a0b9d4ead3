#pragma once
// Which bodies may touch themselves: points of a body that are far from each other in it are those
// of another where it is folded. A body whose points are all near to where a rigid motion takes
// them is not.
#include "mpm/domain.hpp"
#include "mpm/math/inverse.hpp"

namespace mpm {

/// Where a point was in its body at the start [m].
template <int D>
Vec<double, D> place_in_body(const Domain<D>& domain, std::uint32_t c) {
  const auto& at_start = domain.surfaces.others.places_at_start;
  if (!at_start.empty()) return at_start[c];
  const ContactPoint<D>& point = domain.surfaces.points[c];
  const Host<D>& host = domain.surfaces.hosts[point.host];
  const int body = domain.surfaces.parts[host.part].body;
  return listed_place(domain.pool_of(domain.body_at(body)), host.row) + point.surface.away -
         (0.5 * domain.surfaces.spacing) * point.normal;
}

/// Points of a body that are farther from each other in it may touch [cells].
constexpr double apart_to_touch = 4.0;

template <int D>
class FoldedBodies {
 public:
  /// Points that are farther from each other than `reach` do not matter [m].
  FoldedBodies(const Domain<D>& domain, double reach)
      : domain_(domain),
        reach_(reach),
        folded_(domain.bodies.size(), false),
        as_one_(domain.bodies.size(), false),
        in_body_(domain.surfaces.points.size()) {
    const auto& parts = domain.surfaces.parts;
    for (std::size_t k = 0; k < parts.size();) {
      std::size_t end = k;
      while (end < parts.size() && parts[end].body == parts[k].body) ++end;
      const auto body = static_cast<std::size_t>(parts[k].body);
      as_one_[body] = parts[k].as_one;
      if (!parts[k].as_one) folded_[body] = is_bent({parts.data() + k, end - k});
      k = end;
    }
  }

  bool is_folded(int body) const { return folded_[static_cast<std::size_t>(body)]; }
  /// Does a body not deform?
  bool as_one(int body) const { return as_one_[static_cast<std::size_t>(body)]; }
  /// Where a point of a body that deforms is in it [m].
  const Vec<double, D>& in_body(std::uint32_t c) const { return in_body_[c]; }
  /// Are two points of a body so far from each other in it that they may touch?
  bool apart_in_body(std::uint32_t c, std::uint32_t q) const {
    const Vec<double, D> way = in_body_[c] - in_body_[q];
    return dot(way, way) > square_apart();
  }
  double square_apart() const {
    const double far = apart_to_touch * domain_.grid.cell_size;
    return far * far;
  }

 private:
  template <class F>
  static void for_each_point(std::span<const SurfacePart<D>> parts, F&& f) {
    for (const SurfacePart<D>& part : parts)
      for (std::uint32_t c = part.first_point; c < part.first_point + part.point_count; ++c) f(c);
  }

  /// Is some point far from where the rigid motion that is nearest to all takes it?
  bool is_bent(std::span<const SurfacePart<D>> parts) {
    Vec<double, D> X = Vec<double, D>::zero(), x = X;
    double count = 0.0;
    for_each_point(parts, [&](std::uint32_t c) {
      in_body_[c] = place_in_body(domain_, c);
      X += in_body_[c];
      x += domain_.surfaces.places[c];
      count += 1.0;
    });
    X = (1.0 / count) * X;
    x = (1.0 / count) * x;
    Mat<double, D> moments{};
    for_each_point(parts, [&](std::uint32_t c) {
      const Vec<double, D> from = in_body_[c] - X, to = domain_.surfaces.places[c] - x;
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < D; ++j) moments[i][j] += to[i] * from[j];
    });
    const Mat<double, D> turn = rotation_of(moments);
    // Of two points that come nearer than `reach` one is off by half of what they lack, or more.
    const double far = 0.5 * (apart_to_touch * domain_.grid.cell_size - reach_);
    bool bent = false;
    for_each_point(parts, [&](std::uint32_t c) {
      const Vec<double, D> off = domain_.surfaces.places[c] - x - product(turn, in_body_[c] - X);
      bent = bent || !(dot(off, off) < far * far);
    });
    return bent;
  }

  /// The rotation of the polar decomposition, by Newton's iteration Q <- (Q + Q^-T) / 2 (Higham
  /// 1986); any matrix serves, the nearest rotation best.
  static Mat<double, D> rotation_of(Mat<double, D> Q) {
    double size = 0.0;
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j) size = std::max(size, std::abs(Q[i][j]));
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j) Q[i][j] /= size > 0.0 ? size : 1.0;
    for (int k = 0; k < 20; ++k) {
      const Mat<double, D> inverse = inverse_of(Q);
      for (int i = 0; i < D; ++i)
        for (int j = i; j < D; ++j) {
          const double ij = 0.5 * (Q[i][j] + inverse[j][i]), ji = 0.5 * (Q[j][i] + inverse[i][j]);
          Q[i][j] = ij;
          Q[j][i] = ji;
        }
    }
    return Q;
  }

  const Domain<D>& domain_;
  double reach_;
  std::vector<bool> folded_, as_one_;    // by body
  std::vector<Vec<double, D>> in_body_;  // of each point of bodies that deform [m]
};

}  // namespace mpm
