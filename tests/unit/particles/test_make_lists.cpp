// Lists made anew and columns sorted by them: by patch, by cell, then in the order in which the
// user gave the particles, whatever their rows.
#include <algorithm>
#include <random>

#include "check.hpp"
#include "mpm/particles/lists.hpp"
#include "mpm/particles/make_body.hpp"

namespace {

using namespace mpm;

/// The particles' numbers, body by body, in the order of the lists.
template <int D>
std::vector<std::uint32_t> listed(const std::vector<Body<D>>& bodies) {
  std::vector<std::uint32_t> ids;
  for (const Body<D>& body : bodies)
    for (const std::uint32_t row : body.order) ids.push_back(body.id[row]);
  return ids;
}

template <int D>
void check_lists(mpm::testing::Report& report) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-9.0, 9.0);
  const Material material =
      make_material({1.0, {"elastic", {{"E", 1.0}, {"nu", 0.2}}}, {}, {}, {}});
  Threads threads(2);
  TileGrid<D> grid;
  grid.cell_size = 1.0;
  ListScratch<D> scratch;
  std::vector<Body<D>> bodies;
  const std::vector<double> at_rest(D, 0.0), volume{1.0};
  for (int b = 0; b < 2; ++b) {
    std::vector<double> x(std::size_t{300} * D);
    for (double& c : x) c = place(random);
    bodies.push_back(make_body<D>("b", material, x, at_rest, volume, grid));
  }
  make_lists(grid, bodies, threads, scratch);
  for (const Patch<D>& patch : grid.patches) {
    const Body<D>& body = bodies[static_cast<std::size_t>(patch.body)];
    patch.for_each_cell([&](int c, std::uint32_t begin, std::uint32_t end) {
      Index<D> cell = Tile<D>::cell_index(c);
      for (std::size_t a = 0; a < D; ++a) cell[a] += grid.first_cell(patch.tile)[a];
      for (std::uint32_t k = begin; k < end; ++k) {
        Vec<double, D> x;
        for (int a = 0; a < D; ++a) x[a] = body.x(a)[body.order[k]];
        CHECK(grid.cell_of(x) == cell, k);
        CHECK(k == begin || body.id[body.order[k - 1]] < body.id[body.order[k]], k);
      }
    });
  }
  CHECK(std::ranges::is_sorted(bodies[0].order));  // the columns lie in the order of the list
  const auto before = listed(bodies);
  // Rows in another order: the same lists, and sorting brings the rows back.
  for (Body<D>& body : bodies) {
    std::ranges::shuffle(body.order, random);
    sort_columns(grid, body, threads, scratch);
  }
  make_lists(grid, bodies, threads, scratch);
  CHECK(listed(bodies) == before);
  for (Body<D>& body : bodies) {
    std::reverse(body.order.begin(), body.order.end());
    body.moved = 30;  // a tenth: too few
  }
  sort_disordered(grid, bodies, threads, 0.25, scratch);
  CHECK(!std::ranges::is_sorted(bodies[1].order) && bodies[1].moved == 30);
  sort_disordered(grid, bodies, threads, 0.1, scratch);
  CHECK(std::ranges::is_sorted(bodies[1].order) && bodies[1].moved == 0);
}

}  // namespace

void test_make_lists(mpm::testing::Report& report) {
  check_lists<2>(report);
  check_lists<3>(report);
}
