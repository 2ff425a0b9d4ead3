#pragma once
// The time loop, behind an interface that does not show the dimension.
#include <array>
#include <atomic>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mpm/contact/pair_records.hpp"
#include "mpm/fields/columns.hpp"
#include "mpm/fields/state_stream.hpp"
#include "mpm/materials/material.hpp"
#include "mpm/run/settings.hpp"

namespace mpm {

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
  std::string kind;  // of note_names (run/watch.hpp)
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
struct Limiter {
  int body = -1;
  std::int64_t particle = -1;
  double sound_speed = 0.0, speed = 0.0;  // [m/s]
};

/// Particles that take no part any more: eroded, or left the region that is kept.
struct GoneSum {
  double mass = 0.0;  // [kg]
  std::size_t count = 0;
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

struct Bytes {
  std::size_t particles = 0, grid = 0, contact = 0, other = 0;
};

class Simulation {
 public:
  virtual ~Simulation() = default;

  virtual int add_material(const MaterialChoice& choice) = 0;
  /// Positions and velocities are (n, D) row by row, or one row of velocities for all; volumes n
  /// values, or one for all.
  virtual int add_body(const std::string& name, int material, std::span<const double> positions,
                       std::span<const double> velocities, std::span<const double> volumes) = 0;
  /// Values of a state column of a body, one component, in the order in which the user gave the
  /// particles; before prepare().
  virtual void set_state(int body, const std::string& column, std::span<const double> values) = 0;
  /// Prescribe the motion of a body, which is rigid then: the velocity of a centre and the spin
  /// about it (in 2D of the third axis), as functions of time; before prepare().
  virtual void set_motion(int body, const std::array<TimeFunction, 3>& velocity,
                          const std::array<TimeFunction, 3>& spin,
                          const std::array<double, 3>& centre) = 0;
  /// Load a part of the surface of a body that deforms with a kind of LoadKinds; its value is a
  /// function of time [Pa], a number the first of the three; before prepare().
  virtual void add_load(const std::string& name, int body, const std::string& kind,
                        const std::array<TimeFunction, 3>& value, const Pieces& pieces) = 0;
  /// Put a body into the group of an earlier one, by that one's number: they have the same
  /// frictions, and group_pairs() sums over them. Every other body is a group by itself.
  virtual void set_group(int body, int first) = 0;
  /// Friction between the bodies of two groups, each given by its first body; of one, if a == b.
  virtual void set_pair_friction(int a, int b, double mu) = 0;
  /// Sort the particles, make the grid, find the first time step. Once, after the last body.
  virtual void prepare() = 0;
  /// Make up to `max_steps` steps, to `end_time` at most; returns how many. Stops early at a
  /// failure, and after the step in which `stop`, if there is one, has become true.
  virtual std::int64_t advance(std::int64_t max_steps, double end_time,
                               const std::atomic<bool>* stop = nullptr) = 0;

  /// The state as it is between two steps, rows of the history that nobody took included; functions
  /// of time are the case's. Restored into a simulation of the same case that has made no step, it
  /// goes on with the same bits. Throws std::invalid_argument if the state does not fit; what has
  /// been restored half is of no use.
  virtual void save(const StateStream::Transfer& to) = 0;
  virtual void restore(const StateStream::Transfer& from, std::size_t size) = 0;

  virtual double time() const = 0;
  virtual double next_time_step() const = 0;
  virtual std::int64_t step() const = 0;
  virtual int body_count() const = 0;
  virtual std::size_t particle_count(int body) const = 0;
  virtual double total_mass() const = 0;  // of all particles, those that are gone included [kg]
  virtual GoneSum eroded() const = 0;
  virtual GoneSum left() const = 0;
  virtual std::vector<LoadRecord> loads() const = 0;
  virtual const std::optional<Failure>& failure() const = 0;
  virtual Limiter limiter() const = 0;
  virtual std::vector<Warning> warnings() const = 0;
  virtual Bytes bytes() const = 0;
  virtual const std::vector<std::pair<std::string_view, double>>& stage_seconds() const = 0;
  virtual void reset_timers() = 0;
  virtual void set_threads(int count) = 0;

  virtual const std::vector<ColumnInfo>& columns(int body) const = 0;
  /// A column in the order in which the user gave the particles, (n, components) row by row. Stress
  /// has six components in 2D too.
  virtual int column_components(int body, const std::string& name) const = 0;
  virtual void copy_column(int body, const std::string& name, std::span<double> to) const = 0;
  /// A column of all bodies, one after another, rounded to floats: component c of particle i goes
  /// to to[i * width + places[c]]. What belongs to bodies without the column, or to no component,
  /// stays as it is.
  virtual void round_column(const std::string& name, std::span<const int> places, std::size_t width,
                            std::span<float> to) const = 0;
  /// A field of `derived_fields` of all particles, rounded to floats.
  virtual void round_derived(const std::string& name, std::span<float> to) const = 0;
  virtual void set_gravity(
      const std::array<TimeFunction, 3>& gravity) = 0;  // [m/s^2], from the next step on
  virtual void set_velocity(int body, std::span<const double> velocities) = 0;

  static constexpr std::size_t history_capacity = 4096;
  /// Rows of the steps since the last call, at most history_capacity; columns as in history_terms.
  virtual std::vector<double> take_history() = 0;

  virtual const std::vector<PairRecord>& pairs() const = 0;
  /// The records of the pairs summed by groups, in the same order. What bodies of one group do to
  /// each other has no direction: its force and impulse are 0.
  virtual std::vector<PairRecord> group_pairs() const = 0;
  virtual std::size_t overlapped_nodes() const = 0;
  virtual std::size_t overlapped_nodes_max() const = 0;
  virtual int bodies_per_node_max() const = 0;
  virtual std::size_t unconverged_nodes() const = 0;
};

/// Throws std::invalid_argument, in one sentence, for a setting out of range.
std::unique_ptr<Simulation> make_simulation(const Settings& settings);

}  // namespace mpm
