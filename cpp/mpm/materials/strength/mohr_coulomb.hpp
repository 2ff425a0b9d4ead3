#pragma once
#include <array>
#include <numbers>

#include "mpm/materials/elastic_plastic.hpp"
#include "mpm/math/eigen.hpp"

namespace mpm {

/// Mohr and Coulomb's soil: elastic, yielding where the principal stresses s1 >= s2 >= s3 (tension
/// positive) meet k s1 - s3 = 2 c sqrt(k), k = (1 + sin(phi)) / (1 - sin(phi)), or s1 = tension.
struct MohrCoulomb : ElasticPlastic<MohrCoulomb> {
  using Self = MohrCoulomb;
  static constexpr std::string_view name = "mohr_coulomb";
  static constexpr std::string_view doc =
      "soil and rock, yielding at s1 (1 + sin(phi)) - s3 (1 - sin(phi)) = 2 c cos(phi) (s1 >= s2 "
      ">= s3 the principal stresses, tension positive) and at s1 = tension, perfectly plastic, "
      "with plastic dilation by psi";
  static constexpr std::string_view source =
      "Coulomb 1773; return by regions after Clausen, Damkilde & Andersen 2006";
  static constexpr EosUse eos = EosUse::never;
  static constexpr bool breaks_up = true;
  // Ten roundings of the principal stresses, there and back, and the return's; and where stresses
  // vanish half a rounding of E, of which the elastic step has made them.
  static constexpr double rounding_of_stress = 1e-14, rounding_of_modulus = 1e-16;

  double E{}, nu{}, cohesion{}, friction_angle{}, dilation_angle{}, tension{};
  double k{}, m{};             // (1 + sin) / (1 - sin) of friction and dilation
  double strength{}, limit{};  // 2 c sqrt(k) [Pa]; largest principal stress [Pa]

  static constexpr auto params = std::array{
      youngs_modulus(&Self::E),
      poissons_ratio(&Self::nu),
      Param<Self>{"cohesion", &Self::cohesion, "Pa", "cohesion c", Rule::not_negative},
      Param<Self>{"friction_angle", &Self::friction_angle, "rad",
                  "angle of internal friction phi, < 90 deg", Rule::not_negative},
      Param<Self>{"dilation_angle", &Self::dilation_angle, "rad",
                  "angle of dilation psi, at most that of friction; 0 for none", Rule::not_negative,
                  0.0},
      Param<Self>{"tension", &Self::tension, "Pa",
                  "largest principal tension; never more than the apex c cot(phi)",
                  Rule::not_negative, 0.0},
  };

  void prepare(double density) {
    ElasticPlastic::prepare(density);
    const double friction = std::sin(friction_angle), dilation = std::sin(dilation_angle);
    k = (1.0 + friction) / (1.0 - friction);
    m = (1.0 + dilation) / (1.0 - dilation);
    strength = 2.0 * cohesion * std::sqrt(k);
    // A tension beyond the apex c cot(phi) would bound nothing: no admissible stress is there.
    limit = friction > 0.0 ? min(tension, cohesion / std::tan(friction_angle)) : tension;
  }
  std::string problem() const {
    if (!(friction_angle < 0.5 * std::numbers::pi))
      return "mohr_coulomb.friction_angle must be < 90 deg; a number without unit is in rad";
    if (dilation_angle > friction_angle)
      return "mohr_coulomb.dilation_angle must be <= friction_angle, or flow would make energy";
    return {};
  }

  /// Principal stresses after a return, and how far it is from an admissible one [Pa].
  template <class T>
  struct Candidate {
    T stress[3], fault;
  };

  /// D^-1 (trial - stress): the plastic strain, times 2 G, that takes a trial to another stress.
  template <Real T>
  MPM_HD void plastic(const T (&trial)[3], const T (&stress)[3], T (&e)[3]) const {
    T sum(0.0);
    for (int i = 0; i < 3; ++i) sum = sum + (e[i] = trial[i] - stress[i]);
    // Hooke backwards: 2 G e = s - nu / (1 + nu) tr(s).
    for (int i = 0; i < 3; ++i) e[i] = e[i] - T(nu / (1.0 + nu)) * sum;
  }

  /// The trial less flow by `a` along the first vector and `b` along the second, times 2 G.
  template <Real T>
  MPM_HD Candidate<T> moved(const T (&trial)[3], T a, const double (&first)[3], T b,
                            const double (&second)[3]) const {
    // D b = 2 G (b + lambda / 2 G tr(b)): all multipliers are in Pa, times 2 G, so that as faults
    // they can be compared with stresses.
    const double ratio = nu / (1.0 - 2.0 * nu);  // lambda / 2 G
    const double sum_a = ratio * (first[0] + first[1] + first[2]);
    const double sum_b = ratio * (second[0] + second[1] + second[2]);
    Candidate<T> r;
    for (int i = 0; i < 3; ++i)
      r.stress[i] = trial[i] - T(first[i] + sum_a) * a - T(second[i] + sum_b) * b;
    return r;
  }

  /// The return of principal trial stresses in falling order that lie outside. Yield surface and
  /// flow are made of planes, so the return ends on one of nine faces, edges and corners; each is
  /// tried, and the one is taken that obeys the yield conditions, keeps the order of the stresses
  /// and needs no flow backwards (Koiter 1953). Just one does, but where two meet: there they give
  /// the same stress, so the least fault decides.
  template <Real T>
  MPM_HD void return_to_surface(const T (&trial)[3], T (&stress)[3]) const {
    T least(std::numeric_limits<double>::max());
    for (int i = 0; i < 3; ++i) stress[i] = trial[i];
    // Nine tries and a select in place of a search for the region: lanes of all regions take one
    // way.
    const auto try_one = [&](Candidate<T> c) {
      const T order = max(c.stress[1] - c.stress[0], c.stress[2] - c.stress[1]);
      const T shear = (T(k) * c.stress[0] - c.stress[2] - T(strength)) * T(1.0 / k);
      // Each try brings the sign of its own multipliers; order and yield conditions are asked of
      // all.
      c.fault = max(max(c.fault, order), max(shear, c.stress[0] - T(limit)));
      const auto better = c.fault < least;
      least = select(better, c.fault, least);
      for (int i = 0; i < 3; ++i) stress[i] = select(better, c.stress[i], stress[i]);
    };
    by_shear(trial, try_one);
    by_tension(trial, try_one);
    by_both(trial, try_one);
  }

  /// Shear: the face, the edge s1 = s2 (triaxial extension), the edge s2 = s3 (compression).
  template <Real T, class Try>
  MPM_HD void by_shear(const T (&trial)[3], const Try& try_one) const {
    const double ratio = nu / (1.0 - 2.0 * nu);
    const double flow13[3] = {m, 0.0, -1.0}, flow12[3] = {m, -1.0, 0.0}, flow23[3] = {0.0, m, -1.0};
    // What flow along a vector takes from a plane's yield function, times 1 / 2 G.
    const double both = ratio * (m - 1.0) * (k - 1.0);
    // With a of a plane and b of a flow, a . D b / 2 G = a . b + ratio tr(a) tr(b); tr(a) = k - 1
    // and tr(b) = m - 1 for every face of shear. `right`, `left`: of the faces 13 and 23, 13 and
    // 12.
    const double own = both + m * k + 1.0, right = both + 1.0, left = both + m * k;
    const T f13 = T(k) * trial[0] - trial[2] - T(strength);
    const T f12 = T(k) * trial[0] - trial[1] - T(strength);
    const T f23 = T(k) * trial[1] - trial[2] - T(strength);
    Candidate<T> c = moved(trial, f13 * T(1.0 / own), flow13, T(0.0), flow13);
    c.fault = -f13;
    try_one(c);
    const auto edge = [&](T other, double mixed, const double (&flow)[3]) {
      // Both yield functions vanish: own a + mixed b = f13, mixed a + own b = other.
      const T scale(1.0 / (own * own - mixed * mixed));
      const T a = (T(own) * f13 - T(mixed) * other) * scale;
      const T b = (T(own) * other - T(mixed) * f13) * scale;
      c = moved(trial, a, flow13, b, flow);
      c.fault = max(-a, -b);
      try_one(c);
    };
    edge(f23, right, flow23);
    edge(f12, left, flow12);
  }

  /// A stress on an edge or a corner of tension, and the strain e that takes the trial there.
  template <Real T>
  MPM_HD Candidate<T> cut(const T (&trial)[3], T s1, T s2, T s3, T (&e)[3]) const {
    Candidate<T> c;
    c.stress[0] = s1;
    c.stress[1] = s2;
    c.stress[2] = s3;
    plastic(trial, c.stress, e);
    return c;
  }

  /// Tension: of one, two, three principal stresses.
  template <Real T, class Try>
  MPM_HD void by_tension(const T (&trial)[3], const Try& try_one) const {
    const double ratio = nu / (1.0 - 2.0 * nu);
    const double open1[3] = {1.0, 0.0, 0.0}, open2[3] = {0.0, 1.0, 0.0};
    // Opening along one axis takes 1 + ratio from its own stress and ratio from each other.
    const T t(limit), over1 = trial[0] - t, over2 = trial[1] - t;
    Candidate<T> c = moved(trial, over1 * T(1.0 / (1.0 + ratio)), open1, T(0.0), open1);
    c.fault = -over1;
    try_one(c);
    const T a = (T(1.0 + ratio) * over1 - T(ratio) * over2) * T(1.0 / (1.0 + 2.0 * ratio));
    const T b = (T(1.0 + ratio) * over2 - T(ratio) * over1) * T(1.0 / (1.0 + 2.0 * ratio));
    c = moved(trial, a, open1, b, open2);
    c.fault = max(-a, -b);
    try_one(c);
    T e[3];
    // The apex of tension is a point: no multipliers to solve for, the strain itself must not
    // close.
    c = cut(trial, t, t, t, e);
    c.fault = -min(min(e[0], e[1]), e[2]);
    try_one(c);
  }

  /// Both: the edge where s1 = tension and s3 = s, of the corner of the two, and its two ends.
  template <Real T, class Try>
  MPM_HD void by_both(const T (&trial)[3], const Try& try_one) const {
    const double ratio = nu / (1.0 - 2.0 * nu);
    const T t(limit), s(k * limit - strength), over1 = trial[0] - t;
    // No strain along the second axis: trial - stress = e + ratio sum along the first and the
    // third, which added give (1 + 2 ratio) sum, sum = e1 + e3.
    const T sum = (over1 + trial[2] - s) * T(1.0 / (1.0 + 2.0 * ratio));
    T e[3];
    Candidate<T> c = cut(trial, t, trial[1] - T(ratio) * sum, s, e);
    // e = x (1, 0, 0) + y (m, 0, -1) with x, y >= 0: y = -e3, x = e1 + m e3.
    c.fault = max(e[2], -(e[0] + T(m) * e[2]));
    try_one(c);
    c = cut(trial, t, t, s, e);
    c.fault = max(max(e[2], -(e[0] + e[1] + T(m) * e[2])), -min(e[0], e[1]));
    try_one(c);
    c = cut(trial, t, s, s, e);
    c.fault = max(max(e[1], e[2]), -(e[0] + T(m) * (e[1] + e[2])));
    try_one(c);
  }

  /// Stress and state after a step. The plastic strain grows by sqrt(2/3 e:e) of its increment e.
  template <Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>& motion, Sym<T, D>& stress,
                  State<T, D>& state) const {
    elastic.update(motion, stress);
    // Principal stresses are needed only if some lane may yield: with tau = sqrt(s:s/2), s1 - s3 <=
    // 2 tau, and s1 and |s2| of the deviator are at most 2 tau / sqrt(3) and tau / sqrt(3).
    const T mean = T(1.0 / 3.0) * trace(stress);
    const T tau = von_mises(stress) * T(1.0 / std::numbers::sqrt3);
    const T shear = T(k - 1.0) * (mean + T(0.5 / std::numbers::sqrt3) * tau) + T(k + 1.0) * tau;
    // k s1 - s3 = (k - 1) (s1 + s3) / 2 + (k + 1) (s1 - s3) / 2, and (s1 + s3) / 2 = mean - s2' / 2
    // with s2' of the deviator.
    if (!any((shear > T(strength)) | (mean + T(2.0 / std::numbers::sqrt3) * tau > T(limit))))
      return T(0.0);

    const Eigen<T, D> principal = eigen(stress);
    const Sorted<T> sorted(principal.value);
    const T(&trial)[3] = sorted.value;
    // What is beyond the surface by the roundings of the last return stays.
    const T rounding = T(rounding_of_stress) * (T(k) * absolute(trial[0]) + absolute(trial[2])) +
                       T(rounding_of_modulus * E);
    const auto flows =
        (T(k) * trial[0] - trial[2] > T(strength) + rounding) | (trial[0] > T(limit) + rounding);
    if (!any(flows)) return T(0.0);
    T after[3], e[3], change[3];
    return_to_surface(trial, after);
    T squares(0.0), work(0.0);
    plastic(trial, after, e);
    for (int i = 0; i < 3; ++i) {
      e[i] = select(flows, e[i], T(0.0)) * T(0.5 / elastic.G);
      change[i] = select(flows, after[i] - trial[i], T(0.0));
      squares = squares + e[i] * e[i];
      // With the stress after the step, which is what the return solves for (StrengthModel).
      work = work + after[i] * e[i];
    }
    // The change, and not the stress, goes back by the axes: where a lane does not flow nothing is
    // added, and its stress stays to the bit.
    sorted.unsort(change);
    stress = stress + principal.with(change);
    state.plastic_strain += sqrt(T(2.0 / 3.0) * squares);
    return work;
  }
};

}  // namespace mpm
