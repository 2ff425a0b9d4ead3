#pragma once
// The particles of a body around a node: what normals and gaps are made of.
#include <bit>
#include <limits>

#include "mpm/contact/tile_particles.hpp"
#include "mpm/fields/memory_space.hpp"
#include "mpm/math/store_chosen.hpp"

namespace mpm {

/// The particles of a body from which a node is in reach, packed, so that lanes are full. What is
/// empty in the last lanes repeats a particle, without weight or extent.
template <int D>
class NearParticles {
 public:
  using T = Batch<contact_lanes>;

  /// Forget all, with room for so many.
  void clear(std::size_t room) {
    count_ = 0;
    constexpr std::size_t line = cache_line / sizeof(double);
    const std::size_t lines = (room + T::lanes) / line + 1;  // whole lanes are written at the end
    // Room only grows: it is scratch that every node of a thread uses again.
    if (lines * line <= stride_) return;
    // Numbers of one kind lie an odd number of lines from those of the next, so that they fall
    // into different cache sets.
    stride_ = (2 * lines + 1) * line;
    numbers_.release_and_allocate(kinds * stride_);
  }

  /// Add those lanes that have a weight: position from the node [cells], half the particle's edge
  /// [cells], mass [kg].
  void add(const Vec<T, D>& x, T half, T weight) {
    const std::uint64_t lanes = lane_bits(weight > T(0.0));
    double* const to = numbers_.data() + count_;
    // Each call writes whole lanes and moves on by those that count: the next writes over the rest.
    for (int a = 0; a < D; ++a) store_chosen(to + at(a), x[a], lanes);
    store_chosen(to + at(half_at), half, lanes);
    store_chosen(to + at(weight_at), weight, lanes);
    count_ += static_cast<std::size_t>(std::popcount(lanes));
  }
  /// Fill up the last lanes and make the sums; after that more may be added, and finished again.
  void finish() {
    mass_ = 0.0;
    centre_ = Vec<double, D>::zero();
    if (count_ == 0) return;
    double* const end = numbers_.data() + count_;
    for (int a = 0; a < D; ++a) T(end[at(a) - 1]).store(end + at(a));
    // An extent of minus infinity never is the largest. Positions repeat one that is there, for a
    // weight of zero does not make a number of what is none.
    T(-std::numeric_limits<double>::infinity()).store(end + at(half_at));
    T(0.0).store(end + at(weight_at));
    T mass(0.0);
    Vec<T, D> moment = Vec<T, D>::zero();
    for_each([&](const Vec<T, D>& x, T, T weight) {
      mass += weight;
      for (int a = 0; a < D; ++a) moment[a] = fma(weight, x[a], moment[a]);
    });
    mass_ = sum(mass);
    for (int a = 0; a < D; ++a) centre_[a] = sum(moment[a]) / mass_;
  }

  /// f(position, half, weight) for all, in lanes.
  template <class F>
  void for_each(F&& f) const {
    const double* from = numbers_.data();
    for (const double* const end = from + count_; from < end; from += T::lanes) {
      Vec<T, D> x;
      for (int a = 0; a < D; ++a) x[a] = T::load(from + at(a));
      f(x, T::load(from + at(half_at)), T::load(from + at(weight_at)));
    }
  }

  std::size_t count() const { return count_; }
  /// Mass in reach [kg] and its centre from the node [cells]; zero without particles.
  double mass() const { return mass_; }
  const Vec<double, D>& centre() const { return centre_; }

  /// How far the body extends from the node along a unit vector: max of x . n + l [cells], eq. (5),
  /// with l half the edge of a cube of the particle's present volume; -infinity if there are no
  /// particles. Those within a cell of the line through the node along n count: beside the
  /// place where round bodies touch, their surfaces are still apart. If the line misses the body,
  /// as beside an edge, all count.
  double extent_along(const Vec<double, D>& normal) const {
    constexpr double radius = 1.0;
    T on_line(-std::numeric_limits<double>::infinity()), anywhere = on_line;
    for_each([&](const Vec<T, D>& x, T half, T) {
      T along(0.0), square(0.0);
      for (int a = 0; a < D; ++a) {
        // |x|^2 - (x . n)^2 is the square of the distance from the line: no root, no division.
        along = fma(T(normal[a]), x[a], along);
        square = fma(x[a], x[a], square);
      }
      const T distance = along + half;
      anywhere = max(anywhere, distance);
      on_line =
          select(fma(-along, along, square) < T(radius * radius), max(on_line, distance), on_line);
    });
    // Both are found in one pass, for which of them counts is known at its end only.
    const double there = largest(on_line);
    return there > -std::numeric_limits<double>::infinity() ? there : largest(anywhere);
  }

 private:
  static constexpr int half_at = D, weight_at = D + 1, kinds = D + 2;
  std::ptrdiff_t at(int kind) const { return kind * static_cast<std::ptrdiff_t>(stride_); }

  AlignedArray<double> numbers_;  // of each kind: positions along each axis, halves, weights
  std::size_t stride_ = 0, count_ = 0;
  double mass_ = 0.0;
  Vec<double, D> centre_ = Vec<double, D>::zero();
};

/// Collect the particles of a body from which a node, counted from the tile's first, is in reach,
/// in place of those that were there.
template <int D>
void collect_near(const TileParticles<D>& particles, const Index<D>& node, double reach,
                  NearParticles<D>& to) {
  using T = Batch<contact_lanes>;
  // Over this length [cells] a particle's weight falls to 0 where its reach ends: particles on a
  // lattice lie there in whole rows, and rounding must not choose among them.
  constexpr double rim = 1e-3;
  to.clear(particles.most_around());
  particles.around(node, [&](const Index<D>& place, const auto& lanes) {
    Vec<T, D> x;
    T weight = lanes.mass;
    for (int a = 0; a < D; ++a) {
      x[a] = lanes.xi[a] - T(place[a] + particles.own_node());
      // A product over the axes, as shape functions are: the rim is that of a box.
      const T to_rim = T(reach) - absolute(x[a]);
      weight *= min(max(T(1.0 / rim) * to_rim, T(0.0)), T(1.0));
    }
    to.add(x, lanes.half, weight);
  });
  to.finish();
}

}  // namespace mpm
