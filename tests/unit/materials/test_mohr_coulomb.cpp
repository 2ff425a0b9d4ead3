// The return to Mohr and Coulomb's surface, from trial stresses in every region around it.
#include <random>

#include "check.hpp"
#include "mpm/materials/strength/mohr_coulomb.hpp"

namespace {

using namespace mpm;

constexpr double degree = std::numbers::pi / 180.0;

MohrCoulomb soil(double friction, double dilation, double tension, double cohesion) {
  MohrCoulomb m;
  m.E = 2e7;
  m.nu = 0.3;
  m.cohesion = cohesion;
  m.friction_angle = friction * degree;
  m.dilation_angle = dilation * degree;
  m.tension = tension;
  m.prepare(1800.0);
  return m;
}

struct Stresses {
  double s[3];
};

/// The largest of the yield functions [Pa].
double yield(const MohrCoulomb& m, const Stresses& at) {
  const Sorted<double> s(at.s);
  return max((m.k * s.value[0] - s.value[2] - m.strength) / m.k, s.value[0] - m.limit);
}

/// Trial stresses of 0.1 to 1000 times the cohesion scale in falling order, a third of them with
/// two alike: face, edges, corners.
std::vector<Stresses> trials(const MohrCoulomb& m, double scale) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<Stresses> all;
  for (int n = 0; n < 4000; ++n) {
    const double size = scale * std::pow(10.0, 1.0 + 2.0 * any(random));
    double s[3] = {size * any(random), size * any(random), size * any(random)};
    if (n % 3 == 1) s[1] = s[0];
    if (n % 7 == 1) s[1] = s[2] = s[0];
    const Sorted<double> sorted(s);
    Stresses trial{{sorted.value[0], sorted.value[1], sorted.value[2]}};
    if (yield(m, trial) > 0.0) all.push_back(trial);
  }
  return all;
}

/// The yield conditions hold, the order is kept, and the flow is as the dilation demands: of
/// principal plastic strains, what grows is m times what shrinks, and more where tension opens.
void check_return(mpm::testing::Report& report, const MohrCoulomb& m, double scale) {
  const bool associated = m.friction_angle == m.dilation_angle;
  const auto all = trials(m, scale);
  std::vector<Stresses> inside;
  for (const Stresses& trial : all) {
    Stresses after;
    m.return_to_surface(trial.s, after.s);
    const double size = scale + std::abs(trial.s[0]) + std::abs(trial.s[2]);
    const double near = 1e-13 * m.k * m.m * size;
    CHECK(yield(m, after) < min(1e-10 * scale, near) + near, yield(m, after), trial.s[0],
          trial.s[1], trial.s[2]);
    CHECK(after.s[1] <= after.s[0] + near && after.s[2] <= after.s[1] + near, after.s[0],
          after.s[1], after.s[2]);
    double e[3], grows = 0.0, shrinks = 0.0;
    m.plastic(trial.s, after.s, e);
    for (const double x : e) (x > 0.0 ? grows : shrinks) += x;
    const double opened = grows + m.m * shrinks;
    CHECK(opened >= -near, opened, trial.s[0], trial.s[1], trial.s[2]);
    if (after.s[0] < m.limit - near) CHECK_CLOSE(opened, 0.0, near);
    inside.push_back(after);
  }
  if (!associated) return;
  // Koiter: the exact return is the nearest admissible stress in the norm of elastic energy, so
  // that from it no admissible stress lies on the trial's side.
  for (std::size_t n = 0; n < all.size(); ++n) {
    double e[3];
    m.plastic(all[n].s, inside[n].s, e);
    for (std::size_t other = n % 17; other < inside.size(); other += 17) {
      double product = 0.0, trial = scale, admissible = scale;
      for (int i = 0; i < 3; ++i) {
        product += e[i] * (inside[other].s[i] - inside[n].s[i]);
        trial += std::abs(all[n].s[i]);
        admissible += std::abs(inside[other].s[i]) + std::abs(inside[n].s[i]);
      }
      CHECK(product <= 1e-13 * m.k * trial * admissible, product, trial, admissible);
    }
  }
}

/// Lanes of different regions in one register, in space and in the plane, against the scalar.
template <int D>
void check_lanes(mpm::testing::Report& report, const MohrCoulomb& m) {
  constexpr int W = native_lanes;
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int flowed = 0;
  for (int n = 0; n < 500; ++n) {
    StrainIncrement<Batch<W>, D> motion{};
    auto stress = Sym<Batch<W>, D>::zero();
    PlasticState<Batch<W>, D> state{Batch<W>(0.0)};
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        for (int l = 0; l < W; ++l) motion.gradient[i][j].v[l] = 1e-3 * any(random);
    for (auto& c : stress.c)
      for (int l = 0; l < W; ++l) c.v[l] = 2e4 * any(random);
    const Sym<Batch<W>, D> start = stress;
    const Batch<W> work = m.update(motion, stress, state);
    for (int l = 0; l < W; ++l) {
      StrainIncrement<double, D> one{};
      Sym<double, D> s;
      PlasticState<double, D> p{0.0};
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < D; ++j) one.gradient[i][j] = motion.gradient[i][j][l];
      for (int c = 0; c < Sym<double, D>::size; ++c) s.c[c] = start.c[c][l];
      const double w = m.update(one, s, p);
      for (int c = 0; c < Sym<double, D>::size; ++c)
        CHECK_CLOSE(stress.c[c][l], s.c[c], 1e-12 * 5e4);
      CHECK_CLOSE(state.plastic_strain[l], p.plastic_strain, 1e-15);
      CHECK_CLOSE(work[l], w, 1e-12 * 50.0);
      CHECK(w >= -1e-12, w);
      const auto e = eigen(s);
      CHECK(yield(m, {{e.value[0], e.value[1], e.value[2]}}) < 1e-12 * 1e5, w);
      flowed += p.plastic_strain > 0.0;
      // A zero gradient leaves a stress on the surface as it is.
      const auto before = s;
      const auto strain = p.plastic_strain;
      m.update(StrainIncrement<double, D>{}, s, p);
      for (int c = 0; c < Sym<double, D>::size; ++c) CHECK_EQUAL(s.c[c], before.c[c]);
      CHECK_EQUAL(p.plastic_strain, strain);
    }
  }
  CHECK(flowed > 100 * W, flowed);
}

}  // namespace

void test_mohr_coulomb(mpm::testing::Report& report) {
  for (const double friction : {0.0, 5.0, 30.0, 45.0})
    for (const double dilation : {0.0, 5.0, 30.0, 45.0})
      for (const double tension : {0.0, 3e3, 1e9}) {
        if (dilation <= friction) check_return(report, soil(friction, dilation, tension, 1e4), 1e4);
        if (dilation <= friction) check_return(report, soil(friction, dilation, tension, 0.0), 1e4);
      }
  for (const double tension : {0.0, 5e3, 1e9}) {
    check_lanes<2>(report, soil(30.0, 10.0, tension, 1e4));
    check_lanes<3>(report, soil(30.0, 10.0, tension, 1e4));
  }
}
