// Lists made anew and columns sorted by them: by patch, by cell, then in the order in which the
// user gave the particles, whatever their rows.
#include <algorithm>
#include <numeric>
#include <random>

#include "check.hpp"
#include "mpm/particles/cell_lists.hpp"
#include "mpm/particles/make_body.hpp"

namespace {

using namespace mpm;

template <int D>
struct World {
  Threads threads{2};
  TileGrid<D> grid;
  ListScratch<D> scratch;
  std::vector<Body<D>> bodies;
  std::vector<ParticlePool<D>> pools;

  /// Two bodies of one material.
  explicit World(std::mt19937_64& random) {
    std::uniform_real_distribution<double> place(-9.0, 9.0);
    const Material material =
        make_material({1.0, {"elastic", {{"E", 1.0}, {"nu", 0.2}}}, {}, {}, {}});
    grid.cell_size = 1.0;
    pools.push_back(make_pool(material, grid));
    const std::vector<double> at_rest(D, 0.0), volume{1.0};
    for (int b = 0; b < 2; ++b) {
      std::vector<double> x(std::size_t{300} * D);
      for (double& c : x) c = place(random);
      bodies.push_back(make_body<D>("b", material, pools[0], x, at_rest, volume));
    }
    fill_pools(pools, {material}, bodies, grid.patches);
    place_anchor(grid, bodies, pools);
    build_cell_lists(grid, bodies, pools, threads, scratch);
  }
  void build() {
    place_anchor(grid, bodies, pools);
    build_cell_lists(grid, bodies, pools, threads, scratch);
  }
  void sort(double share) { sort_disordered(grid, bodies, pools, threads, share, scratch); }
  std::vector<std::uint32_t> rows_of(int body) const {
    std::vector<std::uint32_t> rows;
    for_each_active_row(grid.patches, pools[0], body,
                        [&](std::uint32_t row) { rows.push_back(row); });
    return rows;
  }
  /// The particles' numbers, body by body, in the order of the lists.
  std::vector<std::uint32_t> listed() const {
    std::vector<std::uint32_t> ids;
    for (int b = 0; b < 2; ++b)
      for (const std::uint32_t row : rows_of(b)) ids.push_back(pools[0].id[row]);
    return ids;
  }
};

template <int D>
void check_cells(mpm::testing::Report& report, const World<D>& world) {
  const ParticlePool<D>& pool = world.pools[0];
  for (const Patch<D>& patch : world.grid.patches) {
    CHECK(patch.count <= patch.room && patch.begin + patch.room <= pool.used, patch.begin);
    patch.for_each_cell([&](int c, std::uint32_t begin, std::uint32_t end) {
      Index<D> cell = Tile<D>::cell_index(c);
      for (std::size_t a = 0; a < D; ++a) cell[a] += world.grid.first_cell(patch.tile)[a];
      for (std::uint32_t k = begin; k < end; ++k) {
        CHECK(world.grid.cell_of(pool.position_of(pool.order[k])) == cell, k);
        CHECK(k == begin || pool.id[pool.order[k - 1]] < pool.id[pool.order[k]], k);
      }
    });
  }
}

template <int D>
void check_lists(mpm::testing::Report& report) {
  std::mt19937_64 random(5);
  World<D> world(random);
  check_cells(report, world);
  CHECK(std::ranges::is_sorted(world.rows_of(0)));  // the rows lie in the order of the lists
  const auto before = world.listed();
  // Rows in another order, of both bodies mixed: the same lists, and sorting brings the rows back
  // to the order of the lists, each body's among themselves.
  ParticlePool<D>& pool = world.pools[0];
  std::vector<std::uint32_t> moved_to(pool.count());
  std::iota(moved_to.begin(), moved_to.end(), 0u);
  std::ranges::shuffle(moved_to, random);
  ParticlePool<D> mixed = make_pool(
      make_material({1.0, {"elastic", {{"E", 1.0}, {"nu", 0.2}}}, {}, {}, {}}), world.grid);
  mixed.columns.allocate(pool.count());
  mixed.id.resize(pool.count());
  for (std::size_t row = 0; row < pool.count(); ++row) {
    for (int c = 0; c < pool.columns.component_count(); ++c)
      mixed.columns.with_component(c, [&]<class Number>(Number* to) {
        to[moved_to[row]] = static_cast<Number>(pool.columns.value(c, row));
      });
    mixed.id[moved_to[row]] = pool.id[row];
  }
  mixed.order = pool.order;
  mixed.used = pool.used;
  for (const Patch<D>& patch : world.grid.patches)
    for (std::uint32_t k = patch.begin; k < patch.begin + patch.count; ++k)
      mixed.order[k] = moved_to[pool.order[k]];
  world.pools[0] = std::move(mixed);
  CHECK(!std::ranges::is_sorted(world.rows_of(0)));
  CHECK(world.listed() == before);
  for (Body<D>& body : world.bodies) body.moved = 30;  // a tenth
  world.scratch.moved = {0, 1};
  world.sort(0.25);  // too few
  CHECK(!std::ranges::is_sorted(world.rows_of(1)) && world.bodies[1].moved == 30);
  world.sort(0.1);
  CHECK(std::ranges::is_sorted(world.rows_of(0)) && std::ranges::is_sorted(world.rows_of(1)));
  CHECK(world.bodies[1].moved == 0 && world.listed() == before);
  check_cells(report, world);
  world.build();
  CHECK(world.listed() == before);
  check_cells(report, world);
}

}  // namespace

void test_build_cell_lists(mpm::testing::Report& report) {
  check_lists<2>(report);
  check_lists<3>(report);
}
