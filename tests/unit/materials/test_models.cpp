// Every model of the catalogue: its lanes agree with the scalar instance, and nothing happens when
// nothing moves.
#include <array>
#include <cstring>
#include <random>

#include "check.hpp"
#include "mpm/materials/catalogue.hpp"

namespace {

using namespace mpm;

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A model with sensible parameters: moduli of 1e8, ratios of 0.3, the rest one.
template <class Model>
Model example() {
  Model model;
  for (const auto& p : Model::params)
    model.*p.member = p.unit == "Pa" ? 1e8 : (p.rule == Rule::poisson_ratio ? 0.3 : 1.0);
  model.prepare(1000.0);
  return model;
}

/// One material point, and W of them, moved by the same gradients; `compare(lane, scalar, lanes)`
/// after each step.
template <class Model, class T, int D>
struct Point {
  Sym<T, D> stress = Sym<T, D>::zero();
  typename Model::template State<T, D> state;
  T J = T(1.0);

  Point() {
    T* flat = reinterpret_cast<T*>(&state);
    for (const StateColumn& s : Model::state_columns)
      for (int k = 0; k < s.components(D); ++k)
        *flat++ = T(s.start == Start::one || (s.start == Start::identity && k < 3) ? 1.0 : 0.0);
  }
  void move(const Model& model, const Mat<T, D>& gradient) {
    Motion<T, D> motion;
    motion.gradient = gradient;
    Mat<T, D> f = gradient;
    for (int i = 0; i < D; ++i) f[i][i] = f[i][i] + T(1.0);
    motion.volume_ratio = determinant(f);
    J = J * motion.volume_ratio;
    motion.J = J;
    model.update(motion, stress, state);
  }
};

template <class Model, int D>
void check_lanes(mpm::testing::Report& report) {
  constexpr int W = native_lanes;
  const Model model = example<Model>();
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> any(-0.05, 0.05);
  Point<Model, Batch<W>, D> lanes;
  std::array<Point<Model, double, D>, W> scalar;
  constexpr int steps = 40;
  for (int step = 0; step < steps; ++step) {
    Mat<Batch<W>, D> gradient;
    std::array<Mat<double, D>, W> each;
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        for (int k = 0; k < W; ++k)
          gradient[i][j].v[k] = each[static_cast<std::size_t>(k)][i][j] = any(random);
    lanes.move(model, gradient);
    const Batch<W> c = model.sound_speed(lanes.stress, lanes.state, lanes.J);
    for (int k = 0; k < W; ++k) {
      auto& one = scalar[static_cast<std::size_t>(k)];
      one.move(model, each[static_cast<std::size_t>(k)]);
      // Some four roundings a step of stresses as large as the modulus, which may be contracted
      // otherwise.
      for (int i = 0; i < Sym<double, D>::size; ++i)
        CHECK_CLOSE(lanes.stress.c[i][k], one.stress.c[i], 4 * steps * eps * 1e8);
      const double speed = model.sound_speed(one.stress, one.state, one.J);
      CHECK(speed > 0.0, speed);
      CHECK_CLOSE(c[k], speed, 4 * steps * eps * speed);
    }
  }
  // A zero gradient leaves stress and state as they are: the first time step relies on it.
  auto& point = scalar[0];
  const auto before = point;
  point.move(model, Mat<double, D>{});
  for (int i = 0; i < Sym<double, D>::size; ++i)
    CHECK_CLOSE(point.stress.c[i], before.stress.c[i], 8 * eps * 1e8);
  if constexpr (!Model::state_columns.empty())
    CHECK(std::memcmp(&point.state, &before.state, sizeof(point.state)) == 0, Model::name);
}

}  // namespace

void test_models(mpm::testing::Report& report) {
  int count = 0;
  StrengthModels::for_each([&]<class Model>(const Model&) {
    check_lanes<Model, 2>(report);
    check_lanes<Model, 3>(report);
    ++count;
  });
  CHECK(count >= 2, count);
}
