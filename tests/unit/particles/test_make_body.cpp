// A body from numbers: masses, means and kinds, and a sentence for what is none.
#include <limits>
#include <vector>

#include "check.hpp"
#include "mpm/particles/make_body.hpp"

void test_make_body(mpm::testing::Report& report) {
  using namespace mpm;
  TileGrid<2> grid;
  grid.cell_size = 1.0;
  const Material steel = make_material({8.0, {"elastic", {{"E", 2.0}, {"nu", 0.0}}}, {}, {}, {}});
  const std::vector<double> x{0.0, 1.0, 2.0, 3.0, 4.0, 5.0}, v{7.0, -1.0}, each{1.0, 2.0, 3.0};
  const Material stone = make_material({8.0, {"rigid", {}}, {}, {}, {}});
  std::vector<ParticlePool<2>> pools;
  for (const Material& material : {steel, stone}) pools.push_back(make_pool(material, grid));
  std::vector<Body<2>> bodies;
  for (int k = 0; k < 3; ++k) {
    const std::size_t m = k == 1 ? 1 : 0;  // the second body is of the other material
    bodies.push_back(make_body<2>("bar", m == 1 ? stone : steel, pools[m], x, v, each));
    bodies.back().material = static_cast<int>(m);
  }
  const Body<2>& body = bodies[0];
  CHECK(body.count == 3 && body.active() == 3 && body.deforms());
  CHECK_EQUAL(body.total_mass, 48.0);
  CHECK_EQUAL(body.mean_mass, 16.0);
  CHECK_CLOSE(body.mean_edge, std::sqrt(2.0), 1e-15);
  CHECK_CLOSE(body.stiffness, 2.0, 1e-14);  // rho c^2 = E for nu = 0
  CHECK_CLOSE(body.shear_impedance, std::sqrt(8.0 * 1.0), 1e-14);
  CHECK(bodies[1].is_free_rigid() && !bodies[1].deforms() && std::isinf(bodies[1].stiffness));

  // Each body's particles in the pool of its material, one after another.
  const int stress = pools[0].at.stress;
  bodies[2].given->states = {{stress, {5.0, 6.0, 7.0}}};
  std::vector<Patch<2>> patches;
  fill_pools(pools, {steel, stone}, bodies, patches);
  CHECK(pools[0].count() == 6 && pools[1].count() == 3);
  CHECK(patches.size() == 3 && patches[2].body == 2 && patches[2].begin == 3);
  for (int b = 0; b < 3; ++b) {
    CHECK(!bodies[static_cast<std::size_t>(b)].given, b);
    const ParticlePool<2>& pool = pools[b == 1 ? 1 : 0];
    std::size_t i = 0;
    for_each_row(patches, pool, b, 0, [&](std::uint32_t row) {
      CHECK(pool.id[row] == i && pool.x(0)[row] == x[2 * i] && pool.x(1)[row] == x[2 * i + 1], i);
      CHECK(pool.mass()[row] == 8.0 * each[i] && pool.volume()[row] == each[i], i);
      CHECK(pool.v(0)[row] == Storage{7.0} && pool.v(1)[row] == Storage{-1.0}, i);
      const double given = b == 2 ? 5.0 + static_cast<double>(i) : 0.0;
      CHECK_EQUAL(double{pool.stress(0)[row]}, given);
      ++i;
    });
    CHECK_EQUAL(i, std::size_t{3});
  }

  const auto refused = [&](std::vector<double> places, std::vector<double> speeds,
                           std::vector<double> volumes, const char* part) {
    CHECK(mpm::testing::throws(
              [&] { make_body<2>("bar", steel, pools[0], places, speeds, volumes); }, part),
          part);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused({}, v, each, "bar: positions must be (n, D) with n > 0");
  refused({0.0, 1.0, 2.0}, v, {1.0}, "positions must be (n, D)");
  refused(x, {1.0, 2.0, 3.0}, each, "velocities must be");
  refused(x, v, {1.0, 2.0}, "volumes must be (n,) or (1,)");
  refused(x, v, {1.0, 0.0, 2.0}, "volumes must be > 0");
  refused({0.0, nan}, v, {1.0}, "positions must be finite");
}
