#pragma once
// How far a point lies from the surface of a body: a smooth one, made of the body's particles
// (decision 0054). It depends on places alone, and on no node's normal.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mpm/fields/lanes.hpp"
#include "mpm/layout/tile.hpp"
#include "mpm/math/vec.hpp"
#include "mpm/walls/walls.hpp"

namespace mpm {

/// The particles around a point, each with a weight (1 - d^2 / R^2 e^2)^n up to a distance d of R
/// of its edges e. A layer of particles an edge apart has a sum which in the mean falls with the
/// height z over it as S_1 ((R^2 - z^2 / e^2) / a^2)^m, a^2 = R^2 - 1 and m = n + (D - 1) / 2.
///
/// At a height of an edge, where bodies touch, the weights of a layer end at a edges beside the
/// point, and what waves of a length of 1 / k edges the lattice has in it goes by J_m(2 pi a k): a
/// is where the longest vanishes, at the first zero of J_m, so that flat rows have no dents. The
/// layer below is two edges away then, beyond all weights.
template <int D>
class SurfaceSum {
 public:
  using T = Batch<contact_lanes>;
  /// Where a weight ends at the latest [cells].
  static constexpr double cut = 2.0;
  /// Cells around that of a point in which weights of particles up to that edge may lie [cells].
  static int range(double edge) { return edge * edge * (1.0 + a2) > 1.0 ? 2 : 1; }

  /// Particles at d from the point, half their edges, and which of them count (a mass above 0).
  /// All in cells.
  void add(const Vec<T, D>& d, T half, T mass) {
    T square(0.0);
    for (int k = 0; k < D; ++k) square = fma(d[k], d[k], square);
    const T end = min(T(4.0 * (1.0 + a2)) * half * half, T(cut * cut));
    const T scale = T(1.0) / end, t = max(fma(-square, scale, T(1.0)), T(0.0)), t2 = t * t;
    const T last = select(mass > T(0.0), D == 2 ? t2 * t2 * t : t2 * t2, T(0.0));  // t^(n - 1)
    const T weight = last * t;
    sum_ += weight;
    halves_ = fma(weight, half, halves_);
    const T slope = last * scale;
    for (int k = 0; k < D; ++k) slope_[k] = fma(slope, d[k], slope_[k]);
  }

  /// Half the edge of the particles, as they count [cells]; none: 0.
  double mean_half() const {
    const double total = sum(sum_);
    return total > 0.0 ? sum(halves_) / total : 0.0;
  }
  /// Height of the point over the outermost layer of particles of that half edge [cells]; of
  /// particles so wide that what is cut off is all at the height of an edge, infinite.
  double height(double half) const {
    const double ends = cut / (2.0 * half);  // edges
    if (!(ends > 1.0)) return std::numeric_limits<double>::infinity();
    const double square = std::min(a2, ends * ends - 1.0);
    const double at_edge = at_an_edge(square < a2 ? std::sqrt(square) : a);
    const double share = std::pow(sum(sum_) / at_edge, 1.0 / (n + 0.5 * (D - 1)));
    return 2.0 * half * std::sqrt(std::max(1.0 + square * (1.0 - share), 0.0));
  }
  /// Unit vector along which the sum rises fastest, into the body; zero if there is none.
  Vec<double, D> normal() const {
    Vec<double, D> along;
    for (int k = 0; k < D; ++k) along[k] = sum(slope_[k]);
    return normalised(along);
  }

 private:
  static constexpr int n = D == 2 ? 6 : 5;
  static constexpr double zero = D == 2 ? 10.512835408093999 : 9.936109524217791;  // of J_m
  static constexpr double a = zero / (2.0 * std::numbers::pi), a2 = a * a;

  /// S_1, the mean over all places beside the layer's particles, of weights that end `beside` edges
  /// from the point there.
  static constexpr double at_an_edge(double beside) {
    const double square = beside * beside;
    // The integral of (1 - u^2)^n, |u| < 1, over lengths or areas.
    double sum = D == 2 ? 2048.0 / 3003.0 * beside : std::numbers::pi / 6.0 * square;
    for (int k = 0; k < n; ++k) sum *= square / (1.0 + square);
    return sum;
  }

  T sum_{0.0}, halves_{0.0};
  Vec<T, D> slope_ = Vec<T, D>::zero();
};

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
      if (walls.exist && Walls<D>::goes_on(walls.face[a][side]) && std::abs(x[a] - face) < range)
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
