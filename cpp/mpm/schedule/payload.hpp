#pragma once
// What particles give to the nodes around them, laid out as a schedule sums it.
#include "mpm/layout/node_batch.hpp"
#include "mpm/layout/node_records.hpp"
#include "mpm/math/tensor.hpp"

namespace mpm {

/// What is scattered: a sum of these. Forces come with neither or with both of the others; MUSL's
/// remap gives momentum alone, onto the mass of the first mapping. With the momentum may come its
/// affine part.
enum Gives : unsigned { gives_mass = 1, gives_momentum = 2, gives_forces = 4, gives_affine = 8 };

/// Of some particles of a cell, one after another, as far as it is scattered: where nodes are the
/// lanes. Columns, since registers of particles are written as they are and single numbers are
/// read, each repeated over the nodes.
template <int D, int room>
struct PayloadColumns {
  double mass[room];                            // [kg]
  double velocity[D][room];                     // [m/s]
  double traction[Sym<double, D>::size][room];  // components of -V_p (sigma_p - q_p 1) / h [N]

  /// Of the particles in the lanes, from place `at` on: whole registers, so that `room` must leave
  /// space for the lanes that hold no particle (CellBuffer).
  template <unsigned /*what*/, class T>
  void add(int at, T m, const Vec<T, D>& v) {
    store_lanes(mass + at, m);
    unrolled<D>([&](auto a) { store_lanes(velocity[a] + at, v[a]); });
  }
  template <class T>
  void add_tractions(int at, const Sym<T, D>& t) {
    unrolled<Sym<T, D>::size>([&](auto c) { store_lanes(traction[c] + at, t.c[c]); });
  }
};

/// The same where the numbers of half a node's record are the lanes. With a one before the velocity
/// (1, v) m_p N_ip is (m_ip, p_ip): mass and momentum of eqs. (2) and (3) in one multiply-add. The
/// registers of particles are transposed once here and not for each layer of nodes (decision 0024).
template <int D, int room>
struct PayloadRecords {
  static constexpr std::size_t alignment = half_record * sizeof(double);
  double mass[room];                                         // [kg]
  alignas(alignment) double velocity[room][half_record];     // behind a one, if mass is given
  alignas(alignment) double traction[D][room][half_record];  // a column of the tensor each
  alignas(alignment) double affine[D][room][half_record];    // likewise of m_p C_p h, behind a zero

  template <unsigned what, class T>
  void add(int at, T m, const Vec<T, D>& v) {
    const T none(0.0), z = D == 3 ? v[D - 1] : none;
    store_lanes(mass + at, m);
    if constexpr ((what & gives_mass) != 0)
      // As the record has them: mass_at before velocity_at.
      lay_out(velocity + at, T(1.0), v[0], v[1], z);
    else
      lay_out(velocity + at, v[0], v[1], z, none);
  }
  /// With the affine part, G = C h: all with the mass in, m (1, v) and m (0, column of G).
  template <unsigned what, class T>
  void add(int at, T m, const Vec<T, D>& v, const Mat<T, D>& G) {
    store_lanes(mass + at, m);
    const auto with_mass = [&](double (*to)[half_record], T first, auto&& component) MPM_INLINE {
      const T none(0.0), z = D == 3 ? component(D - 1) : none;
      if constexpr ((what & gives_mass) != 0)
        lay_out(to + at, first, component(0), component(1), z);
      else
        lay_out(to + at, component(0), component(1), z, none);
    };
    with_mass(velocity, m, [&](int a) MPM_INLINE { return m * v[a]; });
    unrolled<D>([&](auto b) MPM_INLINE {
      with_mass(affine[b], T(0.0), [&](int a) MPM_INLINE { return m * G[a][b]; });
    });
  }
  template <class T>
  void add_tractions(int at, const Sym<T, D>& t) {
    const T none(0.0);
    // By columns: f = sum over b of t_b dN/dxi_b is then a sum of vectors. t is symmetric.
    unrolled<D>([&](auto b) MPM_INLINE {
      lay_out(traction[b] + at, t(0, b), t(1, b), D == 3 ? t(D - 1, b) : none, none);
    });
  }
  /// Of nodes in the body, where it is not symmetric: [a][b] of component a by derivatives along b.
  template <class T>
  void add_tractions(int at, const Mat<T, D>& t) {
    const T none(0.0);
    unrolled<D>([&](auto b) MPM_INLINE {
      lay_out(traction[b] + at, t[0][b], t[1][b], D == 3 ? t[D - 1][b] : none, none);
    });
  }

 private:
  template <class T>
  static void lay_out(double (*to)[half_record], T a, T b, T c, T d) {
    transpose_to_nodes(a, b, c, d, [&](int k, Batch<half_record> q) MPM_INLINE { q.store(to[k]); });
  }
};

}  // namespace mpm
