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

/// f(xx, yy, zz, yz, xz, xy) of the stress of each particle.
template <int D>
template <class F>
void SimulationOf<D>::round_stress(std::span<float> to, const F& f) const {
  std::size_t first = 0;
  for (const Body<D>& b : domain_.bodies) {
    const std::size_t end = first + b.count();
    if (to.size() < end) throw std::invalid_argument("round_stress: wrong size");
    for (std::size_t k = 0; k < b.count(); ++k) {
      const auto s = [&](int c) -> double { return b.stress(c)[k]; };
      const double value =
          D == 2 ? f(s(0), s(1), s(2), 0.0, 0.0, s(3)) : f(s(0), s(1), s(2), s(3), s(4), s(5));
      to[first + b.id[k]] = static_cast<float>(value);
    }
    first = end;
  }
}

template <int D>
void SimulationOf<D>::round_pressure(std::span<float> to) const {
  round_stress(to, [](double xx, double yy, double zz, double, double, double) {
    return -(xx + yy + zz) / 3.0;
  });
}

template <int D>
void SimulationOf<D>::round_von_mises(std::span<float> to) const {
  round_stress(to, [](double xx, double yy, double zz, double yz, double xz, double xy) {
    const double a = xx - yy, b = yy - zz, c = zz - xx;
    const double normal = a * a + b * b + c * c, shear = yz * yz + xz * xz + xy * xy;
    return std::sqrt(0.5 * normal + 3.0 * shear);
  });
}

/// The edge of the square or cube that a particle was at the start.
template <int D>
void SimulationOf<D>::round_size(std::span<float> to) const {
  std::size_t first = 0;
  for (const Body<D>& b : domain_.bodies) {
    const std::size_t end = first + b.count();
    if (to.size() < end) throw std::invalid_argument("round_size: wrong size");
    for (std::size_t k = 0; k < b.count(); ++k) {
      const double volume = b.mass()[k] / b.initial_density;
      to[first + b.id[k]] = static_cast<float>(D == 2 ? std::sqrt(volume) : std::cbrt(volume));
    }
    first = end;
  }
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
