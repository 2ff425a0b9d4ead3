// The shape functions: they sum to one, their gradients to zero, they carry the position, and a
// field read through them agrees with the sum over the nodes and with its own derivative.
#include <cmath>
#include <random>
#include <vector>

#include "check.hpp"
#include "mpm/grid/tile_grid.hpp"
#include "mpm/schedule/choose.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace {

using namespace mpm;
using mpm::testing::eps;

// Sums over at most 64 nodes of products of three factors, the largest of which is one.
constexpr double tolerance = 64 * eps;

/// sum over the nodes of a block of weight x field
double sum_over_nodes(const std::vector<double>& weight, const std::vector<double>& field) {
  double total = 0.0;
  for (std::size_t i = 0; i < field.size(); ++i) total += weight[i] * field[i];
  return total;
}

/// Fields read by particles in W lanes are those that each would read alone.
template <int W, int D, BasisModel B, class Nodes>
void check_lanes(mpm::testing::Report& report, const B& basis, const Nodes& nodes,
                 const Vec<double, D>& start) {
  Vec<Batch<W>, D> lanes;
  for (int k = 0; k < W; ++k)
    for (int a = 0; a < D; ++a) lanes[a].v[k] = std::fmod(start[a] + 0.37 * k, 1.0);
  const auto w = weights_at(basis, lanes);
  const auto v = nodes.template vector<force_at>(w);
  const auto g = nodes.template gradients<force_at>(w);
  for (int k = 0; k < W; ++k) {
    Vec<double, D> xi;
    for (int a = 0; a < D; ++a) xi[a] = lanes[a].v[k];
    const auto alone = weights_at(basis, xi);
    const auto v_alone = nodes.template vector<force_at>(alone);
    const auto g_alone = nodes.template gradients<force_at>(alone);
    for (std::size_t i = 0; i < D; ++i) {
      const int c = static_cast<int>(i);
      CHECK_CLOSE(v[c].v[k], v_alone[c], tolerance);
      for (int a = 0; a < D; ++a) CHECK_CLOSE(g[i][a].v[k], g_alone[i][a], 4 * tolerance);
    }
  }
}

template <int D, BasisModel B>
void check_basis(mpm::testing::Report& report, const BlockShape<D>& shape, const B& basis) {
  const Scatter<B, D> scatter{NodeStrides<D>(shape)};
  const int to_first = NodeStrides<D>(shape).to_first(B::before);
  using T = Batch<4>;
  const auto count = static_cast<std::size_t>(shape.node_count);
  const Index<D> cell =
      Tile<D>::cell_index(Tile<D>::cell_count - 1);  // reaches to the block's edge
  const int first = shape.node(cell);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> inside(1e-12, 1.0 - 1e-12), any(-1.0, 1.0);
  std::vector<double> ones(count, 0.0), field(count, 0.0), records(record * count, 0.0);
  std::array<std::vector<double>, D> position;
  position.fill(ones);
  for (int n = 0; n < shape.node_count; ++n) {
    const auto i = static_cast<std::size_t>(n);
    ones[i] = 1.0;
    field[i] = records[record * i + force_at + 1] = any(random);
    for (std::size_t a = 0; a < D; ++a) position[a][i] = shape.index(n)[a] - cell[a] + B::own_node;
  }
  constexpr int room = 16;
  constexpr unsigned everything = gives_mass | gives_momentum | gives_forces;
  double mass = 0.0;  // of one particle, with its velocity and traction; the others have none
  Vec<double, D> velocity = Vec<double, D>::zero();
  auto traction = Sym<double, D>::zero();
  typename Scatter<B, D>::template Places<room> places{};
  // What particle p gives, others at its side.
  const auto payload_of = [&]<unsigned what>(int p, std::integral_constant<unsigned, what>) {
    typename Scatter<B, D>::template Payload<room> payload{};
    const auto in_lane = [&](int at, double value) {
      T lanes(0.0);
      if (p >= at && p < at + 4) lanes.v[p - at] = value;
      return lanes;
    };
    for (int at = 0; at < room; at += 4) {
      Vec<T, D> v;
      Sym<T, D> t;
      for (int a = 0; a < D; ++a) v[a] = in_lane(at, velocity[a]);
      for (int c = 0; c < Sym<double, D>::size; ++c) t.c[c] = in_lane(at, traction.c[c]);
      payload.template add<what>(at, in_lane(at, mass), v);
      payload.add_tractions(at, t);
    }
    return payload;
  };
  // The records that particle p alone gives to the nodes, mass and momentum, and forces.
  const auto given = [&](int p) {
    std::vector<double> to(record * count, 0.0);
    const NodeRecords nodes = NodeRecords{to.data()}.from(first + to_first);
    const auto payload = payload_of(p, std::integral_constant<unsigned, everything>{});
    scatter.template give<Mapping<Flip>, everything>(nodes, places, payload, room);
    return to;
  };
  const auto number = [&](const std::vector<double>& of, int at) {
    std::vector<double> r(count);
    for (std::size_t i = 0; i < count; ++i) r[i] = of[record * i + static_cast<std::size_t>(at)];
    return r;
  };
  const auto nodes = field_of<B>(NodeRecords{records.data()}.from(first), NodeStrides<D>(shape));
  const auto value = [&](const Vec<double, D>& xi) {
    return nodes.template vector<force_at>(weights_at(basis, xi))[1];
  };

  for (int sample = 0; sample < 200; ++sample) {
    Vec<double, D> xi;
    for (int a = 0; a < D; ++a) xi[a] = inside(random);
    const int p = sample % 4;
    Vec<T, D> lanes;
    for (int a = 0; a < D; ++a)
      for (int k = 0; k < 4; ++k) lanes[a].v[k] = k == p ? xi[a] : inside(random);
    for (int at = 0; at < room; at += 4)
      scatter.template put<everything>(places, at, weights_at(basis, lanes));
    // A mass of one, so that the nodes' are N; tractions that give dN_ip / d xi_b as component c.
    mass = 1.0;
    for (int a = 0; a < D; ++a) velocity[a] = 10.0 + a;
    const auto N = number(given(p), mass_at);
    CHECK_CLOSE(sum_over_nodes(N, ones), 1.0, tolerance);
    for (std::size_t a = 0; a < D; ++a)
      CHECK_CLOSE(sum_over_nodes(N, position[a]), xi[static_cast<int>(a)], tolerance);
    for (const double n : N) CHECK(n >= 0.0, n);
    CHECK_CLOSE(value(xi), sum_over_nodes(N, field), tolerance);
    for (int a = 0; a < D; ++a)
      CHECK_CLOSE(sum_over_nodes(number(given(p), velocity_at + a), ones), 10.0 + a,
                  11 * tolerance);

    const auto gradients = nodes.template gradients<force_at>(weights_at(basis, xi));
    for (int a = 0; a < D; ++a) {
      traction = Sym<double, D>::zero();
      traction(a, a) = 1.0;
      const auto dN = number(given(p), force_at + a);
      CHECK_CLOSE(sum_over_nodes(dN, ones), 0.0, tolerance);
      for (std::size_t b = 0; b < D; ++b)
        CHECK_CLOSE(sum_over_nodes(dN, position[b]), static_cast<int>(b) == a ? 1.0 : 0.0,
                    tolerance);
      CHECK_CLOSE(gradients[1][a], sum_over_nodes(dN, field), 4 * tolerance);
      // An off-diagonal part gives its two components of the force.
      const int b = (a + 1) % D;
      traction(a, a) = 0.0;
      traction(a, b) = 1.0;
      const auto across = number(given(p), force_at + b);
      for (std::size_t i = 0; i < count; ++i) CHECK_CLOSE(across[i], dN[i], tolerance);
      // Central difference: exact for the piecewise quadratics between kinks, but for rounding.
      constexpr double h = 1e-6;
      Vec<double, D> up = xi, down = xi;
      up[a] += h;
      down[a] -= h;
      CHECK_CLOSE(gradients[1][a], (value(up) - value(down)) / (2 * h), 1e-5);
    }
    traction = Sym<double, D>::zero();
    if (sample < 8) {
      check_lanes<2>(report, basis, nodes, xi);
      check_lanes<4>(report, basis, nodes, xi);
      check_lanes<8>(report, basis, nodes, xi);
    }

    // Stages that give less give the same bits.
    const auto all = given(p);
    std::vector<double> parts(record * count, 0.0), momentum(half_record * count, 0.0);
    const NodeRecords to = NodeRecords{parts.data()}.from(first + to_first);
    const auto payload = payload_of(p, std::integral_constant<unsigned, everything>{});
    scatter.template give<Mapping<Flip>, gives_mass | gives_momentum>(to, places, payload, room);
    scatter.template give<Mapping<Flip>, gives_forces>(to, places, payload, room);
    for (std::size_t i = 0; i < all.size(); ++i) CHECK_EQUAL(parts[i], all[i]);
    constexpr std::integral_constant<unsigned, gives_momentum> alone;
    scatter.template give<Mapping<Flip>, gives_momentum>(
        HalfRecords{momentum.data()}.from(first + to_first), places, payload_of(p, alone), room);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t a = 0; a < D; ++a)
        CHECK_EQUAL(momentum[half_record * i + a], all[record * i + velocity_at + a]);
  }
}

/// Four registers with a node in each lane become half a record for each node.
template <int W>
void check_transpose(mpm::testing::Report& report) {
  Batch<W> from[4];
  for (int f = 0; f < 4; ++f)
    for (int n = 0; n < W; ++n) from[f].v[n] = 10.0 * n + f;
  int calls = 0;
  transpose_to_nodes(from[0], from[1], from[2], from[3], [&](int n, Batch<4> q) {
    ++calls;
    for (int f = 0; f < 4; ++f) CHECK_EQUAL(q.v[f], 10.0 * n + f);
  });
  CHECK_EQUAL(calls, W);
}

}  // namespace

void test_basis(mpm::testing::Report& report) {
  Bases::for_each([&](BasisId id, const auto&) {
    for (const double edge : {0.25, 0.5, 1.0})
      Bases::with(id, edge, [&](const auto& basis) {
        const auto flat = BlockShape<2>::around(~std::uint64_t{0}, reach_of(id));
        const auto space = BlockShape<3>::around(~std::uint64_t{0}, reach_of(id));
        check_basis(report, flat, basis);
        check_basis(report, space, basis);
      });
  });
  check_transpose<2>(report);
  check_transpose<4>(report);
  check_transpose<8>(report);
  // A particle on a face, or a rounding beyond it, is held just inside the cell.
  CHECK_EQUAL(local_coordinate(3.0, 3.0), 1e-12);
  CHECK_EQUAL(local_coordinate(3.0 - 1e-15, 3.0), 1e-12);
  CHECK_EQUAL(local_coordinate(4.0, 3.0), 1.0 - 1e-12);
  CHECK_EQUAL(local_coordinate(3.25, 3.0), 0.25);
}
