#include "mpm/run/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "mpm/comm/all_sums.hpp"
#include "mpm/math/inverse.hpp"
#include "mpm/run/find_failure.hpp"
#include "mpm/run/use_device.hpp"
#include "mpm/surfaces/law.hpp"

namespace mpm {
namespace {

// At the largest `cfl`, of the reach of springs in a step. A spring begins within a step
// and is as strong as matter: at half of it hits of flat faces keep their energy to .5 %.
constexpr double most_closing = 0.5;

// Where nodes lie in bodies a step is held, as steps that follow waves, which are faster in
// what is squeezed, make energy of vibrations: by how much it may be longer than what `cfl` asks
// for before it is shortened, how much longer that must be until the step is made longer, and how
// often it is looked at, some periods of coarse bodies.
constexpr double held_up_to = 1.15, longer_from = 1.3;
constexpr std::int64_t steps_held = 100;

/// How fast a particle passes the nodes [m/s]; 0 where they move with it.
template <int D>
double speed_of(const ParticlePool<D>& pool, std::size_t row) {
  if (pool.reference >= 0) return 0.0;
  double squared = 0.0;
  for (int a = 0; a < D; ++a) squared += pool.v(a)[row] * pool.v(a)[row];
  return std::sqrt(squared);
}

/// How much faster a wave passes nodes that lie in a body, by what this is squeezed.
template <int D>
double squeezed(const ParticlePool<D>& pool, std::size_t row) {
  if (pool.reference < 0) return 1.0;
  Mat<double, D> F;
  for (int k = 0; k < D * D; ++k) F[k / D][k % D] = pool.deformation_part(k)[row];
  return std::sqrt(largest_stretch_squared(inverse_of(F)));
}

/// Of the fastest wave in a particle, by the cells that it passes [m/s]; 0 in a rigid body, which
/// limits no time step.
template <int D>
double wave_speed(const Domain<D>& domain, const Patch<D>& patch, std::size_t row) {
  if (!domain.body_of(patch).deforms()) return 0.0;
  const ParticlePool<D>& pool = domain.pool_of(patch);
  const double by = squeezed(pool, row);
  return by * sound_speed<D>(domain.material_of(patch), pool.columns, pool.at, row,
                             domain.grid.cell_size / by);
}

}  // namespace

template <int D>
void probe_speeds(Domain<D>& domain) {
  sum_by_patch(domain);
  domain.sums.resize(domain.grid.patches.size());
  for (std::size_t p = 0; p < domain.sums.size(); ++p) {
    const Patch<D>& patch = domain.grid.patches[p];
    const ParticlePool<D>& pool = domain.pool_of(patch);
    double& fastest = domain.sums[p].stress.fastest;
    fastest = 0.0;
    for (const std::uint32_t row : pool.rows(patch))
      fastest = std::max(fastest, wave_speed(domain, patch, row) + speed_of(pool, row));
  }
}

template <int D>
double stable_time_step(const Domain<D>& domain, double cfl) {
  // Where neither waves nor particles are fast, nothing falls further than about a cell.
  double fastest = std::sqrt(norm(domain.gravity) * domain.grid.cell_size);
  for (const PatchSums<D>& s : domain.sums) fastest = std::max(fastest, s.stress.fastest);
  fastest = all_max(*domain.grid.partition.comm, fastest);
  const double way = cfl * domain.grid.cell_size;
  double time_step = way / fastest;
  // Prescribed motions may have jumps.
  for (const std::size_t b : domain.prescribed) {
    const PrescribedMotion& motion = *domain.bodies[b].motion;
    if (!motion.moves) continue;
    const double speed = motion.speed(load_time(domain.time), load_time(domain.time + time_step));
    time_step = std::min(time_step, way / speed);
  }
  return time_step;
}

/// How fast each material's waves and particles are, for what takes a share in its own steps.
template <int D>
void note_fastest(Domain<D>& domain) {
  for (ParticlePool<D>& pool : domain.pools) pool.fastest = 0.0;
  double of_all = 0.0;
  for (std::size_t p = 0; p < domain.sums.size(); ++p) {
    double& fastest = domain.pool_of(domain.bodies[body_of_sums(domain, p)]).fastest;
    fastest = std::max(fastest, domain.sums[p].stress.fastest);
    of_all = std::max(of_all, fastest);
  }
  Comm& comm = *domain.grid.partition.comm;
  for (ParticlePool<D>& pool : domain.pools) pool.fastest = all_max(comm, pool.fastest);
  of_all = all_max(comm, of_all);
  // Bonded bodies share their nodes, and what walls take of them has one share.
  if (domain.grid.bonded)
    for (ParticlePool<D>& pool : domain.pools) pool.fastest = of_all;
}

/// Keep the step unless it is longer than what is stable by `up_to`, or has been much shorter for
/// long.
template <int D>
void hold_time_step(Simulation<D>& simulation, double stable, double up_to) {
  double& held = simulation.next_time_step;
  double& least = simulation.least_stable;
  const double anew = up_to / held_up_to;
  const bool looks = simulation.domain.step % steps_held == 0;
  least = least > 0.0 ? std::min(least, stable) : stable;
  if (!(held > 0.0) || held > up_to * stable)
    held = anew * stable;
  else if (looks && anew * least > longer_from * held)
    held = anew * least;
  if (looks) least = stable;
}

template <int D>
std::string choose_time_step(Simulation<D>& simulation) {
  note_fastest(simulation.domain);
  const RunSettings& run = simulation.settings.run;
  const Surfaces<D>& surfaces = simulation.domain.surfaces;
  const double most = surfaces.exist() ? most_cfl_of_springs : 1.0, cfl = std::min(run.cfl, most);
  if (run.time_step) {
    simulation.next_time_step = *run.time_step;
    const double stable = stable_time_step(simulation.domain, most);
    if (*run.time_step <= stable) return {};
    std::ostringstream text;
    text << "run.time_step = " << *run.time_step
         << " s is larger than the largest stable step, in which "
         << "the fastest wave or particle passes ";
    if (surfaces.exist()) text << most << " of ";
    text << "a cell, " << stable << " s";
    if (surfaces.exist()) text << ": contact between surfaces bears no more";
    return text.str();
  }
  double stable = stable_time_step(simulation.domain, cfl);
  // Surfaces must not pass each other's points.
  if (surfaces.closing > 0.0)
    stable = std::min(stable, cfl * most_closing * surfaces.spacing / surfaces.closing);
  if (run.largest_time_step) stable = std::min(stable, *run.largest_time_step);
  if (holds_time_step(simulation))
    hold_time_step(simulation, stable, std::min(held_up_to, most / cfl));
  else
    simulation.next_time_step = stable;
  return {};
}

template <int D>
bool holds_time_step(const Simulation<D>& simulation) {
  return !simulation.settings.run.time_step && has_kept_nodes(simulation.domain);
}

template <int D>
void update_time_step(Simulation<D>& simulation) {
  const std::string problem = choose_time_step(simulation);
  if (problem.empty()) return;
  bring_home(simulation);
  const Domain<D>& domain = simulation.domain;
  simulation.failure = failure_at(domain, "time step", find_limiter(domain), problem);
}

template <int D>
Limiter find_limiter(const Domain<D>& domain) {
  Limiter result;
  // The fastest patch of all, in their order the first.
  std::vector<double> key(2 + D, -std::numeric_limits<double>::infinity());
  std::size_t fastest = 0;
  const auto look_in = [&](const Patch<D>& patch) {
    const ParticlePool<D>& pool = domain.pool_of(patch);
    for (const std::uint32_t row : pool.rows(patch)) {
      const double c = wave_speed(domain, patch, row), v = speed_of(pool, row);
      if (c + v > result.sound_speed + result.speed || result.body < 0)
        result = {particle_at(pool, patch.body, row), c, v};
    }
  };
  if (!domain.sums_of.empty())  // a device's, which is alone
    for (const Patch<D>& patch : domain.grid.patches) look_in(patch);
  else if (domain.sums.size() == domain.grid.patches.size())
    for (std::size_t p = 0; p < domain.sums.size(); ++p)
      if (const double speed = domain.sums[p].stress.fastest; speed > key[0]) {
        key[0] = speed;
        fastest = p;
      }
  if (key[0] > -std::numeric_limits<double>::infinity()) {
    const Patch<D>& patch = domain.grid.patches[fastest];
    key[1] = -patch.body;
    for (std::size_t a = 0; a < D; ++a) key[2 + a] = -patch.tile[D - 1 - a];
    look_in(patch);
  }
  Comm& comm = *domain.grid.partition.comm;
  broadcast(comm, rank_of_largest(comm, key), result);
  return result;
}

template void probe_speeds<2>(Domain<2>&);
template void probe_speeds<3>(Domain<3>&);
template double stable_time_step<2>(const Domain<2>&, double);
template double stable_time_step<3>(const Domain<3>&, double);
template bool holds_time_step<2>(const Simulation<2>&);
template bool holds_time_step<3>(const Simulation<3>&);
template std::string choose_time_step<2>(Simulation<2>&);
template std::string choose_time_step<3>(Simulation<3>&);
template void update_time_step<2>(Simulation<2>&);
template void update_time_step<3>(Simulation<3>&);
template Limiter find_limiter<2>(const Domain<2>&);
template Limiter find_limiter<3>(const Domain<3>&);

}  // namespace mpm
