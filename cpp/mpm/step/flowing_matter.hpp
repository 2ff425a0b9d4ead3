#pragma once
// Gases and liquids with an affine transfer. A particle's own pressure works on its own affine
// part, whose inertia is m D an axis: its heat would go into a motion that the next step takes
// away, and its volume grow without end. So a volume may not grow beyond the room that the grid has
// for it, and a gas is heated by the work of the very forces that have acted and by all that the
// transfer takes of its motion (docs/theory/step.md, "Matter that flows"; decision 0062).
#include <algorithm>
#include <cmath>

#include "mpm/domain.hpp"
#include "mpm/schedule/choose.hpp"
#include "mpm/step/transfer/apic.hpp"

namespace mpm {

/// Of the volume of a cell what the particles' volumes may fill before no more of them grows. Above
/// 1, as particles at random places fill cells unevenly.
inline constexpr double most_filled = 1.12;

/// The room of particles that are being advanced, and what the transfer takes of them, which is
/// heat again: from the same nodes and weights.
template <class T, int D>
class FlowingMatter {
 public:
  FlowingMatter(const TileGrid<D>& grid, ParticlePool<D>& pool, const Material& material,
                double time_step)
      : time_step_(time_step),
        cell_volume_(std::pow(grid.cell_size, D)),
        moment_(grid.affine_moment()),
        density_(material.density),
        lowest_energy_(std::max(material.bounds.lowest_energy, 0.0)) {
    const auto column = [&](int at) { return at >= 0 ? pool.columns.component(at) : nullptr; };
    mass_ = pool.mass();
    volume_ = pool.volume();
    growth_limit_ = column(pool.at.growth_limit);
    owed_ = column(pool.at.heat_owed);
    energy_ = column(pool.at.energy);
    recoverable_ = column(pool.at.recoverable);
    for (int a = 0; a < D; ++a) v_[a] = pool.v(a);
    for (int k = 0; k < D * D; ++k) affine_[k] = pool.affine_part(k);
  }

  /// Before the particles take anything from the nodes.
  template <class Rows>
  MPM_INLINE void begin(const Rows& rows) {
    if (owed_ != nullptr) before_ = square_with(rows, affine(rows));
  }
  /// When they have taken their velocities; `dv`: the sum of N_ip dv_i.
  template <class Rows, class Field, class W>
  MPM_INLINE void end(const Rows& rows, const Field& nodes, const W& w, const Vec<T, D>& dv) {
    limit_growth(rows, nodes, w);
    if (owed_ != nullptr) give_back(rows, nodes, w, dv);
  }
  void write(PatchSums<D>& sums) const {
    sums.returned = sum(returned_);
    sums.unseen = sum(unseen_);
  }

 private:
  /// The volume up to which they may grow: the room that the cells have for all matter, shared out
  /// by volume; V most_filled / phi, phi = sum N_ip V_i / h^D with V_i = sum V_p N_ip.
  template <class Rows, class Field, class W>
  MPM_INLINE void limit_growth(const Rows& rows, const Field& nodes, const W& w) const {
    const T filled = nodes.template value<volume_at>(w);
    store(growth_limit_, rows, T(most_filled * cell_volume_) * load(volume_, rows) / filled);
  }

  /// E += what the transfer takes: the kinetic energy that the nodes give, dt f . (v_i + dv_i / 2)
  /// shared out by N_ip, less that which the particle gets, once C_p has been carried along.
  template <class Rows, class Field, class W>
  MPM_INLINE void give_back(const Rows& rows, const Field& nodes, const W& w, const Vec<T, D>& dv) {
    const T all = load(mass_, rows), per_volume = T(density_) / all;
    // As Moving does it with a body that owes heat.
    const T after =
        square_with(rows, carried_along(affine(rows), T(time_step_), Closing::as_it_would));
    const T gained = nodes.template gain<velocity_at, increment_at>(w);
    T energy = load(energy_, rows);
    const T owed = fma(all, fma(T(0.5), before_ - after, gained), load(owed_, rows));
    // No more than a tenth of the heat is taken in a step, and what is below absolute zero is lent.
    const T heat = max(energy - T(lowest_energy_), T(0.0)) / per_volume;
    T given = max(owed, T(-0.1) * heat);
    energy = fma(given, per_volume, energy);
    given += max(T(lowest_energy_) - energy, T(0.0)) / per_volume;
    store(energy_, rows, max(energy, T(lowest_energy_)));
    store(owed_, rows, owed - given);
    if (recoverable_) store(recoverable_, rows, fma(given, per_volume, load(recoverable_, rows)));
    T together(0.0);
    unrolled<D>([&](auto a) MPM_INLINE { together = fma(dv[a], dv[a], together); });
    const T m = of_valid(rows, all);
    returned_ = fma(m / all, given, returned_);
    unseen_ = fma(T(0.5) * m, nodes.template square<increment_at>(w) - together, unseen_);
  }
  template <class Rows>
  MPM_INLINE Mat<T, D> affine(const Rows& rows) const {
    Mat<T, D> C;
    unrolled<D * D>([&](auto k) MPM_INLINE { C[k / D][k % D] = load(affine_[k], rows); });
    return C;
  }
  /// v_p^2 + D C : C: twice the kinetic energy over the mass.
  template <class Rows>
  MPM_INLINE T square_with(const Rows& rows, const Mat<T, D>& C) const {
    T v2(0.0), C2(0.0);
    unrolled<D>([&](auto a) MPM_INLINE {
      const T v = load(v_[a], rows);
      v2 = fma(v, v, v2);
    });
    unrolled<D * D>([&](auto k) MPM_INLINE { C2 = fma(C[k / D][k % D], C[k / D][k % D], C2); });
    return fma(T(moment_), C2, v2);
  }

  // In each lane [J]: what has been given back as heat; kinetic energy that the nodes' increments
  // hold beyond those of particles. And square_with() what they had.
  T returned_{0.0}, unseen_{0.0}, before_{0.0};
  double time_step_, cell_volume_, moment_, density_, lowest_energy_;
  const double *mass_, *volume_;
  double *growth_limit_, *owed_, *energy_, *recoverable_;
  const Storage *v_[D], *affine_[D * D];
};

}  // namespace mpm
