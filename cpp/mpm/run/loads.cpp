// The part of a simulation that takes loads on surfaces in and tells what they have done.
#include <cmath>
#include <stdexcept>

#include "mpm/run/simulation_of.hpp"

namespace mpm {

template <int D>
void SimulationOf<D>::add_load(const std::string& name, int number, const std::string& kind,
                               const std::array<TimeFunction, 3>& value, const Pieces& pieces) {
  const auto check = [&](bool condition, const std::string& rule) {
    if (!condition) throw std::invalid_argument("load " + name + ": " + rule);
  };
  check(!prepared_, "must be added before prepare()");
  const Body<D>& body = domain_.bodies.at(static_cast<std::size_t>(number));
  check(body.deforms(), "its body is rigid, and a load acts on bodies that deform");
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
  load.piece.assign(body.count(), 0);
  load.area.resize(n);
  load.arm.resize(n);
  load.size.assign(pieces.sizes.begin(), pieces.sizes.end());
  for (const double size : load.size)
    check(size > 0.0 && std::isfinite(size), "sizes must be finite numbers > 0");
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t particle = pieces.particles[k];
    check(particle < body.count(), "there is no such particle");
    check(load.piece[particle] == 0, "a particle has two pieces");
    load.piece[particle] = static_cast<std::uint32_t>(k + 1);
    for (std::size_t a = 0; a < D; ++a) {
      const int axis = static_cast<int>(a);
      load.area[k][axis] = pieces.areas[k * D + a];
      load.arm[k][axis] = pieces.arms[k * D + a];
      check(std::isfinite(load.area[k][axis]) && std::isfinite(load.arm[k][axis]),
            "areas and arms must be finite numbers");
    }
  }
  domain_.loads.push_back(std::move(load));
}

template <int D>
std::vector<LoadRecord> SimulationOf<D>::loads() const {
  std::vector<LoadRecord> records;
  for (const SurfaceLoad<D>& load : domain_.loads) {
    LoadRecord& record = records.emplace_back();
    record.name = load.name;
    for (std::size_t a = 0; a < D; ++a) {
      record.force[a] = load.force[static_cast<int>(a)];
      record.impulse[a] = load.impulse[static_cast<int>(a)];
    }
    const Body<D>& on = body(load.body);
    for (std::size_t k = 0; k < on.active(); ++k)
      if (const std::uint32_t piece = load.piece[on.id[on.order[k]]])
        record.area += load.size[piece - 1];
  }
  return records;
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
