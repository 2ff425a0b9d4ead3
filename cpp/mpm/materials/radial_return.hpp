#pragma once
// The return of a trial stress to von Mises' yield surface along its own deviator (Wilkins 1964,
// Krieg & Key 1976): q_trial - 3 G d = Y, d the increment of the equivalent plastic strain.
#include "mpm/materials/jaumann.hpp"

namespace mpm {

/// A yield stress [Pa] and its derivative with what it is searched for.
template <class T>
struct Yield {
  T value, slope;
};

/// The same for a search in x = ln d: derivatives with x, the second of which may miss `bend_error`
/// times the first.
template <class T>
struct RateYield {
  T value, slope, bend;
};
inline constexpr double bend_error = 0.01;

/// What a return did: the increment of the equivalent plastic strain, and von Mises' stress after.
template <class T>
struct Returned {
  T increment, von_mises;
};

/// Shorten the deviator of a stress whose von Mises stress is q to that of q - stiff d.
template <class T, int D>
Returned<T> shorten(Sym<T, D>& stress, T q, T stiff, T d) {
  const Sym<T, D> mean = Sym<T, D>::isotropic(T(1.0 / 3.0) * trace(stress));
  const T after = q - stiff * d;
  stress = mean + select(d > T(0.0), after / q, T(1.0)) * (stress - mean);
  return {d, after};
}

/// A residual, as a share of q, below which Newton's step is the last: convergence is quadratic.
inline constexpr double return_tolerance = 1e-11;

/// The return for hardening without rates: `yield(d)` gives Y and dY/dd; `at_rest` is Y(0), below
/// which nothing happens. Newton's steps are kept between 0 and q / (3 G) by halving.
template <Real T, int D, class F>
Returned<T> return_radially(Sym<T, D>& stress, double G, T at_rest, F&& yield) {
  const T q = von_mises(stress);
  const auto flows = q > at_rest;
  if (!any(flows)) return {T(0.0), q};

  const T stiff(3.0 * G);
  T low(0.0), high = q / stiff;
  T d = select(flows, (q - at_rest) / stiff, T(0.0));
  auto open = flows;
  for (int turn = 0; turn < 80; ++turn) {
    const Yield<T> y = yield(d);
    const T rest = q - stiff * d - y.value;
    low = select(rest > T(0.0), d, low);
    high = select(rest > T(0.0), high, d);
    const T newton = d + rest / (stiff + y.slope);
    const auto rough = absolute(rest) > T(return_tolerance) * q;
    const auto good = (newton > low) & (newton < high);
    const T inside = select(good, newton, T(0.5) * (low + high));
    d = select(open, select(rough, inside, newton), d);
    open = open & rough;
    if (!any(open)) break;
  }
  return shorten(stress, q, stiff, d);
}

/// The return for a yield stress that depends on the rate: the unknown is x, where the increment is
/// unit exp(x), because rate terms are linear in x. `yield(q, d, x)` gives Y and dY/dx, and
/// `start(q)` where the search begins; where that is far off it begins anew at `above(q)`, which
/// must not lie below the solution. x = 0 may be a kink.
template <Real T, int D, class F, class Start, class Above>
Returned<T> return_with_rate(Sym<T, D>& stress, double G, double unit, T at_rest, F&& yield,
                             Start&& start, Above&& above) {
  const T q = von_mises(stress);
  const auto flows = q > at_rest;
  if (!any(flows)) return {T(0.0), q};

  const T stiff(3.0 * G), nothing(0.0);
  T low(-700.0), high(700.0), x = start(q), found = nothing;
  auto open = flows;
  for (int turn = 0; turn < 100; ++turn) {
    const T d = T(unit) * exp(x);
    const RateYield<T> y = yield(q, d, x);
    const T rest = q - stiff * d - y.value, slope = stiff * d + y.slope;
    // Halley's step, third order; far off it is kept within a third of Newton's.
    const T inverse = T(1.0) / slope, newton = rest * inverse;
    const T bent = T(0.5) * newton * (stiff * d + y.bend) * inverse;
    const T step = newton / (T(1.0) + min(max(bent, T(-0.25)), T(0.25)));
    low = select(rest > nothing, x, low);
    high = select(rest > nothing, high, x);
    T next = x + step;
    // What this step leaves is of its third power, and of its square as far as `bend` is inexact,
    // unless it passes the kink.
    const T size = absolute(step);
    const auto small = size < T(1e-3);
    const auto settled =
        (small & (size * size * (size + T(bend_error)) * slope < T(return_tolerance) * q) &
         (x * next > nothing)) |
        (absolute(rest) < T(return_tolerance) * q);
    const T after =
        select(small, d + d * step * (T(1.0) + step * (T(0.5) + T(1.0 / 6.0) * step)), d);
    found = select(open, after, found);
    open = open & !settled;
    if (!any(open)) break;
    const auto far = size > T(0.5);
    if (turn == 0 && any(open & far))
      next = select(far, above(q), next);
    else
      next = select((next > low) & (next < high), next, T(0.5) * (low + high));
    x = select(open, next, x);
  }
  return shorten(stress, q, stiff, found);
}

}  // namespace mpm
