#pragma once
// What is noted of a run that goes on but may be going wrong.
#include <cstdint>
#include <vector>

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
  unsettled
};
inline constexpr std::array note_names = {"time step",     "energy of a step", "load",
                                          "outside walls", "volume",           "left box",
                                          "crowded node",  "unsettled"};

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

/// Particles of a group that something is true of, and the one of which it is most so.
struct Seen {
  std::size_t count = 0, body = 0, row = 0;
  double most = 0.0, value = 0.0;
  void add(std::size_t b, std::size_t at, double size, double shown) {
    if (count++ == 0 || size > most) {
      most = size;
      body = b;
      row = at;
      value = shown;
    }
  }
};

/// What a look at the particles of a group has found.
template <int D>
struct Sight {
  std::size_t particles = 0;
  Seen outside, odd, left[2 * D];
};

template <int D>
struct Watch {
  StepWatch steps;
  std::int64_t looked = -1;  // step of the last look
  std::vector<Note> notes;
  std::vector<Sight<D>> sights;  // scratch, one per body
};

}  // namespace mpm
