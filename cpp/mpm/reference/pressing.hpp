#pragma once
// Particles of what flows that press the surfaces of bodies, (S7), in the reference step: each
// looks at every point of every body, and forces are derivatives of the energy.
#include "mpm/reference/surfaces.hpp"

namespace mpm::reference {

/// A particle whose nodes lie in space, and what it remembers of the body that it presses most.
template <int D>
struct PressingParticle {
  Vec<double, D> x, v;
  double V0 = 0.0, M = 0.0, density = 0.0;  // at the start [m^3, Pa, kg/m^3]
  double pressure = 0.0, now = 0.0;         // [Pa]; its density now [kg/m^3]
  Whom whom = -1;
  bool pressed = false;  // by its spring, of that stiffness [N/m]
  double k = 0.0;
  SurfaceMemory<D> memory{};
  double set_back = 0.0;                                     // b [m]
  Vec<double, D> push = Vec<double, D>::zero(), rub = push;  // on it [N]
  Vec<double, D> place = Vec<double, D>::zero();             // where it rubs [m]
  double stored_push = 0.0, stored_rub = 0.0;                // [J]
};

template <int D>
class Pressing {
 public:
  Surfaces<D>& surfaces;
  std::vector<PressingParticle<D>> particles{};
  std::size_t touching = 0;

  /// Before the first step: what overlaps is set back.
  void start() {
    for (PressingParticle<D>& p : particles)
      for_each_touch(p, [&](SurfaceTouch<D>& t) {
        if (surfaces.overlap(t) > p.set_back) {
          p.set_back = surfaces.overlap(t);
          p.whom = t.whom;
        }
      });
  }

  /// At the end of a step.
  void press() {
    touching = 0;
    for (PressingParticle<D>& p : particles) press(p);
  }

 private:
  double edge(const PressingParticle<D>& p) const { return std::pow(p.V0, 1.0 / D); }

  /// f(touch) for the bodies of which a particle feels points. What it lies higher over them than a
  /// point that touches, e / 2 - r, counts with what it is set back by.
  template <class F>
  void for_each_touch(const PressingParticle<D>& p, F&& f) {
    for (std::size_t b = 0; b < surfaces.bodies.size(); ++b) {
      SurfaceTouch<D> t{0, 0, static_cast<Whom>(b)};
      if (!surfaces.feel(t, p.x)) continue;
      t.b = 0.5 * surfaces.e - std::min(0.5 * edge(p), surfaces.e);
      if (p.whom == t.whom) t.b += p.set_back;
      t.k = 1.0;
      f(t);
    }
  }

  /// As stiff as its matter, behind a shock where it comes as fast as its waves, and as it has
  /// been.
  double stiffness(const PressingParticle<D>& p, const SurfaceTouch<D>& t, double approach) const {
    const Step<D>& step = surfaces.step;
    const double H = 0.25 * step.h, bears = 0.6 * step.h / step.dt;
    const double c = std::sqrt(p.M / p.density) + approach;
    const double M = std::min(std::max(p.density * c * c, 3.0 * p.pressure), p.now * bears * bears);
    const double k = std::pow(edge(p), D - 1) / (H / M + H * surfaces.other(t).compliance());
    return p.pressed && p.whom == t.whom ? std::max(k, p.k) : k;
  }

  /// How the surfaces slip on each other at the place of contact, in the middle of the overlap.
  Vec<double, D> slip_velocity(const PressingParticle<D>& p, SurfaceTouch<D>& t) {
    t.w = surfaces.step.h;
    surfaces.press(t, p.x);
    const double begun = surfaces.overlap(t) + 0.5 * t.w;
    t.slope = (2.0 * t.w / (t.k * begun * begun)) * t.push;
    const double r = std::min(0.5 * edge(p), surfaces.e);
    t.place = p.x - 0.5 * (r + t.z - 0.5 * surfaces.e) * normalised(t.slope);
    Vec<double, D> u = p.v;
    for (const Felt<D>& felt : t.felt) {
      SurfaceBody<D>& body = surfaces.other(t);
      u -= felt.share *
           felt.mirror.vector(body.velocity(body.points[felt.q], felt.mirror.place(t.place)));
    }
    return u;
  }

  double onset(const PressingParticle<D>& p, const SurfaceTouch<D>& t, double approach) const {
    const SurfaceBody<D>& b = surfaces.other(t);
    const double c = std::min(std::sqrt(p.M / p.density),
                              1.0 / std::sqrt(b.compliance() * b.body().material.density));
    const double h = surfaces.step.h;
    return std::min({h * approach / c, 0.2 * h, 0.8 * surfaces.e});
  }

  void press(PressingParticle<D>& p) {
    const double dt = surfaces.step.dt;
    const PressingParticle<D> before = p;
    p.push = p.rub = Vec<double, D>::zero();
    p.stored_push = p.stored_rub = p.set_back = 0.0;
    p.whom = -1;
    p.pressed = false;
    p.memory = {};
    std::vector<SurfaceTouch<D>> all;
    std::size_t main = 0;
    double most = 0.0;
    Vec<double, D> u_main;
    for_each_touch(before, [&](SurfaceTouch<D>& t) {
      if (!(surfaces.overlap(t) > -0.5 * std::min(0.2 * surfaces.step.h, 0.8 * surfaces.e))) return;
      const Vec<double, D> u = slip_velocity(before, t);
      const double speed = surfaces.approach(t, u);
      double w = before.memory.w, set_back = 0.0;
      if (t.whom != before.whom || !before.pressed)
        w = std::clamp(2.0 * (speed * dt - surfaces.overlap(t)), 0.0, onset(before, t, speed));
      t.push = Vec<double, D>::zero();
      if (t.whom == before.whom && before.set_back > 0.0) {
        const double slid = dt * norm(along(u, normalised(t.slope)));
        set_back = std::clamp(before.set_back - 2.0 * slid, 0.0,
                              std::max(surfaces.overlap(t) + before.set_back, 0.0));
      }
      const bool presses = surfaces.overlap(t) > -0.5 * w;
      if (presses) {
        t.w = w;
        t.k = stiffness(before, t, speed);
        p.stored_push += surfaces.press(t, p.x);
        p.push += t.push;
        ++touching;
      }
      if (set_back > 0.0 || (!(p.set_back > 0.0) && norm(t.push) > most)) {
        most = norm(t.push);
        main = all.size();
        u_main = u;
        p.whom = t.whom;
        p.pressed = presses;
        p.k = presses ? t.k : 0.0;
        p.set_back = set_back;
        p.memory = {t.whom == before.whom ? before.memory.s : Vec<double, D>::zero(),
                    presses ? w : 0.0};
      }
      all.push_back(t);
    });
    if (p.whom >= 0) rub(p, all[main], u_main);
    for (SurfaceTouch<D>& t : all)
      if (norm(t.push) > 0.0) surfaces.give_to_felt(t);
  }

  void rub(PressingParticle<D>& p, SurfaceTouch<D>& t, const Vec<double, D>& u) {
    Vec<double, D>& s = p.memory.s;
    const double f = norm(t.push), mu = surfaces.law.mu, k_t = 0.8 * t.k;
    if (!(mu > 0.0 && f > 0.0)) {
      s = Vec<double, D>::zero();
      return;
    }
    const Vec<double, D> n = normalised(t.push);
    if (norm(s) > 0.0) s = norm(s) * normalised(along(s, n));
    s += surfaces.step.dt * along(u, n);
    if (norm(s) > mu * f / k_t) s = (mu * f / k_t) * normalised(s);
    t.rubs = true;
    t.rub = p.rub = -k_t * s;
    p.place = t.place;
    p.stored_rub = 0.5 * k_t * dot(s, s);
  }
};

}  // namespace mpm::reference
