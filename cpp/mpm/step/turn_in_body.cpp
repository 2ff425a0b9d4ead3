// Bodies on nodes of their own turn as their particles would, not as their nodes
// (particles/kept_spin.hpp): with the angular momentum L of the body, which the moment T of all
// forces changes, the nodes shall have I (I - D)^-1 L by the end of the step. What they lack of it
// besides T is given to them as that of forces m_i alpha x r_i about the centre of mass. So is in
// the step after what (M5) has taken of it as the step changed.
#include "mpm/followers/follow.hpp"
#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/sum_over_bodies.hpp"
#include "mpm/surfaces/restitution.hpp"

namespace mpm {
namespace {

/// Of the nodes of a body, about a point.
struct TurningSums {
  RigidSums motion;                  // mass, place, momentum, angular momentum, inertia
  Vector3 moment = Vector3::zero();  // of the forces [N m]
  Vector3 force = Vector3::zero();   // [N]

  void add(const TurningSums& other) {
    const RigidSums& of = other.motion;
    motion.mass += of.mass;
    motion.first += of.first;
    motion.momentum += of.momentum;
    motion.angular += of.angular;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) motion.inertia[i][j] += of.inertia[i][j];
    moment += other.moment;
    force += other.force;
  }
};

template <int D>
TurningSums sums_of_nodes(Domain<D>& domain, std::size_t p, const Vector3& about) {
  TurningSums sums;
  const Patch<D>& patch = domain.grid.patches[p];
  const NodeBlock<D> block = domain.grid.block(p);
  double own[BlockShape<D>::nodes_max];
  own_nodes(domain.grid, patch, own);
  const Vector3 corner = place_of(domain.grid, patch, patch.shape.low) - about;
  const Index<D>& nodes = patch.shape.nodes;
  Vector3 first = Vector3::zero(), momentum = first, angular = first, force = first, moment = first;
  double mass = 0.0, second[3][3] = {};
  Index<D> at{};
  for (int n = 0; n < block.count; ++n) {
    const double* const numbers = block.records[n];
    if (const double m = own[n] * numbers[mass_at]; m > 0.0) {
      Vector3 r = corner, v = Vector3::zero(), f = v;
      for (int a = 0; a < D; ++a) {
        r[a] += domain.grid.cell_size * at[static_cast<std::size_t>(a)] + block.displacements[n][a];
        v[a] = numbers[velocity_at + a];
        f[a] = numbers[force_at + a];
      }
      const Vector3 mr = m * r;
      mass += m;
      first += mr;
      momentum += m * v;
      angular += cross(mr, v);
      force += f;
      moment += cross(r, f);
      for (int i = 0; i < D; ++i)
        for (int j = i; j < D; ++j) second[i][j] += mr[i] * r[j];
    }
    for (std::size_t a = 0; a < D && ++at[a] == nodes[a]; ++a) at[a] = 0;
  }
  RigidSums& motion = sums.motion;
  motion.mass += mass;
  motion.first += first;
  motion.momentum += momentum;
  motion.angular += angular;
  sums.force += force;
  sums.moment += moment;
  const double trace = second[0][0] + second[1][1] + second[2][2];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      motion.inertia[i][j] += (i == j ? trace : 0.0) - (i <= j ? second[i][j] : second[j][i]);
  return sums;
}

/// Forces m (g + alpha x r) to the nodes of a patch, r from a centre. Patches that hold a node get
/// the same bits, as places are those of its index in the grid: copies of a node that differ by
/// rounding would drift apart, d'' = alpha x d, and tear the body after 100,000 steps of hits.
template <int D>
void add_forces(Domain<D>& domain, std::size_t p, const Vector3& centre, const Vector3& straight,
                const Vector3& alpha) {
  const Patch<D>& patch = domain.grid.patches[p];
  const NodeBlock<D> block = domain.grid.block(p);
  for (int n = 0; n < block.count; ++n) {
    double* const numbers = block.records[n];
    const Vector3 r = place_of_kept(domain.grid, patch, block, n) - centre;
    const Vector3 g = straight + cross(alpha, r);
    for (int a = 0; a < D; ++a) numbers[force_at + a] += numbers[mass_at] * g[a];
  }
}

/// About the centre of mass, which moves to it.
void move_to_centre(TurningSums& sums, Vector3& centre) {
  RigidSums& s = sums.motion;
  const Vector3 c = (1.0 / s.mass) * s.first;
  s.angular = s.angular - cross(c, s.momentum);
  sums.moment = sums.moment - cross(c, sums.force);
  const double square = dot(c, c);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) s.inertia[i][j] -= s.mass * ((i == j ? square : 0.0) - c[i] * c[j]);
  centre += c;
}

/// What acts on a body as a whole.
template <int D>
Wrench acting_as_whole(const Domain<D>& domain, int body) {
  const auto& all = domain.surfaces.on_bodies;
  const auto at = std::ranges::lower_bound(all, body, {}, &ActingOnBody::body);
  return at != all.end() && at->body == body ? at->all() : Wrench{};
}

/// The angular acceleration that the nodes lack, and what the body has by the end of the step.
template <int D>
Vector3 lacking(const Domain<D>& domain, const Patch<D>& patch, const TurningSums& sums,
                const Vector3& moment, KeptSpin& turning) {
  constexpr unsigned axes = D == 2 ? 4u : 7u;
  const Matrix3& I = sums.motion.inertia;
  Matrix3 of_body = I;
  for (int a = 0; a < 3; ++a) of_body[a][a] -= turning.excess;
  const auto of_particles = [&](const Vector3& nodes) {  // L of the body, of that of its nodes
    return nodes - turning.excess * spin_of(I, nodes, axes);
  };
  const double acts = time_of_forces(domain, patch);
  const Vector3 now = sums.motion.angular;
  // What has changed the nodes beside forces, as damping or what sets velocities.
  if (!turning.begun)
    turning.momentum = of_particles(now);
  else if (domain.shift_before == 0.0)
    turning.momentum += of_particles(now - turning.of_nodes);
  turning.begun = true;
  turning.momentum += acts * (sums.moment + moment);
  turning.spin = spin_of(of_body, turning.momentum, axes);
  if constexpr (D == 3) {
    // L is that of the middle of the step, when the body has turned by half of it.
    const Matrix3 turned = rotation(0.5 * domain.time_step * turning.spin);
    of_body = turned * of_body * transposed(turned);
    turning.spin = spin_of(of_body, turning.momentum, axes);
  }
  turning.of_nodes = of_body * turning.spin + turning.excess * turning.spin;
  if constexpr (D == 2) turning.of_nodes = {0.0, 0.0, turning.of_nodes[2]};
  const Vector3 lacks = turning.of_nodes - now - acts * sums.moment;
  return acts > 0.0 ? (1.0 / acts) * spin_of(I, lacks, axes) : Vector3::zero();
}

}  // namespace

template <int D>
void turn_in_body(Domain<D>& domain) {
  give_forces_to_leading(domain);
  const auto of_patch = [&](std::size_t p, const KeptSpin& turning) {
    return sums_of_nodes(domain, p, turning.centre);
  };
  // What has no excess turns as its nodes do; restitution asks how it moves, (M5) how it speeds up.
  const bool all = restitution_takes(domain.contact_settings) || domain.shift != 0.0 ||
                   domain.shift_before != 0.0;
  const auto wanted = [&](const KeptSpin& turning) { return all || turning.excess > 0.0; };
  for (KeptSpin& turning : domain.kept_spins) turning.begun = turning.begun && wanted(turning);
  sum_over_bodies<TurningSums>(
      domain, wanted, of_patch, [&](KeptSpin& turning, TurningSums sums, std::size_t first) {
        move_to_centre(sums, turning.centre);
        const auto patches = patches_of<D>(domain.grid.patches, turning.body);
        const Wrench as_whole = acting_as_whole(domain, turning.body);
        const Vector3 straight = (1.0 / sums.motion.mass) * as_whole.force;
        turning.acceleration =
            (1.0 / sums.motion.mass) * sums.force + straight + in_space<D>(domain.gravity);
        for (int a = 0; a < D; ++a)
          if (turning.held >> a & 1u) turning.acceleration[a] = 0.0;
        if (turning.held != 0) return;
        turning.velocity = (1.0 / sums.motion.mass) * sums.motion.momentum +
                           time_of_forces(domain, patches[0]) * turning.acceleration;
        const Vector3 alpha =
            lacking(domain, patches[0], sums, as_whole.moment_about(turning.centre), turning);
        // Kinetic energy is that of the body too.
        if (first != of_another_rank)
          domain.sums[first].kept_ahead -= 0.5 * turning.excess * dot(turning.spin, turning.spin);
        for (const Patch<D>& patch : patches)
          add_forces(domain, static_cast<std::size_t>(&patch - domain.grid.patches.data()),
                     turning.centre, straight, alpha);
      });
}

template void turn_in_body<2>(Domain<2>&);
template void turn_in_body<3>(Domain<3>&);

}  // namespace mpm
