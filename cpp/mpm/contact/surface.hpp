#pragma once
// How far a point lies from the surface of a body: a smooth one, made of the body's particles
// (decision 0054). It depends on places alone, and on no node's normal.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mpm/fields/lanes.hpp"
#include "mpm/layout/tile.hpp"
#include "mpm/math/vec.hpp"
#include "mpm/walls/walls.hpp"

namespace mpm {

/// The particles around a point, each with a weight (1 - d^2 / 4 e^2)^6 up to a distance d of two
/// of its edges e. A layer of particles an edge apart then has a sum that falls with the height z
/// over it as (1 - z^2 / 4 e^2)^m, m = 6 + (D - 1) / 2, and the layer below adds nothing at the
/// height of an edge, where bodies touch.
template <int D>
class SurfaceSum {
 public:
  using T = Batch<contact_lanes>;

  /// Particles at d from the point, half their edges, and which of them count (a mass above 0).
  /// `range` is where a weight ends at the latest. All in cells.
  void add(const Vec<T, D>& d, T half, T mass, double range) {
    T square(0.0);
    for (int a = 0; a < D; ++a) square = fma(d[a], d[a], square);
    const T end = min(T(16.0) * half * half, T(range * range));
    const T scale = T(1.0) / end, t = max(fma(-square, scale, T(1.0)), T(0.0));
    const T t2 = t * t, t5 = select(mass > T(0.0), t2 * t2 * t, T(0.0)), weight = t5 * t;
    sum_ += weight;
    halves_ = fma(weight, half, halves_);
    const T slope = t5 * scale;
    for (int a = 0; a < D; ++a) slope_[a] = fma(slope, d[a], slope_[a]);
  }

  /// Half the edge of the particles, as they count [cells]; none: 0.
  double half() const {
    const double total = sum(sum_);
    return total > 0.0 ? sum(halves_) / total : 0.0;
  }
  /// Height of the point over the outermost layer of particles of that half edge [cells].
  double height(double half) const {
    const double power = std::pow(sum(sum_) / at_an_edge(), 1.0 / exponent);
    return 4.0 * half * std::sqrt(std::max(1.0 - 0.75 * power, 0.0));
  }
  /// Unit vector along which the sum rises fastest, into the body; zero if there is none.
  Vec<double, D> normal() const {
    Vec<double, D> n;
    for (int a = 0; a < D; ++a) n[a] = sum(slope_[a]);
    return normalised(n);
  }

 private:
  static constexpr double exponent = 6.0 + 0.5 * (D - 1);

  /// The sum at the height of an edge: the mean over all places beside the layer's particles.
  static constexpr double at_an_edge() {
    // (3/4)^m times the integral of (1 - u^2)^6, |u| < 1, over lengths or areas, of radius sqrt 3.
    if constexpr (D == 2)
      return 243.0 * std::numbers::sqrt3 / 2002.0;
    else
      return 2187.0 * std::numbers::pi / 28672.0;
  }

  T sum_{0.0}, halves_{0.0};
  Vec<T, D> slope_ = Vec<T, D>::zero();
};

/// Cells around that of a point in which the weights of a body's particles may lie: up to two
/// edges, cut off there.
inline int surface_range(double mean_edge) { return mean_edge < 0.51 ? 1 : 2; }

/// f(image, signs) for a point and what it is beyond the faces of the box that it is nearer to than
/// `range`: a body goes on there as before the face. `signs` are -1 along the axes that are
/// mirrored. All in the grid's coordinates [cells].
template <int D, class F>
void for_each_image(const Walls<D>& walls, const Vec<double, D>& x, double range, F&& f) {
  double along[D][3], sign[3] = {1.0, -1.0, -1.0};
  Index<D> none{}, last{};
  for (int a = 0; a < D; ++a) {
    const auto k = static_cast<std::size_t>(a);
    along[a][0] = x[a];
    for (const int side : {0, 1}) {
      const double face = side == 0 ? 0.0 : walls.cells[k];
      if (walls.exist && walls.face[a][side] != Wall::free && std::abs(x[a] - face) < range)
        along[a][++last[k]] = 2.0 * face - x[a];
    }
  }
  for_each_index<D>(none, last, [&](const Index<D>& chosen) {
    Vec<double, D> image, signs;
    for (int a = 0; a < D; ++a) {
      const int k = chosen[static_cast<std::size_t>(a)];
      image[a] = along[a][k];
      signs[a] = sign[k];
    }
    f(image, signs);
  });
}

}  // namespace mpm
