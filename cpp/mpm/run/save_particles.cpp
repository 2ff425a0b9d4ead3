#include "mpm/run/save_particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mpm/run/check_restored.hpp"
#include "mpm/run/gather.hpp"

namespace mpm {
namespace {

constexpr std::array one{0};  // the place of a row's only number

constexpr std::size_t most = std::size_t{1} << 16;  // numbers that pass at once

/// The particles of the bodies of a pool: where those of each begin in the user's order, and which
/// of them this rank has, in that order.
template <int D>
struct Places {
  std::vector<std::size_t> first;  // by the number of the body
  std::size_t count = 0;           // of all ranks
  std::vector<PlacedRow> rows;

  Places(const Domain<D>& domain, std::size_t m) : first(domain.bodies.size()) {
    for (std::size_t b = 0; b < first.size(); ++b) {
      first[b] = count;
      if (pool_number(domain.bodies, static_cast<int>(b)) == m) count += domain.bodies[b].count;
    }
    if (count > std::numeric_limits<std::uint32_t>::max())
      throw std::invalid_argument(
          "bodies of one material have more than 4 billion particles, for which there are no "
          "checkpoints");
    const ParticlePool<D>& pool = domain.pools[m];
    const auto add = [&](int body, std::uint32_t row) {
      const std::size_t place = first[static_cast<std::size_t>(body)] + pool.id[row];
      rows.push_back({static_cast<std::uint32_t>(place), row});
    };
    for (const Patch<D>& patch : domain.grid.patches)
      if (pool_number(domain.bodies, patch.body) == m)
        for (const std::uint32_t row : pool.rows(patch)) add(patch.body, row);
    for (const RemovedRow& one : pool.removed) add(one.body, one.row);
    std::ranges::sort(rows, {}, &PlacedRow::place);
  }

  std::size_t body_at(std::size_t place) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(first, place) - first.begin()) - 1;
  }

  /// A number of each particle: get(row) here, set(row, number) when it is restored.
  template <class Number, class Get, class Set>
  void exchange(StateStream& stream, Get&& get, Set&& set) const {
    std::vector<Number> numbers;
    auto at = rows.begin();
    for (std::size_t begin = 0; begin < count; begin += most) {
      numbers.assign(std::min(most, count - begin), Number{});
      const auto end = std::lower_bound(
          at, rows.end(), begin + numbers.size(),
          [](const PlacedRow& one, std::size_t place) { return one.place < place; });
      const std::span here(at, end);
      if (!stream.restores()) {
        gather(stream.comm(), Slices(numbers.size()), 1, one, std::span(numbers), [&](auto&& f) {
          for (const auto [place, row] : here) f(place - begin, 0, get(row));
        });
      }
      stream.array(std::span(numbers));
      if (stream.restores())
        for (const auto [place, row] : here) set(row, numbers[place - begin]);
      at = end;
    }
  }
};

/// The pieces of loads, each with the particle that carries it.
template <int D>
void exchange_pieces(const Places<D>& places, ParticlePool<D>& pool, StateStream& stream) {
  stream.same(pool.pieces.size(), "it was made from another case");
  if (pool.pieces.empty()) return;
  places.template exchange<std::uint32_t>(
      stream, [&](std::uint32_t row) { return pool.piece[row]; },
      [&](std::uint32_t row, std::uint32_t piece) { pool.piece[row] = piece; });
  if (!stream.restores())
    gather(stream.comm(), Slices(pool.pieces.size()), 1, one, std::span(pool.pieces),
           [&](auto&& f) {
             for (const auto [place, row] : places.rows)
               for (std::uint32_t k = pool.piece[row]; k != 0; k = pool.pieces[k - 1].next)
                 f(k - 1, 0, pool.pieces[k - 1]);
           });
  stream.array(std::span(pool.pieces));
}

/// The rows that take part, a patch for each body, and those that do not.
template <int D>
void place_rows(Domain<D>& domain, std::size_t m, const Places<D>& places,
                const std::vector<bool>& removed, std::vector<Patch<D>>& bodies) {
  ParticlePool<D>& pool = domain.pools[m];
  pool.order.clear();
  pool.removed.clear();
  auto at = places.rows.begin();
  for (std::size_t b = 0; b < domain.bodies.size(); ++b) {
    if (pool_number(domain.bodies, static_cast<int>(b)) != m) continue;
    Body<D>& body = domain.bodies[b];
    Patch<D>& patch = bodies[b];
    patch.body = static_cast<int>(b);
    patch.begin = static_cast<std::uint32_t>(pool.order.size());
    body.removed_here = 0;
    for (; at != places.rows.end() && at->place < places.first[b] + body.count; ++at)
      if (removed[at->row]) {
        pool.removed.push_back({at->row, patch.body});
        ++body.removed_here;
      } else {
        pool.order.push_back(at->row);
        ++patch.count;
      }
  }
}

}  // namespace

template <int D>
void exchange_particles(Domain<D>& domain, std::size_t m, StateStream& stream,
                        std::vector<Patch<D>>& bodies) {
  ParticlePool<D>& pool = domain.pools[m];
  const Places<D> places(domain, m);
  stream.same(places.count, "it was made from another case");
  stream.same(pool.columns.component_count(), "it was made from another case");
  // Of bodies into which nodes were laid anew these are not those of the case.
  const auto places_in_body = [&] {
    std::vector<double> found;
    if (pool.reference < 0) return found;
    for (const PlacedRow& one : places.rows)
      if (domain.bodies[places.body_at(one.place)].renewals == 0)
        for (int a = 0; a < D; ++a)
          found.push_back(pool.columns.component(pool.reference + a)[one.row]);
    return found;
  };
  const std::vector<double> before = stream.restores() ? places_in_body() : std::vector<double>{};
  for (int c = 0; c < pool.columns.component_count(); ++c)
    pool.columns.with_component(c, [&]<class Number>(Number* values) {
      places.template exchange<Number>(
          stream, [&](std::uint32_t row) { return values[row]; },
          [&](std::uint32_t row, Number number) { values[row] = number; });
    });
  // Cells, nodes and contact points are made of them.
  if (stream.restores())
    stream.check_all(places_in_body() == before, "it was made from another case");
  std::vector<bool> removed(pool.count(), false);
  for (const RemovedRow& one : pool.removed) removed[one.row] = true;
  places.template exchange<std::uint8_t>(
      stream, [&](std::uint32_t row) { return std::uint8_t{removed[row]}; },
      [&](std::uint32_t row, std::uint8_t is) { removed[row] = is != 0; });
  exchange_pieces(places, pool, stream);
  if (!stream.restores()) return;
  place_rows(domain, m, places, removed, bodies);
  check_particles(domain, m, std::span(places.rows), stream);
}

template void exchange_particles<2>(Domain<2>&, std::size_t, StateStream&, std::vector<Patch<2>>&);
template void exchange_particles<3>(Domain<3>&, std::size_t, StateStream&, std::vector<Patch<3>>&);

}  // namespace mpm
