#pragma once
// Which particles lie in which cell: lists built once, then updated where particles have moved.
// Columns are put back in order only when that pays; correctness never depends on it.
#include <limits>
#include <utility>
#include <vector>

#include "mpm/comm/all_sums.hpp"
#include "mpm/grid/tile_grid.hpp"
#include "mpm/parallel/threads.hpp"
#include "mpm/particles/pool.hpp"

namespace mpm {

/// A particle that has left its tile.
template <int D>
struct Migrant {
  int body;
  Index<D> tile;       // that it has come to
  std::int32_t patch;  // of its body there; -1 while there is none
  std::uint32_t row;
  std::uint8_t cell;
};

/// A particle that comes to a patch.
struct Arrival {
  std::uint32_t row;
  std::uint8_t cell;
};

/// What particles that take no part any more have taken with them so far; of a rank those that it
/// had. Trivially copyable, so that a checkpoint holds it.
struct Removed {
  std::size_t count = 0;
  std::array<ExactSum, 6> sums;  // that depend on no order: of the values of RemovedTotal

  void add(const std::array<double, 6>& values) {
    ++count;
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k].add(values[k]);
  }
};

/// The same of all ranks.
struct RemovedTotal {
  std::size_t count = 0;
  double mass = 0.0;                           // [kg]
  double kinetic = 0.0, recoverable = 0.0;     // [J]
  Vector3 angular_momentum = Vector3::zero();  // about the origin [N m s]
};
inline RemovedTotal total_of(Removed removed, Comm& comm) {
  const std::int64_t count = all_sum(comm, static_cast<std::int64_t>(removed.count));
  if (count == 0) return {};
  all_sum(comm, removed.sums);
  const auto& s = removed.sums;
  return {static_cast<std::size_t>(count),
          s[0].value(),
          s[1].value(),
          s[2].value(),
          {s[3].value(), s[4].value(), s[5].value()}};
}

/// Reused from step to step, so that a step allocates nothing, and shared by all bodies.
template <int D>
struct ListScratch {
  // What is noted of a patch, so that who goes through all of them need not read the patches, each
  // of which is far from the next.
  struct Note {
    int body = 0;
    std::uint32_t begin = 0, room = 0;  // Patch::begin, room
    bool left_cell = false;             // Patch::left_cell
    std::size_t first_mark = 0;         // of `marks`
    std::uint32_t kept = 0;             // particles that stay in the patch
    std::uint32_t removed = 0;          // that take no part any more
    std::uint32_t migrants = 0;         // that go to another patch
    std::uint32_t first_migrant = 0;    // of `migrants`
    std::uint32_t changes = 0;          // particles that have changed cell, or were removed
  };
  struct Change {
    std::size_t first_mark = 0, first_entry = 0;  // of `marks`; of `lists`
    std::uint32_t kept = 0, removed = 0;
    std::uint32_t first_arrival = 0, arrivals_end = 0;  // of `arrivals`
    std::uint32_t begin = 0, room = 0;                  // of the new list, in those of the pool
    int body = 0;
    bool rewritten = false;

    std::uint32_t count() const { return kept + arrivals_end - first_arrival; }
  };
  std::vector<Note> notes;                        // one per patch, before patches are added
  std::vector<Migrant<D>> migrants;               // in the order of the patches that they leave
  std::vector<std::pair<int, Index<D>>> entered;  // body and tile of each patch to be added
  std::vector<std::int32_t> number;  // of each patch, after patches were added; -1 if it has gone
  std::vector<Change> changes;       // one per patch, after patches were added
  std::vector<Arrival> arrivals;     // in the order of the patches that they come to
  std::vector<int> moved;            // the bodies of which particles have changed cell in this step
  // Of each pool: some particle has left its cell; its lists are laid out anew.
  std::vector<std::uint8_t> touched, full;
  std::vector<std::uint32_t>
      first;  // where the list of each patch of a body begins, one after another
  std::uint32_t* lists = nullptr;  // the new lists of patches whose lists change
  std::uint8_t* marks = nullptr;   // cell or CellMark of each particle of patches that some leave

  /// Room for so many bytes, until the next call or until blocks are cut: in the memory of the
  /// nodes, whose values are of no use before momentum is mapped, or where that is too small, our
  /// own, which then gets `most`.
  std::byte* room(TileGrid<D>& grid, std::size_t bytes, std::size_t most) {
    const std::span<std::byte> idle = grid.nodes.idle();
    if (bytes <= idle.size()) return idle.data();
    make_room(own, bytes, most);
    return own.data();
  }
  /// Of what goes with the particles; migrants and what goes with the patches is not counted.
  std::size_t bytes() const { return own.bytes() + own_lists.bytes(); }

  AlignedArray<std::byte> own;
  AlignedArray<std::uint32_t> own_lists;  // `lists` where there are other ranks
};

/// Let tiles begin at the lowest cell with a particle. Throws std::invalid_argument if one lies
/// more than 2^19 cells from the origin. By all ranks at once.
template <int D>
void place_anchor(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const std::vector<ParticlePool<D>>& pools);
/// The same, of particles that are given and in no pool yet.
template <int D>
void place_anchor(TileGrid<D>& grid, const std::vector<Body<D>>& bodies);

/// Sort every body's rows by tile and cell, and make patches and lists anew, at the start, after a
/// change of the grid, or from a checkpoint. Throws std::out_of_range if a particle lies more than
/// 2^20 cells from the anchor. By all ranks at once, which take these tiles, or share them out.
template <int D>
void build_cell_lists(TileGrid<D>& grid, std::vector<Body<D>>& bodies,
                      std::vector<ParticlePool<D>>& pools, Threads& threads,
                      ListScratch<D>& scratch, std::optional<Owners<D>> owners = {});

/// The ranges of tiles that cost alike, where patches with no more than a body, a tile and a count
/// tell of the particles. By all ranks at once.
template <int D>
Owners<D> choose_owners(const TileGrid<D>& grid, std::span<const Patch<D>> patches,
                        const std::vector<Body<D>>& bodies);

/// From now on these ranks have the tiles; particles go there when lists are updated.
template <int D>
void take_owners(TileGrid<D>& grid, Owners<D> owners);

/// Give these tiles to the ranks, or share them out by what they cost, and take the particles
/// there. By all ranks at once.
template <int D>
void divide(TileGrid<D>& grid, std::vector<Body<D>>& bodies, std::vector<ParticlePool<D>>& pools,
            Threads& threads, ListScratch<D>& scratch, std::optional<Owners<D>> owners);

/// What is done in a tile of this rank beside the stages of its particles.
template <int D>
struct TileCost {
  Index<D> tile;
  std::int64_t cost;  // in quarters of what a particle costs in a step
};

/// Other ranges of tiles, if the cost of one rank is more than `bound` times the mean one and
/// others are better; then true, and particles go along in the next update_cell_lists(). By all
/// ranks at once.
template <int D>
bool share_out_anew(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                    std::span<const TileCost<D>> more, double bound);

/// Put the rows that hold particles into the order of the lists, one behind another, with some room
/// for others that come; guests are forgotten.
template <int D>
void repack(std::vector<Patch<D>>& patches, std::vector<Body<D>>& bodies,
            std::vector<ParticlePool<D>>& pools);

/// In the column `failed`, beside the values of FailureAction: the particle has left the region
/// that is kept.
inline constexpr double left_region = 4.0;

/// May any particle be removed: by failure, or out of the region that is kept?
template <int D>
bool may_remove(const TileGrid<D>& grid, const std::vector<ParticlePool<D>>& pools) {
  const auto may_fail = [](const ParticlePool<D>& pool) { return pool.at.failed >= 0; };
  return grid.outflow_box.exist || std::ranges::any_of(pools, may_fail);
}

/// Find the particles that have left their tiles, where ListScratch::notes says how many, and what
/// changes for each patch; true if patches were added or removed.
template <int D>
bool migrate_particles(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                       std::vector<ParticlePool<D>>& pools, Threads& threads,
                       ListScratch<D>& scratch);

/// Update the lists of patches that particles have left, and take out what has eroded or left the
/// region that is kept, where there are sums for it; true if patches were added or removed. By all
/// ranks at once: particles go to those that have the tiles.
template <int D>
bool update_cell_lists(TileGrid<D>& grid, std::vector<Body<D>>& bodies,
                       std::vector<ParticlePool<D>>& pools, Threads& threads,
                       ListScratch<D>& scratch, Removed* eroded, Removed* outflow);

/// Put the rows of a body into the order of its lists.
template <int D>
void sort_columns(TileGrid<D>& grid, Body<D>& body, std::span<Patch<D>> patches,
                  ParticlePool<D>& pool, Threads& threads, ListScratch<D>& scratch);

/// Sorting moves every column once; reading particles out of order costs about that once this share
/// of them is.
inline constexpr double disorder_that_pays = 0.25;

/// The same for the bodies of which particles have moved in this step, if that share of them has
/// changed cell since they were sorted.
template <int D>
void sort_disordered(TileGrid<D>& grid, std::vector<Body<D>>& bodies,
                     std::vector<ParticlePool<D>>& pools, Threads& threads, double share,
                     ListScratch<D>& scratch);

}  // namespace mpm
