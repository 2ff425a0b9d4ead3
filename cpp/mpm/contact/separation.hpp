#pragma once
// The plane between two bodies at a node: the one that best separates the particles of one from
// those of the other. Fitted to the particles themselves, it is right at edges and corners, where
// gradients of mass are oblique (Nairn, Hammerquist & Smith 2020, who fit it by logistic
// regression). Here it is the plane of the support-vector machine with squared loss (Cortes &
// Vapnik 1995), found by Newton's method with a line search (Keerthi & DeCoste 2005).
#include <cmath>

#include "mpm/contact/near_particles.hpp"
#include "mpm/math/cholesky.hpp"

namespace mpm {

/// The fit of a plane a . x + b = 0, x in cells from the node, to the particles of two bodies: the
/// least of
///   softness |a|^2 / 2 + sum_p w_p max(0, 1 - c_p (a . x_p + b))^2 / 2,
/// c = -1 and +1 for the particles of r and s, w each body's masses over their sum. It is the
/// widest corridor between the two, of half width 1/|a|, that few particles enter.
template <int D>
class PlaneFit {
  using T = Batch<native_lanes>;
  static constexpr int n = D + 1;

 public:
  /// Axes in `held` get no component.
  PlaneFit(const NearParticles<D>& r, const NearParticles<D>& s, unsigned held)
      : r_(r), s_(s), held_(held) {
    const double mass_r = r.total(), mass_s = s.total();
    if (!(mass_r > 0.0 && mass_s > 0.0)) return;
    share_r_ = 1.0 / mass_r;
    share_s_ = 1.0 / mass_s;
    start_between_centres();
    // Some three steps; the limit is against rounding that never settles.
    constexpr int most_steps = 50;
    for (int k = 0; k < most_steps; ++k) {
      double step[n];
      newton_step(step);
      double change = 0.0, size = 0.0;
      for (int i = 0; i < n; ++i) {
        change = std::max(change, std::abs(step[i]));
        size = std::max(size, std::abs(z_[i]));
      }
      if (!(change > 1e-13 * size)) return;
      bool settled = false;
      const double t = best_length(step, settled);
      for (int i = 0; i < n; ++i) z_[i] += t * step[i];
      if (settled) return;
    }
  }

  /// The gradient a [1/cell] of the plane; zero where a body has no particles.
  Vec<double, D> gradient() const {
    Vec<double, D> a;
    for (int i = 0; i < D; ++i) a[i] = z_[i];
    return a;
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

  /// f(position, sign, share of the body's mass) over both bodies.
  template <class F>
  void for_both(F&& f) const {
    for (const auto& p : r_.lanes) f(p.x, T(-1.0), T(share_r_) * p.weight);
    for (const auto& p : s_.lanes) f(p.x, T(1.0), T(share_s_) * p.weight);
  }
  static T height(const double (&z)[n], const Vec<T, D>& x) {
    T y(z[D]);
    for (int a = 0; a < D; ++a) y += T(z[a]) * x[a];
    return y;
  }

  /// Newton's step from the gradient and the curvature at the present plane.
  void newton_step(double (&step)[n]) const {
    T slope[n], curvature[n][n];
    for (int i = 0; i < n; ++i) {
      slope[i] = T(0.0);
      for (int j = 0; j <= i; ++j) curvature[i][j] = T(0.0);
    }
    for_both([&](const Vec<T, D>& x, T sign, T share) {
      const T lack = T(1.0) - sign * height(z_, x);
      const T weight = select(lack > T(0.0), share, T(0.0));
      const T pull = sign * weight * lack;
      T point[n];
      for (int a = 0; a < D; ++a) point[a] = x[a];
      point[D] = T(1.0);
      for (int i = 0; i < n; ++i) {
        slope[i] += pull * point[i];
        const T row = weight * point[i];
        for (int j = 0; j <= i; ++j) curvature[i][j] += row * point[j];
      }
    });
    double A[n][n] = {};
    auto fixed = [&](int i) { return i < D && (held_ >> i & 1u); };
    for (int i = 0; i < n; ++i) {
      step[i] = fixed(i) ? 0.0 : sum(slope[i]) - (i < D ? softness * z_[i] : 0.0);
      for (int j = 0; j <= i; ++j) A[i][j] = fixed(i) || fixed(j) ? 0.0 : sum(curvature[i][j]);
      A[i][i] = fixed(i) ? 1.0 : A[i][i] + (i < D ? softness : damping);
    }
    solve_symmetric(A, step);
  }

  /// The length of a step at which the function is least: the root of a slope that is linear piece
  /// by piece and rises. Roughly is enough: the next step mends the rest. If the particles inside
  /// the corridor are the same after the whole step, that has led to the least: `settled`.
  double best_length(const double (&step)[n], bool& settled) const {
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
      auto changed = T(1.0) < T(0.0);
      for_both([&](const Vec<T, D>& x, T sign, T share) {
        const T gain = sign * height(step, x);
        const T before = T(1.0) - sign * height(z_, x);
        const T lack = before - T(t) * gain;
        const auto was = before > T(0.0), is = lack > T(0.0);
        changed = changed | (((was & !is) | (is & !was)) & (share > T(0.0)));
        const T pull = select(lack > T(0.0), share, T(0.0)) * gain;
        slope -= pull * lack;
        curvature += pull * gain;
      });
      if (k == 0 && !any(changed)) {
        settled = true;
        return t;
      }
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
};

/// The unit normal from r to s of the plane that separates their particles; zero if none does. All
/// particles lie within 1.5 cells of the node along each axis, so the corridor of two separate
/// bodies has a half width below 1.5 sqrt(3) = 2.6 cells; a much wider one means that the bodies
/// fill the same place.
template <int D>
Vec<double, D> separating_normal(const NearParticles<D>& r, const NearParticles<D>& s,
                                 unsigned held) {
  constexpr double widest = 4.0;  // half width [cells]
  return normalised(PlaneFit<D>(r, s, held).gradient(), 1.0 / widest);
}

}  // namespace mpm
