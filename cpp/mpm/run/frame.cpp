// This file is compiled without fused multiply-add, so that the invariants of the stress have the
// bits of their formulas on any processor.
#include "mpm/run/frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "mpm/run/derived_fields.hpp"
#include "mpm/run/gather.hpp"

namespace mpm {

namespace {

/// Where the particles of each body stand among all, body by body.
template <int D>
std::vector<std::size_t> first_places(const Domain<D>& domain) {
  std::vector<std::size_t> first{0};
  for (const Body<D>& body : domain.bodies) first.push_back(first.back() + body.count);
  return first;
}

/// f(body, row) for all particles of a pool, those that were removed last.
template <int D, class F>
void for_each_row_of(const Domain<D>& domain, std::size_t pool, F&& f) {
  for (const Patch<D>& patch : domain.grid.patches) {
    const auto b = static_cast<std::size_t>(patch.body);
    if (std::cmp_not_equal(domain.bodies[b].material, pool)) continue;
    for (const std::uint32_t row : domain.pools[pool].rows(patch)) f(b, row);
  }
  for (const RemovedRow& removed : domain.pools[pool].removed)
    f(static_cast<std::size_t>(removed.body), removed.row);
}

}  // namespace

template <int D>
void round_column(const Domain<D>& domain, const Slices& slices, const std::string& name,
                  std::span<const int> places, std::size_t width, std::span<float> to) {
  const std::vector<std::size_t> first = first_places(domain);
  Comm& comm = *domain.grid.partition.comm;
  if (to.size() < slices.of(comm.rank()).count() * width)
    throw std::invalid_argument("round_column: wrong size");
  for (std::size_t m = 0; m < domain.pools.size(); ++m) {
    const ParticlePool<D>& of = domain.pools[m];
    const auto info = std::ranges::find(of.columns.infos(), name, &ColumnInfo::name);
    if (info == of.columns.infos().end()) continue;
    if (places.size() != static_cast<std::size_t>(info->components) ||
        !std::ranges::all_of(places, [&](int k) { return 0 <= k && std::cmp_less(k, width); }))
      throw std::invalid_argument("round_column: wrong places");
    gather(comm, slices, width, places, to, [&](auto&& f) {
      for (int c = 0; c < info->components; ++c)
        of.columns.with_component(info->first + c, [&](const auto* from) {
          for_each_row_of(domain, m, [&](std::size_t b, std::uint32_t row) {
            f(first[b] + of.id[row], static_cast<std::size_t>(c), static_cast<float>(from[row]));
          });
        });
    });
  }
}

template <int D>
void round_derived(const Domain<D>& domain, const Slices& slices, const std::string& name,
                   std::span<float> to) {
  const auto field = std::ranges::find(derived_fields, name, &DerivedField::name);
  if (field == derived_fields.end())
    throw std::invalid_argument("no derived field is named " + name);
  const std::vector<std::size_t> first = first_places(domain);
  Comm& comm = *domain.grid.partition.comm;
  const auto width = static_cast<std::size_t>(field->components);
  if (to.size() < slices.of(comm.rank()).count() * width)
    throw std::invalid_argument("round_derived: wrong size");
  std::vector<int> places(width);
  std::iota(places.begin(), places.end(), 0);
  for (std::size_t m = 0; m < domain.pools.size(); ++m) {
    const ParticlePool<D>& of = domain.pools[m];
    gather(comm, slices, width, places, to, [&](auto&& f) {
      for (int c = 0; c < field->components; ++c)
        for_each_row_of(domain, m, [&](std::size_t b, std::uint32_t row) {
          const ParticleState p = particle_state(domain, domain.bodies[b], of, row);
          f(first[b] + of.id[row], static_cast<std::size_t>(c),
            static_cast<float>(field->value(p, c)));
        });
    });
  }
}

template void round_column<2>(const Domain<2>&, const Slices&, const std::string&,
                              std::span<const int>, std::size_t, std::span<float>);
template void round_column<3>(const Domain<3>&, const Slices&, const std::string&,
                              std::span<const int>, std::size_t, std::span<float>);
template void round_derived<2>(const Domain<2>&, const Slices&, const std::string&,
                               std::span<float>);
template void round_derived<3>(const Domain<3>&, const Slices&, const std::string&,
                               std::span<float>);

}  // namespace mpm
