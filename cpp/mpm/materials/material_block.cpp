#include "mpm/materials/material_block.hpp"

#include <limits>

#include "mpm/materials/take_through.hpp"

namespace mpm {
template <class T, int D>
void update_block(const Material& material, Columns& all, const MaterialColumns& at,
                  MaterialBlock<D>& block, const StressSettings& settings, StressSums& sums) {
  const BlockColumns<D> columns(all, at);
  take_through<T>(view_of(material), material.strength, material.eos, material.failures, columns,
                  settings, block, sums);
}

template <int D>
void add_material_columns(const Material& material, Columns& columns, MaterialColumns& at) {
  const auto add = [&](int& first, const auto& model) {
    for (const StateColumn& s : model.state_columns) {
      const int place = columns.add(std::string(s.name), std::string(s.unit), s.components(D));
      if (first < 0) first = place;
    }
  };
  std::visit([&](const auto& model) { add(at.state, model); }, material.strength);
  if (material.viscosity.active())
    at.viscosity_pressure = columns.add("viscosity_pressure", "Pa", 1);
  if (material.averages_volume) at.force_pressure = columns.add("force_pressure", "Pa", 1);
  if (material.damping.active())
    at.damping_stress = columns.add("damping_stress", "Pa", Sym<double, D>::size);
  at.energy = material.eos ? columns.add("internal_energy", "J/m^3", 1) : -1;
  if (material.failures.empty()) return;
  if (material.erodes() || !material.eos)
    at.recoverable = columns.add("recoverable_energy", "J/m^3", 1);
  at.failed = columns.add("failed", "1", 1);
  for (const Failing& failing : material.failures)
    std::visit([&](const auto& model) { add(at.failure_state, model); }, failing.model);
}

template <int D>
void start_material_columns(const Material& material, Columns& columns, const MaterialColumns& at) {
  const auto fill = [&](int component, double value) {
    columns.with_component(component, [&]<class Number>(Number* column) {
      std::fill_n(column, columns.rows(), static_cast<Number>(value));
    });
  };
  for (int c = at.stress; c < columns.component_count(); ++c) fill(c, 0.0);
  const auto start = [&](int& first, const auto& model) {
    const auto state = model.template start<double, D>();
    constexpr int size = state_size<std::remove_cvref_t<decltype(state)>, double>;
    double flat[size + 1];
    pack(state, flat);
    for (int k = 0; k < size; ++k) fill(first + k, flat[k]);
    first += size;
  };
  int next = at.state;
  std::visit([&](const auto& model) { start(next, model); }, material.strength);
  next = at.failure_state;
  for (const Failing& failing : material.failures)
    std::visit([&](const auto& model) { start(next, model); }, failing.model);
  if (!material.eos) return;
  std::visit(
      [&](const auto& model) {
        const double energy = model.initial_energy();
        const double pressure = line_of(model, 1.0, energy).pressure(energy);
        fill(at.energy, energy);
        if (at.recoverable >= 0) fill(at.recoverable, energy);
        if (material.burns()) return;  // not burning yet
        for (int c = 0; c < 3; ++c) fill(at.stress + c, -pressure);
      },
      *material.eos);
}

namespace {

/// That of the material's models, which find viscosities of their own.
template <int D>
double speed_of_models(const Material& material, const Columns& columns, const MaterialColumns& at,
                       std::size_t row, double cell_size) {
  const auto value = [&](int component) { return columns.value(component, row); };
  Sym<double, D> stress;
  for (int c = 0; c < Sym<double, D>::size; ++c) stress.c[c] = value(at.stress + c);
  // No waves run in loose matter: torn particles that gape (apply_failure.hpp).
  if (at.failed >= 0 && value(at.failed) >= static_cast<double>(FailureAction::no_tension) &&
      trace(stress) >= 0.0)
    return 0.0;
  const double J = value(at.volume) * material.density / value(at.mass);
  return std::visit(
      [&]<class Model>(const Model& model) {
        using State = typename Model::template State<double, D>;
        double flat[state_size<State, double> + 1];
        for (int k = 0; k < state_size<State, double>; ++k) flat[k] = value(at.state + k);
        const auto state = unpack<State>(flat);
        if constexpr (Model::eos != EosUse::must)
          if (!material.eos) return model.sound_speed(stress, state, J);
        if constexpr (Model::eos != EosUse::never) {
          const double other = model.other_speed_squared(state, J);
          const double bulk = std::visit(
              [&](const auto& eos) {
                const double energy = value(at.energy);
                LinearInEnergy<double> p = line_of(eos, J, energy);
                if constexpr (Burns<Model>) p = p.burnt(state.burn_fraction);
                return sound_speed_squared(p, J, energy, material.density);
              },
              *material.eos);
          const double c = sqrt(bulk + other);
          if constexpr (Damps<Model>) return damped_speed(c, model.damping_speed(J, cell_size));
          return c;
        }
        return 0.0;
      },
      material.strength);
}

}  // namespace

template <int D>
double sound_speed(const Material& material, const Columns& columns, const MaterialColumns& at,
                   std::size_t row, double cell_size) {
  const double c = speed_of_models<D>(material, columns, at, row, cell_size);
  if (!material.damping.active()) return c;
  const double specific = columns.value(at.volume, row) / columns.value(at.mass, row);
  return speed_with_damping(view_of(material), c, specific, cell_size);
}

double sound_speed_at_start(const Material& material) {
  Columns columns;
  MaterialColumns at;
  at.velocity = columns.add("velocity", "m/s", 3, Precision::rounded);
  at.mass = columns.add("mass", "kg", 1);
  at.volume = columns.add("volume", "m^3", 1);
  at.stress = columns.add("stress", "Pa", Sym<double, 3>::size, Precision::rounded);
  add_material_columns<3>(material, columns, at);
  columns.allocate(1);
  columns.component(at.mass)[0] = material.density;
  columns.component(at.volume)[0] = 1.0;
  start_material_columns<3>(material, columns, at);
  return speed_of_models<3>(material, columns, at, 0, std::numeric_limits<double>::infinity());
}

template void update_block<Batch<native_lanes>, 2>(const Material&, Columns&,
                                                   const MaterialColumns&, MaterialBlock<2>&,
                                                   const StressSettings&, StressSums&);
template void update_block<Batch<native_lanes>, 3>(const Material&, Columns&,
                                                   const MaterialColumns&, MaterialBlock<3>&,
                                                   const StressSettings&, StressSums&);
template void update_block<double, 2>(const Material&, Columns&, const MaterialColumns&,
                                      MaterialBlock<2>&, const StressSettings&, StressSums&);
template void update_block<double, 3>(const Material&, Columns&, const MaterialColumns&,
                                      MaterialBlock<3>&, const StressSettings&, StressSums&);
template void add_material_columns<2>(const Material&, Columns&, MaterialColumns&);
template void add_material_columns<3>(const Material&, Columns&, MaterialColumns&);
template void start_material_columns<2>(const Material&, Columns&, const MaterialColumns&);
template void start_material_columns<3>(const Material&, Columns&, const MaterialColumns&);
template double sound_speed<2>(const Material&, const Columns&, const MaterialColumns&, std::size_t,
                               double);
template double sound_speed<3>(const Material&, const Columns&, const MaterialColumns&, std::size_t,
                               double);

}  // namespace mpm
