#include "mpm/run/find_failure.hpp"

#include <cmath>
#include <sstream>

#include "mpm/run/time_step.hpp"

namespace mpm {

template <int D>
void find_failure(Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  const auto fail = [&](const char* kind, std::size_t body, std::size_t row,
                        const std::string& what) {
    simulation.failure = failure_at(domain, kind, body, row, what);
  };
  bool negative = false;
  for (const PatchSums<D>& s : domain.sums) negative = negative || s.stress.negative_volume;
  if (!negative && std::isfinite(domain.ledger.kinetic) &&
      std::isfinite(domain.ledger.residual())) {
    if (domain.ledger.growth() <= simulation.settings.run.energy_growth_limit) return;
    const Limiter fastest = find_limiter(domain);
    if (fastest.body < 0) return fail("energy growth", 0, 0, "no particle takes part any more");
    const std::size_t row = row_of(domain, fastest.body, fastest.particle);
    std::ostringstream text;
    text << "the numerical terms have made " << domain.ledger.growth()
         << " of the largest energy brought in (the column numerical of history.csv); halve "
            "run.cfl, "
            "or raise run.energy_growth_limit if that is meant";
    fail("energy growth", static_cast<std::size_t>(fastest.body), row, text.str());
    return;
  }
  for (const Patch<D>& patch : domain.grid.patches) {
    const auto b = static_cast<std::size_t>(patch.body);
    const ParticlePool<D>& of = domain.pool_of(patch);
    const bool forced = domain.body_of(patch).force >= 0;
    for (const std::uint32_t i : of.rows(patch)) {
      for (int a = 0; a < (forced ? D : 0); ++a) {
        const double force = of.columns.component(of.body_force + a)[i];
        if (moves_within_cell(force, domain.time_step, domain.grid.cell_size)) continue;
        std::ostringstream text;
        text << "its body_force is " << force << " m/s^2 along " << "xyz"[a]
             << ", no finite number or one that moves it past a cell in a step";
        return fail("body force", b, i, text.str());
      }
      bool finite = true;
      for (int c = 0; c < of.columns.component_count(); ++c)
        finite = finite && std::isfinite(of.columns.value(c, i));
      if (!finite) {
        fail("non-finite", b, i, "a value of the particle is not a finite number");
        return;
      }
      if (!(of.volume()[i] > 0.0)) {
        fail("negative volume", b, i, "the particle has been turned inside out");
        return;
      }
    }
  }
  fail("non-finite", 0, 0, "the energy is not a finite number");
}

template <int D>
Failure failure_at(const Domain<D>& domain, const std::string& kind, std::size_t b, std::size_t row,
                   const std::string& what) {
  const Body<D>& body = domain.bodies[b];
  const ParticlePool<D>& pool = domain.pool_of(body);
  Failure f;
  f.kind = kind;
  f.body = static_cast<int>(b);
  f.particle = pool.id[row];
  f.step = domain.step;
  f.time = domain.time;
  for (int a = 0; a < D; ++a) f.position[static_cast<std::size_t>(a)] = pool.x(a)[row];
  std::ostringstream text;
  text << kind << " at step " << f.step << ", t = " << f.time << " s: " << what << " (body \""
       << body.name << "\", particle " << f.particle << ", at";
  for (int a = 0; a < D; ++a) text << ' ' << pool.x(a)[row];
  text << " m)";
  f.message = text.str();
  return f;
}

template <int D>
std::size_t row_of(const Domain<D>& domain, int number, std::int64_t particle) {
  const Body<D>& body = domain.body_at(number);
  const ParticlePool<D>& of = domain.pool_of(body);
  std::size_t found = 0;
  for_each_row(domain.grid.patches, of, number, body.removed, [&](std::uint32_t row) {
    if (static_cast<std::int64_t>(of.id[row]) == particle) found = row;
  });
  return found;
}

template void find_failure<2>(Simulation<2>&);
template void find_failure<3>(Simulation<3>&);
template Failure failure_at<2>(const Domain<2>&, const std::string&, std::size_t, std::size_t,
                               const std::string&);
template Failure failure_at<3>(const Domain<3>&, const std::string&, std::size_t, std::size_t,
                               const std::string&);
template std::size_t row_of<2>(const Domain<2>&, int, std::int64_t);
template std::size_t row_of<3>(const Domain<3>&, int, std::int64_t);

}  // namespace mpm
