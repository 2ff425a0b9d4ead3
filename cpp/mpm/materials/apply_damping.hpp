#pragma once
// The last part of a block's way where the material is damped in proportion to its stiffness: the
// stress of that, which nodal forces use beside the other.
#include "mpm/materials/stress_writer.hpp"

namespace mpm {

/// s = beta C : D, C : D = lambda tr(D) 1 + 2 G D, of the rate D that has strained the material in
/// this step; 2 G (D - tr(D) / d 1) in d dimensions where the damping is of the shape alone. The
/// volumes are those of after the step.
template <class T, int D, int N>
MPM_FLATTEN MPM_HD void apply_damping(const MaterialView& material, const BlockColumns<D>& columns,
                                      const StressSettings& settings,
                                      const MaterialBlock<D, N>& block, StressSums& sums) {
  const StiffnessDamping& damping = material.damping;
  const double per_step = damping.beta / settings.time_step;
  const T two_G(2.0 * per_step * damping.shear),
      lambda(damping.of_shape ? -2.0 * per_step * damping.shear / D
                              : per_step * (damping.pressure - 2.0 * damping.shear));
  T work(0.0), power(0.0);
  for_each_group<T>(block, [&](const Group<T, D>& group) {
    const Mat<T, D> gradient = gradient_of(group, block);
    const Sym<T, D> strain = symmetric_part(gradient);
    Sym<T, D> before, after = two_G * strain + Sym<T, D>::isotropic(lambda * trace(strain));
    // What has failed has no stiffness.
    if (columns.failed) {
      const auto intact = group.read(columns.failed) < T(1.0);
      for (int c = 0; c < Sym<T, D>::size; ++c) after.c[c] = select(intact, after.c[c], T(0.0));
    }
    for (int c = 0; c < Sym<T, D>::size; ++c) {
      before.c[c] = group.read(columns.damping_stress[c]);
      group.write(columns.damping_stress[c], after.c[c]);
    }
    const T volume = group.read(columns.volume), done = volume * inner(after, strain);
    work += done;
    if (settings.forces_follow) {
      power += done;
      return;
    }
    // The forces have used the stress of the step before, with the volume before.
    Mat<T, D> f = gradient;
    for (int a = 0; a < D; ++a) f[a][a] += T(1.0);
    power += volume / determinant(f) * inner(before, strain);
  });
  sums.damped += sum(work);
  sums.force_power += sum(power);
}

}  // namespace mpm
