#pragma once
// The plane between two bodies at a node: the one that best separates the particles of one from
// those of the other. Fitted to the particles themselves, it is right at edges and corners, where
// gradients of mass are oblique (Nairn, Hammerquist & Smith 2020, who fit it by logistic
// regression). Here it is the plane of the support-vector machine with squared loss (Cortes &
// Vapnik 1995), found by Newton's method with a line search (Keerthi & DeCoste 2005).
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mpm/contact/near_particles.hpp"
#include "mpm/math/cholesky.hpp"

namespace mpm {

/// A plane a . x + b = 0, x in cells; none if a is zero. a points from one body to another and has
/// the inverse of the half width of the corridor between them as its length.
template <int D>
struct Plane {
  Vec<double, D> a = Vec<double, D>::zero();  // [1/cell]
  double b = 0.0;

  bool exists() const { return dot(a, a) > 0.0; }
  /// The same plane when x counts from another origin.
  Plane seen_from(const Index<D>& origin) const {
    Plane plane = *this;
    for (int k = 0; k < D; ++k) plane.b += a[k] * origin[static_cast<std::size_t>(k)];
    return plane;
  }
  Plane reversed() const { return {-1.0 * a, -b}; }
};

/// The fit of a plane a . x + b = 0, x in cells from the node, to the particles of two bodies: the
/// least of
///   softness |a|^2 / 2 + sum_p w_p max(0, 1 - c_p (a . x_p + b))^2 / 2,
/// c = -1 and +1 for the particles of r and s, w each body's masses over their sum. It is the
/// widest corridor between the two, of half width 1/|a|, that few particles enter.
template <int D>
class PlaneFit {
  using T = Batch<contact_lanes<D>>;
  static constexpr int n = D + 1;

 public:
  /// Axes in `held` get no component. A plane near the answer saves steps, and changes nothing
  /// else.
  PlaneFit(const NearParticles<D>& r, const NearParticles<D>& s, unsigned held,
           const Plane<D>& start)
      : r_(r), s_(s), held_(held) {
    if (r.count() == 0 || s.count() == 0) return;
    share_r_ = 1.0 / r.mass();
    share_s_ = 1.0 / s.mass();
    thread_local std::vector<T> inside;  // kept, so that fits do not allocate
    inside.assign((r.count() + s.count()) / T::lanes + 2, T(0.0));
    inside_ = inside.data();
    if (start.exists()) {
      for (int i = 0; i < D; ++i) z_[i] = held >> i & 1u ? 0.0 : start.a[i];
      z_[D] = start.b;
    } else {
      start_between_centres();
    }
    find_least();
  }

  /// None where a body has no particles.
  Plane<D> plane() const {
    Plane<D> plane;
    for (int i = 0; i < D; ++i) plane.a[i] = z_[i];
    plane.b = z_[D];
    return plane;
  }

 private:
  // Chosen by tests, not by theory (decision 0008): a third of it lets single particles turn the
  // normal, and two finely divided rings lose their symmetry; more keeps part of the slope of a
  // corner, and friction on a sliding block is one to two per cent off.
  static constexpr double softness = 4e-3;
  // Keeps the system regular where no particle is inside the corridor.
  static constexpr double damping = 1e-12;

  /// Start with the plane midway between the bodies' centres of mass, both on the corridor's edges.
  void start_between_centres() {
    const Vec<double, D> r = r_.centre(), s = s_.centre();
    double apart[D], square = 0.0, middle = 0.0;
    for (int a = 0; a < D; ++a) {
      apart[a] = held_ >> a & 1u ? 0.0 : s[a] - r[a];
      square += apart[a] * apart[a];
      middle += apart[a] * 0.5 * (r[a] + s[a]);
    }
    if (!(square > 0.0)) return;
    for (int a = 0; a < D; ++a) z_[a] = 2.0 * apart[a] / square;
    z_[D] = -2.0 * middle / square;
  }

  /// Newton's method. Between the places where a particle enters or leaves the corridor the
  /// function is a quadratic; once its least has the same particles inside as before, that is the
  /// answer.
  void find_least() {
    // Some three steps; the limit is against rounding that never settles.
    constexpr int most_steps = 50;
    bool changed = false;
    double value = classify(z_, changed);
    for (int k = 0; k < most_steps; ++k) {
      double z[n], step[n], change = 0.0, size = 0.0;
      least_of_quadratic(z);
      for (int i = 0; i < n; ++i) {
        step[i] = z[i] - z_[i];
        change = std::max(change, std::abs(step[i]));
        size = std::max(size, std::abs(z_[i]));
      }
      double there = classify(z, changed);
      const bool settled = !changed || !(change > 1e-13 * size);
      if (!settled && !(there < value)) {  // too long a step
        const double t = best_length(step);
        for (int i = 0; i < n; ++i) z[i] = z_[i] + t * step[i];
        there = classify(z, changed);
        if (!(there < value)) return;  // as near as rounding lets it come
      }
      std::copy(z, z + n, z_);
      value = there;
      if (settled) return;
    }
  }

  /// f(position, sign, share of the body's mass, share of it that is inside) over both bodies.
  template <class F>
  void for_both(F&& f) {
    T* inside = inside_;
    r_.for_each(
        [&](const Vec<T, D>& x, T, T weight) { f(x, T(-1.0), T(share_r_) * weight, *inside++); });
    s_.for_each(
        [&](const Vec<T, D>& x, T, T weight) { f(x, T(1.0), T(share_s_) * weight, *inside++); });
  }
  static T height(const double (&z)[n], const Vec<T, D>& x) {
    T y(z[D]);
    for (int a = 0; a < D; ++a) y += T(z[a]) * x[a];
    return y;
  }

  /// Which particles are inside a plane's corridor or beyond; gives the function there, and whether
  /// they are others than before.
  double classify(const double (&z)[n], bool& changed) {
    T lacks(0.0);
    auto others = T(1.0) < T(0.0);
    for_both([&](const Vec<T, D>& x, T sign, T share, T& inside) {
      const T lack = T(1.0) - sign * height(z, x);
      const T now = select(lack > T(0.0), share, T(0.0));
      others = others | (now < inside) | (now > inside);
      inside = now;
      lacks += now * lack * lack;
    });
    changed = any(others);
    double value = sum(lacks);
    for (int i = 0; i < D; ++i) value += softness * z[i] * z[i];
    return 0.5 * value;
  }

  /// The least of the function as it were if those inside now always were. It does not depend on
  /// where the search started.
  void least_of_quadratic(double (&z)[n]) {
    T second[D][D], first[n];  // sums of share x x^T, and of sign share (x, 1)
    T mean[n];                 // and of share (x, 1)
    for (int i = 0; i < n; ++i) {
      first[i] = mean[i] = T(0.0);
      for (int j = 0; j <= i && i < D; ++j) second[i][j] = T(0.0);
    }
    for_both([&](const Vec<T, D>& x, T sign, T, const T& inside) {
      first[D] += sign * inside;
      mean[D] += inside;
      for (int i = 0; i < D; ++i) {
        const T moment = inside * x[i];
        first[i] += sign * moment;
        mean[i] += moment;
        for (int j = 0; j <= i; ++j) second[i][j] += moment * x[j];
      }
    });
    double A[n][n] = {};
    const auto fixed = [&](int i) { return i < D && (held_ >> i & 1u); };
    for (int i = 0; i < n; ++i) {
      z[i] = fixed(i) ? 0.0 : sum(first[i]);
      for (int j = 0; j <= i; ++j)
        A[i][j] = fixed(i) || fixed(j) ? 0.0 : sum(i < D ? second[i][j] : mean[j]);
      A[i][i] = fixed(i) ? 1.0 : A[i][i] + (i < D ? softness : damping);
    }
    solve_symmetric(A, z);
  }

  /// The length of a step at which the function is least: the root of a slope that is linear piece
  /// by piece and rises. Roughly is enough: the next step mends the rest.
  double best_length(const double (&step)[n]) {
    constexpr int most_trials = 20;
    constexpr double tolerance = 0.1;
    double along = 0.0, square = 0.0;
    for (int i = 0; i < D; ++i) {
      along += softness * z_[i] * step[i];
      square += softness * step[i] * step[i];
    }
    double t = 1.0;
    for (int k = 0; k < most_trials; ++k) {
      T slope(0.0), curvature(0.0);
      for_both([&](const Vec<T, D>& x, T sign, T share, const T&) {
        const T gain = sign * height(step, x);
        const T lack = T(1.0) - sign * height(z_, x) - T(t) * gain;
        const T pull = select(lack > T(0.0), share, T(0.0)) * gain;
        slope -= pull * lack;
        curvature += pull * gain;
      });
      const double stiffness = sum(curvature) + square;
      if (!(stiffness > 0.0)) break;
      const double change = (sum(slope) + along + t * square) / stiffness;
      t -= change;
      if (!(std::abs(change) > tolerance * t)) break;
    }
    return t;
  }

  const NearParticles<D>& r_;
  const NearParticles<D>& s_;
  unsigned held_;
  double share_r_ = 0.0, share_s_ = 0.0;
  double z_[n] = {};
  T* inside_ = nullptr;  // of each lane the share that is inside; the thread's until its next fit
};

/// The unit normal from r to s of the plane that separates their particles; zero if none does. All
/// particles lie within 1.5 cells of the node along each axis, so the corridor of two separate
/// bodies has a half width below 1.5 sqrt(3) = 2.6 cells; a much wider one means that the bodies
/// fill the same place. `plane` is where to start, if it exists, and then the plane that was found.
template <int D>
Vec<double, D> separating_normal(const NearParticles<D>& r, const NearParticles<D>& s,
                                 unsigned held, Plane<D>& plane) {
  constexpr double widest = 4.0;  // half width [cells]
  plane = PlaneFit<D>(r, s, held, plane).plane();
  return normalised(plane.a, 1.0 / widest);
}

/// The planes between the bodies around one tile that were found last, x from the tile's first
/// node.
template <int D>
class LastPlanes {
 public:
  void forget() { known_.clear(); }
  /// f(plane) with the plane from body r to body s, x from a node, which f may change.
  template <class F>
  void with(int r, int s, Index<D> node, F&& f) {
    auto at = std::ranges::find(known_, std::pair(std::min(r, s), std::max(r, s)), &Known::bodies);
    if (at == known_.end()) at = known_.insert(at, {std::pair(std::min(r, s), std::max(r, s)), {}});
    Plane<D> plane = at->plane.seen_from(node);
    if (r > s) plane = plane.reversed();
    f(plane);
    if (r > s) plane = plane.reversed();
    for (auto& i : node) i = -i;
    at->plane = plane.seen_from(node);
  }

 private:
  struct Known {
    std::pair<int, int> bodies;
    Plane<D> plane;
  };
  std::vector<Known> known_;
};

}  // namespace mpm
