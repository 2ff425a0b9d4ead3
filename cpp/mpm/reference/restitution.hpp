#pragma once
// Restitution of bodies that touch by their surfaces, in the reference step
// (docs/theory/surface-contact.md, "Restitution").
#include "mpm/reference/surfaces.hpp"

namespace mpm::reference {

/// Of two bodies, or of a body and a face: what their springs come to.
template <int D>
struct Meeting {
  Vector3 push = Vector3::zero(), rub = push, middle = push;  // on the first [N]; [N m]
  double sizes = 0.0, k = 0.0;                                // of pushes [N]; [N/m]
};

/// As bodies part by u_n > 0 they feel e^2 of the normal force N: the rest,
/// (1 - e^2) N min(u_n / u_s, 1) with u_s = N dt / m*, acts between their motions as wholes at the
/// middle of the contact. Along the surface a dashpot of that restitution (Tsuji, Tanaka & Ishida
/// 1992), 2 beta (k m*)^(1/2) u_t, beta = -ln e / (pi^2 + ln^2 e)^(1/2), takes no more than .05 of
/// what both have along it in a step, and than Coulomb's law leaves of mu times what the bodies
/// feel of N; that bounds the friction of their points too, in the next step, and what these have
/// more than it by now is taken back.
template <int D>
void restitute(Surfaces<D>& surfaces, const Meeting<D>& met, std::size_t a, Whom whom) {
  SurfaceBody<D>& first = surfaces.bodies[a];
  SurfaceBody<D>* const second =
      is_wall(whom) ? nullptr : &surfaces.bodies[static_cast<std::size_t>(whom)];
  const SurfaceLaw law = second ? surfaces.law_of(a, static_cast<std::size_t>(whom)) : surfaces.law;
  const double e = law.restitution, N = norm(met.push), dt = surfaces.step.dt;
  const auto light = [](const SurfaceBody<D>& b) {
    return b.body().prescribed() ? 0.0 : 1.0 / b.mass();
  };
  const double m = 1.0 / (light(first) + (second ? light(*second) : 0.0));
  if (!(e < 1.0 && N > 0.0)) return;
  const Vector3 n = normalised(met.push), x = (1.0 / met.sizes) * met.middle;
  Vector3 u = first.motion().velocity_at(x);
  if (second) u = u - second->motion().velocity_at(x);
  const double u_n = dot(u, n), u_s = N * dt / m;
  const double taken = (1.0 - e * e) * N * std::clamp(u_n / u_s, 0.0, 1.0);
  const double ln = std::log(std::max(e, 1e-3)), pi = std::numbers::pi;
  const double beta = -ln / std::sqrt(pi * pi + ln * ln);
  const double mu = second ? law.mu : friction_at_wall(surfaces.step, first.body(), whom);
  const Vector3 u_t = along(u, n);
  const double drag =
      std::min({2.0 * beta * std::sqrt(met.k * m) * norm(u_t), 0.05 * m / dt * norm(u_t),
                std::max(mu * (N - taken) - norm(met.rub), 0.0)});
  surfaces.left[{a, whom}] = 1.0 - taken / N;
  Vector3 force = -taken * n - drag * normalised(u_t);
  const double allowed = mu * met.sizes * (1.0 - taken / N);
  if (!law.bonded && norm(met.rub) > allowed)
    force = force - (1.0 - allowed / norm(met.rub)) * met.rub;
  first.push_whole(x, force);
  if (second) second->push_whole(x, -1.0 * force);
}

/// Of all that touch, after Surfaces::touch(). A body does not part from itself.
template <int D>
void restitute(Surfaces<D>& surfaces) {
  std::map<std::pair<std::size_t, Whom>, Meeting<D>> all;
  for (const SurfaceTouch<D>& t : surfaces.touches) {
    const auto b = static_cast<std::size_t>(t.whom);
    if (!is_wall(t.whom) && b == t.body) continue;
    const bool is_first = is_wall(t.whom) || t.body < b;
    Meeting<D>& met = is_first ? all[{t.body, t.whom}] : all[{b, static_cast<Whom>(t.body)}];
    const double sign = is_first ? 1.0 : -1.0;
    met.push += sign * in_space<D>(t.push);
    met.rub += sign * in_space<D>(t.rub);
    met.middle += norm(t.push) * in_space<D>(t.place);
    met.sizes += norm(t.push);
    met.k += t.k;
  }
  surfaces.left.clear();
  for (const auto& [who, met] : all) restitute(surfaces, met, who.first, who.second);
}

}  // namespace mpm::reference
