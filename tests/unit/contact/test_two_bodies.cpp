// Two bodies at a node: exactly eqs. (6)-(7) and (11)-(15) of Ma, Zhang & Huang (2010).
#include <random>

#include "check.hpp"
#include "mpm/contact/node_solver.hpp"

namespace {

using namespace mpm;
using mpm::testing::eps;

// About ten roundings of quantities of the size of the momenta, which are below 100.
constexpr double rounding = 1000 * eps;

template <int D>
struct Meeting {
  NodeSolution<D> node{std::vector<SolvedSide<D>>(2), std::vector<SolvedPair<D>>(1)};
  std::vector<SolvedSide<D>>& sides = node.sides;
  SolvedPair<D>& pair = node.pairs[0];

  explicit Meeting(std::mt19937_64& random) {
    std::uniform_real_distribution<double> mass(0.1, 10.0), any(-1.0, 1.0);
    for (std::size_t k = 0; k < 2; ++k) {
      sides[k].mass = mass(random);
      for (int a = 0; a < D; ++a) sides[k].momentum[a] = 10.0 * any(random);
      for (int a = 0; a < D; ++a) pair.normal[a] = any(random);
    }
    pair.normal = normalised(pair.normal);
    pair.r = 0;
    pair.s = 1;
    pair.takes_part = true;
  }
  template <bool with_friction>
  void solve() {
    solve_node<with_friction>(node);
  }
};

template <int D>
double distance(const Vec<double, D>& x, const Vec<double, D>& y) {
  return norm(x - y);
}

/// (m_s p_r - m_r p_s) / (m_r + m_s): what eqs. (6), (7), (13) and (15) project.
template <int D>
Vec<double, D> relative_momentum(const Meeting<D>& m) {
  const SolvedSide<D>&r = m.sides[0], &s = m.sides[1];
  return (1.0 / (r.mass + s.mass)) * (s.mass * r.momentum - r.mass * s.momentum);
}

template <int D>
void check_momentum(mpm::testing::Report& report, std::mt19937_64& random) {
  int approaching = 0;
  for (int n = 0; n < 200; ++n) {
    Meeting<D> m(random);
    const auto p_r = m.sides[0].momentum, p_s = m.sides[1].momentum;
    const double approach = dot(relative_momentum(m), m.pair.normal);
    m.template solve<false>();
    approaching += approach > 0.0;
    const Vec<double, D> removed = std::max(approach, 0.0) * m.pair.normal;
    CHECK_CLOSE(distance(m.sides[0].momentum, p_r - removed), 0.0, rounding);  // eq. (6)
    CHECK_CLOSE(distance(m.sides[1].momentum, p_s + removed), 0.0, rounding);  // eq. (7)
    CHECK_CLOSE(m.pair.normal_impulse, std::max(approach, 0.0), rounding);
    CHECK_EQUAL(norm(m.pair.friction_impulse), 0.0);
  }
  CHECK(approaching > 50 && approaching < 150, approaching);  // both branches are tested
}

/// With p + dt f as the momentum, f^nor dt is eq. (13) and f^fric dt is eqs. (14)-(15): the
/// approach of p is gone by then.
template <int D>
void check_forces(mpm::testing::Report& report, std::mt19937_64& random) {
  int slipping = 0, sticking = 0;
  for (int n = 0; n < 400; ++n) {
    Meeting<D> m(random);
    m.pair.friction = 0.5;
    const auto p_r = m.sides[0].momentum, p_s = m.sides[1].momentum;
    const Vec<double, D> all = relative_momentum(m);
    const double nor = std::max(dot(all, m.pair.normal), 0.0);
    const Vec<double, D> along = all - dot(all, m.pair.normal) * m.pair.normal;
    const Vec<double, D> s_r = normalised(along);  // the unit tangent of eqs. (11)-(12)
    const double tan = dot(all, s_r);
    const double fric = std::min(m.pair.friction * nor, tan);
    m.template solve<true>();
    if (nor > 0.0) ++(fric < tan ? slipping : sticking);
    const Vec<double, D> impulse = nor * m.pair.normal + fric * s_r;
    CHECK_CLOSE(distance(m.sides[0].momentum, p_r - impulse), 0.0, rounding);  // eq. (11)
    CHECK_CLOSE(distance(m.sides[1].momentum, p_s + impulse), 0.0, rounding);  // eq. (12)
    CHECK_CLOSE(distance(m.pair.friction_impulse, fric * s_r), 0.0, rounding);
  }
  CHECK(slipping > 20 && sticking > 20, slipping, sticking);
}

}  // namespace

void test_two_bodies(mpm::testing::Report& report) {
  std::mt19937_64 random(11);
  check_momentum<2>(report, random);
  check_momentum<3>(report, random);
  check_forces<2>(report, random);
  check_forces<3>(report, random);
  // A pair that takes no part is left alone.
  Meeting<2> open(random);
  open.pair.takes_part = false;
  const auto before = open.sides[0].momentum;
  open.solve<true>();
  CHECK_EQUAL(distance(open.sides[0].momentum, before), 0.0);
  CHECK_EQUAL(open.pair.normal_impulse, 0.0);
}
