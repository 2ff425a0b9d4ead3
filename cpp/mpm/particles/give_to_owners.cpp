// Before particles enter the pools of their materials, each goes to the rank that has its tile: a
// letter holds groups of particles of a body, with all that was given of them.
#include "mpm/particles/give_to_owners.hpp"

#include <algorithm>

#include "mpm/comm/letters.hpp"

namespace mpm {
namespace {

/// A letter begins with these, and their number.
struct GivenHead {
  std::int32_t body;
  std::uint32_t count;
  std::uint64_t states;
};

/// The particles of a body that go to a rank.
struct GivenGroup {
  int body;
  std::vector<std::uint32_t> which;
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
void write_group(Letter& letter, const GivenParticles& given,
                 std::span<const std::uint32_t> which) {
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
void read_group(Reader& reader, const GivenHead& head, GivenParticles& given) {
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

/// Which of its particles this rank gives to each.
template <int D>
std::vector<std::vector<GivenGroup>> groups_of_ranks(const TileGrid<D>& grid,
                                                     const std::vector<Body<D>>& bodies,
                                                     const Owners<D>& owners) {
  std::vector<std::vector<GivenGroup>> groups(owners.first.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (std::size_t k = 0; bodies[b].given && k < bodies[b].given->count(); ++k) {
      const int rank = owners.rank_of(tile_of(grid, *bodies[b].given, k));
      std::vector<GivenGroup>& of_rank = groups[static_cast<std::size_t>(rank)];
      if (of_rank.empty() || std::cmp_not_equal(of_rank.back().body, b))
        of_rank.push_back({static_cast<int>(b), {}});
      of_rank.back().which.push_back(static_cast<std::uint32_t>(k));
    }
  return groups;
}

/// A letter to each rank that gets any, this one too.
template <int D>
std::vector<Letter> write_all(const TileGrid<D>& grid, std::vector<Body<D>>& bodies,
                              const Owners<D>& owners) {
  const std::vector<std::vector<GivenGroup>> groups = groups_of_ranks(grid, bodies, owners);
  std::vector<Letter> letters(groups.size());
  for (std::size_t rank = 0; rank < groups.size(); ++rank) {
    letters[rank].rank = static_cast<int>(rank);
    if (groups[rank].empty()) continue;
    write(letters[rank], groups[rank].size());
    for (const GivenGroup& group : groups[rank]) {
      const auto count = static_cast<std::uint32_t>(group.which.size());
      const auto& given = *bodies[static_cast<std::size_t>(group.body)].given;
      write(letters[rank], GivenHead{group.body, count, given.states.size()});
    }
  }
  // Body by body, so that memory does not hold all twice.
  std::vector<std::size_t> next(groups.size(), 0);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (std::size_t rank = 0; rank < groups.size(); ++rank) {
      if (next[rank] == groups[rank].size()) continue;
      const GivenGroup& group = groups[rank][next[rank]];
      if (std::cmp_not_equal(group.body, b)) continue;
      write_group<D>(letters[rank], *bodies[b].given, group.which);
      ++next[rank];
    }
    bodies[b].given.reset();
  }
  return letters;
}

/// The heads of a letter's groups; room is made for what they tell of.
template <int D>
std::vector<GivenHead> read_heads(Reader& reader, std::vector<Body<D>>& bodies) {
  std::vector<GivenHead> heads(reader.read<std::size_t>());
  for (GivenHead& head : heads) {
    head = reader.read<GivenHead>();
    std::unique_ptr<GivenParticles>& given = bodies[static_cast<std::size_t>(head.body)].given;
    if (!given) given = std::make_unique<GivenParticles>();
    const std::size_t count = given->numbers.capacity() + head.count;
    given->numbers.reserve(count);
    given->positions.reserve(D * count);
    given->velocities.reserve(D * count);
    given->volumes.reserve(count);
  }
  return heads;
}

}  // namespace

template <int D>
std::optional<Owners<D>> give_to_owners(TileGrid<D>& grid, std::vector<Body<D>>& bodies) {
  if (grid.partition.alone()) return std::nullopt;
  Owners<D> owners = choose_owners<D>(grid, count_in_tiles(grid, bodies), bodies);
  std::vector<Letter> letters = write_all(grid, bodies, owners);
  Comm& comm = *grid.partition.comm;
  Mail mail;
  for (Letter& letter : letters)
    if (letter.rank != comm.rank() && !letter.bytes.empty()) mail.out.push_back(std::move(letter));
  comm.exchange(mail);
  mail.out.clear();
  Letter& kept = letters[static_cast<std::size_t>(comm.rank())];
  if (!kept.bytes.empty()) mail.in.push_back(std::move(kept));
  std::vector<Reader> readers(mail.in.begin(), mail.in.end());
  std::vector<std::vector<GivenHead>> heads(readers.size());
  for (std::size_t k = 0; k < heads.size(); ++k) heads[k] = read_heads(readers[k], bodies);
  for (std::size_t k = 0; k < readers.size(); ++k) {
    for (const GivenHead& head : heads[k])
      read_group<D>(readers[k], head, *bodies[static_cast<std::size_t>(head.body)].given);
    mail.in[k] = {};
  }
  return owners;
}

template std::optional<Owners<2>> give_to_owners<2>(TileGrid<2>&, std::vector<Body<2>>&);
template std::optional<Owners<3>> give_to_owners<3>(TileGrid<3>&, std::vector<Body<3>>&);

}  // namespace mpm
