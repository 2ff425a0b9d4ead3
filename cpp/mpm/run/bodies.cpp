#include "mpm/run/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "mpm/particles/add_columns.hpp"
#include "mpm/particles/make_body.hpp"
#include "mpm/run/start_in_body.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {
namespace {

void check_functions(const std::array<TimeFunction, 3>& functions, const std::string& what) {
  for (const TimeFunction& f : functions)
    if (!f.problem().empty()) throw std::invalid_argument(what + " " + f.problem());
}

/// Is it a body, and the first of its group?
template <int D>
bool leads_group(const Domain<D>& domain, int number) {
  const auto b = static_cast<std::size_t>(number);
  return number >= 0 && b < domain.bodies.size() && domain.bodies[b].group == number;
}

}  // namespace

template <int D>
int add_material(Simulation<D>& simulation, const MaterialChoice& choice) {
  require(simulation, Phase::building, "materials must be added before prepare()");
  Domain<D>& domain = simulation.domain;
  const Material material = make_material(choice);
  if (choice.in_body) check_in_body(material);
  domain.materials.push_back(material);
  domain.pools.push_back(
      make_pool(domain.materials.back(), domain.grid, columns_of(domain.transfer, choice.in_body)));
  return static_cast<int>(domain.materials.size()) - 1;
}

template <int D>
int add_body(Simulation<D>& simulation, const std::string& name, int material_number,
             std::span<const double> positions, std::span<const double> velocities,
             std::span<const double> volumes) {
  Domain<D>& domain = simulation.domain;
  require(simulation, Phase::building, "bodies must be added before prepare()");
  const auto m = static_cast<std::size_t>(material_number);
  const Share share(positions.size() / D, *domain.grid.partition.comm);
  Body<D> body = make_body(name, domain.materials.at(m), domain.pools.at(m), positions, velocities,
                           volumes, share);
  body.material = material_number;
  body.group = static_cast<int>(domain.bodies.size());
  domain.bodies.push_back(std::move(body));
  return static_cast<int>(domain.bodies.size()) - 1;
}

namespace {

/// All ranks are given the same of this, and so throw alike.
void check_bodies(std::span<const std::string> names, std::span<const std::int64_t> counts,
                  std::span<const double> volumes) {
  if (names.empty() || counts.size() != names.size() || volumes.size() != names.size())
    throw std::invalid_argument("bodies need a name, a count and a volume of a particle each");
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (counts[k] <= 0) throw std::invalid_argument(names[k] + ": it has no particles");
    if (counts[k] > std::numeric_limits<std::uint32_t>::max())  // They are numbered by 32 bits.
      throw std::invalid_argument(names[k] + ": it has more than 4 billion particles");
    if (!(volumes[k] > 0.0 && std::isfinite(volumes[k])))
      throw std::invalid_argument(names[k] + ": volumes must be finite numbers > 0");
  }
}

}  // namespace

template <int D>
int add_bodies(Simulation<D>& simulation, std::span<const std::string> names, int material_number,
               std::span<const std::int64_t> counts, std::span<const double> volumes,
               std::size_t first, std::span<const double> positions,
               std::span<const double> velocities) {
  Domain<D>& domain = simulation.domain;
  require(simulation, Phase::building, "bodies must be added before prepare()");
  const auto m = static_cast<std::size_t>(material_number);
  const Material& material = domain.materials.at(m);
  const ParticlePool<D>& pool = domain.pools.at(m);
  check_bodies(names, counts, volumes);
  if (velocities.size() != D && velocities.size() != positions.size())
    throw std::invalid_argument(names[0] + ": velocities must be (n, D) or (1, D)");
  const auto leader = static_cast<int>(domain.bodies.size());
  const Share share(names.size(), *domain.grid.partition.comm);
  const bool alike = velocities.size() == D;
  std::vector<Body<D>> bodies;
  bodies.reserve(names.size());
  std::size_t given = 0;  // particles before those of the body
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto count = static_cast<std::size_t>(counts[k]);
    const bool is_given = k >= first && (given + count) * D <= positions.size();
    if (share.holds(k) && !is_given)
      throw std::invalid_argument(names[k] + ": its particles are not given");
    const Share whole = share.holds(k) ? Share(0, count) : Share();
    const std::size_t at = share.holds(k) ? given * D : 0, width = whole.count() * D;
    Body<D> body = make_slice(names[k], material, pool, count, whole, positions.subspan(at, width),
                              alike ? velocities : velocities.subspan(at, width), volumes[k]);
    if (k >= first) given += count;
    body.material = material_number;
    body.group = leader;
    bodies.push_back(std::move(body));
  }
  std::ranges::move(bodies, std::back_inserter(domain.bodies));
  return leader;
}

template <int D>
int add_slice(Simulation<D>& simulation, const std::string& name, int material_number,
              std::size_t count, std::size_t first, std::span<const double> positions,
              std::span<const double> velocities, double volume) {
  Domain<D>& domain = simulation.domain;
  require(simulation, Phase::building, "bodies must be added before prepare()");
  const auto m = static_cast<std::size_t>(material_number);
  const auto counts = {static_cast<std::int64_t>(count)};
  check_bodies(std::span(&name, 1), counts, std::span(&volume, 1));
  Body<D> body =
      make_slice(name, domain.materials.at(m), domain.pools.at(m), count,
                 Share(first, first + positions.size() / D), positions, velocities, volume);
  body.material = material_number;
  body.group = static_cast<int>(domain.bodies.size());
  domain.bodies.push_back(std::move(body));
  return static_cast<int>(domain.bodies.size()) - 1;
}

template <int D>
void set_state(Simulation<D>& simulation, int number, const std::string& column,
               std::span<const double> values) {
  require(simulation, Phase::building, "states must be set before prepare()");
  Body<D>& b = simulation.domain.body_at(number);
  const ColumnInfo& info = simulation.domain.pool_of(b).columns.info(column);
  const Share share = b.share();
  const auto width = static_cast<std::size_t>(info.components);
  const bool of_all = values.size() == b.count * width;
  if (!of_all && values.size() != share.count() * width)
    throw std::invalid_argument(column + ": a state that is set must be (n,) or (n, components)");
  check_finite(values, column);
  if (!b.given) return;
  const std::vector<double> own =
      of_all ? share.of(values, width) : std::vector(values.begin(), values.end());
  for (std::size_t c = 0; c < width; ++c) {
    std::vector<double> component(own.size() / width);
    for (std::size_t i = 0; i < component.size(); ++i) component[i] = own[i * width + c];
    b.given->states.emplace_back(info.first + static_cast<int>(c), std::move(component));
  }
}

template <int D>
void keep_start_positions(Simulation<D>& simulation) {
  require(simulation, Phase::building, "places at the start must be kept before prepare()");
  for (ParticlePool<D>& pool : simulation.domain.pools) add_start_positions(pool);
}

template <int D>
void set_motion(Simulation<D>& simulation, int number, const std::array<TimeFunction, 3>& velocity,
                const std::array<TimeFunction, 3>& spin, const std::array<double, 3>& centre) {
  Domain<D>& domain = simulation.domain;
  require(simulation, Phase::building, "motions must be set before prepare()");
  Body<D>& b = domain.body_at(number);
  if (domain.pool_of(b).reference >= 0)
    throw std::invalid_argument(b.name + ": frame = \"material\" is for bodies that deform");
  for (const SurfaceLoad<D>& load : domain.loads)
    if (load.body == number)
      throw std::invalid_argument(b.name + ": it has a load, which acts on bodies that deform");
  if (b.force >= 0)
    throw std::invalid_argument(b.name + ": it has a body force, which acts on those that deform");
  if (b.damping >= 0)
    throw std::invalid_argument(b.name + ": it has damping, which acts on bodies that deform");
  check_functions(velocity, b.name + ": velocity");
  check_functions(spin, b.name + ": spin");
  check_finite(centre, b.name + ": centre");
  b.kind = BodyKind::prescribed;
  b.motion = std::make_unique<PrescribedMotion>();
  b.motion->velocity = velocity;
  b.motion->spin = spin;
  b.motion->start({centre[0], centre[1], D == 3 ? centre[2] : 0.0}, domain.time);
  b.stiffness = std::numeric_limits<double>::infinity();
}

template <int D>
void set_group(Simulation<D>& simulation, int number, int first) {
  require(simulation, Phase::building, "groups must be set before prepare()");
  Domain<D>& domain = simulation.domain;
  if (number <= first || std::cmp_greater_equal(number, domain.bodies.size()) ||
      !leads_group(domain, first))
    throw std::invalid_argument("a group is given by its first body");
  Body<D>& body = domain.body_at(number);
  for (const Body<D>& b : domain.bodies)
    if (&b != &body && b.group == number)
      throw std::invalid_argument("a body with a group of its own cannot join another");
  body.group = first;
}

template <int D>
void set_pair_law(Domain<D>& domain, int a, int b, const PairLaw& law) {
  if (!(law.friction >= 0.0 && std::isfinite(law.friction)))
    throw std::invalid_argument("friction must be a finite number >= 0");
  if (!leads_group(domain, a) || !leads_group(domain, b))
    throw std::invalid_argument("a pair needs two groups, each given by its first body");
  if (law.bonded && domain.surfaces.exist())
    throw std::invalid_argument("bodies on nodes of their own are bonded at the start");
  set_law(domain.contact_settings, a, b, law);
}

template <int D>
void press(Simulation<D>& simulation, int a, int b, double depth) {
  require(simulation, Phase::building, "bodies must be pressed before prepare()");
  if (!(depth >= 0.0 && std::isfinite(depth)))
    throw std::invalid_argument("a depth must be a finite number >= 0");
  PairLaw law = law_of(simulation.domain.contact_settings, a, b);
  law.pressed = depth;
  set_pair_law(simulation.domain, a, b, law);
  set_law(simulation.settings.contact, a, b, law);  // all of it, whatever the time
}

template <int D>
void set_gravity(Domain<D>& domain, const std::array<TimeFunction, 3>& gravity) {
  check_functions(gravity, "gravity");
  domain.gravity_of_time = gravity;
}

template int add_material<2>(Simulation<2>&, const MaterialChoice&);
template int add_material<3>(Simulation<3>&, const MaterialChoice&);
template int add_body<2>(Simulation<2>&, const std::string&, int, std::span<const double>,
                         std::span<const double>, std::span<const double>);
template int add_body<3>(Simulation<3>&, const std::string&, int, std::span<const double>,
                         std::span<const double>, std::span<const double>);
template int add_bodies<2>(Simulation<2>&, std::span<const std::string>, int,
                           std::span<const std::int64_t>, std::span<const double>, std::size_t,
                           std::span<const double>, std::span<const double>);
template int add_bodies<3>(Simulation<3>&, std::span<const std::string>, int,
                           std::span<const std::int64_t>, std::span<const double>, std::size_t,
                           std::span<const double>, std::span<const double>);
template int add_slice<2>(Simulation<2>&, const std::string&, int, std::size_t, std::size_t,
                          std::span<const double>, std::span<const double>, double);
template int add_slice<3>(Simulation<3>&, const std::string&, int, std::size_t, std::size_t,
                          std::span<const double>, std::span<const double>, double);
template void set_state<2>(Simulation<2>&, int, const std::string&, std::span<const double>);
template void set_state<3>(Simulation<3>&, int, const std::string&, std::span<const double>);
template void keep_start_positions<2>(Simulation<2>&);
template void keep_start_positions<3>(Simulation<3>&);
template void set_motion<2>(Simulation<2>&, int, const std::array<TimeFunction, 3>&,
                            const std::array<TimeFunction, 3>&, const std::array<double, 3>&);
template void set_motion<3>(Simulation<3>&, int, const std::array<TimeFunction, 3>&,
                            const std::array<TimeFunction, 3>&, const std::array<double, 3>&);
template void set_group<2>(Simulation<2>&, int, int);
template void set_group<3>(Simulation<3>&, int, int);
template void set_pair_law<2>(Domain<2>&, int, int, const PairLaw&);
template void set_pair_law<3>(Domain<3>&, int, int, const PairLaw&);
template void press<2>(Simulation<2>&, int, int, double);
template void press<3>(Simulation<3>&, int, int, double);
template void set_gravity<2>(Domain<2>&, const std::array<TimeFunction, 3>&);
template void set_gravity<3>(Domain<3>&, const std::array<TimeFunction, 3>&);

}  // namespace mpm
