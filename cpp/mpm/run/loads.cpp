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
  const Body<D>& on = body(number);
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
    piece.load = static_cast<int>(domain_.loads.size());
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
  domain_.pieces.insert(domain_.pieces.end(), found.begin(), found.end());
  domain_.loads.push_back(std::move(load));
}

/// Tell the particles which pieces they carry; each body's lie in one patch yet, as they were
/// given.
template <int D>
void SimulationOf<D>::place_pieces() {
  for (std::size_t k = 0; k < domain_.pieces.size(); ++k) {
    SurfacePiece<D>& piece = domain_.pieces[k];
    const int on = domain_.loads[static_cast<std::size_t>(piece.load)].body;
    const Patch<D>& patch = domain_.grid.patches[static_cast<std::size_t>(on)];
    ParticlePool<D>& pool = domain_.pool_of(patch);
    pool.piece.resize(pool.count(), 0);
    std::uint32_t& first = pool.piece[patch.begin + std::size_t{piece.particle}];
    piece.next = first;
    first = static_cast<std::uint32_t>(k + 1);
  }
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
  }
  std::vector<bool> removed(domain_.pieces.size());  // with the particles that carried them
  for (const ParticlePool<D>& pool : domain_.pools)
    for (const RemovedRow& one : pool.removed)
      for (std::uint32_t k = pool.piece.empty() ? 0 : pool.piece[one.row]; k != 0;
           k = domain_.pieces[k - 1].next)
        removed[k - 1] = true;
  for (std::size_t k = 0; k < removed.size(); ++k) {
    const SurfacePiece<D>& piece = domain_.pieces[k];
    if (!removed[k]) records[static_cast<std::size_t>(piece.load)].area += piece.size;
  }
  return records;
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
