// Bodies on nodes of their own keep all that their nodes do, also what their particles hardly see:
// waves as short as the cells. With a setting a > 0 velocities lose a share of what is not seen of
// them in every fiftieth step,
//   v -= R G R v,   R v = v - Q* Q v,   G = a (c / h) 50 dt,                                 (W1)
// with Q to the particles' velocities and their affine parts and Q* back, as APIC maps both (Jiang
// et al. 2015). R has eigenvalues from 0, for motions that are linear in the body, to 1; it is of
// the fourth order in cells over wavelengths, near surfaces of the second. So it takes energy of
// bodies of a few cells too.
#include "mpm/followers/follow.hpp"
#include "mpm/grid/halo.hpp"
#include "mpm/schedule/scatter.hpp"
#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/node_loops.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/sum_over_bodies.hpp"
#include "mpm/surfaces/restitution.hpp"

namespace mpm {
namespace {

constexpr std::int64_t steps_between = 50;

/// m_i Q* Q of what stands at a number of the records of the nodes, by the particles of a patch.
template <int number, int lanes, int D, BasisModel B>
[[gnu::noinline, gnu::flatten]] void map_what_is_seen(const B& basis, const TileGrid<D>& grid,
                                                      const ParticlePool<D>& pool,
                                                      const Patch<D>& patch,
                                                      const NodeRecords& nodes,
                                                      const HalfRecords& seen) {
  using T = Batch<lanes>;
  const LocalPosition<D> local_position(grid, pool);
  const NodeStrides<D> stride(patch.shape);
  const T per_moment(1.0 / B::second_moment);
  DoubleBuffer<Mapping<Apic>, gives_momentum | gives_affine, D, B, half_record> cells(stride, seen);
  for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
    cells.begin(cell);
    const auto around = field_of<B>(nodes.from(cell.first_node), stride);
    for_each_group<lanes>(cell, [&](const auto& rows) {
      auto& to = cells.next();
      const Vec<T, D> xi = local_position(cell, rows);
      const auto w = weights_at(basis, xi);
      const auto moments = moments_at<B>(xi, w);
      Vec<T, D> v;
      Mat<T, D> G;
      around.template value_and_moments<number>(w, moments, v, G);
      unrolled<D * D>([&](auto k) { G[k / D][k % D] *= per_moment; });
      to.add(load(pool.mass(), rows), v, G, moments);
      to.place(w, rows.count);
    });
    cells.end();
  });
  cells.finish();
}

/// The same for all nodes in bodies, to the places of their forces.
template <int number, int D>
void map_what_is_seen(Domain<D>& domain) {
  TileGrid<D>& grid = domain.grid;
  for_each_patch(domain, in_body, [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    const NodeRecords nodes = grid.block(p).records;
    const int count = patch.shape.node_count;
    double numbers[BlockShape<D>::nodes_max * half_record];
    const HalfRecords seen{numbers};
    clear(seen, count, half_record);
    with_basis_and_lanes(
        grid, domain.body_of(patch), patch, [&]<BasisModel B>(const B& basis, auto lanes) {
          if constexpr (B::second_moment > 0.0)
            map_what_is_seen<number, lanes>(basis, grid, domain.pool_of(patch), patch, nodes, seen);
        });
    copy_halves(nodes.at(force_at), seen, count);
    fold_at_walls(grid, patch, grid.block(p), force_at);
  });
  // Those of other bodies have no use yet.
  exchange_and_sum(grid, domain.threads, force_at, record);
  give_to_leading(domain, force_at);
}

/// G R v of the nodes of a patch is taken from v, and put where Q* Q v is.
template <int D>
void take_unseen(const Domain<D>& domain, const Body<D>& body, const NodeBlock<D>& block) {
  const double h = domain.grid.cell_size,
               waves = std::sqrt(body.stiffness / body.initial_density) / h * steps_between *
                       domain.time_step,
               share = std::min(waves * domain.short_wave_damping, 1.0);
  for (int n = 0; n < block.count; ++n) {
    double* const numbers = block.records[n];
    const double m = numbers[mass_at];
    for (int a = 0; a < D && m > 0.0; ++a) {
      double &v = numbers[velocity_at + a], &seen = numbers[force_at + a];
      seen = share * (v - seen / m);
      v -= seen;
    }
  }
}

/// Q* Q of what was taken is given back.
template <int D>
void give_seen(const NodeBlock<D>& block) {
  for (int n = 0; n < block.count; ++n) {
    double* const numbers = block.records[n];
    const double m = numbers[mass_at];
    for (int a = 0; a < D && m > 0.0; ++a) numbers[velocity_at + a] += numbers[force_at + a] / m;
  }
}

/// Of the nodes of a patch [J].
template <int D>
double kinetic_of_kept(TileGrid<D>& grid, const Patch<D>& patch) {
  double sum = 0.0;
  for_each_kept_node(
      grid, patch, [&](double m, const Vector3&, const Vector3& v) { sum += 0.5 * m * dot(v, v); });
  return sum;
}

/// Of the nodes of a patch, about a place [N m s].
struct AngularMomentum {
  Vector3 sum = Vector3::zero();
  void add(const AngularMomentum& other) { sum += other.sum; }
};
template <int D>
AngularMomentum angular_momentum_of_kept(TileGrid<D>& grid, const Patch<D>& patch,
                                         const KeptSpin& of) {
  AngularMomentum all;
  for_each_kept_node(grid, patch, [&](double m, const Vector3& x, const Vector3& v) {
    all.sum += m * cross(x - of.centre, v);
  });
  return all;
}

}  // namespace

template <int D>
void damp_short_waves(Domain<D>& domain) {
  TileGrid<D>& grid = domain.grid;
  if ((domain.step + 1) % steps_between != 0 || !(domain.short_wave_damping > 0.0)) return;
  // Before and, with the other sign, after: what is lost.
  const auto count_kinetic = [&](double sign) {
    for_each_patch(domain, in_body, [&](std::size_t p) {
      domain.sums[p].transferred += sign * kinetic_of_kept(grid, grid.patches[p]);
    });
  };
  // Where a body is bent Q* Q takes some of its turning; what is kept of that gives it back.
  const bool all = restitution_takes(domain.contact_settings);
  const auto wanted = [&](const KeptSpin& turning) { return all || turning.excess > 0.0; };
  const auto leave_out_turning = [&](double sign) {
    sum_over_bodies<AngularMomentum>(
        domain, wanted,
        [&](std::size_t p, const KeptSpin& turning) {
          return angular_momentum_of_kept(grid, grid.patches[p], turning);
        },
        [&](KeptSpin& turning, const AngularMomentum& all, std::size_t) {
          turning.of_nodes -= sign * all.sum;
        });
  };
  count_kinetic(1.0);
  leave_out_turning(1.0);
  map_what_is_seen<velocity_at>(domain);
  for_each_patch(domain, in_body, [&](std::size_t p) {
    take_unseen(domain, domain.body_of(grid.patches[p]), grid.block(p));
    hold_kept_nodes(grid, grid.patches[p], grid.block(p), force_at);
  });
  take_from_leading(domain, force_at);
  map_what_is_seen<force_at>(domain);
  for_each_patch(domain, in_body, [&](std::size_t p) {
    give_seen(grid.block(p));
    hold_kept_nodes(grid, grid.patches[p], grid.block(p));
  });
  take_from_leading(domain, velocity_at);
  count_kinetic(-1.0);
  leave_out_turning(-1.0);
}

template void damp_short_waves<2>(Domain<2>&);
template void damp_short_waves<3>(Domain<3>&);

}  // namespace mpm
