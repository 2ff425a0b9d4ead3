#include "mpm/run/find_failure.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>

#include "mpm/run/time_step.hpp"
#include "mpm/run/use_device.hpp"

namespace mpm {

namespace {

/// What a particle that no step can go on from has; empty if it can go on.
template <int D>
std::pair<std::string, std::string> kind_and_sentence(const Domain<D>& domain,
                                                      const Patch<D>& patch, std::uint32_t row) {
  const ParticlePool<D>& of = domain.pool_of(patch);
  for (int a = 0; a < (domain.body_of(patch).force >= 0 ? D : 0); ++a) {
    const double force = of.columns.component(of.body_force + a)[row];
    if (moves_within_cell(force, domain.time_step, domain.grid.cell_size)) continue;
    std::ostringstream text;
    text << "its body_force is " << force << " m/s^2 along "
         << "xyz"[a] << ", no finite number or one that moves it past a cell in a step";
    return {"body force", text.str()};
  }
  for (int c = 0; c < of.columns.component_count(); ++c)
    if (!std::isfinite(of.columns.value(c, row)))
      return {"non-finite", "a value of the particle is not a finite number"};
  if (!(of.volume()[row] > 0.0))
    return {"negative volume", "the particle has been turned inside out"};
  return {};
}

/// The first particle of all, in the order of the patches, that no step can go on from.
template <int D>
Failure first_failure(const Domain<D>& domain) {
  std::optional<Failure> found;
  std::vector<double> key(1 + D, -std::numeric_limits<double>::infinity());
  for (const Patch<D>& patch : domain.grid.patches) {
    for (const std::uint32_t row : domain.pool_of(patch).rows(patch)) {
      const auto [kind, what] = kind_and_sentence(domain, patch, row);
      if (kind.empty()) continue;
      found = failure_at(domain, kind, particle_at(domain.pool_of(patch), patch.body, row), what);
      break;
    }
    if (!found) continue;
    key[0] = -patch.body;
    for (std::size_t a = 0; a < D; ++a) key[1 + a] = -patch.tile[D - 1 - a];
    break;
  }
  Comm& comm = *domain.grid.partition.comm;
  if (!any_of_all(comm, found.has_value()))
    return failure_at(domain, "non-finite", {}, "the energy is not a finite number");
  const int rank = rank_of_largest(comm, key);
  std::vector<std::byte> bytes;
  if (found) bytes = to_bytes(*found);
  broadcast(comm, rank, bytes);
  return failure_from(bytes);
}

/// The column of history.csv in which numerics have made most, and what helps against that.
std::string_view largest_made(const Ledger& ledger, Response response) {
  const double numerical = -(ledger.mapping + ledger.time_integration);
  if (-ledger.contact > std::max(numerical, -ledger.energy_floor))
    return response == Response::impulses ? "contact of history.csv: halve run.cfl"
                                          : "contact of history.csv: give contact.response = "
                                            "\"impulses\", or \"by_matter\" where "
                                            "what flows meets other bodies, or halve run.cfl";
  if (-ledger.energy_floor > numerical)
    return "energy_floor of history.csv: give the material failure = "
           "{ hydrostatic_tension = ... }, or halve run.cfl";
  return ledger.mapping < ledger.time_integration
             ? "numerical_mapping of history.csv: halve run.cfl"
             : "numerical_time of history.csv: halve run.cfl";
}

}  // namespace

template <int D>
void find_failure(Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  bool negative = false;
  for (const PatchSums<D>& s : domain.sums) negative = negative || s.stress.negative_volume;
  negative = any_of_all(*domain.grid.partition.comm, negative);
  if (negative || !std::isfinite(domain.ledger.kinetic) ||
      !std::isfinite(domain.ledger.residual())) {
    bring_home(simulation);
    simulation.failure = first_failure(domain);
    return;
  }
  if (domain.ledger.growth() <= simulation.settings.run.energy_growth_limit) return;
  bring_home(simulation);
  const Limiter fastest = find_limiter(domain);
  std::ostringstream text;
  if (fastest.body < 0)
    text << "no particle takes part any more";
  else
    text << "numerics have made " << domain.ledger.growth()
         << " of the largest energy brought in, most of it in the column "
         << largest_made(domain.ledger, domain.contact_settings.response)
         << "; or raise run.energy_growth_limit if that is meant";
  simulation.failure = failure_at(domain, "energy growth", fastest, text.str());
}

template <int D>
Failure failure_at(const Domain<D>& domain, const std::string& kind, const ParticleAt& at,
                   const std::string& what) {
  Failure f{kind, at.body, at.particle, domain.step, domain.time, at.position, {}};
  std::ostringstream text;
  text << kind << " at step " << f.step << ", t = " << f.time << " s: " << what;
  if (at.body >= 0) {
    text << " (body \"" << domain.body_at(at.body).name << "\", particle " << f.particle << ", at";
    for (std::size_t a = 0; a < D; ++a) text << ' ' << at.position[a];
    text << " m)";
  }
  f.message = text.str();
  return f;
}

std::vector<std::byte> to_bytes(const Failure& f) {
  Letter letter;
  for (const std::string* text : {&f.kind, &f.message}) {
    write(letter, text->size());
    for (const char c : *text) write(letter, c);
  }
  write(letter, ParticleAt{f.body, f.particle, f.position});
  write(letter, f.step);
  write(letter, f.time);
  return letter.bytes;
}

Failure failure_from(std::span<const std::byte> bytes) {
  const Letter letter{0, {bytes.begin(), bytes.end()}};
  Reader reader(letter);
  Failure f;
  for (std::string* text : {&f.kind, &f.message}) {
    text->resize(reader.read<std::size_t>());
    for (char& c : *text) c = reader.read<char>();
  }
  const auto at = reader.read<ParticleAt>();
  f.body = at.body;
  f.particle = at.particle;
  f.position = at.position;
  f.step = reader.read<std::int64_t>();
  f.time = reader.read<double>();
  return f;
}

template void find_failure<2>(Simulation<2>&);
template void find_failure<3>(Simulation<3>&);
template Failure failure_at<2>(const Domain<2>&, const std::string&, const ParticleAt&,
                               const std::string&);
template Failure failure_at<3>(const Domain<3>&, const std::string&, const ParticleAt&,
                               const std::string&);

}  // namespace mpm
