#include "mpm/schedule/scatter.hpp"
#include "mpm/step/affine_velocity.hpp"
#include "mpm/step/fixed_walls.hpp"
#include "mpm/step/flowing_matter.hpp"
#include "mpm/step/move.hpp"
#include "mpm/step/node_loops.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {
namespace {

/// What is done beside eq. (17) while the particles, their weights and their nodes are at hand:
/// stages fused (decisions 0015, 0034), from the source that makes the single ones too.
/// The move, eq. (16), has the same weights: those of the positions before.
enum class Also { nothing, remap, move };

/// Of the particles in the lanes, for the ledger: every lane has its own sums over the patch, which
/// are brought together once at the end, in one order (decision 0038).
template <class T, int D>
struct LaneSums {
  T kinetic{0.0}, second_order{0.0}, transferred{0.0};
  Vec<T, D> momentum = Vec<T, D>::zero();

  /// Masses m with velocities v after a change dv: K, and S = 1/2 sum m dv^2, by which the
  /// particles' energy changes beyond dt sum f_i . v_i (ledger.hpp). Halved when written.
  MPM_INLINE void add(const T& m, const Vec<T, D>& v, const Vec<T, D>& dv) {
    T speed2(0.0), change2(0.0);
    unrolled<D>([&](auto a) MPM_INLINE {
      momentum[a] = fma(m, v[a], momentum[a]);
      speed2 = fma(v[a], v[a], speed2);
      change2 = fma(dv[a], dv[a], change2);
    });
    kinetic = fma(m, speed2, kinetic);
    second_order = fma(m, change2, second_order);
  }
  void write(PatchSums<D>& sums) const {
    sums.kinetic = 0.5 * sum(kinetic);
    sums.second_order = 0.5 * sum(second_order);
    sums.transferred = 0.5 * sum(transferred);
    for (int a = 0; a < D; ++a) sums.momentum[a] = sum(momentum[a]);
  }
};

/// In the place of FlowingMatter, of what keeps its shape.
struct NoFlow {
  template <class... Any>
  MPM_INLINE explicit NoFlow(const Any&...) {}
  template <class... Any>
  MPM_INLINE void begin(const Any&...) const {}
  template <class... Any>
  MPM_INLINE void end(const Any&...) const {}
  template <class Sums>
  void write(const Sums&) const {}
};

template <bool flows, class T, int D>
using FlowOf = std::conditional_t<flows, FlowingMatter<T, D>, NoFlow>;

/// The columns of a pool that hold the particles' velocities; for a transfer that filters also what
/// the grid has not seen of them.
template <class Transfer, int D>
struct VelocityColumns {
  Storage* v[D];
  const Storage* unseen[D];

  explicit VelocityColumns(ParticlePool<D>& pool) {
    for (int a = 0; a < D; ++a) {
      v[a] = pool.v(a);
      unseen[a] = Transfer::filters ? pool.unseen_velocity(a) : nullptr;
    }
  }
  /// The new velocities of the particles in the lanes, as the transfer says, stored; `dv` is the
  /// sum over the nodes, `beside` that of their velocities.
  template <class Rows, class T>
  MPM_INLINE Vec<T, D> take(const Transfer& transfer, const Rows& rows, const T& m,
                            const Vec<T, D>& dv, Vec<T, D> beside, LaneSums<T, D>& sums) const {
    Vec<T, D> taken;
    unrolled<D>([&](auto a) MPM_INLINE {
      const T before = load(v[a], rows);
      if constexpr (Transfer::filters) beside[a] = load(unseen[a], rows);
      if constexpr (Transfer::takes_grid_velocity || Transfer::filters) {
        taken[a] = transfer.take(before, dv[a], beside[a]);
        // m (|v_p + dv_p|^2 - |v_p'|^2), halved at the end: what particles lose against FLIP, with
        // all of the change; of affine transfers against the start (docs/theory/step.md).
        const T kept = Transfer::affine ? before : before + dv[a];
        sums.transferred += m * kept * kept;
        sums.transferred -= m * taken[a] * taken[a];
      } else {
        taken[a] = transfer.take(before, dv[a]);
      }
      store(v[a], rows, taken[a]);
    });
    sums.add(m, taken, dv);
    return taken;
  }
};

/// Velocities of a patch's particles, eq. (17), as the transfer says. Taken from the increments of
/// the nodes, v_p is smoothed by no mapping to the grid and back; the nodes are advanced, so v_i is
/// that of the end of the step. A function of its own for each basis, width and transfer (decision
/// 0018).
///
/// The increments are still read where MUSL's new momenta are scattered, m_i v_i' = sum N_ip m_p
/// v_p (3.6, step 10), and both have the same place in the record (node_records.hpp): so these are
/// summed aside, 7 kB in 3D, and copied once all particles of the patch have read. Other patches
/// read their own blocks alone. There is no mass among them, for particles have not moved since it
/// was mapped.
///
/// Lanes behind the last particle repeat its row. With no mass they count for nothing in the
/// ledger; the nodes are told how many there are (`place`). With MPM_FLOAT32 velocities are rounded
/// when stored; the ledger and the remap take v as computed (decision 0021).
template <int W, Also also, bool flows = false, class Transfer, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] void advance_patch(Domain<D>& domain, std::size_t p, const B& basis,
                                                   const Transfer transfer) {
  using T = Batch<W>;
  auto& grid = domain.grid;
  Patch<D>& patch = grid.patches[p];
  ParticlePool<D>& pool = domain.pool_of(patch);
  const NodeBlock<D> block = grid.block(p);
  LaneSums<T, D> sums;
  const LocalPosition<D> local_position(grid, pool);
  Moving<T, D> moving(grid, pool, domain.time_step);
  const double* mass = pool.mass();
  const VelocityColumns<Transfer, D> velocities(pool);
  alignas(
      cache_line) double remapped[also == Also::remap ? BlockShape<D>::nodes_max * half_record : 1];
  if constexpr (also == Also::remap) std::fill_n(remapped, block.count * half_record, 0.0);
  const NodeStrides<D> stride(patch.shape);
  constexpr unsigned what = gives_momentum | (Transfer::affine ? gives_affine : 0u);
  DoubleBuffer<Mapping<typename Transfer::Gives>, what, D, B, half_record> cells(stride,
                                                                                 {remapped});
  [[maybe_unused]] TakingAffine<T, D> affine(grid, pool);
  FlowOf<flows, T, D> flow(grid, pool, domain.material_of(patch), domain.time_step);
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    const auto nodes = field_of<B>(block.records.from(cell.first_node), stride);
    const Transfer here = transfer_of_cell(transfer, grid, patch, cell.cell);
    if constexpr (also == Also::remap) cells.begin(cell);
    for_each_group<W>(cell, [&](const auto& rows) {
      const Vec<T, D> xi = local_position(cell, rows);
      const auto w = weights_at(basis, xi);
      const T all = load(mass, rows), m = of_valid(rows, all);
      const Vec<T, D> dv = nodes.template vector<increment_at>(w);
      Vec<T, D> beside = Vec<T, D>::zero();
      Moments<T, D, B::nodes> moments;
      flow.begin(rows);
      if constexpr (Transfer::affine) {
        moments = moments_at<B>(xi, w);
        affine.take(nodes, rows, w, moments, m, beside, sums);
      }
      if constexpr (Transfer::takes_grid_velocity && !Transfer::affine)
        beside = nodes.template vector<velocity_at>(w);
      const Vec<T, D> v = velocities.take(here, rows, m, dv, beside, sums);
      flow.end(rows, nodes, w, dv);
      if constexpr (also == Also::move) moving.move(cell, rows, nodes, w);
      if constexpr (also == Also::remap) {
        auto& particles = cells.next();
        if constexpr (Transfer::affine)
          particles.add(all, v, affine.in_cells(), moments);
        else
          particles.add(all, v);
        particles.place(w, rows.count);
      }
    });
    if constexpr (also == Also::remap) cells.end();
  });
  if constexpr (also == Also::remap) {
    cells.finish();
    copy_halves(block.records.at(remapped_at), {remapped}, block.count);
  }
  sums.write(domain.sums[p]);
  flow.write(domain.sums[p]);
  if constexpr (also == Also::move) moving.write(patch, domain.sums[p]);
}

/// Kinetic energy of a patch's particles [J].
template <int D>
double kinetic_energy_of(const Domain<D>& domain, const Patch<D>& patch) {
  const ParticlePool<D>& pool = domain.pool_of(patch);
  double sum = 0.0;
  for (const std::uint32_t row : pool.rows(patch))
    sum += kinetic_energy(pool, row, domain.grid.affine_moment());
  return sum;
}

/// Rigid bodies are only advanced: their velocities are not final yet, so they are neither moved
/// nor remapped, and FLIP alone: PIC would damp their turning.
template <int W, int D, BasisModel B>
void advance_rigid_patch(Domain<D>& domain, std::size_t p, const B& basis) {
  // Where others have an affine transfer the ledger wants the change from all.
  const bool affine = is_affine(domain.transfer);
  const double before = affine ? kinetic_energy_of(domain, domain.grid.patches[p]) : 0.0;
  advance_patch<W, Also::nothing>(domain, p, basis, Flip());
  if (affine) domain.sums[p].transferred = before - domain.sums[p].kinetic;
}

template <int W, Also also, class Transfer, int D, BasisModel B>
void advance_deformable(Domain<D>& domain, std::size_t p, const B& basis,
                        const Transfer& transfer) {
  if constexpr (Transfer::affine)
    if (domain.pool_of(domain.grid.patches[p]).at.growth_limit >= 0)
      return advance_patch<W, also, true>(domain, p, basis, transfer);
  advance_patch<W, also>(domain, p, basis, transfer);
}

template <Also also, int D>
void advance(Domain<D>& domain) {
  for_each_patch(domain, deformable | free_rigid, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    const Body<D>& body = domain.body_of(patch);
    with_basis_and_lanes(domain.grid, body, patch, [&]<BasisModel B>(const B& basis, auto lanes) {
      if (!body.deforms())
        advance_rigid_patch<lanes>(domain, p, basis);
      else
        with_transfer_for<B>(
            domain, share_of(domain, domain.pool_of(patch)), [&](const auto& transfer) {
              advance_deformable<lanes, also>(domain, p, basis, taken_by(transfer));
            });
    });
  });
}

}  // namespace

template <int D>
void advance_particles(Domain<D>& domain) {
  advance<Also::nothing>(domain);
}

template <int D>
void advance_and_remap_particles(Domain<D>& domain) {
  advance<Also::remap>(domain);
}

template <int D>
void advance_and_move_particles(Domain<D>& domain) {
  advance<Also::move>(domain);
}

template void advance_particles<2>(Domain<2>&);
template void advance_particles<3>(Domain<3>&);
template void advance_and_remap_particles<2>(Domain<2>&);
template void advance_and_remap_particles<3>(Domain<3>&);
template void advance_and_move_particles<2>(Domain<2>&);
template void advance_and_move_particles<3>(Domain<3>&);

}  // namespace mpm
