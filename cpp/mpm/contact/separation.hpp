#pragma once
// The plane between two bodies at a node: the one that best separates the particles of one from
// those of the other. Fitted to the particles themselves, it is right at edges and corners, where
// gradients of mass are oblique (Nairn, Hammerquist & Smith 2020, who fit it by logistic
// regression). Here it is the plane of the support-vector machine with squared loss (Cortes &
// Vapnik 1995), found by Newton's method with a line search (Keerthi & DeCoste 2005).
#include <algorithm>
#include <cmath>

#include "mpm/contact/near_particles.hpp"
#include "mpm/math/cholesky.hpp"

namespace mpm {

/// A plane a . x + b = 0, x in cells from the node; none if a is zero. a points from one body to
/// another and has the inverse of the half width of the margin between them as its length.
template <int D>
struct Plane {
  Vec<double, D> a = Vec<double, D>::zero();  // [1/cell]
  double b = 0.0;
};

/// The fit of a plane a . x + b = 0, x in cells from the node, to the particles of two bodies: the
/// least of
///   regularisation |a|^2 / 2 + sum_p w_p max(0, 1 - c_p (a . x_p + b))^2 / 2,
/// c = -1 and +1 for the particles of r and s, w each body's masses over their sum. It is the
/// widest margin between the two, of half width 1/|a|, that few particles enter.
///
/// The function is convex with one least point. Between the places where a particle enters or
/// leaves the margin it is a quadratic, of those that are inside; Newton's method goes to the
/// least of the quadratic, until the same particles are inside there. What it ends with depends on
/// them alone, and not on the way there; and it begins at the centres of mass, never at a plane
/// found before: else the order in which nodes are visited would be seen in the last bits.
template <int D>
class PlaneFit {
  using T = Batch<contact_lanes>;
  // The unknowns z = (a, b): as many as D + 1, so that a step solves a system of three or four.
  static constexpr int n = D + 1;

 public:
  /// Axes in `constrained` get no component.
  PlaneFit(const NearParticles<D>& r, const NearParticles<D>& s, unsigned constrained)
      : r_(r), s_(s), constrained_(constrained) {
    if (r.count() == 0 || s.count() == 0) return;
    start_between_centres();
    minimise();
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
  static constexpr double regularisation = 4e-3;
  // Keeps the system regular where no particle is inside the margin.
  static constexpr double damping = 1e-12;

  /// The function as it is where the same particles are inside:
  /// constant / 2 - b . z + z . A z / 2, A symmetric with its lower triangle given.
  struct Quadratic {
    double A[n][n] = {}, b[n] = {}, constant = 0.0;

    bool operator==(const Quadratic&) const = default;
    double along(const double (&y)[n], const double (&z)[n]) const {  // y . A z
      double total = 0.0;
      for (int i = 0; i < n; ++i) {
        total += y[i] * A[i][i] * z[i];
        for (int j = 0; j < i; ++j) total += A[i][j] * (y[i] * z[j] + y[j] * z[i]);
      }
      return total;
    }
    double value(const double (&z)[n]) const {
      double linear = 0.0;
      for (int i = 0; i < n; ++i) linear += b[i] * z[i];
      return 0.5 * (constant + along(z, z)) - linear;
    }
    /// The derivative at z along a step.
    double slope(const double (&z)[n], const double (&step)[n]) const {
      double linear = 0.0;
      for (int i = 0; i < n; ++i) linear += b[i] * step[i];
      return along(z, step) - linear;
    }
    void minimise(double (&z)[n]) const {
      double factors[n][n];
      std::copy(&A[0][0], &A[0][0] + n * n, &factors[0][0]);
      std::copy(b, b + n, z);
      solve_symmetric(factors, z);
    }
  };

  /// Start with the plane midway between the bodies' centres of mass, both on the margin's edges.
  void start_between_centres() {
    const Vec<double, D> r = r_.centre(), s = s_.centre();
    double apart[D], square = 0.0, middle = 0.0;
    for (int a = 0; a < D; ++a) {
      apart[a] = constrained_ >> a & 1u ? 0.0 : s[a] - r[a];
      square += apart[a] * apart[a];
      middle += apart[a] * 0.5 * (r[a] + s[a]);
    }
    // Without a direction z stays zero, where all particles are inside: a start as good as any.
    if (!(square > 0.0)) return;
    // a . s + b = 1 and a . r + b = -1 with a along s - r:
    // a = 2 (s - r) / |s - r|^2, b = -a . (r + s) / 2.
    for (int a = 0; a < D; ++a) z_[a] = 2.0 * apart[a] / square;
    z_[D] = -2.0 * middle / square;
  }

  void minimise() {
    // Some four steps; the limit is against rounding that never settles.
    constexpr int most_steps = 50;
    Quadratic here = at(z_);
    for (int k = 0; k < most_steps; ++k) {
      double z[n], step[n], change = 0.0, size = 0.0;
      here.minimise(z);
      for (int i = 0; i < n; ++i) {
        step[i] = z[i] - z_[i];
        change = std::max(change, std::abs(step[i]));
        size = std::max(size, std::abs(z[i]));
      }
      Quadratic there = at(z);
      // Equal to the bit if the same particles are inside, for they are summed in one order: so the
      // sets need not be kept to be compared. The other test is for a particle that lies on the
      // margin and is in or out by rounding.
      const bool settled = there == here || !(change > 1e-13 * size);
      if (!settled) line_search(here, step, z, there);
      std::copy(z, z + n, z_);
      here = there;
      if (settled) return;
    }
  }

  /// Shorten a step that ends at z, unless the function falls along it, until it does: its slope
  /// rises along the step, so the root of it lies between.
  void line_search(const Quadratic& here, const double (&step)[n], double (&z)[n],
                   Quadratic& there) {
    constexpr int most_trials = 20;
    constexpr double enough = 0.3;  // of the first slope: the next step mends the rest
    // The slope is below 0 here: step = -A^-1 gradient, A positive definite.
    const double first = here.slope(z_, step), start = here.value(z_);
    double low = 0.0, high = 1.0, t = 1.0;
    for (int k = 0; k < most_trials; ++k) {
      const double slope = there.slope(z, step);
      if (!(slope > -enough * first) && there.value(z) < start) return;
      (slope > 0.0 ? high : low) = t;
      // Newton for the root of the slope, whose own slope along the step is step . A step; halving
      // where it would leave what is known to hold the root.
      t -= slope / there.along(step, step);
      if (!(t > low && t < high)) t = 0.5 * (low + high);
      for (int i = 0; i < n; ++i) z[i] = z_[i] + t * step[i];
      there = at(z);
    }
  }

  /// Sums over the particles of a body that are inside a plane's margin or beyond.
  struct Moments {
    T second[D][D], first[n];  // of weight x x^T and of weight (x, 1)
  };
  /// `sign` is c.
  static Moments moments_of(const NearParticles<D>& body, double sign, const double (&z)[n]) {
    Moments m;
    for (int i = 0; i < n; ++i) {
      m.first[i] = T(0.0);
      for (int j = 0; j <= i && i < D; ++j) m.second[i][j] = T(0.0);
    }
    const T level(1.0 - sign * z[D]);
    T slope[D];
    // lack = 1 - c (a . x + b), what a particle lacks to the margin's edge on its own side.
    for (int a = 0; a < D; ++a) slope[a] = T(-sign * z[a]);
    body.for_each([&](const Vec<T, D>& x, T, T weight) MPM_INLINE {
      T lack = level;
      for (int a = 0; a < D; ++a) lack = fma(slope[a], x[a], lack);
      // A weight of 0 in place of a branch: particles inside and outside lie in the same lanes.
      const T inside = select(lack > T(0.0), weight, T(0.0));
      m.first[D] += inside;
      for (int i = 0; i < D; ++i) {
        const T moment = inside * x[i];
        m.first[i] += moment;
        for (int j = 0; j <= i; ++j) m.second[i][j] = fma(moment, x[j], m.second[i][j]);
      }
    });
    return m;
  }

  /// The quadratic of those that are inside the margin of a plane or beyond.
  Quadratic at(const double (&z)[n]) const {
    const Moments r = moments_of(r_, -1.0, z), s = moments_of(s_, 1.0, z);
    // A body counts as 1 however heavy it is at the node, else a light one beside a heavy one would
    // be allowed to lie inside the margin. The shares are taken once, behind the sums.
    const T of_r(1.0 / r_.mass()), of_s(1.0 / s_.mass());  // shares of a body's mass
    const auto fixed = [&](int i) { return i < D && (constrained_ >> i & 1u); };
    Quadratic q;
    for (int i = 0; i < n; ++i) {
      const T first_r = of_r * r.first[i], first_s = of_s * s.first[i];
      // With c^2 = 1 the terms of those inside are
      // w (1 - c z . (x, 1))^2 = w - 2 w c z . (x, 1) + w (z . (x, 1))^2:
      // b has the sign of c, A has none, and the constant is the sum of w.
      q.b[i] = fixed(i) ? 0.0 : sum(first_s - first_r);
      q.A[D][i] = fixed(i) ? 0.0 : sum(first_s + first_r);
      for (int j = 0; j <= i && i < D; ++j)
        q.A[i][j] = fixed(i) || fixed(j) ? 0.0 : sum(of_r * r.second[i][j] + of_s * s.second[i][j]);
    }
    // Before the damping is added: it is no weight. Rows of held axes become 1 z = 0.
    q.constant = q.A[D][D];
    for (int i = 0; i < n; ++i)
      q.A[i][i] = fixed(i) ? 1.0 : q.A[i][i] + (i < D ? regularisation : damping);
    return q;
  }

  const NearParticles<D>& r_;
  const NearParticles<D>& s_;
  unsigned constrained_;
  double z_[n] = {};
};

/// The plane that best separates the particles of two bodies; none where a body has no particles.
template <int D>
Plane<D> separating_plane(const NearParticles<D>& r, const NearParticles<D>& s,
                          unsigned constrained) {
  return PlaneFit<D>(r, s, constrained).plane();
}

/// The unit normal from r to s of the plane that separates their particles; zero if none does. All
/// particles lie within 1.5 cells of the node along each axis, so the margin of two separate
/// bodies has a half width below 1.5 sqrt(3) = 2.6 cells; a much wider one means that the bodies
/// fill the same place.
template <int D>
Vec<double, D> separating_normal(const NearParticles<D>& r, const NearParticles<D>& s,
                                 unsigned constrained) {
  constexpr double widest = 4.0;  // half width [cells]
  return normalised(separating_plane(r, s, constrained).a, 1.0 / widest);
}

}  // namespace mpm
