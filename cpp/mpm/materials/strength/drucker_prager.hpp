#pragma once
#include <array>

#include "mpm/materials/elastic_plastic.hpp"

namespace mpm {

/// Drucker and Prager's soil: elastic, yielding at tau + q_phi sm = k_phi, tau = sqrt(s:s/2), sm
/// the mean stress, with dilation by q_psi, and at the tension sm = tension.
struct DruckerPrager : ElasticPlastic<DruckerPrager> {
  using Self = DruckerPrager;
  static constexpr std::string_view name = "drucker_prager";
  static constexpr std::string_view doc =
      "soil and rock, yielding at sqrt(J2) + q_phi sm = k_phi (sm the mean stress) and at "
      "sm = tension, with plastic dilation by q_psi; through the outer corners of Mohr and "
      "Coulomb: q = 6 sin(phi) / (sqrt(3) (3 - sin(phi))), "
      "k = 6 c cos(phi) / (sqrt(3) (3 - sin(phi)))";
  static constexpr std::string_view source =
      "Drucker & Prager 1952; the corner of shear and tension by Koiter 1953";
  static constexpr EosUse eos = EosUse::never;
  static constexpr bool breaks_up = true;

  double E{}, nu{}, q_phi{}, k_phi{}, q_psi{}, tension{};
  double K{}, limit{};  // limit: of the mean stress in tension

  static constexpr auto params = std::array{
      youngs_modulus(&Self::E),
      poissons_ratio(&Self::nu),
      Param<Self>{"q_phi", &Self::q_phi, "", "friction", Rule::not_negative},
      Param<Self>{"k_phi", &Self::k_phi, "Pa", "cohesion", Rule::not_negative},
      Param<Self>{"q_psi", &Self::q_psi, "", "dilation; 0 for none", Rule::not_negative, 0.0},
      Param<Self>{"tension", &Self::tension, "Pa",
                  "largest mean tension; never more than the apex k_phi / q_phi",
                  Rule::not_negative, 0.0},
  };

  void prepare(double density) {
    ElasticPlastic::prepare(density);
    K = elastic.lambda + 2.0 / 3.0 * elastic.G;
    limit = q_phi > 0.0 ? min(tension, k_phi / q_phi) : tension;
  }
  std::string problem() const {
    if (q_psi > q_phi) return "drucker_prager.q_psi must be <= q_phi, or flow would make energy";
    return {};
  }

  /// Shear flow keeps tau + q_phi sm = k_phi by (tau, sm) -= d (G, K q_psi); tension is cut at
  /// `limit`, and beyond the corner of the two both hold. The plastic strain grows by
  /// d sqrt(1/3 + 2/9 q_psi^2) in shear and by the cut strain in tension.
  template <Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>& motion, Sym<T, D>& stress,
                  State<T, D>& state) const {
    elastic.update(motion, stress);
    const T mean = T(1.0 / 3.0) * trace(stress);
    const Sym<T, D> deviator = stress - Sym<T, D>::isotropic(mean);
    const T tau = sqrt(T(0.5) * inner(deviator, deviator));
    const T over = max(tau + T(q_phi) * mean - T(k_phi), T(0.0));
    const T shear_flow = over * T(1.0 / (elastic.G + K * q_phi * q_psi));
    T tau_after = tau - T(elastic.G) * shear_flow;
    T mean_after = mean - T(K * q_psi) * shear_flow;
    // In tension the mean is cut first, and tau then to the cone at that mean. That is the exact
    // return: a shear return that ends beyond the limit would end on the cone below the corner, so
    // it takes more shear flow than the corner does, and the tension flow left there is positive.
    const T corner(max(0.0, k_phi - q_phi * limit));
    const auto tensile = mean_after > T(limit);
    mean_after = min(mean_after, T(limit));
    tau_after = select(tensile, min(tau, corner), tau_after);
    const T factor = select(tau > tau_after, tau_after / max(tau, T(tiny)), T(1.0));
    stress = Sym<T, D>::isotropic(mean_after) + factor * deviator;
    const T slid = (tau - tau_after) * T(1.0 / elastic.G);
    const T opened = (mean - mean_after) * T(1.0 / K);
    state.plastic_strain += sqrt(T(1.0 / 3.0) * slid * slid + T(2.0 / 9.0) * opened * opened);
    return tau_after * slid + mean_after * opened;
  }
};

}  // namespace mpm
