#include "mpm/run/drive_material.hpp"

#include "mpm/materials/material.hpp"

namespace mpm {
namespace {

double first_lane(double a) { return a; }
template <int W>
double first_lane(Batch<W> a) {
  return a[0];
}

template <class T, class Model>
std::vector<double> drive(const Model& model, std::span<const double> increments) {
  std::vector<double> out(6, 0.0);
  Sym<T, 3> stress = Sym<T, 3>::zero();
  typename Model::template State<T, 3> state;
  T* flat = reinterpret_cast<T*>(&state);
  for (const StateColumn& s : Model::state_columns)
    for (int k = 0; k < s.components(3); ++k)
      *flat++ = T(s.start == Start::one || (s.start == Start::identity && k < 3) ? 1.0 : 0.0);
  T J(1.0);
  for (std::size_t n = 0; n + 9 <= increments.size(); n += 9) {
    Motion<T, 3> motion;
    for (std::size_t k = 0; k < 9; ++k) motion.gradient.c[k / 3][k % 3] = T(increments[n + k]);
    Mat<T, 3> f = motion.gradient;
    for (int i = 0; i < 3; ++i) f[i][i] = f[i][i] + T(1.0);
    motion.volume_ratio = determinant(f);
    J = J * motion.volume_ratio;
    motion.J = J;
    model.update(motion, stress, state);
    for (const T& c : stress.c) out.push_back(first_lane(c));
  }
  return out;
}

}  // namespace

std::vector<double> drive_material(double density, const std::string& strength,
                                   const std::map<std::string, double>& parameters,
                                   std::span<const double> increments, bool lanes) {
  const Material material = make_material(density, strength, parameters);
  return std::visit(
      [&](const auto& model) {
        return lanes ? drive<Batch<native_lanes>>(model, increments)
                     : drive<double>(model, increments);
      },
      material.strength);
}

}  // namespace mpm
