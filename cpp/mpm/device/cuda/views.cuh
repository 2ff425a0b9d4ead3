#pragma once
// What kernels see of the particles, the lists and the nodes.
#include <type_traits>

#include "mpm/device/device_sums.hpp"
#include "mpm/grid/geometry.hpp"
#include "mpm/layout/node_records.hpp"
#include "mpm/math/tensor.hpp"

namespace mpm {

/// An index as a parameter from which the number of dimensions is not found.
template <int D>
using AnIndex = std::type_identity_t<Index<D>>;

/// The columns of one material's particles.
template <int D>
struct ParticleView {
  static constexpr int parts = Sym<double, D>::size;
  double *x[D], *v[D], *mass, *volume, *stress[parts];
  double* affine[D * D];         // null without an affine transfer
  const double* q;               // pressure that nodal forces add to the stress, or null
  const double* damping[parts];  // stress of the material's damping, or null
  const double* failed;          // FailureAction of each, or null
  const std::uint32_t* id;
  double share, grid_share;  // of the step (DeviceStep)
  double cell_size;          // [m]
};

/// Who lies in which cell. Entries of all patches follow each other, those of a patch by cell, then
/// by the particles' numbers, as on the host; `order` has the row of each in its pool.
template <int D>
struct ListView {
  const std::uint32_t *order, *cell_begin;  // cell_begin: [patch][64], and the end
  const std::int32_t* body;                 // of each patch
  const Index<D>* tile;
  const std::int32_t* patch_beside;  // [patch][3^D], of the same body; -1: none
  const std::int32_t* nodes_beside;  // the same of node tiles
};

/// The sums of the nodes of a body that lie in a tile: 64 records (layout/node_records.hpp).
template <int D>
struct NodeTileView {
  static constexpr int nodes = Tile<D>::cell_count;
  double* records;
  const std::int32_t* body;
  const Index<D>* tile;
  const std::int32_t* holders;  // [node tile][3^D]: patches of which nodes lie there; -1: none
  const std::int32_t* beside;   // [node tile][3^D]: node tiles
};

/// Half a node's record, moved as one.
struct alignas(32) HalfRecord {
  double x, y, z, w;
};

/// What the patches' particles have given to the nodes of their blocks, half a record each.
struct PartialView {
  HalfRecord *first, *second;
};

/// Where particles go.
struct MoveView {
  std::uint32_t* target;         // [entry] patch x 64 + cell; `homeless`: no patch there
  std::uint32_t* slot;           // [entry] its turn in that cell, in no order
  std::uint32_t* counts;         // [patch][64]
  std::uint64_t* homeless_keys;  // of their patches
  std::uint32_t* homeless_count;
  std::uint32_t homeless_room;
  std::uint32_t* changed;  // has any left its cell?
  static constexpr std::uint32_t homeless = ~std::uint32_t{0};
};

/// Names a patch or a node tile: by body, then by tile, in the order of the host's patches.
template <int D>
struct TileKey {
  static constexpr int bits = D == 3 ? 14 : 21;
  static constexpr int half = 1 << (bits - 1);

  MPM_HD static std::uint64_t of(int body, const Index<D>& tile) {
    std::uint64_t key = static_cast<std::uint64_t>(body);
    for (int a = D - 1; a >= 0; --a)
      key = key << bits | static_cast<std::uint64_t>(tile[static_cast<std::size_t>(a)] + half);
    return key;
  }
  MPM_HD static int body(std::uint64_t key) { return static_cast<int>(key >> (D * bits)); }
  MPM_HD static Index<D> tile(std::uint64_t key) {
    Index<D> tile{};
    for (int a = 0; a < D; ++a, key >>= bits)
      tile[static_cast<std::size_t>(a)] = static_cast<int>(key & ((1u << bits) - 1)) - half;
    return tile;
  }
  MPM_HD static bool holds(const Index<D>& tile) {
    bool inside = true;
    for (int a = 0; a < D; ++a) {
      const int i = tile[static_cast<std::size_t>(a)];
      inside = inside && i >= -half + 1 && i < half - 1;
    }
    return inside;
  }
};

/// The block of a patch: all nodes that particles in its tile may reach.
template <class B, int D>
struct Block {
  static constexpr int edge = Tile<D>::cells + B::nodes - 1;
  static constexpr int nodes = power(edge, D);
  static constexpr int low = -B::before;

  /// Coordinates in the block of its node n, from 0.
  MPM_HD static Index<D> index(int n) {
    Index<D> i{};
    for (int a = 0; a < D; ++a, n /= edge) i[static_cast<std::size_t>(a)] = n % edge;
    return i;
  }
  MPM_HD static int node(const Index<D>& i) {
    int n = 0;
    for (int a = D - 1; a >= 0; --a) n = n * edge + i[static_cast<std::size_t>(a)];
    return n;
  }
};

/// i / Tile<D>::cells rounded down, for tiles beside one: -1, 0, 1 where i is in -cells .. 2 cells.
template <int D>
MPM_HD int tile_offset(int i) {
  return i < 0 ? -((Tile<D>::cells - 1 - i) / Tile<D>::cells) : i / Tile<D>::cells;
}

/// For sums over a block of threads, in one order: the sum in thread 0.
template <int threads>
__device__ double block_sum(double x, double* scratch) {
  for (int by = 16; by > 0; by /= 2) x += __shfl_down_sync(~0u, x, by);
  if constexpr (threads > 32) {
    __syncthreads();
    if (threadIdx.x % 32 == 0) scratch[threadIdx.x / 32] = x;
    __syncthreads();
    if (threadIdx.x == 0)
      for (int w = 1; w < threads / 32; ++w) x += scratch[w];
  }
  return x;
}
template <int threads>
__device__ double block_max(double x, double* scratch) {
  for (int by = 16; by > 0; by /= 2) x = max(x, __shfl_down_sync(~0u, x, by));
  if constexpr (threads > 32) {
    __syncthreads();
    if (threadIdx.x % 32 == 0) scratch[threadIdx.x / 32] = x;
    __syncthreads();
    if (threadIdx.x == 0)
      for (int w = 1; w < threads / 32; ++w) x = max(x, scratch[w]);
  }
  return x;
}

}  // namespace mpm
