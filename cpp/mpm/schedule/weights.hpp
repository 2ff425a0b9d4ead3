#pragma once
// The weights of particles at the nodes around their cell.
#include "mpm/basis/basis.hpp"
#include "mpm/layout/block_shape.hpp"
#include "mpm/math/unrolled.hpp"
#include "mpm/math/vec.hpp"

namespace mpm {

/// Along each axis those of the nodes in reach; one of the space is a product over the axes.
template <class T, int D, int count>
struct Weights {
  AxisWeights<T, count> axis[D];
};
/// Two functions that sum to one and carry the position are 1 - xi and xi, so xi is all there is to
/// know: whichever basis of two nodes it is, it is this one.
template <class T, int D>
struct Weights<T, D, 2> {
  Vec<T, D> xi;
};

/// Of particles in the lanes, from their position in the cell.
template <BasisModel B, class T, int D>
MPM_HD MPM_INLINE inline Weights<T, D, B::nodes> weights_at(const B& basis, const Vec<T, D>& xi) {
  if constexpr (B::nodes == 2)
    return {xi};
  else
    return [&]<int... a>(std::integer_sequence<int, a...>) MPM_INLINE {
      return Weights<T, D, B::nodes>{{basis.along(xi[a])...}};
    }(std::make_integer_sequence<int, D>{});
}

/// First moments N_i (x_i - x) along each axis [cells]; one of the space is such a factor along its
/// axis and N along the others.
template <class T, int D, int count>
struct Moments {
  T axis[D][count];
};
template <BasisModel B, class T, int D>
MPM_HD MPM_INLINE inline Moments<T, D, B::nodes> moments_at(const Vec<T, D>& xi,
                                                            const Weights<T, D, B::nodes>& w) {
  Moments<T, D, B::nodes> M;
  unrolled<D>([&](auto a) MPM_INLINE {
    unrolled<B::nodes>([&](auto k) MPM_INLINE {
      M.axis[a][k] = w.axis[a].N[k] * (T(B::own_node + k - B::before) - xi[a]);
    });
  });
  return M;
}

/// From a node of a block to the next along y, and along z; x is the fastest, as in BlockShape. In
/// 2D a layer is 0, so that `to` and `to_first` serve both.
template <int D>
struct NodeStrides {
  int row, layer;

  MPM_HD explicit NodeStrides(const BlockShape<D>& shape)
      : row(shape.nodes[0]), layer(D == 3 ? shape.nodes[0] * shape.nodes[1] : 0) {}
  MPM_HD NodeStrides(int to_next_row, int to_next_layer) : row(to_next_row), layer(to_next_layer) {}
  /// To the node so many steps further along each axis.
  MPM_HD int to(int x, int y, int z) const { return x + y * row + z * layer; }
  /// From a cell's own node to the first that its particles reach, which the block holds: it is cut
  /// to the reach of the occupied cells (decision 0013).
  MPM_HD int to_first(int before) const { return -before * (1 + row + layer); }
};

}  // namespace mpm
