// Surfaces of bodies that overlap at the start, as particles are no exact picture of a shape.
#include "mpm/contact/set_back.hpp"

#include <algorithm>
#include <atomic>
#include <vector>

#include "mpm/contact/springs.hpp"

namespace mpm {
namespace {

/// A particle near a node.
template <int D>
struct Near {
  std::uint32_t row;
  Vec<double, D> x;  // [cells]
  double half;       // half its edge [cells]
};

/// Those of a body from which a node of a tile is in reach.
template <int D>
void collect(const Contact<D>& contact, const TileGrid<D>& grid, const Body<D>& body,
             const ParticlePool<D>& pool, const ContactNode& node, int number,
             std::vector<Near<D>>& to) {
  to.clear();
  const ContactTile<D>& tile = contact.tiles[node.tile];
  std::span<const TileHolder> holders(&contact.holders[tile.first_holder], tile.holders);
  const auto [first, last] = std::ranges::equal_range(holders, number, {}, &TileHolder::body);
  TileParticles<D>::for_each_cell(
      grid, {first, last}, std::uint64_t{1} << node.cell,
      [&](const Patch<D>& patch, const Index<D>&, int cell) {
        const auto c = static_cast<std::size_t>(cell);
        for (std::uint32_t k = patch.cell_begin[c]; k < patch.cell_begin[c + 1]; ++k) {
          Near<D>& near = to.emplace_back();
          near.row = pool.order[patch.begin + k];
          for (int a = 0; a < D; ++a) near.x[a] = grid.in_cells(pool.x(a)[near.row], a);
          const Batch<contact_lanes> volume(pool.volume()[near.row]);
          near.half = 0.5 / grid.cell_size * particle_edge<D>(volume, body.mean_edge)[0];
        }
      });
}

/// The largest of what any node says, in whatever order: the answer is that of the case alone.
void raise_to(double& value, double to) {
  std::atomic_ref<double> shared(value);
  double before = shared.load(std::memory_order_relaxed);
  while (before < to && !shared.compare_exchange_weak(before, to, std::memory_order_relaxed)) {
  }
}

template <int D>
void set_back_at(Contact<D>& contact, ContactPart<D>& part, const ContactNode& node,
                 const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                 std::vector<ParticlePool<D>>& pools, double distance) {
  thread_local std::vector<Near<D>> of_r, of_s;
  // Of half an edge; some must be left, for faces, caps and compliance are those of the rest.
  constexpr double most = 0.9;
  const auto sides = part.sides_of(node);
  for (const ContactPair<D>& pair : part.pairs_of(node)) {
    if (!(pair.spring.force > 0.0)) continue;
    const auto collect_of = [&](std::uint16_t side, std::vector<Near<D>>& near) {
      const int number = sides[side].body;
      const Body<D>& body = bodies[static_cast<std::size_t>(number)];
      ParticlePool<D>& pool = pools[static_cast<std::size_t>(body.material)];
      collect(contact, grid, body, pool, node, number, near);
      return pool.columns.component(pool.set_back);
    };
    double* const of_r_back = collect_of(pair.r, of_r);
    double* const of_s_back = collect_of(pair.s, of_s);
    const auto set_back = [&](double* back, const Near<D>& p, double overlap) {
      raise_to(back[p.row], std::min(0.5 * overlap / p.half, most));
    };
    for (const Near<D>& p : of_r)
      for (const Near<D>& q : of_s) {
        // Under the caps of both, as each body's surface is sampled by the other's particles.
        const double overlap =
            std::max(overlap_of<D>(p.half, q.half, q.x - p.x, pair.normal, distance),
                     overlap_of<D>(q.half, p.half, p.x - q.x, -1.0 * pair.normal, distance));
        if (!(overlap > 0.0)) continue;
        set_back(of_r_back, p, overlap);
        set_back(of_s_back, q, overlap);
      }
  }
}

}  // namespace

template <int D>
void set_back_surfaces(Contact<D>& contact, const TileGrid<D>& grid,
                       const std::vector<Body<D>>& bodies, std::vector<ParticlePool<D>>& pools,
                       const ContactSettings& settings, Threads& threads) {
  threads.for_each(contact.parts.size(), [&](std::size_t p) {
    ContactPart<D>& part = contact.parts[p];
    for (const ContactNode& node : part.nodes)
      set_back_at(contact, part, node, grid, bodies, pools, settings.gap_distance / grid.cell_size);
  });
}

template void set_back_surfaces<2>(Contact<2>&, const TileGrid<2>&, const std::vector<Body<2>>&,
                                   std::vector<ParticlePool<2>>&, const ContactSettings&, Threads&);
template void set_back_surfaces<3>(Contact<3>&, const TileGrid<3>&, const std::vector<Body<3>>&,
                                   std::vector<ParticlePool<3>>&, const ContactSettings&, Threads&);

}  // namespace mpm
