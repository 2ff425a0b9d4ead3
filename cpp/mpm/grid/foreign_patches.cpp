#include "mpm/grid/foreign_patches.hpp"

#include "mpm/comm/letters.hpp"

namespace mpm {
namespace {

/// The set of other ranks that have the tile of a patch or one beside it.
template <int D>
const std::vector<int>& readers_of(Partition<D>& partition, Patch<D>& patch) {
  if (patch.readers >= 0) return partition.readers[static_cast<std::size_t>(patch.readers)];
  std::vector<int> ranks;
  ranks.reserve(Tile<D>::neighbours);
  for (int k = 0; k < Tile<D>::neighbours; ++k)
    ranks.push_back(partition.owners.rank_of(Tile<D>::beside(patch.tile, k)));
  std::ranges::sort(ranks);
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  std::erase(ranks, partition.comm->rank());
  // Few patches have any, and their sets are few.
  const auto [found, added] = partition.reader_numbers.try_emplace(
      std::move(ranks), static_cast<int>(partition.readers.size()));
  if (added) partition.readers.push_back(found->first);
  patch.readers = found->second;
  return partition.readers[static_cast<std::size_t>(patch.readers)];
}

template <int D>
bool is_foreign_as_told(const TileGrid<D>& grid) {
  auto told = grid.partition.told.begin();
  for (const Patch<D>& patch : grid.patches) {
    if (!patch.foreign) continue;
    if (told == grid.partition.told.end() || told->body != patch.body || told->tile != patch.tile)
      return false;
    ++told;
  }
  return told == grid.partition.told.end();
}

/// Own patches and those told of, in their order.
template <int D>
void merge(TileGrid<D>& grid) {
  const std::vector<Patch<D>> before = std::exchange(grid.patches, {});
  grid.patches.reserve(before.size() + grid.partition.told.size());
  auto told = grid.partition.told.begin();
  const auto add_before = [&](const Patch<D>* next) {
    for (; told != grid.partition.told.end() &&
           (!next || patch_less<D>(told->body, told->tile, next->body, next->tile));
         ++told) {
      Patch<D>& patch = grid.patches.emplace_back();
      patch.body = told->body;
      patch.tile = told->tile;
      patch.foreign = true;
      patch.keeps = told->keeps;
    }
  };
  for (const Patch<D>& patch : before) {
    if (patch.foreign || grid.partition.leaves(patch)) continue;
    add_before(&patch);
    grid.patches.push_back(patch);
  }
  add_before(nullptr);
}

}  // namespace

template <int D>
bool exchange_patches(TileGrid<D>& grid) {
  Partition<D>& partition = grid.partition;
  Mail& mail = partition.mail.patches;
  mail.out.clear();
  for (Patch<D>& patch : grid.patches) {
    if (patch.foreign || partition.leaves(patch) || patch.occupied == 0) continue;
    for (const int rank : readers_of(partition, patch))
      write(letter_to(mail, rank), ForeignPatch<D>{patch.body, patch.tile, patch.occupied,
                                                   partition.comm->rank(), patch.keeps});
  }
  partition.comm->exchange(mail);
  partition.told.clear();
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();)
      partition.told.push_back(reader.template read<ForeignPatch<D>>());
  std::ranges::sort(partition.told, [](const auto& x, const auto& y) {
    return patch_less<D>(x.body, x.tile, y.body, y.tile);
  });
  // With other owners the same patches are exchanged with others.
  const bool changed = partition.divided || !is_foreign_as_told(grid);
  if (changed) merge(grid);
  partition.divided = false;
  auto told = partition.told.begin();
  for (Patch<D>& patch : grid.patches) {
    if (!patch.foreign) continue;
    patch.owner = told->rank;
    patch.foreign_cells = told++->occupied;
  }
  return changed;
}

template bool exchange_patches<2>(TileGrid<2>&);
template bool exchange_patches<3>(TileGrid<3>&);

}  // namespace mpm
