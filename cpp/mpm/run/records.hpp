#pragma once
// What a simulation tells of itself, the same in 2D and 3D.
#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace mpm {

/// A particle that is told of.
struct ParticleAt {
  int body = -1;               // -1: none
  std::int64_t particle = -1;  // in the order in which the user gave them
  std::array<double, 3> position{};
};

/// Why a run had to stop.
struct Failure {
  std::string kind;  // "non-finite", "negative volume", "energy growth", "outside walls", "volume"
  int body = -1;
  std::int64_t particle = -1;  // in the order in which the user gave them
  std::int64_t step = 0;
  double time = 0.0;
  std::array<double, 3> position{};
  std::string message;
};

/// What goes on but may be going wrong; told once for each kind and body, then counted.
struct Warning {
  std::string kind;  // of note_names (run/notes.hpp)
  int body = -1;
  std::int64_t particle = -1;
  std::int64_t step = 0;  // when and where it was first so
  double time = 0.0;
  std::array<double, 3> position{};
  double share = 0.0;      // of the particles, the largest so far; 0 where it is about one
  std::int64_t count = 0;  // steps at which it was so; of places and volumes, looks
  bool is_error = true;    // else it is only told: particles may leave through an open face
  std::string message;
};

/// The particle that limits the time step.
struct Limiter : ParticleAt {
  double sound_speed = 0.0, speed = 0.0;  // [m/s]
};

/// Particles that take no part any more: eroded, or left the region that is kept.
struct RemovedSum {
  double mass = 0.0;  // [kg]
  std::size_t count = 0;
};

/// What there was of contact, of all ranks.
struct ContactSummary {
  std::size_t overlapped = 0, overlapped_max = 0, unconverged = 0, set_back_particles = 0,
              bytes = 0, touching = 0, touching_max = 0, levelled = 0;
  int bodies_max = 0;
  double set_back_most = 0.0;  // [m]
};

/// What passes between the ranks in a step: of one rank, in the mean.
struct RanksSummary {
  int ranks = 1;
  double letters = 0.0, bytes = 0.0, exchanges = 0.0, reductions = 0.0;
  double share = 0.0;      // of the time of the steps, waiting included
  double imbalance = 1.0;  // the longest time at work over the mean one
};

/// A load on a part of a body's surface; vectors have zeros behind the dimension.
struct LoadRecord {
  std::string name;
  std::array<double, 3> force{};    // of the last step [N]
  std::array<double, 3> impulse{};  // since the start [N s]
  double area = 0.0;                // of the pieces on which it still acts [m^2]
};

/// The pieces of a surface on which a load acts, each with its particle.
struct Pieces {
  std::span<const std::uint32_t> particles;  // in the order in which the user gave them
  std::span<const double> areas;             // outward area vectors [m^2], (pieces, D)
  std::span<const double> sizes;             // areas [m^2], (pieces,)
  std::span<const double> arms;              // from the particle to the piece [m], (pieces, D)
};

/// A face of the box that is not free; vectors have zeros behind the dimension.
struct FaceRecord {
  std::string name;                 // "x_min" to "z_max"
  std::array<double, 3> force{};    // of the last step, of the bodies on it [N]
  std::array<double, 3> impulse{};  // since the start, that of settling too [N s]
  double area = 0.0;                // of the face [m^2; in 2D m]
};

struct Bytes {
  std::size_t particles = 0, grid = 0, contact = 0, other = 0;
};

}  // namespace mpm
