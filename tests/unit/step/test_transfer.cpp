// What particles give to nodes and take from them, against the formulas written out, in one lane
// and in several; and what follows from them.
#include <array>
#include <cmath>
#include <random>
#include <type_traits>

#include "check.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace {

using namespace mpm;

/// As a schedule hands them to a transfer, with its own product of a tensor and a vector.
template <class T, int D>
struct Traction {
  Sym<T, D> t;
  friend Vec<T, D> operator*(const Traction& traction, const Vec<T, D>& x) {
    Vec<T, D> r;
    for (int a = 0; a < D; ++a) {
      r[a] = traction.t(a, 0) * x[0];
      for (int b = 1; b < D; ++b) r[a] += traction.t(a, b) * x[b];
    }
    return r;
  }
};
template <class T, int D>
struct Giver {
  T m;
  Vec<T, D> v;
  Traction<T, D> traction;
};
template <class T, int D>
struct Taker {
  T m{0.0};
  Vec<T, D> p = Vec<T, D>::zero(), f = Vec<T, D>::zero();
};

double any(std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(-1.0, 1.0)(random);
}

/// m_i = sum m_p N_ip, p_i = sum m_p N_ip v_p, f_i = sum t_p . grad N_ip.
template <class Transfer, int D>
void check_give(mpm::testing::Report& report) {
  constexpr int W = 4;
  using T = Batch<W>;
  std::mt19937_64 random(1);
  Taker<double, D> one[W], expected[W];
  Taker<T, D> lanes;
  for (int k = 0; k < 10; ++k) {
    Giver<T, D> particles;
    T N_ip;
    Vec<T, D> grad;
    for (int lane = 0; lane < W; ++lane) {
      Giver<double, D> p;
      Vec<double, D> dN;
      p.m = particles.m.v[lane] = 1.0 + any(random);
      const double N = N_ip.v[lane] = 0.5 + 0.5 * any(random);
      for (int a = 0; a < D; ++a) {
        p.v[a] = particles.v[a].v[lane] = any(random);
        dN[a] = grad[a].v[lane] = any(random);
      }
      for (int c = 0; c < Sym<double, D>::size; ++c)
        p.traction.t.c[c] = particles.traction.t.c[c].v[lane] = any(random);
      Mapping<Transfer>::give_momentum(p, N, one[lane]);
      Mapping<Transfer>::give_force(p, dN, one[lane]);
      expected[lane].m += p.m * N;
      for (int a = 0; a < D; ++a) {
        expected[lane].p[a] += p.m * N * p.v[a];
        for (int c = 0; c < D; ++c) expected[lane].f[a] += p.traction.t(a, c) * dN[c];
      }
    }
    Mapping<Transfer>::give_momentum(particles, N_ip, lanes);
    Mapping<Transfer>::give_force(particles, grad, lanes);
  }
  constexpr double rounding = 1e-14;  // of 30 products below 2, added
  for (int lane = 0; lane < W; ++lane) {
    CHECK_CLOSE(one[lane].m, expected[lane].m, rounding);
    CHECK_CLOSE(lanes.m[lane], expected[lane].m, rounding);
    for (int a = 0; a < D; ++a) {
      CHECK_CLOSE(one[lane].p[a], expected[lane].p[a], rounding);
      CHECK_CLOSE(lanes.p[a][lane], expected[lane].p[a], rounding);
      CHECK_CLOSE(one[lane].f[a], expected[lane].f[a], rounding);
      CHECK_CLOSE(lanes.f[a][lane], expected[lane].f[a], rounding);
    }
  }
}

/// v_p + dv, of which a share gives way to the velocity of the grid.
void check_take(mpm::testing::Report& report) {
  std::mt19937_64 random(2);
  constexpr double rounding = 1e-15;  // of a few numbers below 2
  for (int k = 0; k < 100; ++k) {
    const double v = any(random), dv = any(random), grid = any(random);
    CHECK_EQUAL(Flip().take(v, dv), v + dv);
    CHECK_CLOSE(FlipPic(0.0).take(v, dv, grid), v + dv, rounding);
    CHECK_EQUAL(taken_by(Pic()).take(v, dv, grid), Pic().take(v, dv, grid));
    CHECK_EQUAL(taken_by(Apic()).take(v, dv, grid), Apic().take(v, dv, grid));
    const double share = 0.5 + 0.5 * any(random);
    const double taken = FlipPic(share).take(v, dv, grid);
    CHECK_CLOSE(taken, (1.0 - share) * (v + dv) + share * grid, 2.0 * rounding);
    // Who moves as the grid does, goes on so.
    CHECK_EQUAL(FlipPic(share).take(v, dv, v + dv), v + dv);
    using T = Batch<4>;
    CHECK_EQUAL(FlipPic(share).take(T(v), T(dv), T(grid))[3], taken);
    CHECK_EQUAL(Flip().take(T(v), T(dv))[3], v + dv);
  }
}

/// Particles of one place, of which the grid sees the mean: their momentum stays, and of their
/// motion against each other the square of 1 - share is left of the energy.
void check_damping(mpm::testing::Report& report) {
  std::mt19937_64 random(3);
  constexpr int particles = 8;
  double v[particles], mean = 0.0, before = 0.0, after = 0.0, momentum = 0.0;
  for (double& each : v) mean += (each = any(random)) / particles;
  const FlipPic transfer(0.3);
  for (const double each : v) {
    const double taken = transfer.take(each, 0.0, mean);
    momentum += taken / particles;
    before += (each - mean) * (each - mean);
    after += (taken - mean) * (taken - mean);
  }
  CHECK_CLOSE(momentum, mean, 1e-15);
  CHECK_CLOSE(after, 0.7 * 0.7 * before, 1e-14);
}

/// Of the run: a share is the rate of damping times the step, one at most, and FLIP without.
template <int D>
void check_choice(mpm::testing::Report& report) {
  Domain<D> domain;
  domain.time_step = 0.01;
  for (const double damping : {0.0, 30.0, 1e4}) {
    domain.pic_rate = damping;
    int called = 0;
    with_transfer(domain, any_share(domain), [&]<class Transfer>(const Transfer& transfer) {
      ++called;
      if constexpr (std::is_same_v<Transfer, FlipPic>)
        CHECK_CLOSE(transfer.pic, damping == 30.0 ? 0.3 : 1.0, 1e-15);
      else
        CHECK(damping == 0.0, damping);
    });
    CHECK_EQUAL(called, 1);
  }
}

/// C' is the symmetric part of C F^-1 and the antisymmetric one of C, to the third order in the
/// step; debris beyond keeps its C.
void check_carried(mpm::testing::Report& report) {
  const auto carried = [](const Mat<double, 2>& C, double dt) {
    return carried_along(C, dt, Closing::as_it_would);
  };
  const Mat<double, 2> C{{{3.0, -5.0}, {4.0, 2.0}}};
  double before = 0.0;
  for (const double dt : {1e-2, 5e-3}) {
    const Mat<double, 2> now = carried(C, dt);
    CHECK_CLOSE(now[0][1] - now[1][0], C[0][1] - C[1][0], 1e-15);
    const double a = 1.0 + dt * C[0][0], b = dt * C[0][1], c = dt * C[1][0], d = 1.0 + dt * C[1][1];
    const double exact = (C[0][0] * d - C[0][1] * c) / (a * d - b * c);  // of C F^-1
    const double error = std::abs(now[0][0] - exact);
    if (before > 0.0) CHECK(error < 0.3 * before, error, before);
    before = error;
  }
  const double rate = 1.1 / 1e-2;
  for (const double sign : {-1.0, 1.0}) {
    const Mat<double, 2> wild{{{sign * rate, 0.0}, {0.0, sign * rate}}};
    CHECK_EQUAL(carried(wild, 1e-2)[0][0], wild[0][0]);
  }
  const Mat<double, 2> fast{{{-0.5 * rate, 0.0}, {0.0, -0.5 * rate}}};
  CHECK(carried(fast, 1e-2)[0][0] > 1.6 * fast[0][0]);  // no more than that again
  CHECK_CLOSE(carried_along(fast, 1e-2, Closing::no_faster)[0][0], fast[0][0], 1e-12 * rate);
}

/// Debris that is flattened keeps its rate and makes no energy; what is merely sheared feels
/// nothing; what closes slowly is carried along as what opens.
void check_closing(mpm::testing::Report& report) {
  const double dt = 1e-2;
  const auto carried = [&](const auto& C) { return carried_along(C, dt, Closing::no_faster); };
  const Mat<double, 3> flattened{{{-2.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  Mat<double, 3> C = flattened;
  const auto energy = [](const Mat<double, 3>& of) {
    double sum = 0.0;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) sum += of[a][b] * of[a][b];
    return sum;
  };
  for (int step = 0; step < 200; ++step) {  // without the rule it would be infinite at the 100th
    C = carried(C);
    // Pressure keeps the volume.
    const double rate = (C[0][0] + C[1][1] + C[2][2]) / 3.0;
    for (int a = 0; a < 3; ++a) C[a][a] -= rate;
  }
  CHECK_CLOSE(energy(C), energy(flattened), 1e-12 * energy(flattened));

  const Mat<double, 3> opening{{{3.0, 1.0, 0.0}, {1.0, -1.0, 0.5}, {0.0, 0.5, 1.0}}};
  Mat<double, 3> closing = opening;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) closing[a][b] = -opening[a][b];
  CHECK(energy(carried(opening)) < 0.97 * energy(opening));
  // But for the square of the change: (dt |S S|)^2, |S S| < |S|^2.
  CHECK(energy(carried(closing)) - energy(closing) < std::pow(dt * energy(closing), 2));

  const Mat<double, 2> sheared{{{0.0, 7.0}, {0.0, 0.0}}};  // C C = 0
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) CHECK_CLOSE(carried(sheared)[a][b], sheared[a][b], 1e-15);
  CHECK_EQUAL(energy(carried(Mat<double, 3>{})), 0.0);

  const double slow = std::sqrt(0.9 * closing_from) / dt;  // x = dt slow
  for (const Closing closes : {Closing::no_faster, Closing::as_it_would}) {
    const Mat<double, 2> both{{{-slow, 0.0}, {0.0, -slow}}};
    CHECK_CLOSE(carried_along(both, dt, closes)[0][0], -slow - dt * slow * slow, 1e-6 * slow);
  }
}

/// Lanes that close and lanes that do not, side by side, are carried along as each alone is.
void check_lanes_carried(mpm::testing::Report& report) {
  constexpr int W = 4, D = 3;
  const double dt = 1e-2;
  std::mt19937_64 random(7);
  for (int n = 0; n < 200; ++n) {
    Mat<Batch<W>, D> all;
    std::array<Mat<double, D>, W> each;
    for (std::size_t lane = 0; lane < W; ++lane)
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b)
          each[lane][a][b] = all[a][b].v[lane] = (lane % 2 == 0 ? 0.2 : 20.0) * any(random);
    const Mat<Batch<W>, D> now = carried_along(all, Batch<W>(dt), Closing::no_faster);
    for (std::size_t lane = 0; lane < W; ++lane) {
      const Mat<double, D> alone = carried_along(each[lane], dt, Closing::no_faster);
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) CHECK_CLOSE(now[a][b].v[lane], alone[a][b], 1e-13);
    }
  }
}

/// A pool of each matter.
void add_pools(Domain<2>& domain, std::initializer_list<Matter> pools) {
  domain.grid.cell_size = 2.0;
  domain.time_step = 0.25;
  domain.flip_share = 0.97;
  domain.flip_share_of_gases = 0.7;
  for (const Matter matter : pools) {
    domain.pools.emplace_back().matter = matter;
    domain.pools.back().fastest = 3.0;
  }
}

/// Gases and explosives have their share, others that of solids; where bodies are bonded gases have
/// theirs if there is nothing else.
void check_shares(mpm::testing::Report& report) {
  constexpr auto solid = Matter::solid, liquid = Matter::liquid, gas = Matter::gas;
  Domain<2> mixed, gases;
  add_pools(mixed, {solid, gas, liquid});
  add_pools(gases, {gas, gas});
  const auto share = [&](const Domain<2>& domain, std::size_t k) {
    return share_of(domain, domain.pools[k]);
  };
  CHECK_CLOSE(share(mixed, 0).flip, 0.97, 0.0);
  CHECK_CLOSE(share(mixed, 1).flip, 0.7, 0.0);
  CHECK_CLOSE(share(mixed, 2).flip, 0.97, 0.0);
  CHECK_CLOSE(share(mixed, 1).own, 0.75, 1e-15);  // 3 m/s for 0.25 s, over half a cell
  mixed.grid.bonded = true;
  for (std::size_t k = 0; k < 3; ++k) CHECK_CLOSE(share(mixed, k).flip, 0.97, 0.0);
  for (const bool bonded : {false, true}) {
    gases.grid.bonded = bonded;
    for (std::size_t k = 0; k < 2; ++k) CHECK_CLOSE(share(gases, k).flip, 0.7, 0.0);
  }
}

}  // namespace

void test_transfer(mpm::testing::Report& report) {
  check_give<Flip, 2>(report);
  check_give<Flip, 3>(report);
  check_give<FlipPic, 3>(report);
  check_take(report);
  check_damping(report);
  check_choice<2>(report);
  check_choice<3>(report);
  check_carried(report);
  check_closing(report);
  check_lanes_carried(report);
  check_shares(report);
}
