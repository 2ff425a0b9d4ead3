#include "mpm/surfaces/as_one.hpp"

#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {
template <int D>
void move_points_as_one(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  for (SurfacePart<D>& part : surfaces.parts) {
    if (!part.as_one) continue;
    part.square_of_step = 0.0;
    const Body<D>& body = domain.body_at(part.body);
    if (body.is_prescribed() ? !body.motion->moves : body.active() == 0) continue;
    const RigidMotion now = motion_as_one(domain, part.body);
    Vector3 before = now.centre - domain.time_step * now.velocity;
    Matrix3 turned;
    if (body.is_prescribed()) {
      turned = rotation(domain.time_step * now.spin);
    } else {
      before = domain.rigid_before[static_cast<std::size_t>(body.rigid)].centre;
      turned = domain.rigid_turns[static_cast<std::size_t>(body.rigid)];
    }
    for (std::uint32_t c = part.first_point; c < part.first_point + part.point_count; ++c) {
      const Vector3 x = now.centre + turned * (in_space<D>(surfaces.places[c]) - before);
      Vec<double, D> place;
      for (int a = 0; a < D; ++a) place[a] = x[a];
      move_point(surfaces, part, c, place);
    }
  }
}

template <int D>
void add_work_as_one(Domain<D>& domain, bool at_end) {
  PatchSums<D>* const counted = sums_as_one(domain);
  if (counted == nullptr) return;
  PatchSums<D>& sums = *counted;
  for (const ActingOnBody& on : domain.surfaces.on_bodies) {
    const RigidMotion motion = motion_as_one(domain, on.body);
    const auto work = [&](const Wrench& by) {
      return 0.5 * domain.time_step *
             (dot(by.force, motion.velocity) + dot(by.moment_about(motion.centre), motion.spin));
    };
    const double push = work(on.push), rub = work(on.rub), restitution = work(on.restitution);
    const double all = push + rub + restitution;
    sums.surface_push += push;
    sums.surface_rub += rub;
    sums.restitution += restitution;
    if (domain.body_at(on.body).is_prescribed()) {
      sums.prescribed.work += all;
    } else if (domain.body_at(on.body).keeps_nodes()) {
      sums.force_work -= all;
      sums.kept_shift += all;
      if (at_end) sums.kept_ahead += all;
    } else {
      // It changes the particles' velocities at once, which counts as made_rigid.
      sums.made_rigid += all;
      sums.transferred -= all;
      if (at_end) sums.kept_ahead += all;
    }
  }
}

template <int D>
void push_rigid_by_surfaces(Domain<D>& domain) {
  const double acts = time_of_forces(domain, true);
  for (const ActingOnBody& on : domain.surfaces.on_bodies) {
    const Body<D>& body = domain.body_at(on.body);
    if (body.keeps_nodes()) continue;  // turn_in_body()
    const Wrench all = on.all();
    if (body.is_prescribed()) {
      if (PatchSums<D>* const sums = sums_as_one(domain)) {
        for (int a = 0; a < D; ++a) sums->prescribed.impulse[a] += acts * all.force[a];
        sums->angular.on_prescribed += acts * all.moment;
      }
      continue;
    }
    const RigidMotion motion = motion_as_one(domain, on.body);
    const Vector3 change = (acts / body.total_mass) * all.force;
    const Vector3 spin =
        spin_of(motion.inertia, acts * all.moment_about(motion.centre), motion.free_axes);
    ParticlePool<D>& pool = domain.pool_of(body);
    for (const Patch<D>& patch : patches_of<D>(domain.grid.patches, on.body))
      for (const std::uint32_t row : pool.rows(patch)) {
        const Vector3 arm = in_space<D>(pool.position_of(row)) - motion.centre;
        const Vector3 v = change + cross(spin, arm);
        for (int a = 0; a < D; ++a) pool.v(a)[row] += static_cast<Storage>(v[a]);
      }
  }
}

template void move_points_as_one<2>(Domain<2>&);
template void move_points_as_one<3>(Domain<3>&);
template void add_work_as_one<2>(Domain<2>&, bool);
template void add_work_as_one<3>(Domain<3>&, bool);
template void push_rigid_by_surfaces<2>(Domain<2>&);
template void push_rigid_by_surfaces<3>(Domain<3>&);

}  // namespace mpm
