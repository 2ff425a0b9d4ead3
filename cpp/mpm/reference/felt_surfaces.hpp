#pragma once
// Surfaces as a place feels them, in the reference step: the sum over points, the energy of a
// spring and its derivatives. Nothing is listed.
#include <map>

#include "mpm/reference/surface_points.hpp"
#include "mpm/reference/surface_touch.hpp"

namespace mpm::reference {

template <int D>
struct FeltSurfaces {
  const Step<D>& step;
  double e = 0.0;  // spacing of points [m]
  std::vector<SurfaceBody<D>> bodies{};
  Height<D> height{e};

  double height_over(Whom face, double x) const {
    const auto axis = static_cast<std::size_t>(axis_of(face));
    return side_of(face) == 0 ? x : step.h * step.walls.cells[axis] - x;
  }
  SurfaceBody<D>& other(const SurfaceTouch<D>& t) {
    return bodies[static_cast<std::size_t>(t.whom)];
  }
  const SurfaceBody<D>& other(const SurfaceTouch<D>& t) const {
    return bodies[static_cast<std::size_t>(t.whom)];
  }

  /// o = e - b - e zeta or e / 2 - b - z.
  double overlap(const SurfaceTouch<D>& t) const {
    return (is_wall(t.whom) ? 0.5 * e : e) - t.b - t.z;
  }

  /// Which points of the other body a place and its images feel, and how high it is over them. Is
  /// there any? `unfelt(point)` leaves some out.
  bool feel(SurfaceTouch<D>& t, const Vec<double, D>& x) const {
    return feel(t, x, [](const ContactPoint<D>&) { return false; });
  }
  template <class Unfelt>
  bool feel(SurfaceTouch<D>& t, const Vec<double, D>& x, Unfelt&& unfelt) const {
    std::map<int, double> of_face;
    for_each_mirror(step.h, step.walls_of(other(t).body()), [&](const Mirror<D>& mirror) {
      for (std::size_t q = 0; q < other(t).points.size(); ++q) {
        const ContactPoint<D>& c = other(t).points[q];
        if (!(c.A_felt > 0.0) || unfelt(c)) continue;
        const double weight = height.weight(square(c.x, mirror.place(x)));
        if (!(weight > 0.0)) continue;
        t.felt.push_back({q, mirror, c.A_felt / std::pow(e, D - 1) * weight});
        of_face[c.face] += t.felt.back().share;
      }
    });
    if (of_face.empty()) return false;
    const double S = of_all_faces(of_face);
    for (Felt<D>& felt : t.felt)  // dS/dS_f over S
      felt.share *= std::pow(of_face.at(other(t).points[felt.q].face) / S, 3) / S;
    t.z = e * height.zeta(S);
    return true;
  }
  /// The energy of the spring of a touch, of the places of p and of the points that it feels, (S3).
  template <class T>
  T energy(const SurfaceTouch<D>& t, const Vec<T, D>& p, const std::vector<Vec<T, D>>& q) const {
    if (is_wall(t.whom)) {
      const T& x = p[axis_of(t.whom)];
      const T z = side_of(t.whom) == 0 ? x : height_over(t.whom, 0.0) - x;
      return t.k * stored<T>(0.5 * e - t.b - z, t.w);
    }
    std::map<int, T> sums;
    for (std::size_t j = 0; j < q.size(); ++j) {
      const ContactPoint<D>& c = other(t).points[t.felt[j].q];
      sums[c.face] +=
          c.A_felt / std::pow(e, D - 1) * height.weight(square(q[j], t.felt[j].mirror.place(p)));
    }
    return t.k * stored<T>(e - t.b - e * height.zeta(of_all_faces(sums)), t.w);
  }

  /// - dE/dx to p and to all that it feels. Of E(x + i d) the imaginary part is d dE/dx, exact with
  /// a d of which the square is nothing (Squire & Trapp 1998). Returns E.
  double press(SurfaceTouch<D>& t, const Vec<double, D>& x_p) {
    using Complex = std::complex<double>;
    const auto complex = [](const Vec<double, D>& x) {
      Vec<Complex, D> z;
      for (int a = 0; a < D; ++a) z[a] = x[a];
      return z;
    };
    Vec<Complex, D> p = complex(x_p);
    std::vector<Vec<Complex, D>> q;
    q.reserve(t.felt.size());
    for (const Felt<D>& felt : t.felt) q.push_back(complex(other(t).points[felt.q].x));
    const auto force_at = [&](Vec<Complex, D>& x) {
      const double d = 1e-30 * e;
      Vec<double, D> force;
      for (int a = 0; a < D; ++a) {
        x[a].imag(d);
        force[a] = -std::imag(energy(t, p, q)) / d;
        x[a].imag(0.0);
      }
      return force;
    };
    t.push = force_at(p);
    for (std::size_t j = 0; j < q.size(); ++j) t.felt[j].push = force_at(q[j]);
    return std::real(energy(t, p, q));
  }

  /// To all that a touch feels.
  void give_to_felt(const SurfaceTouch<D>& t) {
    for (const Felt<D>& felt : t.felt) {
      const ContactPoint<D>& c = other(t).points[felt.q];
      other(t).push(c, felt.push);
      if (t.rubs)
        other(t).rub(c, felt.mirror.place(t.place), felt.mirror.vector(-felt.share * t.rub));
    }
  }
};

}  // namespace mpm::reference
