#pragma once
// Which walls of the box hold bodies that flow, and which might, once nodes are laid into them anew
// (renew_reference.hpp).
#include <vector>

#include "mpm/run/particles_that_flow.hpp"

namespace mpm {

/// How many particles of each body are near to each slip or fixed face of the box, by where they
/// are in the body, so that it holds nodes of theirs, and in space; of all ranks.
template <int D>
struct NearWalls {
  std::vector<std::int64_t> in_body, in_space;  // by body and face, 2 axis + side

  explicit NearWalls(const Domain<D>& domain)
      : in_body(domain.bodies.size() * 2 * D), in_space(in_body.size()) {
    const Walls<D>& walls = domain.grid.walls;
    if (!walls.exist) return;
    for_each_that_flows(domain, [&](const Patch<D>& patch, const ParticlePool<D>& pool) {
      for (int a = 0; a < D; ++a)
        for (int side = 0; side < 2; ++side) {
          if (!holds(walls.face[a][side])) continue;
          const auto before = [&](double place) {
            const double x = domain.grid.in_cells(place, a);
            return side == 0 ? x : walls.cells[static_cast<std::size_t>(a)] - x;
          };
          const std::size_t at =
              static_cast<std::size_t>(patch.body) * 2 * D + static_cast<std::size_t>(2 * a + side);
          for (const std::uint32_t row : pool.rows(patch)) {
            in_body[at] += before(pool.listed(a)[row]) < on_wall;
            in_space[at] += before(pool.x(a)[row]) < near_wall;
          }
        }
    });
    domain.grid.partition.comm->all_sum(in_body);
    domain.grid.partition.comm->all_sum(in_space);
  }
  // Nodes of what is nearer, in cells, may lie on a wall or beyond.
  static constexpr double near_wall = 2.0, on_wall = 1.0;

  static bool holds(Wall wall) { return wall == Wall::slip || wall == Wall::fixed; }

  /// Has a body come near a face that did not hold it?
  bool comes_near(std::size_t body) const {
    bool near = false;
    for (std::size_t k = body * 2 * D; k < (body + 1) * 2 * D; ++k)
      near = near || (in_space[k] > 0 && in_body[k] == 0);
    return near;
  }
};

/// The axes about which a body that walls hold turns freely, a bit each.
template <int D>
unsigned free_axes(const Domain<D>& domain, const NearWalls<D>& near, std::size_t body) {
  unsigned axes = D == 2 ? 4u : 7u;
  for (int a = 0; a < D; ++a)
    for (int side = 0; side < 2; ++side)
      if (near.in_body[body * 2 * D + static_cast<std::size_t>(2 * a + side)] > 0)
        axes &= domain.grid.walls.face[a][side] == Wall::slip ? 1u << a : 0u;
  return axes;
}

}  // namespace mpm
