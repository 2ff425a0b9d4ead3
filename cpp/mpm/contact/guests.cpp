#include "mpm/contact/guests.hpp"

#include <numeric>

#include "mpm/comm/letters.hpp"
#include "mpm/contact/find_touches.hpp"
#include "mpm/grid/connect.hpp"

namespace mpm {
namespace {

/// What a rank asks another for: the particles in some cells of a patch.
template <int D>
struct Request {
  std::int32_t body;
  Index<D> tile;
  std::uint64_t cells;
};

/// What it is told of the patch, before the particles.
struct Answer {
  std::uint8_t surface_range;  // [cells]
  std::uint32_t count;
};

template <int D>
struct Guest {
  std::uint8_t cell;
  Vec<double, D> x;               // [m]
  double mass, volume, set_back;  // [kg], [m^3], a share of half its edge
};

template <int D>
double set_back_of(const ParticlePool<D>& pool, std::uint32_t row) {
  return pool.set_back < 0 ? 0.0 : pool.columns.component(pool.set_back)[row];
}

/// The particles of some cells of an own patch, in the order of its lists.
template <int D>
void answer(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
            const std::vector<ParticlePool<D>>& pools, const Patch<D>& patch, std::uint64_t cells,
            Letter& letter) {
  const ParticlePool<D>& pool = pools[pool_number(bodies, patch.body)];
  std::uint32_t count = 0;
  const auto each = [&](auto&& f) {
    patch.for_each_cell([&](int cell, std::uint32_t begin, std::uint32_t end) {
      if (!(cells >> cell & 1u)) return;
      for (std::uint32_t k = begin; k < end; ++k) f(cell, pool.order[k]);
    });
  };
  each([&](int, std::uint32_t) { ++count; });
  write(letter, Answer{surface_range(grid, pool, patch), count});
  each([&](int cell, std::uint32_t row) {
    write(letter, Guest<D>{static_cast<std::uint8_t>(cell), pool.position_of(row), pool.mass()[row],
                           pool.volume()[row], set_back_of(pool, row)});
  });
}

/// Take the particles of a foreign patch in, behind all lists of their pool; `rows` is scratch.
template <int D>
void take_in(Reader& reader, ParticlePool<D>& pool, Patch<D>& patch,
             std::vector<std::uint32_t>& rows) {
  const auto told = reader.read<Answer>();
  patch.surface_range = told.surface_range;
  patch.begin = static_cast<std::uint32_t>(pool.used + pool.guests.size());
  patch.room = 0;  // no list of its own
  patch.cell_begin.fill(0);
  take_rows(pool, told.count, rows);
  pool.guests.insert(pool.guests.end(), rows.begin(), rows.end());
  for (const std::uint32_t row : rows) {
    const auto guest = reader.template read<Guest<D>>();
    for (int a = 0; a < D; ++a) pool.x(a)[row] = guest.x[a];
    pool.mass()[row] = guest.mass;
    pool.volume()[row] = guest.volume;
    if (pool.set_back >= 0) pool.columns.component(pool.set_back)[row] = guest.set_back;
    ++patch.cell_begin[guest.cell + std::size_t{1}];
  }
  std::partial_sum(patch.cell_begin.begin(), patch.cell_begin.end(), patch.cell_begin.begin());
}

}  // namespace

template <int D>
void exchange_guests(Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                     std::vector<ParticlePool<D>>& pools) {
  Comm& comm = *grid.partition.comm;
  if (comm.alone()) return;
  Mail& asked = contact.mail.asked;
  Mail& told = contact.mail.told;
  asked.out.clear();
  for (const WantedCells& wanted : contact.wanted) {
    const Patch<D>& patch = grid.patches[wanted.patch];
    write(letter_to(asked, patch.owner),
          Request<D>{patch.body, patch.tile, wanted.cells & patch.foreign_cells});
  }
  comm.exchange(asked);
  told.out.clear();
  for (const Letter& letter : asked.in)
    for (Reader reader(letter); !reader.done();) {
      const auto request = reader.template read<Request<D>>();
      const int p = find_patch<D>(grid, request.body, request.tile);
      if (p < 0) throw std::logic_error("another rank asks for a patch that is not here");
      Patch<D>& patch = grid.patches[static_cast<std::size_t>(p)];
      patch.in_contact = true;
      answer(grid, bodies, pools, patch, request.cells, letter_to(told, letter.rank));
    }
  comm.exchange(told);
  for (ParticlePool<D>& pool : pools) {
    pool.free_rows.insert(pool.free_rows.end(), pool.guests.begin(), pool.guests.end());
    pool.guests.clear();
  }
  std::vector<std::pair<int, Reader>> readers;
  readers.reserve(told.in.size());
  for (const Letter& letter : told.in) readers.emplace_back(letter.rank, Reader(letter));
  std::vector<std::uint32_t> rows;
  // Answers come in the order of the requests.
  for (const WantedCells& wanted : contact.wanted) {
    Patch<D>& patch = grid.patches[wanted.patch];
    take_in(std::ranges::find(readers, patch.owner, &std::pair<int, Reader>::first)->second,
            pools[pool_number(bodies, patch.body)], patch, rows);
  }
  for (ParticlePool<D>& pool : pools) {
    const std::size_t end = pool.used + pool.guests.size();
    if (end > pool.order.size()) pool.order.resize(end + spare_room(end));
    std::ranges::copy(pool.guests, pool.order.begin() + static_cast<std::ptrdiff_t>(pool.used));
  }
}

template void exchange_guests<2>(Contact<2>&, TileGrid<2>&, const std::vector<Body<2>>&,
                                 std::vector<ParticlePool<2>>&);
template void exchange_guests<3>(Contact<3>&, TileGrid<3>&, const std::vector<Body<3>>&,
                                 std::vector<ParticlePool<3>>&);

}  // namespace mpm
