#pragma once
// Contact between the surfaces of bodies on nodes of their own, in the reference step: the
// equations of docs/theory/surface-contact.md as they stand there. Every point looks at every
// point of every other body; nothing is listed, and forces are derivatives of the energy.
#include <set>
#include <utility>

#include "mpm/reference/felt_surfaces.hpp"
#include "mpm/reference/levelled.hpp"

namespace mpm::reference {

/// Coulomb's coefficient of a face of the box for a body.
template <int D>
double friction_at_wall(const Step<D>& step, const Body<D>& body, Whom face) {
  return step.walls_of(body).friction[axis_of(face)][side_of(face)];
}

template <int D>
struct Surfaces : FeltSurfaces<D> {
  using Base = FeltSurfaces<D>;
  using Base::bodies, Base::e, Base::feel, Base::give_to_felt, Base::height_over, Base::other,
      Base::overlap, Base::press, Base::step;

  std::map<std::pair<std::size_t, std::size_t>, SurfaceLaw> laws{};  // the lower number first
  SurfaceLaw law{};                                                  // of all others, and of faces
  std::vector<SurfaceTouch<D>> touches{};                            // of this step
  using Of = std::tuple<std::size_t, std::size_t, Whom>;             // body, point, whom it touches
  std::map<Of, double> set_back{};                                   // b [m]
  std::map<Of, SurfaceLevelled<D>> levelled{};                       // b < 0, until they slide
  std::set<Of> bonded{};                                             // who does not push
  std::map<Of, SurfaceMemory<D>> kept{};                             // of who touches
  std::map<std::pair<std::size_t, Whom>, double> left{};             // of N in the step before
  std::map<std::pair<Whom, Whom>, double> approaches{};              // so far, fastest [m/s]

  SurfaceLaw law_of(std::size_t a, std::size_t b) const {
    const auto found = laws.find(std::minmax(a, b));
    return found != laws.end() ? found->second : law;
  }

  /// Before the first step: what lies in others is set back, so that springs just begin.
  void start() {
    for (SurfaceBody<D>& b : bodies)
      for (ContactPoint<D>& c : b.points) b.place(c);
    for_each_touch([&](const SurfaceTouch<D>& t) {
      if (overlap(t) > 0.0) set_back[{t.body, t.point, t.whom}] = overlap(t);
      if (const double sunk = sunk_where_drawn(*this, t); sunk > 0.0)
        levelled[{t.body, t.point, t.whom}] = {sunk, sunk};
    });
    for_each_near_touch([&](SurfaceTouch<D> t) {
      const double begun = overlap(t) + 0.5 * onset(t, approach(t, slip_velocity(t)));
      if (begun > 0.0) set_back[{t.body, t.point, t.whom}] += begun;
    });
  }

  /// At the end of a step: what acts in the next.
  void touch() {
    for (SurfaceBody<D>& b : bodies) {
      b.clear();
      for (ContactPoint<D>& c : b.points) b.place(c);
    }
    touches.clear();
    std::map<Of, SurfaceMemory<D>> now;
    std::vector<std::pair<std::pair<Whom, Whom>, double>> begun;
    keep_levelled(*this);
    for_each_near_touch([&](SurfaceTouch<D> t) {
      const Of of{t.body, t.point, t.whom};
      const bool begins = !kept.contains(of);
      const Vec<double, D> u = slip_velocity(t);
      const double speed = approach(t, u);
      SurfaceMemory<D> memory;
      if (begins)  // no more than since the step before
        memory.w = std::clamp(2.0 * (speed * step.dt - overlap(t)), 0.0, onset(t, speed));
      else
        memory = kept[of];
      if (!(overlap(t) > -0.5 * memory.w)) return;
      if (begins) begun.emplace_back(pair_of(t), speed);
      if (const auto level = levelled.find(of); level != levelled.end())
        level->second.slide(step.dt * along(u, normalised(t.slope)));
      t.w = memory.w;
      bodies[t.body].stored_push += press(t);
      rub(t, u, memory.s);
      give(t);
      now[of] = memory;
      touches.push_back(t);
    });
    kept = std::move(now);  // Who parts forgets.
    for (const auto& [pair, speed] : begun) approaches[pair] = std::max(approaches[pair], speed);
  }
  /// How fast the surfaces approach each other.
  double approach(const SurfaceTouch<D>& t, const Vec<double, D>& u) const {
    return std::max(-dot(t.slope, u), 0.0);
  }
  /// w of (S4): what the surfaces approach each other while the slower waves of the two bodies pass
  /// a cell, as they begin to overlap here or have anywhere before.
  double onset(const SurfaceTouch<D>& t, double approach) const {
    const auto waves = [](const SurfaceBody<D>& b) {
      return 1.0 / std::sqrt(b.compliance() * b.body().material.density);
    };
    double c = waves(bodies[t.body]);
    if (!is_wall(t.whom)) c = std::min(c, waves(other(t)));
    if (const auto before = approaches.find(pair_of(t)); before != approaches.end())
      approach = std::max(approach, before->second);
    return std::min({step.h * approach / c, 0.2 * step.h, 0.8 * e});
  }

  ContactPoint<D>& point(const SurfaceTouch<D>& t) { return bodies[t.body].points[t.point]; }

  /// f(touch) for those that may have begun, of the widest w.
  template <class F>
  void for_each_near_touch(F&& f) {
    for_each_touch([&](SurfaceTouch<D> t) {
      t.b = set_back_of(*this, t);
      if (overlap(t) > -0.5 * 0.2 * step.h) f(t);
    });
  }

  /// f(touch) for every point and every face that pushes back and every other body near it.
  template <class F>
  void for_each_touch(F&& f) const {
    for (std::size_t a = 0; a < bodies.size(); ++a)
      for (std::size_t p = 0; p < bodies[a].points.size(); ++p) {
        const double A = bodies[a].points[p].A, of_a = bodies[a].compliance();
        if (!(A > 0.0)) continue;
        const double H = 0.25 * step.h;
        const Walls<D> walls = step.walls_of(bodies[a].body());
        for (Whom face = -1; face >= -2 * D && bodies[a].deforms(); --face) {
          const auto axis = static_cast<std::size_t>(axis_of(face));
          if (!walls.exist || walls.face[axis][side_of(face)] != Wall::contact) continue;
          SurfaceTouch<D> t{a, p, face};
          t.z = height_over(face, bodies[a].points[p].x[axis_of(face)]);
          t.k = A / (H * of_a);
          f(t);
        }
        for (std::size_t b = 0; b < bodies.size(); ++b) {
          if (!bodies[a].deforms() && !bodies[b].deforms()) continue;
          SurfaceTouch<D> t{a, p, static_cast<Whom>(b)};
          if (bonded.contains({a, p, t.whom}) || !feel(t)) continue;
          t.k = 0.5 * A / (H * (of_a + bodies[b].compliance()));
          f(t);
        }
      }
  }

  /// That of a point: of its own body it feels what is more than four cells off in it, which may
  /// be folded.
  bool feel(SurfaceTouch<D>& t) const {
    const ContactPoint<D>& p = bodies[t.body].points[t.point];
    const bool itself = t.whom == static_cast<Whom>(t.body);
    return feel(t, p.x, [&](const ContactPoint<D>& c) {
      return itself && !(norm(c.X - p.X) > 4.0 * step.h);
    });
  }
  double press(SurfaceTouch<D>& t) { return press(t, point(t).x); }

  /// The dashpot (S6) of a point that slides with u [m/s]: all that presses by so much more.
  void damp(SurfaceTouch<D>& t, const Vec<double, D>& u) {
    const auto admittance = [](const SurfaceBody<D>& b) {
      return std::sqrt(b.compliance() / b.body().material.density);
    };
    const double A = point(t).A, of_a = admittance(bodies[t.body]), tiny = 1e-30 * e;
    const double eta = is_wall(t.whom) ? 0.4 * A / of_a : 0.2 * A / (of_a + admittance(other(t)));
    // k o, as it begins, and do/dt.
    const double spring =
        t.k * std::imag(stored(std::complex<double>(overlap(t), tiny), t.w)) / tiny;
    const double faster = -dot(t.push, u) / spring;
    const Vec<double, D> n = normalised(t.push);
    const double steep = std::abs(dot(u, n)) / norm(along(u, n));
    const double b = std::min(std::max(1.5 - 5.0 * steep, 0.0), 1.0);
    const double more = std::max(1.0 + b * eta * faster / spring, 0.01);
    t.push = more * t.push;
    for (Felt<D>& felt : t.felt) felt.push = more * felt.push;
  }

  void give(SurfaceTouch<D>& t) {
    SurfaceBody<D>& own = bodies[t.body];
    own.push(point(t), t.push);
    if (t.rubs) own.rub(point(t), t.place, t.rub);
    give_to_felt(t);
  }
  /// The coefficient, times what of the normal force the two felt in the step before.
  double friction_of(const SurfaceTouch<D>& t) const {
    const auto b = static_cast<std::size_t>(t.whom);
    const bool wall = is_wall(t.whom), first = wall || t.body < b;
    const double mu =
        wall ? friction_at_wall(step, bodies[t.body].body(), t.whom) : law_of(t.body, b).mu;
    const auto pair = left.find({first ? t.body : b, first ? t.whom : static_cast<Whom>(t.body)});
    return pair == left.end() ? mu : pair->second * mu;
  }

  /// How the surfaces of a touch move on each other at x_0 = x_p - z n / 2, on a face its foot; by
  /// the way where a spring pushes that has begun long before.
  Vec<double, D> slip_velocity(SurfaceTouch<D>& t) {
    t.w = step.h;
    press(t);
    const double begun = overlap(t) + 0.5 * t.w;
    t.slope = (2.0 * t.w / (t.k * begun * begun)) * t.push;
    const Vec<double, D> n = normalised(t.slope);
    t.place = point(t).x - (is_wall(t.whom) ? 1.0 : 0.5) * t.z * n;
    Vec<double, D> u = bodies[t.body].velocity(point(t), t.place);
    for (const Felt<D>& felt : t.felt)
      u -= felt.share * felt.mirror.vector(
                            other(t).velocity(other(t).points[felt.q], felt.mirror.place(t.place)));
    return u;
  }

  /// (S2) at x_0: what s has along the normal by now is turned into the plane, to keep its length.
  void rub(SurfaceTouch<D>& t, const Vec<double, D>& u, Vec<double, D>& s) {
    const double f = norm(t.push), mu = friction_of(t), k_t = 0.8 * t.k;
    const Vec<double, D> n = normalised(t.push);
    t.rub = Vec<double, D>::zero();
    if (!(mu > 0.0 && f > 0.0)) return;
    if (norm(s) > 0.0) s = norm(s) * normalised(along(s, n));
    s += step.dt * along(u, n);
    t.slides = norm(s) > mu * f / k_t;
    if (t.slides) {
      damp(t, u);
      s = std::min(norm(s), mu * norm(t.push) / k_t) * normalised(s);
    }
    t.rubs = true;
    t.rub = -k_t * s;
    bodies[t.body].stored_rub += 0.5 * k_t * dot(s, s);
  }
};

}  // namespace mpm::reference
