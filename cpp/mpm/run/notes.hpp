#pragma once
// What is noted of a run that goes on but may be going wrong.
#include <cstdint>
#include <tuple>
#include <vector>

#include "mpm/comm/all_sums.hpp"
#include "mpm/particles/pool.hpp"
#include "mpm/run/records.hpp"
#include "mpm/run/step_watch.hpp"

namespace mpm {

/// Why a note is made, by its place in `note_names`.
enum class NoteKind {
  time_step,
  energy_made,
  load_energy,
  outside,
  volume,
  left_box,
  crowd,
  unsettled,
  gas_volume,
  sparse,
  sparse_gas,
  deep,
  nodes_kept,
  failed
};
/// Why nodes are not laid anew into a body that has flowed (renew_reference.hpp).
enum class WhyNodesStay { no, parted, folded, failed };
inline constexpr std::array note_names = {
    "time step",  "energy of a step", "load",       "outside walls", "volume",
    "left box",   "crowded node",     "unsettled",  "gas volume",    "sparse particles",
    "sparse gas", "deep surface",     "nodes kept", "failed"};

/// Told once for each kind and body (the first of its group), then counted. Trivially copyable, so
/// that a checkpoint holds it.
struct Note {
  NoteKind kind;
  int body = -1, group = -1;   // group: the first body of it
  std::int64_t particle = -1;  // in the order in which the user gave them
  std::int64_t step = 0;       // when it was first so
  double time = 0.0;
  std::array<double, 3> position{};
  double value = 0.0, against = 0.0;  // what was found, and what it is judged by
  int face = -1;                      // of the box, x- x+ y- y+ z- z+, for `left_box`
  double share = 0.0;                 // of the particles, the largest so far
  std::int64_t count = 0;             // steps, or looks, at which it was so
};

template <int D>
ParticleAt particle_at(const ParticlePool<D>& pool, int body, std::uint32_t row) {
  ParticleAt at{body, pool.id[row], {}};
  for (std::size_t a = 0; a < D; ++a) at.position[a] = pool.x(static_cast<int>(a))[row];
  return at;
}

/// Particles of a group that something is true of, and the one of which it is most so; of several
/// the first.
struct Seen {
  std::int64_t count = 0;
  double most = 0.0, value = 0.0;
  ParticleAt at;
  template <int D>
  void add(const ParticlePool<D>& pool, int body, std::uint32_t row, double size, double shown) {
    const std::int64_t particle = pool.id[row];
    if (count++ > 0 && std::tuple(-size, body, particle) >= std::tuple(-most, at.body, at.particle))
      return;
    most = size;
    value = shown;
    at = particle_at(pool, body, row);
  }
  /// Of all ranks.
  void add_others(Comm& comm) {
    const std::int64_t all = all_sum(comm, count);
    if (comm.alone() || all == 0) return;
    const double own = count > 0 ? most : -std::numeric_limits<double>::infinity();
    const int rank =
        rank_of_largest(comm, {own, -1.0 * at.body, -static_cast<double>(at.particle)});
    broadcast(comm, rank, *this);
    count = all;
  }
};

/// What a look at the particles of a group has found.
template <int D>
struct Sight {
  std::int64_t particles = 0;
  Seen outside, odd, swollen, thin, left[2 * D];  // swollen, thin: of gases
  // Of bodies that keep together: cells that hold some, and those beside one or two empty cells
  // behind which there are some again.
  std::int64_t cells = 0;
  Seen gaps;

  double gap_share() const {
    return cells > 0 ? static_cast<double>(gaps.count) / static_cast<double>(cells) : 0.0;
  }
};

template <int D>
struct Watch {
  StepWatch steps;
  std::int64_t looked = -1;  // step of the last look
  std::vector<Note> notes;
  std::vector<Sight<D>> sights;       // scratch, one per body
  std::vector<double> gaps_at_start;  // gap_share() of each, as it is given
};

}  // namespace mpm
