#pragma once
// The normal of a pair of bodies at a node: every rule, one line in `NormalRules`.
#include <algorithm>

#include "mpm/catalogue/choice_list.hpp"
#include "mpm/contact/separation.hpp"

namespace mpm {

/// Sum of m_p grad N_ip [kg/m] over the particles of a body around a node, counted from the tile's
/// first; it points out of the body. `edge` is the particles' edge at the start [cells].
template <int D>
Vec<double, D> mass_gradient(const TileParticles<D>& particles, const Index<D>& node,
                             const TileGrid<D>& grid, double edge) {
  using T = Batch<contact_lanes>;
  Vec<T, D> total = Vec<T, D>::zero();
  Bases::with(grid.basis, edge, [&]<BasisModel B>(const B& basis) {
    particles.around(node, [&](const Index<D>& place, const auto& lanes) {
      for (int a = 0; a < D; ++a) {
        T g = lanes.mass;
        for (int b = 0; b < D; ++b) {
          const auto w = basis.along(lanes.xi[b]);
          const int k = place[static_cast<std::size_t>(b)] + B::before;
          g = g * (b == a ? w.dN[k] : w.N[k]);
        }
        // By x_p, at the particle: N_i rises towards the node, so the sum points from the body's
        // mass to the node, outwards.
        total[a] += g;
      }
    });
  });
  Vec<double, D> r;
  for (int a = 0; a < D; ++a) r[a] = sum(total[a]) / grid.cell_size;
  return r;
}

/// The outward unit normal of a body at a node, times min(1, |gradient| h / mass): one where the
/// body ends at the node, near zero where the body surrounds it and the direction of its gradient
/// is chance.
template <int D>
Vec<double, D> weighted_normal(const Vec<double, D>& gradient, double mass, double cell_size) {
  const double length = norm(gradient);
  return length > 0.0 ? (std::min(1.0, length * cell_size / mass) / length) * gradient
                      : Vec<double, D>::zero();
}

/// What a normal is made of, of one body at a node.
template <int D>
struct NormalSource {
  int body;
  double stiffness;  // rho c^2 of its material [Pa]
  NearParticles<D> particles;
  Vec<double, D> normal;  // from the gradient of mass (weighted_normal); zero for `plane`
};

/// A rule for the unit normal from body r to body s, zero if there is none; `constrained` are axes
/// that walls hold. One that uses gradients of mass finds them in NormalSource::normal.
template <class T>
concept NormalModel = requires(const NormalSource<3>& source, unsigned constrained) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::doc } -> std::convertible_to<std::string_view>;
  { T::uses_gradients } -> std::convertible_to<bool>;
  { T::normal(source, source, constrained) } -> std::same_as<Vec<double, 3>>;
};

/// Decisions 0008 and 0032.
struct PlaneNormal {
  static constexpr std::string_view name = "plane";
  static constexpr std::string_view doc = "of the plane which separates the two bodies' points";
  static constexpr bool uses_gradients = false;

  template <int D>
  static Vec<double, D> normal(const NormalSource<D>& r, const NormalSource<D>& s,
                               unsigned constrained) {
    return separating_normal(r.particles, s.particles, constrained);
  }
};

/// n_r - n_s, the paper's.
struct PairNormal {
  static constexpr std::string_view name = "pair";
  static constexpr std::string_view doc = "from the gradients of mass of both, n_r - n_s";
  static constexpr bool uses_gradients = true;

  template <int D>
  static Vec<double, D> normal(const NormalSource<D>& r, const NormalSource<D>& s, unsigned) {
    constexpr double parallel = 1e-6;  // normals that differ by less give no direction
    return normalised(r.normal - s.normal, parallel);
  }
};

/// From the gradient of mass of one of the two: r's if `takes_r`.
template <int D>
Vec<double, D> normal_of_one(const NormalSource<D>& r, const NormalSource<D>& s, bool takes_r) {
  return normalised(takes_r ? r.normal : -1.0 * s.normal);
}

struct FirstNormal {
  static constexpr std::string_view name = "first";
  static constexpr std::string_view doc = "from that of the first";
  static constexpr bool uses_gradients = true;

  template <int D>
  static Vec<double, D> normal(const NormalSource<D>& r, const NormalSource<D>& s, unsigned) {
    return normal_of_one(r, s, r.body < s.body);
  }
};

struct SecondNormal {
  static constexpr std::string_view name = "second";
  static constexpr std::string_view doc = "from that of the second";
  static constexpr bool uses_gradients = true;

  template <int D>
  static Vec<double, D> normal(const NormalSource<D>& r, const NormalSource<D>& s, unsigned) {
    return normal_of_one(r, s, r.body > s.body);
  }
};

/// Of two that are alike the first.
struct StifferNormal {
  static constexpr std::string_view name = "stiffer";
  static constexpr std::string_view doc = "from that of the stiffer";
  static constexpr bool uses_gradients = true;

  template <int D>
  static Vec<double, D> normal(const NormalSource<D>& r, const NormalSource<D>& s, unsigned) {
    const bool alike = r.stiffness == s.stiffness;
    return normal_of_one(r, s, alike ? r.body < s.body : r.stiffness > s.stiffness);
  }
};

enum class NormalRule : std::uint8_t {};
template <NormalModel... T>
using NormalList = ChoiceList<NormalRule, T...>;
using NormalRules = NormalList<PlaneNormal, PairNormal, FirstNormal, SecondNormal, StifferNormal>;
template <>
inline constexpr auto words<NormalRule> = NormalRules::words_of();

}  // namespace mpm
