#pragma once
// The return of a trial stress to von Mises' yield surface for any hardening.
#include "mpm/materials/jaumann.hpp"

namespace mpm {

/// A yield stress [Pa] and its derivative with the plastic strain increment of the step.
template <class T>
struct Yield {
  T value, slope;
};

/// What a return did: the increment of the equivalent plastic strain, and von Mises' stress after.
template <class T>
struct Returned {
  T increment, von_mises;
};

/// Return the deviator of a trial stress along its own direction (Wilkins 1964, Krieg & Key 1976)
/// to where q_trial - 3 G d = Y(d): `yield(q, d)` gives Y and dY/dd, everything that d changes
/// included, so rate and temperature terms are implicit. `at_rest` is Y(0), below which nothing
/// happens. The increment d lies between 0 and q/(3 G), and the search starts at `guess(q)`.
/// Newton's steps are those of ln d, in which rate terms are linear, with the exponential as
/// (1 + x/2) / (1 - x/2); where they leave the bracket it is halved. The step at a residual below
/// 1e-11 q is the last (at the kink of a rate term convergence is not quadratic).
template <Real T, int D, class F, class Guess>
Returned<T> return_radially(Sym<T, D>& stress, double G, T at_rest, F&& yield, Guess&& guess) {
  const Sym<T, D> mean = Sym<T, D>::isotropic(T(1.0 / 3.0) * trace(stress));
  const Sym<T, D> deviator = stress - mean;
  const T q = sqrt(T(1.5) * inner(deviator, deviator));
  const auto flows = q > at_rest;
  if (!any(flows)) return {T(0.0), q};

  const T stiff(3.0 * G);
  T low(0.0), high = q / stiff;
  T d = select(flows, max(min(guess(q), high), T(1e-3) * high), T(0.0));
  auto open = flows;
  for (int turn = 0; turn < 80; ++turn) {
    const Yield<T> y = yield(q, d);
    const T rest = q - stiff * d - y.value;
    low = select(rest > T(0.0), d, low);
    high = select(rest > T(0.0), high, d);
    const T per_log = T(2.0) * d * (stiff + y.slope);
    const T step = max(min(rest, T(0.9) * per_log), T(-0.9) * per_log);
    const T newton = d * (per_log + step) / (per_log - step);
    const auto rough = absolute(rest) > T(1e-11) * q, near = absolute(rest) <= T(1e-11) * q;
    const auto good = near | ((newton > low) & (newton < high));
    const T inside = select(good, newton, T(0.5) * (low + high));
    d = select(open, inside, d);
    open = open & rough;
    if (!any(open)) break;
  }
  const T after = q - stiff * d;
  stress = mean + select(flows, after / q, T(1.0)) * deviator;
  return {d, after};
}

/// The same for hardening without rates: the yield stress hardly changes within a step.
template <Real T, int D, class F>
Returned<T> return_radially(Sym<T, D>& stress, double G, T at_rest, F&& yield) {
  return return_radially(stress, G, at_rest, yield,
                         [&](T q) { return (q - at_rest) * T(1.0 / (3.0 * G)); });
}

}  // namespace mpm
