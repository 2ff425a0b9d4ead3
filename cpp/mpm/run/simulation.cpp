#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "mpm/run/simulation_of.hpp"

namespace mpm {
namespace {

void check(bool condition, const char* sentence) {
  if (!condition) throw std::invalid_argument(sentence);
}

void check(const Settings& s) {
  check(s.dimension == 2 || s.dimension == 3, "dimension must be 2 or 3");
  check(s.cell_size > 0.0 && std::isfinite(s.cell_size), "cell_size must be > 0");
  check(s.time_step_factor > 0.0 && s.time_step_factor <= 1.0,
        "time_step_factor must lie in (0, 1]");
  check(s.pic_damping >= 0.0 && std::isfinite(s.pic_damping),
        "pic_damping must be a finite number >= 0");
  check(s.disorder >= 0.0, "disorder must be >= 0");
  check(s.threads >= 1, "threads must be >= 1");
  check(s.friction >= 0.0 && std::isfinite(s.friction), "friction must be a finite number >= 0");
  // Beyond it a pair that was found well apart could meet along a normal that is not one of
  // contact.
  check(s.normal_travel >= 0.0 && s.normal_travel <= 0.25, "normal_travel must lie in [0, 0.25]");
  check(s.gap_distance >= 0.0 && std::isfinite(s.gap_distance),
        "gap_distance must be a finite number >= 0");
  for (std::size_t a = 0; a < 3; ++a) {
    check(std::isfinite(s.origin[a]), "origin must be finite");
    const std::string problem = s.gravity[a].problem();
    if (!problem.empty()) throw std::invalid_argument("gravity " + problem);
  }
  check(!(s.contact && s.bonded), "bodies are bonded or have contact, not both");
  check(s.energy_growth_limit > 0.0, "energy_growth_limit must be > 0");
  check(s.outside_limit > 0.0 && s.outside_limit <= 1.0, "outside_limit must lie in (0, 1]");
  check(s.volume_limit > 0.0 && s.volume_limit <= 1.0, "volume_limit must lie in (0, 1]");
}

}  // namespace

const std::vector<std::string>& Simulation::history_columns() {
  static const std::vector<std::string> names = {"step",
                                                 "time",
                                                 "dt",
                                                 "kinetic",
                                                 "internal",
                                                 "plastic",
                                                 "viscous",
                                                 "friction",
                                                 "contact",
                                                 "external",
                                                 "absorbed",
                                                 "eroded",
                                                 "left",
                                                 "bounded",
                                                 "numerical",
                                                 "residual",
                                                 "momentum_x",
                                                 "momentum_y",
                                                 "momentum_z",
                                                 "numerical_mapping",
                                                 "numerical_time",
                                                 "load_work",
                                                 "cell_size",
                                                 "tiles",
                                                 "motion_work",
                                                 "motion_impulse_x",
                                                 "motion_impulse_y",
                                                 "motion_impulse_z",
                                                 "energy_floor"};
  return names;
}

std::unique_ptr<Simulation> make_simulation(const Settings& settings) {
  check(settings);
  if (settings.dimension == 2) return std::make_unique<SimulationOf<2>>(settings);
  return std::make_unique<SimulationOf<3>>(settings);
}

template <int D>
SimulationOf<D>::SimulationOf(const Settings& settings)
    : settings_(settings), stages_(stages_of<D>(settings.scheme, settings.fused)) {
  TileGrid<D>& grid = domain_.grid;
  grid.cell_size = settings.cell_size;
  grid.basis = settings.basis;
  grid.bonded = settings.bonded;
  grid.walls.exist = settings.box_cells[0] > 0;
  grid.walls.odd_at_fixed = odd_at_fixed_walls(settings.basis);
  grid.keep.exist = settings.keep;
  for (std::size_t a = 0; a < D; ++a) {
    const int axis = static_cast<int>(a);
    grid.origin[axis] = settings.origin[a];
    grid.keep.lower[axis] = settings.keep_lower[a];
    grid.keep.upper[axis] = settings.keep_upper[a];
    grid.walls.cells[a] = settings.box_cells[a];
    grid.walls.face[a][0] = settings.walls[2 * a];
    grid.walls.face[a][1] = settings.walls[2 * a + 1];
  }
  domain_.gravity_of_time = settings.gravity;
  grid.has_dashpots = grid.walls.absorb();
  domain_.pic_damping = settings.pic_damping;
  domain_.disorder = settings.disorder;
  domain_.contact_settings.enabled = settings.contact;
  domain_.contact_settings.detection = settings.detection;
  domain_.contact_settings.normal = settings.normal_rule;
  domain_.contact_settings.gap_distance = settings.gap_distance;
  domain_.contact_settings.normal_travel = settings.normal_travel;
  domain_.contact_settings.friction = settings.friction;
  domain_.threads.resize(settings.threads);
  for (std::size_t k = 0; k < stages_.size(); ++k) timers_.name(k, stages_[k].name);
  history_.reserve((history_capacity + 1) * history_columns().size());
}

template <int D>
void SimulationOf<D>::prepare() {
  check(!prepared_, "prepare() has been called already");
  check(!domain_.bodies.empty(), "there is no body");
  make_lists(domain_.grid, domain_.bodies, domain_.threads, domain_.list_scratch);
  if (domain_.has_contact()) domain_.contact.connect(domain_.grid, domain_.bodies);
  domain_.sums.resize(domain_.grid.patches.size());
  const auto& bodies = domain_.bodies;
  const auto is_rigid = [](const Body<D>& b) { return b.rigid; };
  check(!std::all_of(bodies.begin(), bodies.end(), is_rigid),
        "all bodies are rigid, so no wave limits the time step: one must deform");
  check(!settings_.bonded || std::none_of(bodies.begin(), bodies.end(), is_rigid),
        "bodies are bonded, so none can be rigid");
  start_motions();
  if (std::any_of(bodies.begin(), bodies.end(),
                  [](const Body<D>& b) { return b.rigid && !b.prescribed; })) {
    domain_.rigid.resize(bodies.size());
    hold_rigid_bodies(domain_);
  }
  probe_speeds();
  domain_.ledger.kinetic = kinetic_energy();
  domain_.ledger.internal = initial_internal_energy();
  domain_.ledger.start = domain_.ledger.kinetic + domain_.ledger.internal;
  domain_.ledger.momentum = momentum();
  for (const Body<D>& b : bodies)
    if (b.prescribed) domain_.ledger.add_prescribed(b);
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
  for (Body<D>& b : domain_.bodies)
    if (b.prescribed) b.motion->begin_step(domain_.time, time_after);
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
  if (must_double()) double_cells();
}

template <int D>
void SimulationOf<D>::choose_time_step() {
  // Where neither waves nor particles are fast, nothing falls further than about a cell.
  double fastest = std::sqrt(norm(domain_.gravity) * settings_.cell_size);
  for (const PatchSums<D>& s : domain_.sums) fastest = std::max(fastest, s.stress.fastest);
  const double way = settings_.time_step_factor * settings_.cell_size;
  next_time_step_ = way / fastest;
  // Prescribed motions may have jumps.
  for (const Body<D>& b : domain_.bodies)
    if (b.prescribed && b.motion->moves) {
      const double speed = b.motion->speed(domain_.time, domain_.time + next_time_step_);
      next_time_step_ = std::min(next_time_step_, way / speed);
    }
}

template <int D>
void SimulationOf<D>::write_history_row() {
  // Room for the row of the start and history_capacity steps; a caller who never takes them loses
  // the oldest.
  if (history_.size() > history_capacity * history_columns().size()) history_.clear();
  const Ledger& l = domain_.ledger;
  for (const double value : {static_cast<double>(domain_.step),
                             domain_.time,
                             domain_.time_step,
                             l.kinetic,
                             l.internal,
                             l.plastic,
                             l.viscous,
                             l.friction,
                             l.contact,
                             l.external,
                             l.absorbed,
                             l.eroded,
                             l.left,
                             l.bounded,
                             l.numerical(),
                             l.residual(),
                             l.momentum[0],
                             l.momentum[1],
                             l.momentum[2],
                             l.mapping,
                             l.time_integration,
                             l.load_work,
                             domain_.grid.cell_size,
                             static_cast<double>(domain_.grid.patches.size()),
                             l.motion_work,
                             l.motion_impulse[0],
                             l.motion_impulse[1],
                             l.motion_impulse[2],
                             l.energy_floor})
    history_.push_back(value);
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
