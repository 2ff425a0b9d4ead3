// The part of a simulation that takes bodies in.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mpm/particles/make_body.hpp"
#include "mpm/run/simulation_of.hpp"

namespace mpm {
namespace {

void check_functions(const std::array<TimeFunction, 3>& functions, const std::string& what) {
  for (const TimeFunction& f : functions)
    if (!f.problem().empty()) throw std::invalid_argument(what + " " + f.problem());
}

}  // namespace

template <int D>
int SimulationOf<D>::add_material(const MaterialChoice& choice) {
  domain_.materials.push_back(make_material(choice));
  domain_.pools.push_back(make_pool(domain_.materials.back(), domain_.grid));
  return static_cast<int>(domain_.materials.size()) - 1;
}

template <int D>
int SimulationOf<D>::add_body(const std::string& name, int material_number,
                              std::span<const double> positions, std::span<const double> velocities,
                              std::span<const double> volumes) {
  if (prepared_) throw std::invalid_argument("bodies must be added before prepare()");
  const auto m = static_cast<std::size_t>(material_number);
  Body<D> body =
      make_body(name, domain_.materials.at(m), domain_.pools.at(m), positions, velocities, volumes);
  body.material = material_number;
  body.group = static_cast<int>(domain_.bodies.size());
  domain_.bodies.push_back(std::move(body));
  return static_cast<int>(domain_.bodies.size()) - 1;
}

template <int D>
void SimulationOf<D>::set_state(int number, const std::string& column,
                                std::span<const double> values) {
  if (prepared_) throw std::invalid_argument("states must be set before prepare()");
  Body<D>& b = domain_.bodies.at(static_cast<std::size_t>(number));
  const ColumnInfo& info = pool(b).columns.info(column);
  if (info.components != 1 || values.size() != b.count)
    throw std::invalid_argument(column + ": a state that is set must be (n,)");
  check_finite(values, column);
  b.given->states.emplace_back(info.first, std::vector<double>(values.begin(), values.end()));
}

template <int D>
void SimulationOf<D>::set_motion(int number, const std::array<TimeFunction, 3>& velocity,
                                 const std::array<TimeFunction, 3>& spin,
                                 const std::array<double, 3>& centre) {
  if (prepared_) throw std::invalid_argument("motions must be set before prepare()");
  Body<D>& b = domain_.bodies.at(static_cast<std::size_t>(number));
  for (const SurfaceLoad<D>& load : domain_.loads)
    if (load.body == number)
      throw std::invalid_argument(b.name + ": it has a load, which acts on bodies that deform");
  check_functions(velocity, b.name + ": velocity");
  check_functions(spin, b.name + ": spin");
  check_finite(centre, b.name + ": centre");
  b.kind = BodyKind::prescribed;
  b.motion = std::make_unique<PrescribedMotion>();
  b.motion->velocity = velocity;
  b.motion->spin = spin;
  b.motion->start({centre[0], centre[1], D == 3 ? centre[2] : 0.0}, domain_.time);
  b.stiffness = std::numeric_limits<double>::infinity();
}

/// Give the particles of bodies with prescribed motion their velocities at the start.
template <int D>
void SimulationOf<D>::start_motions() {
  for (const std::size_t b : domain_.prescribed) {
    PrescribedMotion& motion = *domain_.bodies[b].motion;
    motion.radius = 0.0;
    for (const Patch<D>& patch : patches_of<D>(domain_.grid.patches, static_cast<int>(b))) {
      ParticlePool<D>& pool = domain_.pool_of(patch);
      for (const std::uint32_t row : pool.rows(patch)) {
        const Vector3 x = in_space<D>(pool.position_of(row));
        motion.radius = std::max(motion.radius, norm(x - motion.now.centre));
        const Vector3 v = motion.now.velocity_at(x);
        for (int a = 0; a < D; ++a) pool.v(a)[row] = static_cast<Storage>(v[a]);
      }
    }
  }
}

template <int D>
double SimulationOf<D>::initial_internal_energy() const {
  double total = 0.0;
  for (const Patch<D>& patch : domain_.grid.patches) {
    const ParticlePool<D>& of = pool(body(patch.body));
    if (of.at.energy < 0) continue;
    for (const std::uint32_t row : of.rows(patch))
      total += of.columns.component(of.at.energy)[row] * of.volume()[row];
  }
  return total;
}

template <int D>
void SimulationOf<D>::set_group(int number, int first) {
  if (first < 0 || number <= first || number >= body_count() || body(first).group != first)
    throw std::invalid_argument("a group is given by its first body");
  for (const Body<D>& b : domain_.bodies)
    if (&b != &body(number) && b.group == number)
      throw std::invalid_argument("a body with a group of its own cannot join another");
  domain_.bodies[static_cast<std::size_t>(number)].group = first;
}

template <int D>
void SimulationOf<D>::set_pair_friction(int a, int b, double mu) {
  if (!(mu >= 0.0 && std::isfinite(mu)))
    throw std::invalid_argument("friction must be a finite number >= 0");
  for (const int k : {a, b})
    if (k < 0 || k >= body_count() || body(k).group != k)
      throw std::invalid_argument("friction needs two groups, each given by its first body");
  set_friction(domain_.contact_settings, a, b, mu);
}

template <int D>
void SimulationOf<D>::set_velocity(int number, std::span<const double> velocities) {
  Body<D>& b = domain_.bodies.at(static_cast<std::size_t>(number));
  if (b.is_prescribed()) throw std::invalid_argument("the motion of " + b.name + " is prescribed");
  if (velocities.size() != b.count * D) throw std::invalid_argument("velocities must be (n, D)");
  check_finite(velocities, "velocities");
  if (!prepared_) {
    b.given->velocities.assign(velocities.begin(), velocities.end());
    return;
  }
  const double before = kinetic_energy();
  ParticlePool<D>& pool = domain_.pools[static_cast<std::size_t>(b.material)];
  for_each_row(domain_.grid.patches, pool, number, b.removed, [&](std::uint32_t row) {
    for (std::size_t a = 0; a < D; ++a)
      pool.v(static_cast<int>(a))[row] = static_cast<Storage>(velocities[pool.id[row] * D + a]);
  });
  project_rigid_velocities(domain_);
  domain_.ledger.external += kinetic_energy() - before;
  domain_.ledger.kinetic = kinetic_energy();
  domain_.ledger.momentum = momentum();
  watch_.start_from(domain_.ledger.made(), domain_.ledger.load_work);
  probe_speeds();
  invalidate_pairs(domain_.contact);  // gaps change with the velocities that particles had
}

template <int D>
void SimulationOf<D>::set_gravity(const std::array<TimeFunction, 3>& gravity) {
  check_functions(gravity, "gravity");
  domain_.gravity_of_time = gravity;
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
