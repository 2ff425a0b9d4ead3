// Springs between particles that overlap: flat layers in closed form, shares of nodes, and the
// impulse over a step.
#include <cmath>
#include <random>

#include "check.hpp"
#include "mpm/contact/node_solver.hpp"
#include "mpm/contact/springs.hpp"

namespace {

using namespace mpm;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr BasisId spline = basis_id<QuadraticBSpline>;

double quadratic(double d) {
  const double x = std::abs(d);
  return x < 0.5 ? 0.75 - x * x : x < 1.5 ? 0.5 * (1.5 - x) * (1.5 - x) : 0.0;
}

/// Layers of particles half a cell wide, so many deep, around a node: they fill one side of the
/// plane at `surface` along the last axis, towards `side`, and are moved by `shift` along it.
template <int D>
void fill(NearParticles<D>& to, double surface, double side, double shift) {
  using T = typename NearParticles<D>::T;
  constexpr double reach = 1.5;
  to.clear(1000);
  Index<D> low, high;
  low.fill(-4), high.fill(4);
  low[D - 1] = 0, high[D - 1] = 3;
  for_each_index<D>(low, high, [&](const Index<D>& k) {
    Vec<T, D> x;
    bool near = true;
    for (int a = 0; a < D; ++a) {
      const auto i = static_cast<std::size_t>(a);
      const double at = a < D - 1 ? 0.5 * (k[i] + shift) : surface + side * 0.5 * (k[i] + 0.5);
      near = near && std::abs(at) < reach;
      x[a] = T(at);
    }
    if (near) to.add(x, T(0.25), select(first_lanes<T::lanes>(1), T(1.0), T(0.0)));
  });
  to.finish();
}

/// Two flat bodies overlap by o: a pressure o / (e / M_r + e / M_s) with edges e, of which a node
/// at a distance z from the middle of the overlap has N(z) per area of a cell's face.
template <int D>
void check_layers(mpm::testing::Report& report, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int k = 0; k < 50; ++k) {
    const double middle = 1.2 * (any(random) - 0.5), o = 0.1 * any(random), shift = any(random);
    const double of_r = k % 5 == 0 ? 0.0 : any(random), of_s = 1.0 + any(random), h = 0.3;
    NearParticles<D> r, s;
    // One beside the other, so that the caps' dents play no part.
    fill<D>(r, middle + 0.5 * o, -1.0, shift);
    fill<D>(s, middle - 0.5 * o, 1.0, shift);
    Vec<double, D> n = Vec<double, D>::zero();
    n[D - 1] = 1.0;
    const NodeShare<D> share(spline, 0.5, Walls<D>{}, Index<D>{});
    const SpringSide<D> side_r{r, of_r, share}, side_s{s, of_s, share};
    const ContactSpring spring = Springs<D>(side_r, side_s, n, 0.0).at(h);
    const double stiffness = quadratic(middle) / (0.5 * h * (of_r + of_s)) * std::pow(h, D - 1);
    // Some hundred terms.
    CHECK_CLOSE(spring.stiffness, stiffness, 1000 * eps * stiffness);
    CHECK_CLOSE(spring.force, stiffness * o * h, 1000 * eps * stiffness * h);
    const ContactSpring other = Springs<D>(side_s, side_r, -1.0 * n, 0.0).at(h);
    CHECK_CLOSE(other.force, spring.force, 1000 * eps * spring.force);
    // They act from the given distance on.
    const ContactSpring apart = Springs<D>(side_r, side_s, n, -1.1 * o).at(h);
    CHECK_EQUAL(apart.force, 0.0);
    const ContactSpring sooner = Springs<D>(side_r, side_s, n, 0.01).at(h);
    CHECK(sooner.force > spring.force, sooner.force, spring.force);
  }
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
      total += NodeShare<2>(spline, 0.5, walls, i).at(from_node);
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
    pair = {0, 1, true, 0.3, normalised(Vec<double, 2>{{any(random), any(random)}})};
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
  check_layers<2>(report, random);
  check_layers<3>(report, random);
  check_walls(report);
  check_impulse(report, random);
}
