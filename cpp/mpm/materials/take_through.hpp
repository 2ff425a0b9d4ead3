#pragma once
// The whole way of a block's particles through their material, part by part.
#include "mpm/materials/apply_damping.hpp"
#include "mpm/materials/apply_eos.hpp"
#include "mpm/materials/apply_failure.hpp"
#include "mpm/materials/apply_strength.hpp"

namespace mpm {

/// In place of an equation of state where there is none.
struct NoEos {};

/// f(model), for a model that is known, or the one that a material has.
template <class Model, class F>
MPM_HD void with_model(const Model& model, F&& f) {
  f(model);
}
template <class F>
MPM_HD void with_model(const NoEos&, F&&) {}
template <class... Models, class F>
void with_model(const std::variant<Models...>& model, F&& f) {
  std::visit(f, model);
}
template <class Any, class F>
void with_model(const std::optional<Any>& model, F&& f) {
  if (model) std::visit(f, *model);
}

/// Stress, state and volume after the step, and the sums. Strength and equation of state are what
/// with_model() takes, failure models what for_each_failure() takes; the host finds out for each
/// part and block which they are (decision 0009), a device's kernel has been made for them.
template <class T, int D, int N, class Strength, class Eos, class Failures>
MPM_HD void take_through(const MaterialView& material, const Strength& strength, const Eos& eos,
                         const Failures& failures, const BlockColumns<D>& columns,
                         const StressSettings& settings, MaterialBlock<D, N>& block,
                         StressSums& sums) {
  StressWriter<T, D> writer(columns, settings, material);
  with_model(strength, [&](const auto& model) {
    apply_strength(model, material, columns, settings, block, writer);
  });
  with_model(eos, [&](const auto& model) {
    apply_eos(model, material, columns, settings, block, writer);
  });
  if (material.judged) apply_failures(material, failures, columns, settings, block, writer, sums);
  writer.add_to(sums);
  if (material.damping.active()) apply_damping<T>(material, columns, settings, block, sums);
}

}  // namespace mpm
