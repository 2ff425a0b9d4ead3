// The plane that separates two sets of particles, and how far a set extends.
#include <algorithm>
#include <cmath>
#include <random>

#include "check.hpp"
#include "mpm/contact/separation.hpp"

namespace {

using namespace mpm;
constexpr std::size_t most = 1000;  // particles of a body
constexpr double pi = 3.14159265358979323846;

template <int D>
void add(NearParticles<D>& to, const Vec<double, D>& x, double mass = 1.0) {
  using T = typename NearParticles<D>::T;
  Vec<T, D> lanes;
  for (int a = 0; a < D; ++a) lanes[a] = T(x[a]);
  if (to.count() == 0) to.clear(most);
  to.add(lanes, T(0.25), select(first_lanes<T::lanes>(1), T(mass), T(0.0)));
  to.finish();
}

template <int D>
Vec<double, D> separate(const NearParticles<D>& r, const NearParticles<D>& s,
                        unsigned constrained = 0) {
  return separating_normal(r, s, constrained);
}

/// Two particles: the normal is the line between them, whatever their masses.
template <int D>
void check_two_particles(mpm::testing::Report& report, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-1.0, 1.0), mass(0.1, 10.0);
  for (int k = 0; k < 50; ++k) {
    NearParticles<D> r, s;
    Vec<double, D> x, y;
    for (int a = 0; a < D; ++a) {
      x[a] = any(random);
      y[a] = any(random);
    }
    add<D>(r, x, mass(random));
    add<D>(s, y, mass(random));
    const double off = norm(separate<D>(r, s) - normalised(y - x));
    CHECK(off < 1e-9, off, D);
    const auto forth = separate<D>(r, s), back = separate<D>(s, r);
    CHECK(norm(forth + back) < 1e-12, forth[0], back[0]);
  }
}

/// How far a plane is from the least of the function that it is to minimise: the largest derivative
/// there, summed plainly.
template <int D>
double steepness(const NearParticles<D>& r, const NearParticles<D>& s, const Plane<D>& plane) {
  using T = typename NearParticles<D>::T;
  double slope[D + 1];  // at first of the softness, and of what keeps b in its bounds
  for (int a = 0; a < D; ++a) slope[a] = 4e-3 * plane.a[a];
  slope[D] = 1e-12 * plane.b;
  const auto add_body = [&](const NearParticles<D>& body, double sign) {
    body.for_each([&](const Vec<T, D>& x, T, T weight) {
      for (int k = 0; k < T::lanes; ++k) {
        double height = plane.b;
        for (int a = 0; a < D; ++a) height += plane.a[a] * x[a][k];
        const double lack = std::max(0.0, 1.0 - sign * height);
        for (int a = 0; a <= D; ++a)
          slope[a] -= sign * lack * weight[k] / body.mass() * (a < D ? x[a][k] : 1.0);
      }
    });
  };
  add_body(r, -1.0);
  add_body(s, 1.0);
  double most = 0.0;
  for (const double one : slope) most = std::max(most, std::abs(one));
  return most / std::max(1.0, norm(plane.a));  // of terms that are as large as that
}

/// The function is convex: a plane at which all derivatives are zero is the one that is meant,
/// wherever the search began. Clouds beside and within each other, of 1 to 40 particles.
template <int D>
void check_least(mpm::testing::Report& report, std::mt19937_64& random, int fits) {
  std::uniform_real_distribution<double> any(-0.75, 0.75), mass(0.1, 10.0);
  double worst = 0.0, off = 0.0;
  for (int k = 0; k < fits; ++k) {
    std::vector<std::pair<Vec<double, D>, double>> clouds[2];
    Vec<double, D> shift[2];
    for (int body = 0; body < 2; ++body) {
      for (int a = 0; a < D; ++a) shift[body][a] = any(random);
      for (std::size_t count = 1 + random() % 40; count > 0; --count) {
        Vec<double, D> x = shift[body];
        for (int a = 0; a < D; ++a) x[a] += any(random);
        clouds[body].emplace_back(x, mass(random));
      }
    }
    const auto fit = [&](int first, double sign) {
      NearParticles<D> bodies[2];
      for (int body = 0; body < 2; ++body)
        for (const auto& [x, m] : clouds[(body + first) % 2]) add<D>(bodies[body], sign * x, m);
      const Plane<D> plane = separating_plane<D>(bodies[0], bodies[1], 0u);
      worst = std::max(worst, steepness<D>(bodies[0], bodies[1], plane));
      return plane;
    };
    const Plane<D> plane = fit(0, 1.0), mirrored = fit(0, -1.0);
    for (auto& cloud : clouds) std::ranges::shuffle(cloud, random);
    const Plane<D> renumbered = fit(1, 1.0);
    off = std::max({off, norm(plane.a + mirrored.a), norm(plane.a + renumbered.a),
                    std::abs(plane.b - mirrored.b), std::abs(plane.b + renumbered.b)});
  }
  CHECK(worst < 1e-13, worst, D);  // sums of 80 numbers of the size of one, each rounded to 1e-16
  CHECK(off < 1e-10, off, D);      // that over the softness, 4e-3, and planes of the size of ten
}

/// A block's lower edge on a floor, its corner `corner` from the node; turned by `angle`.
Vec<double, 2> corner_normal(double corner, double angle) {
  NearParticles<2> block, floor;
  const double c = std::cos(angle), s = std::sin(angle);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 2; ++j) {
      const double x = -1.0 + 0.5 * i, y = 0.25 + 0.5 * j;
      add<2>(floor, {c * x + s * y, s * x - c * y});
      if (x < corner) add<2>(block, {c * x - s * y, s * x + c * y});
    }
  return separate<2>(floor, block);
}

/// Lanes with and without weight, packed: all that have one are there, in their order, and once.
template <int D>
void check_packing(mpm::testing::Report& report, std::mt19937_64& random) {
  using T = typename NearParticles<D>::T;
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  NearParticles<D> near;
  for (int turn = 0; turn < 20; ++turn) {
    const int groups = turn % 7;  // fewer and more than before
    near.clear(static_cast<std::size_t>(groups * T::lanes));
    std::vector<Vec<double, D>> places;
    double mass = 0.0;
    Vec<double, D> moment = Vec<double, D>::zero();
    for (int g = 0; g < groups; ++g) {
      Vec<T, D> x;
      T weight(0.0);
      for (int k = 0; k < T::lanes; ++k) {
        Vec<double, D> place;
        for (int a = 0; a < D; ++a) x[a].v[k] = place[a] = any(random);
        if (turn > 0 && random() % 3 == 0) continue;  // at first all lanes are full
        weight.v[k] = 1.5 + any(random);
        places.push_back(place);
        mass += weight[k];
        moment += weight[k] * place;
      }
      near.add(x, T(0.25), weight);
    }
    near.finish();
    CHECK_EQUAL(near.count(), places.size());
    CHECK_CLOSE(near.mass(), mass, 1e-14 * mass);
    if (mass > 0.0) CHECK(norm(near.centre() - (1.0 / mass) * moment) < 1e-14, turn);
    std::size_t next = 0;
    near.for_each([&](const Vec<T, D>& x, T half, T weight) {
      for (int k = 0; k < T::lanes; ++k) {
        const bool there = next < places.size();
        CHECK_EQUAL(weight[k] > 0.0, there);
        CHECK_EQUAL(half[k], there ? 0.25 : -std::numeric_limits<double>::infinity());
        for (int a = 0; there && a < D; ++a) CHECK_EQUAL(x[a][k], places[next][a]);
        next += there;
      }
    });
    CHECK_EQUAL(next, places.size());
  }
}

}  // namespace

void test_separation(mpm::testing::Report& report) {
  std::mt19937_64 random(20200915);
  check_two_particles<2>(report, random);
  check_two_particles<3>(report, random);
  check_least<2>(report, random, 20000);
  check_least<3>(report, random, 20000);
  check_packing<2>(report, random);
  check_packing<3>(report, random);

  // At a corner the mean of the gradients of mass is tens of degrees off. The plane is one or
  // two off, and, being soft, seven where only the block's last column is in reach.
  for (const double corner : {-0.75, -0.25, 0.25, 0.75, 1.25}) {
    const auto n = corner_normal(corner, 0.0);
    const double limit = (corner < -0.5 ? 7.0 : 2.0) * pi / 180.0;
    CHECK(std::abs(n[0]) < limit && n[1] > 0.0, corner, n[0], n[1]);
    // The plane turns with the particles.
    const auto turned = corner_normal(corner, 0.7);
    const double c = std::cos(0.7), s = std::sin(0.7);
    const Vec<double, 2> expected{c * n[0] - s * n[1], s * n[0] + c * n[1]};
    CHECK(norm(turned - expected) < 1e-10, corner, turned[0], expected[0]);
  }

  // A wall that mirrors the bodies leaves no component along its normal.
  NearParticles<3> r, s;
  add<3>(r, {0.3, -0.2, 0.1});
  add<3>(r, {-0.3, -0.4, 0.5});
  add<3>(s, {0.9, 0.3, 0.2});
  const auto n = separate<3>(r, s, 0b001u);
  CHECK(n[0] == 0.0 && std::abs(norm(n) - 1.0) < 1e-14, n[0], n[1], n[2]);

  // Two lattices in the same place, one between the points of the other, have no plane; nor has a
  // body without particles.
  NearParticles<2> lattice, between, nothing;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) {
      add<2>(lattice, {0.5 * i, 0.5 * j});
      if (i < 2 && j < 2) add<2>(between, {0.5 * i + 0.25, 0.5 * j + 0.25});
    }
  CHECK(norm(separate<2>(lattice, between)) == 0.0, separate<2>(lattice, between)[0]);
  CHECK(norm(separate<2>(lattice, nothing)) == 0.0, lattice.count());

  // Within a cell of the line through the node the body is lower than its highest point beside it;
  // a line that misses the body sees all of it.
  NearParticles<2> disc;
  add<2>(disc, {0.3, 0.1});
  add<2>(disc, {1.2, 1.1});
  CHECK_CLOSE(disc.extent_along({0.0, 1.0}), 0.1 + 0.25, 1e-15);
  CHECK_CLOSE(disc.extent_along({-1.0, 0.0}), -0.3 + 0.25, 1e-15);
  NearParticles<2> beside;
  add<2>(beside, {1.1, -0.4});
  CHECK_CLOSE(beside.extent_along({0.0, 1.0}), -0.4 + 0.25, 1e-15);
}
