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
/// to where q_trial - 3 G d = Y(d): `yield(d)` gives Y and dY/dd, everything that d changes
/// included, so rate and temperature terms are implicit. `at_rest` is Y(0), below which nothing
/// happens. The increment d lies between 0 and q/(3 G); Newton's steps, halved into that bracket
/// where they leave it, end at a residual of 1e-13 q.
template <Real T, int D, class F>
Returned<T> return_radially(Sym<T, D>& stress, double G, T at_rest, F&& yield) {
  const Sym<T, D> mean = Sym<T, D>::isotropic(T(1.0 / 3.0) * trace(stress));
  const Sym<T, D> deviator = stress - mean;
  const T q = sqrt(T(1.5) * inner(deviator, deviator));
  const auto flows = q > at_rest;
  if (!any(flows)) return {T(0.0), q};

  const T stiff(3.0 * G);
  T low(0.0), high = q / stiff;
  T d = select(flows, (q - at_rest) / stiff, T(0.0));
  auto open = flows;
  for (int turn = 0; turn < 80; ++turn) {
    const Yield<T> y = yield(q, d);
    const T rest = q - stiff * d - y.value;
    open = open & (absolute(rest) > T(1e-13) * q);
    if (!any(open)) break;
    low = select(rest > T(0.0), d, low);
    high = select(rest > T(0.0), high, d);
    const T newton = d + rest / (stiff + y.slope);
    const T inside = select((newton > low) & (newton < high), newton, T(0.5) * (low + high));
    d = select(open, inside, d);
  }
  const T after = q - stiff * d;
  stress = mean + select(flows, after / q, T(1.0)) * deviator;
  return {d, after};
}

}  // namespace mpm
