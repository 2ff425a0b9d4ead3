#pragma once
// Contact points by the boxes of space that they are in, found by a hash.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "mpm/fields/lanes.hpp"
#include "mpm/surfaces/surfaces.hpp"

namespace mpm {

using BoxIndex = std::array<std::int32_t, 3>;

struct FaceOfBody {
  std::int32_t body = 0, face = 0;
};

/// The points of a face of a body in a box: a range of those that are sorted so, and the least box
/// that holds them.
template <int D>
struct PointBox {
  BoxIndex index{};
  std::int32_t body = 0, face = 0;
  std::uint32_t first = 0, count = 0, next = 0;  // 1 + the number of another face's, or 0
  Vec<double, D> low, high;                      // [m]

  /// The square of how far it is from another.
  double square_to(const Vec<double, D>& other_low, const Vec<double, D>& other_high) const {
    double sum = 0.0;
    for (int a = 0; a < D; ++a) {
      const double apart = std::max({low[a] - other_high[a], other_low[a] - high[a], 0.0});
      sum += apart * apart;
    }
    return sum;
  }
};

/// All points by their boxes.
template <int D>
class PointBoxes {
 public:
  /// `edge` of a box [m]; body and face of each point.
  PointBoxes(const Vec<double, D>& origin, double edge, const std::vector<Vec<double, D>>& places,
             const std::vector<FaceOfBody>& face_of)
      : origin_(origin), edge_(edge), table_(64, 0), box_of_(places.size()) {
    std::uint32_t last = 0;
    for (std::size_t c = 0; c < places.size(); ++c) {
      const BoxIndex index = index_of(places[c]);
      // Points that follow one another are mostly in one box.
      if (c == 0 || index != boxes_[last].index || !is_of(boxes_[last], face_of[c]))
        last = box_at(index, face_of[c]);
      PointBox<D>& box = boxes_[last];
      for (int a = 0; a < D; ++a) {
        box.low[a] = std::min(box.low[a], places[c][a]);
        box.high[a] = std::max(box.high[a], places[c][a]);
      }
      ++box.count;
      box_of_[c] = last;
    }
    std::uint32_t first = 0;
    for (PointBox<D>& box : boxes_) {
      box.first = first;
      first += std::exchange(box.count, 0);
    }
    points_.resize(places.size());
    // Whole registers are read, beyond the last as well.
    for (int a = 0; a < D; ++a) places_[a].resize(places.size() + contact_lanes);
    for (std::uint32_t c = 0; c < places.size(); ++c) {
      PointBox<D>& box = boxes_[box_of_[c]];
      const std::uint32_t at = box.first + box.count++;
      points_[at] = c;
      for (int a = 0; a < D; ++a) places_[a][at] = places[c][a];
    }
  }

  std::size_t size() const { return boxes_.size(); }
  std::uint32_t box_of(std::uint32_t point) const { return box_of_[point]; }
  std::uint32_t number_of(const PointBox<D>& box) const {
    return static_cast<std::uint32_t>(&box - boxes_.data());
  }
  const PointBox<D>& operator[](std::uint32_t box) const { return boxes_[box]; }
  /// f(box) for those of all faces at an index.
  template <class F>
  void for_each_at(const BoxIndex& index, F&& f) const {
    for (std::uint32_t b = first_at(index); b != 0; b = boxes_[b - 1].next) f(boxes_[b - 1]);
  }
  /// f(point, square of its distance) for those of a box that are nearer to a place than the root
  /// of `square`.
  template <class F>
  void for_each_near(const PointBox<D>& box, const Vec<double, D>& place, double square,
                     F&& f) const {
    constexpr std::uint32_t W = contact_lanes;
    for (std::uint32_t k = box.first; k < box.first + box.count; k += W) {
      Batch<W> squares(0.0);
      for (int a = 0; a < D; ++a) {
        const Batch<W> way = Batch<W>::load(places_[a].data() + k) - Batch<W>(place[a]);
        squares = fma(way, way, squares);
      }
      const std::uint32_t count = std::min(W, box.first + box.count - k);
      for (std::uint32_t i = 0; i < count; ++i)
        if (const double one = squares[static_cast<int>(i)]; one < square) f(points_[k + i], one);
    }
  }

 private:
  BoxIndex index_of(const Vec<double, D>& place) const {
    BoxIndex index{};
    for (int a = 0; a < D; ++a) {
      // What is no number is found far off, by who looks at the state of the run.
      constexpr double far = 1 << 30;
      const double at = std::floor((place[a] - origin_[a]) / edge_);
      index[static_cast<std::size_t>(a)] =
          static_cast<std::int32_t>(at < far ? std::max(at, -far) : far);
    }
    return index;
  }
  /// Where in the table an index is, or would be.
  std::size_t slot(const BoxIndex& index) const {
    std::uint64_t h = 0;
    for (const std::int32_t i : index)
      h = (h ^ static_cast<std::uint32_t>(i)) * 0x9e3779b97f4a7c15ull;
    std::size_t at = (h >> 32) % table_.size();
    while (table_[at] != 0 && boxes_[table_[at] - 1].index != index) at = (at + 1) % table_.size();
    return at;
  }
  std::uint32_t first_at(const BoxIndex& index) const { return table_[slot(index)]; }
  static bool is_of(const PointBox<D>& box, const FaceOfBody& of) {
    return box.body == of.body && box.face == of.face;
  }
  /// The number of a face's box, which is made if there is none yet.
  std::uint32_t box_at(const BoxIndex& index, const FaceOfBody& of) {
    for (std::uint32_t b = first_at(index); b != 0; b = boxes_[b - 1].next)
      if (is_of(boxes_[b - 1], of)) return b - 1;
    constexpr double far = std::numeric_limits<double>::infinity();
    PointBox<D> box;
    box.index = index;
    box.body = of.body;
    box.face = of.face;
    box.next = first_at(index);
    for (int a = 0; a < D; ++a) {
      box.low[a] = far;
      box.high[a] = -far;
    }
    boxes_.push_back(box);
    const auto made = static_cast<std::uint32_t>(boxes_.size());
    table_[slot(index)] = made;
    if (2 * boxes_.size() > table_.size()) {
      table_.assign(4 * table_.size(), 0);
      for (std::uint32_t b = 0; b < made; ++b) table_[slot(boxes_[b].index)] = b + 1;
    }
    return made - 1;
  }

  Vec<double, D> origin_;
  double edge_;
  std::vector<PointBox<D>> boxes_;
  std::vector<std::uint32_t> table_;            // 1 + the number of the last box at an index, or 0
  std::vector<std::uint32_t> points_, box_of_;  // by box; by point
  std::vector<double> places_[D];               // of the points, by box
};

}  // namespace mpm
