#include "mpm/run/prepare.hpp"

#include <algorithm>
#include <stdexcept>

#include "mpm/contact/candidates.hpp"
#include "mpm/particles/give_to_owners.hpp"
#include "mpm/particles/make_body.hpp"
#include "mpm/run/held_bodies.hpp"
#include "mpm/run/loads.hpp"
#include "mpm/run/measures.hpp"
#include "mpm/run/part_sums.hpp"
#include "mpm/run/settle.hpp"
#include "mpm/run/start_affine.hpp"
#include "mpm/run/start_contact.hpp"
#include "mpm/run/start_in_body.hpp"
#include "mpm/run/surfaces.hpp"
#include "mpm/run/time_step.hpp"
#include "mpm/run/watch.hpp"
#include "mpm/surfaces/pressing.hpp"

namespace mpm {
namespace {

void check_setting(bool condition, const char* sentence) {
  if (!condition) throw std::invalid_argument(sentence);
}

template <int D>
void check_bodies(const Domain<D>& domain) {
  const auto is_rigid = [](const Body<D>& b) { return !b.deforms(); };
  check_setting(!std::ranges::all_of(domain.bodies, is_rigid),
                "all bodies are rigid, so no wave limits the time step: one must deform");
  check_setting(!domain.grid.bonded || std::ranges::none_of(domain.bodies, is_rigid),
                "bodies are bonded, so none can be rigid");
  const auto damped_otherwise = [&](const Body<D>& b) {
    return b.damping != domain.bodies[0].damping;
  };
  check_setting(!domain.grid.bonded || std::ranges::none_of(domain.bodies, damped_otherwise),
                "bodies are bonded and move as one, so all must have the same damping");
}

template <int D>
void start_ledger(Domain<D>& domain) {
  Ledger& ledger = domain.ledger;
  ledger.kinetic = kinetic_energy(domain);
  ledger.internal = initial_internal_energy(domain);
  ledger.kept_ahead = -kinetic_excess(domain.kept_spins);
  ledger.start = ledger.kinetic + ledger.internal;
  ledger.momentum = momentum(domain);
  const AngularTotals angular = angular_totals(part_sums(domain));
  ledger.angular.start = angular.all;
  ledger.angular.prescribed_start = angular.prescribed;
  for (const Patch<D>& patch : domain.grid.patches) {
    ParticlePool<D>& pool = domain.pool_of(patch);
    const Body<D>& body = domain.body_of(patch);
    PartEnergies& part =
        domain.part_energies[domain.group_of[static_cast<std::size_t>(patch.body)]];
    for (const std::uint32_t row : pool.rows(patch)) {
      const double energy = energy_at_start(pool, body, row);
      part.add({energy, 0.0, 0.0});
      if (pool.at.recoverable >= 0 && energy != 0.0)  // what it takes along if it is removed
        pool.columns.component(pool.at.recoverable)[row] =
            energy * body.initial_density / pool.mass()[row];
    }
  }
  ledger.start_prescribed(domain.bodies, domain.grid.patches, domain.pools,
                          *domain.grid.partition.comm);
}

/// Walls that hold some bodies on nodes of their own push back others, which do not lie on them.
template <int D>
void find_walls_of_bodies(Domain<D>& domain) {
  TileGrid<D>& grid = domain.grid;
  if (!grid.walls.exist) return;
  const auto is_held = [&](const Body<D>& body) {
    return !body.keeps_nodes() || grid.walls.all_hold(body.held_by);
  };
  if (std::ranges::all_of(domain.bodies, is_held)) return;
  for (const Body<D>& body : domain.bodies)
    grid.walls_of_bodies.push_back(is_held(body) ? grid.walls
                                                 : grid.walls.as_held_by(body.held_by));
}

}  // namespace

template <int D>
void prepare(Simulation<D>& simulation) {
  Domain<D>& domain = simulation.domain;
  require(simulation, Phase::building, "prepare() has been called already");
  check_setting(!domain.bodies.empty(), "there is no body");
  check_bodies(domain);
  simulation.phase = Phase::broken;  // until all is done
  // A body alone may touch itself.
  domain.surfaces.meet = domain.contact_settings.enabled && !domain.contact_settings.bonded &&
                         !domain.surfaces.given.empty();
  domain.surfaces.pressed_by =
      static_cast<int>(std::ranges::count(domain.bodies, BodyKind::deformable, &Body<D>::kind));
  domain.contact.leaves_surfaces = domain.surfaces.meet;
  domain.grid.partition.shares_tiles = domain.has_contact();
  add_contact_columns(domain);
  find_held_bodies(simulation);
  check_in_body(simulation);
  find_walls_of_bodies(domain);
  place_anchor(domain.grid, domain.bodies);
  std::optional<Owners<D>> owners = give_to_owners(domain.grid, domain.bodies);
  fill_pools(domain.pools, domain.materials, domain.bodies, domain.grid.patches);
  place_pieces(domain);
  build_cell_lists(domain.grid, domain.bodies, domain.pools, domain.threads, domain.list_scratch,
                   std::move(owners));
  if (domain.has_contact())
    connect_tiles(domain.contact, domain.grid, domain.bodies, domain.contact_settings.response);
  domain.sums.resize(domain.grid.patches.size());
  if (domain.grid.walls.exist) domain.face_parts.resize(domain.grid.patches.size());
  list_kinds(domain);
  choose_stages(simulation);
  start_settling(simulation);
  set_prescribed_velocities(domain);
  project_rigid_velocities(domain);
  start_affine(domain);
  start_in_body(domain);
  start_contact(domain);
  start_surfaces(domain);
  probe_speeds(domain);
  const std::string problem = choose_time_step(simulation);
  check_setting(problem.empty(), problem.c_str());
  // The fastest speed of all, whatever steps are made.
  const double cfl = simulation.settings.run.cfl;
  const double fastest = cfl * domain.grid.cell_size / stable_time_step(domain, cfl);
  domain.contact.records.set_scale(total_mass(domain), fastest);
  hold_bodies(simulation);
  start_ledger(domain);
  look_at_start(simulation);
  simulation.watch.notes.reserve(2 * note_names.size());
  domain.time_step = 0.0;
  simulation.history.add(step_state(domain));  // the state at the start
  simulation.phase = Phase::ready;
}

template void prepare<2>(Simulation<2>&);
template void prepare<3>(Simulation<3>&);

}  // namespace mpm
