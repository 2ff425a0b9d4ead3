#pragma once
// Johnson and Cook's yield stress, which two strength models share.
#include "mpm/materials/radial_return.hpp"

namespace mpm {

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
  /// end of the step, T + heating J (q - 3 G d) d.
  template <Real T, int D>
  T update(const Motion<T, D>& motion, double G, Sym<T, D>& stress, T& plastic_strain,
           T& temperature) const {
    const T before = plastic_strain, start = temperature, heat = T(heating) * motion.J;
    const T per_rate(1.0 / (motion.time_step * rate0));
    const T tiny(1e-300);
    const auto soft = [&](T at) {  // 1 - T*^m
      return T(1.0) - pow(max(homologous(at), tiny), T(m));
    };
    const auto yield = [&](T q, T d) {
      const T total = max(before + d, tiny), power = T(B) * pow(total, T(n));
      const T rate = d * per_rate;
      const auto fast = rate > T(1.0);
      const T faster = T(1.0) + T(C) * log(max(rate, T(1.0)));
      const T hard = T(A) + power;
      Yield<T> y{hard * faster,
                 T(n) * power / total * faster + hard * select(fast, T(C) / max(d, tiny), T(0.0))};
      if (thermal) {
        const T hot = start + heat * (q - T(3.0 * G) * d) * d;
        const T star = homologous(hot), lost = pow(max(star, tiny), T(m));
        const auto varies = (star > T(0.0)) & (star < T(1.0));
        const T slope = heat * (q - T(6.0 * G) * d) * T(1.0 / (T_melt - T_room));
        y.slope = y.slope * (T(1.0) - lost) -
                  select(varies, y.value * T(m) * lost / max(star, tiny) * slope, T(0.0));
        y.value = y.value * (T(1.0) - lost);
      }
      return y;
    };
    T at_rest = T(A) + T(B) * pow(max(before, tiny), T(n));
    if (thermal) at_rest = at_rest * soft(start);
    const auto done = return_radially(stress, G, at_rest, yield);
    plastic_strain = before + done.increment;
    const T work = done.von_mises * done.increment;
    if (thermal) temperature = start + heat * work;
    return work;
  }
};

}  // namespace mpm
