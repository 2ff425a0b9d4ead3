// What a frame holds of the bodies: columns rounded to floats, without room for doubles between.
//
// This file is compiled without fused multiply-add, so that the invariants of the stress have the
// bits of their formulas on any processor.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "mpm/run/simulation_of.hpp"

namespace mpm {

template <int D>
void SimulationOf<D>::round_column(const std::string& name, std::span<const int> places,
                                   std::size_t width, std::span<float> to) const {
  std::size_t first = 0;  // of the body's particles
  for (const Body<D>& b : domain_.bodies) {
    const auto& infos = b.columns.infos();
    const auto info = std::find_if(infos.begin(), infos.end(),
                                   [&](const ColumnInfo& i) { return i.name == name; });
    const std::size_t end = first + b.count();
    if (to.size() < end * width) throw std::invalid_argument("round_column: wrong size");
    if (info != infos.end()) {
      if (places.size() != static_cast<std::size_t>(info->components) ||
          !std::ranges::all_of(places, [&](int k) { return 0 <= k && std::cmp_less(k, width); }))
        throw std::invalid_argument("round_column: wrong places");
      for (int c = 0; c < info->components; ++c) {
        const auto place = static_cast<std::size_t>(places[static_cast<std::size_t>(c)]);
        float* const begin = to.data() + first * width + place;
        b.columns.with_component(info->first + c, [&](const auto* from) {
          for (std::size_t k = 0; k < b.count(); ++k)
            begin[b.id[k] * width] = static_cast<float>(from[k]);
        });
      }
    }
    first = end;
  }
}

template <int D>
void SimulationOf<D>::round_invariants(std::span<float> pressure,
                                       std::span<float> von_mises) const {
  std::size_t first = 0;
  for (const Body<D>& b : domain_.bodies) {
    const std::size_t end = first + b.count();
    if (std::min(pressure.size(), von_mises.size()) < end)
      throw std::invalid_argument("round_invariants: wrong size");
    for (std::size_t k = 0; k < b.count(); ++k) {
      const auto s = [&](int c) -> double { return b.stress(c)[k]; };
      const double xx = s(0), yy = s(1), zz = s(2);
      const double yz = D == 3 ? s(3) : 0.0, xz = D == 3 ? s(4) : 0.0, xy = D == 3 ? s(5) : s(3);
      const double a = xx - yy, c = yy - zz, d = zz - xx;
      const double normal = a * a + c * c + d * d, shear = yz * yz + xz * xz + xy * xy;
      pressure[first + b.id[k]] = static_cast<float>(-(xx + yy + zz) / 3.0);
      von_mises[first + b.id[k]] = static_cast<float>(std::sqrt(0.5 * normal + 3.0 * shear));
    }
    first = end;
  }
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
