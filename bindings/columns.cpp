// The particles' numbers as arrays.
#include "mpm/run/columns.hpp"

#include "any.hpp"
#include "mpm/run/frame.hpp"
#include "mpm/run/measures.hpp"

namespace mpm::bindings {
namespace {

/// So many on rank 0, which gets all; none on others.
template <class Simulation>
std::size_t on_first(const Simulation& s, std::size_t count) {
  return comm_of(s).rank() == 0 ? count : 0;
}

/// Rows of floats that `fill` writes on rank 0; none on others.
template <class Fill>
Floats rows_of_all(AnySimulation& either, std::size_t width, float elsewhere, Fill fill) {
  const std::size_t count =
      either.visit([](auto& s) { return on_first(s, particle_count(s.domain)); });
  Floats values = floats(count, width, elsewhere);
  const std::span<float> to{values.data(), values.size()};
  either.visit([&](auto& s) { fill(s, to.first(on_first(s, to.size()))); });
  return values;
}

}  // namespace

void def_columns(SimulationClass& simulation) {
  simulation
      .def("columns", of_any([](auto& s, int body) { return columns(s.domain, body); }),
           nb::arg("body"))
      .def(
          "column",
          [](AnySimulation& either, int body, const std::string& name) {
            auto [values, width] = either.visit([&](auto& s) {
              const auto components =
                  static_cast<std::size_t>(column_components(s.domain, body, name));
              std::vector<double> numbers(on_first(s, s.domain.body_at(body).count * components));
              copy_column(s.domain, body, name, numbers);
              return std::pair(std::move(numbers), components);
            });
            return to_numpy(std::move(values), width);
          },
          nb::arg("body"), nb::arg("name"))
      .def(
          "ranks_of",
          [](AnySimulation& either, int body) {
            auto numbers = either.visit([&](auto& s) {
              std::vector<double> found(on_first(s, s.domain.body_at(body).count));
              copy_ranks(s.domain, body, found);
              return found;
            });
            return to_numpy(std::move(numbers), 1);
          },
          nb::arg("body"))
      .def(
          "rounded_column",
          [](AnySimulation& either, const std::string& name, const std::vector<int>& places,
             std::size_t width, float elsewhere) {
            return rows_of_all(either, width, elsewhere, [&](auto& s, std::span<float> to) {
              round_column(s.domain, name, places, width, to);
            });
          },
          nb::arg("name"), nb::arg("places"), nb::arg("width"), nb::arg("elsewhere"))
      .def(
          "rounded_derived",
          [](AnySimulation& either, const std::string& name) {
            return rows_of_all(either, 1, 0.0F, [&](auto& s, std::span<float> to) {
              round_derived(s.domain, name, to);
            });
          },
          nb::arg("name"));
}

}  // namespace mpm::bindings
