// What a frame holds of the bodies: columns rounded to floats, without room for doubles between.
//
// This file is compiled without fused multiply-add, so that the invariants of the stress have the
// bits of their formulas on any processor.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "mpm/run/derived_fields.hpp"
#include "mpm/run/simulation_of.hpp"

namespace mpm {

template <int D>
void SimulationOf<D>::round_column(const std::string& name, std::span<const int> places,
                                   std::size_t width, std::span<float> to) const {
  std::size_t first = 0;  // of the body's particles
  for (std::size_t number = 0; number < domain_.bodies.size(); ++number) {
    const Body<D>& b = domain_.bodies[number];
    const ParticlePool<D>& of = pool(b);
    const auto& infos = of.columns.infos();
    const auto info = std::find_if(infos.begin(), infos.end(),
                                   [&](const ColumnInfo& i) { return i.name == name; });
    const std::size_t end = first + b.count;
    if (to.size() < end * width) throw std::invalid_argument("round_column: wrong size");
    if (info != infos.end()) {
      if (places.size() != static_cast<std::size_t>(info->components) ||
          !std::ranges::all_of(places, [&](int k) { return 0 <= k && std::cmp_less(k, width); }))
        throw std::invalid_argument("round_column: wrong places");
      for (int c = 0; c < info->components; ++c) {
        const auto place = static_cast<std::size_t>(places[static_cast<std::size_t>(c)]);
        float* const begin = to.data() + first * width + place;
        of.columns.with_component(info->first + c, [&](const auto* from) {
          for_each_row(domain_.grid.patches, of, static_cast<int>(number), [&](std::uint32_t row) {
            begin[of.id[row] * width] = static_cast<float>(from[row]);
          });
        });
      }
    }
    first = end;
  }
}

template <int D>
void SimulationOf<D>::round_derived(const std::string& name, std::span<float> to) const {
  const auto field = std::ranges::find(derived_fields, name, &DerivedField::name);
  if (field == derived_fields.end())
    throw std::invalid_argument("no derived field is named " + name);
  std::size_t first = 0;
  for (std::size_t number = 0; number < domain_.bodies.size(); ++number) {
    const Body<D>& b = domain_.bodies[number];
    const ParticlePool<D>& of = pool(b);
    const std::size_t end = first + b.count;
    if (to.size() < end) throw std::invalid_argument("round_derived: wrong size");
    for_each_row(domain_.grid.patches, of, static_cast<int>(number), [&](std::uint32_t row) {
      ParticleState p{{}, of.mass()[row] / b.initial_density, D};
      for (int c = 0; c < Sym<double, D>::size; ++c)
        p.stress[D == 2 && c == 3 ? 5 : c] = of.stress(c)[row];
      to[first + of.id[row]] = static_cast<float>(field->value(p));
    });
    first = end;
  }
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
