#include "mpm/run/loads.hpp"

#include <cmath>
#include <stdexcept>

#include "mpm/comm/all_sums.hpp"
#include "mpm/particles/add_columns.hpp"
#include "mpm/particles/make_body.hpp"

namespace mpm {

template <int D>
void add_load(Simulation<D>& simulation, const std::string& name, int number,
              const std::string& kind, const std::array<TimeFunction, 3>& value,
              const Pieces& pieces) {
  Domain<D>& domain = simulation.domain;
  const auto check = [&](bool condition, const std::string& rule) {
    if (!condition) throw std::invalid_argument("load " + name + ": " + rule);
  };
  require(simulation, Phase::building, "loads must be added before prepare()");
  const Body<D>& on = domain.body_at(number);
  check(on.deforms(), "its body is rigid, and a load acts on bodies that deform");
  const std::size_t n = pieces.particles.size();
  check(n > 0, "no particle carries a piece of the surface");
  check(pieces.areas.size() == n * D && pieces.arms.size() == n * D && pieces.sizes.size() == n,
        "areas and arms must be (pieces, D), sizes (pieces,)");
  SurfaceLoad<D> load;
  load.name = name;
  load.body = number;
  load.kind = choice_named<LoadKind>("a load", kind);
  for (std::size_t a = 0; a < D; ++a) {
    load.value[a] = value[a];
    check(value[a].problem().empty(), "its function of time " + value[a].problem());
  }
  std::vector<bool> carries(on.count);
  std::vector<SurfacePiece<D>> found(n);
  for (std::size_t k = 0; k < n; ++k) {
    SurfacePiece<D>& piece = found[k];
    piece.load = static_cast<int>(domain.loads.size());
    piece.particle = pieces.particles[k];
    piece.size = pieces.sizes[k];
    check(piece.size > 0.0 && std::isfinite(piece.size), "sizes must be finite numbers > 0");
    check(piece.particle < on.count, "there is no such particle");
    check(!carries[piece.particle], "a particle has two pieces");
    carries[piece.particle] = true;
    for (std::size_t a = 0; a < D; ++a) {
      const int axis = static_cast<int>(a);
      piece.area[axis] = pieces.areas[k * D + a];
      piece.arm[axis] = pieces.arms[k * D + a];
      check(std::isfinite(piece.area[axis]) && std::isfinite(piece.arm[axis]),
            "areas and arms must be finite numbers");
    }
  }
  auto& all = domain.pool_of(on).pieces;
  all.insert(all.end(), found.begin(), found.end());
  domain.loads.push_back(std::move(load));
}

template <int D>
void add_body_force(Simulation<D>& simulation, const std::vector<int>& bodies,
                    const std::vector<Expression::Program>& value) {
  Domain<D>& domain = simulation.domain;
  require(simulation, Phase::building, "body forces must be added before prepare()");
  BodyForce<D> force;
  force.given = value.empty();
  if (!force.given && value.size() != D)
    throw std::invalid_argument("a body force must have D formulas");
  for (std::size_t a = 0; a < value.size(); ++a) force.value[a] = Expression(value[a]);
  for (const int number : bodies) {
    Body<D>& body = domain.body_at(number);
    const auto check = [&](bool condition, const char* rule) {
      if (!condition) throw std::invalid_argument(body.name + rule);
    };
    check(body.deforms(), ": it is rigid, and a body force acts on bodies that deform");
    check(body.force < 0, ": it has a body force already");
    body.force = static_cast<int>(domain.body_forces.size());
    add_force_column(domain.pool_of(body));
    if (force.is_of_start()) add_start_positions(domain.pool_of(body));
  }
  domain.body_forces.push_back(std::move(force));
}

template <int D>
void set_body_force(Simulation<D>& simulation, int number, std::span<const double> values) {
  Domain<D>& domain = simulation.domain;
  require(simulation, Phase::ready, "call prepare() before set_body_force()");
  const Body<D>& body = domain.body_at(number);
  if (body.force < 0 || !domain.body_forces[static_cast<std::size_t>(body.force)].given)
    throw std::invalid_argument(body.name + ": it takes no force from the program");
  if (values.size() != body.count * D) throw std::invalid_argument("forces must be (n, D)");
  check_finite(values, "forces");
  ParticlePool<D>& pool = domain.pool_of(body);
  for_each_row(domain.grid.patches, pool, number, body.removed_here, [&](std::uint32_t row) {
    for (std::size_t a = 0; a < D; ++a)
      pool.columns.component(pool.body_force + static_cast<int>(a))[row] =
          values[pool.id[row] * D + a];
  });
}

template <int D>
void add_damping(Simulation<D>& simulation, const std::vector<int>& bodies,
                 const TimeFunction& rate, const TimeFunction& local) {
  Domain<D>& domain = simulation.domain;
  require(simulation, Phase::building, "damping must be added before prepare()");
  const auto check = [](bool condition, const std::string& rule) {
    if (!condition) throw std::invalid_argument("damping: " + rule);
  };
  for (const TimeFunction& f : {rate, local})
    check(f.problem().empty(), "its function of time " + f.problem());
  check(rate.lower_bound() >= 0.0, "mass must be >= 0 at all times");
  check(local.lower_bound() >= 0.0 && local.upper_bound() < 1.0,
        "local must be >= 0 and < 1 at all times");
  for (const int number : bodies) {
    Body<D>& body = domain.body_at(number);
    check(body.deforms(), body.name + " does not deform, and damping acts on bodies that do");
    check(body.damping < 0, body.name + " has damping already");
    body.damping = static_cast<int>(domain.dampings.size());
  }
  domain.dampings.push_back({rate, local, {}});
}

template <int D>
void place_pieces(Domain<D>& domain) {
  struct Numbered {
    std::uint32_t number, row;
  };
  std::vector<std::vector<Numbered>> of_bodies(domain.bodies.size());  // by number
  for (ParticlePool<D>& pool : domain.pools)
    for (std::size_t k = 0; k < pool.pieces.size(); ++k) {
      SurfacePiece<D>& piece = pool.pieces[k];
      const int on = domain.loads[static_cast<std::size_t>(piece.load)].body;
      const Patch<D>& patch = domain.grid.patches[static_cast<std::size_t>(on)];
      pool.piece.resize(pool.count(), 0);
      std::vector<Numbered>& rows = of_bodies[static_cast<std::size_t>(on)];
      if (rows.empty()) {
        for (const std::uint32_t row : pool.rows(patch)) rows.push_back({pool.id[row], row});
        std::ranges::sort(rows, {}, &Numbered::number);
      }
      const auto found = std::ranges::lower_bound(rows, piece.particle, {}, &Numbered::number);
      if (found == rows.end() || found->number != piece.particle) continue;  // another rank's
      std::uint32_t& first = pool.piece[found->row];
      piece.next = first;
      first = static_cast<std::uint32_t>(k + 1);
    }
}

template <int D>
std::vector<LoadRecord> load_records(const Domain<D>& domain) {
  std::vector<LoadRecord> records;
  for (const SurfaceLoad<D>& load : domain.loads) {
    LoadRecord& record = records.emplace_back();
    record.name = load.name;
    for (std::size_t a = 0; a < D; ++a) {
      record.force[a] = load.force[static_cast<int>(a)];
      record.impulse[a] = load.impulse[static_cast<int>(a)];
    }
  }
  std::vector<ExactSum> areas(records.size());
  domain.for_each_particle([&](const ParticlePool<D>& pool, std::uint32_t row) {
    for_each_piece_of(pool, row, [&](const SurfacePiece<D>& piece) {
      areas[static_cast<std::size_t>(piece.load)].add(piece_in_space(pool, row, piece).size);
    });
  });
  all_sum(*domain.grid.partition.comm, areas);
  for (std::size_t l = 0; l < records.size(); ++l)
    LoadKinds::with(domain.loads[l].kind, [&]<class Kind>(const Kind&) {
      records[l].area = acts_at_point<Kind> ? 0.0 : areas[l].value();
    });
  return records;
}

template void add_load<2>(Simulation<2>&, const std::string&, int, const std::string&,
                          const std::array<TimeFunction, 3>&, const Pieces&);
template void add_load<3>(Simulation<3>&, const std::string&, int, const std::string&,
                          const std::array<TimeFunction, 3>&, const Pieces&);
template void add_body_force<2>(Simulation<2>&, const std::vector<int>&,
                                const std::vector<Expression::Program>&);
template void add_body_force<3>(Simulation<3>&, const std::vector<int>&,
                                const std::vector<Expression::Program>&);
template void set_body_force<2>(Simulation<2>&, int, std::span<const double>);
template void set_body_force<3>(Simulation<3>&, int, std::span<const double>);
template void add_damping<2>(Simulation<2>&, const std::vector<int>&, const TimeFunction&,
                             const TimeFunction&);
template void add_damping<3>(Simulation<3>&, const std::vector<int>&, const TimeFunction&,
                             const TimeFunction&);
template void place_pieces<2>(Domain<2>&);
template void place_pieces<3>(Domain<3>&);
template std::vector<LoadRecord> load_records<2>(const Domain<2>&);
template std::vector<LoadRecord> load_records<3>(const Domain<3>&);

}  // namespace mpm
