#pragma once
// Takes materials and bodies in. All throw std::invalid_argument, in one sentence, for what makes
// no sense, and std::out_of_range for a body or material that there is not.
#include <array>
#include <span>
#include <string>

#include "mpm/run/simulation.hpp"

namespace mpm {

/// Returns its number. `in_body`: of bodies on nodes of their own (step/kept_nodes.hpp).
template <int D>
int add_material(Simulation<D>& simulation, const MaterialChoice& choice);
/// Positions and velocities are (n, D) row by row, or one row of velocities for all; volumes n
/// values, or one for all. Returns the body's number.
template <int D>
int add_body(Simulation<D>& simulation, const std::string& name, int material,
             std::span<const double> positions, std::span<const double> velocities,
             std::span<const double> volumes);
/// Bodies of one material that form a group, as grains do: how many particles each has, and the
/// volume of one of them. Particles are given of those from the `first`-th on, one body after
/// another; of several ranks each takes those of its Share of the bodies, which must be among
/// these. Returns the number of the first.
template <int D>
int add_bodies(Simulation<D>& simulation, std::span<const std::string> names, int material,
               std::span<const std::int64_t> counts, std::span<const double> volumes,
               std::size_t first, std::span<const double> positions,
               std::span<const double> velocities);
/// A body of `count` particles of one volume, of which this rank is given some from the `first`-th
/// on, and each other one others. Returns the body's number.
template <int D>
int add_slice(Simulation<D>& simulation, const std::string& name, int material, std::size_t count,
              std::size_t first, std::span<const double> positions,
              std::span<const double> velocities, double volume);
/// Values of a column of a body, its stress or a state, (n, components) row by row in the order in
/// which the user gave the particles, of all or of those that this rank was given; before
/// prepare().
template <int D>
void set_state(Simulation<D>& simulation, int body, const std::string& column,
               std::span<const double> values);
/// Let all particles keep their places at the start, for the field `displacement`; before
/// prepare().
template <int D>
void keep_start_positions(Simulation<D>& simulation);
/// Prescribe the motion of a body, which is rigid then: the velocity of a centre and the spin about
/// it (in 2D of the third axis), as functions of time; before prepare().
template <int D>
void set_motion(Simulation<D>& simulation, int body, const std::array<TimeFunction, 3>& velocity,
                const std::array<TimeFunction, 3>& spin, const std::array<double, 3>& centre);
/// Put a body into the group of an earlier one, by that one's number: they have the same frictions,
/// and group_pairs() sums over them. Every other body is a group by itself.
template <int D>
void set_group(Simulation<D>& simulation, int body, int first);
/// What holds between the bodies of two groups, each given by its first body; of one, if a == b.
template <int D>
void set_pair_law(Domain<D>& domain, int a, int b, const PairLaw& law);
/// Let the bodies of two groups touch from that distance on [m], which they are drawn into each
/// other: little by little while the run settles, see begin_settling_step().
template <int D>
void press(Simulation<D>& simulation, int a, int b, double depth);
/// Of the particles of a body, (n, D) row by row; between two steps the ledger takes the work.
template <int D>
void set_velocity(Simulation<D>& simulation, int body, std::span<const double> velocities);
/// [m/s^2], from the next step on.
template <int D>
void set_gravity(Domain<D>& domain, const std::array<TimeFunction, 3>& gravity);

}  // namespace mpm
