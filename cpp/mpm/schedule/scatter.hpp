#pragma once
// From particles to nodes, cell by cell; what the particles give is first laid out in the first
// cache. Only the patch's own block is written, so that threads never meet; what several patches
// hold is summed later (decision 0020).
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/schedule/choose.hpp"

namespace mpm {

/// Particles of a cell, one after another, as many as there is room for, and what they give.
template <unsigned what, int D, BasisModel B>
class CellBuffer {
 public:
  explicit CellBuffer(const NodeStrides<D>& stride)
      : scatter_(stride), to_first_(stride.to_first(B::before)) {}

  void begin(const CellRange<D>& cell) { first_node_ = cell.first_node + to_first_; }
  bool full() const { return count_ == room; }
  /// The first `added` lanes by their weights; what they give is added before `place`, which moves
  /// on. The lanes behind are written as well, and overwritten or never read.
  template <class T>
  void place(const Weights<T, D, B::nodes>& w, int added) {
    Scatter<B, D>::template put<what>(places_, count_, w);
    count_ += added;
  }
  template <class T>
  void add(T m, const Vec<T, D>& v) {
    payload_.template add<what>(count_, m, v);
  }
  /// With the affine part, G = C h, before the particles are placed.
  template <class T>
  void add(T m, const Vec<T, D>& v, const Mat<T, D>& G, const Moments<T, D, B::nodes>& M) {
    Scatter<B, D>::put_moments(places_, count_, M);
    payload_.template add<what>(count_, m, v, G);
  }
  /// -V_p (sigma_p - q_p 1) / h [N]; times F^-T, a Mat, where nodes lie in the body.
  template <class Tractions>
  void add_tractions(const Tractions& t) {
    payload_.add_tractions(count_, t);
  }

  /// To the nodes of a patch, from its first on, as a mapping's formulas say. An empty buffer gives
  /// nothing: at the first cell there is none before.
  template <class Mapping, int width>
  void give(const Nodes<width>& patch) {
    if (count_ == 0) return;
    scatter_.template give<Mapping, what>(patch.from(first_node_), places_, payload_, count_);
    count_ = 0;
  }

 private:
  // A multiple of every number of lanes: only the last group of a cell is not whole, so one that
  // finds `full()` false has room for all its lanes. A cell with more gives several times.
  static constexpr int room = 16;
  Scatter<B, D> scatter_;
  int to_first_;  // from a cell's own node to the first in reach
  int first_node_ = 0, count_ = 0;
  typename Scatter<B, D>::template Places<room> places_;
  typename Scatter<B, D>::template Payload<room> payload_;
};

/// The particles of a cell and of the one before, which give once those of this cell are laid out:
/// what has just been written would have to be waited for (decision 0024). Nodes get the sums of
/// cells in the order of the cells all the same, as where there was one buffer.
template <class Mapping, unsigned what, int D, BasisModel B, int width>
class DoubleBuffer {
 public:
  /// `patch` are its nodes, from its first on: the block itself, or room for half of its records
  /// where MUSL's remap is fused with eq. (17).
  DoubleBuffer(const NodeStrides<D>& stride, const Nodes<width>& patch)
      : cells_{CellBuffer<what, D, B>(stride), CellBuffer<what, D, B>(stride)}, patch_(patch) {}

  void begin(const CellRange<D>& cell) { now().begin(cell); }
  /// Where the next particles of the cell are laid out.
  CellBuffer<what, D, B>& next() {
    if (now().full()) {
      // The cell before goes first, to keep that order.
      last().template give<Mapping>(patch_);
      now().template give<Mapping>(patch_);
    }
    return now();
  }
  /// The cell has all its particles.
  void end() {
    last().template give<Mapping>(patch_);
    // Empty from here on, so `begin` may give it another cell.
    now_ = 1 - now_;
  }
  /// After the last cell.
  void finish() { last().template give<Mapping>(patch_); }

 private:
  CellBuffer<what, D, B>& now() { return cells_[now_]; }
  CellBuffer<what, D, B>& last() { return cells_[1 - now_]; }

  CellBuffer<what, D, B> cells_[2];
  int now_ = 0;
  Nodes<width> patch_;
};

/// The affine part C of the velocity of particles, the column `affine` of a pool.
template <int D>
class AffineVelocity {
 public:
  AffineVelocity() = default;
  AffineVelocity(const TileGrid<D>& grid, const ParticlePool<D>& pool)
      : cell_size_(grid.cell_size) {
    for (int k = 0; k < D * D; ++k) columns_[k] = pool.affine_part(k);
  }
  /// C h, the change of the velocity over a cell [m/s].
  template <class T, class Rows>
  Mat<T, D> in_cells(const Rows& rows) const {
    Mat<T, D> G;
    unrolled<D * D>([&](auto k) { G[k / D][k % D] = T(cell_size_) * load(columns_[k], rows); });
    return G;
  }

 private:
  double cell_size_ = 0.0;
  const Storage* columns_[D * D] = {};
};

/// The stress that nodal forces use, sigma_p - q_p 1 + s_p. Stress is positive in tension, the
/// pressure q of the artificial viscosity in compression, hence the difference, on the diagonal
/// alone: its components come first in `Sym`. s_p is the stress of the material's damping.
template <int D>
class ForceStress {
 public:
  explicit ForceStress(const ParticlePool<D>& pool) {
    // With averaged volumes a column holds q and what the cell's mean pressure changes.
    const int q = pool.at.force_pressure >= 0 ? pool.at.force_pressure : pool.at.viscosity_pressure;
    if (q >= 0) q_ = pool.columns.component(q);
    if (const int s = pool.at.damping_stress; s >= 0)
      for (int c = 0; c < Sym<double, D>::size; ++c) damping_[c] = pool.columns.component(s + c);
    viscous_ = q_ || damping_[0];
    for (int c = 0; c < Sym<double, D>::size; ++c) stress_[c] = pool.stress(c);
  }
  template <class T, class Rows>
  MPM_INLINE Sym<T, D> of(const Rows& rows) const {
    Sym<T, D> stress;
    unrolled<Sym<T, D>::size>([&](auto c) { stress.c[c] = load(stress_[c], rows); });
    if (viscous_) add_viscous(stress, rows);
    return stress;
  }

 private:
  template <class T, class Rows>
  MPM_INLINE void add_viscous(Sym<T, D>& stress, const Rows& rows) const {
    if (q_) {
      const T q = load(q_, rows);
      unrolled<D>([&](auto c) { stress.c[c] = stress.c[c] - q; });
    }
    if (damping_[0])
      unrolled<Sym<T, D>::size>(
          [&](auto c) { stress.c[c] = stress.c[c] + load(damping_[c], rows); });
  }

  const double *q_ = nullptr, *damping_[Sym<double, D>::size] = {};
  bool viscous_ = false;  // is there any of the two?
  const Storage* stress_[Sym<double, D>::size];
};

/// Takes what particles give out of the columns of a pool; `velocity` is the first component of the
/// velocity among them. Pointers to columns and 1 / h are found once a patch (decision 0015).
template <unsigned what, int D>
class ParticleReader {
 public:
  ParticleReader(const TileGrid<D>& grid, const ParticlePool<D>& pool, int velocity)
      : local_position_(grid, pool), minus_per_cell_size_(-1.0 / grid.cell_size), stress_(pool) {
    if constexpr ((what & gives_affine) != 0) affine_ = AffineVelocity<D>(grid, pool);
    mass_ = pool.mass();
    volume_ = pool.volume();
    for (int a = 0; a < D; ++a) velocity_[a] = pool.columns.rounded(velocity + a);
  }

  template <BasisModel B, class Rows>
  void add(CellBuffer<what, D, B>& to, const CellRange<D>& cell, const Rows& rows,
           const B& basis) const {
    using T = Batch<Rows::lanes>;
    // Their position is that of the start of the step.
    const Vec<T, D> xi = local_position_(cell, rows);
    const Weights<T, D, B::nodes> w = weights_at(basis, xi);
    // -V_p (sigma_p - q_p 1 + s_p) / h: the sign and the volume V_p = m_p / rho_p of eq. (9), with
    // 1 / h as gradients are in cells. In 2D zz is carried along and not used, as nothing varies
    // along z.
    if constexpr ((what & gives_forces) != 0) {
      const T scale = T(minus_per_cell_size_) * load(volume_, rows);
      Sym<T, D> tractions = stress_.template of<T>(rows);
      unrolled<Sym<T, D>::size>([&](auto c) { tractions.c[c] = scale * tractions.c[c]; });
      to.add_tractions(tractions);
    }
    if constexpr ((what & gives_momentum) != 0) {
      Vec<T, D> v;
      unrolled<D>([&](auto a) { v[a] = load(velocity_[a], rows); });
      if constexpr ((what & gives_affine) != 0)
        to.add(load(mass_, rows), v, affine_.template in_cells<T>(rows), moments_at<B>(xi, w));
      else
        to.add(load(mass_, rows), v);
    }
    // Last, as it counts the particles.
    to.place(w, rows.count);
  }

 private:
  LocalPosition<D> local_position_;
  double minus_per_cell_size_;
  const double *mass_, *volume_;
  const Storage* velocity_[D];
  ForceStress<D> stress_;
  AffineVelocity<D> affine_{};
};

/// Scatter from all particles of a patch to its nodes (CellBuffer::give). A function of its own for
/// each basis and width, inlined whole: with several in one, g++ reached its limits of growth and
/// left innermost loops as calls (decision 0018).
template <class Mapping, unsigned what, int lanes, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] void scatter_by(const B& basis, const TileGrid<D>& grid,
                                                const ParticlePool<D>& pool, int velocity,
                                                const Patch<D>& patch, const NodeRecords& nodes) {
  const ParticleReader<what, D> reader(grid, pool, velocity);
  DoubleBuffer<Mapping, what, D, B, record> cells(NodeStrides<D>(patch.shape), nodes);
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    cells.begin(cell);
    for_each_group<lanes>(cell,
                          [&](const auto& rows) { reader.add(cells.next(), cell, rows, basis); });
    cells.end();
  });
  cells.finish();
}

/// The same for the basis of the grid, and as many lanes as the patch's cells fill.
template <class Mapping, unsigned what, int D>
void scatter(const TileGrid<D>& grid, const Body<D>& body, const ParticlePool<D>& pool,
             const Patch<D>& patch, const NodeRecords& nodes) {
  with_basis_and_lanes(grid, body, patch, [&](const auto& basis, auto lanes) {
    scatter_by<Mapping, what, lanes>(basis, grid, pool, pool.at.velocity, patch, nodes);
  });
}

}  // namespace mpm
