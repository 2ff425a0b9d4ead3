// Particles that go from rank to rank: a letter holds, one after another, the number of a body,
// that of a particle in it, all components of its columns, and the pieces of loads that it carries.
#include "mpm/particles/exchange_migrants.hpp"

#include "mpm/comm/letters.hpp"
#include "mpm/grid/connect.hpp"

namespace mpm {
namespace {

constexpr std::int32_t gone = -2;  // in place of a migrant's patch: it has gone to another rank

template <int D>
void write_particle(Letter& letter, int body, const ParticlePool<D>& pool, std::uint32_t row) {
  write(letter, body);
  write(letter, pool.id[row]);
  for (int c = 0; c < pool.columns.component_count(); ++c)
    pool.columns.with_component(c, [&](const auto* values) { write(letter, values[row]); });
  if (pool.pieces.empty()) return;
  write(letter, pool.piece[row]);
  for_each_piece_of(pool, row, [&](const SurfacePiece<D>& piece) { write(letter, piece); });
}

template <int D>
void read_particle(Reader& reader, ParticlePool<D>& pool, std::uint32_t row) {
  pool.id[row] = reader.read<std::uint32_t>();
  for (int c = 0; c < pool.columns.component_count(); ++c)
    pool.columns.with_component(
        c, [&]<class Number>(Number* values) { values[row] = reader.read<Number>(); });
  if (pool.pieces.empty()) return;
  pool.piece[row] = reader.read<std::uint32_t>();
  // A piece has the same number everywhere.
  for (std::uint32_t k = pool.piece[row]; k != 0; k = pool.pieces[k - 1].next)
    pool.pieces[k - 1] = reader.read<SurfacePiece<D>>();
}

}  // namespace

template <int D>
void exchange_migrants(TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                       std::vector<ParticlePool<D>>& pools, ListScratch<D>& scratch) {
  Partition<D>& partition = grid.partition;
  Mail& mail = partition.mail.migrants;
  mail.out.clear();
  for (Migrant<D>& migrant : scratch.migrants) {
    // Most go to patches that this rank has.
    if (migrant.patch >= 0 && !partition.divided &&
        !grid.patches[static_cast<std::size_t>(migrant.patch)].foreign)
      continue;
    const int rank = partition.owners.rank_of(migrant.tile);
    if (rank == partition.comm->rank()) continue;
    ParticlePool<D>& pool = pools[pool_number(bodies, migrant.body)];
    write_particle(letter_to(mail, rank), migrant.body, pool, migrant.row);
    pool.free_rows.push_back(migrant.row);
    migrant.patch = gone;
  }
  std::erase_if(scratch.migrants, [](const Migrant<D>& migrant) { return migrant.patch == gone; });
  partition.comm->exchange(mail);
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) {
      const int body = reader.read<int>();
      ParticlePool<D>& pool = pools[pool_number(bodies, body)];
      const std::uint32_t row = take_row(pool);
      read_particle(reader, pool, row);
      const auto [tile, cell] = grid.tile_and_cell(pool.position_of(row));
      scratch.migrants.push_back({body, tile,
                                  static_cast<std::int32_t>(find_patch<D>(grid, body, tile)), row,
                                  static_cast<std::uint8_t>(cell)});
    }
}

template void exchange_migrants<2>(TileGrid<2>&, const std::vector<Body<2>>&,
                                   std::vector<ParticlePool<2>>&, ListScratch<2>&);
template void exchange_migrants<3>(TileGrid<3>&, const std::vector<Body<3>>&,
                                   std::vector<ParticlePool<3>>&, ListScratch<3>&);

}  // namespace mpm
