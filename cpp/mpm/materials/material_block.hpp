#pragma once
// A block of particles on its way through its material: gradients in, strength, equation of state,
// failure, stress out. Each is one indirect call per block; what passes between them stays in the
// block, in the first cache.
#include "mpm/fields/columns.hpp"
#include "mpm/fields/lanes.hpp"
#include "mpm/materials/material.hpp"

namespace mpm {

/// Up to `most` particles. A register may be stored past the last one. On a device it is one
/// particle, in the registers of a thread.
template <int D, int most = 128>
struct MaterialBlock {
  static constexpr int capacity = most;
#if defined(__CUDACC__)
  static_assert(most == 1);
  static constexpr int room = 1;
#else
  static constexpr int room = capacity + native_lanes;
#endif
  using Values = double[room];

  std::size_t count = 0;
  std::uint32_t row[room];
  Values gradient[D][D];  // velocity gradient x time step

  Values stress[Sym<double, D>::size];  // after the step [Pa]
  Values dissipated;                    // work lost to flow per present volume [J/m^3]
  Values speed;                         // of sound [m/s]; before an EOS `other_speed_squared`
  Values viscous_pressure;              // of the artificial viscosity [Pa]
  Values burnt;                         // factor of the EOS's pressure; of high explosives
  Values damping;                       // Q of damped_speed() by the strength's own viscosity
  // For an EOS: volume after the step [m^3], trace of the gradient, work with the strength's stress
  // [J] (StressWork), mean stress before the step [Pa].
  Values volume, dilation, deviatoric_work, force_work, mean_before;
  Values plastic_strain, plastic_increment, temperature;  // for failure models
};

/// Where a body keeps what its material reads and writes: first components in its columns, -1 if
/// absent.
struct MaterialColumns {
  int velocity, mass, volume, stress;
  int state = -1;               // of the strength model
  int viscosity_pressure = -1;  // of the artificial viscosity
  int force_pressure = -1;      // that nodal forces add to the stress; with averaged volumes
  int damping_stress = -1;      // of the damping in proportion to the stiffness
  int energy = -1;              // internal, per initial volume; with an EOS
  int recoverable = -1;         // energy per initial volume; where particles may fail
  int failed = -1;              // FailureAction; with failure models, or where particles may leave
  int failure_state = -1;       // of the failure models, one after another
  // Of matter that flows, with an affine transfer (step/flowing_matter.hpp): the volume beyond
  // which it does not grow [m^3]; of a gas what the transfer has taken and not yet given back as
  // heat [J].
  int growth_limit = -1, heat_owed = -1;
};

struct StressSettings {
  double time_step, time, cell_size;  // time: at the end of the step
  BulkViscosity viscosity;
  bool
      forces_follow;  // USF: this step's forces use the new stress; else they have used the old one
  // By how much each row is squeezed, if its nodes lie in the body: waves pass these the sooner.
  // Null: in space, where the time step heeds how fast particles pass them.
  const Storage* squeezed = nullptr;
};

/// What the ledger and the time step need from a block; energies in J.
struct StressSums {
  double internal = 0.0;      // recoverable work of the stress, mean of old and new
  double plastic = 0.0;       // dissipated by plastic or viscous flow
  double viscous = 0.0;       // work of the artificial viscosity
  double damped = 0.0;        // work of the damping in proportion to the stiffness
  double bounded = 0.0;       // taken by the bounds of an equation of state; negative: given
  double energy_floor = 0.0;  // the part that the least energy has, never positive
  double force_power = 0.0;   // work over this strain of the stress that the nodal forces use
  double fracture = 0.0;      // the part of internal that particles stored which bear nothing now
  double averaging = 0.0;     // the part that averaging volumes has made, beyond the forces' own
  double fastest = 0.0;       // largest c + |v| [m/s]
  bool negative_volume = false;
  bool eroded = false;  // some particle is to be eroded
};

/// Take the particles of a block through a material: stress, state and volume after the step, and
/// the sums. `Lanes` is Batch<W>, or double, which tests take as the oracle.
template <class Lanes, int D>
void update_block(const Material& material, Columns& columns, const MaterialColumns& at,
                  MaterialBlock<D>& block, const StressSettings& settings, StressSums& sums);

/// Declare the columns that a material needs; fills in where they are.
template <int D>
void add_material_columns(const Material& material, Columns& columns, MaterialColumns& at);
/// Give them the values of a body at rest at the start.
template <int D>
void start_material_columns(const Material& material, Columns& columns, const MaterialColumns& at);

/// Speed of sound [m/s] of one particle.
template <int D>
double sound_speed(const Material& material, const Columns& columns, const MaterialColumns& at,
                   std::size_t row, double cell_size);
/// The same of a body at rest at the start, without what viscosities add for the time step.
double sound_speed_at_start(const Material& material);

}  // namespace mpm
