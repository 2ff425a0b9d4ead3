#pragma once
// A stage of a step: its name, what it does, and what it reads and writes.
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "mpm/domain.hpp"

namespace mpm {

/// What stages work on, a bit each. Of particles of bodies that deform the columns; of rigid bodies
/// all particles' columns are two. Of the nodes the halves of their records.
struct Data {
  enum Bits : std::uint64_t {
    position = 1ull << 0,
    velocity = 1ull << 1,
    mass = 1ull << 2,
    volume = 1ull << 3,
    stress = 1ull << 4,          // and all state of the material
    rigid_position = 1ull << 5,  // of the particles and of the centre
    rigid_velocity = 1ull << 6,
    lists = 1ull << 7,  // of particles by cell; the patches and their blocks
    load_pieces = 1ull << 8,
    node_mass = 1ull << 9,
    node_momentum = 1ull << 10,
    node_velocity = 1ull << 11,
    ghost_weights = 1ull << 12,
    node_force = 1ull << 13,
    node_increments = 1ull << 14,
    node_remapped = 1ull << 15,
    node_dashpots = 1ull << 16,
    contacts = 1ull << 17,
    patch_sums = 1ull << 18,
    records = 1ull << 19,
    energies = 1ull << 20,
    left_cells = 1ull << 21,  // whether particles have left the cells of their lists
    body_force = 1ull << 22,  // of particles, and their places at the start
    unseen = 1ull << 23,      // what is filtered out of their velocities
    // Of the patches' sums the angular impulses: of forces; of walls on mapped velocities.
    impulses = 1ull << 24,
    mapped_impulses = 1ull << 25,
    force_pressure = 1ull << 26,  // of particles with averaged volumes, for one mapping of forces
    node_springs = 1ull << 27,    // of walls that touch, then what they push with
    affine = 1ull << 28,          // affine part of particles' velocities
    carried_sums = 1ull << 29,    // of the patches' sums what these lose as they are carried along
    node_volumes = 1ull << 30,    // of matter that flows
    // Of matter that flows limits of volumes; of a gas also its energies and the heat it is owed.
    flowing = 1ull << 31,
    kept_nodes = 1ull << 32,   // what nodes that lie in bodies keep: their motion
    deformation = 1ull << 33,  // of the particles of these bodies
    surfaces = 1ull << 34,     // contact points, and what acts on them
    kept_spins = 1ull << 35,   // how these bodies turn
  };
};
/// Their names, in the order of the bits.
inline constexpr auto data_names = std::to_array<std::string_view>(
    {"position",        "velocity",       "mass",          "volume",          "stress",
     "rigid position",  "rigid velocity", "lists",         "load pieces",     "node mass",
     "node momentum",   "node velocity",  "ghost weights", "node force",      "node increments",
     "node remapped",   "node dashpots",  "contacts",      "patch sums",      "records",
     "energies",        "left cells",     "body force",    "unseen velocity", "impulses",
     "mapped impulses", "force pressure", "node springs",  "affine part",     "carried sums",
     "node volumes",    "flowing",        "kept nodes",    "deformation",     "surfaces",
     "kept spins"});

/// The data and what shares its place (layout/node_records.hpp): who writes one takes the others.
constexpr std::uint64_t places_of(std::uint64_t data) {
  // First halves of records beside the mass; second halves.
  constexpr std::uint64_t shared[] = {
      Data::node_momentum | Data::node_velocity,
      Data::ghost_weights | Data::node_force | Data::node_increments | Data::node_remapped};
  for (const std::uint64_t one : shared)
    if (data & one) data |= one;
  return data;
}

template <int D>
struct Stage {
  std::string_view name;
  void (*run)(Domain<D>&) = nullptr;
  std::uint64_t reads = 0, writes = 0;  // of Data
  bool all_particles = false;           // it goes through all of them, and not only some
  bool by_patch = false;                // what it does for a patch needs no other
  void (*start)(Domain<D>&) = nullptr;  // of an exchange: may come as soon as the edge is done
};

/// May two stages change places, to the same bits?
template <int D>
constexpr bool independent(const Stage<D>& a, const Stage<D>& b) {
  // Neither writes what the other reads or writes; by places, as writing a field ends those that
  // share its place.
  const std::uint64_t taken_by_a = places_of(a.writes), taken_by_b = places_of(b.writes);
  return !(taken_by_a & b.reads) && !(a.reads & taken_by_b) && !(taken_by_a & b.writes);
}

inline constexpr std::size_t most_stages = 48;  // of a list

template <int D>
struct StageList {
  std::array<Stage<D>, most_stages> stages{};
  std::size_t count = 0;

  constexpr StageList() = default;
  template <std::size_t n>
  constexpr StageList(const std::array<Stage<D>, n>& list) {
    for (const Stage<D>& stage : list) add(stage);
  }
  constexpr void add(const Stage<D>& stage) { stages[count++] = stage; }
  constexpr std::size_t find(const Stage<D>& stage) const {
    std::size_t k = 0;
    // By name and reads, which no two rows of a list share (test_fuse). Comparing `run` is no
    // constant expression under -fsanitize=undefined of g++ 12 (its bug 71962).
    while (k < count && !(stages[k].name == stage.name && stages[k].reads == stage.reads)) ++k;
    return k;
  }
};

/// The list without a stage.
template <int D>
constexpr StageList<D> without(const StageList<D>& list, const Stage<D>& stage) {
  StageList<D> rest;
  const std::size_t left_out = list.find(stage);
  for (std::size_t k = 0; k < list.count; ++k)
    if (k != left_out) rest.add(list.stages[k]);
  return rest;
}

/// Two stages that can be done at once, by one that is faster.
template <int D>
struct Fusion {
  Stage<D> first, second;
  std::string_view name;
  void (*run)(Domain<D>&);
  void (*start)(Domain<D>&) = nullptr;
};

/// The list with two stages fused. The second comes forward to the first, and with it, ahead of the
/// first, what it needs of the stages between. A list in which it must not, because what it needs
/// needs the first, is no constant expression: it does not compile.
template <int D>
constexpr StageList<D> fuse(const StageList<D>& list, const Fusion<D>& fusion) {
  const std::size_t i = list.find(fusion.first), j = list.find(fusion.second);
  if (!(i < j && j < list.count))
    throw std::logic_error("the two stages are not in this order in the list");
  std::array<bool, most_stages> ahead{};
  ahead[j] = true;
  // Backwards: what a stage that goes ahead needs has to go ahead as well. Those that do keep their
  // order among each other, and so do those that do not.
  for (std::size_t k = j; k-- > i + 1;)
    for (std::size_t m = k + 1; m <= j; ++m)
      ahead[k] = ahead[k] || (ahead[m] && !independent(list.stages[k], list.stages[m]));
  StageList<D> fused;
  for (std::size_t k = 0; k < i; ++k) fused.add(list.stages[k]);
  for (std::size_t k = i + 1; k < j; ++k)
    if (ahead[k]) {
      // It would have to come before the first and after it.
      if (!independent(list.stages[k], list.stages[i]))
        throw std::logic_error("a stage between needs the first");
      fused.add(list.stages[k]);
    }
  fused.add({fusion.name, fusion.run, fusion.first.reads | fusion.second.reads,
             fusion.first.writes | fusion.second.writes,
             fusion.first.all_particles || fusion.second.all_particles,
             fusion.first.by_patch && fusion.second.by_patch, fusion.start});
  for (std::size_t k = i + 1; k < j; ++k)
    if (!ahead[k]) fused.add(list.stages[k]);
  for (std::size_t k = j + 1; k < list.count; ++k) fused.add(list.stages[k]);
  return fused;
}
template <int D, class... More>
constexpr StageList<D> fuse(const StageList<D>& list, const Fusion<D>& fusion,
                            const More&... more) {
  return fuse(fuse(list, fusion), more...);
}

}  // namespace mpm
