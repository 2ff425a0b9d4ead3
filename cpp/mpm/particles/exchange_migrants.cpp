// Particles that go from rank to rank: a letter says how many come to each pool, and holds groups
// of particles of a body, each with their numbers in it, every component of their columns, and the
// pieces of loads that they carry.
#include "mpm/particles/exchange_migrants.hpp"

#include <map>

#include "mpm/comm/letters.hpp"
#include "mpm/grid/connect.hpp"

namespace mpm {
namespace {

constexpr std::int32_t gone = -2;  // in place of a migrant's patch: it has gone to another rank

/// What a group begins with.
struct GroupHead {
  std::int32_t body;
  std::uint32_t count;
};

/// The particles of a body that go to a rank.
struct GroupToRank {
  int rank, body;
  std::vector<std::uint32_t> rows{};
};

template <int D>
void write_group(Letter& letter, const GroupToRank& group, const ParticlePool<D>& pool) {
  const std::span<const std::uint32_t> rows = group.rows;
  write(letter, GroupHead{group.body, static_cast<std::uint32_t>(rows.size())});
  write_rows(letter, pool.id.data(), rows);
  for (int c = 0; c < pool.columns.component_count(); ++c)
    pool.columns.with_component(c, [&](const auto* values) { write_rows(letter, values, rows); });
  if (pool.pieces.empty()) return;
  write_rows(letter, pool.piece.data(), rows);
  for (const std::uint32_t row : rows)
    for_each_piece_of(pool, row, [&](const SurfacePiece<D>& piece) { write(letter, piece); });
}

template <int D>
void read_group(Reader& reader, ParticlePool<D>& pool, std::span<const std::uint32_t> rows) {
  reader.read_rows(pool.id.data(), rows);
  for (int c = 0; c < pool.columns.component_count(); ++c)
    pool.columns.with_component(c, [&](auto* values) { reader.read_rows(values, rows); });
  if (pool.pieces.empty()) return;
  reader.read_rows(pool.piece.data(), rows);
  // A piece has the same number everywhere.
  for (const std::uint32_t row : rows)
    for_each_piece_of(pool, row, [&](SurfacePiece<D>& piece) {
      piece = reader.template read<SurfacePiece<D>>();
    });
}

/// Take the migrants that have come into tiles of other ranks out of the list, in groups.
template <int D>
std::vector<GroupToRank> take_leaving(const TileGrid<D>& grid, std::vector<Migrant<D>>& migrants) {
  const Partition<D>& partition = grid.partition;
  std::vector<GroupToRank> groups;
  for (Migrant<D>& migrant : migrants) {
    // Most go to patches that this rank has.
    if (migrant.patch >= 0 && !partition.divided &&
        !grid.patches[static_cast<std::size_t>(migrant.patch)].foreign)
      continue;
    const int rank = partition.owners.rank_of(migrant.tile);
    if (rank == partition.comm->rank()) continue;
    // Migrants are in the order of the bodies, so that only the last groups are looked at.
    auto group = groups.rbegin();
    while (group != groups.rend() && group->body == migrant.body && group->rank != rank) ++group;
    const bool is_new = group == groups.rend() || group->body != migrant.body;
    (is_new ? groups.emplace_back(rank, migrant.body) : *group).rows.push_back(migrant.row);
    migrant.patch = gone;
  }
  std::erase_if(migrants, [](const Migrant<D>& migrant) { return migrant.patch == gone; });
  return groups;
}

}  // namespace

template <int D>
void exchange_migrants(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                       std::vector<ParticlePool<D>>& pools, ListScratch<D>& scratch) {
  Mail& mail = grid.partition.mail.migrants;
  mail.out.clear();
  const std::vector<GroupToRank> groups = take_leaving(grid, scratch.migrants);
  std::map<int, std::vector<std::size_t>> counts;  // by rank, of each pool
  for (const GroupToRank& group : groups)
    counts.try_emplace(group.rank, pools.size()).first->second[pool_number(bodies, group.body)] +=
        group.rows.size();
  for (const auto& [rank, of_pools] : counts)
    for (const std::size_t count : of_pools) write(letter_to(mail, rank), count);
  for (const GroupToRank& group : groups) {
    ParticlePool<D>& pool = pools[pool_number(bodies, group.body)];
    write_group(letter_to(mail, group.rank), group, pool);
    pool.free_rows.insert(pool.free_rows.end(), group.rows.begin(), group.rows.end());
  }
  grid.partition.comm->exchange(mail);
  std::vector<Reader> readers(mail.in.begin(), mail.in.end());
  std::vector<std::size_t> coming(pools.size(), 0);
  for (Reader& reader : readers)
    for (std::size_t& count : coming) count += reader.read<std::size_t>();
  for (std::size_t m = 0; m < pools.size(); ++m) need_rows(pools[m], coming[m]);
  std::vector<std::uint32_t> rows;
  for (Reader& reader : readers)
    while (!reader.done()) {
      const auto head = reader.read<GroupHead>();
      ParticlePool<D>& pool = pools[pool_number(bodies, head.body)];
      take_rows(pool, head.count, rows);
      read_group<D>(reader, pool, rows);
      for (const std::uint32_t row : rows) {
        const auto [tile, cell] = grid.tile_and_cell(listed_place(pool, row));
        const int patch = find_patch<D>(grid, head.body, tile);
        scratch.migrants.push_back({head.body, tile, patch, row, static_cast<std::uint8_t>(cell)});
      }
    }
}

template void exchange_migrants<2>(TileGrid<2>&, const std::vector<Body<2>>&,
                                   std::vector<ParticlePool<2>>&, ListScratch<2>&);
template void exchange_migrants<3>(TileGrid<3>&, const std::vector<Body<3>>&,
                                   std::vector<ParticlePool<3>>&, ListScratch<3>&);

}  // namespace mpm
