#pragma once
// Johnson and Cook's yield stress, which two strength models share.
#include "mpm/materials/rate_return.hpp"

namespace mpm {

/// x^a near the x at which it was last taken exactly.
template <class T>
class Power {
 public:
  MPM_HD Power(T x, const PowerNearOne& a)
      : series_(a), near_(x), inverse_(T(1.0) / x), near_value_(pow(x, T(a.exponent))) {}

  struct At {
    T value, slope, inverse;  // x^a, its derivative, 1/x
  };
  /// At the x that it began with.
  MPM_HD At first() const {
    return {near_value_, T(series_.exponent) * near_value_ * inverse_, inverse_};
  }
  /// By series; exactly where x is far off: the steps of a search are long only at its start.
  MPM_HD T value(T x) {
    change_ = (x - near_) * inverse_;
    const auto far = absolute(change_) > T(PowerNearOne::reach);
    if (!series_.exact() || any(far)) {  // lane by lane: one does not ask what its neighbour holds
      const auto anew = series_.exact() ? far : T(0.0) < T(1.0);
      near_ = select(anew, x, near_);
      inverse_ = select(anew, T(1.0) / x, inverse_);
      near_value_ = select(anew, pow(x, T(series_.exponent)), near_value_);
      change_ = select(anew, T(0.0), change_);
    }
    return near_value_ * series_(change_);
  }
  /// 1/x within the change's fourth power, 6e-6, which is enough for the slopes of a search.
  MPM_HD At at(T x) {
    const T there = value(x);
    const T one_over = inverse_ * (T(1.0) - change_) * (T(1.0) + change_ * change_);
    return {there, T(series_.exponent) * there * one_over, one_over};
  }

 private:
  const PowerNearOne& series_;
  T near_, inverse_, near_value_, change_ = T(0.0);
};

/// Y = (A + B ep^n) (1 + C ln(rate / rate0)) (1 - T*^m), rates below rate0 taken as rate0,
/// T* = (T - T_room) / (T_melt - T_room) between 0 and 1 (Johnson & Cook 1983, eqs. 1-2).
struct JohnsonCookLaw {
  double A{}, B{}, C{}, rate0{};
  PowerNearOne n{}, m{};
  double T_room{}, T_melt{};
  double heating = 0.0;  // temperature per plastic work of the initial volume [K m^3/J]

  template <Real T>
  MPM_HD T homologous(T temperature) const {
    return min(max((temperature - T(T_room)) * T(1.0 / (T_melt - T_room)), T(0.0)), T(1.0));
  }

  /// Returns the stress; adds to plastic strain and, if `thermal`, temperature; gives the plastic
  /// work. Rate, hardening and heating are implicit: the rate is d / time step, and the temperature
  /// that of the end of the step, T + heating J (q - 3 G d) d.
  template <bool thermal, Real T, int D>
  MPM_HD T update(const StrainIncrement<T, D>& motion, double G, const Sym<T, D>& stress_before,
                  Sym<T, D>& stress, T& plastic_strain, T& temperature) const;
};

/// The yield stress over one step as `return_with_rate` asks for it: x = ln(d / unit).
template <bool thermal, class T>
class JohnsonCookFlow {
 public:
  MPM_HD JohnsonCookFlow(const JohnsonCookLaw& law, double G, double unit, T heat, T plastic_strain,
                         T temperature)
      : law_(law),
        G_(G),
        unit_(unit),
        heat_(heat),
        strain_(plastic_strain),
        temperature_(temperature),
        // `tiny` for a power of zero: its logarithm must be a number.
        hardening_(max(plastic_strain, T(tiny)), law.n),
        softening_(thermal ? max(law.homologous(temperature), T(tiny)) : T(1.0), law.m) {
    const auto hard = hardening_.first();
    const T left = thermal ? T(1.0) - softening_.first().value : T(1.0);
    static_yield_ = (T(law.A) + T(law.B) * hard.value) * left;
    hardening_slope_ = T(law.B) * hard.slope * left;
    // dY/dx at d = 0: a law without rates has none, and no division by it may be asked for.
    gain_ = max(T(law.C) * static_yield_, T(tiny));
  }

  MPM_HD T static_yield() const { return static_yield_; }
  MPM_HD T hardening() const { return hardening_slope_; }

  MPM_HD T value(T q, T d, T x) {
    const T Y = (T(law_.A) + T(law_.B) * hardening_.value(strain(d))) * faster(x);
    if constexpr (!thermal) return Y;
    return Y * (T(1.0) - softening_.value(max(star(q, d), T(tiny))));
  }

  MPM_HD RateYield<T> yield(T q, T d, T x) {
    const auto hard = hardening_.at(strain(d));
    const T rest = T(law_.A) + T(law_.B) * hard.value;
    const T harder = T(law_.B) * hard.slope * d * faster(x);
    RateYield<T> y;
    y.value = rest * faster(x);
    // x = ln(rate / rate0), as unit = time step x rate0: the rate term is C x, with a kink at
    // x = 0, below which rates count as rate0.
    y.slope = harder + select(x > T(0.0), T(law_.C) * rest, T(0.0));
    // Terms of C times the hardening's slope are left out, and of two slopes below: `bend_error`
    // allows for it.
    y.curvature = harder * (T(1.0) + T(law_.n.exponent - 1.0) * d * hard.inverse);
    if constexpr (thermal) {
      const T hot = star(q, d);
      const auto lost = softening_.at(max(hot, T(tiny)));
      // Outside, homologous() is held at 0 or 1 and does not change.
      const auto varies = (hot > T(0.0)) & (hot < T(1.0));
      const double per_kelvin = 1.0 / (law_.T_melt - law_.T_room);
      const T softer = select(varies, y.value * lost.slope * heat_ * d * T(per_kelvin), T(0.0));
      const T left = T(1.0) - lost.value;
      y.value = y.value * left;
      // d/dx of (q - 3 G d) d is (q - 6 G d) d, and of that (q - 12 G d) d.
      y.slope = y.slope * left - softer * (q - T(6.0 * G_) * d);
      y.curvature = y.curvature * left - softer * (q - T(12.0 * G_) * d);
    }
    return y;
  }

  MPM_HD T start(T q_before) const {
    // q_before = Y0 (1 + C x): the rate at which the particle flowed before this step.
    return min(max((q_before - static_yield_) / gain_, T(-50.0)), T(50.0));
  }
  MPM_HD T above(T q) const {
    const T over = max(q - static_yield_, T(tiny));
    // Two bounds of x, by the rate term alone and by 3 G d alone: where nothing softens, each takes
    // no more than what is over.
    return min(max(over / gain_, T(0.0)), log(max(over * T(1.0 / (3.0 * G_ * unit_)), T(tiny))));
  }

 private:
  MPM_HD T strain(T d) const { return max(strain_ + d, T(tiny)); }
  MPM_HD T faster(T x) const { return T(1.0) + T(law_.C) * max(x, T(0.0)); }
  MPM_HD T star(T q, T d) const {
    return law_.homologous(temperature_ + heat_ * (q - T(3.0 * G_) * d) * d);
  }

  const JohnsonCookLaw& law_;
  double G_, unit_;
  T heat_, strain_, temperature_;
  Power<T> hardening_, softening_;
  T static_yield_, hardening_slope_, gain_;
};

template <bool thermal, Real T, int D>
MPM_HD T JohnsonCookLaw::update(const StrainIncrement<T, D>& motion, double G,
                                const Sym<T, D>& stress_before, Sym<T, D>& stress,
                                T& plastic_strain, T& temperature) const {
  const T heat = T(heating) * motion.J;
  const double unit = motion.time_step * rate0;
  JohnsonCookFlow<thermal, T> flow(*this, G, unit, heat, plastic_strain, temperature);
  const auto done = return_with_rate(stress, G, unit, von_mises(stress_before), flow);
  plastic_strain += done.increment;
  const T work = done.von_mises * done.increment;
  // The very work that was in the law's temperature: what heats is what the ledger counts.
  if constexpr (thermal) temperature += heat * work;
  return work;
}

}  // namespace mpm
