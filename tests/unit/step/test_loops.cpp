// Loops over nodes and patches: whom they visit, and what they leave alone.
#include <atomic>
#include <map>

#include "check.hpp"
#include "grid/tiles.hpp"
#include "mpm/step/node_loops.hpp"
#include "mpm/step/patch_loops.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// Whole halves of records are cleared or copied, and no others.
void check_halves(Report& report) {
  constexpr int count = 5;
  alignas(64) double records[count * record], halves[count * half_record];
  const auto start = [&] {
    for (int k = 0; k < count * record; ++k) records[k] = 1.0 + k;
    for (int k = 0; k < count * half_record; ++k) halves[k] = -1.0 - k;
  };
  const NodeRecords nodes{records};
  for (const int numbers : {half_record, record}) {
    start();
    clear(nodes, count - 1, numbers);  // all but the last
    for (int n = 0; n < count; ++n)
      for (int k = 0; k < record; ++k)
        CHECK_EQUAL(nodes[n][k], n < count - 1 && k < numbers ? 0.0 : 1.0 + n * record + k);
  }
  start();
  clear(nodes.at(force_at), count - 1, half_record);
  CHECK(nodes[0][force_at - 1] == 1.0 + force_at - 1 && nodes[0][force_at] == 0.0);
  start();
  copy_halves(nodes.at(remapped_at), {halves}, count - 1);
  for (int n = 0; n < count; ++n)
    for (int k = 0; k < record; ++k) {
      const bool copied = n < count - 1 && k >= remapped_at;
      CHECK_EQUAL(nodes[n][k],
                  copied ? halves[n * half_record + k - remapped_at] : 1.0 + n * record + k);
    }
}

template <int D>
void put_walls(Tiles<D>& tiles) {
  Walls<D>& walls = tiles.grid.walls;
  walls.exist = true;
  walls.cells.fill(Tile<D>::cells - 1);
  walls.face[0][0] = Wall::slip;
  walls.face[1][1] = Wall::fixed;
  tiles.cut();
}

/// Those that walls hold, each once, with the axes; then p / m, zero along those and without mass.
template <int D>
void check_walls(Report& report, BasisId basis) {
  Tiles<D> tiles(basis, false);
  put_walls(tiles);
  TileGrid<D>& grid = tiles.grid;
  std::map<std::pair<std::size_t, int>, unsigned> visited;
  for (std::size_t p = 0; p < grid.patches.size(); ++p)
    for_each_constrained_node(grid, grid.patches[p], [&](int n, unsigned axes) {
      CHECK(visited.try_emplace({p, n}, axes).second, p, n);
    });
  CHECK(visited.size() > 10, visited.size());
  const auto mass = [](int n) { return n % 4 == 0 ? 0.0 : 0.25 * (n % 4); };
  tiles.for_each_node([&](std::size_t p, int n, const Index<D>& node) {
    const auto at = visited.find({p, n});
    CHECK_EQUAL(at == visited.end() ? 0u : at->second, grid.walls.constrained_axes(node));
    const NodeBlock<D> block = grid.block(p);
    for (int k = 0; k < record; ++k) block.records[n][k] = 1.0 + k;
    block.mass()[n] = mass(n);
  });
  for (const int at : {velocity_at, remapped_at}) {
    for (std::size_t p = 0; p < grid.patches.size(); ++p)
      momentum_to_velocity(grid, grid.patches[p], grid.block(p), at);
    tiles.for_each_node([&](std::size_t p, int n, const Index<D>& node) {
      const double* const numbers = grid.block(p).records[n];
      const unsigned held = grid.walls.constrained_axes(node);
      CHECK_EQUAL(numbers[mass_at], mass(n));
      for (int a = 0; a < D; ++a) {
        const bool moves = mass(n) > 0.0 && !(held >> a & 1u);
        const double expected = moves ? (1.0 + at + a) / mass(n) : 0.0;
        CHECK_CLOSE(numbers[at + a], expected, 1e-15 * expected);
        if (at == velocity_at) CHECK_EQUAL(numbers[remapped_at + a], 1.0 + remapped_at + a);
      }
    });
  }
}

/// The patches of bodies of these kinds, each once, with several threads.
template <int D>
void check_patches(Report& report) {
  constexpr BodyKind kinds[] = {BodyKind::deformable, BodyKind::rigid, BodyKind::prescribed,
                                BodyKind::rigid, BodyKind::deformable};
  Domain<D> domain;
  domain.threads.resize(3);
  for (int b = 0; b < 5; ++b) {
    domain.bodies.emplace_back().kind = kinds[b];
    for (int k = 0; k < 40; ++k) domain.grid.patches.emplace_back().body = b;
  }
  for (Kinds chosen = 0; chosen < 8; ++chosen) {
    std::vector<std::atomic<int>> visits(domain.grid.patches.size());
    for_each_patch(domain, chosen, [&](std::size_t p) { ++visits[p]; });
    for (std::size_t p = 0; p < visits.size(); ++p) {
      const BodyKind kind = domain.body_of(domain.grid.patches[p]).kind;
      const bool wanted = (kind == BodyKind::deformable && (chosen & deformable)) ||
                          (kind == BodyKind::rigid && (chosen & free_rigid)) ||
                          (kind == BodyKind::prescribed && (chosen & prescribed));
      CHECK_EQUAL(visits[p].load(), wanted ? 1 : 0);
    }
  }
}

}  // namespace

void test_loops(Report& report) {
  check_halves(report);
  for (const BasisId basis : {basis_id<Linear>, basis_id<Gimp>}) {
    check_walls<2>(report, basis);
    check_walls<3>(report, basis);
  }
  check_patches<2>(report);
  check_patches<3>(report);
}
