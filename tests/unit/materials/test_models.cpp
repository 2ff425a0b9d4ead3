// Every model of the catalogue: its lanes agree with the scalar instance, and nothing happens when
// nothing moves.
#include <array>
#include <random>

#include "check.hpp"
#include "example.hpp"
#include "mpm/materials/catalogue.hpp"

namespace {

using namespace mpm;
using mpm::testing::eps;
using mpm::testing::example, mpm::testing::hard, mpm::testing::soft;

constexpr double modulus = 1e8;
constexpr int steps = 40;

/// One material point, or W of them.
template <class Model, class T, int D>
struct Point {
  Sym<T, D> stress = Sym<T, D>::zero();
  typename Model::template State<T, D> state;
  T J = T(1.0);

  explicit Point(const Model& model) : state(model.template start<T, D>()) {}
  [[gnu::noinline]] void move(const Model& model, const Mat<T, D>& gradient) {
    StrainIncrement<T, D> motion;
    motion.gradient = gradient;
    Mat<T, D> f = gradient;
    for (int i = 0; i < D; ++i) f[i][i] = f[i][i] + T(1.0);
    J = J * determinant(f);
    motion.J = J;
    motion.time_step = motion.time = 1e-3;
    motion.cell_size = 1.0;
    model.update(motion, stress, state);
  }
  T speed(const Model& model) const {
    if constexpr (Model::eos == EosUse::must)
      return mpm::sqrt(model.other_speed_squared(state, J));
    else
      return model.sound_speed(stress, state, J);
  }
};

/// Some four roundings a step of stresses as large as the modulus, which may be contracted
/// otherwise; iterations end at 1e-13 of the stress. The steps of the soft model are of all sizes
/// from 1e-5 to 0.05, yield at some 1e-3, so that in many steps some lanes flow and some do not.
/// Returns in how many.
template <class Model, int D>
int check_lanes(mpm::testing::Report& report, double yield, std::mt19937_64& random) {
  constexpr int W = native_lanes;
  const Model model = example<Model>(yield);
  std::uniform_real_distribution<double> any(-0.05, 0.05), decades(-3.7, 0.0);
  Point<Model, Batch<W>, D> lanes(model);
  std::vector<Point<Model, double, D>> scalar(W, Point<Model, double, D>(model));
  const double near = 4 * steps * (eps + 1e-13);
  int mixed = 0;
  for (int step = 0; step < steps; ++step) {
    Mat<Batch<W>, D> gradient;
    std::array<Mat<double, D>, W> each;
    for (int k = 0; k < W; ++k) {
      const double size = yield < modulus ? std::pow(10.0, decades(random)) : 1.0;
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < D; ++j)
          gradient[i][j].v[k] = each[static_cast<std::size_t>(k)][i][j] = size * any(random);
    }
    const auto before = lanes.state;
    lanes.move(model, gradient);
    int flowing = 0;
    if constexpr (requires { before.plastic_strain; })
      for (int k = 0; k < W; ++k)
        flowing += lanes.state.plastic_strain[k] > before.plastic_strain[k] + 1e-9;
    mixed += flowing > 0 && flowing < W;
    const Batch<W> c = lanes.speed(model);
    for (int k = 0; k < W; ++k) {
      auto& one = scalar[static_cast<std::size_t>(k)];
      one.move(model, each[static_cast<std::size_t>(k)]);
      for (int i = 0; i < Sym<double, D>::size; ++i)
        CHECK_CLOSE(lanes.stress.c[i][k], one.stress.c[i], near * modulus);
      const double speed = one.speed(model);
      CHECK(speed >= 0.0, speed);
      CHECK_CLOSE(c[k], speed, near * speed);
    }
  }
  // A zero gradient leaves stress and state as they are, where nothing depends on rates or time.
  if constexpr (Model::eos != EosUse::must && !requires { model.law; }) {
    auto& point = scalar[0];
    const auto before = point;
    point.move(model, Mat<double, D>{});
    for (int i = 0; i < Sym<double, D>::size; ++i)
      CHECK_CLOSE(point.stress.c[i], before.stress.c[i], 8 * eps * modulus);
    // A stress that has flowed lies on the yield surface but for rounding.
    constexpr int size = state_size<decltype(point.state), double>;
    double after[size + 1], old[size + 1];
    pack(point.state, after);
    pack(before.state, old);
    for (int k = 0; k < size; ++k)
      CHECK_CLOSE(after[k], old[k], yield == soft ? 8 * eps * std::abs(old[k]) : 0.0);
  }
  return mixed;
}

/// Eight points whatever the lanes: of two alone one may be pressed so that it never flows again.
template <class Model, int D>
void check_eight_points(mpm::testing::Report& report, double yield) {
  std::mt19937_64 random(9);
  int mixed = 0;
  for (int point = 0; point < 8; point += native_lanes)
    mixed += check_lanes<Model, D>(report, yield, random);
  using State = typename Model::template State<double, D>;
  if constexpr (requires(State state) { state.plastic_strain; })
    CHECK(yield == soft ? mixed > steps / 4 : mixed == 0, Model::name, yield, mixed);
}

/// What a lane does not ask what its neighbours hold: it gives the bits that it gives among its
/// likes.
template <class Model>
void check_neighbours(mpm::testing::Report& report) {
  constexpr int W = native_lanes, D = 3;
  using Lanes = Point<Model, Batch<W>, D>;
  const Model model = example<Model>(soft);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> any(-0.05, 0.05), decades(-6.0, 0.0);
  Lanes mixed(model);
  std::vector<Lanes> alike(W, mixed);
  for (int step = 0; step < 60; ++step) {
    Mat<Batch<W>, D> gradient;
    std::array<Mat<Batch<W>, D>, W> each;
    for (int k = 0; k < W; ++k) {
      const double size = std::pow(10.0, decades(random));
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < D; ++j)
          each[static_cast<std::size_t>(k)][i][j] =
              Batch<W>(gradient[i][j].v[k] = size * any(random));
    }
    mixed.move(model, gradient);
    for (int k = 0; k < W; ++k) {
      auto& one = alike[static_cast<std::size_t>(k)];
      one.move(model, each[static_cast<std::size_t>(k)]);
      for (int i = 0; i < Sym<double, D>::size; ++i)
        CHECK(mixed.stress.c[i][k] == one.stress.c[i][k], Model::name, step, k);
      CHECK(mixed.J[k] == one.J[k], Model::name, step, k);
    }
  }
}

/// Lanes against the scalar, and the derivatives against central differences.
template <class Model>
void check_eos(mpm::testing::Report& report) {
  constexpr int W = native_lanes;
  const Model model = example<Model>();
  const auto pressure = [&](double V, double energy) {
    return line_of(model, V, energy).pressure(energy);
  };
  for (const double V : {0.75, 0.9, 0.99, 1.01, 1.19, 1.21, 3.0})
    for (const double energy : {0.5 * modulus, 2.0 * modulus, 4.0 * modulus}) {
      const LinearInEnergy<double> one = line_of(model, V, energy);
      const LinearInEnergy<Batch<W>> all = line_of(model, Batch<W>(V), Batch<W>(energy));
      const double near = 64 * eps * modulus;
      CHECK_CLOSE(all.A[0], one.A, near);
      CHECK_CLOSE(all.B[0], one.B, 64 * eps * (1.0 + std::abs(one.B)));
      CHECK_CLOSE(all.dA[0], one.dA, 64 * eps * (modulus + std::abs(one.dA)));
      CHECK_CLOSE(all.dB[0], one.dB, 64 * eps * (1.0 + std::abs(one.dB)));
      const double h = 1e-5;
      const double by_volume = (pressure(V + h, energy) - pressure(V - h, energy)) / (2 * h);
      const double slope = one.dA + one.dB * energy;
      CHECK_CLOSE(by_volume, slope,
                  1e-7 * (std::abs(one.dA) + std::abs(one.dB) * energy + modulus));
      const double H = h * modulus;
      const double by_energy = (pressure(V, energy + H) - pressure(V, energy - H)) / (2 * H);
      CHECK_CLOSE(by_energy, one.B, 1e-7 * (1.0 + std::abs(one.B)));
    }
}

}  // namespace

void test_models(mpm::testing::Report& report) {
  int count = 0;
  StrengthModels::for_each([&]<class Model>(const Model&) {
    for (const double yield : {hard, soft}) {
      check_eight_points<Model, 2>(report, yield);
      check_eight_points<Model, 3>(report, yield);
    }
    check_neighbours<Model>(report);
    ++count;
  });
  EosModels::for_each([&]<class Model>(const Model&) {
    check_eos<Model>(report);
    ++count;
  });
  CHECK(count >= 17, count);
}
