#pragma once
// Contact points on the surfaces of bodies, in the reference step
// (docs/theory/surface-contact.md): each knows its host, and by that its place, its velocity and
// the nodes on which a force acts.

#include "mpm/reference/kept_nodes.hpp"
#include "mpm/reference/prescribed.hpp"
#include "mpm/reference/rigid.hpp"

namespace mpm::reference {

/// A point behind a place X_s = X_p + d on the surface, p being its host. Of a body that does not
/// deform the host is a particle without mass where the point is, which moves as the body does.
template <int D>
struct ContactPoint {
  std::size_t host = 0;  // number of the particle
  Vec<double, D> d;      // from it to the surface, at the start [m]
  Vec<double, D> N;      // normal out of the body, at the start
  double behind = 0.0;   // how far the point lies behind the surface [m]
  double A = 0.0;        // area that it pushes for [m^2; in 2D m times 1 m]
  double A_felt = 0.0;   // of its face, by which others feel it [the same]
  int face = 0;          // of its body
  Vec<double, D> X, x;   // its place at the start, and now [m]

  /// From the host out of the body.
  Vec<double, D> out() const { return dot(d, N) * N; }
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
  ContactPoint<D> point_at(const Vec<double, D>& X, const Vec<double, D>& N, double behind,
                           double A, std::size_t nearest) {
    ContactPoint<D> c{nearest, Vec<double, D>::zero(), N, behind, A, A, 0, X, X};
    if (deforms()) {
      c.d = X + behind * N - body().particles[nearest].X;
      return c;
    }
    Particle<D> p{};
    p.x = p.X = X;
    c.host = whole->particles.size();
    whole->particles.push_back(p);
    return c;
  }

  /// F_p N.
  Vec<double, D> fibre(const ContactPoint<D>& c) const { return product(kept->F[c.host], c.N); }
  /// x_c = X_s + sum W_i u_i - (e / 2) F_p N / |F_p N|.
  void place(ContactPoint<D>& c) const {
    const Particle<D>& p = body().particles[c.host];
    c.x = p.x;
    if (!deforms()) return;
    c.x = p.X + c.d - c.behind * normalised(fibre(c));
    for_each_node(c, c.d, [&](const Index<D>& i, double W) { c.x += W * kept->u.at(i); });
  }

  /// f(i, W) for the nodes on which a force acts that the body feels at r from the host of a point.
  template <class F>
  void for_each_node(const ContactPoint<D>& c, const Vec<double, D>& r, F&& f) const {
    const Vec<double, D>& X = body().particles[c.host].X;
    for_each_node_at(kept->step, X, r, c.out(), f);
  }
  /// From the host of a point to the place in the body at the start that is at x.
  Vec<double, D> reach(const ContactPoint<D>& c, const Vec<double, D>& x) const {
    const Vec<double, D> x_s = c.x + c.behind * normalised(fibre(c));
    return c.d + product(inverse_of(kept->F[c.host]), x - x_s);
  }

  /// How fast the body moves there.
  Vec<double, D> velocity(const ContactPoint<D>& c, const Vec<double, D>& x) const {
    if (!deforms()) return from_space<D>(whole->motion.velocity_at(in_space<D>(x)));
    Vec<double, D> v = Vec<double, D>::zero();
    for_each_node(c, reach(c, x),
                  [&](const Index<D>& i, double W) { v += W * body().nodes.at(i).v; });
    return v;
  }

  /// A force t at a place x of the body.
  void rub(const ContactPoint<D>& c, const Vec<double, D>& x, const Vec<double, D>& t) {
    if (!deforms()) return push_whole(in_space<D>(x), in_space<D>(t));
    for_each_node(c, reach(c, x), [&](const Index<D>& i, double W) { add(i, W * t); });
  }
  /// A force t at the point: t . dx_c/du_i, with d(F N)/du_i = (N . grad N_i) 1.
  void push(const ContactPoint<D>& c, const Vec<double, D>& t) {
    if (!deforms()) return push_whole(in_space<D>(c.x), in_space<D>(t));
    for_each_node(c, c.d, [&](const Index<D>& i, double W) { add(i, W * t); });
    const Vec<double, D> g = fibre(c), n = normalised(g);
    const Vec<double, D> aside = (c.behind / norm(g)) * (t - dot(t, n) * n);
    kept->step.for_each_node(body().particles[c.host].X,
                             [&](const Index<D>& i, double, const Vec<double, D>& dN) {
                               add(i, -dot(c.N, dN) * aside);
                             });
  }
  void add(const Index<D>& i, const Vec<double, D>& t) {
    f.try_emplace(i, Vec<double, D>::zero()).first->second += t;
  }
  void push_whole(const Vector3& x, const Vector3& t) {
    force += t;
    moment += cross(x, t);
  }

  /// In the next step, before its nodes are turned.
  void give_to_nodes() {
    for (const auto& [i, t] : f) kept->body.nodes[i].f += t;
  }

  /// How it moves as a whole at the end of a step; the spin of one on nodes of its own is that of
  /// the body, of which these have more inertia.
  RigidMotion motion() const {
    if (!deforms()) return whole->motion;
    std::vector<Particle<D>> nodes;
    for (const auto& [i, node] : body().nodes) {
      Particle<D>& p = nodes.emplace_back();
      p.x = place(i);
      p.m = node.m;
      p.v = node.v;
    }
    RigidMotion all = motion_of(nodes);
    all.spin = kept->spin;
    return all;
  }
  double mass() const {
    double m = 0.0;
    for (const Particle<D>& p : body().particles) m += p.m;
    return m;
  }

  /// Where a node is by now.
  Vec<double, D> place(const Index<D>& i) const {
    Vec<double, D> x = kept->u.at(i);
    for (int a = 0; a < D; ++a) x[a] += kept->step.h * i[static_cast<std::size_t>(a)];
    return x;
  }

  /// What acts on a body that deforms as a whole comes to its nodes as m_i (a + alpha x r_i), r_i
  /// from the centre of mass, so that it strains nothing.
  void push_as_one() {
    if (!deforms()) return;
    const RigidMotion now = motion();
    const Vector3 alpha = spin_of(now.inertia, moment - cross(now.centre, force), now.free_axes);
    for (auto& [i, node] : kept->body.nodes) {
      const Vector3 r = in_space<D>(place(i)) - now.centre;
      node.f += node.m * from_space<D>((1.0 / mass()) * force + cross(alpha, r));
    }
  }

  /// To a rigid body by the laws of Newton and Euler: for as long as forces act on nodes of their
  /// own, gravity for the step.
  void push_rigid(const Step<D>& step) {
    if (deforms() || whole->prescribed()) return;
    const double acts = 0.5 * (step.dt + step.dt_before);
    const RigidMotion& now = whole->motion;
    const Vector3 dv = (acts / mass()) * force + step.dt * in_space<D>(step.g);
    const Vector3 spin =
        spin_of(now.inertia, acts * (moment - cross(now.centre, force)), now.free_axes);
    for (Particle<D>& p : whole->particles)
      p.v += from_space<D>(dv + cross(spin, in_space<D>(p.x) - now.centre));
  }

  void clear() {
    f.clear();
    force = moment = Vector3::zero();
    stored_push = stored_rub = 0.0;
  }
};

}  // namespace mpm::reference
