// Springs between particles and bodies that overlap: the surface of flat layers, their pressure in
// closed form, shares of nodes, and the impulse over a step.
#include <algorithm>
#include <cmath>
#include <random>

#include "check.hpp"
#include "mpm/contact/node_solver.hpp"
#include "mpm/contact/springs.hpp"
#include "mpm/contact/surface.hpp"

namespace {

using namespace mpm;
using mpm::testing::eps;
constexpr BasisId spline = basis_id<QuadraticBSpline>;

double quadratic(double d) {
  const double x = std::abs(d);
  return x < 0.5 ? 0.75 - x * x : x < 1.5 ? 0.5 * (1.5 - x) * (1.5 - x) : 0.0;
}

/// Layers of a lattice of particles, the outermost of which a point lies over by z, all in edges of
/// the particles: by how much it is taken to be lower than it is, of an edge.
template <int D>
double sinks(double z, double edge, const Vec<double, D>& beside, int layers) {
  using T = typename SurfaceSum<D>::T;
  SurfaceSum<D> sum;
  Index<D> low, high;
  low.fill(-4), high.fill(4);
  low[D - 1] = 0, high[D - 1] = layers - 1;
  for_each_index<D>(low, high, [&](const Index<D>& k) {
    Vec<T, D> d;
    for (int a = 0; a + 1 < D; ++a) d[a] = T(edge * (k[static_cast<std::size_t>(a)] + beside[a]));
    d[D - 1] = T(-edge * (z + k[D - 1]));
    sum.add(d, T(0.5 * edge), select(first_lanes<T::lanes>(1), T(1.0), T(0.0)));
  });
  return z - sum.height(sum.mean_half()) / edge;
}

/// Where bodies touch, the surface of flat layers has dents of six ten-thousandths of an
/// edge, and of a twentieth of the overlap more where they overlap; the layer below has no part in
/// it where they touch, and lifts it by less than a hundredth of the overlap.
template <int D>
void check_surface(mpm::testing::Report& report, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (const double z : {0.8, 0.9, 1.0}) {
    double mean = 0.0, most = 0.0;
    constexpr int places = 400;
    for (int k = 0; k < places; ++k) {
      Vec<double, D> beside;
      for (int a = 0; a < D; ++a) beside[a] = any(random);
      const double here = sinks<D>(z, 0.1 + 0.9 * any(random), beside, 1);
      mean += here / places;
      most = std::max(most, std::abs(here));
      const double by_layers = sinks<D>(z, 1.0, beside, 3) - sinks<D>(z, 1.0, beside, 1);
      CHECK_CLOSE(by_layers, 0.0, 0.01 * (1.0 - z) + 10 * eps);
    }
    CHECK(most < (D == 2 ? 1e-5 : 6e-4) + 0.05 * (1.0 - z), z, most);
    CHECK(std::abs(mean) < 1e-3, z, mean);
  }
}

/// What is cut off of the weights of wide particles is no gap: the height of an edge is what it is,
/// in the mean. From two cells on they have no surface.
template <int D>
void check_wide(mpm::testing::Report& report, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (const double edge : {0.45, 0.52, 0.7, 1.0, 1.1, 1.2, 1.4}) {
    double mean = 0.0;
    constexpr int places = 400;
    for (int k = 0; k < places; ++k) {
      Vec<double, D> beside;
      for (int a = 0; a < D; ++a) beside[a] = any(random);
      mean += sinks<D>(1.0, edge, beside, 1) / places;
    }
    CHECK(std::abs(mean) < (edge <= 1.0 ? 1e-4 : 0.01), edge, mean);
  }
  CHECK_EQUAL(SurfaceSum<D>().height(1.01), HUGE_VAL);
  CHECK_EQUAL(SurfaceSum<D>::range(0.5), 1);
  CHECK_EQUAL(SurfaceSum<D>::range(0.55), 2);
}

/// The normal is the way in which the height falls fastest.
template <int D>
void check_normal(mpm::testing::Report& report, std::mt19937_64& random) {
  using T = typename SurfaceSum<D>::T;
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int k = 0; k < 20; ++k) {
    std::vector<Vec<double, D>> others(2);
    for (Vec<double, D>& q : others)
      for (int a = 0; a < D; ++a) q[a] = 0.2 * any(random) + (a == 0 ? 0.5 : 0.0);
    const auto seen_from = [&](const Vec<double, D>& x) {
      SurfaceSum<D> sum;
      for (const Vec<double, D>& q : others) {
        Vec<T, D> d;
        for (int a = 0; a < D; ++a) d[a] = T(q[a] - x[a]);
        sum.add(d, T(0.25), select(first_lanes<T::lanes>(1), T(1.0), T(0.0)));
      }
      return sum;
    };
    constexpr double step = 1e-6;
    Vec<double, D> falls;
    for (int a = 0; a < D; ++a) {
      Vec<double, D> x = Vec<double, D>::zero();
      x[a] = step;
      falls[a] = seen_from(-1.0 * x).height(0.25) - seen_from(x).height(0.25);
    }
    // Differences of a step have an error of its square.
    CHECK(norm(seen_from(Vec<double, D>::zero()).normal() - normalised(falls)) < 1e-7);
  }
}

/// A flat layer of particles, each over its other body by o, is pressed by o / (e / M_r + e / M_s)
/// with edges e, half from either side; of this a node at a distance z from the middle of the
/// overlap has N(z) per area of a cell's face.
template <int D>
void check_layers(mpm::testing::Report& report, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int k = 0; k < 50; ++k) {
    const double middle = 1.2 * (any(random) - 0.5), o = 0.1 * any(random), shift = any(random);
    const double give_r = k % 5 == 0 ? 0.0 : any(random), give_s = 1.0 + any(random), h = 0.3;
    Vec<double, D> n = Vec<double, D>::zero(), node;
    for (int a = 0; a < D; ++a) node[a] = any(random);
    n[D - 1] = 1.0;
    const NodeShares<D> shares(spline, 0.5, Walls<D>{}, Index<D>{});
    const SpringSide<D> r{0, give_r, shares}, s{1, give_s, shares};
    Springs<D> springs;
    for (const std::int32_t own : {0, 1}) {
      Index<D> low, high;
      low.fill(-4), high.fill(4);
      low[D - 1] = high[D - 1] = 0;
      for_each_index<D>(low, high, [&](const Index<D>& i) {
        const Vec<double, D> inwards = (own == 0 ? 1.0 : -1.0) * n;
        // Set back by 0.05.
        Touch<D> touch{own, 1 - own, 0, node, inwards, 0.25, 0.2, 0.25, o, 0.2 - 0.5 * o};
        for (int a = 0; a + 1 < D; ++a)
          touch.x[a] += 0.5 * (i[static_cast<std::size_t>(a)] + shift);
        touch.x[D - 1] += middle + (own == 0 ? -1.0 : 1.0) * (0.2 - 0.5 * o);
        springs.add(touch, node, r, s);
      });
    }
    const double stiffness = quadratic(middle) / (0.5 * h * (give_r + give_s)) * std::pow(h, D - 1);
    // Some hundred terms.
    const ContactSpring spring = springs.along(springs.normal(0), h);
    CHECK_CLOSE(spring.stiffness, stiffness, 1000 * eps * stiffness);
    CHECK_CLOSE(spring.force, stiffness * o * h, 1000 * eps * stiffness * h);
    CHECK_CLOSE(spring.energy, 0.5 * stiffness * o * o * h * h, 1000 * eps * stiffness * h * h);
  }
}

/// Beyond the walls of a box a body goes on: each face mirrors what is near to it.
void check_images(mpm::testing::Report& report) {
  Walls<2> walls;
  walls.exist = true;
  walls.cells = {1, 6};
  walls.face[0][0] = walls.face[0][1] = Wall::slip;
  walls.face[1][0] = Wall::fixed;
  std::vector<std::pair<double, double>> images;
  const auto find = [&](double x, double y) {
    images.clear();
    for_each_image<2>(walls, Vec<double, 2>{{x, y}}, 1.0,
                      [&](const Vec<double, 2>& at, const Vec<double, 2>&) {
                        images.emplace_back(at[0], at[1]);
                      });
    return images.size();
  };
  CHECK_EQUAL(find(0.25, 3.0), std::size_t{3});  // the box is but a cell wide
  CHECK_EQUAL(find(0.25, 5.9), std::size_t{3});  // a free face has no image
  CHECK_EQUAL(find(0.25, 0.5), std::size_t{6});
  CHECK(std::ranges::count(images, std::pair{-0.25, -0.5}) == 1);
  CHECK(std::ranges::count(images, std::pair{1.75, 0.5}) == 1);
}

/// A point before a wall with images gives all of its force to the nodes before it.
void check_walls(mpm::testing::Report& report) {
  Walls<2> walls;
  walls.exist = true;
  walls.cells = {6, 6};
  walls.face[0][0] = walls.face[0][1] = walls.face[1][0] = Wall::slip;
  for (const double x : {0.01, 0.3, 0.9, 2.5, 5.2, 5.99}) {
    const Vec<double, 2> point{{x, 6.0 - x}};
    double total = 0.0;
    for_each_index<2>({0, 0}, {6, 8}, [&](const Index<2>& i) {
      const Vec<double, 2> from_node{{x - i[0], point[1] - i[1]}};
      NodeShares<2>(spline, 0.5, walls, i).of(from_node, [&](double share, const Vec<double, 2>&) {
        total += share;
      });
    });
    CHECK_CLOSE(total, 1.0, 100 * eps);
  }
}

/// J = F dt + c u with the approach u that is left after it, but no pull.
void check_impulse(mpm::testing::Report& report, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int pushed = 0;
  for (int k = 0; k < 100; ++k) {
    NodeSolution<2> node{std::vector<SolvedSide<2>>(2), std::vector<SolvedPair<2>>(1)};
    for (SolvedSide<2>& side : node.sides) {
      side.mass = 2.0 + any(random);
      side.momentum = {{any(random), any(random)}};
    }
    const Vec<double, 2> before = node.sides[0].momentum + node.sides[1].momentum;
    SolvedPair<2>& pair = node.pairs[0];
    pair = {0, 1, true, false, 0.3, normalised(Vec<double, 2>{{any(random), any(random)}})};
    pair.spring = {0.2 * (1.0 + any(random)), 1.0 + any(random), true};
    CHECK(solve_node<true>(node));
    const auto v = [&](int s) { return node.sides[static_cast<std::size_t>(s)].end_velocity(); };
    const double left = dot(v(0) - v(1), pair.normal);
    const double wanted = pair.spring.impulse + pair.spring.per_approach * left;
    if (pair.normal_impulse > 0.0)
      CHECK_CLOSE(pair.normal_impulse, wanted, 100 * eps);
    else
      CHECK(wanted <= 100 * eps, wanted);
    pushed += pair.normal_impulse > 0.0;
    CHECK(norm(pair.friction_impulse) <= 0.3 * pair.normal_impulse * (1 + 10 * eps));
    CHECK_CLOSE(norm(node.sides[0].momentum + node.sides[1].momentum - before), 0.0, 100 * eps);
  }
  CHECK(pushed > 50 && pushed < 100, pushed);  // both branches are tested
}

}  // namespace

void test_springs(mpm::testing::Report& report) {
  std::mt19937_64 random(5);
  check_surface<2>(report, random);
  check_surface<3>(report, random);
  check_wide<2>(report, random);
  check_wide<3>(report, random);
  check_normal<2>(report, random);
  check_normal<3>(report, random);
  check_images(report);
  check_layers<2>(report, random);
  check_layers<3>(report, random);
  check_walls(report);
  check_impulse(report, random);
}
