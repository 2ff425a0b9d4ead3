#pragma once
// From particles to nodes. A cell's nodes are the lanes, so that sums stay in registers for all
// particles of the cell; what the particles give is first laid out in the first cache.
#include "mpm/step/cell_loop.hpp"

namespace mpm {

/// What is scattered: a sum of these. Forces come with neither or with both of the others.
enum Gives : unsigned { gives_mass = 1, gives_momentum = 2, gives_forces = 4 };

/// Particles of a cell, one after another, as many as there is room for.
template <int D, class Functions>
class CellParticles {
 public:
  using T = Batch<cell_lanes<D>>;
  using Nodes = typename Functions::Nodes;
  static constexpr int parts = Sym<T, D>::size;

  CellParticles(const Functions& basis, const CellRange<D>& cell)
      : basis_(basis), first_node_(cell.first_node) {}

  bool full() const { return count_ == room; }
  /// The first `added` lanes; what they give is added before `place`.
  void place(const Vec<T, D>& position, int added) {
    places_.put(basis_, count_, position);
    count_ += added;
  }
  void add(T m, const Vec<T, D>& v) {
    m.store(mass_ + count_);
    unrolled<D>([&](auto a) { v[a].store(velocity_[a] + count_); });
  }
  /// Component c of -V_p (sigma_p - q_p 1) / h [N].
  void add_traction(int c, T value) { value.store(traction_[c] + count_); }

  /// To the nodes of a patch, whose lines begin at its first: the particles' mass and momentum to
  /// the first quad, their forces to the next; momentum alone to the first.
  template <unsigned what>
  void give(const NodeLines& patch) {
    constexpr bool forces = (what & gives_forces) != 0, momentum = what != gives_forces;
    static_assert(!(forces && momentum) || (what & gives_mass), "mass comes before the momentum");
    // All sums at once where the machine's registers hold them and a quarter is left for the rest.
    constexpr int all = native_lanes == 8 ? 32 : 16;
    if constexpr (!forces || !momentum || Nodes::parts * (1 + 2 * D) <= all - all / 4) {
      give_sums<what>(patch.from(first_node_));
    } else {
      give_sums<what & ~gives_forces>(patch.from(first_node_));
      give_sums<gives_forces>(patch.from(first_node_));
    }
    count_ = 0;
  }

 private:
  /// Eqs. (2), (3) and f_i -= V_p (sigma_p - q_p 1) . grad N_ip, eq. (9), with the artificial
  /// viscosity's pressure q.
  template <unsigned what>
  void give_sums(const NodeLines& nodes) {
    Nodes m = Nodes::zero(), p[3] = {m, m, m}, f[3] = {m, m, m};
    for (int k = 0; k < count_; ++k) {
      if constexpr (what != gives_forces) {
        const Nodes m_ip = basis_.functions(places_, k, mass_[k]);
        if constexpr ((what & gives_mass) != 0) m.add(1.0, m_ip);
        unrolled<D>([&](auto a) { p[a].add(velocity_[a][k], m_ip); });
      }
      if constexpr ((what & gives_forces) != 0) {
        Nodes G[D];
        basis_.gradients(places_, k, G);
        unrolled<D>([&](auto a) {
          unrolled<D>([&](auto b) { f[a].add(traction_[Sym<double, D>::index(a, b)][k], G[b]); });
        });
      }
    }
    if constexpr ((what & gives_mass) != 0)
      basis_.add_to_nodes(nodes, m, p[0], p[1], p[2]);
    else if constexpr (what != gives_forces)
      basis_.add_to_nodes(nodes, p[0], p[1], p[2], m);
    if constexpr ((what & gives_forces) != 0)
      basis_.add_to_nodes(nodes.at(force_at), f[0], f[1], f[2], Nodes::zero());
  }

  static constexpr int room = 16;
  const Functions& basis_;
  int first_node_, count_ = 0;
  typename Functions::template Particles<room> places_;
  double mass_[room];             // [kg]
  double velocity_[D][room];      // [m/s]
  double traction_[parts][room];  // [N]
};

/// Takes what particles give out of the columns of a body.
template <unsigned what, int D>
class Givers {
 public:
  using T = Batch<cell_lanes<D>>;
  Givers(const TileGrid<D>& grid, const Body<D>& body)
      : local_position_(grid, body), minus_per_cell_size_(-1.0 / grid.cell_size) {
    mass_ = body.mass();
    volume_ = body.volume();
    if (const int q = body.at.viscosity_pressure; q >= 0) q_ = body.columns.component(q);
    for (int a = 0; a < D; ++a) velocity_[a] = body.v(a);
    for (int c = 0; c < Sym<T, D>::size; ++c) stress_[c] = body.stress(c);
  }

  template <class Functions, class Rows>
  void add(CellParticles<D, Functions>& to, const CellRange<D>& cell, const Rows& rows) const {
    if constexpr ((what & gives_forces) != 0) {
      const T scale = T(minus_per_cell_size_) * load(volume_, rows);
      const T q = q_ ? load(q_, rows) : T(0.0);
      unrolled<Sym<T, D>::size>([&](auto c) {
        const T stress = load(stress_[c], rows);
        to.add_traction(c, scale * (c < D ? stress - q : stress));
      });
    }
    if constexpr ((what & gives_momentum) != 0) {
      Vec<T, D> v;
      unrolled<D>([&](auto a) { v[a] = load(velocity_[a], rows); });
      to.add(load(mass_, rows), v);
    }
    to.place(local_position_(cell, rows), rows.count);
  }

 private:
  LocalPosition<D> local_position_;
  double minus_per_cell_size_;
  const double *mass_, *volume_, *q_ = nullptr, *velocity_[D], *stress_[Sym<T, D>::size];
};

/// Scatter from all particles of a patch to its nodes (CellParticles::give).
template <unsigned what, int D>
[[gnu::flatten]] void scatter(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch,
                              const NodeLines& nodes) {
  const Givers<what, D> givers(grid, body);
  with_basis(grid, body, patch, [&](const auto& basis) {
    for_each_cell(grid, body, patch, [&](const CellRange<D>& cell) {
      CellParticles particles(basis, cell);
      for_each_group(cell, [&](const auto& rows) {
        if (particles.full()) particles.template give<what>(nodes);
        givers.add(particles, cell, rows);
      });
      particles.template give<what>(nodes);
    });
  });
}

}  // namespace mpm
