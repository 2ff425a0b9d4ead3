#pragma once
// From particles to nodes, cell by cell; what the particles give is first laid out in the first
// cache.
#include "mpm/step/cell_loop.hpp"

namespace mpm {

/// Particles of a cell, one after another, as many as there is room for, and what they give.
template <unsigned what, int D, class Functions>
class CellParticles {
 public:
  explicit CellParticles(const Functions& basis) : basis_(basis) {}

  void begin(const CellRange<D>& cell) { first_node_ = cell.first_node; }
  bool full() const { return count_ == room; }
  /// The first `added` lanes by their weights; what they give is added before `place`.
  template <class Weights>
  void place(const Weights& w, int added) {
    basis_.template put<what>(places_, count_, w);
    count_ += added;
  }
  template <class T>
  void add(T m, const Vec<T, D>& v) {
    gifts_.template add<what>(count_, m, v);
  }
  /// -V_p (sigma_p - q_p 1) / h [N].
  template <class T>
  void add_tractions(const Sym<T, D>& t) {
    gifts_.add_tractions(count_, t);
  }

  /// To the nodes of a patch, from its first on.
  template <int width>
  void give(const Nodes<width>& patch) {
    if (count_ == 0) return;
    basis_.template give<what>(patch.from(first_node_), places_, gifts_, count_);
    count_ = 0;
  }

 private:
  static constexpr int room = 16;
  const Functions& basis_;
  int first_node_ = 0, count_ = 0;
  typename Functions::template Particles<room> places_;
  typename Functions::template Gifts<room> gifts_;
};

/// The particles of a cell and of the one before, which give once those of this cell are laid out:
/// what has just been written would have to be waited for.
template <unsigned what, int D, class Functions, int width>
class CellByCell {
 public:
  /// `patch` are its nodes, from its first on.
  CellByCell(const Functions& basis, const Nodes<width>& patch)
      : cells_{CellParticles<what, D, Functions>(basis), CellParticles<what, D, Functions>(basis)},
        patch_(patch) {}

  void begin(const CellRange<D>& cell) { now().begin(cell); }
  /// Where the next particles of the cell are laid out.
  CellParticles<what, D, Functions>& next() {
    if (now().full()) {
      last().give(patch_);
      now().give(patch_);
    }
    return now();
  }
  /// The cell has all its particles.
  void end() {
    last().give(patch_);
    now_ = 1 - now_;
  }
  /// After the last cell.
  void finish() { last().give(patch_); }

 private:
  CellParticles<what, D, Functions>& now() { return cells_[now_]; }
  CellParticles<what, D, Functions>& last() { return cells_[1 - now_]; }

  CellParticles<what, D, Functions> cells_[2];
  int now_ = 0;
  Nodes<width> patch_;
};

/// Takes what particles give out of the columns of a body.
template <unsigned what, int D>
class Givers {
 public:
  Givers(const TileGrid<D>& grid, const Body<D>& body)
      : local_position_(grid, body), minus_per_cell_size_(-1.0 / grid.cell_size) {
    mass_ = body.mass();
    volume_ = body.volume();
    if (const int q = body.at.viscosity_pressure; q >= 0) q_ = body.columns.component(q);
    for (int a = 0; a < D; ++a) velocity_[a] = body.v(a);
    for (int c = 0; c < Sym<double, D>::size; ++c) stress_[c] = body.stress(c);
  }

  template <class Functions, class Rows>
  void add(CellParticles<what, D, Functions>& to, const CellRange<D>& cell, const Rows& rows,
           const Functions& basis) const {
    using T = Batch<Rows::lanes>;
    if constexpr ((what & gives_forces) != 0) {
      const T scale = T(minus_per_cell_size_) * load(volume_, rows);
      const T q = q_ ? load(q_, rows) : T(0.0);
      Sym<T, D> tractions;
      unrolled<Sym<T, D>::size>([&](auto c) {
        const T stress = load(stress_[c], rows);
        tractions.c[c] = scale * (c < D ? stress - q : stress);
      });
      to.add_tractions(tractions);
    }
    if constexpr ((what & gives_momentum) != 0) {
      Vec<T, D> v;
      unrolled<D>([&](auto a) { v[a] = load(velocity_[a], rows); });
      to.add(load(mass_, rows), v);
    }
    to.place(basis.weights(local_position_(cell, rows)), rows.count);
  }

 private:
  LocalPosition<D> local_position_;
  double minus_per_cell_size_;
  const double *mass_, *volume_, *q_ = nullptr;
  const Rounded *velocity_[D], *stress_[Sym<double, D>::size];
};

/// Scatter from all particles of a patch to its nodes (CellParticles::give).
template <unsigned what, int lanes, int D, class Functions>
[[gnu::noinline, gnu::flatten]] void scatter_by(const Functions& basis, const TileGrid<D>& grid,
                                                const Body<D>& body, const Patch<D>& patch,
                                                const NodeLines& nodes) {
  const Givers<what, D> givers(grid, body);
  CellByCell<what, D, Functions, line> cells(basis, nodes);
  for_each_cell(grid, body, patch, [&](const CellRange<D>& cell) {
    cells.begin(cell);
    for_each_group<lanes>(cell,
                          [&](const auto& rows) { givers.add(cells.next(), cell, rows, basis); });
    cells.end();
  });
  cells.finish();
}

template <unsigned what, int D>
void scatter(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch,
             const NodeLines& nodes) {
  with_basis_and_lanes(grid, body, patch, [&](const auto& basis, auto lanes) {
    scatter_by<what, lanes>(basis, grid, body, patch, nodes);
  });
}

}  // namespace mpm
