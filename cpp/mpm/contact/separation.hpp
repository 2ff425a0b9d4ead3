#pragma once
// The plane between two bodies at a node: the one that best separates the particles of one from
// those of the other. Fitted to the particles themselves, it is right at edges and corners, where
// gradients of mass are oblique (Nairn, Hammerquist & Smith 2020, who fit it by logistic
// regression). Here it is the plane of the support-vector machine with squared loss (Cortes &
// Vapnik 1995), found by Newton's method with exact line search (Keerthi & DeCoste 2005).
#include <cmath>

#include "mpm/contact/near_particles.hpp"

namespace mpm {

/// Solve A z = y, A symmetric and positive definite with its lower triangle given, by Cholesky's
/// method in place: y becomes z.
template <int n>
void solve_symmetric(double (&A)[n][n], double (&y)[n]) {
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) A[j][j] -= A[j][k] * A[j][k];
    A[j][j] = std::sqrt(A[j][j]);
    for (int i = j + 1; i < n; ++i) {
      for (int k = 0; k < j; ++k) A[i][j] -= A[i][k] * A[j][k];
      A[i][j] /= A[j][j];
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) y[i] -= A[i][k] * y[k];
    y[i] /= A[i][i];
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) y[i] -= A[k][i] * y[k];
    y[i] /= A[i][i];
  }
}

/// A plane z . (x, 1) = 0 fitted to two bodies' particles.
template <int D>
class SeparatingPlane {
  using T = Batch<native_lanes>;
  static constexpr int n = D + 1;

 public:
  /// Minimise over the plane a . x + b = 0, x in cells from the node,
  ///   softness |a|^2 / 2 + sum_p w_p max(0, 1 - c_p (a . x_p + b))^2 / 2,
  /// c = -1 and +1 for the particles of r and s, w each body's masses over their sum: the widest
  /// corridor between the two, of half width 1/|a|, that few particles enter. Axes in `held` get no
  /// component.
  SeparatingPlane(NearParticles<D>& r, NearParticles<D>& s, unsigned held) : r_(r), s_(s) {
    T mass_r(0.0), mass_s(0.0);
    for (const auto& p : r.lanes) mass_r += p.weight;
    for (const auto& p : s.lanes) mass_s += p.weight;
    if (!(sum(mass_r) > 0.0 && sum(mass_s) > 0.0)) return;
    share_r_ = 1.0 / sum(mass_r);
    share_s_ = 1.0 / sum(mass_s);
    // 3 to 19 steps where it was counted; the limit is against rounding that never settles.
    constexpr int most_steps = 50;
    for (int k = 0; k < most_steps; ++k) {
      double step[n];
      newton_step(held, step);
      const double t = best_length(step);
      double change = 0.0, size = 0.0;
      for (int i = 0; i < n; ++i) {
        z_[i] += t * step[i];
        change = std::max(change, std::abs(t * step[i]));
        size = std::max(size, std::abs(z_[i]));
      }
      if (!(change > 1e-13 * size)) return;
    }
  }

  /// The unit normal from r to s; zero if no direction separates them.
  Vec<double, D> normal() const {
    Vec<double, D> a;
    for (int i = 0; i < D; ++i) a[i] = z_[i];
    return normalised(a, 1e-6);
  }

 private:
  // Chosen by tests, not by theory (decision 0008): a tenth of it lets single particles turn the
  // normal, and two rings lose their symmetry; five times as much keeps part of the slope of a
  // corner, and a block on an incline is braked.
  static constexpr double softness = 1.5e-3;

  /// f(particles, sign, share of the body's mass) over both bodies.
  template <class F>
  void for_both(F&& f) {
    for (auto& p : r_.lanes) f(p, T(-1.0), T(share_r_) * p.weight);
    for (auto& p : s_.lanes) f(p, T(1.0), T(share_s_) * p.weight);
  }
  static T height(const double (&z)[n], const Vec<T, D>& x) {
    T y(z[D]);
    for (int a = 0; a < D; ++a) y += T(z[a]) * x[a];
    return y;
  }

  /// Newton's step from the gradient and the curvature at the present plane.
  void newton_step(unsigned held, double (&step)[n]) {
    T slope[n], curvature[n][n];
    for (int i = 0; i < n; ++i) {
      slope[i] = T(0.0);
      for (int j = 0; j <= i; ++j) curvature[i][j] = T(0.0);
    }
    for_both([&](auto& p, T sign, T share) {
      p.lack = T(1.0) - sign * height(z_, p.x);
      const T inside = select(p.lack > T(0.0), share, T(0.0));
      const T pull = sign * inside * p.lack;
      T point[n];
      for (int a = 0; a < D; ++a) point[a] = p.x[a];
      point[D] = T(1.0);
      for (int i = 0; i < n; ++i) {
        slope[i] += pull * point[i];
        const T row = inside * point[i];
        for (int j = 0; j <= i; ++j) curvature[i][j] += row * point[j];
      }
    });
    double A[n][n] = {};
    auto fixed = [&](int i) { return i < D && (held >> i & 1u); };
    for (int i = 0; i < n; ++i) {
      step[i] = fixed(i) ? 0.0 : sum(slope[i]) - (i < D ? softness * z_[i] : 0.0);
      for (int j = 0; j <= i; ++j) A[i][j] = fixed(i) || fixed(j) ? 0.0 : sum(curvature[i][j]);
      A[i][i] = fixed(i) ? 1.0 : A[i][i] + (i < D ? softness : 1e-12);
    }
    solve_symmetric(A, step);
  }

  /// The length of a step at which the function is least: the root of a slope that is linear piece
  /// by piece and rises.
  double best_length(const double (&step)[n]) {
    double along = 0.0, square = 0.0;
    for (int i = 0; i < D; ++i) {
      along += softness * z_[i] * step[i];
      square += softness * step[i] * step[i];
    }
    for_both([&](auto& p, T sign, T) { p.gain = sign * height(step, p.x); });
    double t = 1.0;
    for (int k = 0; k < 50; ++k) {
      T slope(0.0), curvature(0.0);
      for_both([&](auto& p, T, T share) {
        const T lack = p.lack - T(t) * p.gain;
        const T pull = select(lack > T(0.0), share, T(0.0)) * p.gain;
        slope -= pull * lack;
        curvature += pull * p.gain;
      });
      const double stiffness = sum(curvature) + square;
      if (!(stiffness > 0.0)) break;
      const double change = (sum(slope) + along + t * square) / stiffness;
      t -= change;
      if (!(std::abs(change) > 1e-14)) break;
    }
    return t;
  }

  NearParticles<D>& r_;
  NearParticles<D>& s_;
  double share_r_ = 0.0, share_s_ = 0.0;
  double z_[n] = {};
};

}  // namespace mpm
