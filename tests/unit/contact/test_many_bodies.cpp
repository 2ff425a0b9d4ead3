// Three to six bodies at a node: momentum, non-penetration, Coulomb's law and the numbering of the
// bodies.
#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "check.hpp"
#include "mpm/contact/node_solver.hpp"

namespace {

using namespace mpm;

template <int D>
struct Crowd {
  NodeSolution<D> node;
  std::vector<SolvedSide<D>>& sides = node.sides;
  std::vector<SolvedPair<D>>& pairs = node.pairs;

  Crowd(const Crowd& other) : node(other.node) {}

  /// `count` bodies around a node, each seen from the node in another direction, moving at random.
  Crowd(std::mt19937_64& random, std::size_t count, double friction) {
    sides.resize(count);
    std::uniform_real_distribution<double> mass(0.5, 5.0), any(-1.0, 1.0);
    std::vector<Vec<double, D>> centre(count);
    for (std::size_t k = 0; k < count; ++k) {
      sides[k] = {};
      sides[k].mass = mass(random);
      for (int a = 0; a < D; ++a) sides[k].momentum[a] = sides[k].mass * any(random);
      bool apart = false;  // bodies do not sit inside one another: at least 35 degrees apart
      while (!apart) {
        for (int a = 0; a < D; ++a) centre[k][a] = any(random);
        centre[k] = normalised(centre[k]);
        apart = true;
        for (std::size_t j = 0; j < k; ++j) apart = apart && norm(centre[k] - centre[j]) > 0.6;
      }
    }
    for (std::size_t r = 0; r < count; ++r)
      for (std::size_t s = r + 1; s < count; ++s) {
        SolvedPair<D> pair{};
        pair.r = static_cast<std::uint16_t>(r);
        pair.s = static_cast<std::uint16_t>(s);
        pair.takes_part = true;
        pair.friction = friction;
        pair.normal = normalised(centre[s] - centre[r]);
        pairs.push_back(pair);
      }
  }

  template <bool with_friction>
  bool solve() {
    return solve_node<with_friction>(node);
  }

  /// The same bodies under other numbers: body k becomes body number[k]; pairs in the order of the
  /// new numbers.
  Crowd renumbered(const std::vector<std::size_t>& number) const {
    Crowd other = *this;
    for (std::size_t k = 0; k < sides.size(); ++k) other.sides[number[k]] = sides[k];
    for (SolvedPair<D>& pair : other.pairs) {
      pair.r = static_cast<std::uint16_t>(number[pair.r]);
      pair.s = static_cast<std::uint16_t>(number[pair.s]);
      if (pair.r < pair.s) continue;
      std::swap(pair.r, pair.s);
      pair.normal = -1.0 * pair.normal;
    }
    std::sort(other.pairs.begin(), other.pairs.end(), [](const auto& x, const auto& y) {
      return std::pair(x.r, x.s) < std::pair(y.r, y.s);
    });
    return other;
  }

  Vec<double, D> momentum() const {
    auto total = Vec<double, D>::zero();
    for (const auto& side : sides) total += side.momentum;
    return total;
  }
  double kinetic() const {
    double total = 0.0;
    for (const auto& side : sides) total += 0.5 / side.mass * dot(side.momentum, side.momentum);
    return total;
  }
};

template <int D, bool with_friction>
void check_crowd(mpm::testing::Report& report, Crowd<D> crowd, std::mt19937_64& random) {
  const auto start = crowd;
  // The solver stops at changes of 1e-12 of the largest impulse; what is left to go is at most some
  // hundred times that.
  constexpr double tolerance = 1e-9;
  crowd.template solve<with_friction>();
  const std::size_t bodies = crowd.sides.size();
  // At most 20,000 sweeps of rounded additions; in practice some tens.
  CHECK_CLOSE(norm(crowd.momentum() - start.momentum()), 0.0, 1e-13);
  CHECK(crowd.kinetic() <= start.kinetic() * (1.0 + 1e-12), crowd.kinetic(), start.kinetic(),
        bodies);
  for (const auto& pair : crowd.pairs) {
    const SolvedSide<D>&r = crowd.sides[pair.r], &s = crowd.sides[pair.s];
    const Vec<double, D> relative = (1.0 / r.mass) * r.momentum - (1.0 / s.mass) * s.momentum;
    const double approach = dot(relative, pair.normal);
    CHECK(approach <= tolerance, approach, bodies);
    CHECK(pair.normal_impulse >= 0.0, pair.normal_impulse);
    CHECK_CLOSE(pair.normal_impulse * approach, 0.0, tolerance);
    if constexpr (with_friction) {
      const double limit = pair.friction * pair.normal_impulse;
      const Vec<double, D> slip = relative - approach * pair.normal;
      CHECK(norm(pair.friction_impulse) <= limit * (1.0 + 1e-12) + 1e-15,
            norm(pair.friction_impulse), limit);
      // Where bodies slip, friction is at its limit and against the slip of r over s.
      CHECK_CLOSE(limit * norm(slip) - dot(pair.friction_impulse, slip), 0.0, tolerance);
    }
  }
  std::vector<std::size_t> number(bodies);
  std::iota(number.begin(), number.end(), 0u);
  for (int n = 0; n < 3; ++n) {
    std::shuffle(number.begin(), number.end(), random);
    Crowd<D> other = start.renumbered(number);
    other.template solve<with_friction>();
    for (std::size_t k = 0; k < bodies; ++k)
      CHECK_EQUAL(norm(other.sides[number[k]].momentum - crowd.sides[k].momentum), 0.0);
  }
}

/// Bodies that move together to the last bits have converged, although the little that passes
/// between them is rounding.
template <int D, bool with_friction>
void check_together(mpm::testing::Report& report, Crowd<D> crowd) {
  for (std::size_t k = 0; k < crowd.sides.size(); ++k)
    for (int a = 0; a < D; ++a)
      crowd.sides[k].momentum[a] =
          crowd.sides[k].mass * (30.0 - 10.0 * a) * (1.0 + 1e-16 * static_cast<double>(k));
  const Crowd<D> before = crowd;
  CHECK(crowd.template solve<with_friction>());
  for (std::size_t k = 0; k < crowd.sides.size(); ++k) {
    // 16 epsilon of a momentum from each pair, at most.
    const double tolerance = 16.0 * 2.3e-16 * static_cast<double>(crowd.pairs.size());
    const double p = norm(before.sides[k].momentum);
    CHECK_CLOSE(norm(crowd.sides[k].momentum - before.sides[k].momentum), 0.0, tolerance * p);
  }
}

template <int D>
void check_bodies(mpm::testing::Report& report) {
  std::mt19937_64 random(5);
  for (std::size_t count = 3; count <= 6; ++count)
    for (int n = 0; n < 25; ++n) {
      check_crowd<D, false>(report, Crowd<D>(random, count, 0.0), random);
      check_crowd<D, true>(report, Crowd<D>(random, count, 0.2), random);
      check_together<D, false>(report, Crowd<D>(random, count, 0.0));
      check_together<D, true>(report, Crowd<D>(random, count, 0.2));
    }
}

}  // namespace

void test_many_bodies(mpm::testing::Report& report) {
  check_bodies<2>(report);
  check_bodies<3>(report);
  // Newton's row: one body meets four at rest; all then move together, as plastic impact demands.
  std::mt19937_64 random(1);
  Crowd<2> row(random, 5, 0.0);
  for (std::size_t k = 0; k < 5; ++k) {
    row.sides[k].mass = 1.0;
    row.sides[k].momentum = {{k == 0 ? 1.0 : 0.0, 0.0}};
  }
  for (auto& pair : row.pairs) {
    pair.normal = {{1.0, 0.0}};
    pair.takes_part = pair.s == pair.r + 1;
  }
  row.solve<false>();
  for (const auto& side : row.sides) CHECK_CLOSE(side.momentum[0], 0.2, 1e-10);
}
