#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "mpm/contact/candidates.hpp"
#include "mpm/ledger/history.hpp"
#include "mpm/particles/make_body.hpp"
#include "mpm/run/simulation_of.hpp"

namespace mpm {
namespace {

void check(bool condition, const char* sentence) {
  if (!condition) throw std::invalid_argument(sentence);
}

void check(const Settings& s) {
  check_settings(s.grid);
  if (s.grid.coarsening) check_settings(*s.grid.coarsening);
  check_settings(s.run);
  check_settings(s.contact);
  check_settings(s.execution);
  for (std::size_t a = 0; a < 3; ++a) {
    check(std::isfinite(s.grid.origin[a]), "origin must be finite");
    const std::string problem = s.run.gravity[a].problem();
    if (!problem.empty()) throw std::invalid_argument("gravity " + problem);
  }
}

}  // namespace

std::unique_ptr<Simulation> make_simulation(const Settings& settings) {
  check(settings);
  if (settings.grid.dimension == 2) return std::make_unique<SimulationOf<2>>(settings);
  return std::make_unique<SimulationOf<3>>(settings);
}

template <int D>
SimulationOf<D>::SimulationOf(const Settings& settings)
    : settings_(settings), stages_(stages_of<D>(settings.run.scheme, settings.execution.fused)) {
  const GridSettings& given = settings.grid;
  TileGrid<D>& grid = domain_.grid;
  grid.cell_size = given.cell_size;
  grid.basis = given.basis;
  grid.bonded = settings.contact.bonded;
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
  }
  grid.has_dashpots = grid.walls.absorb();
  domain_.gravity_of_time = settings.run.gravity;
  domain_.pic_damping = settings.run.pic_damping;
  domain_.disorder = settings.execution.disorder;
  domain_.contact_settings = settings.contact;
  domain_.threads.resize(settings.execution.threads);
  for (std::size_t k = 0; k < stages_.size(); ++k) timers_.name(k, stages_[k].name);
  history_.reserve((history_capacity + 1) * history_terms.size());
}

template <int D>
void SimulationOf<D>::prepare() {
  check(!prepared_, "prepare() has been called already");
  check(!domain_.bodies.empty(), "there is no body");
  fill_pools(domain_.pools, domain_.materials, domain_.bodies, domain_.grid.patches);
  place_pieces();
  build_cell_lists(domain_.grid, domain_.bodies, domain_.pools, domain_.threads,
                   domain_.list_scratch);
  if (domain_.has_contact()) connect_tiles(domain_.contact, domain_.grid, domain_.bodies);
  domain_.sums.resize(domain_.grid.patches.size());
  const auto& bodies = domain_.bodies;
  const auto is_rigid = [](const Body<D>& b) { return !b.deforms(); };
  check(!std::all_of(bodies.begin(), bodies.end(), is_rigid),
        "all bodies are rigid, so no wave limits the time step: one must deform");
  check(!settings_.contact.bonded || std::none_of(bodies.begin(), bodies.end(), is_rigid),
        "bodies are bonded, so none can be rigid");
  list_kinds(domain_);
  start_motions();
  project_rigid_velocities(domain_);
  probe_speeds();
  const double fastest = settings_.run.cfl * settings_.grid.cell_size / next_time_step_;
  domain_.contact.records.set_scale(total_mass(), fastest);
  domain_.ledger.kinetic = kinetic_energy();
  domain_.ledger.internal = initial_internal_energy();
  domain_.ledger.start = domain_.ledger.kinetic + domain_.ledger.internal;
  domain_.ledger.momentum = momentum();
  for (const Patch<D>& patch : domain_.grid.patches)
    if (body(patch.body).is_prescribed())
      domain_.ledger.add_prescribed(domain_.pool_of(patch), patch);
  sights_.resize(bodies.size());
  notes_.reserve(2 * note_names.size());
  domain_.time_step = 0.0;
  write_history_row();  // the state at the start
  prepared_ = true;
}

template <int D>
std::int64_t SimulationOf<D>::advance(std::int64_t max_steps, double end_time,
                                      const std::atomic<bool>* stop) {
  check(prepared_, "call prepare() before advance()");
  check(std::isfinite(end_time), "end_time must be a finite number");
  std::int64_t made = 0;
  while (made < max_steps && domain_.time < end_time && !failure_) {
    const double left = end_time - domain_.time;
    const bool last = next_time_step_ >= left;
    // Two last steps of equal length rather than a tiny one, in which forces would be rounding.
    domain_.time_step = last ? left : std::min(next_time_step_, 0.5 * left);
    make_step(last ? end_time : domain_.time + domain_.time_step);
    ++made;
    if (stop != nullptr && stop->load(std::memory_order_relaxed)) break;
  }
  if (made > 0 && domain_.time >= end_time && looked_ != domain_.step && !failure_) look();
  return made;
}

template <int D>
void SimulationOf<D>::make_step(double time_after) {
  for (std::size_t a = 0; a < D; ++a)
    domain_.gravity[static_cast<int>(a)] =
        domain_.gravity_of_time[a].mean(domain_.time, time_after);
  for (const std::size_t b : domain_.prescribed)
    domain_.bodies[b].motion->begin_step(domain_.time, time_after);
  domain_.time_after = time_after;
  for (std::size_t k = 0; k < stages_.size(); ++k)
    timers_.time(k, [&] { stages_[k].run(domain_); });
  domain_.time = time_after;
  ++domain_.step;
  write_history_row();
  find_failure();
  if (failure_) return;
  choose_time_step();
  watch_step();
  if (domain_.step % look_every == 0) look();
  if (must_coarsen()) coarsen_cells();
}

template <int D>
void SimulationOf<D>::choose_time_step() {
  // Where neither waves nor particles are fast, nothing falls further than about a cell.
  double fastest = std::sqrt(norm(domain_.gravity) * settings_.grid.cell_size);
  for (const PatchSums<D>& s : domain_.sums) fastest = std::max(fastest, s.stress.fastest);
  const double way = settings_.run.cfl * settings_.grid.cell_size;
  next_time_step_ = way / fastest;
  // Prescribed motions may have jumps.
  for (const std::size_t b : domain_.prescribed) {
    const PrescribedMotion& motion = *domain_.bodies[b].motion;
    if (!motion.moves) continue;
    const double speed = motion.speed(domain_.time, domain_.time + next_time_step_);
    next_time_step_ = std::min(next_time_step_, way / speed);
  }
}

template <int D>
void SimulationOf<D>::write_history_row() {
  // Room for the row of the start and history_capacity steps; a caller who never takes them loses
  // the oldest.
  if (history_.size() > history_capacity * history_terms.size()) history_.clear();
  const StepState state{domain_.ledger,    domain_.step,           domain_.time,
                        domain_.time_step, domain_.grid.cell_size, domain_.grid.patches.size()};
  for (const HistoryTerm& term : history_terms) history_.push_back(term.value(state));
}

template <int D>
std::vector<double> SimulationOf<D>::take_history() {
  std::vector<double> rows = history_;
  history_.clear();
  return rows;
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
