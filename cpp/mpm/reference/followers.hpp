#pragma once
// Nodes that follow others, (E1) of followers/followers.hpp, in the reference step.
#include "mpm/reference/mirrors.hpp"

namespace mpm::reference {

/// A node that leads another, with its share, and the signs that walls between the two turn.
template <int D>
struct Leader {
  Index<D> node;
  double e;
  Vec<double, D> sign;
};

template <int D>
struct Followers {
  std::map<Index<D>, std::vector<Leader<D>>> of{};  // by who follows

  /// Of a body by its particles, once its nodes have masses: who leads gets those of who follows.
  void find(const Step<D>& step, Body<D>& body) {
    const Walls<D> walls = step.walls_of(body);
    const std::map<Index<D>, double> cells = filled(step, walls, body);
    for (const Particle<D>& p : body.particles)  // with those that get loads alone
      around(nearest(step, p.X), 1, [&](const Index<D>& i) { body.nodes[i]; });
    const auto exists = [&](const Index<D>& i) {
      const auto image = walls.image(i);
      const auto at = body.nodes.find(image ? image->node : i);
      return at != body.nodes.end() && at->second.m > 0.0;
    };
    const auto leads = [&](const Index<D>& i) {
      bool full = false;
      around(i, 1, [&](const Index<D>& c) {
        const auto at = cells.find(c);
        full = full || (at != cells.end() && at->second >= 1.499 * std::pow(0.5, D));
      });
      return full && exists(i);
    };
    for (const auto& [j, node] : body.nodes) {
      if (walls.image(j) || leads(j)) continue;
      for (const double farthest : {1.0, std::sqrt(2.0), 2.0, 3.0}) {  // in diagonals of a cell
        std::vector<Index<D>> near;
        around(j, 5, [&](const Index<D>& i) {
          const Vec<double, D> x = away(i, j);
          if (i != j && norm(x) < 1.0001 * std::sqrt(D) * farthest && leads(i)) near.push_back(i);
        });
        if (std::vector<double> e; linear(j, near, e)) {
          for (std::size_t k = 0; k < near.size(); ++k)
            of[j].push_back(leader(walls, near[k], e[k]));
          break;
        }
      }
    }
    while (drop_who_takes_too_much(body)) {
    }
    for (const auto& [j, leaders] : of) {
      for (const Leader<D>& leader : leaders)
        body.nodes[leader.node].m += leader.e * body.nodes[j].m;
      body.nodes[j].m = 0.0;
    }
  }

  /// Vectors of who follows, to who leads.
  template <class Vectors>
  void give(Vectors&& at) const {
    for (const auto& [j, leaders] : of) {
      const Vec<double, D> given = at(j);
      for (const Leader<D>& leader : leaders)
        for (int a = 0; a < D; ++a) at(leader.node)[a] += leader.e * leader.sign[a] * given[a];
      at(j) = Vec<double, D>::zero();
    }
  }
  /// And from who leads, to who follows.
  template <class Vectors>
  void take(Vectors&& at) const {
    for (const auto& [j, leaders] : of) {
      Vec<double, D> sum = Vec<double, D>::zero();
      for (const Leader<D>& leader : leaders)
        for (int a = 0; a < D; ++a) sum[a] += leader.e * leader.sign[a] * at(leader.node)[a];
      at(j) = sum;
    }
  }

 private:
  /// Who would leave a leader less than half of its mass does not follow. Is there any?
  bool drop_who_takes_too_much(const Body<D>& body) {
    std::map<Index<D>, double> m;
    for (const auto& [i, node] : body.nodes) m[i] = node.m;
    for (const auto& [j, leaders] : of)
      for (const Leader<D>& leader : leaders) m[leader.node] += leader.e * body.nodes.at(j).m;
    return std::erase_if(of, [&](const auto& one) {
             bool drop = false;
             for (const Leader<D>& leader : one.second)
               drop = drop || (leader.e < 0.0 && body.nodes.at(one.first).m > 0.0 &&
                               m[leader.node] < 0.5 * body.nodes.at(leader.node).m);
             return drop;
           }) > 0;
  }
  template <class F>
  static void around(const Index<D>& i, int range, F&& f) {
    Index<D> low = i, high = i;
    for (std::size_t a = 0; a < D; ++a) {
      low[a] -= range;
      high[a] += range;
    }
    for_each_index<D>(low, high, f);
  }
  static Vec<double, D> away(const Index<D>& i, const Index<D>& from) {
    Vec<double, D> x;
    for (std::size_t a = 0; a < D; ++a) x[static_cast<int>(a)] = i[a] - from[a];
    return x;
  }
  static Index<D> nearest(const Step<D>& step, const Vec<double, D>& x) {
    Index<D> i;
    for (int a = 0; a < D; ++a)
      i[static_cast<std::size_t>(a)] = static_cast<int>(std::lround(x[a] / step.h));
    return i;
  }
  static Leader<D> leader(const Walls<D>& walls, const Index<D>& i, double e) {
    Leader<D> made{i, e, {}};
    const auto image = walls.image(i);
    if (image) made.node = image->node;
    for (int a = 0; a < D; ++a) made.sign[a] = image ? image->component(1.0, a) : 1.0;
    return made;
  }
  /// How much of each box about a node the particles fill, as boxes, and their images.
  static std::map<Index<D>, double> filled(const Step<D>& step, const Walls<D>& walls,
                                           const Body<D>& body) {
    std::map<Index<D>, double> cells;
    for (const Particle<D>& p : body.particles)
      for_each_mirror(step.h, walls, [&](const Mirror<D>& mirror) {
        const double half = 0.5 * std::pow(p.m / body.material.density, 1.0 / D) / step.h;
        const Vec<double, D> x = (1.0 / step.h) * mirror.place(p.X);
        around(nearest(step, mirror.place(p.X)), 1, [&](const Index<D>& c) {
          double share = 1.0;
          for (int a = 0; a < D; ++a) {
            const double middle = c[static_cast<std::size_t>(a)];
            share *= std::max(
                std::min(x[a] + half, middle + 0.5) - std::max(x[a] - half, middle - 0.5), 0.0);
          }
          cells[c] += share;
        });
      });
    return cells;
  }
  /// e of the linear field that meets those of the nodes near j best, by 1 / r^4: Gauss's
  /// elimination of the normal equations, with pivots. Are there enough?
  static bool linear(const Index<D>& j, const std::vector<Index<D>>& near, std::vector<double>& e) {
    constexpr int n = D + 1;
    double A[n][n + 1] = {};
    const auto x = [&](const Index<D>& i, int k) { return k == 0 ? 1.0 : away(i, j)[k - 1]; };
    const auto w = [&](const Index<D>& i) { return std::pow(norm(away(i, j)), -4.0); };
    A[0][n] = 1.0;
    for (const Index<D>& i : near)
      for (int r = 0; r < n; ++r)
        for (int s = 0; s < n; ++s) A[r][s] += w(i) * x(i, r) * x(i, s);
    for (int k = 0; k < n; ++k) {
      int pivot = k;
      for (int r = k; r < n; ++r)
        if (std::abs(A[r][k]) > std::abs(A[pivot][k])) pivot = r;
      if (std::abs(A[pivot][k]) < 1e-6) return false;
      std::swap(A[k], A[pivot]);
      for (int r = 0; r < n; ++r) {
        const double factor = r == k ? 0.0 : A[r][k] / A[k][k];
        for (int s = k; s <= n; ++s) A[r][s] -= factor * A[k][s];
      }
    }
    for (const Index<D>& i : near) {
      double sum = 0.0;
      for (int k = 0; k < n; ++k) sum += w(i) * x(i, k) * A[k][n] / A[k][k];
      e.push_back(sum);
    }
    return true;
  }
};

}  // namespace mpm::reference
