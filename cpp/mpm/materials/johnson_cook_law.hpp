#pragma once
// Johnson and Cook's yield stress, which two strength models share.
#include "mpm/materials/radial_return.hpp"

namespace mpm {

/// x^a near the x at which it was last taken exactly.
template <class T>
struct Power {
  double exponent;
  T near, inverse, near_value;

  Power(T x, double a) : exponent(a), near(x), inverse(T(1.0) / x), near_value(pow(x, T(a))) {}
  struct At {
    T value, slope, inverse;  // x^a, its derivative, 1/x
  };
  /// By series, and 1/x to the change's own order, which is enough for the slopes of a search;
  /// exactly where x is far off: the steps of a search are long only at its start.
  At at(T x) {
    T change = (x - near) * inverse;
    const auto far = absolute(change) > T(0.01);
    const bool never_near = exponent >= power_near_one_below;
    if (never_near || any(far)) {  // lane by lane: what one holds is no matter to its neighbour
      const auto exact = never_near ? T(0.0) < T(1.0) : far;
      near = select(exact, x, near);
      inverse = select(exact, T(1.0) / x, inverse);
      near_value = select(exact, pow(x, T(exponent)), near_value);
      change = select(exact, T(0.0), change);
    }
    const T value = near_value * power_near_one(change, exponent);
    const T one_over = inverse * (T(1.0) - change);
    return {value, T(exponent) * value * one_over, one_over};
  }
};

/// Y = (A + B ep^n) (1 + C ln(rate / rate0)) (1 - T*^m), rates below rate0 taken as rate0,
/// T* = (T - T_room) / (T_melt - T_room) between 0 and 1 (Johnson & Cook 1983, eqs. 1-2).
struct JohnsonCookLaw {
  double A{}, B{}, n{}, C{}, rate0{};
  double m{}, T_room{}, T_melt{};
  double heating = 0.0;  // temperature per plastic work of the initial volume [K m^3/J]
  bool thermal = false;

  template <Real T>
  T homologous(T temperature) const {
    return min(max((temperature - T(T_room)) * T(1.0 / (T_melt - T_room)), T(0.0)), T(1.0));
  }

  /// Returns the stress; adds to plastic strain and temperature; gives the plastic work. Rate,
  /// hardening and heating are implicit: the rate is d / time step, and the temperature that of the
  /// end of the step, T + heating J (q - 3 G d) d. The search starts at the rate that the stress
  /// before the step has if it lay on the yield surface.
  template <Real T, int D>
  T update(const Motion<T, D>& motion, double G, const Sym<T, D>& stress_before, Sym<T, D>& stress,
           T& plastic_strain, T& temperature) const {
    const T before = plastic_strain, start = temperature, heat = T(heating) * motion.J;
    const double unit = motion.time_step * rate0;
    Power<T> hardening(max(before, T(tiny)), n),
        softening(thermal ? max(homologous(start), T(tiny)) : T(1.0), m);
    T at_rest = T(A) + T(B) * hardening.near_value;
    if (thermal) at_rest = at_rest * (T(1.0) - softening.near_value);
    const auto yield = [&](T q, T d, T x) {
      const auto hard = hardening.at(max(before + d, T(tiny)));
      const T faster = T(1.0) + T(C) * max(x, T(0.0)), rest = T(A) + T(B) * hard.value;
      const T harder = T(B) * hard.slope * d * faster;
      RateYield<T> y;
      y.value = rest * faster;
      y.slope = harder + select(x > T(0.0), T(C) * rest, T(0.0));
      y.bend = harder * (T(1.0) + T(n - 1.0) * d * hard.inverse);
      if (thermal) {
        const T star = homologous(start + heat * (q - T(3.0 * G) * d) * d);
        const auto lost = softening.at(max(star, T(tiny)));
        const auto varies = (star > T(0.0)) & (star < T(1.0));
        const T softer =
            select(varies, y.value * lost.slope * heat * d * T(1.0 / (T_melt - T_room)), T(0.0));
        const T left = T(1.0) - lost.value;
        y.value = y.value * left;
        y.slope = y.slope * left - softer * (q - T(6.0 * G) * d);
        y.bend = y.bend * left - softer * (q - T(12.0 * G) * d);
      }
      return y;
    };
    const T gain = max(T(C) * at_rest, T(tiny));
    const auto rate_before = [&](T) {
      return min(max((von_mises(stress_before) - at_rest) / gain, T(-50.0)), T(50.0));
    };
    const auto above = [&](T q) {
      const T over = max(q - at_rest, T(tiny));
      return min(max(over / gain, T(0.0)), log(max(over * T(1.0 / (3.0 * G * unit)), T(tiny))));
    };
    const auto done = return_with_rate(stress, G, unit, at_rest, yield, rate_before, above);
    plastic_strain = before + done.increment;
    const T work = done.von_mises * done.increment;
    if (thermal) temperature = start + heat * work;
    return work;
  }
};

}  // namespace mpm
