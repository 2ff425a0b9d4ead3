#pragma once
// Contact points on the surfaces of bodies, in the reference step
// (docs/theory/surface-contact.md): each knows its host, and by that its place, its velocity and
// the nodes on which a force acts.
#include "mpm/reference/kept_nodes.hpp"
#include "mpm/reference/prescribed.hpp"

namespace mpm::reference {

/// A point at X_c = X_p + d in the body, p being its host. Of a body that does not deform the host
/// is a particle without mass where the point is, which moves as the body does.
template <int D>
struct ContactPoint {
  std::size_t host = 0;  // number of the particle
  Vec<double, D> d;      // from it, at the start [m]
  double A = 0.0;        // its share of the area [m^2; in 2D m times 1 m]
  Vec<double, D> X, x;   // its place at the start, and now [m]
};

/// A body with points on its surface, and what acts on it in the coming step.
template <int D>
struct SurfaceBody {
  KeptNodes<D>* kept = nullptr;  // on nodes of its own, or else
  Body<D>* whole = nullptr;      // one that does not deform
  std::vector<ContactPoint<D>> points{};
  std::map<Index<D>, Vec<double, D>> f{};                     // on its nodes [N]
  Vector3 force = Vector3::zero(), moment = Vector3::zero();  // on it as a whole, about 0
  double stored_push = 0.0, stored_rub = 0.0;                 // in springs of its points [J]

  bool deforms() const { return kept != nullptr; }
  const Body<D>& body() const { return kept ? kept->body : *whole; }

  /// 1 / M, M = rho c^2 at the start.
  double compliance() const {
    const Elastic& law = body().material;
    return deforms() ? 1.0 / (law.lambda + 2.0 * law.G) : 0.0;
  }

  /// One where X lies by now, which is at the start.
  ContactPoint<D> point_at(const Vec<double, D>& X, double A, std::size_t nearest) {
    ContactPoint<D> c{nearest, Vec<double, D>::zero(), A, X, X};
    if (deforms()) {
      c.d = X - body().particles[nearest].X;
      return c;
    }
    Particle<D> p{};
    p.x = p.X = X;
    c.host = whole->particles.size();
    whole->particles.push_back(p);
    return c;
  }

  /// x_c = x_p + F_p d.
  void place(ContactPoint<D>& c) const {
    c.x = body().particles[c.host].x;
    if (deforms()) c.x += product(kept->F[c.host], c.d);
  }

  /// f(i, W) with W = N_i(X_p) + r . grad N_i(X_p), for the nodes on which a force at x acts that
  /// the body feels through the host of a point: r = d + F_p^-1 (x - x_c), d for the point itself.
  template <class F>
  void for_each_node(const ContactPoint<D>& c, const Vec<double, D>& x, F&& f) const {
    const Vec<double, D> r = c.d + product(inverse_of(kept->F[c.host]), x - c.x);
    kept->step.for_each_node(
        body().particles[c.host].X,
        [&](const Index<D>& i, double N, const Vec<double, D>& dN) { f(i, N + dot(r, dN)); });
  }

  /// How fast the body moves there.
  Vec<double, D> velocity(const ContactPoint<D>& c, const Vec<double, D>& x) const {
    if (!deforms()) return from_space<D>(whole->motion.velocity_at(in_space<D>(x)));
    Vec<double, D> v = Vec<double, D>::zero();
    for_each_node(c, x, [&](const Index<D>& i, double W) { v += W * body().nodes.at(i).v; });
    return v;
  }

  /// A force t at x.
  void push(const ContactPoint<D>& c, const Vec<double, D>& x, const Vec<double, D>& t) {
    if (!deforms()) return push_whole(in_space<D>(x), in_space<D>(t));
    for_each_node(c, x, [&](const Index<D>& i, double W) {
      f.try_emplace(i, Vec<double, D>::zero()).first->second += W * t;
    });
  }
  void push_whole(const Vector3& x, const Vector3& t) {
    force += t;
    moment += cross(x, t);
  }

  /// In the next step, before its nodes are turned.
  void give_to_nodes() {
    for (const auto& [i, t] : f) kept->body.nodes[i].f += t;
  }

  /// To a rigid body by the laws of Newton and Euler: for as long as forces act on nodes of their
  /// own, gravity for the step.
  void push_rigid(const Step<D>& step) {
    if (deforms() || whole->prescribed()) return;
    const double acts = 0.5 * (step.dt + step.dt_before);
    const RigidMotion& motion = whole->motion;
    double m = 0.0;
    for (const Particle<D>& p : whole->particles) m += p.m;
    const Vector3 dv = (acts / m) * force + step.dt * in_space<D>(step.g);
    const Vector3 spin =
        spin_of(motion.inertia, acts * (moment - cross(motion.centre, force)), motion.free_axes);
    for (Particle<D>& p : whole->particles)
      p.v += from_space<D>(dv + cross(spin, in_space<D>(p.x) - motion.centre));
  }

  void clear() {
    f.clear();
    force = moment = Vector3::zero();
    stored_push = stored_rub = 0.0;
  }
};

}  // namespace mpm::reference
