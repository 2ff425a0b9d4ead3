#pragma once
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "mpm/layout/tile.hpp"
#include "mpm/math/tensor.hpp"

namespace mpm {

/// Things at places of bodies, in boxes of one edge: a few, of which those near a place are asked
/// for.
template <int D, class Thing>
class BoxesOfBodies {
 public:
  explicit BoxesOfBodies(double edge) : edge_(edge) {}

  void add(int body, const Vec<double, D>& place, const Thing& thing) {
    boxes_[{body, box_of(place)}].push_back(&thing);
  }
  /// f(thing) for those of a body that are nearer than the edge of a box to a place, and others.
  template <class F>
  void for_each_near(int body, const Vec<double, D>& place, F&& f) const {
    Index<D> low = box_of(place), high = low;
    for (std::size_t a = 0; a < D; ++a) {
      low[a] -= 1;
      high[a] += 1;
    }
    for_each_index<D>(low, high, [&](const Index<D>& box) {
      const auto found = boxes_.find({body, box});
      if (found == boxes_.end()) return;
      for (const Thing* thing : found->second) f(*thing);
    });
  }

 private:
  Index<D> box_of(const Vec<double, D>& place) const {
    Index<D> box;
    for (int a = 0; a < D; ++a)
      box[static_cast<std::size_t>(a)] = static_cast<std::int32_t>(std::floor(place[a] / edge_));
    return box;
  }

  double edge_;
  std::map<std::pair<int, Index<D>>, std::vector<const Thing*>> boxes_;
};

}  // namespace mpm
