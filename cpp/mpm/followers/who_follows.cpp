#include "mpm/followers/who_follows.hpp"

#include <array>
#include <cmath>
#include <iterator>

namespace mpm {
namespace {

/// One body: its cells and nodes, with those that walls mirror.
template <int D>
struct BodyOfNodes {
  const Walls<D>& walls;
  OnesOfBody<D> cells, masses;

  /// How much of a cell is filled. Half of that about a node on a wall is beyond it.
  double filled(const Index<D>& cell) const {
    const auto image = walls.image(cell);
    double share = value_of(cells, image ? image->node : cell);
    for (std::size_t a = 0; a < D; ++a)
      for (const int side : {0, 1})
        if (walls.exist && Walls<D>::holds(walls.face[a][side]) &&
            cell[a] == (side == 0 ? 0 : walls.cells[a]))
          share *= 2.0;
    return share;
  }

  bool leads(const std::type_identity_t<Index<D>>& node) const {
    constexpr double least = 1.499 / (1 << D);  // of 2^D particles a cell more than one
    const auto image = walls.image(node);
    if (!(value_of(masses, image ? image->node : node) > 0.0)) return false;
    if (filled(node) >= least) return true;
    bool found = false;
    for_each_around(node, 1, [&](const Index<D>& c) { found = found || filled(c) >= least; });
    return found;
  }
  /// Is there matter in any of the cells around?
  bool is_reached(const Index<D>& node) const {
    bool found = false;
    for_each_around(node, 1, [&](const Index<D>& c) { found = found || filled(c) > 0.0; });
    return found;
  }
  template <class F>
  static void for_each_around(const Index<D>& node, int range, F&& f) {
    Index<D> low = node, high = node;
    for (std::size_t a = 0; a < D; ++a) {
      low[a] -= range;
      high[a] += range;
    }
    for_each_index<D>(low, high, f);
  }
};

/// The coefficients c of (E1), by the moments of those who lead, (1, X) (1, X)^T; are there enough?
template <int D>
bool solve(std::array<std::array<double, D + 1>, D + 1> moments, std::array<double, D + 1>& c) {
  c = {};
  c[0] = 1.0;
  // Of a positive matrix: no pivots are needed.
  for (std::size_t k = 0; k <= D; ++k) {
    if (!(moments[k][k] > 1e-6)) return false;
    for (std::size_t i = k + 1; i <= D; ++i) {
      const double factor = moments[i][k] / moments[k][k];
      for (std::size_t j = k; j <= D; ++j) moments[i][j] -= factor * moments[k][j];
      c[i] -= factor * c[k];
    }
  }
  for (std::size_t k = D + 1; k-- > 0;) {
    for (std::size_t j = k + 1; j <= D; ++j) c[k] -= moments[k][j] * c[j];
    c[k] /= moments[k][k];
  }
  return true;
}

/// (E1), by those within the least of four distances that are enough; none if there are none.
template <int D>
std::vector<Leader<D>> leaders_of(const BodyOfNodes<D>& body,
                                  const std::type_identity_t<Index<D>>& node) {
  using Numbers = std::array<double, D + 1>;
  const auto away = [&](const Index<D>& i) {
    Numbers x{1.0};
    for (std::size_t a = 0; a < D; ++a) x[a + 1] = i[a] - node[a];
    return x;
  };
  const auto squared = [](const Numbers& x) {
    double square = 0.0;
    for (std::size_t a = 1; a <= D; ++a) square += x[a] * x[a];
    return square;
  };
  for (const int times : {1, 2, 4, 9}) {
    std::vector<Leader<D>> leaders;
    std::array<Numbers, D + 1> moments{};
    const double farthest = times * D;
    body.for_each_around(node, static_cast<int>(std::sqrt(farthest)), [&](const Index<D>& i) {
      const Numbers x = away(i);
      const double square = squared(x);
      if (i == node || square > farthest || !body.leads(i)) return;
      const auto image = body.walls.image(i);
      leaders.push_back({image ? image->node : i, i, 0.0, image ? image->turned : 0u});
      for (std::size_t r = 0; r <= D; ++r)
        for (std::size_t s = 0; s <= D; ++s) moments[r][s] += x[r] * x[s] / (square * square);
    });
    Numbers c;
    if (!solve<D>(moments, c)) continue;
    for (Leader<D>& one : leaders) {
      const Numbers x = away(one.beyond);
      const double square = squared(x);
      for (std::size_t r = 0; r <= D; ++r) one.share += x[r] * c[r] / (square * square);
    }
    return leaders;
  }
  return {};
}

/// Shares may be below zero: who would leave a leading node less than half of its mass does not
/// follow.
template <int D>
void keep_masses(const BodyOfNodes<D>& body, std::vector<Follower<D>>& all) {
  const auto place_of_mass = [&](const Index<D>& node) {
    const auto index = [](const OfNode<D>& one) -> const Index<D>& { return one.node.node; };
    return static_cast<std::size_t>(std::ranges::lower_bound(body.masses, node, {}, index) -
                                    body.masses.begin());
  };
  for (bool changed = true; changed;) {
    std::vector<double> with(body.masses.size());
    for (std::size_t k = 0; k < with.size(); ++k) with[k] = body.masses[k].value;
    for (const Follower<D>& one : all)
      for (const Leader<D>& leader : one.leaders)
        with[place_of_mass(leader.node)] += leader.share * one.mass;
    const auto takes_too_much = [&](const Leader<D>& leader) {
      const std::size_t k = place_of_mass(leader.node);
      return leader.share < 0.0 && with[k] < 0.5 * body.masses[k].value;
    };
    changed = std::erase_if(all, [&](const Follower<D>& one) {
                return one.mass > 0.0 && std::ranges::any_of(one.leaders, takes_too_much);
              }) > 0;
  }
}

}  // namespace

template <int D>
void add_followers(const Walls<D>& walls, OnesOfBody<D> cells, OnesOfBody<D> masses, bool at_start,
                   std::vector<Follower<D>>& all) {
  const BodyOfNodes<D> body{walls, cells, masses};
  std::vector<Follower<D>> own;
  for (const OfNode<D>& one : body.masses) {
    const Index<D>& node = one.node.node;
    if ((!at_start && one.value > 0.0) || body.walls.image(node)) continue;
    if (body.leads(node) || !body.is_reached(node)) continue;
    std::vector<Leader<D>> leaders = leaders_of(body, node);
    if (!leaders.empty()) own.push_back({one.node, one.value, std::move(leaders)});
  }
  keep_masses(body, own);
  std::ranges::move(own, std::back_inserter(all));
}

template void add_followers<2>(const Walls<2>&, OnesOfBody<2>, OnesOfBody<2>, bool,
                               std::vector<Follower<2>>&);
template void add_followers<3>(const Walls<3>&, OnesOfBody<3>, OnesOfBody<3>, bool,
                               std::vector<Follower<3>>&);

}  // namespace mpm
