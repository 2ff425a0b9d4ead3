// Principal values and axes against the definition a n = value n, for tensors of every kind.
#include <random>

#include "check.hpp"
#include "mpm/math/eigen.hpp"

namespace {

using namespace mpm;
using mpm::testing::eps;

constexpr double near = 48 * eps;  // 1e-14: roundings of 12 rotations, most of which do nothing

template <int D>
void check_definition(mpm::testing::Report& report, const Sym<double, D>& a) {
  const auto e = eigen(a);
  double norm = 0.0;
  for (const double c : a.c) norm = std::max(norm, std::abs(c));
  for (int k = 0; k < D; ++k)
    for (int i = 0; i < D; ++i) {
      double an = 0.0;
      for (int j = 0; j < D; ++j) an += a(i, j) * e.axis[k][j];
      CHECK_CLOSE(an, e.value[k] * e.axis[k][i], near * norm);
      CHECK_CLOSE(dot(e.axis[k], e.axis[i]), i == k ? 1.0 : 0.0, near);
    }
  if (D == 2) CHECK_CLOSE(e.value[2], a.c[2], eps * norm);
  CHECK_CLOSE(e.value[0] + e.value[1] + e.value[2], trace(a), near * norm);
  const auto again = e.with(e.value);
  for (int k = 0; k < Sym<double, D>::size; ++k) CHECK_CLOSE(again.c[k], a.c[k], near * norm);
}

/// Random tensors of all sizes: full, nearly diagonal, with one axis apart, two or three values
/// alike, and a pair that is nearly so.
template <int D>
std::vector<Sym<double, D>> samples() {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<Sym<double, D>> all{Sym<double, D>::zero(), Sym<double, D>::isotropic(-3.0)};
  for (const double scale : {1.0, 1e-200, 1e-9, 1e9, 1e150})
    for (int n = 0; n < 400; ++n) {
      Sym<double, D> a;
      for (double& c : a.c) c = scale * any(random);
      all.push_back(a);
      Sym<double, D> nearly = a;
      for (int k = 3; k < Sym<double, D>::size; ++k)
        nearly.c[k] *= std::pow(10.0, 20 * any(random));
      all.push_back(nearly);
      for (int k = 3; k < Sym<double, D>::size; ++k) nearly.c[k] = 0.0;
      all.push_back(nearly);
      // Two values alike or nearly so, along the axes of the first.
      const auto e = eigen(a);
      for (const double apart : {0.0, 1e-15, 1e-8}) {
        const double values[3] = {e.value[0], e.value[0] * (1.0 + apart), e.value[2]};
        all.push_back(e.with(values));
      }
    }
  return all;
}

template <int D>
void check_eigenvalues(mpm::testing::Report& report) {
  const auto all = samples<D>();
  for (const auto& a : all) check_definition(report, a);

  constexpr int W = native_lanes;
  for (std::size_t n = 0; n + W <= all.size(); n += W) {
    auto lanes = Sym<Batch<W>, D>::zero();
    for (int c = 0; c < Sym<double, D>::size; ++c)
      for (int k = 0; k < W; ++k) lanes.c[c].v[k] = all[n + static_cast<std::size_t>(k)].c[c];
    const auto e = eigen(lanes);
    for (int k = 0; k < W; ++k) {
      const auto& a = all[n + static_cast<std::size_t>(k)];
      const auto one = eigen(a);
      double norm = 0.0;
      for (const double c : a.c) norm = std::max(norm, std::abs(c));
      for (int i = 0; i < 3; ++i) CHECK_CLOSE(e.value[i][k], one.value[i], near * norm);
    }
  }
}

void check_sorted(mpm::testing::Report& report) {
  int order[3] = {0, 1, 2};
  do {
    const double given[3] = {1.0 * order[0], 1.0 * order[1], 1.0 * order[2]};
    const Sorted<double> sorted(given);
    double back[3];
    for (int k = 0; k < 3; ++k) {
      CHECK_EQUAL(sorted.value[k], 2.0 - k);
      back[k] = sorted.value[k];
    }
    sorted.unsort(back);
    for (int k = 0; k < 3; ++k) CHECK_EQUAL(back[k], given[k]);
  } while (std::next_permutation(order, order + 3));
}

}  // namespace

void test_eigen(mpm::testing::Report& report) {
  check_eigenvalues<2>(report);
  check_eigenvalues<3>(report);
  check_sorted(report);
}
