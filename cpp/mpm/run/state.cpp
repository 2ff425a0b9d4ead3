// The part of a simulation that says what its bodies, pairs and columns have come to.
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "mpm/run/simulation_of.hpp"

namespace mpm {
namespace {

template <int D>
double speed_of(const ParticlePool<D>& pool, std::size_t row) {
  double squared = 0.0;
  for (int a = 0; a < D; ++a) squared += pool.v(a)[row] * pool.v(a)[row];
  return std::sqrt(squared);
}

}  // namespace

/// Of the fastest wave in a particle [m/s]; 0 in a rigid body, which limits no time step.
template <int D>
double SimulationOf<D>::wave_speed(const Body<D>& b, std::size_t row) const {
  if (!b.deforms()) return 0.0;
  const Material& material = domain_.materials[static_cast<std::size_t>(b.material)];
  return sound_speed<D>(material, pool(b).columns, pool(b).at, row, domain_.grid.cell_size);
}

template <int D>
void SimulationOf<D>::probe_speeds() {
  for (PatchSums<D>& s : domain_.sums) s.stress.fastest = 0.0;
  domain_.sums.resize(domain_.grid.patches.size());
  for (std::size_t p = 0; p < domain_.grid.patches.size(); ++p) {
    const Patch<D>& patch = domain_.grid.patches[p];
    const Body<D>& b = domain_.body_of(patch);
    for (const std::uint32_t row : pool(b).rows(patch)) {
      double& fastest = domain_.sums[p].stress.fastest;
      fastest = std::max(fastest, wave_speed(b, row) + speed_of(pool(b), row));
    }
  }
  choose_time_step();
}

template <int D>
std::vector<PairRecord> SimulationOf<D>::group_pairs() const {
  std::map<std::pair<int, int>, PairRecord> found;
  for (const PairRecord& pair : pairs()) {
    const int a = body(pair.a).group, b = body(pair.b).group;
    const auto key = std::minmax(a, b);
    PairRecord& sum = found.try_emplace(key).first->second;
    sum.a = key.first;
    sum.b = key.second;
    ++sum.pairs;
    sum.friction_work += pair.friction_work;
    const double sign = a < b ? 1.0 : a > b ? -1.0 : 0.0;
    if (pair.first_step >= 0 && (sum.first_step < 0 || pair.first_step < sum.first_step)) {
      sum.first_step = pair.first_step;
      sum.first_time = pair.first_time;
      sum.first_gap = pair.first_gap;
      sum.first_share = pair.first_share;
      for (int k = 0; k < 3; ++k) {
        sum.first_normal[k] = (a > b ? -1.0 : 1.0) * pair.first_normal[k];
        sum.first_node[k] = pair.first_node[k];
      }
    }
    for (int k = 0; k < 3; ++k) {
      sum.force[k] += sign * pair.force[k];
      sum.impulse[k] += sign * pair.impulse[k];
    }
  }
  std::vector<PairRecord> records;
  records.reserve(found.size());
  for (const auto& [key, sum] : found) records.push_back(sum);
  return records;
}

template <int D>
double SimulationOf<D>::total_mass() const {
  double total = 0.0;
  for_each_particle([&](const ParticlePool<D>& of, std::uint32_t row) { total += of.mass()[row]; });
  for (const ParticlePool<D>& of : domain_.pools)
    for (const RemovedRow& removed : of.removed) total += of.mass()[removed.row];
  return total;
}

template <int D>
double SimulationOf<D>::kinetic_energy() const {
  double total = 0.0;
  for_each_particle([&](const ParticlePool<D>& of, std::uint32_t row) {
    for (int a = 0; a < D; ++a) total += 0.5 * of.mass()[row] * of.v(a)[row] * of.v(a)[row];
  });
  return total;
}

template <int D>
std::array<double, 3> SimulationOf<D>::momentum() const {
  std::array<double, 3> total{};
  for_each_particle([&](const ParticlePool<D>& of, std::uint32_t row) {
    for (std::size_t a = 0; a < D; ++a) total[a] += of.mass()[row] * of.v(static_cast<int>(a))[row];
  });
  return total;
}

template <int D>
Limiter SimulationOf<D>::limiter() const {
  Limiter result;
  if (domain_.sums.empty() || domain_.sums.size() != domain_.grid.patches.size()) return result;
  std::size_t fastest = 0;
  for (std::size_t p = 1; p < domain_.sums.size(); ++p)
    if (domain_.sums[p].stress.fastest > domain_.sums[fastest].stress.fastest) fastest = p;
  const Patch<D>& patch = domain_.grid.patches[fastest];
  const Body<D>& b = body(patch.body);
  for (const std::uint32_t row : pool(b).rows(patch)) {
    const double c = wave_speed(b, row), v = speed_of(pool(b), row);
    if (c + v > result.sound_speed + result.speed || result.body < 0)
      result = {patch.body, static_cast<std::int64_t>(pool(b).id[row]), c, v};
  }
  return result;
}

template <int D>
Bytes SimulationOf<D>::bytes() const {
  Bytes r;
  for (const ParticlePool<D>& of : domain_.pools) r.particles += of.bytes();
  r.particles += domain_.list_scratch.bytes();
  r.grid = bytes_of(domain_.grid);
  if (domain_.has_contact()) r.contact = bytes_of(domain_.contact);
  r.other = domain_.sums.capacity() * sizeof(PatchSums<D>) + history_.capacity() * sizeof(double);
  return r;
}

template <int D>
int SimulationOf<D>::column_components(int b, const std::string& name) const {
  return name == "stress" ? 6 : pool(body(b)).columns.info(name).components;
}

template <int D>
void SimulationOf<D>::copy_column(int number, const std::string& name, std::span<double> to) const {
  const Body<D>& b = body(number);
  const ParticlePool<D>& of = pool(b);
  const ColumnInfo& info = of.columns.info(name);
  const auto width = static_cast<std::size_t>(column_components(number, name));
  if (to.size() != b.count * width) throw std::invalid_argument("copy_column: wrong size");
  std::fill(to.begin(), to.end(), 0.0);
  for (int c = 0; c < info.components; ++c) {
    // Plane strain keeps xx yy zz xy; the fourth becomes the sixth of xx yy zz yz xz xy.
    const auto place = static_cast<std::size_t>(name == "stress" && D == 2 && c == 3 ? 5 : c);
    of.columns.with_component(info.first + c, [&](const auto* from) {
      for_each_row(domain_.grid.patches, of, number, b.removed,
                   [&](std::uint32_t row) { to[of.id[row] * width + place] = from[row]; });
    });
  }
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
