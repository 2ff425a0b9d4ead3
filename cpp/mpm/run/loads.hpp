#pragma once
// Takes loads on surfaces, body forces and damping in, and tells what loads have done.
#include <array>
#include <string>
#include <vector>

#include "mpm/run/simulation.hpp"

namespace mpm {

/// Load a part of the surface of a body that deforms with a kind of LoadKinds; its value is a
/// function of time [Pa], a number the first of the three; before prepare(). Throws
/// std::invalid_argument, in one sentence, for what makes no sense.
template <int D>
void add_load(Simulation<D>& simulation, const std::string& name, int body, const std::string& kind,
              const std::array<TimeFunction, 3>& value, const Pieces& pieces);

/// Give bodies a force per mass [m/s^2], a formula along each axis, or none where the program gives
/// it; before prepare(). Throws std::invalid_argument, in one sentence, for what makes no sense.
template <int D>
void add_body_force(Simulation<D>& simulation, const std::vector<int>& bodies,
                    const std::vector<Expression::Program>& value);

/// The force per mass of each particle of a body [m/s^2], (n, D) in the user's order, from now on;
/// zeros until then. Throws likewise.
template <int D>
void set_body_force(Simulation<D>& simulation, int body, std::span<const double> values);

/// Damp the motion of bodies that have no damping yet: in proportion to their mass, by a rate
/// [1/s], and to the force that is out of balance; before prepare(). Throws likewise.
template <int D>
void add_damping(Simulation<D>& simulation, const std::vector<int>& bodies,
                 const TimeFunction& rate, const TimeFunction& local);

/// Tell the particles which pieces they carry; each body's lie in one patch yet, as they were
/// given.
template <int D>
void place_pieces(Domain<D>& domain);

template <int D>
std::vector<LoadRecord> load_records(const Domain<D>& domain);

}  // namespace mpm
