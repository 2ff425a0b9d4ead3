// The part of a simulation that finds out why it cannot go on.
#include <cmath>
#include <sstream>

#include "mpm/run/simulation_of.hpp"

namespace mpm {

template <int D>
void SimulationOf<D>::find_failure() {
  bool negative = false;
  for (const PatchSums<D>& s : domain_.sums) negative = negative || s.stress.negative_volume;
  if (!negative && std::isfinite(domain_.ledger.kinetic) &&
      std::isfinite(domain_.ledger.residual())) {
    if (domain_.ledger.growth() <= settings_.run.energy_growth_limit) return;
    const Limiter fastest = limiter();
    const std::size_t row = row_of(fastest.body, fastest.particle);
    std::ostringstream text;
    text << "the numerical terms have made " << domain_.ledger.growth()
         << " of the largest energy brought in";
    failure_ = failure_at("energy growth", static_cast<std::size_t>(fastest.body), row, text.str());
    return;
  }
  for (const Patch<D>& patch : domain_.grid.patches) {
    const auto b = static_cast<std::size_t>(patch.body);
    const ParticlePool<D>& of = domain_.pool_of(patch);
    for (const std::uint32_t i : of.rows(patch)) {
      bool finite = true;
      for (int c = 0; c < of.columns.component_count(); ++c)
        finite = finite && std::isfinite(of.columns.value(c, i));
      if (!finite) {
        failure_ = failure_at("non-finite", b, i, "a value of the particle is not a finite number");
        return;
      }
      if (!(of.volume()[i] > 0.0)) {
        failure_ = failure_at("negative volume", b, i, "the particle has been turned inside out");
        return;
      }
    }
  }
  failure_ = failure_at("non-finite", 0, 0, "the energy is not a finite number");
}

template <int D>
Failure SimulationOf<D>::failure_at(const std::string& kind, std::size_t b, std::size_t row,
                                    const std::string& what) const {
  const Body<D>& body = domain_.bodies[b];
  Failure f;
  f.kind = kind;
  f.body = static_cast<int>(b);
  f.particle = pool(body).id[row];
  f.step = domain_.step;
  f.time = domain_.time;
  for (int a = 0; a < D; ++a) f.position[static_cast<std::size_t>(a)] = pool(body).x(a)[row];
  std::ostringstream text;
  text << kind << " at step " << f.step << ", t = " << f.time << " s: " << what << " (body \""
       << body.name << "\", particle " << f.particle << ", at";
  for (int a = 0; a < D; ++a) text << ' ' << pool(body).x(a)[row];
  text << " m)";
  f.message = text.str();
  return f;
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
