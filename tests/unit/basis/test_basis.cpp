// The shape functions: they sum to one, their gradients to zero, they carry the position, and a
// field read through them agrees with the sum over the nodes and with its own derivative.
#include <random>
#include <vector>

#include "check.hpp"
#include "mpm/basis/basis.hpp"

namespace {

using namespace mpm;

constexpr double eps = std::numeric_limits<double>::epsilon();
// Sums over at most 64 nodes of products of three factors, the largest of which is one.
constexpr double tolerance = 64 * eps;

/// sum over the nodes of a block of weight x field
double sum_over_nodes(const std::vector<double>& weight, const std::vector<double>& field) {
  double total = 0.0;
  for (std::size_t i = 0; i < field.size(); ++i) total += weight[i] * field[i];
  return total;
}

template <int D, class B>
void check_basis(mpm::testing::Report& report, const BlockShape<D>& shape, const B& basis) {
  using T = Batch<4>;
  const auto count = static_cast<std::size_t>(shape.node_count);
  const Index<D> cell =
      Tile<D>::cell_index(Tile<D>::cell_count - 1);  // reaches to the block's edge
  const int first = shape.node(cell);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> inside(1e-12, 1.0 - 1e-12), any(-1.0, 1.0);
  std::vector<double> ones(count, 0.0), field(count, 0.0), lines(line * count, 0.0);
  std::array<std::vector<double>, D> position;
  position.fill(ones);
  for (int n = 0; n < shape.node_count; ++n) {
    const auto i = static_cast<std::size_t>(n);
    ones[i] = 1.0;
    field[i] = lines[line * i + quad + 1] = any(random);
    for (std::size_t a = 0; a < D; ++a) position[a][i] = shape.index(n)[a] - cell[a];
  }
  auto spread = [&](const typename B::Nodes& nodes) {
    std::vector<double> weight(count), quads(quad * count, 0.0);
    const auto none = B::Nodes::zero();
    basis.add_to_nodes(NodeLines{quads.data(), quad}.from(first), none, none, nodes, none);
    for (std::size_t i = 0; i < count; ++i) {
      weight[i] = std::exchange(quads[quad * i + 2], 0.0);
      for (std::size_t k = 0; k < quad; ++k) CHECK_EQUAL(quads[quad * i + k], 0.0);
    }
    return weight;
  };
  const auto nodes = basis.field(NodeLines{lines.data(), line}.from(first));
  // The particle in one of the lanes, others beside it.
  typename B::template Particles<4> particles;
  const auto value = [&](const Vec<double, D>& xi) {
    return nodes.value(quad + 1, basis.weights(xi));
  };

  for (int sample = 0; sample < 200; ++sample) {
    Vec<double, D> xi;
    for (int a = 0; a < D; ++a) xi[a] = inside(random);
    const int p = sample % 4;
    Vec<T, D> lanes;
    for (int a = 0; a < D; ++a)
      for (int k = 0; k < 4; ++k) lanes[a].v[k] = k == p ? xi[a] : inside(random);
    particles.put(basis, 0, lanes);
    const auto N = spread(basis.functions(particles, p, 1.0));
    CHECK_CLOSE(sum_over_nodes(N, ones), 1.0, tolerance);
    for (std::size_t a = 0; a < D; ++a)
      CHECK_CLOSE(sum_over_nodes(N, position[a]), xi[static_cast<int>(a)], tolerance);
    for (const double n : N) CHECK(n >= 0.0, n);
    CHECK_CLOSE(value(xi), sum_over_nodes(N, field), tolerance);

    typename B::Nodes G[D];
    basis.gradients(particles, p, G);
    const auto gradient = nodes.gradient(quad + 1, basis.weights(xi));
    for (int a = 0; a < D; ++a) {
      const auto dN = spread(G[a]);
      CHECK_CLOSE(sum_over_nodes(dN, ones), 0.0, tolerance);
      for (std::size_t b = 0; b < D; ++b)
        CHECK_CLOSE(sum_over_nodes(dN, position[b]), static_cast<int>(b) == a ? 1.0 : 0.0,
                    tolerance);
      CHECK_CLOSE(gradient[a], sum_over_nodes(dN, field), 4 * tolerance);
      // Central difference: exact for the piecewise quadratics between kinks, but for rounding.
      constexpr double h = 1e-6;
      Vec<double, D> up = xi, down = xi;
      up[a] += h;
      down[a] -= h;
      CHECK_CLOSE(gradient[a], (value(up) - value(down)) / (2 * h), 1e-5);
    }
  }
}

/// Four registers with a node in each lane become a quad for each node.
template <int W>
void check_quads(mpm::testing::Report& report) {
  Batch<W> from[4];
  for (int f = 0; f < 4; ++f)
    for (int n = 0; n < W; ++n) from[f].v[n] = 10.0 * n + f;
  int calls = 0;
  for_each_quad(from[0], from[1], from[2], from[3], [&](int n, Batch<4> q) {
    ++calls;
    for (int f = 0; f < 4; ++f) CHECK_EQUAL(q.v[f], 10.0 * n + f);
  });
  CHECK_EQUAL(calls, W);
}

}  // namespace

void test_basis(mpm::testing::Report& report) {
  for (const Basis basis : {Basis::linear, Basis::gimp})
    for (const double edge : {0.25, 0.5, 1.0}) {
      const auto flat = BlockShape<2>::around(~std::uint64_t{0}, margin_of(basis));
      const auto space = BlockShape<3>::around(~std::uint64_t{0}, margin_of(basis));
      with_basis<2>(basis, flat, edge, [&](const auto& b) { check_basis(report, flat, b); });
      with_basis<3>(basis, space, edge, [&](const auto& b) { check_basis(report, space, b); });
    }
  check_quads<2>(report);
  check_quads<4>(report);
  check_quads<8>(report);
  // A particle on a face, or a rounding beyond it, is held just inside the cell.
  CHECK_EQUAL(local_coordinate(3.0, 3.0), 1e-12);
  CHECK_EQUAL(local_coordinate(3.0 - 1e-15, 3.0), 1e-12);
  CHECK_EQUAL(local_coordinate(4.0, 3.0), 1.0 - 1e-12);
  CHECK_EQUAL(local_coordinate(3.25, 3.0), 0.25);
}
