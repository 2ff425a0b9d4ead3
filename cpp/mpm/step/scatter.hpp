#pragma once
// From particles to nodes. A cell's nodes are the lanes, so that sums stay in registers for all
// particles of the cell; what the particles give is first laid out in the first cache.
#include "mpm/step/cell_loop.hpp"

namespace mpm {

/// What is scattered: any sum of these.
enum Gives : unsigned { gives_mass = 1, gives_momentum = 2, gives_forces = 4 };

/// Up to `room` particles of a cell, one after another.
template <int D>
struct CellParticles {
  using T = Batch<native_lanes>;
  static constexpr int room = 16;
  static constexpr int parts = Sym<T, D>::size;
  int count = 0;
  double xi[D][room];            // position in the cell
  double mass[room];             // [kg]
  double velocity[D][room];      // [m/s]
  double traction[parts][room];  // -V_p (sigma_p - q_p 1) / h [N]

  /// The first `added` lanes; what they give is added before or after.
  void add(const Vec<T, D>& position, T m, const Vec<T, D>& v, int added) {
    unrolled<D>([&](auto a) {
      position[a].store(xi[a] + count);
      v[a].store(velocity[a] + count);
    });
    m.store(mass + count);
    count += added;
  }
};

/// Takes what particles give out of the columns of a body.
template <unsigned what, int D>
class Givers {
 public:
  using T = Batch<native_lanes>;
  Givers(const TileGrid<D>& grid, const Body<D>& body)
      : local_position_(grid, body), minus_per_cell_size_(-1.0 / grid.cell_size) {
    mass_ = body.mass();
    volume_ = body.volume();
    if (const int q = body.at.viscosity_pressure; q >= 0) q_ = body.columns.component(q);
    for (int a = 0; a < D; ++a) velocity_[a] = body.v(a);
    for (int c = 0; c < CellParticles<D>::parts; ++c) stress_[c] = body.stress(c);
  }

  template <class Rows>
  void add(CellParticles<D>& to, const CellRange<D>& cell, const Rows& rows) const {
    if constexpr ((what & gives_forces) != 0) {
      const T scale = T(minus_per_cell_size_) * load(volume_, rows);
      const T q = q_ ? load(q_, rows) : T(0.0);
      unrolled<CellParticles<D>::parts>([&](auto c) {
        const T stress = load(stress_[c], rows);
        (scale * (c < D ? stress - q : stress)).store(to.traction[c] + to.count);
      });
    }
    const Vec<T, D> xi = local_position_(cell, rows);
    if constexpr ((what & gives_momentum) != 0) {
      Vec<T, D> v;
      unrolled<D>([&](auto a) { v[a] = load(velocity_[a], rows); });
      to.add(xi, load(mass_, rows), v, rows.count);
    } else {
      unrolled<D>([&](auto a) { xi[a].store(to.xi[a] + to.count); });
      to.count += rows.count;
    }
  }

 private:
  LocalPosition<D> local_position_;
  double minus_per_cell_size_;
  const double *mass_, *volume_, *q_ = nullptr, *velocity_[D], *stress_[CellParticles<D>::parts];
};

/// Mass (if asked for) and momentum of a cell's particles, eqs. (2)-(3); `momentum(a)` is the
/// nodal field of component a.
template <bool with_mass, int D, class Functions, class Field>
void give_momentum(const Functions& basis, const CellParticles<D>& particles, int first_node,
                   double* mass, Field&& momentum) {
  using Nodes = typename Functions::Nodes;
  Nodes m_i = Nodes::zero();
  Nodes p_i[D];
  for (auto& p : p_i) p = Nodes::zero();
  for (int k = 0; k < particles.count; ++k) {
    const Nodes m_ip =
        basis.functions(&particles.xi[0][k], CellParticles<D>::room, particles.mass[k]);
    if constexpr (with_mass) m_i.add(1.0, m_ip);
    unrolled<D>([&](auto a) { p_i[a].add(particles.velocity[a][k], m_ip); });
  }
  if constexpr (with_mass) basis.add_to_nodes(mass + first_node, m_i);
  for (int a = 0; a < D; ++a) basis.add_to_nodes(momentum(a) + first_node, p_i[a]);
}

/// f_i -= V_p (sigma_p - q_p 1) . grad N_ip, eq. (9), with the artificial viscosity's pressure q.
template <int D, class Functions, class Field>
void give_forces(const Functions& basis, const CellParticles<D>& particles, int first_node,
                 Field&& force) {
  using Nodes = typename Functions::Nodes;
  Nodes f_i[D];
  for (auto& f : f_i) f = Nodes::zero();
  for (int k = 0; k < particles.count; ++k) {
    Nodes G[D];
    basis.gradients(&particles.xi[0][k], CellParticles<D>::room, G);
    unrolled<D>([&](auto a) {
      unrolled<D>(
          [&](auto b) { f_i[a].add(particles.traction[Sym<double, D>::index(a, b)][k], G[b]); });
    });
  }
  for (int a = 0; a < D; ++a) basis.add_to_nodes(force(a) + first_node, f_i[a]);
}

/// Scatter from all particles of a patch to its block; momenta to the fields `momentum(a)`.
template <unsigned what, int D, class Field>
[[gnu::flatten]] void scatter(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch,
                              const NodeBlock<D>& block, Field&& momentum) {
  const Givers<what, D> givers(grid, body);
  with_basis(grid, body, patch, [&](const auto& basis) {
    for_each_cell(grid, body, patch, [&](const CellRange<D>& cell) {
      CellParticles<D> particles;
      const auto give = [&] {
        if constexpr ((what & gives_momentum) != 0)
          give_momentum<(what & gives_mass) != 0>(basis, particles, cell.first_node, block.mass(),
                                                  momentum);
        if constexpr ((what & gives_forces) != 0)
          give_forces(basis, particles, cell.first_node, [&](int a) { return block.force(a); });
        particles.count = 0;
      };
      for_each_group(cell, [&](const auto& rows) {
        if (particles.count == CellParticles<D>::room) give();
        givers.add(particles, cell, rows);
      });
      give();
    });
  });
}

}  // namespace mpm
