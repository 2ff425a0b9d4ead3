#include "mpm/run/probes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mpm/comm/all_sums.hpp"
#include "mpm/run/derived_fields.hpp"

namespace mpm {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

/// A field: a column, or one that follows from the stress.
struct SeenField {
  std::string name;
  const DerivedField* derived = nullptr;
  bool is_stress = false;
  int components = 1;
};

template <int D>
SeenField field_named(const Domain<D>& domain, const std::string& name) {
  const auto derived = std::ranges::find(derived_fields, name, &DerivedField::name);
  if (derived != derived_fields.end()) return {name, &*derived, false, derived->components};
  if (name == "stress") return {name, nullptr, true, 6};
  for (const ParticlePool<D>& pool : domain.pools)
    for (const ColumnInfo& info : pool.columns.infos())
      if (info.name == name) return {name, nullptr, false, info.components};
  throw std::invalid_argument("no field is named " + name);
}

/// Where a column stands among the components of each pool, or -1; 0 for what is no column.
template <int D>
std::vector<int> first_components(const Domain<D>& domain, const SeenField& field) {
  std::vector<int> firsts;
  for (const ParticlePool<D>& pool : domain.pools) {
    const auto info = std::ranges::find(pool.columns.infos(), field.name, &ColumnInfo::name);
    const bool is_column = field.derived == nullptr && !field.is_stress;
    firsts.push_back(!is_column ? 0 : info == pool.columns.infos().end() ? -1 : info->first);
  }
  return firsts;
}

/// f(component, value) for what a particle has of a field; `first` of its pool.
template <int D, class F>
void for_each_value(const Domain<D>& domain, const Body<D>& body, const ParticlePool<D>& pool,
                    std::uint32_t row, const SeenField& field, int first, F&& f) {
  if (field.derived != nullptr || field.is_stress) {
    const ParticleState p = particle_state(domain, body, pool, row);
    for (int c = 0; c < field.components; ++c)
      f(c, field.is_stress ? p.stress[c] : field.derived->value(p, c));
    return;
  }
  if (first < 0) return;
  for (int c = 0; c < field.components; ++c)
    pool.columns.with_component(first + c, [&](const auto* from) { f(c, double{from[row]}); });
}

/// The weight with which a probe sees a particle, 0 if it does not.
template <int D>
double weight_of(const Probe& probe, const ParticlePool<D>& pool, std::uint32_t row,
                 double cell_size) {
  if (probe.kind == ProbeKind::particle && std::cmp_not_equal(pool.id[row], probe.particle))
    return 0.0;
  double weight = pool.mass()[row];
  for (int a = 0; a < D; ++a) {
    const double x = pool.x(a)[row];
    const auto axis = static_cast<std::size_t>(a);
    if (probe.kind == ProbeKind::point)
      weight *= std::max(0.0, 1.0 - std::abs(x - probe.lower[axis]) / cell_size);
    else if (probe.kind == ProbeKind::region)
      weight *= probe.lower[axis] <= x && x <= probe.upper[axis] ? 1.0 : 0.0;
  }
  return weight;
}

/// Can a probe see particles of a patch, which lie in its tile? Where nodes lie in the body the
/// tile says where particles were.
template <int D>
bool reaches(const Domain<D>& domain, const Probe& probe, const Patch<D>& patch) {
  if (patch.keeps) return true;
  if (probe.kind != ProbeKind::point && probe.kind != ProbeKind::region) return true;
  const auto& grid = domain.grid;
  const double wide = probe.kind == ProbeKind::point ? grid.cell_size : 0.0;
  const auto& to = probe.kind == ProbeKind::point ? probe.lower : probe.upper;
  const Vec<double, D> first = grid.position_of(grid.first_cell(patch.tile));
  for (std::size_t a = 0; a < D; ++a) {
    // A cell more on either side: particles of cells that are centred at nodes, and rounding.
    const double low = first[static_cast<int>(a)] - grid.cell_size - wide;
    const double high = first[static_cast<int>(a)] + (Tile<D>::cells + 1) * grid.cell_size + wide;
    if (to[a] < low || probe.lower[a] > high) return false;
  }
  return true;
}

/// Which bodies are among some.
template <int D>
std::vector<std::uint8_t> marked(const Domain<D>& domain, const std::vector<int>& bodies) {
  std::vector<std::uint8_t> wanted(domain.bodies.size());
  for (const int body : bodies) wanted.at(static_cast<std::size_t>(body)) = 1;
  return wanted;
}

/// What has been seen of a component in a patch, in the order of its particles, whichever thread.
struct SeenComponent {
  double weight = 0.0, sum = 0.0, least = none, largest = -none;
};
struct PatchSeen {
  std::int64_t count = 0;
  double mass = 0.0;
  std::vector<SeenComponent> components;
};

/// What a probe looks for, and where it stands.
struct Fields {
  std::vector<SeenField> all;
  std::vector<std::vector<int>> firsts;  // of each, by pools
  std::size_t components = 0;
};
template <int D>
Fields fields_of(const Domain<D>& domain, const Probe& probe) {
  Fields fields;
  for (const std::string& name : probe.fields) {
    const SeenField& field = fields.all.emplace_back(field_named(domain, name));
    fields.firsts.push_back(first_components(domain, field));
    fields.components += static_cast<std::size_t>(field.components);
  }
  return fields;
}

template <int D>
PatchSeen seen_in(const Domain<D>& domain, const Probe& probe, const Patch<D>& patch,
                  const Fields& fields) {
  PatchSeen part;
  if (!reaches(domain, probe, patch)) return part;
  const Body<D>& body = domain.body_of(patch);
  const ParticlePool<D>& pool = domain.pool_of(patch);
  const auto pool_number = static_cast<std::size_t>(body.material);
  for (const std::uint32_t row : pool.rows(patch)) {
    const double weight = weight_of(probe, pool, row, domain.grid.cell_size);
    if (weight == 0.0) continue;
    part.components.resize(fields.components);
    ++part.count;
    part.mass += pool.mass()[row];
    SeenComponent* of_field = part.components.data();
    for (std::size_t k = 0; k < fields.all.size(); of_field += fields.all[k++].components)
      for_each_value(domain, body, pool, row, fields.all[k], fields.firsts[k][pool_number],
                     [&](int c, double value) {
                       SeenComponent& of = of_field[c];
                       of.weight += weight;
                       of.sum += weight * value;
                       of.least = std::min(of.least, value);
                       of.largest = std::max(of.largest, value);
                     });
  }
  return part;
}

}  // namespace

template <int D>
std::vector<double> look(Domain<D>& domain, const Probe& probe) {
  const Fields fields = fields_of(domain, probe);
  const std::vector<std::uint8_t> wanted = marked(domain, probe.bodies);
  const auto& patches = domain.grid.patches;
  const std::size_t components = fields.components;
  std::vector<PatchSeen> parts(patches.size());
  domain.threads.for_each(patches.size(), [&](std::size_t p) {
    if (wanted[static_cast<std::size_t>(patches[p].body)] != 0)
      parts[p] = seen_in(domain, probe, patches[p], fields);
  });
  std::int64_t count = 0;
  std::vector<ExactSum> sums(1 + 2 * components);  // mass; weight and sum of each component
  std::vector<double> ends(2 * components, -none);
  for (const PatchSeen& part : parts) {
    if (part.count == 0) continue;
    count += part.count;
    sums[0].add(part.mass);
    for (std::size_t k = 0; k < components; ++k) {
      const SeenComponent& of = part.components[k];
      sums[1 + 2 * k].add(of.weight);
      sums[2 + 2 * k].add(of.sum);
      ends[2 * k] = std::max(ends[2 * k], -of.least);
      ends[2 * k + 1] = std::max(ends[2 * k + 1], of.largest);
    }
  }
  Comm& comm = *domain.grid.partition.comm;
  all_sum(comm, sums);
  comm.all_max(ends);
  std::vector<double> told{static_cast<double>(all_sum(comm, count)), sums[0].value()};
  for (std::size_t k = 0; k < components; ++k) {
    const double weight = sums[1 + 2 * k].value();
    const bool any = weight > 0.0;
    told.push_back(any ? sums[2 + 2 * k].value() / weight : std::nan(""));
    told.push_back(any ? -ends[2 * k] : std::nan(""));
    told.push_back(any ? ends[2 * k + 1] : std::nan(""));
  }
  return told;
}

template <int D>
std::optional<std::array<std::int64_t, 2>> nearest_particle(const Domain<D>& domain,
                                                            const std::vector<int>& bodies,
                                                            const std::array<double, 3>& place) {
  // The key of which the least is wanted: distance squared, body, number.
  std::array<double, 3> best{none, none, none};
  const std::vector<std::uint8_t> wanted = marked(domain, bodies);
  for (const Patch<D>& patch : domain.grid.patches) {
    if (wanted[static_cast<std::size_t>(patch.body)] == 0) continue;
    const ParticlePool<D>& pool = domain.pool_of(patch);
    for (const std::uint32_t row : pool.rows(patch)) {
      double square = 0.0;
      for (int a = 0; a < D; ++a) {
        const double d = pool.x(a)[row] - place[static_cast<std::size_t>(a)];
        square += d * d;
      }
      best = std::min(best,
                      {square, static_cast<double>(patch.body), static_cast<double>(pool.id[row])});
    }
  }
  Comm& comm = *domain.grid.partition.comm;
  const int rank = rank_of_largest(comm, {-best[0], -best[1], -best[2]});
  broadcast(comm, rank, best);
  if (best[0] == none) return {};
  return std::array{static_cast<std::int64_t>(best[1]), static_cast<std::int64_t>(best[2])};
}

template std::vector<double> look<2>(Domain<2>&, const Probe&);
template std::vector<double> look<3>(Domain<3>&, const Probe&);
template std::optional<std::array<std::int64_t, 2>> nearest_particle<2>(
    const Domain<2>&, const std::vector<int>&, const std::array<double, 3>&);
template std::optional<std::array<std::int64_t, 2>> nearest_particle<3>(
    const Domain<3>&, const std::vector<int>&, const std::array<double, 3>&);

}  // namespace mpm
