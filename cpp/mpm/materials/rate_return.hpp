#pragma once
// The return where the yield stress depends on the rate. The unknown is x, where the increment of
// the plastic strain is d = unit exp(x), because rate terms are linear in x.
#include "mpm/materials/radial_return.hpp"

namespace mpm {

/// A yield stress [Pa] and its derivatives with x, the first of which may miss `slope_error` of
/// itself, the second `bend_error` times the first.
template <class T>
struct RateYield {
  T value, slope, curvature;
};
inline constexpr double slope_error = 1e-5, bend_error = 0.01;

/// The increment where a particle goes on flowing as it did. What the elastic step would add to von
/// Mises' stress, `q_before` before, is what the flow takes back, but for the hardening. So good a
/// start needs one step of third order (Chebyshev's) and mostly one with the slope that it
/// predicts, which asks for the yield stress alone. Gives the lanes that flow and are
/// still to be found.
template <Real T, class Flow>
MPM_HD Truth<T> newton_steps(T q, T q_before, T stiff, double unit, Truth<T> flows, Flow& flow,
                             T& found) {
  // On the yield surface before and after, at the same rate: q - q_before = (3 G + dY/dd) d.
  const T nothing(0.0), over = q - max(q_before, flow.static_yield());
  auto open = flows & (over > T(1e-6) * q);
  if (!any(open)) return flows;
  T d = select(open, over, q) / (stiff + flow.hardening()), x = log(d * T(1.0 / unit));
  // Lanes that are not open stay where `flow` has begun, so that nothing depends on neighbours.
  d = select(open, d, nothing);
  const RateYield<T> y = flow.yield(q, d, x);
  const T inverse = T(1.0) / (stiff * d + y.slope);
  // g(x) = 3 G d + Y - q with dd/dx = d, so g' = 3 G d + Y' and g'' = 3 G d + Y''.
  const T newton = (q - stiff * d - y.value) * inverse;
  const T curvature = (stiff * d + y.curvature) * inverse;
  // Chebyshev: x - (g / g') (1 + g g'' / 2 g'^2), and newton = -g / g'.
  T step = newton * (T(1.0) - T(0.5) * newton * curvature);
  // Up to here exp(step) - 1 is its series to step^6, within 2e-13 of d.
  open = open & (absolute(step) < T(0.05));
  step = select(open, step, nothing);
  T series(1.0 / 720.0);
  for (const double factor : {1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0})
    series = T(factor) + step * series;
  d += d * step * series;
  const T x_before = x, step_size = absolute(step);
  x += step;
  // g'(x + step) = g' (1 + step g'' / g') to first order.
  const T predicted = inverse * (T(1.0) - step * curvature);  // 1 / slope
  const auto search = flows & !open;
  constexpr int most_steps = 3;
  for (int k = 0; k < most_steps && any(open); ++k) {
    const T last = (q - stiff * d - flow.value(q, d, x)) * predicted, size = absolute(last);
    // exp(last) to second order: `last` is small enough, or the lane stays open.
    d = select(open, d + d * last * (T(1.0) + T(0.5) * last), d);
    x = select(open, x + last, x);
    // What a step leaves is its own square, and what the slope was wrong by.
    const T left =
        size * (size + T(slope_error) + step_size * (T(bend_error) + T(2.0) * step_size));
    open = open & !(left < T(return_tolerance) * q * inverse);
  }
  found = d;
  return search | open | (flows & !(x_before * x > nothing));  // x = 0 may be a kink
}

/// The same for any lane: Halley's steps, third order, kept between bounds by halving, from
/// `flow.start(q_before)`, or, where that is far off, from `flow.above(q)`.
template <Real T, class Flow>
MPM_HD T bracketed_halley(T q, T q_before, T stiff, double unit, Truth<T> open, Flow& flow) {
  const T nothing(0.0);
  // The flow takes no more than the whole stress: 3 G d <= q.
  // exp of less than -708 is held there; at -700 nothing flows.
  T low(-700.0), high = log(max(q / stiff * T(1.0 / unit), T(tiny)));
  T x = min(flow.start(q_before), high), found = nothing;
  for (int turn = 0; turn < 100; ++turn) {
    const T d = T(unit) * exp(x);
    const RateYield<T> y = flow.yield(q, d, x);
    const T rest = q - stiff * d - y.value, slope = stiff * d + y.slope;
    // Far off the step is kept within a third of Newton's.
    const T inverse = T(1.0) / slope, newton = rest * inverse;
    // Halley: newton / (1 + newton g'' / 2 g'), g as above.
    const T bent = T(0.5) * newton * (stiff * d + y.curvature) * inverse;
    const T step = newton / (T(1.0) + min(max(bent, T(-0.25)), T(0.25)));
    // The rest falls with x, so that its sign says on which side the root is.
    low = select(rest > nothing, x, low);
    high = select(rest > nothing, high, x);
    T next = x + step;
    // What this step leaves is of its third power, and of its square as far as `curvature` is
    // inexact, unless it passes the kink.
    const T size = absolute(step);
    const auto small = size < T(1e-3);
    const auto settled =
        (small & (size * size * (size + T(bend_error)) * slope < T(return_tolerance) * q) &
         (x * next > nothing)) |
        (absolute(rest) < T(return_tolerance) * q);
    // exp(step) to third order, below 1e-3: 4e-14 of d is left.
    const T after =
        select(small, d + d * step * (T(1.0) + step * (T(0.5) + T(1.0 / 6.0) * step)), d);
    found = select(open, after, found);
    open = open & !settled;
    if (!any(open)) break;
    const auto far = size > T(0.5);
    next = select((next > low) & (next < high), next, T(0.5) * (low + high));
    // A step of more than 0.5 from a start that says nothing of this lane.
    if (turn == 0 && any(open & far)) next = select(far, flow.above(q), next);
    x = select(open, next, x);
  }
  return found;
}

/// Return a trial stress to the yield surface over one step. `flow` gives the yield stress
/// `static_yield` (d = 0 and no rate), below which nothing happens, and how it has its `hardening`
/// there with d; its `value` and its `yield` with derivatives at (q, d, x), q von Mises' trial
/// stress; where to `start` if von Mises' stress before the step lay on the yield surface; and an x
/// `above` the solution for q. x = 0 may be a kink.
template <Real T, int D, class Flow>
MPM_HD Returned<T> return_with_rate(Sym<T, D>& stress, double G, double unit, T q_before,
                                    Flow& flow) {
  const T q = von_mises(stress), stiff(3.0 * G), nothing(0.0);
  // Below the static yield stress the rate term only adds: no lane that is elastic asks for it.
  const auto flows = q > flow.static_yield();
  if (!any(flows)) return {nothing, q};
  T d = nothing;
  const auto search = newton_steps(q, q_before, stiff, unit, flows, flow, d);
  if (any(search)) d = select(search, bracketed_halley(q, q_before, stiff, unit, search, flow), d);
  return scale_deviator(stress, q, stiff, select(flows, d, nothing));
}

}  // namespace mpm
