#include "mpm/contact/exchange_contact.hpp"

#include "mpm/comm/letters.hpp"
#include "mpm/contact/tile_touches.hpp"
#include "mpm/grid/connect.hpp"

namespace mpm {
namespace {

template <int D>
struct ToldTouch {
  Index<D> tile;  // that it lies in
  Touch<D> touch;
};

template <int D>
struct ToldNode {
  std::int32_t body, node;  // node: of the patch's block
  Index<D> tile;
  Vec<double, D> value;  // velocity [m/s] or force [N]
};

/// f(touch, rank) for each touch of a tile and each other rank with nodes that it reaches.
template <int D, class F>
void for_each_reader(const Contact<D>& contact, const TileGrid<D>& grid, const ContactTile<D>& tile,
                     double support, F&& f) {
  const std::span<const Touch<D>> touches(
      contact.touches[tile.touches.share].data() + tile.touches.first, tile.touches.count);
  if (touches.empty()) return;
  std::array<int, Tile<D>::neighbours> owners;
  for (int k = 0; k < Tile<D>::neighbours; ++k)
    owners[static_cast<std::size_t>(k)] =
        grid.partition.owners.rank_of(Tile<D>::beside(tile.tile, k));
  std::vector<int> readers;
  for (const Touch<D>& touch : touches) {
    readers.clear();
    for (int k = 0; k < Tile<D>::neighbours; ++k) {
      const int rank = owners[static_cast<std::size_t>(k)];
      if (rank == grid.partition.comm->rank() || std::ranges::find(readers, rank) != readers.end())
        continue;
      Vec<double, D> place = touch.place();
      for (std::size_t a = 0; a < D; ++a)
        place[static_cast<int>(a)] -= Tile<D>::cells * Tile<D>::offset(k)[a];
      if (TileTouches<D>::nodes_near(place, support) == 0) continue;
      readers.push_back(rank);
      f(touch, rank);
    }
  }
}

}  // namespace

template <int D>
void exchange_touches(Contact<D>& contact, const TileGrid<D>& grid, double support) {
  Comm& comm = *grid.partition.comm;
  if (comm.alone()) return;
  Mail& mail = contact.mail.touches;
  mail.out.clear();
  for (const ContactTile<D>& tile : contact.tiles)
    if (tile.beside_others)
      for_each_reader(contact, grid, tile, support, [&](const Touch<D>& touch, int rank) {
        write(letter_to(mail, rank), ToldTouch<D>{tile.tile, touch});
      });
  comm.exchange(mail);
  std::vector<ToldTouch<D>> told;
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();)
      told.push_back(reader.template read<ToldTouch<D>>());
  // Those of a tile come from one rank, and stay in their order.
  std::ranges::stable_sort(told, tile_less<D>, &ToldTouch<D>::tile);
  contact.foreign_touches.clear();
  for (const ToldTouch<D>& one : told) contact.foreign_touches.push_back(one.touch);
  for (ForeignTile<D>& tile : contact.foreign_tiles) {
    const auto found = std::ranges::equal_range(told, tile.tile, tile_less<D>, &ToldTouch<D>::tile);
    tile.first = static_cast<std::uint32_t>(found.begin() - told.begin());
    tile.count = static_cast<std::uint32_t>(found.size());
  }
}

template <int D>
void exchange_responses(Contact<D>& contact, TileGrid<D>& grid, int at) {
  Comm& comm = *grid.partition.comm;
  if (comm.alone()) return;
  Mail& mail = contact.mail.responses;
  mail.out.clear();
  for (ContactPart<D>& part : contact.parts)
    for (const ContactNode& node : part.nodes) {
      if (!contact.tiles[node.tile].held_by_others || !part.any_gap_closed(node)) continue;
      for (const BodyAtNode<D>& side : part.sides_of(node))
        part.for_each_place(side, [&](std::uint32_t place) {
          // Blocks lie one behind another, in the order of the patches.
          const auto next = std::ranges::upper_bound(grid.patches, std::size_t{place} * record, {},
                                                     &Patch<D>::memory);
          const Patch<D>& patch = *std::prev(next);
          if (!patch.foreign) return;
          const double* const numbers = grid.nodes.record_at(place);
          ToldNode<D> told{
              patch.body, static_cast<std::int32_t>(place - patch.memory / record), patch.tile, {}};
          for (int a = 0; a < D; ++a) told.value[a] = numbers[at + a];
          write(letter_to(mail, patch.owner), told);
        });
    }
  comm.exchange(mail);
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) {
      const auto told = reader.template read<ToldNode<D>>();
      const int p = find_patch<D>(grid, told.body, told.tile);
      if (p < 0) throw std::logic_error("another rank tells of a patch that is not here");
      double* const numbers = grid.block(static_cast<std::size_t>(p)).records[told.node];
      for (int a = 0; a < D; ++a) numbers[at + a] = told.value[a];
    }
}

template void exchange_touches<2>(Contact<2>&, const TileGrid<2>&, double);
template void exchange_touches<3>(Contact<3>&, const TileGrid<3>&, double);
template void exchange_responses<2>(Contact<2>&, TileGrid<2>&, int);
template void exchange_responses<3>(Contact<3>&, TileGrid<3>&, int);

}  // namespace mpm
