#pragma once
// The columns of `history.csv`, a row each: files, pictures, summaries and the reference page take
// them from here.
#include "mpm/ledger/ledger.hpp"

namespace mpm {

/// What a row of the history tells of.
struct StepState {
  const Ledger& ledger;
  std::int64_t step;
  double time, time_step, cell_size;
  std::size_t tiles;
  std::int64_t renewals;
};

/// How a column enters the balance of the ledger.
enum class Role {
  other,
  energy,    // a share of the energy
  error,     // one that the method has lost
  supply,    // brought in from outside
  residual,  // what these leave unexplained
};
template <>
inline constexpr auto words<Role> =
    std::to_array<Word<Role>>({{"other", Role::other, "no term of the balance"},
                               {"energy", Role::energy, "a share of the energy"},
                               {"error", Role::error, "energy that the method has lost"},
                               {"supply", Role::supply, "brought in from outside"},
                               {"residual", Role::residual, "what these leave unexplained"}});

struct HistoryTerm {
  std::string_view name, unit, meaning;
  double (*value)(const StepState&);
  Role role = Role::other;
  std::string_view part_of = {};  // the column that it is a part of
};

inline constexpr auto history_terms = std::to_array<HistoryTerm>({
    {"step", "1", "steps made", [](const StepState& s) { return static_cast<double>(s.step); }},
    {"time", "s", "reached after the step", [](const StepState& s) { return s.time; }},
    {"dt", "s", "the step's length; 0 at the start",
     [](const StepState& s) { return s.time_step; }},
    {"kinetic", "J", "kinetic energy", [](const StepState& s) { return s.ledger.kinetic; },
     Role::energy},
    {"internal", "J", "energy in the material but for what `plastic` and `viscous` hold",
     [](const StepState& s) { return s.ledger.internal; }, Role::energy},
    {"plastic", "J", "work of plastic and viscous flow so far",
     [](const StepState& s) { return s.ledger.plastic; }, Role::energy},
    {"viscous", "J", "work of artificial viscosity so far",
     [](const StepState& s) { return s.ledger.viscous; }, Role::energy},
    {"friction", "J", "work of friction so far",
     [](const StepState& s) { return s.ledger.friction; }, Role::energy},
    {"restitution", "J", "energy that `contact.restitution` and that of pairs have taken",
     [](const StepState& s) { return s.ledger.restitution; }, Role::energy},
    {"contact", "J", "energy that normal contact has lost, negative: made; an error",
     [](const StepState& s) { return s.ledger.contact; }, Role::error},
    {"springs", "J", "energy that springs of contact hold and give back",
     [](const StepState& s) { return s.ledger.springs; }, Role::energy},
    {"external", "J", "work so far of gravity, loads and prescribed motions",
     [](const StepState& s) { return s.ledger.external; }, Role::supply},
    {"absorbed", "J", "energy that absorbing walls have taken up",
     [](const StepState& s) { return s.ledger.absorbed; }, Role::energy},
    {"damped", "J", "energy that damping of materials and of bodies' motion has taken",
     [](const StepState& s) { return s.ledger.damped; }, Role::energy},
    {"eroded", "J", "kinetic and recoverable energy that eroded particles took with them",
     [](const StepState& s) { return s.ledger.eroded; }, Role::energy},
    {"fracture", "J",
     "energy that particles had stored which failed and bear nothing now; of materials with an "
     "equation of state it stays in `internal`",
     [](const StepState& s) { return s.ledger.fracture; }, Role::energy},
    {"left", "J", "kinetic and recoverable energy of particles that left `grid.outflow_box`",
     [](const StepState& s) { return s.ledger.left; }, Role::energy},
    {"bounded", "J", "energy that the bounds of equations of state have taken, negative: given",
     [](const StepState& s) { return s.ledger.bounded; }, Role::energy},
    {"numerical", "J", "energy that the method has lost, negative: made; an error",
     [](const StepState& s) { return s.ledger.numerical(); }, Role::error},
    {"residual", "J", "what the terms above leave unexplained: rounding",
     [](const StepState& s) { return s.ledger.residual(); }, Role::residual},
    {"momentum_x", "N s", "momentum of the particles that take part",
     [](const StepState& s) { return s.ledger.momentum[0]; }},
    {"momentum_y", "N s", "likewise", [](const StepState& s) { return s.ledger.momentum[1]; }},
    {"momentum_z", "N s", "likewise; 0 in 2D",
     [](const StepState& s) { return s.ledger.momentum[2]; }},
    {"numerical_mapping", "J", "the part of `numerical` that mapping to nodes and back has",
     [](const StepState& s) { return s.ledger.mapping; }, Role::other, "numerical"},
    {"numerical_time", "J", "its other part, of the integration in time",
     [](const StepState& s) { return s.ledger.time_integration; }, Role::other, "numerical"},
    {"numerical_transfer", "J",
     "its part that transfers other than FLIP have taken, or nodes that were laid anew: what they "
     "smooth away",
     [](const StepState& s) { return s.ledger.transferred; }, Role::other, "numerical"},
    {"load_work", "J", "the part of `external` that loads on surfaces and body forces have done",
     [](const StepState& s) { return s.ledger.load_work; }, Role::other, "external"},
    {"damped_stiffness", "J", "the part of `damped` that damping of materials has taken",
     [](const StepState& s) { return s.ledger.damped_stiffness; }, Role::other, "damped"},
    {"unbalanced", "1",
     "forces out of balance over those applied, while the run settles (`run.settle`); then 0",
     [](const StepState& s) { return s.ledger.unbalanced; }},
    {"cell_size", "m", "edge of the cells; it grows where `grid.coarsening` is given",
     [](const StepState& s) { return s.cell_size; }},
    {"tiles", "1",
     "tiles of 4 x 4 x 4 cells (8 x 8 in 2D) that hold particles, those of each body counted",
     [](const StepState& s) { return static_cast<double>(s.tiles); }},
    {"renewals", "1",
     "how often nodes have been laid anew into bodies on nodes of their own that flow",
     [](const StepState& s) { return static_cast<double>(s.renewals); }},
    {"motion_work", "J", "the part of `external` that prescribed motions have done",
     [](const StepState& s) { return s.ledger.motion_work; }, Role::other, "external"},
    {"motion_impulse_x", "N s", "impulse that prescribed motions have given",
     [](const StepState& s) { return s.ledger.motion_impulse[0]; }},
    {"motion_impulse_y", "N s", "likewise",
     [](const StepState& s) { return s.ledger.motion_impulse[1]; }},
    {"motion_impulse_z", "N s", "likewise; 0 in 2D",
     [](const StepState& s) { return s.ledger.motion_impulse[2]; }},
    {"kinetic_prescribed", "J", "the part of `kinetic` of bodies with prescribed motion",
     [](const StepState& s) { return s.ledger.prescribed_kinetic; }, Role::other, "kinetic"},
    {"energy_floor", "J", "the part of `bounded` that energies below absolute zero were given",
     [](const StepState& s) { return s.ledger.energy_floor; }, Role::other, "bounded"},
    {"numerical_averaging", "J",
     "the part of `numerical_mapping` that `volume_averaging` has; of the second order in a step",
     [](const StepState& s) { return s.ledger.averaging; }, Role::other, "numerical_mapping"},
});

}  // namespace mpm
