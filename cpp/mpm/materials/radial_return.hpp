#pragma once
// The return of a trial stress to von Mises' yield surface along its own deviator (Wilkins 1964,
// Krieg & Key 1976): q_trial - 3 G d = Y, d the increment of the equivalent plastic strain.
#include "mpm/materials/jaumann.hpp"

namespace mpm {

/// A yield stress [Pa] and its derivative with the increment of the plastic strain.
template <class T>
struct Yield {
  T value, slope;
};

/// What a return did: the increment of the equivalent plastic strain, and von Mises' stress after.
template <class T>
struct Returned {
  T increment, von_mises;
};

/// Shorten the deviator of a stress whose von Mises stress is q to that of q - stiff d; where d is
/// zero the stress stays as it is, to the bit.
template <class T, int D>
MPM_HD Returned<T> scale_deviator(Sym<T, D>& stress, T q, T stiff, T d) {
  const Sym<T, D> mean = Sym<T, D>::isotropic(T(1.0 / 3.0) * trace(stress));
  const T after = q - stiff * d;
  const Sym<T, D> shorter = mean + (after / q) * (stress - mean);
  for (int c = 0; c < Sym<T, D>::size; ++c)
    stress.c[c] = select(d > T(0.0), shorter.c[c], stress.c[c]);
  return {d, after};
}

/// A residual, as a share of q, below which Newton's step is the last: convergence is quadratic.
inline constexpr double return_tolerance = 1e-11;

/// The return for hardening without rates: `yield(d)` gives Y and dY/dd; `static_yield` is Y(0),
/// below which nothing happens. Newton's steps are kept between 0 and q / (3 G) by halving.
template <Real T, int D, class F>
MPM_HD Returned<T> return_radially(Sym<T, D>& stress, double G, T static_yield, F&& yield) {
  const T q = von_mises(stress);
  const auto flows = q > static_yield;
  if (!any(flows)) return {T(0.0), q};

  const T stiff(3.0 * G);
  // The flow takes no more than the whole stress.
  T low(0.0), high = q / stiff;
  T d = select(flows, (q - static_yield) / stiff, T(0.0));
  auto open = flows;
  for (int turn = 0; turn < 80; ++turn) {
    const Yield<T> y = yield(d);
    const T rest = q - stiff * d - y.value;
    // rest falls with d as long as 3 G + dY/dd > 0, so that its sign says where the root lies.
    low = select(rest > T(0.0), d, low);
    high = select(rest > T(0.0), high, d);
    const T newton = d + rest / (stiff + y.slope);
    const auto rough = absolute(rest) > T(return_tolerance) * q;
    const auto good = (newton > low) & (newton < high);
    const T inside = select(good, newton, T(0.5) * (low + high));
    // A lane that has settled takes this last Newton step and no more, however long others go on:
    // what it gives does not depend on its neighbours (decision 0026).
    d = select(open, select(rough, inside, newton), d);
    open = open & rough;
    if (!any(open)) break;
  }
  return scale_deviator(stress, q, stiff, d);
}

}  // namespace mpm
