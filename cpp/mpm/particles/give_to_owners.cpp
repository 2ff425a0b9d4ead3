// Before particles enter the pools of their materials, each goes to the rank that has its tile: a
// letter holds groups of particles of a body, with all that was given of them.
#include "mpm/particles/give_to_owners.hpp"

#include <algorithm>

#include "mpm/comm/letters.hpp"

namespace mpm {
namespace {

/// What a group begins with.
struct GroupHead {
  std::int32_t body;
  std::uint32_t count;
  std::uint64_t states;
};

template <int D>
Index<D> tile_of(const TileGrid<D>& grid, const GivenParticles& given, std::size_t k) {
  return grid.tile_and_cell(given.template position<D>(k)).first;
}

/// A patch for each tile of each body, with no more than its place and the count of its particles.
template <int D>
std::vector<Patch<D>> count_in_tiles(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies) {
  std::vector<Patch<D>> patches;
  std::vector<Index<D>> tiles;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].given) continue;
    tiles.clear();
    for (std::size_t k = 0; k < bodies[b].given->count(); ++k)
      tiles.push_back(tile_of(grid, *bodies[b].given, k));
    std::ranges::sort(tiles);
    for (std::size_t k = 0; k < tiles.size(); ++k) {
      if (k == 0 || tiles[k] != tiles[k - 1]) {
        Patch<D>& patch = patches.emplace_back();
        patch.body = static_cast<std::int32_t>(b);
        patch.tile = tiles[k];
      }
      ++patches.back().count;
    }
  }
  return patches;
}

/// values[k] of each k, `width` numbers, or for all the same ones.
void write_given(Letter& letter, const std::vector<double>& values, std::size_t width,
                 std::span<const std::uint32_t> which) {
  const bool one = values.size() == width;
  std::byte* to = extend(letter, which.size() * width * sizeof(double));
  for (const std::uint32_t k : which) {
    std::memcpy(to, &values[one ? 0 : k * width], width * sizeof(double));
    to += width * sizeof(double);
  }
}

template <int D>
void write_group(Letter& letter, int body, const GivenParticles& given,
                 std::span<const std::uint32_t> which) {
  write(letter, GroupHead{body, static_cast<std::uint32_t>(which.size()), given.states.size()});
  for (const std::uint32_t k : which) write(letter, given.number(k));
  write_given(letter, given.positions, D, which);
  write_given(letter, given.velocities, D, which);
  write_given(letter, given.volumes, 1, which);
  for (const auto& [component, values] : given.states) {
    write(letter, component);
    // One particle's are not those of all.
    for (const std::uint32_t k : which) write(letter, values[k]);
  }
}

template <int D>
void read_group(Reader& reader, const GroupHead& head, GivenParticles& given) {
  const auto append = [&](std::vector<double>& values, std::size_t width) {
    for (std::size_t k = 0; k < head.count * width; ++k) values.push_back(reader.read<double>());
  };
  for (std::uint32_t k = 0; k < head.count; ++k)
    given.numbers.push_back(reader.read<std::uint32_t>());
  append(given.positions, D);
  append(given.velocities, D);
  append(given.volumes, 1);
  given.states.resize(head.states);
  for (auto& [component, values] : given.states) {
    component = reader.read<int>();
    append(values, 1);
  }
}

/// All that this rank was given, in letters to the ranks of its tiles; that to itself is apart.
template <int D>
Letter write_all(const TileGrid<D>& grid, std::vector<Body<D>>& bodies, const Owners<D>& owners,
                 Mail& mail) {
  const int own = grid.partition.comm->rank();
  Letter kept;
  std::vector<std::vector<std::uint32_t>> of_ranks(owners.first.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].given) continue;
    const GivenParticles& given = *bodies[b].given;
    for (std::size_t k = 0; k < given.count(); ++k)
      of_ranks[static_cast<std::size_t>(owners.rank_of(tile_of(grid, given, k)))].push_back(
          static_cast<std::uint32_t>(k));
    for (std::size_t rank = 0; rank < of_ranks.size(); ++rank) {
      if (of_ranks[rank].empty()) continue;
      const bool stays = std::cmp_equal(rank, own);
      Letter& letter = stays ? kept : letter_to(mail, static_cast<int>(rank));
      write_group<D>(letter, static_cast<int>(b), given, of_ranks[rank]);
      of_ranks[rank].clear();
    }
    bodies[b].given.reset();
  }
  return kept;
}

}  // namespace

template <int D>
std::optional<Owners<D>> give_to_owners(TileGrid<D>& grid, std::vector<Body<D>>& bodies) {
  if (grid.partition.alone()) return std::nullopt;
  const Owners<D> owners = choose_owners<D>(grid, count_in_tiles(grid, bodies), bodies);
  Mail mail;
  const Letter kept = write_all(grid, bodies, owners, mail);
  grid.partition.comm->exchange(mail);
  mail.out.clear();
  mail.in.push_back(kept);
  for (Letter& letter : mail.in) {
    for (Reader reader(letter); !reader.done();) {
      const auto head = reader.read<GroupHead>();
      std::unique_ptr<GivenParticles>& given = bodies[static_cast<std::size_t>(head.body)].given;
      if (!given) given = std::make_unique<GivenParticles>();
      read_group<D>(reader, head, *given);
    }
    letter = {};
  }
  return owners;
}

template std::optional<Owners<2>> give_to_owners<2>(TileGrid<2>&, std::vector<Body<2>>&);
template std::optional<Owners<3>> give_to_owners<3>(TileGrid<3>&, std::vector<Body<3>>&);

}  // namespace mpm
