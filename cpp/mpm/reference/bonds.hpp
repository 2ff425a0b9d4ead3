#pragma once
// Bodies that are bonded by their surfaces, in the reference step (docs/theory/surface-contact.md,
// "Bonds").
#include "mpm/reference/surfaces.hpp"

namespace mpm::reference {

/// A point c of one body that is held to the place d of another, (S5).
template <int D>
struct Bond {
  std::size_t a, c, b;
  ContactPoint<D> d;  // carried as its nearest point is
  double k;           // [N/m]
};

/// Before Surfaces::start(): each point of a body that is bonded to another and touches it, by less
/// than e / 4, is held to where it lies there, by the host of the nearest point; by those that are
/// as near to rounding it is held by shares.
template <int D>
std::vector<Bond<D>> find_bonds(Surfaces<D>& surfaces) {
  std::vector<Bond<D>> bonds;
  surfaces.for_each_touch([&](const SurfaceTouch<D>& t) {
    if (is_wall(t.whom) || t.z > 1.25 * surfaces.e) return;
    const auto b = static_cast<std::size_t>(t.whom);
    if (b == t.body || !surfaces.law_of(t.body, b).bonded) return;
    const ContactPoint<D>& c = surfaces.point(t);
    const std::vector<ContactPoint<D>>& others = surfaces.bodies[b].points;
    double least = std::numeric_limits<double>::infinity();
    for (const ContactPoint<D>& q : others)
      if (q.A_felt > 0.0) least = std::min(least, square(q.x, c.x));
    std::vector<std::size_t> hosts;
    for (const ContactPoint<D>& q : others)
      if (q.A_felt > 0.0 && square(q.x, c.x) <= (1.0 + 1e-6) * least) hosts.push_back(q.host);
    for (const std::size_t host : hosts)
      bonds.push_back({t.body, t.point, b,
                       surfaces.bodies[b].point_at(c.X, c.N, c.behind, 0.0, host),
                       t.k / static_cast<double>(hosts.size())});
  });
  for (const Bond<D>& bond : bonds)
    surfaces.bonded.insert({bond.a, bond.c, static_cast<Whom>(bond.b)});
  return bonds;
}

/// After Surfaces::touch(): -dE/dx of E = k |x_c - x_d|^2 / 2 to both.
template <int D>
void pull(Surfaces<D>& surfaces, std::vector<Bond<D>>& bonds) {
  for (Bond<D>& bond : bonds) {
    SurfaceBody<D>&a = surfaces.bodies[bond.a], &b = surfaces.bodies[bond.b];
    const ContactPoint<D>& c = a.points[bond.c];
    b.place(bond.d);
    const Vec<double, D> force = bond.k * (bond.d.x - c.x);
    a.push(c, force);
    b.push(bond.d, -1.0 * force);
    a.stored_push += 0.5 * bond.k * square(bond.d.x, c.x);
  }
}

}  // namespace mpm::reference
