#include "mpm/run/simulation.hpp"

#include <cmath>
#include <stdexcept>

namespace mpm {
namespace {

/// Does the transfer go with the basis, and what is given for it with it?
void check_transfer(const Settings& s) {
  if (is_affine(s.run.transfer.word) && second_moment(s.grid.basis) == 0.0)
    throw std::invalid_argument(
        "run.transfer: an affine transfer needs a basis whose second moment is the same "
        "everywhere: "
        "grid.basis = \"quadratic_bspline\"");
}

/// Springs are found in every step, where particles overlap.
void check_contact(const ContactSettings& s) {
  if (!may_spring(s.response)) return;
  if (s.detection != Detections::id_of<GapDetection>())
    throw std::invalid_argument(
        "contact.detection: \"velocity\" does not go with springs, which act where particles "
        "overlap: "
        "contact.response = \"impulses\"");
  if (s.normal_refresh_distance > 0.0)
    throw std::invalid_argument(
        "contact.normal_refresh_distance: does not go with springs, which are found in every step: "
        "contact.response = \"impulses\"");
}

/// The settings, if all are in range.
const Settings& checked(const Settings& s) {
  check_settings(s.grid);
  if (s.grid.coarsening) check_settings(*s.grid.coarsening);
  check_settings(s.run);
  check_settings(s.run.transfer);
  if (s.run.settle) check_settings(*s.run.settle);
  check_settings(s.contact);
  check_contact(s.contact);
  check_transfer(s);
  check_settings(s.execution);
  for (std::size_t a = 0; a < 3; ++a) {
    if (!std::isfinite(s.grid.origin[a])) throw std::invalid_argument("origin must be finite");
    const std::string problem = s.run.gravity[a].problem();
    if (!problem.empty()) throw std::invalid_argument("gravity " + problem);
  }
  return s;
}

/// What the transfer needs beside FLIP's stages.
Extra extra_stages(const Settings& s) {
  const TransferSettings& transfer = s.run.transfer;
  if (filters(transfer.word)) return Extra::filter;
  // Do particles take velocities of nodes that eqs. (6)-(7) correct? Springs alone correct none.
  const bool takes =
      takes_grid_velocity(transfer.word) || transfer.pic_rate > 0.0 || transfer.flip_share() < 1.0;
  const bool corrects =
      s.contact.enabled && !s.contact.bonded && s.contact.response != Response::springs;
  return takes && corrects ? Extra::release : Extra::none;
}

template <int D>
void set_grid(TileGrid<D>& grid, const GridSettings& given) {
  grid.cell_size = given.cell_size;
  grid.basis = given.basis;
  grid.walls.exist = given.box_cells[0] > 0;
  grid.walls.odd_at_fixed = odd_at_fixed_walls(given.basis);
  grid.outflow_box.exist = given.outflow;
  for (std::size_t a = 0; a < D; ++a) {
    const int axis = static_cast<int>(a);
    grid.origin[axis] = given.origin[a];
    grid.outflow_box.lower[axis] = given.outflow_lower[a];
    grid.outflow_box.upper[axis] = given.outflow_upper[a];
    grid.walls.cells[a] = given.box_cells[a];
    grid.walls.face[a][0] = given.walls[2 * a];
    grid.walls.face[a][1] = given.walls[2 * a + 1];
    for (std::size_t side = 0; side < 2; ++side)
      grid.walls.friction[a][side] = given.wall_friction[2 * a + side];
  }
  grid.has_dashpots = grid.walls.absorb();
  grid.has_wall_springs = grid.walls.touch();
}

}  // namespace

template <int D>
Simulation<D>::Simulation(const Settings& given, Comm* comm) : settings(checked(given)) {
  set_grid(domain.grid, given.grid);
  if (comm != nullptr) domain.grid.partition.comm = comm;
  domain.grid.bonded = given.contact.bonded;
  domain.gravity_of_time = given.run.gravity;
  domain.transfer = given.run.transfer.word;
  domain.flip_share = given.run.transfer.flip_share();
  domain.flip_share_of_gases = given.run.transfer.flip_share_of_gases();
  domain.pic_rate = given.run.transfer.pic_rate;
  domain.filter_order = given.run.transfer.xpic;
  domain.short_wave_damping = given.run.short_wave_damping;
  domain.filter_every = given.run.transfer.every;
  domain.disorder = given.execution.disorder;
  domain.balance_every = given.execution.balance_every;
  domain.imbalance_limit = given.execution.imbalance_limit;
  domain.contact_settings = given.contact;
  domain.threads.resize(given.execution.threads);
  choose_stages(*this);
}

template <int D>
void choose_stages(Simulation<D>& simulation) {
  const Settings& s = simulation.settings;
  simulation.stages = stages_of<D>(s.run.scheme, s.execution.fused, extra_stages(s),
                                   has_kept_nodes(simulation.domain));
  for (std::size_t k = 0; k < simulation.stages.size(); ++k)
    simulation.timers.name(k, simulation.stages[k].name);
}

template void choose_stages<2>(Simulation<2>&);
template void choose_stages<3>(Simulation<3>&);
template struct Simulation<2>;
template struct Simulation<3>;

}  // namespace mpm
