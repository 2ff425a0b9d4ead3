#pragma once
// What a step is for nodes, where one is beyond a wall, and what its thread gives to the ledger.
#include "mpm/device/cuda/views.cuh"
#include "mpm/loads/damped_node.hpp"
#include "mpm/walls/face_impulses.hpp"

namespace mpm {

/// What a step is for nodes.
template <int D>
struct NodeStep {
  GridGeometry<D> grid;
  double time_step;
  Vec<double, D> gravity;
  bool has_gravity, ghosts;
  bool takes_of_grid;           // do particles take the velocity of the grid?
  bool other_at_fixed;          // all of it at fixed walls? (step/fixed_walls.hpp)
  const double* grid_share;     // of each body
  const StepDamping* damping;   // of each body's motion, or null
  const std::uint8_t* weighed;  // of each body: have its forces been weighed (`weigh_mapped`)?
  double* sums;                 // [DeviceSum][node tile]
  std::size_t tiles;
};

/// A node beyond a wall whose image its own patches hold: one cell before the wall.
template <int D>
struct Image {
  bool exists = false;
  WallImage<D> image{};

  __device__ Image(const GridGeometry<D>& grid, bool ghosts, const Index<D>& node) {
    if (!ghosts) return;
    const auto found = grid.walls.image(node);
    if (!found) return;
    exists = true;
    for (int a = 0; a < D; ++a) {
      const int way = found->node[a] - node[a];
      exists = exists && way <= 2 && way >= -2;
    }
    image = *found;
  }
};

/// By number, as nvcc makes wrong code of comparisons of arrays.
template <int D>
__device__ bool same_place(const Index<D>& x, const Index<D>& y) {
  bool same = true;
  for (int a = 0; a < D; ++a) same = same && x[a] == y[a];
  return same;
}

/// f(place in the block, image) for the nodes of a patch's block of which a node is the image, in
/// the order of the block.
template <class B, int D, class F>
__device__ void for_each_imaged(const GridGeometry<D>& grid, const AnIndex<D>& node,
                                const AnIndex<D>& in_block, F&& f) {
  Index<D> way{};
  const auto visit = [&] {
    Index<D> other, at;
    bool inside = true, same = true;
    for (int a = 0; a < D; ++a) {
      other[a] = node[a] + way[a];
      at[a] = in_block[a] + way[a];
      inside = inside && at[a] >= 0 && at[a] < Block<B, D>::edge;
      same = same && way[a] == 0;
    }
    if (same || !inside) return;
    const Image<D> image(grid, true, other);
    if (image.exists && same_place<D>(image.image.node, node)) f(at, image.image);
  };
  if constexpr (D == 3)
    for (way[2] = -2; way[2] <= 2; way[2] += 2)
      for (way[1] = -2; way[1] <= 2; way[1] += 2)
        for (way[0] = -2; way[0] <= 2; way[0] += 2) visit();
  else
    for (way[1] = -2; way[1] <= 2; way[1] += 2)
      for (way[0] = -2; way[0] <= 2; way[0] += 2) visit();
}

/// Forces of a patch's block, of the node at a place in it: those that its particles have given
/// with what gravity is to lack there (walls/mirror.hpp).
template <class B, int D>
__device__ void weigh(const GridGeometry<D>& grid, const Vec<double, D>& gravity,
                      const HalfRecord* given, const AnIndex<D>& node, const AnIndex<D>& in_block,
                      double* force) {
  double weight[D] = {};
  for_each_imaged<B, D>(grid, node, in_block, [&](const Index<D>& at, const WallImage<D>& image) {
    const double mass = given[Block<B, D>::node(at)].x;
    for (int a = 0; a < D; ++a)
      if (image.turned >> a & 1u) weight[a] -= 2.0 * mass * gravity[a];
  });
  for (int a = 0; a < D; ++a) force[a] += weight[a];
}

template <int D>
__device__ Vec<double, 3> in_three(const Vec<double, D>& v) {
  return {v[0], v[1], D == 3 ? v[D - 1] : 0.0};
}
__device__ inline Vec<double, 3> cross_of(const Vec<double, 3>& x, const Vec<double, 3>& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

/// What a thread adds to the sums of its node tile.
struct NodeSums {
  double of[DeviceSum::of_nodes];

  __device__ NodeSums() {
    for (double& x : of) x = 0.0;
  }
  __device__ void add_vector(int at, const Vec<double, 3>& v) {
    for (int a = 0; a < 3; ++a) of[at + a] += v[a];
  }
  /// An impulse at a place, by the faces of_component(axis).
  template <int D, class F>
  __device__ void add_reaction(int at, const Vec<double, D>& place, const Vec<double, D>& impulse,
                               F&& of_component) {
    add_vector(at, cross_of(in_three(place), in_three(impulse)));
    for (int a = 0; a < D; ++a)
      if (impulse[a] != 0.0) add_to_faces(of_component(a), a, impulse[a]);
  }
  /// As FaceImpulses::add.
  __device__ void add_to_faces(unsigned faces, int component, double impulse) {
    const int count = __popc(faces);
    for (int face = 0; face < 6; ++face)
      if (faces >> face & 1u) of[DeviceSum::faces + 3 * face + component] += impulse / count;
  }
  /// x_i x R s - x_g x s and R s - s of a node beyond walls (walls/reactions.hpp).
  template <int D>
  __device__ void add_folding(int at, const GridGeometry<D>& grid, const AnIndex<D>& node,
                              const WallImage<D>& image, const Vec<double, D>& s) {
    Vec<double, D> of_image;
    for (int a = 0; a < D; ++a) of_image[a] = image.component(s[a], a);
    add_vector(at, cross_of(in_three(grid.position_of(image.node)), in_three(of_image)) -
                       cross_of(in_three(grid.position_of(node)), in_three(s)));
    for (int a = 0; a < D; ++a)
      if (of_image[a] != s[a])
        add_to_faces(grid.walls.faces_turning(node, a), a, of_image[a] - s[a]);
  }
  /// By all threads of the block; the first `count` of them.
  __device__ void write(double* sums, std::size_t tiles, std::size_t tile, int count) {
    __shared__ double scratch[2];
    for (int k = 0; k < DeviceSum::of_nodes; ++k)
      if (k < count) {
        const double all = block_sum<64>(of[k], scratch);
        if (threadIdx.x == 0) sums[k * tiles + tile] += all;
      }
  }
};

}  // namespace mpm
